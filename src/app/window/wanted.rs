//! Purposes of the files that the user chooses, and answers of the file dialog.

use std::path::PathBuf;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Open,
    Lesson,
    /// Measured data, to be drawn over the computed motion or curve.
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
    /// The question where a path is typed, the kind of file, and its extension.
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

    /// Label of the button that confirms the choice.
    pub(super) fn verb(self) -> &'static str {
        if self.is_read() { "Open" } else { "Save" }
    }

    /// Whether the file is read, not written.
    pub(super) fn is_read(self) -> bool {
        matches!(self, Self::Open | Self::Lesson | Self::Measured)
    }
}

/// The answer of a file dialog.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Chosen {
    /// The chosen file.
    File(Wanted, PathBuf),
    /// The desktop has no dialog; the path that it would have suggested.
    NoDialog(Wanted, PathBuf),
}
