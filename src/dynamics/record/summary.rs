//! Summary of a record: statistics, regime and energy ledger.

use super::recorder::Recorder;
use super::sums::Sums;
use crate::dynamics::clock::Instant;
use crate::dynamics::model::excitation::Rhythm;
use crate::dynamics::result::{Harvest, Ledger, Outcome, Phase, Place, Regime, Run, Sample, Summary};
use crate::numeric::{CompensatedSum, Scalar};

/// Share of the length scale below which a motion is rounding: the mass has not moved.
const STILL: f64 = 1e-12;

/// The end of a run, as the recorder needs it.
pub(crate) struct Ending<T> {
    pub at: Instant<T>,
    /// Displacement and velocity, kernel units.
    pub state: (T, T),
    /// Velocity at time 0, kernel units.
    pub start_v: T,
    /// State of the circuit at time 0 and at the end.
    pub circuit: (T, T),
    pub phase: Phase,
    /// Segment of the drive.
    pub segment: usize,
    /// Change of the potential over the run in J.
    pub potential: f64,
    pub outcome: Outcome,
}

impl<T: Scalar> Recorder<'_, T> {
    /// Closes the record.
    pub fn finish(mut self, ending: &Ending<T>) -> Run {
        let &Ending { at: end, state: (x, v), start_v, circuit, phase, segment, potential, outcome } = ending;
        let final_x = x.to_f64();
        let final_v = v.to_f64() / self.unit;
        // A sample requested at the very end (to rounding) is the final state.
        let last = self.clock.seconds(&end);
        while let Some(t) = self.times.get(self.next_time).copied() {
            if t > last * (1.0 + 4.0 * f64::EPSILON) {
                break;
            }
            self.samples.push(Sample {
                t,
                x: final_x,
                v: final_v,
                base_accel: self.base(&self.clock.at(t), segment),
                phase,
                electrical: self.electrical(circuit.1),
            });
            self.next_time += 1;
        }
        self.last_strobe(&end, (x, v));
        let (section, carried) = self.listed(&end, (final_x, final_v));
        let m = self.model.mass;
        let energy = m / (self.unit * self.unit);
        let value = |sum: &CompensatedSum<T>| sum.value().to_f64();
        let covered = value(&self.covered);
        let seen = covered > 0.0;
        let transducer = self.model.transducer;
        let ledger = self.ledger.then(|| {
            let kinetic = |v: T| (v * v).to_f64() * 0.5;
            let work_j = value(&self.whole.work) * energy;
            let damping_j = self.model.damping * value(&self.whole.squared_velocity) / self.unit;
            let impact_j = value(&self.whole.impact) * energy;
            let charged = transducer.map_or(0.0, |_| kinetic(circuit.1) - kinetic(circuit.0));
            let stored_j = (kinetic(v) - kinetic(start_v) + charged) * energy + potential;
            let (taken, moved) = ((work_j - damping_j) - impact_j, self.work_moved + self.peak_kinetic);
            let moved = moved * energy + damping_j + impact_j.abs() + stored_j.abs();
            let electrical =
                transducer.map(|transducer| transducer.energies(self.squared_signal(&self.whole)));
            let (harvested_j, coil_j) =
                (electrical.map(|energies| energies.0), electrical.map(|energies| energies.1));
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
        });
        let rms = (value(&self.settled.squared_velocity) / covered).sqrt() / self.unit;
        let work = value(&self.settled.work);
        let harvest = transducer.map(|transducer| {
            let load = transducer.energies(self.squared_signal(&self.settled)).0;
            let load_share = (self.ledger && seen && work.abs() > 0.0).then(|| load / (work * energy));
            let squared = Some(self.squared_signal(&self.settled) / (covered * self.unit));
            let squared = squared.filter(|squared| seen && squared.is_finite());
            Harvest {
                mean_load_power: squared.map(|squared| transducer.energies(squared).0),
                mean_coil_power: squared.map(|squared| transducer.energies(squared).1),
                voltage_rms: squared.map(|squared| transducer.voltage_rms(squared.sqrt())),
                load_share,
            }
        });
        let travel = (self.high - self.low).to_f64();
        let scales = &self.model.scales;
        let counts = &self.counts;
        let left = counts.crossings + counts.impacts + counts.releases > 0;
        let compliant = self.model.compliant;
        // A mass pressed onto a compliant stop throughout oscillates there but has not left it.
        let pressed = compliant.is_some() && value(&self.settled.rested) == covered;
        let moved = seen && (left || (travel > STILL * scales.length && !pressed));
        let rests = seen && !moved;
        let pressed_by = |force: f64| compliant.and_then(|stop| stop.pressure(force));
        let force = compliant.map(|_| self.peak_contact.to_f64() * m / (self.unit * self.unit));
        let pressure = force.and_then(pressed_by);
        let material = compliant.and_then(|stop| stop.material);
        let yields =
            pressure.zip(material).is_some_and(|(pressure, material)| pressure > material.yield_pressure());
        let impact_share =
            (self.ledger && seen && work.abs() > 0.0).then(|| value(&self.settled.impact) / work);
        let regime = if self.model.one_well {
            Regime::OneWell
        } else if !moved {
            Regime::Rest
        } else if self.counts.crossings == 0 {
            Regime::Intrawell
        } else if self.model.rhythm != Rhythm::Periodic {
            Regime::Crossing
        } else if self.judge.crossings_repeat() {
            Regime::Interwell
        } else {
            Regime::Irregular
        };
        let done = outcome == Outcome::Done;
        let origin = self.origin();
        let strobed = |number: u64| {
            let cycle = origin.cycle + number as i64 * self.period_cycles;
            self.clock.seconds(&Instant { cycle, phase: origin.phase })
        };
        let (low, high) = (self.low.to_f64(), self.high.to_f64());
        let level = self.model.crossing_level.filter(|_| seen && !self.model.one_well);
        let side = level.and_then(|top| match () {
            () if low == top && high == top => None,
            () if low >= top => Some(Place::Right),
            () if high <= top => Some(Place::Left),
            () => Some(Place::Both),
        });
        let (crossing_periods, release_periods) = self.judge.periods_with();
        let ramped = |t: f64| self.model.excitation.ramped_amplitude(t);
        Run {
            samples: std::mem::take(&mut self.samples),
            events: self.events.take().unwrap_or_default(),
            section,
            carried,
            summary: Summary {
                final_x,
                final_v,
                rms_velocity: (seen && rms.is_finite()).then_some(rms),
                regime,
                crossings: self.counts.crossings,
                impacts: self.counts.impacts,
                impact_speed_max: (self.counts.impacts > 0).then(|| self.impact_speed.to_f64() / self.unit),
                releases: self.counts.releases,
                max_abs_x: seen.then(|| high.abs().max(low.abs())),
                range: seen.then_some((low, high)),
                mean_x: (self.ledger && seen).then(|| value(&self.settled.displacement) / covered),
                side,
                window: self.window_seconds(&end),
                periods: self.periods(),
                crossing_periods,
                release_periods,
                settled: self.judge.settled(rests).map(|settled| settled && done),
                steady: self.judge.steady(rests).filter(|_| done),
                settles_at: self.judge.settles_at(strobed).filter(|_| done),
                firsts: self.judge.firsts(self.in_periods(&end), ramped),
                impact_share,
                rested_share: seen.then(|| value(&self.settled.rested) / covered),
                total_crossings: self.counts.total_crossings,
                total_impacts: self.counts.total_impacts,
                chatter_sums: self.counts.sums,
                rests: self.counts.rests,
                period: self.judge.period().filter(|_| done && moved),
                peak_contact_force: force,
                peak_contact_pressure: pressure,
                contact_yields: yields,
                harvest,
                outcome,
                steps: 0,
                evaluations: 0,
                cpu_s: 0.0,
                ledger,
            },
        }
    }

    /// Integral over time in s of the squared signal of the transducer, SI.
    fn squared_signal(&self, sums: &Sums<T>) -> f64 {
        let squared = match self.model.circuit() {
            Some(circuit) => circuit.amount * circuit.amount * sums.circuit.value().to_f64(),
            None => sums.squared_velocity.value().to_f64(),
        };
        squared / self.unit
    }
}
