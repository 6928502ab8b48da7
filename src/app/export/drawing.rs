//! Drawing of figures: reads the scene as the command line does, runs the study and plots its table.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Result, anyhow, ensure};

use crate::app::session::explore::STARTS;
use crate::app::session::map::over;
use crate::app::session::measured::Overlay as Laid;
use crate::app::task::progress;
use crate::dynamics::STANDARD_GRAVITY;
use crate::mechanics::Mechanism;
use crate::numeric::extent;
use crate::output::{
    Caption, Chart, Figure, Overlay, Ranges, RunPanel, SpectrumQuantity, SweepPicture, Theme, View,
    basins_chart, can_show, compared_name, comparison_chart, comparison_title, curve_chart, measured_chart,
    measured_force_chart, mechanism_chart, run_chart, scene_accuracy_chart, shown_columns, spectrum_chart,
    sweep_chart, well_chart,
};
use crate::questions::{
    Accuracy, Basins, Carry, Compare, Curve, Grid, Progress, Scheme, Section, Signal, Simulation, Spectrum,
    Sweep,
};
use crate::scene::{Document, FieldPath, arguments};
use interwell_studies::study::{
    Answered, Framing, Keep, Scenes, Study, answer_in, default_positions, metres, stop_positions,
};

use super::figure::{FigureOrder, Subject};

const CHANGED: &str = "The file of this scene has changed since it was opened, and the figure's command \
                       reads it: save the scene first (Ctrl+S), or open it again.";

/// Draws the figure. Returns `None` if cancelled.
pub(super) fn draw(order: &FigureOrder, cancel: &AtomicBool) -> Result<Option<Figure>> {
    let figure = figure(order, cancel);
    if cancel.load(Ordering::Relaxed) { Ok(None) } else { figure.map(Some) }
}

/// The figure; if cancelled, any error.
fn figure(order: &FigureOrder, cancel: &AtomicBool) -> Result<Figure> {
    let document = document(order)?;
    let mut caption = Caption::new(&document, env!("CARGO_PKG_VERSION"));
    let drawing = Drawing { progress: progress(cancel), document };
    let chart = match &order.subject {
        Subject::Run(times, panels) => drawing.run(*times, panels),
        Subject::Curve => drawing.curve(),
        Subject::Mechanism(mm) => drawing.mechanism_at(*mm),
        Subject::Well(mm, accel_g) => drawing.well(*mm, *accel_g),
        Subject::Accuracy(stepped) => drawing.accuracy(*stepped),
        Subject::Measured(over) => drawing.measured(over),
        Subject::Sweep(_, quantity, view) => drawing.sweep(&order.subject, quantity, view.clone()),
        Subject::Diagram(_) => drawing.diagram(&order.subject),
        Subject::Section => drawing.section(),
        Subject::Compare(other) => drawing.compare(other, &order.origin, &mut caption),
        Subject::Basins(x_mm, v) => drawing.basins(*x_mm, *v),
        Subject::Spectrum(signal, until) => drawing.spectrum(*signal, *until),
    };
    Ok(chart?.figure(&caption, &Theme::of(false, Some(order.place.sheet))))
}

/// Reads the document as the command line does; an error if it differs from the scene of the window.
fn document(order: &FigureOrder) -> Result<Document> {
    let mut document = Document::of_argument(&order.origin)?;
    for setting in &order.settings {
        document.set(setting)?;
    }
    document.settle_within();
    let mut first = document.clone();
    for axis in order.subject.axes() {
        ensure!(FieldPath::new(&axis.field).set(&mut first.scene, axis.from), CHANGED);
    }
    first.check()?;
    if matches!(order.subject, Subject::Basins(..)) {
        first.scene.start = order.scene.start;
    }
    ensure!(arguments(&first.scene, &order.scene).is_empty(), CHANGED);
    Ok(document)
}

struct Drawing<'a> {
    document: Document,
    progress: Progress<'a>,
}

impl Drawing<'_> {
    fn simulation(&self) -> Result<Simulation> {
        Ok(Simulation::build(self.document.clone(), &self.progress)?)
    }

    /// The mechanism of a scene whose own start need not be possible.
    fn mechanism(&self) -> Result<Arc<Mechanism>> {
        Ok(Arc::new(Mechanism::build(&self.document.scene.mechanism, &self.document.files)?))
    }

    fn grid(&self, subject: &Subject) -> Result<Grid> {
        let over: Vec<String> = subject.axes().iter().map(over).collect();
        Ok(Grid::new(self.document.axes(&over)?)?)
    }

    fn run(&self, times: Option<(f64, f64)>, panels: &[RunPanel]) -> Result<Chart> {
        let simulation = self.simulation()?;
        let (run, trace) = simulation.traced(&Keep::default(), times, &self.progress)?;
        let trace = RunPanel::complete(panels, trace, simulation.model(), self.progress.stop());
        Ok(run_chart(&trace, &run.summary, simulation.model(), panels, Ranges { x: times, y: None }))
    }

    fn curve(&self) -> Result<Chart> {
        let simulation = self.simulation()?;
        let (scene, mechanism) = (simulation.scene(), simulation.mechanism());
        let table = Curve::drawn(None, &self.document, mechanism)?;
        Ok(curve_chart(&table, mechanism, stop_positions(scene), Ranges::default()))
    }

    fn well(&self, mm: f64, accel_g: f64) -> Result<Chart> {
        let simulation = self.simulation()?;
        let ends = default_positions(simulation.scene(), simulation.mechanism(), 2);
        let (x, base_accel) = (metres(mm), accel_g * STANDARD_GRAVITY);
        Ok(well_chart(simulation.model(), x, base_accel, (ends[0], ends[1])))
    }

    fn mechanism_at(&self, mm: f64) -> Result<Chart> {
        Ok(mechanism_chart(&[(self.simulation()?.model(), metres(mm))])?)
    }

    fn accuracy(&self, stepped: Option<(Scheme, f64)>) -> Result<Chart> {
        let (simulation, progress) = (self.simulation()?, &self.progress);
        let known = Accuracy::tolerances(&simulation, progress)?;
        let run = |(scheme, step)| Accuracy::step_size(&simulation, scheme, step, progress);
        let stepped = stepped.map(run).transpose()?;
        let stops = stop_positions(&self.document.scene);
        Ok(scene_accuracy_chart(&known, simulation.model().tolerance(), stepped.as_slice(), stops))
    }

    fn measured(&self, over: &Laid) -> Result<Chart> {
        let (simulation, channel, ranges) = (self.simulation()?, &over.record.values, Ranges::default());
        if over.is_force() {
            let (document, mechanism) = (simulation.document(), simulation.mechanism());
            let found = Curve::compared(document, mechanism, &over.positions(), &channel.values)?;
            let range = extent(found.positions.iter().copied());
            let table = Curve::drawn(Some(range), document, mechanism)?;
            return Ok(measured_force_chart(&found, &table, ranges));
        }
        let found = simulation.compared(&over.motion(Some(over.shift)), &self.progress)?;
        let (_, trace) = simulation.traced(&Keep::default(), None, &self.progress)?;
        Ok(measured_chart(&trace, &found, None, ranges))
    }

    fn sweep(&self, subject: &Subject, quantity: &str, view: View) -> Result<Chart> {
        let (scene, carry) = (&self.document.scene, subject.is_walked().then_some(Carry::Both));
        let question = Sweep { carry, ..Sweep::default() };
        let grid = self.grid(subject)?;
        let shown = shown_columns(quantity, &view, &grid);
        let cells = question.cells(&self.document, grid, &shown, &self.progress)?;
        let (sweep, grid) = (&cells.sweep, cells.sweep.grid());
        can_show(grid, quantity, &view, &sweep.empty_table())?;
        let rows = cells.rows(&self.document, &self.progress)?;
        let overlay = Overlay::of(scene, sweep.first_mechanism().ok().as_deref(), grid, &rows);
        Ok(sweep_chart(&SweepPicture {
            overlay,
            view,
            ..SweepPicture::of_rows(&rows, grid, scene, quantity)
        })?)
    }

    fn diagram(&self, subject: &Subject) -> Result<Chart> {
        let study = Section { carry: Some(Carry::Both), ..Section::default() };
        self.answered(&study, &self.grid(subject)?)
    }

    fn section(&self) -> Result<Chart> {
        self.answered(&Section::default(), &Grid::of_one())
    }

    /// The picture of the answer of a study over this grid.
    fn answered<S: Study>(&self, study: &S, grid: &Grid) -> Result<Chart> {
        let scenes = Scenes { document: &self.document, grid, mechanism: None };
        let Answered { table, chart, .. } = answer_in(study, &scenes, &self.progress)?;
        let chart = chart.ok_or_else(|| anyhow!("`{}` has no picture of this", S::NAME))?;
        let framing = Framing { quantity: None, ranges: Ranges::default(), cancel: self.progress.stop() };
        Ok(chart(&table, &framing)?)
    }

    fn compare(&self, other: &str, origin: &str, caption: &mut Caption) -> Result<Chart> {
        let simulation = Simulation::build(Document::of_argument(other)?, &self.progress)?;
        let with = vec![(compared_name(other, simulation.document()), simulation)];
        let question = Compare { with, name: compared_name(origin, &self.document), ..Compare::default() };
        let found = question.run(&self.simulation()?, &self.progress)?;
        caption.title = comparison_title(&found);
        Ok(comparison_chart(&found.rated, found.frequency_hz))
    }

    fn basins(&self, x_mm: (f64, f64), v: (f64, f64)) -> Result<Chart> {
        let even = |(from, to): (f64, f64)| (from, to, STARTS);
        let begun = Basins::of(even(x_mm), even(v)).begin(&self.document, &self.mechanism()?)?;
        let found = Basins::followed(begun.checked(), &self.progress, None)?;
        Ok(basins_chart(&found.basins, &found.answer))
    }

    fn spectrum(&self, of: Signal, until_settled: Option<f64>) -> Result<Chart> {
        let question = Spectrum { of, until_settled, ..Spectrum::default() };
        let found = question.run(&self.simulation()?, &self.progress)?;
        Ok(spectrum_chart(&found, SpectrumQuantity::Amplitude, Ranges::default()))
    }
}
