//! Settings of the window, independent of the scene.

/// Settings that are kept between two starts of the program.
#[derive(Debug, Clone, Copy, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default)]
pub struct Settings {
    pub dark: bool,
    /// Light ground, larger, thicker lines.
    pub projector: bool,
    /// No rings at impacts.
    pub reduce_motion: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Setting {
    Dark,
    Projector,
    ReduceMotion,
}

impl Settings {
    /// The value of a setting, to be changed.
    pub fn of(&mut self, setting: Setting) -> &mut bool {
        match setting {
            Setting::Dark => &mut self.dark,
            Setting::Projector => &mut self.projector,
            Setting::ReduceMotion => &mut self.reduce_motion,
        }
    }
}
