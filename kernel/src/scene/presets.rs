//! Built-in scenes and their tables.
//!
//! Each scene is a file in `presets/` that is embedded with the tables that it names, so that every command
//! works from any folder. The program opens with the first one.

/// A built-in scene, which [`Document::preset`](super::Document::preset) reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Preset {
    /// The name that a command takes.
    pub name: &'static str,
    /// One line that describes it.
    pub summary: &'static str,
    /// The scene's text.
    pub text: &'static str,
}

/// A built-in table or record, which a built-in scene, or one from a text, names as its path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EmbeddedTable {
    /// The name that a scene gives as its path.
    pub name: &'static str,
    /// The text, in CSV.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal: $summary:literal;)*) => {
        /// The built-in scenes, in the order in which a beginner should look at them.
        pub static PRESETS: &[Preset] = &[$(Preset {
            name: $name,
            summary: $summary,
            text: include_str!(concat!("../../presets/", $name, ".ron")),
        }),*];
    };
}

presets! {
    "first-look": "what the window opens on: the prototype without stops, shaken too weakly to cross";
    "paper": "the prototype: travel limits inside the wells, and the map over limit and shaking";
    "paper-table": "the prototype with its force from an independent three-dimensional model of the flexures";
    "paper-unconstrained": "the prototype without stops: stays in its well at 1 g, crosses above 1.15 g";
    "paper-ramp": "the prototype, shaken from 0 to 2 g in five minutes: when it frees, when it crosses";
    "uneven-stops": "the prototype between unequal stops: two different rebounds, and two thresholds";
    "walking": "the prototype carried by a walking person: crosses in every step with stops at 0.6 mm";
    "random-shaking": "the prototype under noise: crosses with stops at 1 mm, and not without stops";
    "balanced": "the prototype with a spring in place of stops that leaves an equally low barrier";
    "magnet": "the same with two magnets in place of the spring: crosses from 0.14 g";
    "harvester": "the prototype with a coil and a load: the power, and the load that takes most of it";
    "nominal-cubic": "a textbook double well with the prototype's mass; its map has 41 x 101 cells";
    "monostable": "one well for comparison: nothing to cross, and no least shaking";
    "bouncing-ball": "a ball that comes to rest after infinitely many bounces, at an exactly known time";
    "elastic-box": "a free mass between two perfect stops: no energy is lost";
    "duffing": "the periodically forced double well, with its published periods: 1, 2, 4, 5, chaos, 2";
    "duffing-chaos": "the same double well where no period is found: chaos, and averages that hold";
    "duffing-cascade": "the double well with more damping: periods 1, 2, 4, 8 and chaos, all in one well";
    "period-adding": "the well of duffing just touching a stop: one impact in 6, 5, 4, 3, 2, 1 periods";
    "impact-oscillator": "a linear spring and one stop: where a swing first touches it, and what follows";
}

/// The embedded tables and records.
pub static TABLES: &[EmbeddedTable] = &[
    EmbeddedTable { name: "force_dl2.7.csv", text: include_str!("../../assets/force_dl2.7.csv") },
    EmbeddedTable { name: "walking.csv", text: include_str!("../../assets/walking.csv") },
];

pub(super) fn names() -> String {
    PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ")
}

/// File names and contents of all presets and their tables. In one folder each scene finds its table.
#[doc(hidden)]
pub fn export() -> Vec<(String, &'static str)> {
    let scenes = PRESETS.iter().map(|preset| (format!("{}.ron", preset.name), preset.text));
    scenes.chain(TABLES.iter().map(|table| (table.name.to_owned(), table.text))).collect()
}
