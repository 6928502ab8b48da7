//! Drawing of figures: reads the scene as the command line does, runs the study and plots its table.

use std::convert::Infallible;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::{Error, Result, anyhow, ensure};

use crate::app::session::explore::STARTS;
use crate::app::session::map::over;
use crate::app::session::measured::Overlay as Laid;
use crate::app::task::pool;
use crate::dynamics::Model;
use crate::mechanics::Mechanism;
use crate::numeric::extent;
use crate::output::{
    Caption, Chart, Figure, Overlay, Ranges, RunPanel, SpectrumQuantity, SweepPicture, Theme, View,
    basins_chart, can_show, curve_chart, measured_chart, measured_force_chart, mechanism_chart, run_chart,
    scene_accuracy_chart, section_chart, spectrum_chart, sweep_chart,
};
use crate::scene::{Document, Fault, FieldPath, arguments};
use crate::study::accuracy::methods::Scheme;
use crate::study::accuracy::scene::{step_size, tolerances};
use crate::study::{
    Basins, CURVE_PICTURE_POINTS, Carry, EvenRange, Grid, GridStudy, Keep, MeasuredMotion, NoBasins,
    Question, STANDARD_COLUMNS, Sampling, SectionOptions, Sections, Signal, SpectrumOptions, Starts,
    SummaryField, Sweep, SweepOptions, Table, Task, compare, compare_force, curve, default_positions,
    even_positions, metres, sample_times, section, simulate_with_trace, spectrum, stop_positions,
};
use crate::system::threads::Pool;

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
    let caption = Caption::new(&document, env!("CARGO_PKG_VERSION"));
    let drawing = Drawing { task: Task { tick: &|| (), cancel }, document };
    let chart = match &order.subject {
        Subject::Run(times, panels) => drawing.run(*times, panels),
        Subject::Curve => drawing.curve(),
        Subject::Mechanism(mm) => drawing.mechanism_at(*mm),
        Subject::Accuracy(stepped) => drawing.accuracy(*stepped),
        Subject::Measured(over) => drawing.measured(over),
        Subject::Sweep(_, quantity, view) => drawing.sweep(&order.subject, quantity, view.clone()),
        Subject::Diagram(_) => drawing.diagram(&order.subject),
        Subject::Section => drawing.section(),
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

fn threads() -> Result<Pool> {
    pool().ok_or_else(|| anyhow!("The system has no threads to give: close something, and save again."))
}

fn cancelled() -> Error {
    anyhow!("cancelled")
}

struct Drawing<'a> {
    document: Document,
    task: Task<'a>,
}

impl Drawing<'_> {
    fn mechanism(&self) -> Result<Arc<Mechanism>> {
        Ok(Arc::new(Mechanism::build(&self.document.scene.mechanism, &self.document.files)?))
    }

    fn model(&self) -> Result<Model> {
        Model::build(&self.document.scene, self.mechanism()?).map_err(|faults| self.faulty(faults))
    }

    fn grid(&self, subject: &Subject) -> Result<Grid> {
        let over: Vec<String> = subject.axes().iter().map(over).collect();
        Ok(Grid::new(self.document.axes(&over)?)?)
    }

    fn faulty(&self, faults: Vec<Fault>) -> Error {
        self.document.error_from(faults).into()
    }

    /// All rows of a study.
    fn rows<Q: Question>(&self, study: &GridStudy<Q>) -> Result<Table> {
        let (pool, mut rows) = (threads()?, Table::new());
        study.validate(&pool, &self.task).map_err(|cell| self.faulty(cell.faults))?;
        let end = study.run(&pool, &self.task, |table| {
            rows.append(table);
            Ok::<_, Infallible>(true)
        });
        end.map(|_| rows).map_err(|_| cancelled())
    }

    fn run(&self, times: Option<(f64, f64)>, panels: &[RunPanel]) -> Result<Chart> {
        let (document, model) = (&self.document, self.model()?);
        let sample_times = sample_times(&document.scene, &model, &Sampling::Default, None)?;
        let keep = Keep { times: sample_times, events: false, until_settled: None };
        let (simulation, trace) = simulate_with_trace(&model, &keep, times, Some(self.task.cancel));
        let trace = RunPanel::complete(panels, trace, &model, self.task.cancel);
        let (mechanism, ranges) = (model.mechanism(), Ranges { x: times, y: None });
        Ok(run_chart(&trace, &simulation.summary, (mechanism, model.mass()), panels, ranges))
    }

    fn curve(&self) -> Result<Chart> {
        let (scene, mechanism) = (&self.document.scene, self.mechanism()?);
        let table = curve(&mechanism, default_positions(scene, &mechanism, CURVE_PICTURE_POINTS))?;
        Ok(curve_chart(&table, &mechanism, stop_positions(scene), Ranges::default()))
    }

    fn mechanism_at(&self, mm: f64) -> Result<Chart> {
        Ok(mechanism_chart(&self.model()?, metres(mm))?)
    }

    fn accuracy(&self, stepped: Option<(Scheme, f64)>) -> Result<Chart> {
        let (model, cancel) = (self.model()?, self.task.cancel);
        let known = tolerances(&model, cancel).ok_or_else(cancelled)?;
        let stepped = stepped.map(|(scheme, step)| step_size(&model, scheme, step, cancel)).transpose()?;
        let stops = stop_positions(&self.document.scene);
        Ok(scene_accuracy_chart(&known, model.tolerance(), stepped.as_slice(), stops))
    }

    fn measured(&self, over: &Laid) -> Result<Chart> {
        let (scene, model, record) = (&self.document.scene, self.model()?, &over.record);
        let (across, channel, ranges) = (&record.across.values, &record.values, Ranges::default());
        if over.is_force() {
            let positions: Vec<f64> = across.iter().map(|x| x + over.offset).collect();
            let mechanism = model.mechanism();
            let found = compare_force(mechanism, &positions, &channel.values)?;
            let over = even_positions(extent(found.positions.iter().copied()), CURVE_PICTURE_POINTS);
            return Ok(measured_force_chart(&found, &curve(mechanism, over)?, ranges));
        }
        let (offset, time_scale, shift) = (over.added(), over.time_scale, Some(over.shift));
        let motion = MeasuredMotion { times: across, channel, offset, time_scale, shift };
        let found = compare(scene, &model, &motion, self.task.cancel)?;
        let times = sample_times(scene, &model, &Sampling::Default, None)?;
        let keep = Keep { times, events: false, until_settled: None };
        let (_, trace) = simulate_with_trace(&model, &keep, None, Some(self.task.cancel));
        Ok(measured_chart(&trace, (&found, channel.quantity), None, ranges))
    }

    fn sweep(&self, subject: &Subject, quantity: &str, view: View) -> Result<Chart> {
        let (grid, scene) = (self.grid(subject)?, &self.document.scene);
        let carry = subject.is_walked().then_some(Carry::Both);
        let names = STANDARD_COLUMNS.into_iter().filter(|name| *name != quantity).chain([quantity]);
        let columns = names.filter_map(SummaryField::find).collect();
        let options = SweepOptions { columns, carry, ..SweepOptions::default() };
        let sweep = Sweep::new(scene, &self.document.files, grid).with(options);
        can_show(sweep.grid(), quantity, &view, &sweep.empty_table())?;
        let (rows, grid) = (self.rows(&sweep)?, sweep.grid());
        let overlay = match carry {
            Some(_) => Overlay::default(),
            None => Overlay::of(scene, sweep.first_mechanism().ok().as_deref(), grid, &rows),
        };
        Ok(sweep_chart(&SweepPicture {
            rows: &rows,
            grid,
            scene,
            until_settled: None,
            quantity,
            overlay,
            view,
            ranges: Ranges::default(),
            draws: "",
        })?)
    }

    fn diagram(&self, subject: &Subject) -> Result<Chart> {
        let options = SectionOptions { carry: Some(Carry::Both), ..SectionOptions::default() };
        let sections = Sections::new(&self.document.scene, &self.document.files, self.grid(subject)?);
        let sections = sections.with(options);
        let rows = self.rows(&sections)?;
        Ok(section_chart(&rows, Some(sections.grid()), Some(0.0), (None, None), Ranges::default()))
    }

    fn section(&self) -> Result<Chart> {
        let (model, options) = (self.model()?, SectionOptions::default());
        let found = section(&model, &self.document.scene, &options, self.task.cancel);
        let (rows, _) = found.map_err(|fault| self.faulty(vec![fault]))?;
        Ok(section_chart(&rows, None, Some(0.0), model.stop_positions(), Ranges::default()))
    }

    fn basins(&self, x_mm: (f64, f64), v: (f64, f64)) -> Result<Chart> {
        let even = |(from, to): (f64, f64)| EvenRange { from, to, count: STARTS };
        let starts = Starts::grid(&even(x_mm), &even(v))?;
        let basins = Basins::new(&self.document.scene, self.mechanism()?, starts);
        let (mut basins, pool) = match basins {
            Err(NoBasins::Faults(faults)) => return Err(self.faulty(faults)),
            found => (found?, threads()?),
        };
        while !basins.is_whole() && basins.run_level(&pool, &self.task) {}
        let answer = basins.answer(&self.task).ok_or_else(cancelled)?;
        Ok(basins_chart(&basins, &answer))
    }

    fn spectrum(&self, signal: Signal, until_settled: Option<f64>) -> Result<Chart> {
        let options = SpectrumOptions { signal, taper: None, rate_hz: None, until_settled };
        let found = spectrum(&self.model()?, &options, &self.task)?;
        Ok(spectrum_chart(&found, SpectrumQuantity::Amplitude, Ranges::default()))
    }
}
