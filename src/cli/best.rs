//! `best`: the best design for an environment, one row, with its margins.

use std::path::PathBuf;

use clap::Args;
use interwell::output::best_chart;
use interwell::questions::Best;
use interwell::scene::Document;
use interwell::system::files::is_file;

use super::support::{inputs, load, settle_limit, warn};
use super::{ChartOptions, Common, Failure, Output, Outputs, Picture, ask, interrupt, say};

const EXAMPLES: &str = "\
Examples:
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7 --subject-to 'max_abs_x_m<=0.001'
  interwell --headless best paper --over stops.travel_limit_mm=0.5:7 \\
      --environment excitation.amplitude_g=0.8,1,1.2 --vary excitation.amplitude_g=-2%:2%
  interwell --headless best paper --over stops.travel_limit_mm=0.2:2 --environment walking
  interwell --headless best random-shaking --over stops.travel_limit_mm=0.2:3 \\
      --environment excitation.seed=1,2,3,4,5
  interwell --headless best paper --over mechanism.preload_mm=1:3 --over stops.travel_limit_mm=0.5:5";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene file or built-in scene
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scene: String,

    /// A field of the design and its range (repeatable, at most four); STEP is that of the first scan
    /// [default: a 256th of the range; of two fields a 32nd, of three a 12th, of four an 8th]
    #[arg(long, value_name = "FIELD=A:B[:STEP]", allow_hyphen_values = true)]
    pub over: Vec<String>,

    /// Column to maximise: a number of the summary, whose name may lack its unit.
    /// mean_load_power_w needs a scene with a transducer
    #[arg(long, value_name = "COLUMN", default_value = "rms_velocity_m_per_s", visible_alias = "maximize")]
    pub maximise: String,

    /// Bound that holds in every environment, such as 'max_abs_x_m<=0.003' (repeatable)
    #[arg(long, value_name = "COLUMN<=VALUE|COLUMN>=VALUE")]
    pub subject_to: Vec<String>,

    /// Environment of the design, in place of the scene's excitation: excitation and run of another scene, a
    /// record (CSV), or values of a field; *WEIGHT after an environment is its weight, otherwise 1
    /// (repeatable; the weighted mean over all is maximised)
    #[arg(long, value_name = "SCENE|FILE|FIELD=a,b,c", allow_hyphen_values = true)]
    pub environment: Vec<String>,

    /// A tolerance of a field, the least and the largest deviation from its value: writes the worst of 200
    /// samples, every deviation between these bounds being as likely, and the value that 95 % of them reach
    /// (repeatable)
    #[arg(long, value_name = "FIELD=-1%:1%|-0.05:0.05", allow_hyphen_values = true)]
    pub vary: Vec<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s; where the
    /// drive never repeats, each run is as long as the scene says [default: 1000 forcing periods after the
    /// scene's run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    /// Keep the results of each run in this file (CSV) as soon as it has ended, and take from there those
    /// that the same search kept before it was interrupted
    #[arg(long, value_name = "FILE")]
    pub runs_to: Option<PathBuf>,

    /// Seed of the samples of --vary
    #[arg(long, value_name = "SEED", default_value_t = 1)]
    pub seed: u64,

    #[command(flatten)]
    pub chart: ChartOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::of_chart(&options.chart, common)?;
    let (document, warnings) = load(&options.scene, common)?;
    let request = Best {
        over: options.over.clone(),
        maximise: options.maximise.clone(),
        subject_to: options.subject_to.clone(),
        environment: options.environment.clone(),
        vary: options.vary.clone(),
        seed: options.seed,
        until_settled: settle_limit(options.until_settled.as_deref())?,
        runs_to: options.runs_to.clone(),
    };
    let question = request.question(&document)?;
    warn(&document, common, &warnings, None);
    let environments = environment_files(&options.environment);
    let kept = options.runs_to.clone().into_iter().collect();
    let read = [inputs(&options.scene, &document), environments.clone(), kept].concat();
    let mut outputs =
        Outputs::new(&read).with_rows(Some(common.out()))?.reading(&environments)?.with_picture(picture)?;
    let mut so_far = None;
    let found = ask("runs", common, |progress| {
        request.search(question, &document, progress, &mut |_, words| so_far = Some(words))
    });
    if let (Err(_), Some(words)) = (&found, &so_far) {
        say(&format!("{}: best so far at {words}", document.name));
    }
    if let (Err(_), Some(kept)) = (interrupt::check(), &options.runs_to) {
        say(&format!("the runs so far are in {}: the same command goes on from them", kept.display()));
    }
    let found = found?;
    outputs.table(Output::DATA, &found.table())?;
    outputs.draw(picture, &document, |ranges| Ok(best_chart(&found.question, &found.design, ranges)))?;
    found.words().iter().for_each(|line| common.say(&format!("{}: {line}", document.name)));
    outputs.finish_rows(&document, common.jobs())
}

/// The files that environments are read from: records, and scenes with the files that these name.
fn environment_files(environments: &[String]) -> Vec<PathBuf> {
    let file = |text: &String| {
        let without_weight = text.rsplit_once('*').map_or(&**text, |(name, _)| name).trim();
        [&**text, without_weight].map(PathBuf::from).into_iter().find(|path| is_file(path))
    };
    let mut files: Vec<PathBuf> = environments.iter().filter_map(file).collect();
    let scenes = files.iter().filter_map(|path| Document::of_argument(&path.to_string_lossy()).ok());
    let named: Vec<PathBuf> = scenes.flat_map(|document| document.named_files()).collect();
    files.extend(named);
    files
}
