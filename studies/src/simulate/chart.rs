//! Picture of one run: displacement, velocity and base acceleration over time, and the phase portrait.

use std::ops::Range;
use std::sync::atomic::AtomicBool;

use super::Trace;
use crate::dynamics::{Model, Outcome, STANDARD_GRAVITY, Summary};
use crate::numeric::{extent, short};
use crate::output::{
    Chart, DISPLACEMENT, Drawn, Layer, LedgerTerm, Marks, Note, OverTime, Panel, PanelColumn, PlotAxis,
    Point, REGIMES, Ranges, Role, TIME, ledger_panel, portrait_panel, suited_unit,
};
use crate::study::Table;

words! {
    /// A panel of the picture of a run, in the order in which they stand.
    RunPanel {
        /// Displacement over time.
        Displacement = "displacement",
        /// Velocity over time.
        Velocity = "velocity",
        /// Acceleration of the base over time.
        Acceleration = "acceleration",
        /// Power into the load of a transducer, or without one of the base on the mass, over time.
        Power = "power",
        /// Potential and kinetic energy over time.
        Energy = "energy",
        /// Work, losses and stored energy over the times shown, as bars.
        Ledger = "ledger",
        /// Velocity over displacement.
        Portrait = "portrait",
    }
}

impl RunPanel {
    /// The default panels. If they are shown together, numbers are printed beside them.
    pub const USUAL: [Self; 4] = [Self::Displacement, Self::Velocity, Self::Acceleration, Self::Portrait];

    /// The trace of a run of this model with the ledger, if one of these panels shows it.
    #[doc(hidden)]
    pub fn complete(panels: &[Self], trace: Trace, model: &Model, cancel: &AtomicBool) -> Trace {
        if panels.contains(&Self::Ledger) { trace.with_ledger(model, Some(cancel)) } else { trace }
    }
}

/// The picture of a run of a model from its trace and its summary, with these panels. The trace says which
/// times it shows; `ranges` may give the axis of the displacement, in mm.
#[doc(hidden)]
pub fn run_chart(
    trace: &Trace,
    summary: &Summary,
    model: &Model,
    panels: &[RunPanel],
    ranges: Ranges,
) -> Chart {
    // the default picture, with its numbers, has a different order
    let whole = RunPanel::USUAL.iter().all(|panel| panels.contains(panel));
    let usual = RunPanel::ALL.into_iter().filter(|panel| panels.contains(panel));
    let ordered: Vec<RunPanel> = if whole { usual.collect() } else { panels.to_vec() };
    let panels = ordered.as_slice();
    let column = |name: &str| trace.path.numbers(name).unwrap_or_default();
    let stable = model.mechanism().landscape.equilibria.iter().filter(|equilibrium| equilibrium.stable);
    let seen = Seen {
        trace,
        model,
        t: column("t_s"),
        x: column("x_m"),
        v: column("v_m_per_s"),
        accel: column("base_accel_m_per_s2"),
        power: column("power_w"),
        wells: stable.map(|equilibrium| equilibrium.x).collect(),
        speed: suited_unit("m/s", column("v_m_per_s").iter().copied()),
        displacements: ranges.y,
        panels,
        // on a compliant stop the mass never comes to rest completely
        rests: if summary.peak_contact_force.is_some() { "on a stop" } else { "at rest on a stop" },
    };
    let judged = is_judged(summary, trace);
    let about = match judged || summary.outcome != Outcome::Done {
        true => subtitle(summary),
        false => format!("from {} to {} s", short(trace.shown_from), short(trace.shown_to)),
    };
    let mut built: Vec<Panel> = panels.iter().map(|panel| seen.panel(*panel)).collect();
    let place = panels.iter().position(|panel| *panel == RunPanel::Portrait);
    if let Some(place) = place.filter(|_| whole && judged) {
        built[place].notes = account(summary, trace, seen.speed);
    }
    let data = seen.drawn(place.map(|place| &built[place]));
    let beside = place.filter(|_| whole).map(|place| built.remove(place));
    let mut chart = Chart::stack(built, about, data);
    chart.columns.extend(beside.map(|portrait| PanelColumn { width: 0.44, panels: vec![portrait] }));
    chart
}

/// The data of the picture of a run, in SI.
struct Seen<'a> {
    trace: &'a Trace,
    model: &'a Model,
    t: &'a [f64],
    x: &'a [f64],
    v: &'a [f64],
    accel: &'a [f64],
    power: &'a [f64],
    wells: Vec<f64>,
    /// Factor from m/s and name of the unit of speed.
    speed: (f64, &'static str),
    /// The axis of the displacement in mm, where it was asked for.
    displacements: Option<(f64, f64)>,
    panels: &'a [RunPanel],
    /// The legend entry of spans at rest.
    rests: &'static str,
}

impl Seen<'_> {
    fn has(&self, panel: RunPanel) -> bool {
        self.panels.contains(&panel)
    }

    fn is_over_time(&self) -> bool {
        self.panels.iter().any(|panel| !matches!(panel, RunPanel::Portrait | RunPanel::Ledger))
    }

    /// The rows from a time on up to where the picture ends.
    fn rows(&self, from: f64) -> Range<usize> {
        let end = self.t.partition_point(|t| *t <= self.trace.shown_to);
        self.t.partition_point(|t| *t < from).min(end)..end
    }

    /// The axis for these displacements. Stops are included if the mass comes near them, so that a distant
    /// stop does not flatten the motion.
    fn displacement(&self, x: &[f64]) -> PlotAxis {
        const NEAR: f64 = 0.4;
        let (low, high) = extent(x.iter().copied().filter(|x| x.is_finite()));
        // a mass that does not move is shown with all stops and equilibria
        let room = if low < high { NEAR * (high - low) } else { 3.0 * high.abs() };
        let stops = [self.trace.stops.0, self.trace.stops.1];
        let near = stops.into_iter().filter(|stop| (low - room..=high + room).contains(stop));
        let axis = PlotAxis::around(x.iter().copied().chain(near).map(|x| x * 1e3), 0.11, DISPLACEMENT);
        axis.or_given(self.displacements)
    }

    fn velocity(&self, v: &[f64]) -> PlotAxis {
        let (scale, unit) = self.speed;
        PlotAxis::around(v.iter().map(|v| v * scale), 0.08, &RunPanel::Velocity.label(unit, false))
    }

    fn stops_mm(&self) -> (f64, f64) {
        (self.trace.stops.0 * 1e3, self.trace.stops.1 * 1e3)
    }

    fn panel(&self, kind: RunPanel) -> Panel {
        let Self { trace, x, v, speed, .. } = *self;
        let shown = self.rows(trace.shown_from);
        let label = |unit: &str| kind.label(unit, trace.has_load);
        match kind {
            RunPanel::Displacement => self.quantity(kind, (x, 1e3), self.displacement(&x[shown]), 1.0),
            RunPanel::Velocity => self.quantity(kind, (v, speed.0), self.velocity(&v[shown]), 0.9),
            RunPanel::Acceleration => {
                let in_g = self.accel[shown].iter().map(|a| a / STANDARD_GRAVITY);
                let up = PlotAxis::around(in_g.chain([0.0]), 0.1, &label("g"));
                self.quantity(kind, (self.accel, 1.0 / STANDARD_GRAVITY), up, 0.85)
            }
            RunPanel::Power => {
                let power = &self.power[shown];
                let (per_watt, watt) = suited_unit("W", power.iter().copied());
                let watts = power.iter().map(|power| power * per_watt);
                let up = PlotAxis::around(watts.chain([0.0]), 0.08, &label(watt));
                self.quantity(kind, (self.power, per_watt), up, 1.0)
            }
            RunPanel::Energy => self.energy(),
            RunPanel::Ledger => self.ledger(),
            RunPanel::Portrait => self.portrait(),
        }
    }

    /// The times at rest that the picture shows in part.
    fn rest_spans(&self) -> impl Iterator<Item = (f64, f64)> {
        let Self { trace, .. } = *self;
        let [from, to] = ["from_s", "to_s"].map(|name| trace.rests.numbers(name).unwrap_or_default());
        let spans = from.iter().copied().zip(to.iter().copied());
        spans.filter(move |(from, to)| *to >= trace.shown_from && *from <= trace.shown_to)
    }

    /// The events and positions that its panels over time share.
    fn beside(&self) -> OverTime {
        let Self { trace, .. } = *self;
        let times = trace.impacts.numbers("t_s").unwrap_or_default();
        let impacts = times.iter().zip(trace.impacts.words("side"));
        let on =
            |side: &str| impacts.clone().filter(|impact| *impact.1 == side).map(|impact| *impact.0).collect();
        OverTime {
            time: PlotAxis::between(trace.shown_from, trace.shown_to, TIME),
            rests: (self.rest_spans().collect(), self.rests),
            impacts: [on("left"), on("right")],
            stops: self.stops_mm(),
            wells: self.wells.iter().map(|well| well * 1e3).collect(),
        }
    }

    /// The panel of a quantity over time, of these values in SI and times `scale`.
    fn quantity(&self, kind: RunPanel, (values, scale): (&[f64], f64), up: PlotAxis, height: f64) -> Panel {
        let Self { trace, .. } = *self;
        let pairs = self.rows(trace.shown_from).map(|i| (self.t[i], values[i] * scale));
        let line = Layer::new(kind.role(trace.has_load), "", Marks::Trace(pairs.collect()));
        Panel { height, ..kind.over_time(up, vec![line], &self.beside()) }
    }

    /// Potential energy in J, counted from the bottom of the deeper well or, without wells, from its least
    /// value.
    fn potential(&self, x: f64) -> f64 {
        let curve = &self.model.mechanism().curve;
        let of = |places: &[f64]| places.iter().map(|x| curve.potential(*x)).fold(f64::INFINITY, f64::min);
        curve.potential(x) - if self.wells.is_empty() { of(self.x) } else { of(&self.wells) }
    }

    /// Potential energy, and the sum with the kinetic one, over time.
    fn energy(&self) -> Panel {
        let shown = self.rows(self.trace.shown_from);
        let mass = self.model.mass();
        let of = |i: usize, with: f64| {
            (self.t[i], self.potential(self.x[i]) + with * 0.5 * mass * self.v[i] * self.v[i])
        };
        let [potential, total] =
            [0.0, 1.0].map(|with| shown.clone().map(|i| of(i, with)).collect::<Vec<_>>());
        let barrier = self.model.mechanism().landscape.barrier.map(|barrier| self.potential(barrier.x));
        let values = || total.iter().map(|point| point.1).chain(barrier).chain([0.0]);
        let (scale, unit) = suited_unit("J", values());
        let up = PlotAxis::around(
            values().map(|energy| energy * scale),
            0.08,
            &RunPanel::Energy.label(unit, false),
        );
        let beside = self.beside();
        let mut panel = Panel::new(beside.time.clone(), up);
        panel.rests(&beside);
        if let Some(barrier) = barrier {
            panel.layer(Role::Barrier, "top of the barrier", Marks::Horizontals(vec![barrier * scale]));
        }
        let scaled = |points: Vec<Point>| {
            Marks::Trace(points.into_iter().map(|(t, energy)| (t, energy * scale)).collect())
        };
        panel.layer(Role::Total, "potential and kinetic energy", scaled(total));
        panel.layer(Role::Potential, "potential energy", scaled(potential));
        panel
    }

    fn ledger(&self) -> Panel {
        let trace = self.trace;
        let terms = LedgerTerm::ALL.iter().map(|term| (term.energy)(&trace.ledger));
        let (per_joule, name) = suited_unit("J", terms);
        let times = [trace.shown_from, trace.shown_to].map(short);
        ledger_panel(&trace.ledger, trace.has_load, (&times[0], &times[1]), (1.0 / per_joule, name))
    }

    /// Time, displacement and velocity once a forcing period, in SI.
    fn strobes(&self) -> impl Iterator<Item = [f64; 3]> {
        let column = |name: &str| self.trace.strobes.numbers(name).unwrap_or_default();
        let [t, x, v] = ["t_s", "x_m", "v_m_per_s"].map(column);
        t.iter().zip(x).zip(v).map(|((t, x), v)| [*t, *x, *v])
    }

    fn portrait(&self) -> Panel {
        let Self { trace, .. } = *self;
        let shown = self.rows(trace.portrait_from);
        let (x, v) = (&self.x[shown.clone()], &self.v[shown]);
        let path = x.iter().zip(v).map(|(x, v)| (x * 1e3, v * self.speed.0)).collect();
        let mut motion = vec![Layer::new(Role::Motion, "", Marks::Path(path))];
        let strobes: Vec<Point> = self.strobes().map(|[_, x, v]| (x * 1e3, v * self.speed.0)).collect();
        if let (Some(x), true, true) = (x.first(), is_still(x), is_still(v)) {
            motion.push(Layer::new(Role::Resting, "the mass at rest", Marks::Points(vec![(x * 1e3, 0.0)])));
        }
        if !strobes.is_empty() {
            motion.push(Layer::new(Role::Strobe, "once a period", Marks::Points(strobes)));
        }
        let axes = (self.displacement(x), self.velocity(v));
        let panel = portrait_panel(self.model, axes, self.speed.0, self.stops_mm(), motion);
        let heading = match short(trace.portrait_from) {
            from if trace.shown_to < trace.end => {
                format!("phase portrait, {from} to {} s", short(trace.shown_to))
            }
            from => format!("phase portrait from {from} s on"),
        };
        Panel { height: 1.2, heading, ..panel }
    }

    /// The drawn data, with this portrait.
    fn drawn(&self, portrait: Option<&Panel>) -> Table {
        let Self { trace, t, x, v, accel, power, .. } = *self;
        let has_energy = self.has(RunPanel::Energy);
        let names = ["t_s", "x_m", "v_m_per_s", "base_accel_m_per_s2"].into_iter();
        let has_power = self.has(RunPanel::Power);
        let names = names.chain(has_power.then_some("power_w"));
        let names = names.chain(has_energy.then_some(["potential_j", "kinetic_j"]).into_iter().flatten());
        let has_ledger = self.has(RunPanel::Ledger);
        let names: Vec<&str> = names.chain(has_ledger.then_some("energy_j")).collect();
        let count = names.len();
        let mut drawn = Drawn::new(names, if has_ledger { &["side", "term"] } else { &["side"] });
        let shown =
            [RunPanel::Displacement, RunPanel::Velocity, RunPanel::Acceleration].map(|panel| self.has(panel));
        for i in self.rows(trace.shown_from).filter(|_| self.is_over_time()) {
            let value = |place: usize, of: &[f64]| if shown[place] { of[i] } else { f64::NAN };
            let mut row = vec![t[i], value(0, x), value(1, v), value(2, accel)];
            row.extend(has_power.then_some(power[i]));
            if has_energy {
                row.extend([self.potential(x[i]), 0.5 * self.model.mass() * v[i] * v[i]]);
            }
            drawn.put("run", &row, &[]);
        }
        for term in LedgerTerm::ALL.iter().filter(|term| has_ledger && term.role != Role::ByHand) {
            let mut row = vec![f64::NAN; count];
            row[count - 1] = (term.energy)(&trace.ledger);
            drawn.put("ledger", &row, &["", term.name]);
        }
        for i in self.rows(trace.portrait_from).filter(|_| self.has(RunPanel::Portrait)) {
            drawn.put("portrait", &[t[i], x[i], v[i]], &[]);
        }
        let strobes = self.strobes().filter(|_| self.has(RunPanel::Portrait));
        strobes.for_each(|strobe| drawn.put("once_a_period", &strobe, &[]));
        for layer in portrait.iter().flat_map(|panel| &panel.layers) {
            let name = match layer.role {
                Role::Separatrix => "separatrix",
                Role::Stable => "stable_equilibrium",
                Role::Unstable => "unstable_equilibrium",
                _ => continue,
            };
            if let Marks::Path(points) | Marks::Points(points) = &layer.marks {
                points.iter().for_each(|(x, v)| drawn.put(name, &[f64::NAN, x / 1e3, v / self.speed.0], &[]));
            }
        }
        let has_places = self.has(RunPanel::Displacement) || self.has(RunPanel::Portrait);
        let shown = trace.shown_from..=trace.shown_to;
        if self.has(RunPanel::Displacement) {
            let impacts = trace.impacts.numbers("t_s").unwrap_or_default();
            let impacts = impacts.iter().zip(trace.impacts.words("side"));
            for (at, side) in impacts.filter(|impact| shown.contains(impact.0)) {
                let stop = if *side == "left" { trace.stops.0 } else { trace.stops.1 };
                drawn.put("impact", &[*at, stop], &[side]);
            }
        }
        for (from, to) in self.rest_spans().filter(|_| self.is_over_time()) {
            drawn.put("rest_from", &[from.max(trace.shown_from)], &[]);
            drawn.put("rest_to", &[to.min(trace.shown_to)], &[]);
        }
        for (at, side) in [(trace.stops.0, "left"), (trace.stops.1, "right")] {
            if at.is_finite() && has_places {
                drawn.put("stop", &[f64::NAN, at], &[side]);
            }
        }
        let wells = self.wells.iter().filter(|_| self.has(RunPanel::Displacement));
        wells.for_each(|at| drawn.put("well", &[f64::NAN, *at], &[]));
        drawn.table()
    }
}

fn is_still(values: &[f64]) -> bool {
    values.iter().all(|value| *value == values[0])
}

fn reason(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Done => "done",
        Outcome::LeftTable { .. } => "the mass left the force curve",
        Outcome::ImpactBudget { .. } => "more impacts than one run may make",
        Outcome::StepBudget { .. } => "more work than one run may take",
        Outcome::NotFinite { .. } => "a number was no longer finite",
        Outcome::Inaccurate { .. } => "the energy does not balance",
        Outcome::Cancelled { .. } => "cancelled",
    }
}

/// Whether the picture is one of the settled window, which the summary is about. A section of the run may
/// show other times.
fn shows_window(summary: &Summary, trace: &Trace) -> bool {
    let (from, to) = summary.window;
    !trace.is_section || (trace.shown_from <= from && trace.shown_to >= to)
}

/// Whether regime and averages are those of the times that are shown: of the settled window, or of a settled
/// motion at any time from its begin on.
fn is_judged(summary: &Summary, trace: &Trace) -> bool {
    shows_window(summary, trace) || (summary.settled == Some(true) && trace.shown_from >= summary.window.0)
}

fn subtitle(summary: &Summary) -> String {
    match summary.outcome.ended_at() {
        Some(at) => format!("ended early at {} s: {}", short(at), reason(summary.outcome)),
        None if summary.outcome != Outcome::Done => reason(summary.outcome).to_owned(),
        None => match (summary.regime.name(), summary.period) {
            ("", _) => "one well or none: nothing to cross".to_owned(),
            ("interwell", Some(1)) => "interwell: repeats in every forcing period".to_owned(),
            ("interwell", Some(n)) => format!("interwell: repeats after {n} forcing periods"),
            ("irregular", _) => "irregular: crosses without a period".to_owned(),
            ("intrawell", _) => "intrawell: moves without crossing".to_owned(),
            ("rest", _) => "at rest".to_owned(),
            (other, _) => other.to_owned(),
        },
    }
}

/// Regime and numbers, under the phase portrait.
fn account(summary: &Summary, trace: &Trace, (scale, unit): (f64, &str)) -> Vec<Note> {
    let name = summary.regime.name();
    let regime =
        REGIMES.iter().position(|regime| regime.0 == name).filter(|_| summary.rms_velocity.is_some());
    let regime = regime.map(|place| Note { words: name.to_owned(), role: Some(Role::Regime(place)) });
    let mut notes: Vec<Note> = regime.into_iter().collect();
    let mut say = |words: String| notes.push(Note { words, role: None });
    if let Some(rms) = summary.rms_velocity {
        let (from, to) = (short(summary.window.0), short(summary.window.1));
        say(match (summary.settled, summary.is_transient()) {
            (Some(true), _) => format!("settled, from {from} s on:"),
            (_, true) => format!("not settled, {from} to {to} s:"),
            (Some(false), false) => format!("averages steady, {from} to {to} s:"),
            (None, _) => format!("from {from} to {to} s:"),
        });
        say(format!("RMS velocity {} {unit}", short(rms * scale)));
        if shows_window(summary, trace) {
            let impacts = format!("{} impacts", summary.impacts);
            say(match name {
                "" => impacts,
                _ => format!("{} crossings, {impacts}", summary.crossings),
            });
        }
        let words = if summary.peak_contact_force.is_some() { "in contact" } else { "at rest" };
        if let Some(share) = summary.rested_share.filter(|share| *share > 0.0) {
            say(format!("{words} {:.0} % of the time", 100.0 * share));
        }
        if let Some(force) = summary.peak_contact_force.filter(|force| *force > 0.0) {
            say(format!("contact force up to {} N", short(force)));
        }
    } else if trace.path.rows() > 0 {
        say("ended before its settled window".to_owned());
    }
    notes
}
