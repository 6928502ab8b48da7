//! Questions that can be asked for every cell of a grid: sections and exponents; and the fields of grids.

use std::ops::RangeInclusive;
use std::sync::Arc;

use super::error::check_until_settled;
use super::motion::may_have_circuit;
use super::orbits::phase;
use super::{Error, Progress, Simulation, Sweep};
use crate::dynamics::{Model, Summary};
use crate::mechanics::{ForceCurve, Mechanism};
use crate::scene::Mechanism::Linear;
use crate::scene::{Damping, Document, Scene, Start, Stops, Transducer};
use crate::study::{
    ExponentCells, ExponentOptions, Exponents as ExponentsAnswer, Grid, GridStudy, IMPACTS, MAX_SECTION,
    NoExponents, Question, SectionAt, SectionOptions, Sections, Table, drive_fault, exponents, section,
};

/// Fields, each with its values.
pub(super) type Over = Vec<(String, Vec<f64>)>;

/// `count` evenly spaced values over a range, each rounded to 15 significant digits, so that 0.58 is 0.58 and
/// not 0.5800000000000001.
pub(super) fn even(range: RangeInclusive<f64>, count: usize) -> Vec<f64> {
    let (from, to) = (*range.start(), *range.end());
    let last = count.saturating_sub(1).max(1) as f64;
    let value = |i: usize| {
        let plain = from + (to - from) * (i as f64 / last);
        format!("{plain:.14e}").parse().unwrap_or(plain)
    };
    (0..count).map(value).collect()
}

/// Methods that set the fields of a grid.
macro_rules! over_fields {
    ($($question:ident)*) => {$(
        impl $question {
            /// A grid over a field, with `count` even values including both ends of the range.
            pub fn over(field: impl Into<String>, range: RangeInclusive<f64>, count: usize) -> Self {
                Self::default().and(field, range, count)
            }

            /// A grid over these values of a field.
            pub fn over_values(field: impl Into<String>, values: impl Into<Vec<f64>>) -> Self {
                Self::default().and_values(field, values)
            }

            /// Adds a field to the grid, whose values change faster than those of the fields before it.
            #[must_use]
            pub fn and(self, field: impl Into<String>, range: RangeInclusive<f64>, count: usize) -> Self {
                self.and_values(field, even(range, count))
            }

            /// Adds a field with these values to the grid, which change faster than those of the fields
            /// before it.
            #[must_use]
            pub fn and_values(mut self, field: impl Into<String>, values: impl Into<Vec<f64>>) -> Self {
                self.over.push((field.into(), values.into()));
                self
            }
        }
    )*};
}

over_fields!(Sweep Section Exponents);
pub(super) use over_fields;

/// Largest number of forcing periods that a section skips.
const MAX_SKIP: u64 = 1_000_000_000;
/// Numbers of forcing periods that a section may keep.
const KEPT: RangeInclusive<u64> = 1..=MAX_SECTION;

/// The states of a motion once per forcing period (Poincaré's section) or at its impacts; over a field they
/// give a bifurcation diagram.
///
/// # Columns
///
/// The fields, with `carry` the `direction`, `index`, `t_s`, then `x_m,v_m_per_s` (at an event the
/// state after it), or at impacts `side,phase_deg,v_in_m_per_s`. The states are values of the integrator's
/// polynomials. The more periods `options` skips, the fewer rows belong to a transient; at most 1e9 are
/// skipped, and 1 to 4194304 kept. The cost is that of the forcing periods that are run.
///
/// # Errors
///
/// [`Error::Argument`] for wrong fields, numbers of periods, phase or `until_settled`, and for `carry`
/// without a field; [`Error::Scene`], in a grid [`Error::Cells`], if the drive does not repeat (impacts alone
/// need no period) or the settled window holds no forcing period or more than 4194304.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Progress, Section, Simulation};
///
/// // From 5 to 10 s at 3 Hz: 15 states, all at rest on the stop at 4 mm.
/// let simulation = Simulation::preset("nominal-cubic")?;
/// let table = Section::default().run(&simulation, &Progress::none())?;
/// assert_eq!(table.rows(), 15);
/// assert!(table.numbers("x_m").unwrap().iter().all(|x| (x - 4e-3).abs() < 1e-9));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// The fields, the slowest first; if there are none, the section is that of the scene.
    pub over: Over,
    /// Where the section is taken, over which forcing periods, and how runs continue.
    pub options: SectionOptions,
}

impl Section {
    /// Computes the section, or that of each cell.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        let table = match self.over.is_empty() {
            true => self.of_one(simulation, progress)?.0,
            false => self.in_cells(simulation.document(), simulation.grid(&self.over)?, progress)?,
        };
        Ok(table.without(IMPACTS))
    }

    /// The sections of the cells of a grid, with the column of impacts; see [`cells`](Self::cells).
    #[doc(hidden)]
    pub fn in_cells(&self, document: &Document, grid: Grid, progress: &Progress) -> Result<Table, Error> {
        all_rows(&self.cells(document, grid, progress)?, document, progress)
    }

    /// The section of the scene itself with the column of impacts that a picture needs, and the summary of
    /// its run.
    #[doc(hidden)]
    pub fn of_one(&self, simulation: &Simulation, progress: &Progress) -> Result<(Table, Summary), Error> {
        self.check()?;
        if let Some(carry) = self.options.carry {
            return Err(Error::argument("carry", carry.name(), "walks a field: name one by over"));
        }
        let (document, run) = (simulation.document(), self.options.model(simulation.model().clone()));
        check_until(self.options.until_settled, document, &run)?;
        let found = section(simulation.model(), simulation.scene(), &self.options, progress.stop());
        let found = found.map_err(|fault| Error::faults_of(document, vec![fault]))?;
        if progress.is_stopped() { Err(Error::Cancelled) } else { Ok(found) }
    }

    /// The sections of the cells of a grid, not yet run, for a program that writes rows as they come. The
    /// scene itself, whose values of the fields are never run, needs no model.
    #[doc(hidden)]
    pub fn cells(&self, document: &Document, grid: Grid, progress: &Progress) -> Result<Sections, Error> {
        self.check()?;
        let study = Sections::new(&document.scene, &document.files, grid).with(self.options);
        settles(study, self.options.until_settled, document, progress)
    }

    fn check(&self) -> Result<(), Error> {
        if let SectionAt::Phase(degrees) = self.options.at {
            phase(degrees)?;
        }
        let wrong = |(skip, keep): &(u64, u64)| *skip > MAX_SKIP || !KEPT.contains(keep);
        self.options.periods.filter(wrong).map_or(Ok(()), |(skip, keep)| {
            let problem = format!("skip at most {MAX_SKIP} forcing periods, and keep 1 to {MAX_SECTION}");
            Err(Error::argument("skip", format!("{skip}, keep = {keep}"), problem))
        })
    }
}

/// Lyapunov exponents of the settled motion: the rates in 1/s at which small perturbations grow or decay.
///
/// # Columns
///
/// The fields, `exponent_1_per_s`, `exponent_1_se`, `exponent_2_per_s`, `exponent_2_se` (standard
/// errors), `sum_per_s`, `exact_sum_per_s` (from damping, circuit and impacts alone) and `dimension` (Kaplan
/// and Yorke 1979); where there may be a circuit also `exponent_3_per_s`, `exponent_3_se`. The exponents are
/// minus infinity where the mass rests on a stop, except that of a circuit.
///
/// # Method
///
/// Of a motion that repeats, ln|multiplier| over its period; otherwise averages over
/// `options.periods`, 1 to 1e7 (Benettin et al. 1980), through impacts by saltation (Müller 1995), with
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
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exponents {
    /// The fields, the slowest first; if there are none, the exponents are those of the scene.
    pub over: Over,
    /// Number of forcing periods of the averages, and the time that a motion may take to settle.
    pub options: ExponentOptions,
}

const AVERAGED: RangeInclusive<u32> = 1..=10_000_000;

impl Exponents {
    /// Computes the exponents.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<Table, Error> {
        if self.over.is_empty() {
            return Ok(self.of_one(simulation, progress)?.table());
        }
        let (document, grid) = (simulation.document(), simulation.grid(&self.over)?);
        all_rows(&self.cells(document, grid, progress)?, document, progress)
    }

    /// The exponents of the scene itself, whatever `over` says, and how they were computed.
    pub fn of_one(&self, simulation: &Simulation, progress: &Progress) -> Result<ExponentsAnswer, Error> {
        self.check()?;
        let document = simulation.document();
        if let Some(fault) = drive_fault(simulation.model(), simulation.scene()) {
            return Err(Error::faults_of(document, vec![fault]));
        }
        check_until(self.options.until_settled, document, simulation.model())?;
        exponents(simulation.model(), &self.options, progress.stop()).map_err(|problem| match problem {
            NoExponents::Cancelled => Error::Cancelled,
            _ => Error::failed(document, problem),
        })
    }

    /// The exponents of the cells of a grid, not yet computed; see [`Section::cells`].
    #[doc(hidden)]
    pub fn cells(
        &self,
        document: &Document,
        grid: Grid,
        progress: &Progress,
    ) -> Result<ExponentCells, Error> {
        self.check()?;
        let options = ExponentOptions { circuits: may_have_circuit(document, grid.axes()), ..self.options };
        let study = ExponentCells::new(&document.scene, &document.files, grid).with(options);
        settles(study, self.options.until_settled, document, progress)
    }

    fn check(&self) -> Result<(), Error> {
        let periods = self.options.periods;
        match AVERAGED.contains(&periods) {
            true => Ok(()),
            false => Err(Error::argument("periods", periods, format!("give 1 to {}", AVERAGED.end()))),
        }
    }
}

/// Checks the time up to which runs of `model` may continue, if one is given.
pub(super) fn check_until(until: Option<f64>, document: &Document, model: &Model) -> Result<(), Error> {
    until.map_or(Ok(()), |until| check_until_settled(until, document, model))
}

/// The study, once the time up to which its runs may continue is checked with the model of the first cell.
pub(super) fn settles<Q: Question>(
    study: GridStudy<Q>,
    until: Option<f64>,
    document: &Document,
    progress: &Progress,
) -> Result<GridStudy<Q>, Error> {
    if until.is_some()
        && let Some(model) = study.first_model(&progress.silent())
    {
        check_until(until, document, &model)?;
    }
    // the faults of a first cell without a model are found with those of the others
    Ok(study)
}

/// Checks all cells; then runs these and returns all rows.
pub(super) fn all_rows<Q: Question>(
    study: &GridStudy<Q>,
    document: &Document,
    progress: &Progress,
) -> Result<Table, Error> {
    let silent = progress.silent();
    let mut all = study.empty_table();
    progress.pool(|pool| {
        study.validate(pool, &silent).map_err(|cell| Error::cells_of(document, vec![cell]))?;
        let write = |rows: &Table| {
            all.append(rows);
            Ok::<_, std::convert::Infallible>(true)
        };
        let runs = study.rows() * study.runs_per_row();
        let end = progress.task(Some(runs), |task| study.run(pool, task, write));
        // rows in memory can always be written
        end.map_err(|_| Error::Cancelled)
    })??;
    Ok(all)
}

/// A model for the check of `until_settled`, which depends only on the drive and the run of `scene`: a mass
/// on a linear spring with these. So the check needs no mechanism, which a grid or a design may replace.
pub(super) fn drive_alone(document: &Document, scene: Scene) -> Result<Model, Error> {
    let alone = Scene {
        mass_g: 1.0,
        mechanism: Linear { n_per_m: 1.0 },
        damping: Damping::None,
        stops: Stops::None,
        transducer: Transducer::None,
        start: Start::Rest,
        ..scene
    };
    let mechanism = Mechanism::new(ForceCurve::polynomial(&[0.0, 1.0]));
    Model::build(&alone, Arc::new(mechanism)).map_err(|faults| Error::faults_of(document, faults))
}
