//! Pictures of one run that a program asks for: of the run alone, and with a measured motion over it.

use super::chart::{RunPanel, run_chart};
use super::{Keep, Sampling};
use crate::identify::measured_chart;
use crate::output::{Chart, Ranges};
use crate::questions::{Error, Progress, Simulation};
use crate::study::Comparison;

/// A picture of one run over time.
///
/// [`chart`](Self::chart) runs the scene once more, with samples as dense as the picture needs, whatever was
/// sampled for a table.
///
/// # Example
///
/// ```
/// # use interwell_studies as interwell;
/// use interwell::output::{Caption, Format, Ranges, RunPanel, RunPicture, Theme};
/// use interwell::questions::{Progress, Simulation};
///
/// // displacement and phase portrait from 8 to 10 s
/// let simulation = Simulation::preset("paper")?;
/// let picture = RunPicture {
///     panels: vec![RunPanel::Displacement, RunPanel::Portrait],
///     ranges: Ranges { x: Some((8.0, 10.0)), y: None },
///     ..RunPicture::default()
/// };
/// let chart = picture.chart(&simulation, &Progress::none())?;
/// let figure = chart.figure(&Caption::new(simulation.document(), "1.0"), &Theme::LIGHT);
/// assert!(Format::Svg.bytes(&figure).unwrap().starts_with(b"<svg"));
/// # Ok::<(), interwell::questions::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RunPicture {
    /// The panels from top to bottom. The [usual ones](RunPanel::USUAL) together have numbers beside them.
    pub panels: Vec<RunPanel>,
    /// The times in s that it shows, by default the whole run or the last periods of a long one, and the axis
    /// of the displacement in mm.
    pub ranges: Ranges,
    /// The run continues until the motion repeats, at most up to this time in s.
    pub until_settled: Option<f64>,
}

impl Default for RunPicture {
    fn default() -> Self {
        Self { panels: RunPanel::USUAL.to_vec(), ranges: Ranges::default(), until_settled: None }
    }
}

impl RunPicture {
    /// The picture of a run of `simulation`.
    ///
    /// # Errors
    ///
    /// [`Error::Argument`] without panels or for one that is named twice, for times outside the run, and for
    /// `until_settled`; [`Error::Cancelled`].
    pub fn chart(&self, simulation: &Simulation, progress: &Progress) -> Result<Chart, Error> {
        let keep = self.keep(simulation)?;
        self.check_panels()?;
        let (run, trace) = simulation.traced(&keep, self.ranges.x, progress)?;
        let model = simulation.model();
        let trace = RunPanel::complete(&self.panels, trace, model, progress.stop());
        Ok(run_chart(&trace, &run.summary, model, &self.panels, self.ranges))
    }

    /// The picture of a run of `simulation` with a measured motion over it, which was
    /// [compared](Simulation::compared) with the run; `inset` are the times in s that a second panel shows
    /// closer. It has a panel of the measured quantity, whatever `panels` says, and `ranges` are those of its
    /// axes.
    ///
    /// # Errors
    ///
    /// As [`chart`](Self::chart).
    pub fn chart_with_measured(
        &self,
        simulation: &Simulation,
        found: &Comparison,
        inset: Option<(f64, f64)>,
        progress: &Progress,
    ) -> Result<Chart, Error> {
        let keep = self.keep(simulation)?;
        check_times("inset", inset, simulation, self.until_settled)?;
        let (_, trace) = simulation.traced(&keep, inset.or(self.ranges.x), progress)?;
        Ok(measured_chart(&trace, found, inset, self.ranges))
    }

    fn check_panels(&self) -> Result<(), Error> {
        let twice = (1..self.panels.len()).find(|place| self.panels[..*place].contains(&self.panels[*place]));
        if let Some(place) = twice {
            let problem = "is named twice; a picture shows each panel once";
            return Err(Error::argument("panels", self.panels[place].name(), problem));
        }
        if self.panels.is_empty() {
            return Err(Error::argument("panels", "none", "give one or more"));
        }
        Ok(())
    }

    /// What is kept of the run besides its trace; an error if a part of the picture is wrong.
    fn keep(&self, simulation: &Simulation) -> Result<Keep, Error> {
        let keep = simulation.to_keep(&Sampling::At(Vec::new()), self.until_settled)?;
        check_times("ranges", self.ranges.x, simulation, self.until_settled)?;
        Ok(keep)
    }
}

/// Refuses times that are not within a run.
fn check_times(
    argument: &str,
    times: Option<(f64, f64)>,
    simulation: &Simulation,
    until_settled: Option<f64>,
) -> Result<(), Error> {
    let end = until_settled.unwrap_or(simulation.model().duration());
    match times.filter(|(from, to)| !(0.0 <= *from && from < to && *to <= end)) {
        None => Ok(()),
        Some((from, to)) => {
            let problem = format!("give times within the run, from 0 to {end} s, the earlier first");
            Err(Error::argument(argument, format!("{from}:{to}"), problem))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::questions::MeasuredMotion;
    use crate::scene::{Channel, Quantity};

    #[test]
    fn times_outside_the_run_are_refused_with_their_argument() {
        let (simulation, progress) = (Simulation::preset("nominal-cubic").unwrap(), Progress::none());
        let found = simulation.compared(&MeasuredMotion::of(&[0.0, 1.0], &channel()), &progress).unwrap();
        for times in [(8.0, 12.0), (-1.0, 2.0), (3.0, 3.0), (f64::NAN, 1.0)] {
            let ranges = Ranges { x: Some(times), y: None };
            let picture = RunPicture { ranges, ..RunPicture::default() };
            let wrong = |name: &str, drawn: Result<Chart, Error>| match drawn {
                Err(Error::Argument { name: argument, .. }) => assert_eq!(argument, name),
                other => panic!("{times:?}: {other:?}"),
            };
            wrong("ranges", picture.chart(&simulation, &progress));
            wrong("ranges", picture.chart_with_measured(&simulation, &found, None, &progress));
            let picture = RunPicture::default();
            wrong("inset", picture.chart_with_measured(&simulation, &found, Some(times), &progress));
        }
    }

    #[test]
    fn wrong_panels_and_times_to_settle_are_refused_with_their_argument() {
        let (simulation, progress) = (Simulation::preset("nominal-cubic").unwrap(), Progress::none());
        let picture = RunPicture::default();
        for (picture, name) in [
            (RunPicture { until_settled: Some(1.0), ..picture.clone() }, "until_settled"),
            (RunPicture { until_settled: Some(f64::NAN), ..picture.clone() }, "until_settled"),
            (RunPicture { panels: Vec::new(), ..picture.clone() }, "panels"),
            (RunPicture { panels: vec![RunPanel::Energy; 2], ..picture }, "panels"),
        ] {
            match picture.chart(&simulation, &progress) {
                Err(Error::Argument { name: argument, .. }) => assert_eq!(argument, name),
                other => panic!("{name}: {other:?}"),
            }
        }
    }

    #[test]
    fn a_measured_motion_that_is_no_motion_is_refused() {
        let simulation = Simulation::preset("nominal-cubic").unwrap();
        let refused =
            |motion: &MeasuredMotion, name: &str| match simulation.compared(motion, &Progress::none()) {
                Err(Error::Argument { name: argument, .. }) => assert_eq!(argument, name),
                other => panic!("{name}: {other:?}"),
            };
        let channel = channel();
        let right = MeasuredMotion::of(&[0.0, 1.0], &channel);
        for times in [&[][..], &[0.0], &[0.0, 1.0, 2.0], &[1.0, 1.0], &[0.0, f64::NAN], &[0.0, f64::INFINITY]]
        {
            refused(&MeasuredMotion::of(times, &channel), "times");
        }
        refused(&MeasuredMotion { offset: f64::NAN, ..right }, "offset");
        refused(&MeasuredMotion { shift: Some(f64::INFINITY), ..right }, "shift");
        refused(&MeasuredMotion { time_scale: 0.0, ..right }, "time_scale");
        refused(
            &MeasuredMotion::of(&[0.0, 1.0], &Channel { values: vec![0.0, f64::NAN], ..channel.clone() }),
            "values",
        );
        refused(
            &MeasuredMotion::of(&[0.0, 1.0], &Channel { quantity: Quantity::Force, ..channel.clone() }),
            "channel",
        );
    }

    fn channel() -> Channel {
        Channel { quantity: Quantity::Displacement, column: "x_m".to_owned(), values: vec![0.0, 1e-3] }
    }
}
