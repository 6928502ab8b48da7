//! One test binary; each module holds one kind of evidence.

mod absent;
mod accuracy;
#[path = "../../benches/by_hand/mod.rs"]
mod by_hand;
mod cli;
mod compliant;
mod convergence;
mod drives;
mod impacts;
mod layers;
mod live;
mod mechanics;
mod oracles;
mod plots;
mod presets;
mod properties;
mod scene;
mod studies;
mod support;
