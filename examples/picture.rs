//! A run over time as a picture: displacement and phase portrait of its last second.
//!
//! `cargo run --example picture` writes run.svg.

use interwell::output::{Caption, Chart, Format, Ranges, RunPanel, RunPicture, Theme};
use interwell::{Error, Progress, Simulation};

/// The panels from 9 to 10 s.
pub fn chart(simulation: &Simulation) -> Result<Chart, Error> {
    let picture = RunPicture {
        panels: vec![RunPanel::Displacement, RunPanel::Portrait],
        ranges: Ranges { x: Some((9.0, 10.0)), y: None },
        ..RunPicture::default()
    };
    picture.chart(simulation, &Progress::none())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let simulation = Simulation::preset("nominal-cubic")?;
    let caption = Caption::new(simulation.document(), env!("CARGO_PKG_VERSION"));
    let figure = chart(&simulation)?.figure(&caption, &Theme::LIGHT);
    Ok(std::fs::write("run.svg", Format::Svg.bytes(&figure)?)?)
}
