//! Lyapunov exponents of a settled motion: rates in 1/s at which small perturbations grow or decay.
//!
//! If the motion repeats, they are ln|multiplier| / period of the periodic orbit, which Newton's method
//! finds. Otherwise they are averages over forcing periods (Benettin et al. 1980): a perturbation is mapped
//! by the derivatives of the stroboscopic map, which include those of impacts (Müller 1995), and is
//! normalised once per period, and a second one is kept normal to it. The map of the phase plane has two
//! exponents, beside a circuit three; that of the driven system along the trajectory, which is 0, is not
//! among them.
//!
//! Their sum has an exact value, since only damping, circuit and impacts contract volumes: -c/m - d, d the
//! rate at which the circuit decays, + 2 ln(restitution) times the rate of impacts, summed over the stops.
//! The last exponent is computed as this sum minus the others, so that it is accurate even if it is much
//! smaller. A rest on a stop removes every perturbation except those of a circuit; all exponents, or all but
//! one, are then minus infinity.

mod average;
mod chart;
mod orbit;
mod tangent;

use std::ops::RangeInclusive;
use std::sync::atomic::AtomicBool;

use clap::Args;
use serde::{Deserialize, Serialize};

use crate::dynamics::{MapState, Model, Outcome, Request, Run};
use crate::numeric::elementary;
use crate::output::{NoPicture, can_show_over_field};
use crate::questions::{Error, Progress, Simulation, check_until, settles};
use crate::scene::{Axis, Document, Fault, Scene, Transducer};
use crate::study::grid_study::fields;
use crate::study::settled::PATIENCE;
use crate::study::walk::without_a_period;
use crate::study::{
    Answered, Cell, Grid, GridStudy, Heading, Over, Question, Row, Scenes, Streamed, Study, Table, Tally,
    counted, followed_until, number, study_methods, whole,
};
use average::average;
pub use average::average_exponents;
use orbit::of_orbit;
use tangent::Tangent;

/// Lyapunov exponents of the settled motion, with their standard errors, sum and dimension.
///
/// The rates in 1/s at which small perturbations grow or decay.
///
/// # Method
///
/// Of a motion that repeats, ln|multiplier| over its period; otherwise averages over
/// `periods`, 1 to 1e7 (Benettin et al. 1980), through impacts by saltation (Müller 1995), with
/// standard errors by batch means (Flegal and Jones 2010). More periods cost more and reduce these errors.
///
/// # Errors
///
/// [`Error::Argument`] for wrong fields, `periods` or `until_settled`; [`Error::Scene`], in a grid
/// [`Error::Cells`], if the drive changes and does not repeat; [`Error::Failed`] if the motion ends early or
/// touches a stop without speed (in a grid the values of that cell are missing).
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Exponents, Progress, Simulation};
///
/// // Inside one well the exponents add up to -c/m, here -2 ratio sqrt(stiffness / mass).
/// let simulation = Simulation::preset("nominal-cubic")?.with("stops", "None")?;
/// let weak = simulation.with("excitation.amplitude_g", 0.2)?;
/// let table = Exponents::default().run(&weak, &Progress::none())?;
/// let sum = table.numbers("sum_per_s").unwrap()[0];
/// assert!((sum + 2.0 * 0.023 * (80.0_f64 / 15.2e-3).sqrt()).abs() < 1e-6);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Args, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Exponents {
    /// The fields, the slowest first; if there are none, the exponents are those of the scene.
    #[arg(skip)]
    pub over: Over,
    /// Forcing periods over which a motion that does not repeat is averaged, 1 to 10000000; without a drive
    /// periods of small oscillations
    #[arg(long, value_name = "N", allow_hyphen_values = true, default_value_t = ExponentOptions::PERIODS)]
    #[arg(value_parser = whole::<u32>(1..=10_000_000))]
    pub periods: u32,
    /// Follow the motion, window after window, until it repeats, or up to this time in s, before anything
    /// is averaged [default: 1000 forcing periods after the scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    #[arg(value_parser = number("not a time; give seconds, such as 300"))]
    pub until_settled: Option<f64>,
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless exponents duffing-chaos
  interwell --headless exponents paper-unconstrained --set excitation.amplitude_g=1.3 --periods 10000
  interwell --headless exponents duffing --over excitation.amplitude_g=0.02:0.068:0.0005 --plot e.png
  interwell --headless exponents paper --over stops.travel_limit_mm=3:7:1 --over stops.restitution=0.3,0.9

A rest on a stop ends every dependence on the earlier motion: all exponents are then minus infinity, -inf.";

const AVERAGED: RangeInclusive<u32> = 1..=10_000_000;

impl Default for Exponents {
    fn default() -> Self {
        Self { over: Vec::new(), periods: ExponentOptions::PERIODS, until_settled: None }
    }
}

study_methods!(Exponents);

impl Study for Exponents {
    const NAME: &'static str = "exponents";
    const SCENE: &'static str = "Scene file or built-in scene; its drive has a period, or there is none";
    const PARTS: &'static str = "cells";
    const PYTHON: &'static str = "\
>>> weak = scene.set(stops=\"None\", excitation={\"amplitude_g\": 0.2})
>>> weak.exponents()[\"sum_per_s\"].round(3)
array([-3.337])";

    fn over(&self) -> &Over {
        &self.over
    }

    fn check(&self, _: &Scenes) -> Result<(), Error> {
        match AVERAGED.contains(&self.periods) {
            true => Ok(()),
            false => Err(Error::argument("periods", self.periods, format!("give 1 to {}", AVERAGED.end()))),
        }
    }

    /// The exponents of the scene alone.
    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let (model, document) = (scenes.model()?, scenes.document);
        let found = self.of_model(&model, document, progress)?;
        Ok(Answered::new(found.table()).told([found.describe(model.repeats())]))
    }

    fn streamed(&self, scenes: &Scenes, progress: &Progress) -> Result<Option<Streamed>, Error> {
        if scenes.grid.axes().is_empty() {
            return Ok(None);
        }
        let (document, grid, scene) = (scenes.document, scenes.grid.clone(), scenes.scene().clone());
        let circuits = may_have_circuit(document, grid.axes());
        let study = GridStudy::new(&document.scene, &document.files, grid.clone());
        let study = study.with(ExponentOptions { circuits, ..self.options() });
        Ok(Some(Streamed {
            rows: Box::new(settles(study, self.until_settled, document, progress)?),
            remark: described,
            manifest: |manifest, grid, tally| manifest.of_exponents(grid, tally),
            chart: Box::new(move |rows, framing| Ok(chart::chart(rows, &grid, &scene, framing.ranges))),
        }))
    }

    fn can_draw(&self, grid: &Grid) -> Result<(), NoPicture> {
        can_show_over_field(grid, "exponents")
    }

    fn columns() -> Vec<Vec<Heading>> {
        Vec::new()
    }
}

impl Exponents {
    /// The exponents of the scene itself, whatever `over` says, and how they were computed.
    pub fn of_one(&self, simulation: &Simulation, progress: &Progress) -> Result<Lyapunov, Error> {
        self.of_model(simulation.model(), simulation.document(), progress)
    }

    fn of_model(&self, model: &Model, document: &Document, progress: &Progress) -> Result<Lyapunov, Error> {
        if let Some(fault) = drive_fault(model, &document.scene) {
            return Err(Error::faults_of(document, vec![fault]));
        }
        check_until(self.until_settled, document, model)?;
        exponents(model, &self.options(), progress.stop()).map_err(|problem| match problem {
            NoExponents::Cancelled => Error::Cancelled,
            _ => Error::failed(document, problem),
        })
    }

    fn options(&self) -> ExponentOptions {
        ExponentOptions { periods: self.periods, until_settled: self.until_settled, circuits: false }
    }
}

/// The number of cells, and of those without exponents.
fn described(tally: &Tally, _: usize, seconds: f64) -> String {
    let mut text = format!("{} in {seconds:.2} s", counted(tally.cells, "cell"));
    if tally.resting > 0 {
        text += &format!(", {} with a rest on a stop, so that all exponents are -inf", tally.resting);
    }
    if tally.without_exponents > 0 {
        text += &format!(
            ", {} without exponents (the motion ended early, touched a stop without speed, or the flexures \
             have no solution)",
            tally.without_exponents
        );
    }
    text
}

/// Number of forcing periods of a window in which a repetition after up to 12 of them is recognised.
const WINDOW: f64 = 36.0;

/// The exponents of the settled motion of `model`.
///
/// The run continues window by window until the motion repeats, or up to the time in the options. If it
/// repeats, the exponents are those of the periodic orbit; otherwise they are averages over the periods that
/// follow. Without a drive the motion is followed for 1000 periods of small oscillations.
pub fn exponents(
    model: &Model,
    options: &ExponentOptions,
    cancel: &AtomicBool,
) -> Result<Lyapunov, NoExponents> {
    let (run, until_settled) = match model.forcing_period().filter(|_| model.repeats()) {
        Some(period) => {
            let window = (model.duration() - model.settle()).max(WINDOW * period);
            let until = options.until_settled.unwrap_or(followed_until(model));
            (model.with_duration(model.settle() + window, model.settle()), Some(until))
        }
        None if model.excitation().is_constant() => {
            let end = model.duration() + f64::from(PATIENCE) * model.natural_time();
            (model.with_duration(end, end), None)
        }
        None => return Err(NoExponents::NoPeriod),
    };
    let summary = run.run(&Request { cancel: Some(cancel), until_settled, ..Request::default() }).summary;
    match summary.outcome {
        Outcome::Done => {}
        Outcome::Cancelled { .. } => return Err(NoExponents::Cancelled),
        other => return Err(NoExponents::EndedEarly(other)),
    }
    let electrical = summary.final_electrical;
    let state = MapState { x: summary.final_x, v: summary.final_v, electrical };
    let phase = model.drive_phase(summary.window.1).unwrap_or(0.0);
    let tangent = Tangent::of(model, phase)?;
    // a motion that has not settled may pass near a periodic orbit that does not attract it
    let found = match model.repeats() && summary.settled != Some(true) {
        true => None,
        false => of_orbit(&tangent, state, summary.period.unwrap_or(1))?,
    };
    found.map_or_else(|| average(&tangent, state, options.periods, cancel), Ok)
}

type Found = Option<Lyapunov>;

impl Question for ExponentOptions {
    type Answer = Found;

    fn request(&self) -> Option<Request<'_>> {
        None
    }

    fn fault(&self, model: &Model, scene: &Scene) -> Option<Fault> {
        drive_fault(model, scene)
    }

    fn answer(&self, model: &Model, _: Option<Run>, cancel: &AtomicBool) -> Found {
        exponents(model, self, cancel).ok()
    }

    fn without_model(_: Cell) -> Found {
        None
    }

    fn count(tally: &mut Tally, found: &Found) {
        tally.cells += 1;
        tally.resting += u64::from(found.is_some_and(|exponents| exponents.rests()));
        tally.without_exponents += u64::from(found.is_none());
    }

    fn table(&self, grid: &Grid, rows: &[Row<Found>]) -> Table {
        let found: Vec<Found> = rows.iter().map(|row| row.answer).collect();
        with_columns(fields(grid, rows, |_| 1, false), &found, self.circuits)
    }

    fn ahead(&self, threads: u64) -> u64 {
        32 * threads
    }
}

/// The fault of an excitation that changes in time and does not repeat, for which there are no exponents.
pub fn drive_fault(model: &Model, scene: &Scene) -> Option<Fault> {
    let suits = model.excitation().is_constant();
    if suits { None } else { without_a_period(model, scene, "an exponent") }
}

fn with_columns(mut table: Table, found: &[Found], has_circuit: bool) -> Table {
    let number = |of: fn(&Lyapunov) -> f64| move |cell: &Found| cell.as_ref().map(of);
    let estimate =
        |place: usize, of: fn(Estimate) -> f64| move |cell: &Found| cell.as_ref()?.estimates()[place].map(of);
    for place in 0..if has_circuit { 3 } else { 2 } {
        let name = |ending: &str| format!("exponent_{}_{ending}", place + 1);
        table = table.each(&name("per_s"), found, estimate(place, |estimate| estimate.per_s)).each(
            &name("se"),
            found,
            estimate(place, |estimate| estimate.error),
        );
    }
    table
        .each("sum_per_s", found, number(|exponents| exponents.sum))
        .each("exact_sum_per_s", found, |cell| cell.as_ref()?.exact_sum)
        .each("dimension", found, number(Lyapunov::dimension))
}

/// How exponents are computed.
///
/// More periods reduce the standard errors of a motion without a period as one over the square root of their
/// number, and cost in proportion; a motion that repeats needs none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExponentOptions {
    /// Number of forcing periods over which exponents of a motion without a period are averaged, at least 1.
    pub periods: u32,
    /// Time in s up to which a run may continue until it repeats; by default 1000 periods beyond the run.
    pub until_settled: Option<f64>,
    /// Whether the cells of a grid may have a circuit, so that the table has the columns of a third exponent.
    pub circuits: bool,
}

impl ExponentOptions {
    /// Default number of periods of an average.
    pub const PERIODS: u32 = 1000;
}

impl Default for ExponentOptions {
    fn default() -> Self {
        Self { periods: Self::PERIODS, until_settled: None, circuits: false }
    }
}

/// An average with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// The value in 1/s; minus infinity if perturbations vanish completely, NaN if it is not known.
    pub per_s: f64,
    /// Its standard error in 1/s: 0 for a periodic orbit or minus infinity, NaN for too few periods.
    pub error: f64,
}

impl Estimate {
    /// A value without scatter.
    pub(super) fn exact(per_s: f64) -> Self {
        Self { per_s: per_s + 0.0, error: 0.0 }
    }
}

/// The exponents of a motion.
///
/// [`table`](Self::table) has them as one row, [`describe`](Self::describe) says how they were computed. A
/// positive first exponent that [is clearly above 0](Self::is_irregular) is what makes a motion chaotic: two
/// motions that begin side by side then part by exp(first t).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Lyapunov {
    /// The larger one.
    pub first: Estimate,
    /// The second one. NaN if stops are compliant and the contraction is lost in rounding.
    pub second: Estimate,
    /// The smallest one beside a circuit; otherwise `None`.
    pub third: Option<Estimate>,
    /// Their sum in 1/s from the determinants of the derivatives. NaN if volumes contract so much in a
    /// forcing period, more than about exp(10000)-fold, that a determinant is lost in rounding.
    pub sum: f64,
    /// Their sum in 1/s from damping and impacts; `None` with compliant stops, whose loss varies.
    pub exact_sum: Option<f64>,
    /// Period of the orbit in forcing periods; `None` for averages.
    pub period: Option<u32>,
    /// Number of forcing periods to which the exponents refer, and their duration in s.
    pub span: (u32, f64),
}

/// Number of standard errors above 0 from which an exponent counts as positive.
const CLEAR: f64 = 3.0;

/// Smallest growth of perturbations of an irregular motion, in multiples of that of a shear, which is the
/// logarithm of the number of periods.
const BEYOND_SHEAR: f64 = 3.0;

impl Lyapunov {
    /// The exponents of a motion that has rested on a stop within these forcing periods.
    fn of_rest(period: Option<u32>, span: (u32, f64), tangent: &Tangent) -> Self {
        let nothing = f64::NEG_INFINITY;
        let (first, second) = (Estimate::exact(nothing), Estimate::exact(nothing));
        let model = tangent.map.model();
        let third = model.has_electrical_state().then(|| Estimate::exact(nothing));
        let exact_sum = model.compliant().is_none().then_some(nothing);
        Self { first, second, third, sum: nothing, exact_sum, period, span }
    }

    /// The exponents as a table of one row.
    pub fn table(&self) -> Table {
        with_columns(Table::new(), &[Some(*self)], self.third.is_some())
    }

    /// How they were computed and what they say, in a sentence; `forced` is whether the drive has a period.
    pub fn describe(&self, forced: bool) -> String {
        let (unit, units) = match forced {
            true => ("forcing period", "forcing periods"),
            false => ("period of small oscillations", "periods of small oscillations"),
        };
        let multipliers = "the exponents are those of its multipliers";
        let over = format!("averages over {} {units}", self.span.0);
        match self.period {
            _ if self.rests() => "the mass rests on a stop, after which nothing is left of a change: all \
                                  exponents are minus infinity, written -inf"
                .to_owned(),
            Some(1) => format!("the motion repeats in every {unit}; {multipliers}"),
            Some(n) => format!("the motion repeats after {n} {units}; {multipliers}"),
            None if self.is_irregular() => {
                format!("{over}, in which the motion is irregular: the first exponent is clearly above 0")
            }
            None => format!("{over}, in which no growth tells that the motion is irregular"),
        }
    }

    fn estimates(&self) -> [Option<Estimate>; 3] {
        [Some(self.first), Some(self.second), self.third]
    }

    /// Whether the motion has rested on a stop, which removes every perturbation.
    pub fn rests(&self) -> bool {
        self.first.per_s == f64::NEG_INFINITY
    }

    /// Whether the motion is irregular: it does not repeat, the first exponent is above 0 by more than three
    /// standard errors, and perturbations have grown much more over these periods than in proportion to time,
    /// which is their growth in regular motion without damping.
    ///
    /// An irregular transient that lasts longer than these periods counts as irregular.
    pub fn is_irregular(&self) -> bool {
        let (periods, time) = self.span;
        let shear = elementary::ln(f64::from(periods.max(2)));
        self.period.is_none()
            && self.first.per_s > CLEAR * self.first.error
            && self.first.per_s * time > BEYOND_SHEAR * shear
    }

    /// Kaplan-Yorke dimension of the stroboscopic section (Kaplan and Yorke 1979): the largest number of
    /// exponents whose sum is not below 0, and the share of the next one that makes it 0. The dimension of
    /// the trajectory in continuous time is larger by 1. NaN if it depends on an exponent that is not known.
    pub fn dimension(&self) -> f64 {
        let (mut sum, mut whole) = (0.0, 0.0);
        for Estimate { per_s, .. } in self.estimates().into_iter().flatten() {
            if sum + per_s < 0.0 || per_s.is_nan() {
                return if whole == 0.0 && !per_s.is_nan() { 0.0 } else { whole + sum / per_s.abs() };
            }
            (sum, whole) = (sum + per_s, whole + 1.0);
        }
        whole
    }
}

/// Why there are no exponents.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum NoExponents {
    /// The excitation changes and does not repeat.
    #[error("its excitation has no period that repeats")]
    NoPeriod,
    /// It was cancelled.
    #[error("interrupted")]
    Cancelled,
    /// The motion ended.
    #[error("the motion ended early ({}), so it has no exponents", .0.name())]
    EndedEarly(Outcome),
    /// The mass has touched a stop at exactly zero speed, where the map has no derivatives.
    #[error("the mass touched a stop without speed, where a small change has no rate")]
    Grazing,
}

/// Whether the transducer has an electrical state, in the scene or in a cell over `axes`.
fn may_have_circuit(document: &Document, axes: &[Axis]) -> bool {
    let swept = |name: &str| axes.iter().any(|axis| axis.field == format!("transducer.{name}"));
    let cells_may_have = match document.scene.transducer {
        Transducer::None => false,
        Transducer::Electromagnetic { inductance_mh, .. } => {
            swept("inductance_mh") || inductance_mh > 0.0 && swept("load_ohm")
        }
        Transducer::Piezoelectric { .. } => swept("load_kohm"),
    };
    cells_may_have || document.scene.transducer.has_state()
}
