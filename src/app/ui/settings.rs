//! What does a person want of the window, whatever the scene?

/// Kept between two starts of the program.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Dark ground.
    pub dark: bool,
    /// Light ground, larger, thicker lines.
    pub projector: bool,
    /// No rings at impacts.
    pub reduce_motion: bool,
}
