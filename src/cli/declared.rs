//! A command whose study declares its arguments, tables, remarks and picture.

use clap::Args;
use interwell::output::{header, rows};
use interwell::questions::{Error, Table};
use interwell_studies::study::{
    Answered, Cancelled, Framing, IMPACTS, Scenes, Spelling, Streamed, Study, Task,
};

use super::options::takes_one_thread;
use super::support::{Watch, load_over, mechanism_of_all, outputs, pool, warn};
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, ask, bar, interrupt, refuse, say};

/// What a study answers, as its help says it.
pub fn about<S: Study>() -> String {
    let command = S::augment_args(clap::Command::new(S::NAME));
    command.get_about().map(ToString::to_string).unwrap_or_default()
}

#[derive(Debug, Args)]
pub struct Arguments<S: Study> {
    #[arg(help = S::SCENE, value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// One row for each value of a field (repeatable, the first is the slowest)
    #[arg(long, value_name = "FIELD=FROM:TO:STEP|a,b,c", allow_hyphen_values = true, hide = !S::GRID)]
    pub over: Vec<String>,

    #[command(flatten)]
    pub study: S,

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run<S: Study>(options: &Arguments<S>, common: &Common) -> Result<(), Failure> {
    let Arguments { scene, study, over, chart } = options;
    if let (false, Some(field)) = (S::GRID, over.first()) {
        refuse!("--over {field}: `{}` takes one scene: leave it out", S::NAME);
    }
    let picture = Picture::of_chart(chart, common)?;
    let (document, warnings, grid) = load_over(scene, over, |document| study.prepare(document), common)?;
    if let Some(picture) = picture {
        study.can_draw(&grid)?;
        study.check_ranges(&picture.ranges)?;
    }
    let scenes = Scenes { document: &document, grid: &grid, mechanism: None };
    study.check(&scenes)?;
    if let Some(streamed) = study.streamed(&scenes, &interrupt::progress())? {
        warn(&document, common, &warnings, streamed.rows.first_mechanism().as_deref());
        let outputs = outputs(scene, &document, common)?.with_picture(picture)?;
        return stream(&streamed, &scenes, study.parts(&scenes), outputs, picture, common);
    }
    let mechanism = mechanism_of_all(&document, &grid, common, &warnings)?;
    let scenes = Scenes { mechanism: mechanism.as_ref(), ..scenes };
    let mut outputs = outputs(scene, &document, common)?.with_picture(picture)?;
    let files = study.files();
    for (option, path) in &files {
        outputs = outputs.with(Output::further(option), Some(path))?;
    }
    if let (false, Some(forecast)) = (common.quiet, study.forecast(&scenes)?) {
        say(&forecast);
    }
    let Answered { table, parts, beside, remarks, chart, manifest } =
        ask(study.parts(&scenes), common, |progress| study.answer(&scenes, progress))?;
    match parts {
        Some((count, part)) => {
            outputs.table(Output::DATA, &part(0, 0))?;
            for begin in (0..count).step_by(ROWS) {
                interrupt::check()?;
                outputs.write(Output::DATA, rows(&part(begin, begin + ROWS), 0..ROWS))?;
            }
        }
        None => outputs.table(Output::DATA, &table.without(IMPACTS))?,
    }
    for ((option, _), table) in files.iter().zip(&beside) {
        outputs.table(Output::further(option), table)?;
    }
    for remark in remarks {
        let text = format!("{}: {}", document.name, remark.text.spelled(Spelling::CommandLine));
        if remark.is_warning { say(&text) } else { common.say(&text) }
    }
    if let Some(chart) = chart {
        outputs.draw(picture, &document, |ranges| Ok(chart(&table, &framing(ranges))?))?;
    }
    let jobs = if takes_one_thread(S::NAME) { 1 } else { common.jobs() };
    let Some(manifest) = manifest else { return outputs.finish_rows(&document, jobs) };
    outputs.manifest(Some(&document), jobs, |made| Ok(manifest(made)))?;
    outputs.finish()
}

/// Rows of an answer in parts that are made and written at a time.
const ROWS: usize = 1 << 14;

fn framing(ranges: interwell::output::Ranges) -> Framing<'static> {
    Framing { quantity: None, ranges, cancel: interrupt::listen() }
}

/// Computes and writes the rows of a grid. With a picture all are computed, even after the reader of a pipe
/// has gone.
fn stream(
    streamed: &Streamed,
    scenes: &Scenes,
    unit: &str,
    mut outputs: Outputs,
    picture: Option<Picture>,
    common: &Common,
) -> Result<(), Failure> {
    let Scenes { document, grid, .. } = *scenes;
    let Streamed { rows: study, remark, manifest, chart } = streamed;
    // The manifest is opened only when it is written, since a killed process would leave it unfinished.
    outputs.leave(Output::MANIFEST);
    let pool = pool(common)?;
    outputs.watch = Watch::start();
    let progress = bar(study.count(), 0, unit, common);
    let task = Task { tick: &|| progress.inc(1), cancel: interrupt::listen() };
    study.validate(&pool, &task).map_err(|cell| Error::cells_of(document, vec![cell]))?;
    outputs.write(Output::DATA, header(&study.header().without(IMPACTS)))?;
    let (mut shown, mut count, mut failed) = (Table::new(), 0, None);
    let tally = study.run(&pool, &task, &mut |table| {
        count += table.rows();
        if picture.is_some() {
            shown.append(table);
        }
        match outputs.stream(Output::DATA, &rows(&table.without(IMPACTS), 0..usize::MAX)) {
            Ok(wanted) => wanted || picture.is_some(),
            Err(failure) => {
                failed = Some(failure);
                false
            }
        }
    });
    if let Some(failure) = failed {
        return Err(failure);
    }
    let tally = tally.map_err(|Cancelled| Failure::interrupted())?;
    outputs.draw(picture, document, |ranges| Ok(chart(&shown, &framing(ranges))?))?;
    outputs.manifest(Some(document), pool.count(), |made| Ok(manifest(made, grid, &tally)))?;
    let watch = outputs.watch;
    outputs.finish()?;
    if tally.cells == study.count() {
        common.say(&remark(&tally, count, watch.wall_s()));
    }
    Ok(())
}
