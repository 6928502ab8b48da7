//! Accuracy of runs, and its cost.
//!
//! - Any scene ([`scene`]): the error of its run, the time up to which its path can be trusted, and the
//!   effect of a fixed step.
//! - Three problems ([`PROBLEMS`]): work against precision, beside the methods that people use instead
//!   ([`methods`]). The error is measured against the program's own integrator in double-double arithmetic.
//! - Hard cases ([`HARD_CASES`]), which break integrators of impacts: each has its answer ([`exact`] where
//!   there is a closed form) and the digits that its conditioning allows.

mod cases;
pub mod exact;
mod measure;
pub mod methods;
mod precision;
pub mod scene;
mod setup;
mod tables;

pub use cases::{HARD_CASES, HardCase};
pub use measure::{Check, REFERENCE_TOLERANCE, STEP_ERROR, Variant};
pub use precision::{OWN, PROBLEMS, Point, Problem, Setting};
pub use setup::Stopped;

use super::Task;

/// A name that cannot be selected.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no case `{0}`; the cases are {cases}", cases = names().collect::<Vec<_>>().join(", "))]
pub struct UnknownCase(String);

/// Names of all parts of the study: the problems, then the hard cases.
pub fn names() -> impl Iterator<Item = &'static str> {
    PROBLEMS.iter().map(|problem| problem.name).chain(HARD_CASES.iter().map(|case| case.name))
}

/// The part of the study called `name` in words: what is run, then what the error of a problem is, or how the
/// answer of a case is known and why so many digits are allowed. Empty if there is none.
pub fn description(name: &str) -> String {
    let from_name = include_str!("list.txt").lines().skip_while(|line| *line != name).enumerate();
    let entry = from_name.take_while(|(i, line)| *i == 0 || line.starts_with(' '));
    entry.map(|(_, line)| format!("{line}\n")).collect()
}

/// Parts of the study to run.
#[derive(Debug, Clone)]
pub struct Selection {
    problems: Vec<&'static Problem>,
    cases: Vec<&'static HardCase>,
}

impl Selection {
    /// The parts with these names, in the study's own order; all parts without names.
    pub fn of(wanted: &[String]) -> Result<Self, UnknownCase> {
        if let Some(unknown) = wanted.iter().find(|wanted| !names().any(|name| name == wanted.as_str())) {
            return Err(UnknownCase(unknown.clone()));
        }
        let has = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name);
        Ok(Self {
            problems: PROBLEMS.iter().filter(|problem| has(problem.name)).collect(),
            cases: HARD_CASES.iter().filter(|case| has(case.name)).collect(),
        })
    }

    /// How often progress is reported.
    pub fn parts(&self) -> u64 {
        (self.problems.len() * precision::PARTS + self.cases.len()) as u64
    }

    /// Whether work against precision is part of it.
    pub fn has_problems(&self) -> bool {
        !self.problems.is_empty()
    }
}

/// Results of the study.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Report {
    /// Work against precision, by problem and method, the coarsest setting first.
    pub points: Vec<Point>,
    /// The hard cases by name.
    pub cases: Vec<(&'static str, Vec<Variant>)>,
}

impl Report {
    /// Each variant of a case that falls short: case, variant, quantity.
    pub fn shortfalls(&self) -> Vec<(&'static str, &'static str, &'static str)> {
        let mut short = Vec::new();
        for (case, variant) in self.variants() {
            let failed = variant.checks.iter().filter(|(_, check)| !check.passes());
            short.extend(failed.map(|(quantity, _)| (case, variant.name, *quantity)));
        }
        short
    }

    /// The variants of all cases, each with the name of its case.
    fn variants(&self) -> impl Iterator<Item = (&'static str, &Variant)> {
        self.cases.iter().flat_map(|(case, variants)| variants.iter().map(|variant| (*case, variant)))
    }
}

/// Runs the selected parts one after the other on this thread, since their time is measured.
pub fn accuracy(selection: &Selection, task: &Task) -> Result<Report, Stopped> {
    let mut report = Report::default();
    for problem in &selection.problems {
        report.points.extend(problem.measure(task)?);
    }
    for case in &selection.cases {
        report.cases.push((case.name, case.find(task)?));
        (task.tick)();
    }
    Ok(report)
}
