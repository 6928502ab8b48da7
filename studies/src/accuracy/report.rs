//! Work against precision of the problems, and the hard cases: their selection, run and tables.

use super::cases::{HARD_CASES, HardCase};
use super::measure::{Check, Variant};
use super::precision::{OWN, PARTS, PROBLEMS, Point, Problem};
use super::setup::{Stopped, TOLERANCE};
use crate::study::{Table, Task};

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
    /// The parts with these names, in the study's own order; all parts without names. The error is a clause.
    pub fn of(wanted: &[String]) -> Result<Self, String> {
        if let Some(unknown) = wanted.iter().find(|wanted| !names().any(|name| name == wanted.as_str())) {
            let known: Vec<&str> = names().collect();
            return Err(format!("there is no case `{unknown}`; the cases are {}", known.join(", ")));
        }
        let has = |name: &str| wanted.is_empty() || wanted.iter().any(|wanted| wanted == name);
        Ok(Self {
            problems: PROBLEMS.iter().filter(|problem| has(problem.name)).collect(),
            cases: HARD_CASES.iter().filter(|case| has(case.name)).collect(),
        })
    }

    /// How often progress is reported.
    pub fn parts(&self) -> u64 {
        (self.problems.len() * PARTS + self.cases.len()) as u64
    }

    /// Whether work against precision is part of it.
    pub fn has_problems(&self) -> bool {
        !self.problems.is_empty()
    }
}

/// Errors whose cost the summary of a method lists.
const LEVELS: [(&str, f64); 4] =
    [("cpu_to_1e-3_s", 1e-3), ("cpu_to_1e-6_s", 1e-6), ("cpu_to_1e-9_s", 1e-9), ("cpu_to_1e-12_s", 1e-12)];

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

    fn variants(&self) -> impl Iterator<Item = (&'static str, &Variant)> {
        self.cases.iter().flat_map(|(case, variants)| variants.iter().map(|variant| (*case, variant)))
    }

    /// Everything in one table, a row for each point and for each quantity of each variant of a case.
    ///
    /// `part` is `work_precision` or `hard_case`; `error` and `allowed` are relative to what the problem or
    /// case names; unused cells are empty.
    pub fn table(&self) -> Table {
        let mut table = self.work_table();
        table.append(&self.check_table(|variant| variant.checks.clone()));
        table
    }

    /// The points alone, in the same columns; `case` is the problem.
    pub fn work_table(&self) -> Table {
        let points = &self.points;
        Table::new()
            .each("part", points, |_| "work_precision")
            .each("case", points, |point| point.problem)
            .each("method", points, |point| point.method)
            .each("variant", points, |_| "")
            .each("quantity", points, |_| "")
            .each("tolerance", points, |point| point.tolerance)
            .each("step_s", points, |point| point.step)
            .each("error", points, |point| point.error)
            .each("allowed", points, |_| f64::NAN)
            .each("digits_allowed", points, |_| f64::NAN)
            .each("digits_reached", points, |_| f64::NAN)
            .each("steps", points, |point| Some(point.statistics.steps))
            .each("evaluations", points, |point| Some(point.statistics.evaluations))
            .each("cpu_s", points, |point| point.statistics.cpu_s)
            .each("verdict", points, |_| "")
    }

    /// The least CPU time of each method for an error of 1e-3, 1e-6, 1e-9 and 1e-12, and the least error
    /// reached: a row for each problem and method.
    pub fn cost_table(&self) -> Table {
        let mut groups: Vec<(&str, &str)> =
            self.points.iter().map(|point| (point.problem, point.method)).collect();
        // the points of a method stand together
        groups.dedup();
        let least = |group: &(&str, &str), of: &dyn Fn(&Point) -> f64| {
            let points = self.points.iter().filter(|point| (point.problem, point.method) == *group);
            points.map(of).fold(f64::NAN, f64::min)
        };
        let mut table =
            Table::new().each("problem", &groups, |group| group.0).each("method", &groups, |group| group.1);
        for (name, level) in LEVELS {
            let cost = |point: &Point| if point.error <= level { point.statistics.cpu_s } else { f64::NAN };
            table = table.each(name, &groups, |group| least(group, &cost));
        }
        table.each("least_error", &groups, |group| least(group, &|point| point.error))
    }

    /// The hard cases, a row for each variant with the quantity that has the smallest margin.
    pub fn case_table(&self) -> Table {
        const COLUMNS: [&str; 8] =
            ["case", "variant", "quantity", "digits_allowed", "digits_reached", "steps", "cpu_s", "verdict"];
        let table = self.check_table(|variant| variant.tightest().into_iter().collect());
        table.only(&COLUMNS.map(str::to_owned))
    }

    /// The hard cases, a row for each check that `choose` takes from a variant.
    fn check_table(&self, choose: impl Fn(&Variant) -> Vec<(&'static str, Check)>) -> Table {
        let mut rows = Vec::new();
        for (case, variant) in self.variants() {
            rows.extend(choose(variant).into_iter().map(|check| (case, variant, check.0, check.1)));
        }
        let numbers = |check: Check| match check {
            Check::Error { error, allowed } => (error, allowed),
            Check::Fact(_) => (f64::NAN, f64::NAN),
        };
        Table::new()
            .each("part", &rows, |_| "hard_case")
            .each("case", &rows, |row| row.0)
            .each("method", &rows, |_| OWN)
            .each("variant", &rows, |row| row.1.name)
            .each("quantity", &rows, |row| row.2)
            .each("tolerance", &rows, |_| TOLERANCE)
            .each("step_s", &rows, |_| f64::NAN)
            .each("error", &rows, |row| numbers(row.3).0)
            .each("allowed", &rows, |row| numbers(row.3).1)
            .each("digits_allowed", &rows, |row| row.3.digits_allowed().unwrap_or(f64::NAN))
            .each("digits_reached", &rows, |row| row.3.digits_reached().unwrap_or(f64::NAN))
            .each("steps", &rows, |row| Some(row.1.steps))
            .each("evaluations", &rows, |row| Some(row.1.evaluations))
            .each("cpu_s", &rows, |row| row.1.cpu_s)
            .each("verdict", &rows, |row| if row.3.passes() { "pass" } else { "fail" })
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
