//! The edited scene with its file and its undo stack.
//!
//! Undo is a stack of scenes: a scene is plain, comparable data of a few hundred bytes, and one gesture (a
//! drag, a click, a number typed) is one step. So is a move of the mass by hand, which changes no scene.

use std::borrow::Cow;
use std::mem::discriminant;
use std::path::Path;
use std::sync::Arc;

use crate::output::write_file;
use crate::scene::{
    Document, FileError, Files, Scene, SceneError, Source, Start, is_link, named_paths, numeric_fields,
};
use crate::system;

const MAX_STEPS: usize = 500;

/// Name in messages of a scene that was given as text.
const PASTED: &str = "the pasted scene";

/// Displacement in m and velocity in m/s of the mass.
type State = (f64, f64);

/// What one step changes back: the scene, or the state of the mass.
/// The live time of a motion in s, and the state of the mass then.
pub type Moment = (f64, State);

/// What a step brings back of the motion.
#[derive(Debug, Clone, Copy)]
pub enum Placed {
    Mass(State),
    /// The motion when its scene was left, unless it has gone on since.
    Motion(Moment),
}

#[derive(Debug, Clone)]
enum Step {
    /// Another scene, and the motion when it was left.
    Scene(Arc<Scene>, Option<Moment>),
    Mass {
        from: State,
        to: State,
    },
}

#[derive(Debug, Clone)]
pub struct Editor {
    document: Document,
    /// The scene of the document, for all who keep it.
    now: Arc<Scene>,
    /// The scene as it was opened or last saved.
    saved: Scene,
    named: Scene,
    undo: Vec<Step>,
    redo: Vec<Step>,
    /// Where the step that was taken last has placed the mass.
    placed: Option<Placed>,
    /// The motion before the current gesture.
    moment: Option<Moment>,
    /// The scene before the current gesture.
    gesture: Option<Arc<Scene>>,
}

impl Editor {
    pub fn new(document: Document) -> Self {
        let (saved, named) = (document.scene.clone(), document.scene.clone());
        Self {
            now: Arc::new(saved.clone()),
            document,
            saved,
            named,
            undo: Vec::new(),
            redo: Vec::new(),
            placed: None,
            moment: None,
            gesture: None,
        }
    }

    /// An editor on the scene of a lesson or of a link, which differs from the scene that its source names.
    /// The source does not change, and a scene file is not overwritten.
    pub fn changed(mut document: Document) -> Self {
        let named = match document.source {
            Source::BuiltIn(name) => Document::load(name).ok(),
            Source::File(_) | Source::Text => None,
        };
        let Some(named) = named else {
            document.source = Source::Text;
            return Self::new(document);
        };
        Self { named: named.scene, ..Self::new(document) }
    }

    pub fn open(spec: &str) -> Result<Self, SceneError> {
        let document = Document::load(spec)?;
        Ok(if is_link(spec) { Self::changed(document) } else { Self::new(document) })
    }

    /// An editor on a scene as text, which has no file.
    pub fn from_text(text: &str) -> Result<Self, SceneError> {
        Document::from_text(PASTED, text, Files::default()).map(Self::new)
    }

    /// The scene's name on the command line; `None` for a scene that was given as text.
    pub fn origin(&self) -> Option<String> {
        match &self.document.source {
            Source::File(path) => Some(path.to_string_lossy().into_owned()),
            Source::BuiltIn(name) => Some((*name).to_owned()),
            Source::Text => None,
        }
    }

    /// The document as it can be run and written: without sweep axes over a field that the scene lacks at
    /// present, such as the travel limit while the stops are off. The edited scene keeps these axes.
    pub fn runnable(&self) -> Cow<'_, Document> {
        runnable(&self.document)
    }

    pub fn text(&self) -> Result<String, String> {
        text_of(&self.runnable())
    }

    /// Whether the file of the scene has comments, which are not part of a scene.
    pub fn has_comments(&self) -> bool {
        self.path().is_some() && crate::scene::has_comments(&self.document.text)
    }

    pub fn scene(&self) -> &Scene {
        &self.document.scene
    }

    /// The scene, which is shared until it is changed.
    pub fn shared(&self) -> &Arc<Scene> {
        &self.now
    }

    pub fn saved(&self) -> &Scene {
        &self.saved
    }

    /// The scene that [`origin`](Self::origin) names.
    pub fn named(&self) -> &Scene {
        &self.named
    }

    /// The document, with its files and the positions of its fields.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The file that the scene is saved to.
    pub fn path(&self) -> Option<&Path> {
        if let Source::File(path) = &self.document.source { Some(path) } else { None }
    }

    pub fn is_dirty(&self) -> bool {
        self.document.scene != self.saved
    }

    /// Whether the scene is a built-in one of which only shaking, stops and start were changed.
    pub fn is_play(&self) -> bool {
        let (scene, mut played) = (&self.document.scene, self.saved.clone());
        (played.stops, played.start) = (scene.stops, scene.start);
        if let (Some(drive), Some(before)) = (scene.harmonic(), played.harmonic())
            && discriminant(&scene.excitation) == discriminant(&played.excitation)
            && drive.phase_deg == before.phase_deg
        {
            played.excitation = scene.excitation.clone();
        }
        matches!(self.document.source, Source::BuiltIn(_)) && played == *scene
    }

    pub fn in_gesture(&self) -> bool {
        self.gesture.is_some()
    }

    /// Changes the scene as part of a gesture, and begins one if necessary. Returns whether it changed.
    pub fn edit(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        change(&mut self.document.scene);
        keep_start_inside(&mut self.document.scene);
        let changed = self.document.scene != *self.now;
        if changed {
            let before = std::mem::replace(&mut self.now, Arc::new(self.document.scene.clone()));
            self.gesture.get_or_insert(before);
        }
        changed
    }

    /// Ends the gesture, which becomes one undo step if it changed anything.
    pub fn end_gesture(&mut self) {
        let Some(before) = self.gesture.take().filter(|before| *before != self.now) else {
            return;
        };
        self.push(Step::Scene(before, self.moment));
    }

    /// Notes the motion before the next change.
    pub fn at(&mut self, moment: Moment) {
        self.moment = Some(moment);
    }

    /// Adds a move of the mass by hand as one undo step.
    pub fn moved(&mut self, from: State, to: State) {
        self.end_gesture();
        if from != to {
            self.push(Step::Mass { from, to });
        }
    }

    /// What an undo or a redo has brought back of the motion, once.
    pub fn take_placed(&mut self) -> Option<Placed> {
        self.placed.take()
    }

    fn push(&mut self, step: Step) {
        self.undo.push(step);
        self.redo.clear();
        let excess = self.undo.len().saturating_sub(MAX_STEPS);
        self.undo.drain(..excess);
    }

    /// Changes the scene as one undo step. Returns whether it changed.
    pub fn edit_once(&mut self, change: impl FnOnce(&mut Scene)) -> bool {
        self.end_gesture();
        let changed = self.edit(change);
        self.end_gesture();
        changed
    }

    pub fn can_undo(&self) -> bool {
        !self.undo.is_empty() || self.gesture.is_some()
    }

    pub fn can_redo(&self) -> bool {
        !self.redo.is_empty()
    }

    /// Undoes one step. Returns whether there was one.
    pub fn undo(&mut self) -> bool {
        self.end_gesture();
        let Some(step) = self.undo.pop() else { return false };
        self.placed = match step {
            Step::Mass { from, .. } => Some(Placed::Mass(from)),
            Step::Scene(_, moment) => moment.map(Placed::Motion),
        };
        let back = self.taken(step);
        self.redo.push(back);
        true
    }

    /// Redoes one step. Returns whether there was one.
    pub fn redo(&mut self) -> bool {
        self.end_gesture();
        let Some(step) = self.redo.pop() else { return false };
        self.placed = match step {
            Step::Mass { to, .. } => Some(Placed::Mass(to)),
            Step::Scene(_, moment) => moment.map(Placed::Motion),
        };
        let back = self.taken(step);
        self.undo.push(back);
        true
    }

    /// Takes a step. Returns the one that leads back.
    fn taken(&mut self, step: Step) -> Step {
        match step {
            Step::Scene(scene, _) => {
                self.document.scene = Scene::clone(&scene);
                Step::Scene(std::mem::replace(&mut self.now, scene), self.moment)
            }
            step => step,
        }
    }

    /// Goes to the nearest scene before the present one that has this link, or else after it. Returns whether
    /// there is one.
    #[cfg(any(test, target_arch = "wasm32"))]
    pub fn go_to(&mut self, link: &str) -> bool {
        self.end_gesture();
        let has_link = |step: &Step| {
            let Step::Scene(scene, _) = step else { return false };
            let mut document = self.document.clone();
            document.scene = Scene::clone(scene);
            document.link().is_ok_and(|other| other == link)
        };
        let place = |steps: &[Step]| steps.iter().rev().position(has_link);
        match (place(&self.undo), place(&self.redo)) {
            (Some(steps), _) => (0..=steps).all(|_| self.undo()),
            (None, Some(steps)) => (0..=steps).all(|_| self.redo()),
            (None, None) => false,
        }
    }

    /// Goes back to the scene as it was opened or last saved, as one undo step. Returns whether it changed.
    pub fn back_to_start(&mut self) -> bool {
        let saved = self.saved.clone();
        self.edit_once(|scene| *scene = saved)
    }

    /// Writes the scene to a file, which becomes the scene's file, and copies the files that it names beside
    /// it. Returns the names of the copies that were written.
    pub fn save_to(&mut self, path: &Path) -> Result<Vec<String>, String> {
        self.end_gesture();
        let mut document = self.document.clone();
        let copied = copy_files(&mut document.scene, &document.files, path)?;
        document.text = text_of(&runnable(&document))?;
        write_kept(path, document.text.as_bytes())?;
        (document.name, document.source) = (path.display().to_string(), Source::File(path.to_owned()));
        let before = std::mem::replace(&mut document.files, Files::beside(path));
        let mut now = document.scene.clone();
        for step in self.undo.iter_mut().chain(&mut self.redo) {
            let Step::Scene(scene, _) = step else { continue };
            update_names(Arc::make_mut(scene), &before, &mut self.document.scene, &mut now);
        }
        (self.saved, self.named) = (document.scene.clone(), document.scene.clone());
        self.now = Arc::new(document.scene.clone());
        self.document = document;
        Ok(copied)
    }
}

fn runnable(document: &Document) -> Cow<'_, Document> {
    if document.scene.sweep.is_empty() {
        return Cow::Borrowed(document);
    }
    let fields = numeric_fields(&document.scene);
    if document.scene.sweep.iter().all(|axis| fields.contains(&axis.field)) {
        return Cow::Borrowed(document);
    }
    let mut document = document.clone();
    document.scene.sweep.retain(|axis| fields.contains(&axis.field));
    Cow::Owned(document)
}

fn text_of(document: &Document) -> Result<String, String> {
    let text = document.write(&document.scene);
    text.map_err(|error| format!("the scene cannot be written as text: {error}"))
}

/// Moves a start that lies beyond a stop to that stop.
pub(in crate::app) fn keep_start_inside(scene: &mut Scene) {
    let [left, right] = scene.stops.positions_mm();
    let (left, right) = (left.unwrap_or(f64::NEG_INFINITY), right.unwrap_or(f64::INFINITY));
    if let Start::At { x_mm, .. } = &mut scene.start {
        if *x_mm > right {
            *x_mm = right;
        } else if *x_mm < left {
            *x_mm = left;
        }
    }
}

/// Writes a file, and keeps its content where it could not be read again.
fn write_kept(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write_file(path, bytes)?;
    system::files::keep_written(path, bytes);
    Ok(())
}

/// Copies the table and the records of `scene` into the folder of `target`, and renames them in `scene`
/// accordingly. An existing file is used if its content is the same, and is never overwritten. Returns the
/// names of the files written; the error says why one could not be.
fn copy_files(scene: &mut Scene, files: &Files, target: &Path) -> Result<Vec<String>, String> {
    let mut written = Vec::new();
    let target_folder = target.parent().unwrap_or(Path::new(""));
    if files.folder.as_deref().is_some_and(|folder| is_same(folder, target_folder)) {
        return Ok(written);
    }
    let stays = |path: &&mut String| Path::new(path.as_str()).is_absolute() && !files.sealed;
    for path in named_paths(scene).into_iter().filter(|path| !stays(path)) {
        let text = match files.read(path) {
            Err(FileError::Missing { embedded: true, .. }) => Files::default().read(path),
            read => read,
        };
        let text = text.map_err(|error| format!("the scene names a file that cannot be read: {error}"))?;
        let name = free_name(path, &text, target)?;
        if !system::files::exists(&target.with_file_name(&name)) {
            write_kept(&target.with_file_name(&name), text.as_bytes())?;
            written.push(name.clone());
        }
        *path = name;
    }
    Ok(written)
}

/// Updates the file names in a scene of the undo history after a save to another folder: a copied file gets
/// the name of its copy, any other its absolute path. `was` and `now` are the saved scene before and after.
fn update_names(scene: &mut Scene, files: &Files, was: &mut Scene, now: &mut Scene) {
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
        let holds_text = || system::files::bytes(&there).is_ok_and(|bytes| bytes == text.as_bytes());
        there != target && (!system::files::exists(&there) || holds_text())
    };
    let none = || format!("no name is free for `{path}` beside {}", target.display());
    names.take(1000).find(fits).ok_or_else(none)
}

fn is_same(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| {
        system::files::canonical(if path.as_os_str().is_empty() { Path::new(".") } else { path })
    };
    whole(a).is_some_and(|a| whole(b) == Some(a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_of_the_history_is_reached_by_undo_and_redo() {
        let mut editor = Editor::open("paper").unwrap();
        let link = |editor: &Editor| editor.document().link().unwrap();
        let mut links = vec![link(&editor)];
        for mass_g in [11.0, 12.0, 13.0, 14.0] {
            editor.edit_once(|scene| scene.mass_g = mass_g);
            links.push(link(&editor));
        }
        for place in [1, 3, 0, 4, 2, 2] {
            let is_other = link(&editor) != links[place];
            assert_eq!(editor.go_to(&links[place]), is_other);
            assert_eq!(link(&editor), links[place]);
            assert_eq!((editor.undo.len(), editor.redo.len()), (place, 4 - place));
        }
        assert!(!editor.go_to("?scene=harvester"));
        assert_eq!(link(&editor), links[2]);
        // the nearest scene before, and not one that is farther away
        editor.edit_once(|scene| scene.mass_g = 11.0);
        editor.edit_once(|scene| scene.mass_g = 20.0);
        assert!(editor.go_to(&links[1]));
        assert_eq!((editor.undo.len(), editor.redo.len()), (3, 1));
    }
}
