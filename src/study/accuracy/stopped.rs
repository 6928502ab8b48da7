//! Reasons why the study has no result.

/// Why the study has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// It was told to stop.
    #[error("told to stop")]
    Cancelled,
    /// A scene of the study cannot be run: a fault of the program.
    #[error("a scene of the study cannot be run: {0}")]
    Scene(String),
}
