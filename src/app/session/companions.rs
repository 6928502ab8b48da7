//! Copies of the files that a scene names, made beside the file that the scene is saved to.

use std::path::{Path, PathBuf};

use crate::output::write_file;
use crate::scene::{FileError, Files, Scene, named_paths};
use crate::system;

/// Copies the table and the records of `scene` into the folder of `target`, and renames them in `scene`
/// accordingly. An existing file is used if its content is the same, and is never overwritten. Returns the
/// names of the files written; the error says why one could not be.
pub fn copy_files(scene: &mut Scene, files: &Files, target: &Path) -> Result<Vec<String>, String> {
    let mut written = Vec::new();
    if files.folder.as_deref().is_some_and(|folder| is_same(folder, folder_of(target))) {
        return Ok(written);
    }
    for path in named_paths(scene) {
        if Path::new(path.as_str()).is_absolute() {
            continue;
        }
        let text = match files.read(path) {
            Err(FileError::Missing { embedded: true, .. }) => Files::default().read(path),
            read => read,
        };
        let text = text.map_err(|error| format!("the scene names a file that cannot be read: {error}"))?;
        let name = free_name(path, &text, target)?;
        if !system::files::exists(&target.with_file_name(&name)) {
            write_file(&target.with_file_name(&name), text.as_bytes())?;
            written.push(name.clone());
        }
        *path = name;
    }
    Ok(written)
}

/// Updates the file names in a scene of the undo history after a save to another folder: a copied file gets
/// the name of its copy, any other its absolute path. `was` and `now` are the saved scene before and after.
pub fn update_names(scene: &mut Scene, files: &Files, was: &mut Scene, now: &mut Scene) {
    let renamed: Vec<_> = named_paths(was).into_iter().zip(named_paths(now)).collect();
    for path in named_paths(scene) {
        let place = || files.place(path).and_then(|place| std::path::absolute(place).ok());
        if let Some((_, name)) = renamed.iter().find(|names| names.0 == path) {
            path.clone_from(name);
        } else if let Some(place) = place().as_deref().and_then(Path::to_str) {
            *path = place.to_owned();
        }
    }
}

/// The first of `a.csv`, `a-2.csv`, `a-3.csv` .. beside `target` that is free or holds this text.
fn free_name(path: &str, text: &str, target: &Path) -> Result<String, String> {
    let file = Path::new(path);
    let part = |part: Option<&std::ffi::OsStr>| part.map(|part| part.to_string_lossy().into_owned());
    let stem = part(file.file_stem()).ok_or_else(|| format!("`{path}` names no file"))?;
    let ending = part(file.extension()).map_or_else(String::new, |ending| format!(".{ending}"));
    let names = (1_u32..).map(|n| match n {
        1 => format!("{stem}{ending}"),
        n => format!("{stem}-{n}{ending}"),
    });
    let fits = |name: &String| {
        let there = target.with_file_name(name);
        there != target
            && (!system::files::exists(&there)
                || system::files::bytes(&there).is_ok_and(|bytes| bytes == text.as_bytes()))
    };
    names
        .take(1000)
        .find(fits)
        .ok_or_else(|| format!("no name is free for `{path}` beside {}", target.display()))
}

fn folder_of(file: &Path) -> PathBuf {
    file.parent().map_or_else(PathBuf::new, Path::to_path_buf)
}

fn is_same(a: &Path, b: PathBuf) -> bool {
    let whole = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        system::files::canonical(path)
    };
    whole(a).is_some_and(|a| whole(&b) == Some(a))
}
