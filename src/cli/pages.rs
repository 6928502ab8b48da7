//! `completions` and `manual`: shell completions and manual pages, made from the table of commands.

use std::io::Write;
use std::sync::LazyLock;

use clap::Subcommand;
use clap_complete::Shell;

use super::failure::refuse;
use super::{Failure, command_names, options::command_line};

/// Commands that packages use; the first page of the help leaves them out.
#[derive(Debug, Subcommand)]
pub enum Page {
    /// Completions for a shell, on standard output
    #[command(hide = true, override_usage = "interwell completions SHELL")]
    Completions {
        #[arg(value_name = "SHELL")]
        shell: Shell,
    },
    /// A manual page, on standard output: of the program, or of one command
    #[command(hide = true, override_usage = "interwell manual [COMMAND]")]
    Manual {
        #[arg(value_name = "COMMAND")]
        command: Option<String>,
    },
}

impl Page {
    pub fn name(&self) -> &'static str {
        match self {
            Self::Completions { .. } => "completions",
            Self::Manual { .. } => "manual",
        }
    }

    pub fn run(&self) -> Result<(), Failure> {
        let mut page = Vec::new();
        match self {
            Self::Completions { shell } => {
                clap_complete::generate(*shell, &mut command_line(), "interwell", &mut page);
            }
            Self::Manual { command } => {
                let program = format!("interwell {}", *VERSION);
                let made = clap_mangen::Man::new(documented(command.as_deref())?).source(program);
                let made = made.render(&mut page);
                made.map_err(|error| Failure::writing("the manual page", error))?;
            }
        }
        let mut out = std::io::stdout().lock();
        let written = out.write_all(&page).and_then(|()| out.flush());
        written.map_err(|error| Failure::writing("standard output", error))
    }
}

/// The program, or the command of this name, as its manual page calls it.
fn documented(name: Option<&str>) -> Result<clap::Command, Failure> {
    let all = command_line().disable_help_flag(true).disable_version_flag(true);
    let Some(name) = name else { return Ok(all) };
    let named = |command: &&clap::Command| command.get_name() == name && !command.is_hide_set();
    let Some(command) = all.get_subcommands().find(named) else {
        refuse!("there is no page of `{name}`: name {}", command_names());
    };
    let command = command.clone().display_name(format!("interwell-{name}")).disable_help_flag(true);
    Ok(command.bin_name(format!("interwell --headless {name}")))
}

/// The version, and in brackets the commit where it is known.
pub static VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    let digits = COMMIT.iter().take_while(|digit| digit.is_ascii_hexdigit());
    let commit: String = digits.copied().map(char::from).collect();
    if commit.is_empty() { version.to_owned() } else { format!("{version} ({commit})") }
});

/// The first digits of the commit, of the last line of git's log; the log itself is not in the binary.
const COMMIT: [u8; 8] = {
    let log = include_bytes!(env!("INTERWELL_LOG"));
    let mut begin = log.len().saturating_sub(1);
    while begin > 0 && log[begin - 1] != b'\n' {
        begin -= 1;
    }
    let (mut digits, mut i) = ([0; 8], 0);
    while i < digits.len() && begin + 41 + i < log.len() {
        digits[i] = log[begin + 41 + i];
        i += 1;
    }
    digits
};
