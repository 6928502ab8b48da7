//! One run: its samples, events and summary.

use std::sync::atomic::AtomicBool;

use super::table::Table;
use super::times::{SamplingStep, TimesError, even_times, listed_times};
use crate::dynamics::{Event, Model, Output, Request, Sample, Summary};
use crate::scene::{Excitation, Scene};

/// When to sample.
#[derive(Debug, Clone, PartialEq)]
pub enum Sampling {
    /// A 60th of the forcing period, without one a thousandth of the duration.
    Default,
    /// Every so many seconds.
    Every(f64),
    /// At these times in s, in any order; the rows keep that order.
    At(Vec<f64>),
}

/// What to keep of a run besides its summary.
#[derive(Debug, Clone, PartialEq)]
pub struct Keep {
    /// Sample times in s, in the order of the rows.
    pub times: Vec<f64>,
    /// Whether to keep the events.
    pub events: bool,
    /// Goes on until the motion repeats, or up to this time in s.
    pub until_settled: Option<f64>,
}

/// One run, recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// `t_s,x_m,v_m_per_s,base_accel_m_per_s2,phase`, with a transducer also `voltage_v,current_a,power_w`;
    /// up to the end of the run.
    pub samples: Table,
    /// `t_s,kind,side,v_in_m_per_s,v_out_m_per_s` in order of time.
    pub events: Table,
    /// Statistics, outcome and ledger.
    pub summary: Summary,
}

/// The sample times in s that `sampling` asks of this run, up to the last at which it may end.
pub fn sample_times(
    scene: &Scene,
    model: &Model,
    sampling: &Sampling,
    until_settled: Option<f64>,
) -> Result<Vec<f64>, TimesError> {
    let duration = until_settled.unwrap_or(model.duration());
    let step = match sampling {
        Sampling::At(times) => return listed_times(times, duration),
        Sampling::Every(dt) => SamplingStep::Seconds(*dt),
        Sampling::Default => match (&scene.excitation, model.forcing_period()) {
            (Excitation::Sine { frequency_hz, .. } | Excitation::AmplitudeRamp { frequency_hz, .. }, _) => {
                SamplingStep::PeriodOf(*frequency_hz)
            }
            (_, Some(period)) => SamplingStep::Period(period),
            _ => SamplingStep::Thousandth,
        },
    };
    even_times(step, duration)
}

/// Runs `model` once. Setting `cancel` from elsewhere ends it early, as its outcome then says.
pub fn simulate(model: &Model, keep: &Keep, cancel: Option<&AtomicBool>) -> Simulation {
    let ascending = keep.times.is_sorted();
    let mut sorted = Vec::new();
    if !ascending {
        sorted.clone_from(&keep.times);
        sorted.sort_by(f64::total_cmp);
    }
    let sample_times = if ascending { &keep.times } else { &sorted };
    let request = Request { sample_times, events: keep.events, cancel, ..Request::default() };
    let run = model.run(&Request { ledger: true, until_settled: keep.until_settled, ..request });
    let samples = if ascending { run.samples } else { in_order(&keep.times, &run.samples) };
    Simulation {
        samples: samples_table(&samples, |sample| model.output(sample)),
        events: events_table(&run.events),
        summary: run.summary,
    }
}

/// The samples in the order of `times`; times that an early end left without one are left out.
pub(super) fn in_order(times: &[f64], samples: &[Sample]) -> Vec<Sample> {
    let find = |t: &f64| {
        let at = samples.partition_point(|sample| sample.t < *t);
        samples.get(at).filter(|sample| sample.t == *t).copied()
    };
    times.iter().filter_map(find).collect()
}

/// Samples as the table `t_s,x_m,v_m_per_s,base_accel_m_per_s2,phase`; where any has an `output` of a
/// transducer also `voltage_v,current_a,power_w`, which the others miss.
pub fn samples_table(samples: &[Sample], output: impl Fn(&Sample) -> Option<Output>) -> Table {
    let table = Table::new()
        .each("t_s", samples, |sample| sample.t)
        .each("x_m", samples, |sample| sample.x)
        .each("v_m_per_s", samples, |sample| sample.v)
        .each("base_accel_m_per_s2", samples, |sample| sample.base_accel)
        .each("phase", samples, |sample| sample.phase.name());
    let outputs: Vec<Option<Output>> = samples.iter().map(output).collect();
    if outputs.iter().all(Option::is_none) {
        return table;
    }
    let column = |of: fn(&Output) -> f64| move |output: &Option<Output>| output.as_ref().map_or(f64::NAN, of);
    table
        .each("voltage_v", &outputs, column(|output| output.voltage))
        .each("current_a", &outputs, column(|output| output.current))
        .each("power_w", &outputs, column(|output| output.power))
}

/// Events as a table: `t_s,kind,side,v_in_m_per_s,v_out_m_per_s`, a row an event, SI.
pub fn events_table(events: &[Event]) -> Table {
    Table::new()
        .each("t_s", events, |event| event.t)
        .each("kind", events, |event| event.kind.name())
        .each("side", events, |event| event.side.name())
        .each("v_in_m_per_s", events, |event| event.v_in)
        .each("v_out_m_per_s", events, |event| event.v_out)
}
