//! Steps that several commands share: loading a scene, building its mechanism and its model, reading numbers.

use std::path::PathBuf;
use std::sync::Arc;

use interwell::mechanics::Mechanism;
use interwell::output::{Provenance, is_regular};
use interwell::questions::{Error, Grid, Simulation};
use interwell::scene::{Document, SceneError, read_number};
use interwell::system::clock::{ProcessClock, WallClock};
use interwell::system::threads::Pool;
pub use interwell_studies::study::counted;

use super::{Common, Failure, Outputs, interrupt, refuse};

/// Wall-clock and CPU time since a command began its work.
#[derive(Debug, Clone, Copy)]
pub struct Watch {
    wall: WallClock,
    cpu: ProcessClock,
}

impl Watch {
    pub fn start() -> Self {
        Self { wall: WallClock::start(), cpu: ProcessClock::start() }
    }

    pub fn wall_s(&self) -> f64 {
        self.wall.seconds()
    }

    /// Version, arguments and times of this call of the program, which uses `jobs` threads.
    pub fn origin(&self, jobs: usize) -> Provenance {
        Provenance {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            arguments: arguments(),
            wall_s: self.wall_s(),
            cpu_s: self.cpu.seconds(),
            jobs,
        }
    }
}

/// The arguments of this call of the program.
pub fn arguments() -> Vec<String> {
    std::env::args_os().skip(1).map(|argument| argument.to_string_lossy().into_owned()).collect()
}

/// Loads the scene called `spec`, applies `--set` and `--tolerance`, checks it, and returns it with its
/// warnings.
pub fn load(spec: &str, common: &Common) -> Result<(Document, Vec<String>), SceneError> {
    let mut document = read(spec, common)?;
    let warnings = check(&mut document, None)?;
    Ok((document, warnings))
}

/// Loads the scene with its grid: the values of the fields of `--over`, or without `--over` the scene alone,
/// whose sweep is ignored. `prepare` changes the scene before it is checked.
pub fn load_over(
    spec: &str,
    over: &[String],
    prepare: impl FnOnce(&mut Document) -> Result<(), Error>,
    common: &Common,
) -> Result<(Document, Vec<String>, Grid), Failure> {
    let (mut document, is_one) = (read(spec, common)?, over.is_empty());
    prepare(&mut document)?;
    let warnings = check(&mut document, (!is_one).then_some(over))?;
    let grid = if is_one { Grid::of_one() } else { Grid::new(document.axes(over)?)? };
    Ok((document, warnings, grid))
}

/// Checks a document that was read; returns its warnings. With the arguments of `--over` its first cell is
/// checked, since the scene's own values of the swept fields are never run.
pub fn check(document: &mut Document, over: Option<&[String]>) -> Result<Vec<String>, SceneError> {
    let moved = document.settle_within();
    let mut first_cell = document.clone();
    for axis in over.map_or(Ok(Vec::new()), |over| document.axes(over))? {
        axis.apply(&mut first_cell.scene, 0);
    }
    Ok(moved.into_iter().chain(first_cell.check()?).collect())
}

/// Loads the scene without checking it. It keeps the bytes of its files if the rows get a manifest.
pub fn read(spec: &str, common: &Common) -> Result<Document, SceneError> {
    let mut document = Document::of_argument(spec)?;
    change(&mut document, common)?;
    Ok(document)
}

/// Applies `--set` and `--tolerance` to a scene that was read.
pub fn change(document: &mut Document, common: &Common) -> Result<(), SceneError> {
    for argument in &common.set {
        document.set(argument)?;
    }
    if let Some(tolerance) = &common.tolerance {
        document.assign("run.tolerance", tolerance, &format!("--tolerance {tolerance}"))?;
    }
    if is_regular(common.out()) {
        document.cache_files();
    }
    Ok(())
}

/// The files that a scene is read from: its file and the files that it names.
pub fn inputs(spec: &str, document: &Document) -> Vec<PathBuf> {
    let mut inputs = document.named_files();
    inputs.push(spec.into());
    inputs
}

/// The outputs of a command that reads one scene, with its rows open.
pub fn outputs(spec: &str, document: &Document, common: &Common) -> Result<Outputs, Failure> {
    Outputs::new(&inputs(spec, document)).with_rows(Some(common.out()))
}

pub fn mechanism(document: &Document) -> Result<Arc<Mechanism>, Failure> {
    let built = Mechanism::build(&document.scene.mechanism, &document.files);
    built.map(Arc::new).map_err(|error| Error::unbuilt(document, error).into())
}

/// The mechanism of all cells of a grid, `None` if they have different ones; prints the warnings.
pub fn mechanism_of_all(
    document: &Document,
    grid: &Grid,
    common: &Common,
    warnings: &[String],
) -> Result<Option<Arc<Mechanism>>, Failure> {
    let mechanism = (!grid.changes_mechanism()).then(|| mechanism(document)).transpose()?;
    warn(document, common, warnings, mechanism.as_deref());
    Ok(mechanism)
}

/// Loads the scene and its mechanism and prints the warnings of both.
pub fn load_with_mechanism(spec: &str, common: &Common) -> Result<(Document, Arc<Mechanism>), Failure> {
    let (document, warnings) = load(spec, common)?;
    let mechanism = mechanism(&document)?;
    warn(&document, common, &warnings, Some(&mechanism));
    Ok((document, mechanism))
}

/// Loads the scene and builds its model; prints the warnings of both.
pub fn load_simulation(spec: &str, common: &Common) -> Result<Simulation, Failure> {
    simulation(&read(spec, common)?, common)
}

/// The simulation of a scene that is drawn beside another one, which no `--set` changes.
pub fn beside(spec: &str) -> Result<Simulation, Failure> {
    let document = Document::of_argument(spec).map_err(Error::Scene);
    let built = document.and_then(|document| Simulation::build(document, &interrupt::progress()));
    built.map_err(|error| match error {
        Error::Scene(error) => Failure::argument(format!("--beside {error}")),
        error => error.into(),
    })
}

/// Checks a scene and builds its model; prints the warnings of both.
pub fn simulation(document: &Document, common: &Common) -> Result<Simulation, Failure> {
    let simulation = Simulation::new(document)?;
    simulation.warnings().for_each(|warning| common.say(&format!("warning: {warning}")));
    Ok(simulation)
}

/// Prints the warnings of a scene and of its mechanism, unless `--quiet` is given.
pub fn warn(document: &Document, common: &Common, warnings: &[String], mechanism: Option<&Mechanism>) {
    warnings.iter().for_each(|warning| common.say(&format!("warning: {warning}")));
    let of_tables = mechanism.into_iter().flat_map(Mechanism::warnings);
    of_tables.for_each(|warning| common.say(&format!("warning: {}: {warning}", document.name)));
}

/// The numbers of `A,B,C` as given to `option`, each plain or as arithmetic. NaN and infinities are accepted;
/// the caller must check them.
pub fn numbers(option: &str, text: &str, separator: char) -> Result<Vec<f64>, Failure> {
    let wrong = |problem| Failure::argument(format!("{option} {text}: {problem}"));
    text.split(separator).map(|part| read_number(part).map_err(wrong)).collect()
}

/// The number in `text`, plain or as arithmetic, as given to `option`; an error with this remedy if it is no
/// number that `fits`.
pub fn number(
    option: &str,
    text: &str,
    fits: impl FnOnce(&f64) -> bool,
    remedy: &str,
) -> Result<f64, Failure> {
    let number = read_number(text).ok().filter(fits);
    number.ok_or_else(|| Failure::argument(format!("{option} {text}: {remedy}")))
}

/// The finite number in `text`, as given to `option`.
pub fn finite(option: &str, text: &str, remedy: &str) -> Result<f64, Failure> {
    number(option, text, |value| value.is_finite(), remedy)
}

/// The finite number that was given to `option`, if any.
pub fn if_given(option: &str, text: Option<&str>, remedy: &str) -> Result<Option<f64>, Failure> {
    text.map(|text| finite(option, text, remedy)).transpose()
}

/// The range `A:B` as given to `option`; an error that says what to write if it is none.
pub fn range(option: &str, text: &str, form: &str) -> Result<(f64, f64), Failure> {
    match numbers(option, text, ':')?[..] {
        [from, to] if from < to && from.is_finite() && to.is_finite() => Ok((from, to)),
        _ => refuse!("{option} {text}: write {form}"),
    }
}

/// The time in s of `--until-settled`, if given.
pub fn settle_limit(text: Option<&str>) -> Result<Option<f64>, Failure> {
    if_given("--until-settled", text, "not a time; give seconds, such as 300")
}

/// The pool of `--jobs` threads.
pub fn pool(common: &Common) -> Result<Pool, Failure> {
    Pool::new(common.jobs()).map_err(|error| Failure::Failed(error.into()))
}
