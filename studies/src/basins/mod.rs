//! Basins of attraction: the attractor that each start of a scene reaches.
//!
//! Each start begins at time 0 and is followed until one of the following holds:
//!
//! - The mass rests on a rigid stop. The drive alone determines when it is released, so motions that share a
//!   release are identical from then on, to the last bit. What follows a release is computed once.
//! - A stroboscopic state comes within a thousandth of the scene's scales of a known stable orbit, inside an
//!   ellipse around it from which all motions go to the orbit (see `orbit`). A motion that repeats only
//!   proposes an orbit, so that a transient near a saddle is followed further. (Datseris and Wagemakers
//!   (2022) also recognise a motion by its return to known ones, on a grid of cells.)
//! - Neither happens for a thousand periods. A `Verdict` then says whether the motion is irregular. When the
//!   first such motion is met, the study looks for regions that no motion leaves (see `region`); motions that
//!   enter one need not be followed further.
//!
//! The answer of a start depends on no other start. All use the scales of a mass at rest in the middle; an
//! orbit has the same ellipses whichever start proposes it, and a start that comes before its orbit is known
//! is followed again; regions come from starts of their own; and each start may take the same work. Known
//! attractors change only between rounds, so that the result has the same bits for any number of threads.

mod answer;
mod chart;
mod map;
mod orbit;
mod region;
mod rounds;
mod starts;
mod stroboscopic;
mod sure;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use serde::Deserialize;

use crate::mechanics::Mechanism;
use crate::numeric::short;
use crate::output::{MAX_PICTURE_CELLS, NoPicture};
use crate::questions::{Error, Progress, Simulation};
use crate::scene::Document;
use crate::study::{Answered, Grid, Heading, Scenes, Study, Table, counted, headings, named, whole};
pub use answer::{Answer, Attractor, Shares};
pub use chart::basins_chart;
pub use map::{BasinMap, NoBasins};
use starts::{AS_EVEN, MAX_STARTS, StartsError};
pub use starts::{EvenRange, Starts};

/// The attractor that each of many starts goes to, and the share of the starts that go to each attractor.
///
/// One row per start, the displacement the slower, or in the order in which random ones were drawn; and one
/// row per attractor.
///
/// # Method
///
/// Starts that share a release share everything after it, which is computed once. Without rest a
/// start is followed until it enters an ellipse around a stable orbit (motions told by their return to known
/// ones: Datseris and Wagemakers 2022). The shares of `random` starts are the basin stability of Menck et al.
/// (2013). A row is `sure` if a second run at a thousandth of the tolerance stays beside the first one up to
/// the attractor; it depends on no other start. Without rests of the mass the cost per start is many times as
/// large; at most 1e7 starts are taken.
///
/// # Errors
///
/// [`Error::Argument`] for wrong ranges or numbers of starts, or if all starts lie beyond a stop or
/// the end of the force curve; [`Error::Unfit`] if the drive changes and does not repeat, or nothing takes
/// energy. A start that reaches no attractor has no number.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Basins, Progress, Simulation};
///
/// // Below the release amplitude the mass stays at rest on the left or on the right stop.
/// let weak = Simulation::preset("nominal-cubic")?.with("excitation.amplitude_g", 0.6)?;
/// let found = Basins::of((-4.0, 4.0, 5), (-0.2, 0.2, 3)).run(&weak, &Progress::none())?;
/// assert_eq!(found.table().rows(), 15);
/// assert_eq!(found.attractors().words("side"), ["left", "right"]);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, Default, PartialEq, Args, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[command(after_help = EXAMPLES)]
#[group(skip)]
pub struct Basins {
    /// Displacements in mm from which the mass starts: N from A to B, both included; A:B with --random
    #[arg(long, value_name = "A:B:N", allow_hyphen_values = true)]
    #[arg(default_value_t, hide_default_value = true)]
    pub x_mm: EvenRange,
    /// Velocities in m/s with which it starts, likewise
    #[arg(long, value_name = "A:B:N", allow_hyphen_values = true)]
    #[arg(default_value_t, hide_default_value = true)]
    pub v: EvenRange,
    /// Number of starts drawn uniformly from the two ranges A:B, in place of a grid; the shares of the
    /// attractors are then their basin stability
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = whole::<u64>(1..=MAX_STARTS))]
    pub random: Option<u64>,
    /// Seed of --random; whole, 0 or above [default: 0]
    #[arg(long, value_name = "S", allow_hyphen_values = true, requires = "random")]
    #[arg(value_parser = whole::<u64>(0..=u64::MAX))]
    pub seed: Option<u64>,
    /// Where the attractors go: regime, period, side, RMS velocity, a state, and the share of the starts
    #[arg(long, value_name = "FILE", allow_hyphen_values = true)]
    #[serde(skip)]
    pub attractors: Option<PathBuf>,
}

const EXAMPLES: &str = "\
A row is `sure` where the error of the integration cannot change its answer: a second run at a thousandth
of the tolerance stays within a tenth of the scene's scales of the first one up to the attractor.

Examples:
  interwell --headless basins paper --x-mm -1.5:1.5:101 --v -0.5:0.5:101 --out basins.csv --plot basins.png
  interwell --headless basins duffing --x-mm -2000:2000:200 --v -2:2:200 --attractors - --out /dev/null
  interwell --headless basins paper-unconstrained --x-mm -8:8 --v -0.5:0.5 --random 1000 --out starts.csv";

/// The answer of [`Basins::run`]: [one row per start](Self::table), [one per attractor](Self::attractors).
#[derive(Debug)]
pub struct BasinsAnswer {
    /// The starts, as [`basins_chart`] takes them.
    pub basins: BasinMap,
    /// The attractors, and the attractor of each start.
    pub answer: Answer,
}

/// A callback for what is known of basins.
type Coarse<'a> = &'a (dyn Fn(&BasinMap, Answer) + Sync);

/// A forecast is given if one start may take more steps than this, about half a second of a core.
const MANY_STEPS: f64 = 1e6;

impl Study for Basins {
    const NAME: &'static str = "basins";
    const SCENE: &'static str = "Scene file or built-in scene; its start is not used";
    const PARTS: &'static str = "starts followed";
    const GRID: bool = false;
    const ROW_A_CELL: bool = false;
    const PYTHON: &'static str = "";

    fn check(&self, _: &Scenes) -> Result<(), Error> {
        self.starts().map(|_| ())
    }

    fn forecast(&self, scenes: &Scenes) -> Result<Option<String>, Error> {
        let (steps, seconds) = self.begin(scenes.document, &scenes.mechanism()?)?.cost_of_a_period();
        let periods = BasinMap::PATIENCE as f64;
        Ok((steps * periods > MANY_STEPS).then(|| {
            format!(
                "a forcing period takes some {} steps: a start is followed for at most {periods} of them, \
                 which takes some {} s of a core; a start that takes far more than the others ends early",
                short(steps),
                short((seconds * periods).ceil())
            )
        }))
    }

    fn answer(&self, scenes: &Scenes, progress: &Progress) -> Result<Answered, Error> {
        let begun = self.begin(scenes.document, &scenes.mechanism()?)?;
        let found = Arc::new(Self::followed(begun.checked(), progress, None)?);
        let of_parts = Arc::clone(&found);
        let part = move |begin, end| of_parts.answer.table(&of_parts.basins, begin, end);
        let answered = Answered::in_parts(found.answer.rows.len(), part)
            .told([found.answer.described()])
            .beside(found.attractors());
        let of_manifest = Arc::clone(&found);
        let answered =
            answered.documented(move |manifest| manifest.of_basins(&of_manifest.basins, &of_manifest.answer));
        Ok(answered.drawn(move |_, _| Ok(basins_chart(&found.basins, &found.answer))))
    }

    fn files(&self) -> Vec<(&'static str, &Path)> {
        self.attractors.iter().map(|path| ("--attractors", path.as_path())).collect()
    }

    fn can_draw(&self, _: &Grid) -> Result<(), NoPicture> {
        match self.random.unwrap_or(self.x_mm.count.saturating_mul(self.v.count)) {
            count if count > MAX_PICTURE_CELLS => Err(NoPicture::Starts(count)),
            _ => Ok(()),
        }
    }

    fn columns() -> Vec<Vec<Heading>> {
        vec![headings(answer::start_columns()), headings(answer::attractor_columns())]
    }
}

impl Basins {
    /// A grid of starts: first and last displacement in mm and velocity in m/s, and how many.
    pub fn of(x_mm: (f64, f64, u64), v: (f64, f64, u64)) -> Self {
        Self { x_mm: x_mm.into(), v: v.into(), ..Self::default() }
    }

    /// The starts; an error if an argument is wrong.
    fn starts(&self) -> Result<Starts, Error> {
        let wrong = |name: &'static str, value: String| {
            move |problem: StartsError| Error::argument(name, value, problem)
        };
        let Self { x_mm, v, .. } = *self;
        if let Some((name, _)) = [("x_mm", x_mm), ("v", v)].iter().find(|(_, range)| !range.is_given()) {
            return Err(Error::argument(*name, "", format!("is missing: {AS_EVEN}")));
        }
        let Some(count) = self.random else {
            if let Some(seed) = self.seed {
                let problem = format!("belongs to {}: give that too, or leave it out", named!("random"));
                return Err(Error::argument("seed", seed, problem));
            }
            x_mm.check().map_err(wrong("x_mm", x_mm.to_string()))?;
            v.check().map_err(wrong("v", v.to_string()))?;
            return Starts::grid(&x_mm, &v).map_err(wrong("x_mm", x_mm.to_string()));
        };
        for (name, range) in [("x_mm", x_mm), ("v", v)] {
            if range.count > 0 {
                let random = named!("random");
                let problem = format!("write A:B with {random}, which is the number of starts");
                return Err(Error::argument(name, range, problem));
            }
            let checked = Starts::random(range.ends(), (0.0, 0.0), 1, 0);
            checked.map_err(wrong(name, range.to_string()))?;
        }
        let drawn = Starts::random(x_mm.ends(), v.ends(), count, self.seed.unwrap_or(0));
        drawn.map_err(wrong("random", count.to_string()))
    }

    /// Follows the starts, each twice: the second run tells whether the answer is sure.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<BasinsAnswer, Error> {
        let begun = self.begin(simulation.document(), simulation.mechanism())?;
        Self::followed(begun.checked(), progress, None)
    }

    /// The starts before any is followed, of a scene whose own start need not be possible.
    #[doc(hidden)]
    pub fn begin(&self, document: &Document, mechanism: &Arc<Mechanism>) -> Result<BasinMap, Error> {
        let begun = BasinMap::new(&document.scene, Arc::clone(mechanism), self.starts()?);
        begun.map_err(|problem| match problem {
            NoBasins::Faults(faults) => Error::faults_of(document, faults),
            NoBasins::Beyond { .. } => Error::argument("x_mm", self.x_mm, problem),
            _ => Error::unfit(document, problem),
        })
    }

    /// Follows the starts that [`begin`](Self::begin), from coarse to fine. `coarse` gets what is known after
    /// each level but the last.
    #[doc(hidden)]
    pub fn followed(
        mut basins: BasinMap,
        progress: &Progress,
        coarse: Option<Coarse>,
    ) -> Result<BasinsAnswer, Error> {
        let answer = progress.shared(basins.starts().count() as u64, |pool, task| {
            while !basins.is_whole() && basins.run_level(pool, task) {
                if let Some(coarse) = coarse.filter(|_| !basins.is_whole()) {
                    coarse(&basins, basins.answer(task)?);
                }
            }
            basins.answer(task).filter(|_| basins.is_whole())
        })?;
        let answer = answer.ok_or(Error::Cancelled)?;
        Ok(BasinsAnswer { basins, answer })
    }
}

impl BasinsAnswer {
    /// One row per start, the displacement the slower, or in the order in which they were drawn.
    pub fn table(&self) -> Table {
        self.answer.table(&self.basins, 0, self.answer.rows.len())
    }

    /// One row per attractor.
    pub fn attractors(&self) -> Table {
        self.answer.attractors_table()
    }
}

impl Answer {
    /// The numbers of starts and attractors in words, and of starts without one.
    fn described(&self) -> String {
        let attractors = counted(self.attractors.len() as u64, "attractor");
        let mut text = format!("{}, {attractors}", counted(self.rows.len() as u64, "start"));
        let undecided = format!("not settled after {} periods", BasinMap::PATIENCE);
        for (count, what) in [
            (self.unsure(), "not sure"),
            (self.outside, "outside the room of the mass"),
            (self.lost - self.spent, "ended early"),
            (
                self.spent,
                "out of work: a motion far faster than its drive; raise the frequency or the damping",
            ),
            (self.undecided, undecided.as_str()),
        ] {
            if count > 0 {
                text += &format!(", {count} {what}");
            }
        }
        text
    }
}
