//! `compare`: scenes side by side under one sine, a row each.

use std::sync::Arc;

use clap::Args;
use interwell::dynamics::{Model, Regime};
use interwell::mechanics::Mechanism;
use interwell::numeric::short;
use interwell::output::{ComparisonPicture, comparison_figure};
use interwell::scene::{Document, Excitation, Scene, Start};
use interwell::study::{Alternative, Rated, Task, alternatives, comparison_parts, comparison_table};

use super::failure::Failure;
use super::interrupt;
use super::options::{Common, PlotOptions};
use super::picture::{Picture, caption};
use super::say;
use super::support::{finish, inputs, load, mechanism, open, read, warn, write_table};
use super::sweep::{bar, pool};

const EXAMPLES: &str = "\
Examples:
  interwell --headless compare paper balanced magnet
  interwell --headless compare paper balanced magnet paper-unconstrained --set excitation.amplitude_g=0.8
  interwell --headless compare paper my.ron --environment first-look
  interwell --headless compare paper balanced magnet paper-unconstrained --plot alternatives.pdf \\
      --plot-width-mm 170 --no-title";

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

    /// The picture: a row a scene, a panel a quantity.
    #[command(flatten)]
    pub plot: PlotOptions,

    /// What every command takes.
    #[command(flatten)]
    pub common: Common,
}

/// Rates the scenes and writes a row for each.
pub fn run(options: &Arguments) -> Result<(), Failure> {
    let common = &options.common;
    let picture = Picture::asked(&options.plot, common)?;
    let environment = options.environment.as_deref().or(options.scenes.first().map(String::as_str));
    let environment = read(environment.unwrap_or("paper"), common)?;
    let Excitation::Sine { frequency_hz, amplitude_g, .. } = environment.scene.excitation else {
        return Err(Failure::argument(format!(
            "{}: its excitation is no Sine; amplitude and frequency of one are searched: name a scene \
             with a Sine first, or by --environment",
            environment.name
        )));
    };
    let (mut all, mut files, mut shaken) = (Vec::new(), Vec::new(), Vec::new());
    for spec in &options.scenes {
        let (mut document, warnings) = load(spec, common, None)?;
        let own = (&document.scene.excitation, document.scene.run);
        if own != (&environment.scene.excitation, environment.scene.run) {
            shaken.push(plain(spec));
        }
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
    if !common.quiet {
        if let [only] = &options.scenes[..] {
            say(&format!("{only}: the only scene; name others to set beside it"));
        }
        if !shaken.is_empty() {
            let names = shaken.join(", ");
            say(&format!("{names}: under the excitation and with the run of {}", environment.name));
        }
    }
    let pool = pool(common)?;
    let [plot, data] = Picture::outputs(picture);
    let mut sinks = open(&files, [Some(("--out", common.out())), plot, data])?;
    let bar = bar(comparison_parts(&all), "parts", common.quiet, common.out());
    let task = Task { tick: &|| bar.inc(1), cancel: interrupt::listen() };
    let rated = alternatives(&all, &pool, &task);
    bar.finish_and_clear();
    let rated = rated.ok_or_else(Failure::interrupted)?;
    write_table(&mut sinks[0], &comparison_table(&rated))?;
    if !common.quiet {
        let remarks = all.iter().zip(&rated).flat_map(|(own, rated)| remarks(own, rated, amplitude_g));
        remarks.for_each(|words| say(&words));
    }
    if let Some(picture) = picture {
        let mut caption = caption(&environment);
        let count = rated.len();
        let (shaking, at) = (short(amplitude_g), short(frequency_hz));
        caption.title = format!("{count} scenes under a sine of {shaking} g at {at} Hz");
        let shown = ComparisonPicture { rated: &rated, frequency_hz };
        picture.write(&mut sinks[1..3], comparison_figure(&shown, &caption, &picture.theme))?;
    }
    finish(sinks)
}

/// What empty or infinite cells of a row mean, and a speed of 0.
fn remarks(own: &Alternative, rated: &Rated, amplitude_g: f64) -> Vec<String> {
    let name = &rated.name;
    let mut all = Vec::new();
    if rated.summary.regime == Regime::Rest {
        all.push(format!("{name}: {} g does not move it", short(amplitude_g)));
    }
    if own.mechanism.landscape.barrier.is_none() {
        all.push(format!("{name}: no barrier between two wells, so nothing to cross"));
    } else if rated.crossing_g.is_none() {
        all.push(format!("{name}: no amplitude that was tried makes its settled motion cross"));
    }
    if let Some((_, size)) = rated.sensitivity.as_ref().filter(|own| own.0.is_infinite()) {
        all.push(format!("{name}: with {size} changed by 1 % nothing is left to cross, or nothing crosses"));
    }
    all
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
