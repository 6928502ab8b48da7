//! What a person writes: scenes, their checks, their files, the presets.

mod data;

pub use data::*;

/// One thing that is wrong with a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Fault {
    /// Dotted path of the field, without variant names: `stops.travel_limit_mm`.
    pub field: String,
    /// The value as written.
    pub value: String,
    /// What is wrong with it and what would be right.
    pub problem: String,
}

/// Where the files that a scene names are read from: the folder of the scene file, or, for a preset
/// or a pasted scene, the embedded names (and absolute paths).
#[derive(Debug, Clone, Default)]
pub struct Files {
    /// Folder that relative paths start from; none for a preset or a pasted scene.
    pub folder: Option<std::path::PathBuf>,
}
