//! Distance of the motions of other scenes from that of one.

mod chart;

use crate::numeric::number_text;
use crate::questions::{Error, Progress, Simulation};
use crate::study::{Keep, Table, Values};
pub use chart::distance_chart;

/// Names of the other scenes.
const LETTERS: [&str; 3] = ["A", "B", "C"];

/// Steps between the rows of the answer.
const STEPS: usize = 2000;

/// How far the motions of other scenes are from that of one, over time, each from the start of its scene.
///
/// [`DistanceAnswer::table`] has a row for each of 2001 times: `t_s`, and `distance_a_m` to `distance_c_m`,
/// the difference of the displacements without its sign, missing after a run has ended early. Of a scene
/// that begins a micrometre beside the other it is the growth of a small error.
///
/// Errors: [`Error::Argument`] for `of` without a scene or with more than three, and for `times`;
/// [`Error::Scene`] if another scene cannot run as long as `times` ask; [`Error::Cancelled`].
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Distance, Progress, Simulation};
///
/// // In a chaotic motion a difference of a micrometre grows to that of two unrelated motions.
/// let duffing = Simulation::preset("duffing-chaos")?.with("run.duration_s", 200)?;
/// let duffing = duffing.with("run.settle_s", 100)?;
/// let twin = duffing.with("start", "At(x_mm: 1000.001, v_m_per_s: 0)")?;
/// let answer = Distance { of: vec![twin], times: None }.run(&duffing, &Progress::none())?;
/// assert!(answer.lines[0].iter().any(|point| point.1 > 0.1));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Distance {
    /// The other scenes, one to three.
    pub of: Vec<Simulation>,
    /// First and last time in s; the whole run of the scene if there are none.
    pub times: Option<(f64, f64)>,
}

/// The answer of [`Distance::run`].
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceAnswer {
    /// First and last time in s.
    pub times: (f64, f64),
    /// Times in s and distances in m of each of the other scenes; NaN after a run has ended early.
    pub lines: Vec<Vec<(f64, f64)>>,
}

impl Distance {
    /// The distances from the motion of this scene.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<DistanceAnswer, Error> {
        let longest = simulation.scene().run.duration_s;
        let times @ (from, to) = self.times.unwrap_or((0.0, longest));
        if !(0.0 <= from && from < to && to <= longest) {
            let value = format!("{}:{}", number_text(from), number_text(to));
            return Err(Error::argument("times", value, format!("the run lasts from 0 to {longest} s")));
        }
        if !(1..=LETTERS.len()).contains(&self.of.len()) {
            let problem = "one to three other scenes are needed";
            return Err(Error::argument("of", self.of.len().to_string(), problem));
        }
        let at = |i: usize| from + (to - from) * i as f64 / STEPS as f64;
        let rows: Vec<f64> = (0..=STEPS).map(at).collect();
        let keep = Keep { times: rows.clone(), events: false, until_settled: None };
        let displacements = |simulation: &Simulation| -> Result<Vec<f64>, Error> {
            let mut found =
                simulation.kept(&keep, progress)?.samples.numbers("x_m").unwrap_or_default().to_vec();
            found.resize(rows.len(), f64::NAN);
            Ok(found)
        };
        let here = displacements(simulation)?;
        let line = |other: &Simulation| -> Result<Vec<(f64, f64)>, Error> {
            let there = match other.scene().run.duration_s < to {
                true => displacements(&other.with("run.duration_s", to)?)?,
                false => displacements(other)?,
            };
            let apart = here.iter().zip(there).map(|(here, there)| (here - there).abs());
            Ok(rows.iter().copied().zip(apart).collect())
        };
        Ok(DistanceAnswer { times, lines: self.of.iter().map(line).collect::<Result<_, _>>()? })
    }
}

impl DistanceAnswer {
    /// One row per time, with the columns named at [`Distance`].
    pub fn table(&self) -> Table {
        let times = self.lines.first().into_iter().flatten().map(|point| point.0).collect();
        let table = Table::new().with("t_s", Values::Numbers(times));
        self.lines().fold(table, |table, (letter, line)| {
            let values = line.iter().map(|point| point.1).collect();
            table.with(format!("distance_{}_m", letter.to_lowercase()), Values::Numbers(values))
        })
    }

    /// The lines with their letters.
    fn lines(&self) -> impl Iterator<Item = (&'static str, &Vec<(f64, f64)>)> {
        LETTERS.into_iter().zip(&self.lines)
    }
}
