//! `completions`, `manual` and `--version`: what packages and shells ask of the program.

use predicates::str::contains;

use super::{COMMANDS, plain, stdout};

#[test]
fn every_shell_completes_every_command() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = stdout(&format!("completions {shell}"));
        for word in COMMANDS.into_iter().chain(["headless", "tolerance"]) {
            assert!(text.contains(word), "{shell} does not know `{word}`");
        }
        plain(&format!("completions {shell}")).assert().success().stdout(text);
    }
}

/// Without the marks of roff.
fn page(line: &str) -> String {
    let page = stdout(line);
    plain(line).assert().success().stdout(page.clone());
    assert!(page.contains(".TH "), "{page}");
    page.replace("\\-", "-").replace("\\fB", "").replace("\\fI", "").replace("\\fR", "")
}

#[test]
fn the_manual_has_a_page_for_each_command_with_its_options() {
    let all = page("manual");
    for word in COMMANDS {
        assert!(all.contains(&format!("interwell-{word}(1)")), "{word} is not in: {all}");
        let command = page(&format!("manual {word}"));
        assert!(command.contains(&format!("interwell --headless {word}")), "{command}");
        // the options of its help, no more and no less
        let help = stdout(&format!("{word} --help"));
        let of = |text: &str| -> Vec<String> {
            let lines = text.lines().map(str::trim_start).filter(|line| line.starts_with("--"));
            let names = lines.map(|line| line.split([' ', '=', '[']).next().unwrap().to_owned());
            let mut names: Vec<String> =
                names.filter(|name| !["--headless", "--help"].contains(&&**name)).collect();
            names.sort();
            names
        };
        assert_eq!(of(&command), of(&help), "{word}");
        assert!(!of(&command).is_empty(), "{word}");
    }
}

#[test]
fn the_first_page_of_the_help_leaves_them_out() {
    let help = String::from_utf8(plain("--help").assert().success().get_output().stdout.clone()).unwrap();
    assert!(!help.contains("completions") && !help.contains("manual"), "{help}");
    plain("completions --help").assert().success().stdout(contains("interwell completions SHELL"));
}

#[test]
fn the_version_names_the_commit_of_a_clone() {
    let output = plain("--version").assert().success().get_output().stdout.clone();
    let text = String::from_utf8(output).unwrap();
    let version = format!("interwell {}", env!("CARGO_PKG_VERSION"));
    let rest = text.strip_prefix(&version).unwrap_or_else(|| panic!("{text}")).trim_end();
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')'));
    let is_commit = |commit: &str| commit.len() == 8 && commit.bytes().all(|digit| digit.is_ascii_hexdigit());
    assert!(rest.is_empty() || commit.is_some_and(is_commit), "{text}");
}
