//! Comparison of scenes under one sine: release and crossing amplitudes, settled motion, the band of
//! frequencies that cross, and the sensitivity of the crossing amplitude to their sizes.

mod chart;
mod rate;
mod remarks;

use std::sync::Arc;

use crate::questions::{Error, Progress, Simulation, check_until};
use crate::scene::{Document, Excitation, Start};
use crate::study::{Table, Task, named};
use crate::system::threads::Pool;
pub use chart::{compared_name, comparison_chart, comparison_title, three_digits};
pub use rate::{Alternative, Rated, alternatives};
use rate::{SEARCHED_SPAN, comparison_table, parts};
use remarks::of_comparison;

/// Comparison of scenes under the sine and with the run settings of the first one, each from rest.
///
/// [`CompareAnswer::table`] has one row per scene: `scene`, `release_g`, `crossing_g`, `crossing_low_g`,
/// `crossing_high_g`, `crossing_undecided`, `rms_velocity_m_per_s`, `mean_load_power_w`, `max_abs_x_m`,
/// `impact_speed_max_m_per_s`, `crosses_from_hz`, `crosses_to_hz`, `threshold_sensitivity` (a share) and
/// `most_sensitive_to`. A value is missing where a scene has no such number.
///
/// # Method
///
/// The release has a closed form; the crossing amplitude is found by a scan and bisection, as by
/// [`Threshold`](crate::questions::Threshold); the band of frequencies by 40 steps per decade, from a tenth
/// to ten times the frequency of the sine, whose ends are bisected to a thousandth; the sensitivity by
/// changing one length, thickness or gap of the mechanism at a time by 1 % up and down. Each of these changes
/// is a search of its own, for which flexures are solved anew.
///
/// # Errors
///
/// [`Error::Unfit`] if the common excitation is no sine; [`Error::Scene`] if a scene has faults under
/// it; [`Error::Argument`] for `until_settled`; [`Error::Cancelled`].
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::questions::{Compare, Progress, Simulation};
///
/// // Stops at 2 mm release the mass at a lower amplitude than stops at 4 mm.
/// let far = Simulation::preset("nominal-cubic")?.with("run.tolerance", 1e-6)?;
/// let near = far.with("stops.travel_limit_mm", 2.0)?;
/// let question = Compare { with: vec![("near".into(), near)], name: "far".into(), ..Compare::default() };
/// let answer = question.run(&far, &Progress::none())?;
/// assert!(answer.rated[1].release_g < answer.rated[0].release_g);
/// assert_eq!(answer.table().rows(), 2);
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct Compare {
    /// The other scenes, with their names.
    pub with: Vec<(String, Simulation)>,
    /// The name of the first scene, which is passed to `run`.
    pub name: String,
    /// The scene whose sine and run settings all scenes have, in place of the first one's.
    pub environment: Option<Simulation>,
    /// Each run continues until its motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
}

impl Compare {
    /// Rates all scenes, the first one first.
    pub fn run(&self, simulation: &Simulation, progress: &Progress) -> Result<CompareAnswer, Error> {
        let alternative = |(name, simulation): (String, Simulation)| {
            let (document, mechanism) = (simulation.document(), Arc::clone(simulation.mechanism()));
            let (scene, files) = (document.scene.clone(), document.files.clone());
            Alternative { name, scene, files, mechanism }
        };
        let scenes = self.scenes(simulation, progress)?;
        let all: Vec<_> = scenes.iter().cloned().map(alternative).collect();
        let rate = |pool: &Pool, task: &Task| alternatives(&all, self.until_settled, pool, task);
        let rated = progress.shared(parts(&all).len() as u64, rate)?.ok_or(Error::Cancelled)?;
        let (frequency_hz, amplitude_g) = needs_a_sine(self.environment(simulation))?;
        let table = comparison_table(&rated);
        let given: Vec<_> = self.given(simulation).collect();
        let environment = self.environment(simulation);
        let remarks = of_comparison(&given, environment, &scenes, &rated, (amplitude_g, &table));
        Ok(CompareAnswer { rated, frequency_hz, amplitude_g, remarks })
    }

    /// The scenes as they are rated, with their names: at rest, under the common sine and with the common run
    /// settings.
    #[doc(hidden)]
    pub fn scenes(
        &self,
        simulation: &Simulation,
        progress: &Progress,
    ) -> Result<Vec<(String, Simulation)>, Error> {
        let environment = self.environment(simulation);
        needs_a_sine(environment)?;
        let rated = |(name, other): (&str, &Simulation)| {
            let other = other.with_document(in_environment(other.document(), environment), progress)?;
            check_until(self.until_settled, other.document(), other.model())?;
            Ok((name.to_owned(), other))
        };
        self.given(simulation).map(rated).collect()
    }

    /// The scenes with their names, the first one first.
    fn given<'a>(&'a self, simulation: &'a Simulation) -> impl Iterator<Item = (&'a str, &'a Simulation)> {
        let others = self.with.iter().map(|(name, other)| (&**name, other));
        std::iter::once((&*self.name, simulation)).chain(others)
    }

    fn environment<'a>(&'a self, simulation: &'a Simulation) -> &'a Document {
        self.environment.as_ref().unwrap_or(simulation).document()
    }
}

/// The answer of [`Compare::run`].
///
/// [`comparison_chart`](crate::output::comparison_chart) draws it.
#[derive(Debug, Clone, PartialEq)]
pub struct CompareAnswer {
    /// The results of each scene, the first one first.
    pub rated: Vec<Rated>,
    /// Frequency of the common sine in Hz.
    pub frequency_hz: f64,
    /// Its amplitude in g.
    pub amplitude_g: f64,
    /// Which scenes have another excitation or run than their own, and why a scene lacks a number: sentences,
    /// each after the names of the scenes to which it applies.
    pub remarks: Vec<String>,
}

impl CompareAnswer {
    /// One row per scene, with the columns named at [`Compare`].
    pub fn table(&self) -> Table {
        comparison_table(&self.rated)
    }
}

/// Returns frequency in Hz and amplitude in g of a sine or cosine; other excitations are refused.
fn needs_a_sine(environment: &Document) -> Result<(f64, f64), Error> {
    let problem = match (&environment.scene.excitation, environment.scene.harmonic()) {
        (Excitation::Force { .. }, _) => {
            concat!(
                "its excitation is a Force, which shakes scenes of different masses differently: name a \
                 scene with a Sine or Cosine first, or by ",
                named!("environment")
            )
        }
        (_, Some(drive)) => return Ok((drive.frequency_hz, drive.amplitude_g())),
        _ => {
            concat!(
                "its excitation is no Sine; amplitude and frequency of one are searched: name a scene with \
                 a Sine first, or by ",
                named!("environment")
            )
        }
    };
    Err(Error::unfit(environment, problem))
}

/// A scene at rest, with the excitation and the run settings of another one.
fn in_environment(document: &Document, environment: &Document) -> Document {
    let mut changed = document.clone();
    // thresholds and bands of a cosine are searched in g and Hz
    let drive = environment.scene.harmonic().map(|drive| drive.sine());
    changed.scene.excitation = drive.unwrap_or_else(|| environment.scene.excitation.clone());
    changed.scene.run = environment.scene.run;
    changed.scene.start = Start::Rest;
    changed.scene.sweep.clear(); // the other excitation may not have its fields
    changed
}
