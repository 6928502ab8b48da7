//! One test binary; each module holds one kind of evidence.

mod cli;
mod convergence;
mod impacts;
mod layers;
mod mechanics;
mod oracles;
mod presets;
mod scene;
mod studies;
mod support;
