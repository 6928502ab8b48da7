//! The tests of the library and of the command line; each module holds one kind of evidence.

mod absent;
mod accuracy;
mod accuracy_scene;
mod basins;
mod best;
#[path = "../../benches/by_hand/mod.rs"]
mod by_hand;
mod cli;
mod compliant;
mod convergence;
mod documents;
mod drives;
mod escape;
mod examples;
mod exponents;
mod impacts;
mod lanes;
mod layers;
mod lesson_format;
mod lessons;
mod live;
mod measured;
mod mechanics;
mod notes;
mod oracles;
mod orbit;
mod plots;
mod presets;
mod properties;
mod questions;
mod recurrence;
mod scene;
mod section;
#[path = "../shared/mod.rs"]
mod shared;
mod source_text;
mod spectrum;
mod stroboscopic;
mod studies;
mod support;
mod transducer;
mod uncertain;
mod untrusted;
mod up_and_down;
mod verdicts;
