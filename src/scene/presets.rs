//! Which scenes come with the program?
//!
//! Each is a file in `presets/` and embedded, with the tables that it names, so that every command works
//! from any folder. The first is what the program opens with.

/// A built-in scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// The name that a command takes.
    pub name: &'static str,
    /// What it is, in one line.
    pub summary: &'static str,
    /// The scene's text.
    pub text: &'static str,
}

/// An embedded table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Table {
    /// The name by which a scene calls it.
    pub name: &'static str,
    /// CSV.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal: $summary:literal;)*) => {
        /// The built-in scenes, in the order of a first walk.
        pub static PRESETS: &[Preset] = &[$(Preset {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../../presets/", $name, ".ron")),
        }),*];
    };
}

presets! {
    "paper": "the prototype: travel limits inside the wells, and the map over limit and shaking";
    "nominal-cubic": "a textbook double well with the prototype's mass; its map has 41 x 101 cells";
    "bouncing-ball": "a ball that comes to rest after infinitely many bounces, at a time known exactly";
    "elastic-box": "a free mass between two perfect stops: nothing is lost, ever";
    "duffing": "the periodically forced double well, with its published period doublings and chaos";
}

/// The embedded tables.
pub static TABLES: &[Table] =
    &[Table { name: "force_dl2.7.csv", text: include_str!("../../assets/force_dl2.7.csv") }];

/// Names of all presets, with commas.
pub(super) fn names() -> String {
    PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ")
}

/// All presets and the tables that they use, as file names and contents, to be written into one folder
/// where each scene then finds its table.
pub fn export() -> Vec<(String, &'static str)> {
    let scenes = PRESETS.iter().map(|preset| (format!("{}.ron", preset.name), preset.text));
    scenes.chain(TABLES.iter().map(|table| (table.name.to_owned(), table.text))).collect()
}
