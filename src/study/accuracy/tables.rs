//! Accuracy of the program as tables.

use super::measure::Check;
use super::precision::{Point, Setting};
use super::{Report, Variant};
use crate::study::Table;

/// Errors whose cost the summary of a method lists.
const LEVELS: [(&str, f64); 4] =
    [("cpu_to_1e-3_s", 1e-3), ("cpu_to_1e-6_s", 1e-6), ("cpu_to_1e-9_s", 1e-9), ("cpu_to_1e-12_s", 1e-12)];

impl Report {
    /// Everything in one table, a row for each point and for each quantity of each variant of a case.
    ///
    /// `part` is `work_precision` or `hard_case`; `error` and `allowed` are relative to what the problem or
    /// case names; unused cells are empty.
    pub fn table(&self) -> Table {
        let rows: Vec<Row> = self
            .points
            .iter()
            .map(Row::of_point)
            .chain(self.rows(|variant| variant.checks.clone()))
            .collect();
        Table::new()
            .each("part", &rows, |row| row.part)
            .each("case", &rows, |row| row.case)
            .each("method", &rows, |row| row.method)
            .each("variant", &rows, |row| row.variant)
            .each("quantity", &rows, |row| row.quantity)
            .each("tolerance", &rows, |row| row.tolerance)
            .each("step_s", &rows, |row| row.step)
            .each("error", &rows, |row| row.error)
            .each("allowed", &rows, |row| row.allowed)
            .each("digits_allowed", &rows, |row| row.digits_allowed)
            .each("digits_reached", &rows, |row| row.digits_reached)
            .each("steps", &rows, |row| Some(row.steps))
            .each("evaluations", &rows, |row| Some(row.evaluations))
            .each("cpu_s", &rows, |row| row.cpu)
            .each("verdict", &rows, |row| row.verdict)
    }

    /// The points alone, as a plot reads them: `problem`, `method`, `tolerance`, `step_s`, `error`,
    /// `steps`, `cpu_s`.
    pub fn work_table(&self) -> Table {
        let rows: Vec<Row> = self.points.iter().map(Row::of_point).collect();
        Table::new()
            .each("problem", &rows, |row| row.case)
            .each("method", &rows, |row| row.method)
            .each("tolerance", &rows, |row| row.tolerance)
            .each("step_s", &rows, |row| row.step)
            .each("error", &rows, |row| row.error)
            .each("steps", &rows, |row| Some(row.steps))
            .each("cpu_s", &rows, |row| row.cpu)
    }

    /// The least CPU time of each method for an error of 1e-3, 1e-6, 1e-9 and 1e-12, and the least error
    /// reached: a row for each problem and method.
    pub fn cost_table(&self) -> Table {
        let mut groups: Vec<Group> = Vec::new();
        for point in &self.points {
            let group = (point.problem, point.method);
            if !groups.contains(&group) {
                groups.push(group);
            }
        }
        let least = |group: &Group, of: &dyn Fn(&Point) -> f64| {
            let points = self.points.iter().filter(|point| (point.problem, point.method) == *group);
            points.map(of).fold(f64::NAN, f64::min)
        };
        let mut table =
            Table::new().each("problem", &groups, |group| group.0).each("method", &groups, |group| group.1);
        for (name, level) in LEVELS {
            let cost = |point: &Point| if point.error <= level { point.cpu_s } else { f64::NAN };
            table = table.each(name, &groups, |group| least(group, &cost));
        }
        table.each("least_error", &groups, |group| least(group, &|point| point.error))
    }

    /// The hard cases, a row for each variant with the quantity that has the smallest margin.
    pub fn case_table(&self) -> Table {
        let rows = self.rows(|variant| variant.tightest().into_iter().collect());
        Table::new()
            .each("case", &rows, |row| row.case)
            .each("variant", &rows, |row| row.variant)
            .each("quantity", &rows, |row| row.quantity)
            .each("digits_allowed", &rows, |row| row.digits_allowed)
            .each("digits_reached", &rows, |row| row.digits_reached)
            .each("steps", &rows, |row| Some(row.steps))
            .each("cpu_s", &rows, |row| row.cpu)
            .each("verdict", &rows, |row| row.verdict)
    }

    fn rows(&self, choose: impl Fn(&Variant) -> Vec<(&'static str, Check)>) -> Vec<Row> {
        let mut rows = Vec::new();
        for (case, variants) in &self.cases {
            for variant in variants {
                rows.extend(choose(variant).into_iter().map(|check| Row::of_check(case, variant, check)));
            }
        }
        rows
    }
}

/// Problem and method.
type Group = (&'static str, &'static str);

/// One row of either part; unused numbers are NaN, unused words empty.
#[derive(Clone, Copy)]
struct Row {
    part: &'static str,
    case: &'static str,
    method: &'static str,
    variant: &'static str,
    quantity: &'static str,
    tolerance: f64,
    step: f64,
    error: f64,
    allowed: f64,
    digits_allowed: f64,
    digits_reached: f64,
    steps: u64,
    evaluations: u64,
    cpu: f64,
    verdict: &'static str,
}

impl Row {
    fn of_point(point: &Point) -> Self {
        let (tolerance, step) = match point.setting {
            Setting::Tolerance(tolerance) => (tolerance, f64::NAN),
            Setting::Step(step) => (f64::NAN, step),
        };
        Self {
            part: "work_precision",
            case: point.problem,
            method: point.method,
            variant: "",
            quantity: "",
            tolerance,
            step,
            error: point.error,
            allowed: f64::NAN,
            digits_allowed: f64::NAN,
            digits_reached: f64::NAN,
            steps: point.steps,
            evaluations: point.evaluations,
            cpu: point.cpu_s,
            verdict: "",
        }
    }

    fn of_check(case: &'static str, variant: &Variant, (quantity, check): (&'static str, Check)) -> Self {
        let (error, allowed) = match check {
            Check::Error { error, allowed } => (error, allowed),
            Check::Fact(_) => (f64::NAN, f64::NAN),
        };
        Self {
            part: "hard_case",
            case,
            method: super::OWN,
            variant: variant.name,
            quantity,
            tolerance: super::scenes::TOLERANCE,
            step: f64::NAN,
            error,
            allowed,
            digits_allowed: check.digits_allowed().unwrap_or(f64::NAN),
            digits_reached: check.digits_reached().unwrap_or(f64::NAN),
            steps: variant.steps,
            evaluations: variant.evaluations,
            cpu: variant.cpu_s,
            verdict: if check.passes() { "pass" } else { "fail" },
        }
    }
}
