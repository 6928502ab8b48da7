//! `compare`: scenes side by side under one sine, one row for each scene.

use clap::Args;
use interwell::output::{compared_name, comparison_chart, comparison_title};
use interwell::questions::Compare;
use interwell::scene::Document;

use super::support::{self, change, inputs, load_simulation, settle_limit, simulation};
use super::{Common, Failure, Output, Outputs, Picture, PlotOptions, ask, caption, interrupt};

const EXAMPLES: &str = "\
Examples:
  interwell --headless compare paper balanced magnet
  interwell --headless compare paper balanced magnet paper-unconstrained --set excitation.amplitude_g=0.8
  interwell --headless compare paper my.ron --environment first-look
  interwell --headless compare paper balanced magnet paper-unconstrained --plot alternatives.pdf \\
      --plot-width-mm 170 --no-title";

#[derive(Debug, Args)]
#[command(after_help = EXAMPLES)]
pub struct Arguments {
    /// Scene files or built-in scenes; --set changes each of them
    #[arg(value_name = "SCENE", default_value = "paper")]
    pub scenes: Vec<String>,

    /// The scene whose excitation, a sine or cosine, and run all of them have [default: the first]
    #[arg(long, value_name = "SCENE")]
    pub environment: Option<String>,

    /// Follow each run, window after window, until its motion repeats, or up to this time in s: longer is
    /// surer where the motion is irregular [default: 1000 forcing periods after the run]
    #[arg(long, value_name = "MAX_S", allow_hyphen_values = true)]
    pub until_settled: Option<String>,

    #[command(flatten)]
    pub plot: PlotOptions,
}

pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let picture = Picture::new(&options.plot, common)?;
    let environment = options.environment.as_deref();
    let environment = environment.map(|spec| load_simulation(spec, common)).transpose()?;
    let (mut all, mut read) = (Vec::new(), Vec::new());
    for (name, spec, document) in named(&options.scenes, common)? {
        read.extend(inputs(spec, &document));
        all.push((name, simulation(&document, common)?));
    }
    // without an argument there is the default one
    let (name, first) = all[0].clone();
    let until_settled = settle_limit(options.until_settled.as_deref())?;
    let question = Compare { with: all[1..].to_vec(), name, environment, until_settled };
    let scenes = question.scenes(&first, &interrupt::progress())?;
    if let [(only, _)] = &all[..] {
        common.say(&format!("{only}: the only scene; name others to set beside it"));
    }
    let environment = question.environment.as_ref().unwrap_or(&first).document();
    let mut outputs = Outputs::new(&read).with_rows(Some(common.out()))?.with_picture(picture)?;
    let found = ask("parts", common, |progress| question.run(&first, progress))?;
    outputs.table(Output::DATA, &found.table())?;
    found.remarks.iter().for_each(|remark| common.say(remark));
    if let Some(picture) = picture {
        let mut caption = caption(environment);
        caption.title = comparison_title(&found);
        picture.write(&mut outputs, &comparison_chart(&found.rated, found.frequency_hz), &caption)?;
    }
    let documents = scenes.into_iter().map(|(name, scene)| (name, scene.document().clone()));
    let documents: Vec<(String, Document)> = documents.collect();
    let first = documents.first().map(|(_, document)| document);
    outputs.manifest(first, common.jobs(), |manifest| Ok(manifest.of_scenes(&documents)))?;
    outputs.finish()
}

/// The scenes of the arguments, each with its name in the table and its argument. The manifest of a
/// comparison stands for all scenes of that comparison.
fn named<'a>(specs: &'a [String], common: &Common) -> Result<Vec<(String, &'a str, Document)>, Failure> {
    let mut all = Vec::new();
    for spec in specs {
        let mut document = support::read(spec, common)?;
        let compared = std::mem::take(&mut document.compared);
        if compared.is_empty() {
            all.push((compared_name(spec, &document), &**spec, document));
        }
        for (name, mut document) in compared {
            change(&mut document, common)?;
            all.push((compared_name(&name, &document), &**spec, document));
        }
    }
    Ok(all)
}
