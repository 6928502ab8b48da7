//! Summary of a record: statistics, regime and energy ledger.

use super::recorder::Recorder;
use super::sums::Sums;
use crate::dynamics::clock::Instant;
use crate::dynamics::model::excitation::Rhythm;
use crate::dynamics::result::{Harvest, Ledger, MapState, Outcome, Place, Regime, Run, Sample, Summary};
use crate::dynamics::state::{MotionState, Start};
use crate::numeric::{CompensatedSum, Scalar};

/// Share of the length scale up to which a motion is rounding: the mass has not moved.
pub(crate) const MAX_ROUNDING: f64 = 1e-12;

fn value<T: Scalar>(sum: &CompensatedSum<T>) -> f64 {
    sum.value().to_f64()
}

impl<T: Scalar> Recorder<'_, T> {
    /// The results of a run that ends in `state`; `potential` is the change of the potential over it in J.
    pub fn finish(
        mut self,
        state: &MotionState<T>,
        start: &Start<T>,
        potential: f64,
        outcome: Outcome,
    ) -> Run {
        let &MotionState { at: end, x, v, circuit, .. } = state;
        let (final_x, final_v) = (x.to_f64(), v.to_f64() / self.unit);
        let electrical = self.electrical(circuit);
        self.sample_the_end(state);
        let (section, carried) = self.listed(&end, MapState { x: final_x, v: final_v, electrical });
        let covered = value(&self.covered);
        let seen = covered > 0.0;
        let ledger = self.ledger.then(|| self.energy_ledger(state, start, potential));
        let rms = (value(&self.settled.squared_velocity) / covered).sqrt() / self.unit;
        let work = value(&self.settled.work);
        let counts = self.counts;
        let compliant = self.model.compliant;
        let moved = self.has_moved();
        let rests = seen && !moved;
        let force = compliant.map(|_| self.peak_contact.to_f64() * self.model.mass / (self.unit * self.unit));
        let pressure = compliant.zip(force).and_then(|(stop, force)| stop.pressure(force));
        let material = compliant.and_then(|stop| stop.material);
        let yields =
            pressure.zip(material).is_some_and(|(pressure, material)| pressure > material.yield_pressure());
        let has_work = self.ledger && seen && work.abs() > 0.0;
        let done = outcome == Outcome::Done;
        let strobed = |number: u64| {
            let cycle = self.origin.cycle + number as i64 * self.period_cycles;
            self.clock.seconds(&Instant { cycle, ..self.origin })
        };
        let (low, high) = (self.low.to_f64(), self.high.to_f64());
        let level = self.model.crossing_level.filter(|_| seen && !self.model.one_well);
        let side = level.and_then(|top| match () {
            () if low == top && high == top => None,
            () if low >= top => Some(Place::Right),
            () if high <= top => Some(Place::Left),
            () => Some(Place::Both),
        });
        let (crossing_periods, release_periods) = self.classifier.periods_with();
        let ramped = |t: f64| self.model.excitation.ramped_amplitude(t);
        let summary = Summary {
            final_x,
            final_v,
            final_electrical: electrical,
            rms_velocity: (seen && rms.is_finite()).then_some(rms),
            regime: self.regime(moved),
            crossings: counts.crossings,
            impacts: counts.impacts,
            impact_speed_max: (counts.impacts > 0).then(|| self.impact_speed.to_f64() / self.unit),
            releases: counts.releases,
            max_abs_x: seen.then(|| high.abs().max(low.abs())),
            range: seen.then_some((low, high)),
            mean_x: (self.ledger && seen).then(|| value(&self.settled.displacement) / covered),
            side,
            window: self.window_seconds(&end),
            periods: self.periods,
            crossing_periods,
            release_periods,
            settled: self.classifier.settled(rests).map(|settled| settled && done),
            steady: self.classifier.steady(rests).filter(|_| done),
            settles_at: self.classifier.settles_at(strobed).filter(|_| done),
            firsts: self.classifier.firsts(self.in_periods(&end), ramped),
            impact_share: has_work.then(|| value(&self.settled.impact) / work),
            rested_share: seen.then(|| value(&self.settled.rested) / covered),
            total_crossings: counts.total_crossings,
            total_impacts: counts.total_impacts,
            chatter_sums: counts.sums,
            rests: counts.rests,
            period: self.classifier.period().filter(|_| done && moved),
            peak_contact_force: force,
            peak_contact_pressure: pressure,
            contact_yields: yields,
            harvest: self.harvest(seen, covered, has_work.then_some(work)),
            outcome,
            steps: 0,
            evaluations: 0,
            cpu_s: 0.0,
            ledger,
        };
        Run { samples: self.samples, events: self.events.unwrap_or_default(), section, carried, summary }
    }

    /// Whether the mass has moved in the settled window.
    pub fn has_moved(&self) -> bool {
        let (counts, covered) = (self.counts, value(&self.covered));
        let has_events = counts.crossings + counts.impacts + counts.releases > 0;
        // A mass pressed onto a compliant stop during the whole window oscillates there without leaving it.
        let pressed = self.model.compliant.is_some() && value(&self.settled.rested) == covered;
        let travel = (self.high - self.low).to_f64();
        covered > 0.0 && (has_events || (travel > MAX_ROUNDING * self.model.scales.length && !pressed))
    }

    /// Records the samples requested at the very end (to rounding), which are the final state.
    fn sample_the_end(&mut self, state: &MotionState<T>) {
        let last = self.clock.seconds(&state.at);
        while let Some(t) = self.times.get(self.next_time).copied() {
            if t > last * (1.0 + 4.0 * f64::EPSILON) {
                break;
            }
            self.samples.push(Sample {
                t,
                x: state.x.to_f64(),
                v: state.v.to_f64() / self.unit,
                base_accel: self.base(&self.clock.at(t), state.segment),
                phase: state.phase(),
                electrical: self.electrical(state.circuit),
            });
            self.next_time += 1;
        }
    }

    /// Joules in the square of a speed of 1, kernel units, times the mass.
    fn energy_unit(&self) -> f64 {
        self.model.mass / (self.unit * self.unit)
    }

    /// The energies of the whole run, and their residual.
    fn energy_ledger(&self, state: &MotionState<T>, start: &Start<T>, potential: f64) -> Ledger {
        let (energy, transducer) = (self.energy_unit(), self.model.transducer);
        let kinetic = |v: T| (v * v).to_f64() * 0.5;
        let work_j = value(&self.whole.work) * energy;
        let damping_j = self.model.damping * value(&self.whole.squared_velocity) / self.unit;
        let impact_j = value(&self.whole.impact) * energy;
        let charged = transducer.map_or(0.0, |_| kinetic(state.circuit) - kinetic(start.circuit));
        let stored_j = (kinetic(state.v) - kinetic(start.v) + charged) * energy + potential;
        let (taken, moved) = ((work_j - damping_j) - impact_j, self.work_moved + self.peak_kinetic);
        let moved = moved * energy + damping_j + impact_j.abs() + stored_j.abs();
        let electrical = transducer.map(|transducer| transducer.energies(self.squared_signal(&self.whole)));
        let (harvested_j, coil_j) = electrical.unzip();
        let (residual_j, moved) = match electrical {
            Some((load, coil)) => ((taken - load - coil) - stored_j, moved + load + coil),
            None => (taken - stored_j, moved),
        };
        let energy_residual = match residual_j.abs() / moved {
            _ if moved == 0.0 => 0.0,
            share if share.is_finite() => share,
            _ => f64::INFINITY, // the run blew up
        };
        Ledger { work_j, damping_j, impact_j, harvested_j, coil_j, stored_j, residual_j, energy_residual }
    }

    /// Output of the transducer in the settled window. `covered` is the recorded time of the window, `work`
    /// that of the base in it if known and not 0; both in kernel units.
    fn harvest(&self, seen: bool, covered: f64, work: Option<f64>) -> Option<Harvest> {
        let transducer = self.model.transducer?;
        let load = transducer.energies(self.squared_signal(&self.settled)).0;
        let load_share = work.map(|work| load / (work * self.energy_unit()));
        let squared = Some(self.squared_signal(&self.settled) / (covered * self.unit));
        let squared = squared.filter(|squared| seen && squared.is_finite());
        Some(Harvest {
            mean_load_power: squared.map(|squared| transducer.energies(squared).0),
            mean_coil_power: squared.map(|squared| transducer.energies(squared).1),
            voltage_rms: squared.map(|squared| transducer.voltage_rms(squared.sqrt())),
            load_share,
        })
    }

    /// The regime of a motion that has `moved` in the settled window or not.
    fn regime(&self, moved: bool) -> Regime {
        if self.model.one_well {
            Regime::OneWell
        } else if !moved {
            Regime::Rest
        } else if self.counts.crossings == 0 {
            Regime::Intrawell
        } else if self.model.rhythm != Rhythm::Periodic {
            Regime::Crossing
        } else if self.classifier.crossings_repeat() {
            Regime::Interwell
        } else {
            Regime::Irregular
        }
    }

    /// Integral over time in s of the squared signal of the transducer, SI.
    fn squared_signal(&self, sums: &Sums<T>) -> f64 {
        let squared = match self.model.circuit() {
            Some(circuit) => circuit.amount * circuit.amount * value(&sums.circuit),
            None => value(&sums.squared_velocity),
        };
        squared / self.unit
    }
}
