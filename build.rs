//! Tells the binary where git keeps the log whose last line names the commit. The binary alone reads that
//! file, so that a commit does not make cargo build the library again.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let log = log_of_git(Path::new(".")).unwrap_or_else(|| {
        // a published package has the commit in a file of cargo's; elsewhere nothing is known
        let file = PathBuf::from(env::var_os("OUT_DIR").unwrap()).join("commit");
        let packed = fs::read_to_string(".cargo_vcs_info.json").unwrap_or_default();
        let commit = packed.split("\"sha1\": \"").nth(1).and_then(|rest| rest.split('"').next());
        // as a line of git's log: 40 digits of the commit before, those of this one
        fs::write(&file, commit.map(|commit| format!("{:41}{commit}", "")).unwrap_or_default()).unwrap();
        file
    });
    println!("cargo::rustc-env=INTERWELL_LOG={}", log.display());
}

/// The log of HEAD; in a work tree beside the first one `.git` is a file that names the folder.
fn log_of_git(root: &Path) -> Option<PathBuf> {
    let git = root.join(".git");
    let git = match fs::read_to_string(&git) {
        Ok(text) => root.join(text.strip_prefix("gitdir: ")?.trim()),
        Err(_) => git,
    };
    let log = git.join("logs/HEAD").canonicalize().ok()?;
    println!("cargo::rerun-if-changed={}", git.join("HEAD").display());
    Some(log)
}
