//! What the rows of thresholds, escapes and comparisons lack, in sentences.
//!
//! Those of cells name options of the command line, as [`Error::message`](super::Error::message) does.

use super::error::with_argument_names;
use super::escape::grid_or_one;
use super::{Escape, ProbableThreshold, Simulation, Threshold};
use crate::dynamics::Regime;
use crate::mechanics::Mechanism;
use crate::numeric::{extent, short};
use crate::scene::{Document, RunSettings, Stops, Transducer};
use crate::study::{Grid, Onset, Rated, Scan, Searched, Table, Values, can_cross};

impl Threshold {
    /// Why `table`, the answer of [`run`](Self::run), has rows without a value, with the first value of the
    /// range, undecided ones, or ones without Melnikov's threshold: a sentence each, none if there are no
    /// such rows.
    pub fn remarks(&self, simulation: &Simulation, table: &Table) -> Vec<String> {
        let Ok(grid) = grid_or_one(&self.over, simulation) else { return Vec::new() };
        let mechanism = Some(&**simulation.mechanism()).filter(|_| !grid.changes_mechanism());
        let remarks = self.remarks_in_cells(simulation.document(), &grid, mechanism, table);
        remarks.iter().map(|text| with_argument_names(text)).collect()
    }

    /// Like [`Escape::in_cells`](super::Escape::in_cells). `mechanism` is that of all cells.
    #[doc(hidden)]
    pub fn remarks_in_cells(
        &self,
        document: &Document,
        grid: &Grid,
        mechanism: Option<&Mechanism>,
        table: &Table,
    ) -> Vec<String> {
        let Ok(searched) = self.searched(document, grid) else { return Vec::new() };
        let blocked = blocked(document, grid, mechanism, searched.field());
        let blocked = blocked.filter(|_| self.of != Onset::Release);
        let at_first = match &searched {
            Searched::Scan(scan) => at_first(table, scan),
            Searched::Upward { .. } => None,
        };
        [
            missing(table, &searched, self.of, grid, blocked),
            at_first,
            undecided(table),
            without_melnikov(table),
        ]
        .into_iter()
        .flatten()
        .collect()
    }
}

impl ProbableThreshold {
    /// Why `table`, the answer of [`run`](Self::run), has rows without a value; none if all have one.
    pub fn remarks(&self, simulation: &Simulation, table: &Table) -> Vec<String> {
        let Ok(grid) = grid_or_one(&self.over, simulation) else { return Vec::new() };
        let remarks = self.remarks_in_cells(simulation.document(), &grid, table);
        remarks.iter().map(|text| with_argument_names(text)).collect()
    }

    /// Like [`Threshold::remarks_in_cells`].
    #[doc(hidden)]
    pub fn remarks_in_cells(&self, document: &Document, grid: &Grid, table: &Table) -> Vec<String> {
        let too_few = || {
            let (rows, scan) = (without_value(table)?, self.scan(document, grid).ok()?);
            let (last, field) = (scan.values.last()?, &scan.field);
            let within = self.within.unwrap_or(document.scene.run.duration_s);
            Some(format!(
                "{rows}: at {field} = {last} less than a share {} of the runs crosses within {within} s; \
                 give a wider range, or --within a longer time",
                self.probability
            ))
        };
        too_few().into_iter().collect()
    }
}

impl Escape {
    /// How many runs of `table`, the answer of [`run`](Self::run), escaped, how many ended early, and why
    /// Kramers' rate does not hold.
    pub fn describe(table: &Table) -> String {
        let total = |name: &str| match table.column(name).map(|column| &column.values) {
            Some(Values::Counts(counts)) => counts.iter().flatten().sum::<u64>(),
            _ => 0,
        };
        let (runs, escaped, early) = (total("runs"), total("escaped"), total("ended_early"));
        let mut text = format!("{escaped} of {runs} run{} escaped", if runs == 1 { "" } else { "s" });
        if early > 0 {
            text += &format!(
                "; {early} ended before their time without an escape (they left the table of the force, or \
                 used up a budget), so that the rate counts their time up to there"
            );
        }
        let mut fails: Vec<&str> =
            table.words("kramers_fails").iter().copied().filter(|word| !word.is_empty()).collect();
        fails.sort_unstable();
        fails.dedup();
        if !fails.is_empty() {
            let fails = fails.join(", ");
            text += &format!("; Kramers' rate does not hold: {fails} (see kramers_fails in docs/output.md)");
        }
        text
    }
}

/// Why no motion of any cell can cross, where this is known beforehand.
fn blocked(
    document: &Document,
    grid: &Grid,
    mechanism: Option<&Mechanism>,
    searched: &str,
) -> Option<&'static str> {
    let mut fields = grid.axes().iter().map(|axis| &*axis.field).chain([searched]);
    let fixed = !fields.any(|field| field.starts_with("stops") || field.starts_with("mechanism"));
    let mechanism = mechanism.filter(|mechanism| fixed && !can_cross(&document.scene, mechanism))?;
    Some(match mechanism.landscape.barrier {
        None => "there is no barrier between two wells",
        Some(_) => "no barrier lies between the stops",
    })
}

/// The clause "`count` of `all` rows" with the singular or plural of a verb. Returns `None` if `count` is 0.
fn of_rows(count: usize, all: usize, verbs: [&str; 2]) -> Option<String> {
    match (count, all) {
        (0, _) => None,
        (1, 1) => Some(format!("the row {}", verbs[0])),
        (count, all) => Some(format!("{count} of {all} rows {}", verbs[1])),
    }
}

/// The rows with an empty `value`, as a clause, if there are any.
fn without_value(table: &Table) -> Option<String> {
    without(table.numbers("value")?, "value")
}

/// The rows without one of these `numbers`, as a clause, if there are any.
fn without(numbers: &[f64], name: &str) -> Option<String> {
    let count = numbers.iter().filter(|number| number.is_nan()).count();
    of_rows(count, numbers.len(), [&format!("has no {name}"), &format!("have no {name}")])
}

/// Explains an empty Melnikov's threshold, if a row has one.
fn without_melnikov(table: &Table) -> Option<String> {
    let name = &table.columns().iter().find(|column| column.name.starts_with("melnikov"))?.name;
    let rows = without(table.numbers(name)?, name)?;
    Some(format!(
        "{rows}: it needs linear damping above 0, no current or voltage as a third state, a barrier without \
         a kink, a well whose homoclinic orbit meets neither a stop nor the end of the force curve, and a \
         drive that is not far faster than motions at the barrier"
    ))
}

/// Explains a `value` that is the first of the range, if a row has one.
fn at_first(table: &Table, scan: &Scan) -> Option<String> {
    let (values, first) = (table.numbers("value")?, *scan.values.first()?);
    let known = table.numbers("low")?;
    let is_first = |(value, low): (&f64, &f64)| *value == first && low.is_nan();
    let count = values.iter().zip(known).filter(|row| is_first(*row)).count();
    let rows = of_rows(count, values.len(), ["has its value", "have their value"])?;
    Some(format!(
        "{rows} at {first}, the first that was tried: where the field can have a lower one, that may do as \
         well; windows counts how often the answer changes above"
    ))
}

/// Explains `undecided`, if it is true in a row.
fn undecided(table: &Table) -> Option<String> {
    let words = table.words("undecided");
    let count = words.iter().filter(|word| **word == "true").count();
    let rows = of_rows(count, words.len(), ["is undecided", "are undecided"])?;
    Some(format!(
        "{rows}: the answer just below or at the value (without a value, at the end of the range) is not \
         known: the motion does not repeat in the time for which it is followed, the run ended early, or \
         there is no valid scene; low and high, where given, are values whose answers are known, and \
         --until-settled with a longer time may bring them together"
    ))
}

/// Explains an empty `value`, if a row has one. `blocked` says why no row can have a crossing.
fn missing(
    table: &Table,
    searched: &Searched,
    onset: Onset,
    grid: &Grid,
    blocked: Option<&str>,
) -> Option<String> {
    let rows = without_value(table)?;
    if let Some(why) = blocked {
        return Some(format!("{rows}: {why}, so nothing to cross"));
    }
    let what = match onset {
        Onset::Release => "releases the mass from a stop",
        Onset::Crossing => "makes the settled motion cross",
        Onset::Interwell => "makes the settled motion interwell",
    };
    let field = searched.field();
    let unsolved = match grid.changes_mechanism() || field.starts_with("mechanism") {
        true => ", or the flexures are not solved",
        false => "",
    };
    let (range, remedy) = match searched {
        Searched::Scan(scan) => {
            let (low, high) = extent(scan.values.iter().copied());
            (format!("from {low} to {high} "), "give a wider range or smaller steps".to_owned())
        }
        Searched::Upward { .. } => (String::new(), format!("give a range, --field {field}=FROM:TO")),
    };
    Some(format!("{rows}: no {field} that was tried {range}{what}{unsolved}; {remedy}"))
}

/// The remarks on a comparison: which scenes have another excitation or run than in their files, and why the
/// `rated` ones lack a number. Each begins with the names of the scenes to which it applies.
pub(super) fn of_comparison(
    given: &[(&str, &Simulation)],
    environment: &Document,
    scenes: &[(String, Simulation)],
    rated: &[Rated],
    (amplitude_g, table): (f64, &Table),
) -> Vec<String> {
    let replaced =
        given.iter().filter_map(|(name, scene)| Some(((*name).to_owned(), replaced(scene, environment)?)));
    let lacking = scenes.iter().zip(rated).enumerate().flat_map(|(row, ((name, scene), rated))| {
        let empty = table.columns().iter().filter(move |column| column.values.is_missing(row));
        let remarks = of_scene(scene, rated, amplitude_g, empty.map(|column| &*column.name));
        remarks.into_iter().map(|words| (name.clone(), words))
    });
    let groups = grouped(replaced).into_iter().chain(grouped(lacking));
    groups.map(|(names, words)| format!("{names}: {words}")).collect()
}

/// Which of excitation and run of a scene those of the environment replace.
fn replaced(simulation: &Simulation, environment: &Document) -> Option<String> {
    let (scene, lent) = (simulation.scene(), &environment.scene);
    let how = match (scene.excitation != lent.excitation, window(&scene.run) != window(&lent.run)) {
        (true, true) => "excitation and run",
        (true, false) => "excitation",
        (false, true) => "run",
        (false, false) => return None,
    };
    Some(format!("rated with the {how} of {}, not with its own", environment.name))
}

/// Duration of a run, beginning of its settled window, and tolerance.
fn window(run: &RunSettings) -> [f64; 3] {
    [run.duration_s, run.settle_s.unwrap_or(0.5 * run.duration_s), run.tolerance]
}

/// Each distinct remark after the names of all to which it applies.
fn grouped(remarks: impl IntoIterator<Item = (String, String)>) -> Vec<(String, String)> {
    let mut groups: Vec<(String, String)> = Vec::new();
    for (name, words) in remarks {
        match groups.iter_mut().find(|group| group.1 == words) {
            Some((names, _)) => *names += &format!(", {name}"),
            None => groups.push((name, words)),
        }
    }
    groups
}

/// Explains the empty and infinite cells of a row, an early end, rest, and an undecided threshold.
fn of_scene<'a>(
    simulation: &Simulation,
    rated: &Rated,
    amplitude_g: f64,
    empty: impl Iterator<Item = &'a str>,
) -> Vec<String> {
    let (summary, given) = (&rated.summary, short(amplitude_g));
    let mut all = Vec::new();
    if let Some(at) = summary.outcome.ended_at() {
        let (at, outcome) = (short(at), summary.outcome.name());
        all.push(format!(
            "its run ended early at {at} s ({outcome}): nothing is known of its settled motion"
        ));
    } else if summary.regime == Regime::Rest {
        all.push(format!("{given} g does not move it"));
    }
    if let Some(crossing) = rated.crossing.filter(|crossing| crossing.undecided) {
        let low = crossing.low.map_or_else(String::new, |low| format!(" above {} g", short(low)));
        let high = crossing.high.map_or_else(String::new, |high| format!(" below {} g", short(high)));
        all.push(format!(
            "its threshold is undecided: of some amplitudes{low}{high} it is not known whether they cross: \
             the motion does not repeat in the time for which it is followed, the run ended early, or there \
             is no valid scene"
        ));
    }
    if let Some((_, size)) = rated.sensitivity.as_ref().filter(|(change, _)| change.is_infinite()) {
        all.push(format!("with {size} changed by 1 % nothing is left to cross, or nothing crosses"));
    }
    let empty = empty.map(|column| (column.to_owned(), why_empty(column, simulation, rated, &given)));
    all.extend(grouped(empty).iter().map(|(names, why)| format!("no {names}: {why}")));
    all
}

fn why_empty(column: &str, simulation: &Simulation, rated: &Rated, given: &str) -> String {
    let (summary, crossing) = (&rated.summary, rated.crossing_g());
    let transducer = simulation.scene().transducer != Transducer::None;
    match column {
        "release_g" => "it rests on no stop",
        "mean_load_power_w" if !transducer => "it has no transducer",
        "impact_speed_max_m_per_s" if simulation.scene().stops == Stops::None => "it has no stops",
        "impact_speed_max_m_per_s" if summary.outcome.ended_at().is_none() => "it strikes no stop",
        "rms_velocity_m_per_s" | "mean_load_power_w" | "max_abs_x_m" | "impact_speed_max_m_per_s" => {
            "its run ended early"
        }
        _ if simulation.mechanism().landscape.barrier.is_none() => {
            "no barrier between two wells, so nothing to cross"
        }
        _ if rated.crossing.is_none() => "no barrier stands between its stops, so nothing to cross",
        "crosses_from_hz" | "crosses_to_hz" => {
            return format!("no frequency that was tried makes its settled motion cross at {given} g");
        }
        _ if crossing.is_none() => "no amplitude that was tried makes its settled motion cross",
        "crossing_low_g" => "no smaller amplitude that was tried is known not to cross",
        "crossing_high_g" => "no amplitude that was tried is known to cross for good",
        "crossing_step_g" | "crossing_resolution_g" => "it crosses at the least amplitude that was tried",
        _ => "its mechanism has no length, thickness or gap to change",
    }
    .to_owned()
}
