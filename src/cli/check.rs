//! `check`: faults and warnings of scenes, and what each scene models.

use std::path::PathBuf;

use clap::Args;
use interwell::numeric::{one_line, short, visible};
use interwell::system::page_address;

use super::shard::line;
use interwell::questions::Simulation;

use super::support::{load, mechanism, read};
use super::{Common, Failure, Output, Outputs, say};

#[derive(Debug, Args)]
pub struct Arguments {
    /// Scene files or built-in scenes [default: paper]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    /// Print a link that opens each scene, in place of what it models
    #[arg(long)]
    pub link: bool,
}

/// Reports every scene. Wrong scenes are reported on standard error, and make the command fail.
pub fn run(options: &Arguments, common: &Common) -> Result<(), Failure> {
    let paper = ["paper".to_owned()];
    let scenes = if options.scenes.is_empty() { &paper[..] } else { &options.scenes[..] };
    let names: Vec<PathBuf> = scenes.iter().map(PathBuf::from).collect();
    let mut outputs = Outputs::new(&names).with(Output::DATA, Some(common.out()))?;
    let mut wrong = Vec::new();
    for spec in scenes {
        let text = if options.link { link(spec, common) } else { report(spec, common) };
        match text {
            Ok(text) => outputs.write(Output::DATA, &text)?,
            Err(error) => wrong.push(error),
        }
    }
    // a file with the valid scenes alone would look like a complete report
    if wrong.is_empty() || outputs.is_stdout(Output::DATA) {
        outputs.finish()?;
    }
    // The last error is returned, and its caller prints it.
    let Some(last) = wrong.pop() else { return Ok(()) };
    wrong.iter().for_each(|error| say(&format!("error: {error}")));
    // One wrong scene among the failed ones is enough for the exit status of wrong arguments.
    let any_wrong = wrong.iter().any(|error| matches!(error, Failure::Wrong(_)));
    Err(match last {
        Failure::Failed(error) if any_wrong => Failure::Wrong(error),
        last => last,
    })
}

fn link(spec: &str, common: &Common) -> Result<String, Failure> {
    let (document, _) = load(spec, common)?;
    // a link brings no file that is no table
    mechanism(&document)?;
    let link = document.link().map_err(|error| Failure::argument(format!("{}: {error}", document.name)))?;
    Ok(page_address().map_err(Failure::argument)? + &link + "\n")
}

fn report(spec: &str, common: &Common) -> Result<String, Failure> {
    let simulation = Simulation::new(&read(spec, common)?)?;
    let document = simulation.document();
    let mut text = format!("{}: {}\n", document.name, one_line(&document.scene.title));
    simulation.describe().iter().for_each(|line| text += &format!("  {line}\n"));
    if let Some(drive) = document.scene.harmonic()
        && simulation.can_cross()
    {
        // the default is the amplitude of a Sine
        let field = drive.rate.map(|_| {
            let present = drive.amplitude().abs();
            format!("{}=0:{}", drive.amplitude_path(), short(if present > 0.0 { 2.0 * present } else { 1.0 }))
        });
        // the search takes long, so its command is named instead
        let set = common.set.iter().flat_map(|set| ["--set", set]);
        let tolerance = common.tolerance.iter().flat_map(|tolerance| ["--tolerance", tolerance]);
        let search = ["interwell", "--headless", "threshold", spec, "--of", "crossing"].into_iter();
        let words =
            search.chain(field.iter().flat_map(|field| ["--field", field])).chain(set).chain(tolerance);
        text += &format!("  least amplitude that crosses: {}\n", line(words));
    }
    simulation.warnings().for_each(|warning| text += &format!("  warning: {warning}\n"));
    Ok(visible(&text).into_owned())
}
