//! Promises about any input: no panic, no endless work, a refusal in words, and the same text when it is
//! written back.
//!
//! Each function takes any bytes. The fuzz targets in `fuzz/` feed them with what a fuzzer invents, the tests
//! around this file with the small corpus in `tests/corpus`.

use std::fmt::Display;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use interwell::dynamics::{Model, Outcome, Request};
use interwell::mechanics::{BuildError, ForceTable, Mechanism, fit, force_scale};
use interwell::scene::{
    self, Document, Excitation, FieldPath, Files, MAX_AXIS_VALUES, MAX_ROWS, Record, Start, arguments,
    read_columns, write,
};
use interwell_studies::study::{Grid, MAX_CELLS};

/// What messages call the scene.
const NAME: &str = "s.ron";

/// How long a run may take before it is told to stop: what a run does is for other tests, here it must only
/// start.
const RUN: Duration = Duration::from_millis(20);

/// The longest line of a message in bytes: a list of sixty fields, and a clipped value.
const LONGEST_LINE: usize = 5000;

/// The most lines of a message: fifty faults and the count of the others.
const MOST_LINES: usize = 51;

/// The text of a scene: read, checked, written, set and run.
pub fn scene(bytes: &[u8]) {
    let Some(text) = harmless(bytes) else { return };
    let document = match Document::from_text(NAME, text, Files::default()) {
        Ok(document) => document,
        Err(error) => return in_words(error, NAME),
    };
    reads_back(&document.scene);
    keeps_arithmetic(&document);
    if let Err(error) = document.axes::<&str>(&[]) {
        in_words(error, NAME);
    }
    match document.check() {
        Err(error) => in_words(error, NAME),
        Ok(warnings) => {
            warnings.iter().for_each(|warning| in_words(warning, NAME));
            can_be_set(&document.scene);
            builds(&document);
        }
    }
}

/// The text of a table of forces: points, then a curve through them.
pub fn table(bytes: &[u8]) {
    let Some(text) = harmless(bytes) else { return };
    let table = match ForceTable::parse(text) {
        Ok(table) => table,
        Err(error) => return in_words(error, ""),
    };
    let rows = table.x.iter().zip(&table.force).map(|(x, force)| format!("{x:?},{force:?}\n"));
    let written = format!("x_m,force_n\n{}", rows.collect::<String>());
    assert_eq!(ForceTable::parse(&written).as_ref(), Ok(&table));
    table.warnings().iter().for_each(|warning| in_words(warning, ""));
    rows_stand_on_lines(text, ["x_m", "force_n"]);
    for tolerance in [1e-2, 1e-8] {
        let curve = match fit(&table, tolerance) {
            Ok(curve) => curve,
            Err(error) => return in_words(error, ""),
        };
        let (first, last) = (table.x[0], table.x[table.x.len() - 1]);
        let largest = table.force.iter().fold(0.0_f64, |most, force| most.max(force.abs()));
        let reach = first.abs().max(last.abs());
        let (low, high) = curve.domain();
        assert!((low - first).abs() <= 1e-11 * reach && (high - last).abs() <= 1e-11 * reach);
        assert!(curve.breaks().is_sorted() && curve.breaks().iter().all(|at| low < *at && *at < high));
        let allowed = 1.001 * tolerance * force_scale(&table) + 1e-13 * largest;
        for (x, force) in table.x.iter().zip(&table.force) {
            let fitted = curve.force(x.clamp(low, high));
            assert!(
                (fitted - force).abs() <= allowed,
                "{fitted:e} for {force:e} at {x:e}, allowed {allowed:e}"
            );
        }
        let mechanism = Mechanism::new(curve);
        let equilibria = &mechanism.landscape.equilibria;
        assert!(equilibria.is_sorted_by(|a, b| a.x < b.x), "{equilibria:?}");
        assert!(equilibria.iter().all(|point| low <= point.x && point.x <= high), "{equilibria:?}");
        let mut document = small();
        document.scene.start =
            Start::At { x_mm: 0.5e3 * low + 0.5e3 * high, v_m_per_s: 0.0, electrical: 0.0 };
        runs(&document, mechanism);
    }
}

/// The text of a recorded acceleration: samples, then a base that moves like this.
pub fn recorded(bytes: &[u8]) {
    let Some(text) = harmless(bytes) else { return };
    let record = match Record::parse(text) {
        Ok(record) => record,
        Err(error) => return in_words(error, ""),
    };
    let rows = record.times.iter().zip(&record.accelerations).map(|(t, a)| format!("{t:?},{a:?}\n"));
    let written = format!("t_s,accel_m_per_s2\n{}", rows.collect::<String>());
    assert_eq!(Record::parse(&written).as_ref(), Ok(&record));
    // others are chosen by their units
    let names = ["t_s", "accel_m_per_s2"];
    if read_columns(text, names, MAX_ROWS, true).is_ok() {
        rows_stand_on_lines(text, names);
    }
    let mut document = small();
    let duration = document.scene.run.duration_s;
    record.warnings(duration).iter().for_each(|warning| in_words(warning, ""));
    let samples: Vec<f64> = record.times.iter().copied().filter(|t| (0.0..=duration).contains(t)).collect();
    let peak = record.peak();
    let record = Some(Arc::new(record));
    document.scene.excitation = Excitation::Recorded { path: "r.csv".to_owned(), record };
    let mechanism = Mechanism::build(&document.scene.mechanism, &document.files).unwrap();
    if let Some(model) = runs(&document, mechanism) {
        for t in samples.into_iter().take(20) {
            let a = model.base_acceleration(t);
            assert!(a.abs() <= peak * (1.0 + 1e-9), "{a:e} at {t:e}, beyond the record's {peak:e}");
        }
    }
}

/// Arguments of `--set`, a line each, on the built-in scene that the first line names.
pub fn set(bytes: &[u8]) {
    let Some((mut document, given)) = preset_and_arguments(bytes) else { return };
    for argument in given {
        let before = write(&document.scene).unwrap();
        if let Err(error) = document.set(argument) {
            in_words(error, "--set ");
            assert_eq!(write(&document.scene).unwrap(), before, "changed by a refused `{argument}`");
        } else if let Some((field, value)) = argument.split_once('=')
            && let (Some(held), Ok(value)) =
                (FieldPath::new(field.trim()).get(&document.scene), value.trim().parse::<f64>())
        {
            assert!(held == value || value.is_nan(), "{held:?} after `{argument}`");
        }
    }
    reads_back(&document.scene);
    keeps_arithmetic(&document);
    match document.check() {
        Ok(_) => can_be_set(&document.scene),
        Err(error) => in_words(error, ""),
    }
}

/// A link: the text itself, and the text as what stands behind the `#`.
pub fn link(bytes: &[u8]) {
    let Some(text) = harmless(bytes) else { return };
    for link in [text.to_owned(), format!("?scene=paper#{text}"), format!("?scene=#{text}")] {
        if !scene::is_link(&link) {
            continue;
        }
        match Document::of_argument(&link) {
            Err(error) => in_words(error, ""),
            Ok(document) => {
                reads_back(&document.scene);
                match document.check() {
                    Err(error) => in_words(error, ""),
                    Ok(_) => drop(document.link()),
                }
            }
        }
    }
}

/// Arguments of `--over`, a line each, on the built-in scene that the first line names.
pub fn over(bytes: &[u8]) {
    let Some((document, given)) = preset_and_arguments(bytes) else { return };
    let axes = match document.axes(&given) {
        Ok(axes) => axes,
        Err(error) => return in_words(error, ""),
    };
    assert!(given.is_empty() || given.len() == axes.len());
    let mut last_cell = document.clone();
    for axis in &axes {
        assert!((1..=MAX_AXIS_VALUES).contains(&axis.values.len()), "{} values", axis.values.len());
        axis.apply(&mut last_cell.scene, axis.values.len() - 1);
        if axis.values.len() < 1000 {
            let listed: Vec<String> = axis.values.iter().map(|value| format!("{value:?}")).collect();
            let listed = format!("{}={}", axis.field, listed.join(","));
            let again = scene::Axis::parse(&listed, &document.scene);
            assert_eq!(again.as_ref().map(|parsed| &parsed.values), Ok(&axis.values), "{listed}");
        }
    }
    last_cell.check().unwrap();
    match Grid::new(axes) {
        Err(error) => in_words(error, ""),
        Ok(grid) => {
            assert!((1..=MAX_CELLS).contains(&grid.cells()));
            assert_eq!(grid.values(grid.cells() - 1).count(), grid.columns().len());
            assert!(!grid.describe(0).is_empty());
        }
    }
}

/// Bytes as text; none where they are no text or name a file by an absolute path, which would be read.
fn harmless(bytes: &[u8]) -> Option<&str> {
    let text = std::str::from_utf8(bytes).ok()?;
    let names_a_file = text.contains("path") && (text.contains("\"/") || text.contains('\\'));
    (!names_a_file).then_some(text)
}

/// A built-in scene, named by the first line, and the further lines as arguments; none where one names a
/// file by a path with folders.
fn preset_and_arguments(bytes: &[u8]) -> Option<(Document, Vec<&str>)> {
    let names_a_file = |text: &&str| text.contains("path") && text.contains(['/', '\\']);
    let text = std::str::from_utf8(bytes).ok().filter(|text| !names_a_file(text))?;
    let mut lines = text.lines();
    let name = lines.next()?;
    let preset = scene::PRESETS.iter().find(|preset| preset.name == name)?;
    Some((Document::load(preset.name).unwrap(), lines.collect()))
}

/// A scene that needs no file and no flexures.
fn small() -> Document {
    let text = "(title: \"\", mass_g: 15.2, mechanism: Cubic(linear_n_per_m: -40, cubic_n_per_m3: 8.2e5), \
        damping: Coefficient(c_n_s_per_m: 0.01), stops: Rigid(travel_limit_mm: 1e6, restitution: 0.5), \
        start: At(x_mm: 0, v_m_per_s: 0), run: (duration_s: 2, tolerance: 1e-6))";
    Document::from_text(NAME, text, Files::default()).unwrap()
}

/// Each row of a CSV text that was read stands on its own line: none was swallowed, none counted wrongly.
#[track_caller]
fn rows_stand_on_lines(text: &str, names: [&'static str; 2]) {
    let columns = read_columns(text, names, MAX_ROWS, true).unwrap();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let lines: Vec<&str> =
        text.split('\n').flat_map(|l| l.strip_suffix('\r').unwrap_or(l).split('\r')).collect();
    let rows = lines.iter().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    assert_eq!(columns.rows.len() + 1, rows.count());
    for (row, line) in columns.rows.iter().zip(&columns.lines) {
        let values: Vec<f64> =
            lines[line - 1].split(',').filter_map(|v| v.replace('"', "").trim().parse().ok()).collect();
        assert!(row.iter().all(|value| values.contains(value)), "{row:?} is not on line {line}");
    }
}

/// A message says something, begins with what it is about, and neither floods nor moves about a terminal.
#[track_caller]
fn in_words(message: impl Display, about: &str) {
    let message = message.to_string();
    assert!(message.starts_with(about) && message.len() > about.len() + 5, "{message:?}");
    assert!(!message.contains(|c: char| c.is_control() && c != '\n'), "{message:?}");
    assert!(message.lines().count() <= MOST_LINES, "{message}");
    assert!(message.lines().all(|line| !line.is_empty() && line.len() <= LONGEST_LINE), "{message}");
}

/// What was read is written as a text that reads as the same.
#[track_caller]
fn reads_back(scene: &scene::Scene) {
    let written = write(scene).unwrap();
    let again = match Document::from_text("written", &written, Files::default()) {
        Ok(again) => again.scene,
        Err(error) => panic!("{error}\n{written}"),
    };
    // NaN is read, and refused by the check; it is unequal to itself.
    assert_eq!(write(&again).unwrap(), written);
    if *scene == scene.clone() {
        assert_eq!(again, *scene, "{written}");
    }
}

/// The text with arithmetic as it was written reads as the same scene, and is written so again.
#[track_caller]
fn keeps_arithmetic(document: &Document) {
    let text = document.write(&document.scene).unwrap();
    let again = match Document::from_text("written", &text, Files::default()) {
        Ok(again) => again,
        Err(error) => panic!("{error}\n{text}"),
    };
    assert_eq!(again.write(&again.scene).unwrap(), text);
    assert_eq!(write(&again.scene).unwrap(), write(&document.scene).unwrap(), "{text}");
}

/// The arguments that the program offers for a scene make it from another one.
#[track_caller]
fn can_be_set(scene: &scene::Scene) {
    let mut made = Document::load("nominal-cubic").unwrap();
    for argument in arguments(&made.scene, scene) {
        made.set(&argument).unwrap_or_else(|error| panic!("{error}"));
    }
    let left = arguments(&made.scene, scene);
    assert!(left.is_empty(), "{left:?}");
}

/// Makes the mechanism of a checked document, and runs it.
fn builds(document: &Document) {
    match Mechanism::build(&document.scene.mechanism, &document.files) {
        Err(BuildError::Wrong(fault)) => in_words(document.error_from(vec![fault]), NAME),
        Err(BuildError::Unsolved(error)) => in_words(error, ""),
        Ok(mechanism) => {
            runs(document, mechanism);
        }
    }
}

/// Makes the model and lets it run for a moment; the model, where there is one.
fn runs(document: &Document, mechanism: Mechanism) -> Option<Model> {
    let model = match Model::build(&document.scene, Arc::new(mechanism)) {
        Ok(model) => model,
        Err(faults) => {
            assert!(!faults.is_empty());
            in_words(document.error_from(faults), NAME);
            return None;
        }
    };
    model.describe().iter().for_each(|line| in_words(line, ""));
    let cancel = AtomicBool::new(false);
    let times = [0.0, 0.5 * model.duration(), model.duration()];
    let run = std::thread::scope(|scope| {
        let watch = scope.spawn(|| {
            std::thread::park_timeout(RUN);
            cancel.store(true, Ordering::Relaxed);
        });
        let run = model.run(&Request {
            sample_times: &times,
            events: true,
            ledger: true,
            cancel: Some(&cancel),
            ..Request::default()
        });
        watch.thread().unpark();
        run
    });
    let within = |t: f64| (0.0..=model.duration()).contains(&t);
    assert!(run.events.is_sorted_by(|a, b| a.t <= b.t) && run.events.iter().all(|event| within(event.t)));
    assert!(run.samples.len() <= times.len());
    if run.summary.outcome == Outcome::Done {
        assert_eq!(run.samples.len(), times.len());
        assert!(
            run.samples.iter().all(|sample| sample.x.is_finite() && sample.v.is_finite()),
            "{:?}",
            run.samples
        );
    }
    Some(model)
}
