//! `accuracy SCENE`: the error of a run, its cost over the tolerance, and its error in fixed steps.

use interwell::output::aligned;
use interwell::study::accuracy::methods::Scheme;
use interwell::study::accuracy::scene::{Unfit, scene_table, step_name, step_size, tolerances, trust};

use super::accuracy::Arguments;
use super::accuracy::show;
use super::failure::Failure;
use super::interrupt;
use super::options::Common;
use super::outputs::{Output, Outputs};
use super::support::{inputs, load_model};

/// Analyses the run of the scene called `spec`.
pub fn run(spec: &str, options: &Arguments, common: &Common) -> Result<(), Failure> {
    let steps = options.step_s.as_deref().map_or_else(|| Ok(Vec::new()), steps)?;
    let (document, model) = load_model(spec, common)?;
    let mut outputs = Outputs::new(&inputs(spec, &document)).with(Output::DATA, common.out.as_deref())?;
    let cancel = interrupt::listen();

    let trusted = trust(&model, cancel).ok_or_else(Failure::interrupted)?;
    let mut text = match trusted.short(0.0) {
        Some(short) => format!("{short}. {}\n", trusted.long(0.0)),
        None => format!("The run ends early ({}), after {} s.\n", trusted.outcome.name(), trusted.span),
    };
    let cost = tolerances(&model, cancel).ok_or_else(Failure::interrupted)?;
    let mut stepped = Vec::new();
    for scheme in Scheme::ALL.into_iter().filter(|scheme| is_chosen(*scheme, &options.method)) {
        for step in &steps {
            let run = step_size(&model, scheme, *step, cancel).map_err(|unfit| match unfit {
                Unfit::Cancelled => Failure::interrupted(),
                Unfit::Compliant | Unfit::ElectricalState => Failure::argument(format!("--step-s: {unfit}")),
            })?;
            text += &format!(
                "{} in steps of {}: {}\n",
                scheme.name(),
                step_name(*step),
                run.sentences().join(" ")
            );
            stepped.push(run);
        }
    }
    let table = scene_table(&cost, &stepped);
    text += &format!("\n{}", aligned(&table));
    outputs.table(Output::DATA, &table)?;
    let to_stdout = outputs.is_stdout(Output::DATA);
    outputs.finish()?;
    show(&text, to_stdout, common.quiet)
}

fn is_chosen(scheme: Scheme, names: &[String]) -> bool {
    let name = match scheme {
        Scheme::SemiImplicitEuler => "euler",
        Scheme::VelocityVerlet => "verlet",
        Scheme::RungeKutta4 => "rk4",
    };
    names.is_empty() || names.iter().any(|chosen| chosen == name)
}

/// The shortest and the longest step in s that a run is made with.
const STEPS: (f64, f64) = (1e-6, 1.0);

/// Steps in s, each a number or a fraction.
fn steps(text: &str) -> Result<Vec<f64>, Failure> {
    let number = |text: &str| text.trim().parse::<f64>().ok();
    let step = |part: &str| {
        let value = match part.split_once('/') {
            Some((above, below)) => number(above).zip(number(below)).map(|(above, below)| above / below),
            None => number(part),
        };
        let (least, most) = STEPS;
        value.filter(|step| (least..=most).contains(step)).ok_or_else(|| {
            Failure::argument(format!(
                "--step-s {text}: `{part}` is no step; give seconds from {least:e} to {most}, such as 0.001 \
                 or 1/60"
            ))
        })
    };
    text.split(',').map(step).collect()
}
