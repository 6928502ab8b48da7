//! `compare`: scenes side by side under one sine, a row each.

use std::sync::Arc;

use clap::Args;
use interwell::dynamics::Model;
use interwell::mechanics::Mechanism;
use interwell::scene::{Document, Excitation, Scene, Start};
use interwell::study::{Alternative, Task, alternatives, comparison_parts, comparison_table};

use super::failure::Failure;
use super::interrupt;
use super::options::Common;
use super::support::{finish, inputs, load, mechanism, open, read, warn, write_table};
use super::sweep::{bar, pool};

const EXAMPLES: &str = "\
Examples:
  interwell --headless compare paper balanced magnet
  interwell --headless compare paper balanced magnet paper-unconstrained --set excitation.amplitude_g=0.8
  interwell --headless compare paper my.ron --environment first-look";

/// What it takes.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene files or built-in scenes; --set changes each of them
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scenes: Vec<String>,

    /// The scene whose excitation, a sine, and run all of them have [default: the first]
    #[arg(long, value_name = "SCENE")]
    pub environment: Option<String>,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// Rates the scenes and writes a row for each.
pub fn run(options: &Arguments) -> Result<(), Failure> {
    let common = &options.common;
    let environment = options.environment.as_deref().or(options.scenes.first().map(String::as_str));
    let environment = read(environment.unwrap_or("paper"), common)?;
    let Excitation::Sine { .. } = environment.scene.excitation else {
        return Err(Failure::argument(format!(
            "{}: its excitation is no Sine; amplitude and frequency of one are searched: name a scene \
             with a Sine first, or by --environment",
            environment.name
        )));
    };
    let (mut all, mut files) = (Vec::new(), Vec::new());
    for spec in &options.scenes {
        let (mut document, warnings) = load(spec, common, None)?;
        document.scene.excitation = environment.scene.excitation.clone();
        document.scene.run = environment.scene.run;
        document.scene.sweep.clear(); // its fields may not be those of another excitation
        document.check()?;
        let mechanism = mechanism(&document)?;
        valid(&document, &mechanism)?;
        warn(&document, common, &warnings, Some(&mechanism));
        files.extend(inputs(spec, &document));
        let Document { scene, files, .. } = document;
        all.push(Alternative { name: plain(spec), scene, files, mechanism });
    }
    let pool = pool(common)?;
    let mut sinks = open(&files, [Some(("--out", common.out()))])?;
    let bar = bar(comparison_parts(&all), "parts", common.quiet, common.out());
    let task = Task { tick: &|| bar.inc(1), cancel: interrupt::listen() };
    let rated = alternatives(&all, &pool, &task);
    bar.finish_and_clear();
    write_table(&mut sinks[0], &comparison_table(&rated.ok_or_else(Failure::interrupted)?))?;
    finish(sinks)
}

/// A name without what would end a cell of CSV.
fn plain(name: &str) -> String {
    name.replace([',', '"', '\n', '\r'], "_")
}

/// The faults of a model from rest, such as of a mechanism with no place to rest.
fn valid(document: &Document, mechanism: &Arc<Mechanism>) -> Result<(), Failure> {
    let trial = Scene { start: Start::Rest, ..document.scene.clone() };
    let built = Model::build(&trial, Arc::clone(mechanism));
    built.map(|_| ()).map_err(|faults| document.error_from(faults).into())
}
