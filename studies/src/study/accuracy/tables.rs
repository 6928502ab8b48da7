//! Accuracy of the program as tables.

use super::measure::Check;
use super::precision::{Point, Setting};
use super::{OWN, Report, Variant, setup};
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
            .each("tolerance", points, |point| match point.setting {
                Setting::Tolerance(tolerance) => tolerance,
                Setting::Step(_) => f64::NAN,
            })
            .each("step_s", points, |point| match point.setting {
                Setting::Tolerance(_) => f64::NAN,
                Setting::Step(step) => step,
            })
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
            .each("tolerance", &rows, |_| setup::TOLERANCE)
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
