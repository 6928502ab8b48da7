//! The error type of all questions.

use std::fmt;

use crate::dynamics::Model;
use crate::mechanics::{BuildError, FunctionError};
use crate::numeric::number_text;
use crate::scene::{ArgumentError, Document, DriveError, Fault, Origin, SceneError};
use crate::study::{CellFaults, GridError, Said, Spelling, followed_until};

/// Why a question has no answer.
///
/// [`faults`](Self::faults) lists what is wrong, with file, field, value and remedy. The message contains the
/// same, one fault per line. [`is_wrong_input`](Self::is_wrong_input) distinguishes faults that the caller
/// can correct from failures of the computation. That a run ends early (it leaves the force curve, or uses up
/// its budget of steps or impacts) is an outcome in the answer and not an error, except where a question has
/// no answer without the end of the run.
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::Simulation;
///
/// let error = Simulation::preset("nominal-cubic")?.with("stops.restitution", 1.2).unwrap_err();
/// assert!(error.is_wrong_input());
/// let fault = &error.faults()[0];
/// assert_eq!((fault.field.as_str(), fault.value.as_str()), ("stops.restitution", "1.2"));
/// assert!(fault.problem.contains("must be 0 to 1"));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// The scene cannot be read or has faults.
    Scene(SceneError),
    /// Cells of a grid over the scene have faults: a description of each cell, and its error.
    Cells(Vec<(String, SceneError)>),
    /// An argument of the question is wrong.
    Argument {
        /// Its name, such as `until_settled`.
        name: String,
        /// Its value as given.
        value: String,
        /// What is wrong, and the remedy.
        problem: Said,
    },
    /// The scene is valid, but the question does not apply to it.
    Unfit {
        /// Name of the scene.
        scene: String,
        /// What is missing, and the remedy.
        problem: Said,
    },
    /// The computation gave no answer.
    Failed {
        /// Name of the scene.
        scene: String,
        /// The reason.
        problem: Said,
    },
    /// The question was cancelled.
    Cancelled,
}

/// One thing that is wrong with a scene or an argument; [`Error::faults`] lists them.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct FaultAt {
    /// The scene file, or `built-in NAME`; empty for an argument.
    pub file: String,
    /// Line in the file, if the value is written there.
    pub line: Option<usize>,
    /// Dotted path of the field, or name of the argument; empty if neither is at fault.
    pub field: String,
    /// The value as written.
    pub value: String,
    /// The problem and its remedy.
    pub problem: String,
}

/// Largest number of cells whose faults a message lists.
const MAX_LISTED_CELLS: usize = 8;

impl Error {
    /// A wrong argument, as a study of a program's own refuses it.
    pub fn argument(name: impl Into<String>, value: impl fmt::Display, problem: impl fmt::Display) -> Self {
        Self::Argument { name: name.into(), value: value.to_string(), problem: Said::new(problem) }
    }

    /// A wrong number.
    pub fn number(name: impl Into<String>, value: f64, problem: impl fmt::Display) -> Self {
        Self::argument(name, number_text(value), problem)
    }

    /// A scene to which the question does not apply.
    pub fn unfit(document: &Document, problem: impl fmt::Display) -> Self {
        Self::Unfit { scene: document.name.clone(), problem: Said::new(problem) }
    }

    /// A computation without an answer.
    pub fn failed(document: &Document, problem: impl fmt::Display) -> Self {
        Self::Failed { scene: document.name.clone(), problem: Said::new(problem) }
    }

    /// Faults of a scene.
    #[doc(hidden)]
    pub fn faults_of(document: &Document, faults: Vec<Fault>) -> Self {
        Self::Scene(document.error_from(faults))
    }

    /// Faults of cells of a grid.
    #[doc(hidden)]
    pub fn cells_of(document: &Document, cells: Vec<CellFaults>) -> Self {
        let error = |cell: CellFaults| (cell.cell, document.error_from(cell.faults));
        Self::Cells(cells.into_iter().map(error).collect())
    }

    /// A mechanism that cannot be built. Wrong fields are a fault of the scene; valid flexures without a
    /// solution are a failed computation.
    #[doc(hidden)]
    pub fn unbuilt(document: &Document, error: BuildError) -> Self {
        match error {
            BuildError::Wrong(fault) => Self::faults_of(document, vec![fault]),
            BuildError::Unsolved(error) => Self::failed(document, error),
        }
    }

    /// A thread that the system does not give.
    #[doc(hidden)]
    pub fn no_thread() -> Self {
        Self::argument("threads", 1, "the system gives no thread; close another program")
    }

    /// All faults of the input; empty if the computation failed or was cancelled.
    pub fn faults(&self) -> Vec<FaultAt> {
        match self {
            Self::Scene(error) => scene_faults(error),
            Self::Cells(cells) => cells.iter().flat_map(|(_, error)| scene_faults(error)).collect(),
            Self::Argument { name, value, problem } => {
                vec![FaultAt { field: name.clone(), value: value.clone(), ..FaultAt::new("", problem) }]
            }
            Self::Unfit { scene, problem } => vec![FaultAt::new(scene, problem)],
            Self::Failed { .. } | Self::Cancelled => Vec::new(),
        }
    }

    /// The message for users of the command line: its remedies name options such as `--until-settled`, where
    /// those of [`faults`](Self::faults) and of `Display` name arguments.
    pub fn message(&self) -> String {
        self.spelled(Spelling::CommandLine)
    }

    fn spelled(&self, spelling: Spelling) -> String {
        match self {
            Self::Scene(error) => scene_text(error, spelling),
            Self::Cells(cells) => {
                let lines = cells.iter().take(MAX_LISTED_CELLS).map(|(cell, error)| match cell.as_str() {
                    "" => scene_text(error, spelling),
                    cell => format!("in the cell {cell}:\n{}", scene_text(error, spelling)),
                });
                let more = cells.len().saturating_sub(MAX_LISTED_CELLS);
                let more = (more > 0).then(|| format!("and {more} more cells are wrong"));
                lines.chain(more).collect::<Vec<_>>().join("\n")
            }
            Self::Argument { name, value, problem } => {
                format!("{}: {}", with_value(name, value), problem.spelled(spelling))
            }
            Self::Unfit { scene, problem } | Self::Failed { scene, problem } => {
                format!("{scene}: {}", problem.spelled(spelling))
            }
            Self::Cancelled => "cancelled".to_owned(),
        }
    }

    /// The first problem and its remedy, without the name of the scene or of the argument, for a program in
    /// which both are clear.
    #[doc(hidden)]
    pub fn problem(&self) -> String {
        match self {
            Self::Argument { problem, .. } | Self::Unfit { problem, .. } | Self::Failed { problem, .. } => {
                problem.spelled(Spelling::CommandLine)
            }
            Self::Scene(_) | Self::Cells(_) | Self::Cancelled => {
                self.faults().first().map_or_else(|| self.message(), |fault| fault.problem.clone())
            }
        }
    }

    /// The same error for a surface with other names of some arguments; the first of each pair is that here.
    #[must_use]
    pub fn renamed(self, names: &[[&'static str; 2]]) -> Self {
        let named = |problem: &Said| names.iter().fold(problem.clone(), |text, [a, b]| text.renamed(a, b));
        match self {
            Self::Argument { name, value, problem } => {
                let known = names.iter().find(|[here, _]| *here == name);
                let name = known.map_or(name, |[_, there]| (*there).to_owned());
                Self::Argument { name, value, problem: named(&problem) }
            }
            Self::Unfit { scene, problem } => Self::Unfit { scene, problem: named(&problem) },
            Self::Failed { scene, problem } => Self::Failed { scene, problem: named(&problem) },
            other => other,
        }
    }

    /// Whether the scene or an argument is wrong. Otherwise the computation failed or was cancelled.
    pub fn is_wrong_input(&self) -> bool {
        !matches!(self, Self::Failed { .. } | Self::Cancelled)
    }
}

impl FaultAt {
    fn new(file: &str, problem: impl fmt::Display) -> Self {
        let (file, problem) = (file.to_owned(), problem.to_string());
        Self { file, line: None, field: String::new(), value: String::new(), problem }
    }
}

fn scene_faults(error: &SceneError) -> Vec<FaultAt> {
    match error {
        SceneError::NoSuchScene { spec, .. } => vec![FaultAt::new(spec, error)],
        SceneError::Unreadable { name, problem } => vec![FaultAt::new(name, problem)],
        SceneError::Structure { name, place, problem, .. } => {
            vec![FaultAt { line: Some(place.line), ..FaultAt::new(name, problem) }]
        }
        SceneError::Faults { name, faults, .. } => {
            let fault = |placed: &crate::scene::PlacedFault| FaultAt {
                line: if let Origin::Text(place) = &placed.origin { Some(place.line) } else { None },
                field: placed.fault.field.clone(),
                value: placed.fault.value.clone(),
                ..FaultAt::new(name, &placed.fault.problem)
            };
            faults.iter().map(fault).collect()
        }
        SceneError::Argument(error) => {
            let (field, value) = written(error);
            let (field, value) = (field.to_owned(), value.to_owned());
            vec![FaultAt { field, value, ..FaultAt::new("", &error.problem) }]
        }
    }
}

/// An error of a scene; a program has given values of fields, and no options.
fn scene_text(error: &SceneError, spelling: Spelling) -> String {
    match (error, spelling) {
        (_, Spelling::CommandLine) => error.to_string(),
        (SceneError::Argument(error), _) => {
            let (field, value) = written(error);
            format!("{}: {}", with_value(field, value), error.problem)
        }
        _ => {
            let mut error = error.clone();
            if let SceneError::Faults { faults, .. } = &mut error {
                let given = faults.iter_mut().filter(|fault| matches!(fault.origin, Origin::Argument(_)));
                given.for_each(|fault| fault.origin = Origin::Unwritten);
            }
            error.to_string()
        }
    }
}

/// A name with its value, if it has one.
fn with_value(name: &str, value: &str) -> String {
    if value.is_empty() { name.to_owned() } else { format!("{name} = {value}") }
}

/// The field and the value of an argument `--option FIELD=VALUE`, or the option alone.
fn written(error: &ArgumentError) -> (&str, &str) {
    let argument = error.argument.trim_start_matches("--");
    let written = argument.split_once(' ').map_or(argument, |(_, written)| written);
    written.split_once('=').unwrap_or((written, ""))
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.spelled(Spelling::Program))
    }
}

impl std::error::Error for Error {}

impl From<SceneError> for Error {
    fn from(error: SceneError) -> Self {
        Self::Scene(error)
    }
}

impl From<ArgumentError> for Error {
    fn from(error: ArgumentError) -> Self {
        Self::Scene(error.into())
    }
}

impl From<FunctionError> for Error {
    fn from(error: FunctionError) -> Self {
        use FunctionError as Wrong;
        let (name, value) = match &error {
            Wrong::Cancelled => return Self::Cancelled,
            Wrong::Range(low, high) => ("range", format!("{}:{}", number_text(*low), number_text(*high))),
            Wrong::Tolerance(tolerance) => ("tolerance", number_text(*tolerance)),
            Wrong::Break(at) => ("breaks", number_text(*at)),
            Wrong::NotFinite(_, force) => ("force", number_text(*force)),
            Wrong::Pieces(pieces, ..) => ("pieces", pieces.to_string()),
            Wrong::Step(at) | Wrong::Rough(at) => {
                ("force", format!("a function, near {} m", number_text(*at)))
            }
            Wrong::Samples(_) | Wrong::Fit(_) => ("force", "samples".to_owned()),
        };
        Self::argument(name, value, error)
    }
}

impl From<DriveError> for Error {
    fn from(error: DriveError) -> Self {
        use DriveError as Wrong;
        let (name, value) = match &error {
            Wrong::Frequency(hz) | Wrong::Digits(hz, _) => ("frequency_hz", number_text(*hz)),
            Wrong::Tolerance(tolerance) => ("tolerance", number_text(*tolerance)),
            Wrong::NotFinite(_, value) | Wrong::TooLarge(_, value) => ("acceleration", number_text(*value)),
            Wrong::Samples(count) => ("acceleration", format!("{count} samples")),
            Wrong::Unresolved(at, _) => ("acceleration", format!("a function, at {} s", number_text(*at))),
        };
        Self::argument(name, value, error)
    }
}

impl From<GridError> for Error {
    fn from(error: GridError) -> Self {
        let value = match &error {
            GridError::NoAxes => "none".to_owned(),
            GridError::TooMany(cells) => format!("{cells} cells"),
        };
        Self::argument("over", value, error)
    }
}

/// Longest `until_settled` in s, which is the longest duration of a run.
const MAX_UNTIL_SETTLED: f64 = 1e9;

/// The time in s up to which a run of `model` is worth to be continued, if its motion can be seen to repeat.
#[doc(hidden)]
pub fn longest_wait(model: &Model) -> Option<f64> {
    model.can_settle().then(|| followed_until(model).min(MAX_UNTIL_SETTLED))
}

/// Checks that runs of `model` can continue up to `until` s.
pub(super) fn check_until_settled(until: f64, document: &Document, model: &Model) -> Result<(), Error> {
    let duration = model.duration();
    let wrong =
        |problem: String| Err(Error::number("until_settled", until, format!("{}: {problem}", document.name)));
    if !model.can_settle() {
        return match model.forcing_period() {
            Some(period) if model.repeats() => wrong(format!(
                "its settled window of {} s holds less than two forcing periods of {period} s, too few to \
                 tell whether the motion repeats; lengthen run.duration_s",
                duration - model.settle()
            )),
            _ => wrong(
                "its excitation does not repeat, so the motion has no period to wait for; take a Sine, or a \
                 Sum of sines whose frequencies have a common period"
                    .to_owned(),
            ),
        };
    }
    if !(until >= duration) {
        return wrong(format!(
            "its run already lasts {duration} s; give at least that, or shorten run.duration_s"
        ));
    }
    if until > MAX_UNTIL_SETTLED {
        return Err(Error::number("until_settled", until, format!("at most {MAX_UNTIL_SETTLED:e} s")));
    }
    Ok(())
}
