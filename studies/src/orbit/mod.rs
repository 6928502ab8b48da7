//! Periodic motions: orbits, their branches over a field, and loci over two.

mod begin;
mod chart;
mod corrector;
mod events;
mod grazing;
mod locus;
mod newton;
mod switch;
mod walk;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use serde::Deserialize;

use crate::dynamics::Model;
use crate::numeric::number_text;
use crate::output::NoPicture;
use crate::questions::{Error, Progress, Simulation};
use crate::scene::{Axis, Document, FieldPath, Scene, is_whole};
use crate::study::{Answered, Family, Grid, Heading, NoBasins, Scenes, Study, Table, named, number, whole};
pub use begin::{Begin, begun, orbit};
pub use chart::{branch_chart, loci_chart};
pub(crate) use corrector::Units;
pub use events::BranchEvent;
pub use locus::{FieldRange, LocusEnd, LocusEvent, OneLocus, loci, loci_table};
pub(crate) use newton::newton_step;
pub use newton::{
    BranchAnswer, BranchEnd, BranchOptions, NoOrbit, OrbitAnswer, branch, branches_table, orbit_near,
};
use newton::{SAME, allowed, ended, map_of, with_orbits};
pub use switch::switched;

/// The periodic motion near that of a run, with its multipliers; or a branch of motions over a field.
///
/// What `orbit` asks on the command line: an [`Orbit`], a [`Branch`], or a [`Locus`].
#[derive(Debug, Clone, PartialEq, Default, Args, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Orbits {
    /// Forcing periods after which the motion repeats [default: those of the run's settled motion]
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    #[arg(value_parser = whole::<u32>(1..=MAX_PERIOD.into()))]
    pub period: Option<u32>,
    /// The motion to take in place of that of the run: its state at that phase, X_MM,V_M_PER_S (with A or V
    /// of a circuit as a third number), or impacts=N for one with N impacts in the period, stable or not
    #[arg(long, value_name = "STATE", allow_hyphen_values = true)]
    pub from: Option<Begin>,
    /// Phase of the drive at which states are taken, in degrees
    #[arg(long, value_name = "P", allow_hyphen_values = true, default_value = "0")]
    #[arg(value_parser = number(PHASE))]
    pub phase_deg: f64,
    /// Follow the motion over a field from A, in place of its value in the scene, to B, through folds; a row
    /// a motion
    #[arg(long, value_name = "FIELD=A:B", allow_hyphen_values = true)]
    pub branch: Option<FieldRange>,
    /// Longest step of a branch, as a share of the range and of the scales of the state, 0.0001 to 0.05
    /// [default: 0.01]
    #[arg(long, value_name = "S", allow_hyphen_values = true, requires = "branch")]
    #[arg(value_parser = number("give a share, such as 0.01"))]
    pub step: Option<f64>,
    /// Largest number of motions of a branch [default: 5000]
    #[arg(long, value_name = "N", allow_hyphen_values = true, requires = "branch")]
    #[arg(value_parser = whole::<usize>(1..=1_000_000))]
    pub count: Option<usize>,
    /// Follow also the branches that begin at flips and breakings of the symmetry, those that begin on them,
    /// and so on to this number of levels [default without a number: 1]
    #[arg(long, value_name = "LEVELS", num_args = 0..=1, default_missing_value = "1", requires = "branch")]
    #[arg(conflicts_with = "locus", value_parser = whole::<u32>(1..=MAX_LEVELS.into()))]
    pub switch: Option<u32>,
    /// Follow each event of this kind on the branch over a second field too: grazing, fold, flip or symmetry
    /// (where a symmetric motion loses its symmetry)
    #[arg(long, value_name = "EVENT", requires_all = ["branch", "and"], value_parser = events())]
    pub locus: Option<BranchEvent>,
    /// With --locus: the second field, from C, in place of its value in the scene, to D
    #[arg(long, value_name = "FIELD=C:D", allow_hyphen_values = true, requires = "locus")]
    pub and: Option<FieldRange>,
}

const EXAMPLES: &str = "\
Examples:
  interwell --headless orbit paper
  interwell --headless orbit duffing-chaos --period 1
  interwell --headless orbit impact-oscillator --from impacts=1
  interwell --headless orbit paper-unconstrained --set run.duration_s=200 \\
      --branch excitation.amplitude_g=1.3:1.1 --out branch.csv --plot branch.png
  interwell --headless orbit impact-oscillator --branch excitation.amplitude_g=0.056:0.0545 --switch 3
  interwell --headless orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.07 \\
      --locus grazing --and excitation.frequency_hz=0.1:0.116 --plot grazings.png";

const PHASE: &str = "give a phase in degrees, such as 90";

/// Reads an event; a breaking of the symmetry has another name too.
fn events() -> impl TypedValueParser<Value = BranchEvent> {
    let [fold, flip, symmetry, grazing] = BranchEvent::ALL.map(|event| PossibleValue::new(event.name()));
    let words = PossibleValuesParser::from([grazing, fold, flip, symmetry.alias("symmetry-breaking")]);
    words.map(|word| BranchEvent::named(&word).unwrap_or(BranchEvent::Symmetry))
}

impl Study for Orbits {
    const NAME: &'static str = "orbit";
    const PARTS: &'static str = "motions";
    const GRID: bool = false;
    const ROW_A_CELL: bool = false;
    const PYTHON: &'static str = "";

    fn prepare(&self, document: &mut Document) -> Result<(), Error> {
        let given = || self.fields([["branch"; 2], ["and"; 2]]);
        check_fields(&document.scene, given())?;
        for ([option, _], FieldRange { field, range: (from, _) }) in given() {
            document.assign(field, &from.to_string(), &format!("--{option} {field}"))?;
        }
        Ok(())
    }

    /// Checks the fields, by their names in a program, where those of a branch alone are no pair.
    fn check(&self, scenes: &Scenes) -> Result<(), Error> {
        let of_branch = if self.and.is_none() { ["field", "end"] } else { FIRST };
        check_fields(scenes.scene(), self.fields([of_branch, SECOND]))
    }

    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let simulation = Simulation::of_model(scenes.document.clone(), scenes.model()?);
        let Self { period, phase_deg, .. } = *self;
        let begin = self.from.unwrap_or_default();
        let Some(FieldRange { field, range }) = self.branch.clone() else {
            let found = Orbit { period, phase_deg, begin }.run(&simulation, progress)?;
            return Ok(Answered::new(found.table()));
        };
        let step = self.step.unwrap_or(BranchOptions::STEP);
        let count = self.count.unwrap_or(BranchOptions::COUNT);
        let branch = Branch { field, range, period, phase_deg, begin, step, count };
        if let Some((of, second)) = self.locus.zip(self.and.clone()) {
            let found = Locus { branch, of, second }.run(&simulation, progress)?;
            let answer = Answered::new(found.table()).told(found.remarks());
            return Ok(answer.drawn(move |_, framing| Ok(loci_chart(&found.loci, phase_deg, framing.ranges))));
        }
        let levels = self.switch.unwrap_or(0);
        let found = branch.with_switches(levels, &simulation, progress)?;
        let table = if levels > 0 { found.table() } else { found.branches[0].table() };
        let answer = Answered::new(table).told(found.remarks());
        Ok(answer.drawn(move |_, framing| Ok(branch_chart(&found.branches, phase_deg, framing.ranges))))
    }

    fn can_draw(&self, _: &Grid) -> Result<(), NoPicture> {
        if self.branch.is_some() { Ok(()) } else { Err(NoPicture::SingleMotion) }
    }

    fn columns() -> Vec<Vec<Heading>> {
        Vec::new()
    }
}

impl Orbits {
    /// The fields that it covers, each with the names of the arguments that give the field and its range.
    fn fields<'a>(
        &'a self,
        names: [[&'a str; 2]; 2],
    ) -> impl Iterator<Item = ([&'a str; 2], &'a FieldRange)> {
        names.into_iter().zip(self.branch.iter().chain(&self.and))
    }
}

/// The periodic orbit near the settled motion of a run, stable or not, with its Floquet multipliers.
///
/// The table of the answer has one row: `period` (forcing periods), `x_m`, `v_m_per_s` (at `phase_deg`),
/// `multiplier_1_re`, `multiplier_1_im`, `multiplier_2_re`, `multiplier_2_im`, `stable`, `impacts`, `rests`,
/// `gentlest_impact_m_per_s`, `nearest_miss_m`; beside a circuit also `current_a` or `voltage_v` and
/// `multiplier_3_re`, `multiplier_3_im`.
///
/// # Method
///
/// A motion that repeats after n forcing periods is a fixed point of the stroboscopic map, found by
/// Newton's method. The derivative of the map is carried through impacts and releases by saltation matrices
/// (Müller 1995; Kong et al. 2024); its eigenvalues are the multipliers, which are 0 where the mass rests on
/// a stop, except that of a circuit. It takes the run of the scene and some further periods.
///
/// # Errors
///
/// [`Error::Argument`] for `period` or `phase_deg`; [`Error::Unfit`] if the drive does not repeat or is 0, or
/// a circuit without resistance keeps its charge; [`Error::Failed`] if the run comes to no motion that
/// repeats (name a period, start elsewhere, or lengthen the run), Newton's method does not converge, the
/// motion touches a stop without speed or ends early, or there is only an orbit of a shorter period.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Orbit, Progress, Simulation};
///
/// // Without impacts the product of the multipliers is exp(-c T/m).
/// let simulation = Simulation::preset("nominal-cubic")?.with("stops", "None")?;
/// let weak = simulation.with("excitation.amplitude_g", 0.2)?;
/// let orbit = Orbit::default().run(&weak, &Progress::none())?;
/// let rate = 2.0 * 0.023 * (80.0_f64 / 15.2e-3).sqrt();
/// assert!(orbit.is_stable() && orbit.period == 1);
/// assert!((orbit.determinant() - (-rate / 3.0).exp()).abs() < 1e-9);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Orbit {
    /// Its period in forcing periods, 1 to 1000; by default that of the settled motion, at most 12, or 1
    /// where a number of impacts is given.
    pub period: Option<u32>,
    /// Phase of the drive in degrees at which the state is given.
    pub phase_deg: f64,
    /// Which motion is meant: by default that near the settled motion of the run.
    pub begin: Begin,
}

impl Orbit {
    /// Finds the orbit by Newton's method.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<OrbitAnswer, Error> {
        check_period(self.period)?;
        can_have_orbits(simulation.document(), simulation.model())?;
        let phase = phase(self.phase_deg)?;
        let found = begun(simulation.model(), phase, self.period, self.begin, progress.stop());
        found.map_err(|error| no_orbit(simulation.document(), error, ""))
    }
}

/// A branch of periodic orbits, continued in a field and followed around folds.
///
/// The table of the answer has one row per orbit, in order along the branch: the field in its unit, the
/// columns of [`Orbit`], and `event`: empty, `fold`, `flip`, `symmetry` or `grazing`. Its method `remarks`
/// says where the branch ended inside the range, and why.
///
/// # Method
///
/// Pseudo-arclength continuation (Keller 1977). Events are located to some 1e-9 of the range. At a
/// grazing the stroboscopic map changes like the square root of the distance (Nordmark 1991), so the motion
/// that grazes is solved for with the instant of the touch as an unknown. Two events of a kind within a
/// hundredth of the range can be missed. A branch of the prototype takes about a second.
///
/// # Errors
///
/// Those of [`Orbit`] for the first orbit, and [`Error::Argument`] for a field or a range that is
/// wrong; a field of whole numbers has no branch. A branch that ends early is not an error.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Branch, Progress, Simulation};
///
/// // The stable motion in one well ends in a fold near 0.70 g; the branch goes back as an unstable one.
/// let simulation = Simulation::preset("nominal-cubic")?.with("stops", "None")?;
/// let question = Branch::over("excitation.amplitude_g", 0.6, 0.75);
/// let branch = question.run(&simulation, &Progress::none())?;
/// let table = branch.table();
/// let fold = table.words("event").iter().position(|event| *event == "fold").unwrap();
/// assert!((0.70..0.71).contains(&branch.values[fold]));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Branch {
    /// The field.
    pub field: String,
    /// Its value at the first orbit, and the value towards which the branch is continued.
    pub range: (f64, f64),
    /// Period of the first orbit in forcing periods, 1 to 1000; by default that of the settled motion.
    pub period: Option<u32>,
    /// Phase of the drive in degrees at which states are given.
    pub phase_deg: f64,
    /// The motion with which it begins, as of [`Orbit`].
    pub begin: Begin,
    /// Longest step, as a share of the range and of the scales of the state, 1e-4 to 0.05. A shorter one
    /// takes longer and misses fewer events.
    pub step: f64,
    /// Largest number of orbits, 1 to 1000000.
    pub count: usize,
}

impl Branch {
    /// A branch over a field, from one value towards another.
    pub fn over(field: impl Into<String>, from: f64, to: f64) -> Self {
        let (step, count) = (BranchOptions::STEP, BranchOptions::COUNT);
        Self {
            field: field.into(),
            range: (from, to),
            period: None,
            phase_deg: 0.0,
            begin: Begin::Run,
            step,
            count,
        }
    }

    /// Follows the branch. The value of the field in the scene is replaced by the first value of the range.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<BranchAnswer, Error> {
        self.with_switches(0, simulation, progress).map(|mut answer| answer.branches.swap_remove(0))
    }

    /// Follows the branch, and to this number of levels, at most 10, the branches that begin at its flips and
    /// breakings of the symmetry.
    ///
    /// ```
    /// # use interwell_studies as interwell;
    /// use interwell::questions::{Branch, Progress, Simulation};
    ///
    /// // A period is doubled near 0.05503 g: the branch of twice the period begins there.
    /// let question = Branch::over("excitation.amplitude_g", 0.056, 0.0548);
    /// let simulation = Simulation::preset("impact-oscillator")?;
    /// let answer = question.with_switches(1, &simulation, &Progress::none())?;
    /// assert!(answer.branches.len() > 1);
    /// # Ok::<(), interwell::questions::Error>(())
    /// ```
    pub fn with_switches(
        &self,
        levels: u32,
        simulation: &Simulation,
        progress: &Progress,
    ) -> Result<BranchesAnswer, Error> {
        if levels > MAX_LEVELS {
            return Err(Error::argument("switch", levels, format!("give 0 to {MAX_LEVELS}")));
        }
        check_fields(simulation.scene(), [(FIRST, &self.field_range())])?;
        let options = self.options()?;
        let from = self.range.0;
        let first = simulation.with_changes(&[(self.field.clone(), from.to_string())], progress)?;
        can_have_orbits(first.document(), first.model())?;
        let document = first.document();
        let family = Family::new(&document.scene, &document.files, first.mechanism(), &self.field);
        let found = progress.task(None, |task| {
            let first = branch(&family, &self.field, self.range, &options, task)?;
            switched(&family, first, self.range, levels, &options, task)
        });
        let found =
            found.map_err(|error| no_orbit(document, error, &format!("at {} = {from}: ", self.field)));
        let branches = found?;
        let begins = branches[0].orbits.first().map(|orbit| described(first.model(), orbit));
        Ok(BranchesAnswer { begins: begins.unwrap_or_default(), branches, range: self.range })
    }

    fn field_range(&self) -> FieldRange {
        FieldRange { field: self.field.clone(), range: self.range }
    }

    fn options(&self) -> Result<BranchOptions, Error> {
        check_period(self.period)?;
        if !STEPS.contains(&self.step) {
            let problem = format!("give a share of the range from {} to {}", STEPS.start(), STEPS.end());
            return Err(Error::number("step", self.step, problem));
        }
        if !COUNTS.contains(&self.count) {
            return Err(Error::argument("count", self.count, format!("give 1 to {}", COUNTS.end())));
        }
        let phase = phase(self.phase_deg)?;
        let Self { period, begin, step, count, .. } = *self;
        Ok(BranchOptions { phase, period, begin, step, count })
    }
}

/// Longest steps of a branch.
const STEPS: std::ops::RangeInclusive<f64> = 1e-4..=0.05;
/// Largest number of levels of branch switching; the last of ten has a period of 1024.
const MAX_LEVELS: u32 = 10;
const COUNTS: std::ops::RangeInclusive<usize> = 1..=1_000_000;

/// The arguments that give the field of a branch and its range.
const FIRST: [&str; 2] = ["field", "range"];
/// Those of the second field.
const SECOND: [&str; 2] = ["second", "second_range"];

/// Checks fields that take all values of a range, each with the arguments that give the field and the range,
/// which may be one.
fn check_fields<'a>(
    scene: &Scene,
    fields: impl IntoIterator<Item = ([&'a str; 2], &'a FieldRange)>,
) -> Result<(), Error> {
    let mut known: Vec<&str> = Vec::new();
    for ([of_field, of_range], FieldRange { field, range: (from, to) }) in fields {
        let ends = format!("{}:{}", number_text(*from), number_text(*to));
        let both = format!("{field}={ends}");
        let [of_both, ends] = if of_field == of_range { [&both; 2] } else { [field, &ends] };
        let wrong_range = |problem: String| Error::argument(of_range, ends, problem);
        let wrong_field = |problem: String| Error::argument(of_field, of_both, problem);
        let is_known = FieldPath::new(field).get(scene).is_some();
        let found = Axis::listed(field, vec![*from, *to], scene);
        found.map_err(|problem| if is_known { wrong_range(problem) } else { wrong_field(problem) })?;
        if !(from.is_finite() && to.is_finite()) {
            return Err(wrong_range("both ends of the range must be finite".to_owned()));
        }
        if from == to {
            return Err(wrong_range("both ends are equal; give a range, such as 0.5:2".to_owned()));
        }
        let problem = if is_whole(scene, field) {
            concat!(
                "this field holds whole numbers, and a branch takes all values between two ends; follow the \
                 motion by a `sweep` over it with ",
                named!("carry")
            )
        } else if ["run.", "start."].iter().any(|group| field.starts_with(group)) {
            "a periodic motion does not depend on this field; take another one"
        } else if known.contains(&field.as_str()) {
            "the branch is over this field already; name another one"
        } else {
            known.push(field);
            continue;
        };
        return Err(wrong_field(problem.to_owned()));
    }
    Ok(())
}

/// The answer of [`Branch::with_switches`]: the branch, and those that begin at its events.
///
/// [`branch_chart`](crate::output::branch_chart) draws them.
#[derive(Debug, Clone)]
pub struct BranchesAnswer {
    /// The branches, each after the one on which it begins; the first is the branch that was asked for.
    pub branches: Vec<BranchAnswer>,
    /// The motion with which the first one begins, in words.
    begins: String,
    range: (f64, f64),
}

impl BranchesAnswer {
    /// One row per orbit: `branch` (its number from 1) and `from` (the number of the branch on which it
    /// begins), then the columns of [`Branch`].
    pub fn table(&self) -> Table {
        branches_table(&self.branches)
    }

    /// The motion with which the first branch begins, and the remarks of each branch, with its number if
    /// there are several.
    pub fn remarks(&self) -> Vec<String> {
        let several = self.branches.len() > 1;
        let of_branch = |(number, branch): (u64, &BranchAnswer)| {
            let remark = move |line| if several { format!("branch {number}: {line}") } else { line };
            branch.remarks(self.range).into_iter().map(remark)
        };
        let begins = format!("the branch begins with {}", self.begins);
        std::iter::once(begins).chain((1..).zip(&self.branches).flat_map(of_branch)).collect()
    }
}

/// A motion in words: its period, its impacts, and where it is.
fn described(model: &Model, orbit: &OrbitAnswer) -> String {
    let count = |number: u64, one: &str| format!("{number} {one}{}", if number == 1 { "" } else { "s" });
    let place = match model.crossing_level() {
        None => "",
        Some(_) if orbit.passage.crossings() > 0 => ", across the barrier",
        Some(level) if orbit.state.x < level => ", left of the barrier",
        Some(_) => ", right of the barrier",
    };
    let impacts = match (model.stop_positions(), orbit.passage.rests()) {
        ((None, None), _) => String::new(),
        (_, 0) => format!(" with {}", count(orbit.passage.impacts, "impact")),
        (_, rests) => format!(" with {} on a stop", count(rests, "rest")),
    };
    format!("the motion that repeats after {}{impacts}{place}", count(orbit.period.into(), "forcing period"))
}

impl BranchAnswer {
    /// Remarks that have no column in the table: events that were not located and, unless the branch reached
    /// the end of its range, where and why it ended.
    pub fn remarks(&self, (from, to): (f64, f64)) -> Vec<String> {
        let field = &self.field;
        let at_stops =
            |orbit: &OrbitAnswer| !(orbit.passage.misses.is_empty() && orbit.contacts().is_empty());
        let changes = match self.orbits.iter().any(at_stops) {
            true => "its stability or how it touches the stops",
            false => "its stability",
        };
        let unlocated = |(before, after): &(f64, f64)| {
            format!(
                "between {field} = {before} and {after} the motion changes {changes}; no event was located \
                 there, and the table has none"
            )
        };
        let unbegun = |value: &f64| format!("no branch was found that begins at {field} = {value}");
        let mut lines: Vec<String> = self.unlocated.iter().map(unlocated).collect();
        lines.extend(self.unbegun.iter().map(unbegun));
        let at = self.values.last().copied().unwrap_or(f64::NAN);
        let why = match self.end {
            BranchEnd::Range if (at - to).abs() < (at - from).abs() => return lines,
            BranchEnd::Range => "it came back to the value at which it began".to_owned(),
            other => other.name().to_owned(),
        };
        lines.push(format!("the branch ends at {field} = {at}: {why}"));
        lines
    }
}

/// Loci in two fields: where the orbits of a branch fold, double their period, break their symmetry or graze
/// a stop.
///
/// The table of the answer has one row per orbit, in order along each locus: `locus` (its number from 1),
/// both fields in their units, the columns of [`Orbit`], and `event`: empty, `cusp`, `fold-flip`,
/// `grazing-fold`, `grazing-flip`, `grazing-symmetry` or `grazing-grazing`.
///
/// # Method
///
/// The branch is followed at the first value of the second field. From each of its events of this
/// kind a locus is continued towards the other value, by pseudo-arclength in the state and both fields, with
/// the characteristic polynomial of the map at 1 or -1 as one more equation (Kuznetsov 2004, section 10.3),
/// or with the touch of the stop for a grazing. Each point is checked: a multiplier within 1e-6 of 1 or -1, a
/// touch to 1e-9 of the scales.
///
/// # Errors
///
/// Those of [`Branch`], for both fields; [`Error::Failed`] if the branch has no such event.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Branch, BranchEvent, FieldRange, Locus, Progress, Simulation};
///
/// // The swing without impacts of a linear oscillator grazes the stop at an amplitude in closed form.
/// let simulation = Simulation::preset("impact-oscillator")?;
/// let second = FieldRange { field: "excitation.frequency_hz".into(), range: (0.1, 0.116) };
/// let branch = Branch { period: Some(1), ..Branch::over("excitation.amplitude_g", 0.05, 0.07) };
/// let found = Locus { branch, of: BranchEvent::Grazing, second }.run(&simulation, &Progress::none())?;
/// for [amplitude_g, frequency_hz] in &found.loci[0].values {
///     let w = std::f64::consts::TAU * frequency_hz;
///     let reached = amplitude_g * 9.806_65 / (1.0 - w * w).hypot(0.2 * w);
///     assert!((reached - 1.0).abs() < 1e-8);
/// }
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Locus {
    /// The branch on which the loci begin.
    pub branch: Branch,
    /// The kind of event on the loci.
    pub of: BranchEvent,
    /// The second field.
    pub second: FieldRange,
}

impl Locus {
    /// Follows the branch, and the loci from it.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<LocusAnswer, Error> {
        let Self { branch: over, of, second } = self;
        check_fields(simulation.scene(), [FIRST, SECOND].into_iter().zip([&over.field_range(), second]))?;
        let begin = [(&second.field, second.range.0), (&over.field, over.range.0)];
        let begin = begin.map(|(field, value)| (field.clone(), value.to_string()));
        let first = simulation.with_changes(&begin, progress)?;
        can_have_orbits(first.document(), first.model())?;
        let (document, options) = (first.document(), over.options()?);
        let family = Family::new(&document.scene, &document.files, first.mechanism(), &over.field);
        let failed = |error| no_orbit(document, error, &format!("at {} = {}: ", over.field, over.range.0));
        progress.task(None, |task| {
            let found = branch(&family, &over.field, over.range, &options, task).map_err(failed)?;
            if !found.events.contains(&Some(*of)) {
                return Err(Error::failed(document, self.lacking(&found)));
            }
            let found = loci(&family, &found, over.range, (*of, second), &options, task);
            Ok(LocusAnswer { loci: found.map_err(failed)? })
        })
    }

    /// The message that a branch has no event of this kind: which events it has, and where and why it ends.
    fn lacking(&self, found: &BranchAnswer) -> String {
        let Self { branch: Branch { field, range: (from, to), .. }, of, second } = self;
        let mut others: Vec<&str> = found.events.iter().flatten().map(|event| event.name()).collect();
        others.sort_unstable();
        others.dedup();
        let has = match others.is_empty() {
            true => "and no other event".to_owned(),
            false => format!("but {}", others.join(" and ")),
        };
        format!(
            "at {} = {}, the branch over {field} from {from} to {to} has no {} {has}; it ends at {}, {}: \
             take another range, start, period or number of motions",
            second.field,
            second.range.0,
            of.name(),
            found.values.last().unwrap_or(from),
            found.end.name()
        )
    }
}

/// The answer of [`Locus::run`]. A locus that ends early is no error: [`remarks`](Self::remarks) say where
/// and why; [`loci_chart`](crate::output::loci_chart) draws all of them.
#[derive(Debug, Clone)]
pub struct LocusAnswer {
    /// The loci, each from one event of the branch, in the order of the events.
    pub loci: Vec<OneLocus>,
}

impl LocusAnswer {
    /// One row per orbit, with the columns named at [`Locus`].
    pub fn table(&self) -> Table {
        loci_table(&self.loci)
    }

    /// Where and why each locus ended.
    pub fn remarks(&self) -> Vec<String> {
        let remark = |(number, locus): (u64, &OneLocus)| {
            let [first, second] = &locus.fields;
            let [at, and] = locus.values.last()?;
            Some(format!("locus {number} ends at {first} = {at}, {second} = {and}: {}", locus.end.name()))
        };
        (1..).zip(&self.loci).filter_map(remark).collect()
    }
}

/// Largest period of an orbit in forcing periods.
const MAX_PERIOD: u32 = 1000;

fn check_period(period: Option<u32>) -> Result<(), Error> {
    match period.filter(|period| !(1..=MAX_PERIOD).contains(period)) {
        Some(period) => Err(Error::argument("period", period, format!("give 1 to {MAX_PERIOD}"))),
        None => Ok(()),
    }
}

/// The phase in forcing periods.
pub(crate) fn phase(degrees: f64) -> Result<f64, Error> {
    match degrees.is_finite() {
        true => Ok(degrees / 360.0),
        false => Err(Error::number("phase_deg", degrees, PHASE)),
    }
}

/// Refuses a scene whose drive does not repeat.
fn can_have_orbits(document: &Document, model: &Model) -> Result<(), Error> {
    if !model.repeats() || !model.is_shaken() {
        let problem = "excitation: a periodic motion needs a drive that repeats and is not 0; take a Sine, \
                       Cosine or Force, or a Sum of them whose frequencies have a common period";
        return Err(Error::unfit(document, problem));
    }
    if model.keeps_charge() {
        return Err(Error::unfit(document, NoBasins::KeepsCharge));
    }
    Ok(())
}

/// The error for an orbit that was not found; `at` is a prefix that names the place, such as `at FIELD =
/// VALUE: `.
fn no_orbit(document: &Document, error: NoOrbit, at: &str) -> Error {
    match error {
        NoOrbit::Cancelled => Error::Cancelled,
        _ => Error::failed(document, format!("{at}{error}")),
    }
}
