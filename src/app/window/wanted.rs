//! Files that are asked for: what each is wanted for, and how the question was answered.

use std::path::PathBuf;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Open,
    Lesson,
    /// Measured data to be laid over the computed.
    Measured,
    /// The scene.
    Save,
    /// The motion that was seen, as CSV.
    Motion,
    /// The whole run of the scene, as CSV.
    Run,
    /// The events, as CSV.
    Events,
    /// The force curve, as CSV.
    Curve,
    /// The map, as CSV.
    Map,
    /// The window, as PNG.
    Picture,
    Figure,
}

impl Wanted {
    /// What is asked where a path is typed; the kind of the file, and how its name ends.
    pub(super) fn words(self) -> (&'static str, &'static str, &'static str) {
        match self {
            Self::Open => ("Open which scene?", "scene", "ron"),
            Self::Lesson => ("Open which lesson?", "lesson", "ron"),
            Self::Measured => ("Open which measured data?", "measured data", "csv"),
            Self::Save => ("Save the scene to which file?", "scene", "ron"),
            Self::Motion => ("Save the motion that was seen to which file?", "motion", "csv"),
            Self::Run => ("Save the whole run to which file?", "run", "csv"),
            Self::Events => ("Save the events to which file?", "events", "csv"),
            Self::Curve => ("Save the force curve to which file?", "curve", "csv"),
            Self::Map => ("Save the map to which file?", "map", "csv"),
            Self::Picture => ("Save the picture to which file?", "picture", "png"),
            Self::Figure => ("Save the figure to which file?", "figure", "pdf"),
        }
    }

    /// What is then done.
    pub(super) fn verb(self) -> &'static str {
        if self.is_read() { "Open" } else { "Save" }
    }

    /// Whether a file is read and not written.
    pub(super) fn is_read(self) -> bool {
        matches!(self, Self::Open | Self::Lesson | Self::Measured)
    }
}

/// How a question for a file was answered.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Chosen {
    /// By a file.
    File(Wanted, PathBuf),
    /// The desktop has no dialog to offer: the file that it would have begun with.
    NoDialog(Wanted, PathBuf),
}
