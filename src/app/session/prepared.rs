//! Scenes, mechanisms and models in questions: shared within the program, and written in messages as the data
//! from which they are built.

use std::collections::BTreeMap;
use std::ops::Deref;
use std::sync::{Arc, Mutex, PoisonError};

use serde::{Deserialize, Serialize};

use crate::app::task::Identity;
use crate::dynamics::{Beginning, Model};
use crate::mechanics::Mechanism;
use crate::questions::Simulation;
use crate::scene::{self, Document, Fault, Files, Scene, named_texts, read_records};

/// A scene with the files that it names, which is compared by the scene and written with their texts.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(from = "WithTexts", into = "WithTexts")]
pub struct SceneWithFiles {
    /// Its name in messages.
    name: String,
    pub scene: Arc<Scene>,
    pub files: Files,
}

#[derive(Serialize, Deserialize)]
struct WithTexts {
    name: String,
    #[serde(with = "crate::app::task::as_text")]
    scene: Scene,
    texts: BTreeMap<String, String>,
}

impl From<SceneWithFiles> for WithTexts {
    fn from(SceneWithFiles { name, scene, files }: SceneWithFiles) -> Self {
        Self { name, texts: named_texts(&scene, &files), scene: Arc::unwrap_or_clone(scene) }
    }
}

impl From<WithTexts> for SceneWithFiles {
    fn from(WithTexts { name, mut scene, texts }: WithTexts) -> Self {
        let files = Files { cached: texts, ..Files::default() };
        read_records(&mut scene, &files);
        Self { name, scene: scene.into(), files }
    }
}

impl SceneWithFiles {
    /// A scene made from that of a document, with its name and its files.
    pub fn of(document: &Document, scene: impl Into<Arc<Scene>>) -> Self {
        Self { name: document.name.clone(), scene: scene.into(), files: document.files.clone() }
    }

    /// The document of the scene, as questions take it.
    pub fn document(&self) -> Document {
        let mut document = Document::of_scene(Scene::clone(&self.scene), self.files.clone());
        document.name.clone_from(&self.name);
        document
    }
}

impl PartialEq for SceneWithFiles {
    fn eq(&self, other: &Self) -> bool {
        self.scene == other.scene
    }
}

impl Deref for SceneWithFiles {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.scene
    }
}

/// A scene with its mechanism, which is compared by the scene and written with the tolerance of its flexures.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "(SceneWithFiles, f64)", into = "(SceneWithFiles, f64)")]
pub struct Prepared {
    pub of: SceneWithFiles,
    pub mechanism: Arc<Mechanism>,
    pub tolerance: f64,
}

impl From<Prepared> for (SceneWithFiles, f64) {
    fn from(Prepared { of, tolerance, .. }: Prepared) -> Self {
        (of, tolerance)
    }
}

impl TryFrom<(SceneWithFiles, f64)> for Prepared {
    type Error = String;

    fn try_from((of, tolerance): (SceneWithFiles, f64)) -> Result<Self, String> {
        Ok(Self { mechanism: solved(&of, tolerance)?, of, tolerance })
    }
}

/// Number of mechanisms that a worker keeps.
const KEPT: usize = 4;

/// What a mechanism was built from, and the mechanism.
type Kept = (scene::Mechanism, Files, f64, Arc<Mechanism>);

/// The mechanism of a scene that has come as text, taken from an earlier question if that had the same.
fn solved(of: &SceneWithFiles, tolerance: f64) -> Result<Arc<Mechanism>, String> {
    static SOLVED: Mutex<Vec<Kept>> = Mutex::new(Vec::new());
    let mut solved = SOLVED.lock().unwrap_or_else(PoisonError::into_inner);
    let is_same = |kept: &&Kept| (&kept.0, &kept.1, kept.2) == (&of.scene.mechanism, &of.files, tolerance);
    if let Some(kept) = solved.iter().find(is_same) {
        return Ok(Arc::clone(&kept.3));
    }
    let built = Mechanism::build_with(&of.mechanism, &of.files, tolerance, None);
    let built = Arc::new(built.map_err(|error| error.to_string())?);
    solved.truncate(KEPT - 1);
    solved.insert(0, (of.mechanism.clone(), of.files.clone(), tolerance, Arc::clone(&built)));
    Ok(built)
}

impl PartialEq for Prepared {
    fn eq(&self, other: &Self) -> bool {
        self.of == other.of
    }
}

/// The model of a scene, from its start or from a present state, which is compared by its address and written
/// with the state.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(try_from = "(Arc<Prepared>, Beginning)", into = "(Arc<Prepared>, Beginning)")]
pub struct SharedModel {
    pub model: Identity<Model>,
    of: Arc<Prepared>,
}

impl SharedModel {
    pub fn new(model: Model, of: Prepared) -> Self {
        Self { model: Identity(Arc::new(model)), of: Arc::new(of) }
    }

    /// The scene of this model.
    pub fn scene(&self) -> &Scene {
        &self.of.of.scene
    }

    /// The scene with this model, as questions take it.
    pub fn simulation(&self) -> Simulation {
        Simulation::of_model(self.of.of.document(), (**self).clone())
    }

    /// The model that continues a motion of this one, or this one without it.
    pub fn or(&self, continued: Option<Model>) -> Self {
        let model = Identity(Arc::new(continued.unwrap_or_else(|| (**self).clone())));
        Self { model, of: Arc::clone(&self.of) }
    }
}

impl From<SharedModel> for (Arc<Prepared>, Beginning) {
    fn from(SharedModel { model, of }: SharedModel) -> Self {
        (of, model.beginning())
    }
}

impl TryFrom<(Arc<Prepared>, Beginning)> for SharedModel {
    type Error = String;

    fn try_from((of, beginning): (Arc<Prepared>, Beginning)) -> Result<Self, String> {
        let built = Model::build(&of.of, Arc::clone(&of.mechanism));
        let first =
            |faults: Vec<Fault>| faults.into_iter().next().map_or_else(String::new, |fault| fault.problem);
        Ok(Self { model: Identity(Arc::new(built.map_err(first)?.begun_at(&beginning))), of })
    }
}

impl PartialEq for SharedModel {
    fn eq(&self, other: &Self) -> bool {
        self.model == other.model
    }
}

impl Deref for SharedModel {
    type Target = Model;

    fn deref(&self) -> &Model {
        &self.model
    }
}
