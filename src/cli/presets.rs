//! `presets`: list of the built-in scenes, and their copies as files.

use std::path::{Path, PathBuf};

use clap::Args;
use interwell::output::Sink;
use interwell::scene::{PRESETS, export};
use interwell::system::files;

use super::{Common, Failure, Output, Outputs, refuse};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Copy the scenes and their tables into this folder
    #[arg(long, value_name = "DIR")]
    pub write: Option<PathBuf>,

    /// With --write: replace existing files that differ
    #[arg(long, requires = "write")]
    pub force: bool,
}

/// Lists the built-in scenes, one line each, or writes them into a folder and lists the files.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let mut outputs = Outputs::new(&[]).with(Output::DATA, Some(common.out()))?;
    let text = match &options.write {
        Some(folder) => write(folder, options.force)?,
        None => {
            let width = PRESETS.iter().map(|preset| preset.name.len()).max().unwrap_or(0);
            PRESETS.iter().map(|preset| format!("{:width$}  {}\n", preset.name, preset.summary)).collect()
        }
    };
    outputs.write(Output::DATA, &text)?;
    outputs.finish()
}

/// Writes all scenes and tables into `folder`, or none if a file of that name exists and differs.
fn write(folder: &Path, force: bool) -> Result<String, Failure> {
    if !files::is_folder(folder) {
        let folder = folder.display();
        refuse!("--write {folder}: there is no such folder; make it first");
    }
    let all = export();
    let differs = |name: &str, text: &str| {
        let path = folder.join(name);
        files::exists(&path) && files::bytes(&path).ok().as_deref() != Some(text.as_bytes())
    };
    let differing = all.iter().filter(|(name, text)| differs(name, text)).map(|(name, _)| name.as_str());
    let differing: Vec<&str> = differing.collect();
    if !differing.is_empty() && !force {
        let differ = if differing.len() == 1 { "exists and differs" } else { "exist and differ" };
        refuse!(
            "--write {}: {} {differ} from what is built in; nothing was written: choose another folder, or \
             replace with --force",
            folder.display(),
            differing.join(", ")
        );
    }
    let mut written = String::new();
    for (name, text) in &all {
        let path = folder.join(name);
        let mut sink = Sink::open(&path)?;
        sink.put(text)
            .and_then(|()| sink.finish())
            .map_err(|error| Failure::writing(path.display(), error))?;
        written += &format!("{}\n", path.display());
    }
    Ok(written)
}
