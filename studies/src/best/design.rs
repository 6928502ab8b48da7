//! The parsed question and its answer.

use serde::{Deserialize, Serialize};

use super::evaluate::{Evaluator, Memory};
use super::plan::{Part, Plan};
use super::{Seeds, names, search, varied};
use crate::scene::{Fault, Files, Scene};
use crate::study::{SummaryField, Table, Task};
use crate::system::threads::Pool;

/// A field of the design with its range, in the unit of the field.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignRange {
    /// Dotted path of the field.
    pub field: String,
    /// Least value.
    pub low: f64,
    /// Largest value, above the least.
    pub high: f64,
    /// Number of intervals of the scan: at least 1, and for whole numbers at most the length of the range.
    pub intervals: usize,
    /// Whether only whole numbers are tried, as for a count.
    pub(super) whole: bool,
}

impl DesignRange {
    /// The range of `field` from `low` to `high`.
    pub fn new(field: impl Into<String>, (low, high): (f64, f64), intervals: usize) -> Self {
        Self { field: field.into(), low, high, intervals, whole: false }
    }

    /// Step of the scan.
    pub fn step(&self) -> f64 {
        (self.high - self.low) / self.intervals as f64
    }
}

/// A bound on a result.
#[derive(Debug, Clone, Copy)]
pub struct Constraint {
    /// The result.
    pub of: &'static SummaryField,
    /// Whether the result must be at most the limit; otherwise it must be at least the limit.
    pub at_most: bool,
    /// The limit, in the unit of the result.
    pub limit: f64,
}

/// A scene in one environment.
#[derive(Debug, Clone)]
pub struct Environment {
    /// Its name.
    pub name: String,
    /// Its weight, above 0.
    pub weight: f64,
    /// The scene under its excitation.
    pub scene: Scene,
    /// The files that the scene names.
    pub files: Files,
}

/// A field with a manufacturing tolerance, within which every value is as likely.
#[derive(Debug, Clone, PartialEq)]
pub struct Tolerance {
    /// Dotted path of the field.
    pub field: String,
    /// Least deviation from the value: a share of it, or in the field's unit.
    pub low: f64,
    /// Largest deviation.
    pub high: f64,
    /// Whether they are shares.
    pub relative: bool,
}

/// A search for the best design.
#[doc(hidden)]
#[derive(Debug, Clone)]
pub struct BestQuestion {
    /// The fields of the design, 1 to 4.
    pub over: Vec<DesignRange>,
    /// The result whose mean over the environments is to be largest; a number or a count.
    pub maximise: &'static SummaryField,
    /// Constraints in every environment.
    pub subject_to: Vec<Constraint>,
    /// The environments, at least one.
    pub environments: Vec<Environment>,
    /// Fields that vary about the design, each within its tolerance.
    pub vary: Vec<Tolerance>,
    /// Seed of the samples of the fields that vary.
    pub seed: u64,
    /// Time in s up to which runs may continue until they repeat; by default 1000 periods beyond the run.
    pub until_settled: Option<f64>,
}

/// Largest number of fields of a design; the scan grows exponentially with it.
pub const MOST_FIELDS: usize = 4;

/// Numbers of intervals of the scan for one to four fields.
pub const INTERVALS: [usize; MOST_FIELDS] = [256, 32, 12, 8];

/// A design and its results; the values of the fields are in their units and in the order of the question.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Optimum {
    /// The fields' values.
    pub at: Vec<f64>,
    /// The mean of the maximised result.
    pub value: f64,
    /// The result in each environment.
    pub of_each: Vec<f64>,
}

/// A design that was tried, one of [`BestDesign::tried`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tried {
    /// The fields' values.
    pub at: Vec<f64>,
    /// The mean of the maximised result; `None` if a run ended early or without it, or for no valid scene.
    pub value: Option<f64>,
    /// Whether no constraint is known to be violated.
    pub keeps: bool,
}

/// The maximised value under variation: over 200 random samples of the fields with manufacturing tolerances.
/// NaN if a sample has no value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// The worst of the samples.
    pub worst: f64,
    /// The 5 % quantile of the samples.
    pub quantile_5: f64,
}

/// The best design.
///
/// Results jump where the motion changes its kind, so that the best place may stand at the edge of a jump:
/// [`margins`](Self::margins) say how far that is, in the units of the fields, and
/// [`stepped_back`](Self::stepped_back) which design beside it loses less.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BestDesign {
    /// The place.
    pub optimum: Optimum,
    /// For each field, the distance below and above at which the value has fallen by a tenth or a constraint
    /// is violated, with the other fields fixed; `None` if this does not happen within its range.
    pub margins: Vec<[Option<f64>; 2]>,
    /// The longest steps in which each margin was looked for, the resolution near the optimum: a narrower dip
    /// may be missed.
    pub margin_steps: Vec<[f64; 2]>,
    /// Which fields are best at an end of their range.
    pub at_border: Vec<bool>,
    /// Resolution of each field: the place is exact to it, but under a noise, where `seeds` say how far.
    pub resolution: Vec<f64>,
    /// What the place and its value owe to the seeds of the noises that the environments have.
    pub seeds: Seeds,
    /// The value under variation; if nothing varies, the value itself.
    pub spread: Spread,
    /// The design with the largest worst case among those inward of the optimum along the first field.
    pub stepped_back: Option<(Optimum, Spread)>,
    /// Whether all designs that were tried have the same value.
    pub flat: bool,
    /// The value from runs that are followed for twice as long, if the motion has not repeated by the end of
    /// its run, so that the value depends on the time over which it is taken; NaN if it then has no value.
    pub later: Option<f64>,
    /// The designs that were tried, in order: first those of the scan, `scan_places` of them, then those
    /// nearer to the best ones and those beside the optimum. Samples of the fields that vary are left out.
    pub tried: Vec<Tried>,
}

/// Why there is no best design.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum NoBest {
    /// It was cancelled.
    Cancelled,
    /// No design of the scan is a valid scene; these are the faults of the first one.
    Invalid(Vec<Fault>),
    /// No design has the maximised result and those of the constraints.
    NoValue,
    /// No design meets the constraints; the nearest one, and its results in the worst environment.
    NoneMeets {
        /// The fields' values.
        nearest: Vec<f64>,
        /// The results, one for each constraint.
        results: Vec<f64>,
    },
}

impl BestDesign {
    /// One row: the fields, `maximised,value,margin_low,margin_high,worst,quantile_5`, the margins of further
    /// fields, the design stepped back in the first field, the value in each of several environments, the
    /// steps in which the margins were looked for, and under noise the standard error of the value and the
    /// interval of each field.
    pub fn table(&self, question: &BestQuestion) -> Table {
        let names = names(question);
        let (row, back) = ([self], [self.stepped_back.as_ref()]);
        let mut table = Table::new();
        for (name, value) in names.iter().zip(&self.optimum.at) {
            table = table.each(name, &row, |_| *value);
        }
        table = table
            .each("maximised", &row, |_| question.maximise.name)
            .each("value", &row, |best| best.optimum.value)
            .each("margin_low", &row, |best| best.margins[0][0])
            .each("margin_high", &row, |best| best.margins[0][1])
            .each("worst", &row, |best| best.spread.worst)
            .each("quantile_5", &row, |best| best.spread.quantile_5);
        for (name, [low, high]) in names.iter().zip(&self.margins).skip(1) {
            table = table.each(&format!("margin_low.{name}"), &row, |_| *low);
            table = table.each(&format!("margin_high.{name}"), &row, |_| *high);
        }
        table = table
            .each("back_to", &back, |back| Some((*back)?.0.at[0]))
            .each("back_value", &back, |back| Some((*back)?.0.value))
            .each("back_worst", &back, |back| Some((*back)?.1.worst))
            .each("back_quantile_5", &back, |back| Some((*back)?.1.quantile_5));
        let each = self.optimum.of_each.iter().enumerate().filter(|_| question.environments.len() > 1);
        table =
            each.fold(table, |table, (i, value)| table.each(&format!("value_{}", i + 1), &row, |_| *value));
        for (i, (name, [low, high])) in names.iter().zip(&self.margin_steps).enumerate() {
            let of = if i == 0 { String::new() } else { format!(".{name}") };
            table = table.each(&format!("margin_low_step{of}"), &row, |_| *low);
            table = table.each(&format!("margin_high_step{of}"), &row, |_| *high);
        }
        if let Seeds::Averaged { standard_error, intervals, .. } = &self.seeds {
            table = table.each("standard_error", &row, |_| *standard_error);
            for (name, [low, high]) in names.iter().zip(intervals) {
                table = table.each(&format!("{name}_low"), &row, |_| *low);
                table = table.each(&format!("{name}_high"), &row, |_| *high);
            }
        }
        table
    }
}

/// Searches for the best design. `memory` keeps the results of its runs; `plan` gets the number of runs that
/// are left to do, as far as it is known, at the beginning and whenever it changes; `preview` the best design
/// of the coarse scan, then the best design before margins and samples are computed. The result is the same
/// for any number of threads.
pub fn best(
    question: &BestQuestion,
    pool: &Pool,
    task: &Task,
    memory: Option<&dyn Memory>,
    plan: &(dyn Fn(u64) + Sync),
    preview: &mut dyn FnMut(&Optimum),
) -> Result<BestDesign, NoBest> {
    let evaluator = Evaluator::new(question, pool, task, memory)?;
    let mut plan = Plan::new(&evaluator, plan);
    let found = search::search(&evaluator, &mut plan, preview)?;
    let margins = search::margins(&evaluator, &mut plan, &found)?;
    let (spread, stepped_back) = varied::robust(&evaluator, &mut plan, &found, &margins)?;
    plan.is_at(Part::Samples, 0);
    let border = |(range, at): (&DesignRange, &f64)| *at <= range.low || *at >= range.high;
    let seeds = evaluator.seeds(&found.optimum);
    Ok(BestDesign {
        seeds,
        at_border: evaluator.over.iter().zip(&found.optimum.at).map(border).collect(),
        resolution: evaluator.over.iter().map(search::resolution).collect(),
        later: evaluator.later(&found.optimum.at)?,
        optimum: found.optimum,
        flat: found.flat,
        margins: margins.iter().map(|sides| sides.map(|side| side.margin)).collect(),
        margin_steps: margins.iter().map(|sides| sides.map(|side| side.step)).collect(),
        spread,
        stepped_back,
        tried: evaluator.into_tried(),
    })
}

/// Number of designs of the scan of the whole range.
pub fn scan_places(question: &BestQuestion) -> u64 {
    question.over.iter().map(|range| range.intervals as u64 + 1).product()
}
