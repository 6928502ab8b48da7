//! Transducer of a scene in SI: its effect on the motion, and its output.
//!
//! Voltage, current and powers follow from one signal. Without an electrical state the signal is the
//! velocity: a coil without inductance is exactly a damping k^2/(coil + load). Otherwise it is the state: the
//! current in the coil or the voltage of the piezoelectric layer.

use crate::numeric::short;
use crate::scene;

/// A transducer prepared for a run. SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Transducer {
    /// The transducer as given in the scene.
    pub described: scene::Transducer,
    /// Damping coefficient in N s/m that it adds.
    pub damping: f64,
    /// The circuit, if it has a state that is integrated with the motion.
    pub circuit: Option<Circuit>,
    /// Voltage over the load per signal.
    voltage: f64,
    /// Current through the load per signal.
    current: f64,
    /// Power into the load per squared signal.
    load: f64,
    /// Power lost in the coil per squared signal.
    coil: f64,
}

/// A circuit: with its state s, in A or V, and w = s/amount in m/s, x'' = .. - coupling w and w' = coupling
/// x' - decay w.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Circuit {
    /// In 1/s.
    pub coupling: f64,
    /// In 1/s.
    pub decay: f64,
    /// State at w = 1 m/s, whose energy is that of the mass at this speed.
    pub amount: f64,
    pub is_voltage: bool,
}

/// The kind of a circuit's electrical state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CircuitState {
    /// The current in the coil in A.
    Current,
    /// The voltage of the piezoelectric layer in V.
    Voltage,
}

impl Circuit {
    /// From a coupling in N/A or N/V, a storage in H or F, and its decay in 1/s.
    fn new(coupling: f64, storage: f64, decay: f64, mass: f64, is_voltage: bool) -> Self {
        let amount = (mass / storage).sqrt();
        Self { coupling: coupling * amount / mass, decay, amount, is_voltage }
    }

    /// The state as a speed in m/s.
    pub fn state(&self, electrical: f64) -> f64 {
        electrical / self.amount
    }

    fn is_finite(&self) -> bool {
        let numbers = [self.coupling * self.coupling, self.decay, self.amount * self.amount];
        numbers.into_iter().all(f64::is_finite) && self.amount > 0.0
    }
}

/// Multiple of the motion's rate above which a circuit is fast.
const FAST_RATIO: f64 = 100.0;

/// Relative error of the motion up to which a fast circuit may be left out.
const NEGLIGIBLE_SHARE: f64 = 1e-2;

/// Share by which a coil damps the motion in a time scale, below which the coil counts as an open circuit.
const OPEN_CIRCUIT_SHARE: f64 = 1e-9;

/// Output of a transducer at an instant; [`Model::output`](crate::dynamics::Model::output) gives that of a
/// sample.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Output {
    /// Voltage over the load in V.
    pub voltage: f64,
    /// Current through the load in A.
    pub current: f64,
    /// Power into the load in W.
    pub power: f64,
}

impl Transducer {
    /// The transducer of a scene with a mass in kg; `None` if it has none.
    pub fn of(transducer: &scene::Transducer, mass: f64) -> Option<Self> {
        use scene::Transducer::{Electromagnetic, Piezoelectric};
        let zero = Self {
            described: *transducer,
            damping: 0.0,
            circuit: None,
            voltage: 0.0,
            current: 0.0,
            load: 0.0,
            coil: 0.0,
        };
        Some(match *transducer {
            scene::Transducer::None => return None,
            Electromagnetic { coupling_v_s_per_m, load_ohm, .. } if load_ohm.is_infinite() => {
                Self { voltage: coupling_v_s_per_m, ..zero }
            }
            Electromagnetic { coupling_v_s_per_m, coil_ohm, load_ohm, inductance_mh } => {
                let (resistance, inductance) = (coil_ohm + load_ohm, inductance_mh / 1e3);
                // per unit current: the current is the signal or is proportional to it
                let (gain, damping, circuit) = if transducer.has_state() {
                    let (k, decay) = (coupling_v_s_per_m, resistance / inductance);
                    (1.0, 0.0, Some(Circuit::new(k, inductance, decay, mass, false)))
                } else {
                    let gain = coupling_v_s_per_m / resistance;
                    (gain, coupling_v_s_per_m * gain, None)
                };
                Self {
                    damping,
                    circuit,
                    voltage: load_ohm * gain,
                    current: gain,
                    load: load_ohm * gain * gain,
                    coil: coil_ohm * gain * gain,
                    ..zero
                }
            }
            Piezoelectric { coupling_n_per_v, load_kohm: 0.0, .. } => {
                Self { current: coupling_n_per_v, ..zero }
            }
            Piezoelectric { coupling_n_per_v, capacitance_nf, load_kohm } => {
                let (conductance, capacitance) = (1.0 / (load_kohm * 1e3), capacitance_nf / 1e9);
                let decay = conductance / capacitance;
                let circuit = Some(Circuit::new(coupling_n_per_v, capacitance, decay, mass, true));
                Self { circuit, voltage: 1.0, current: conductance, load: conductance, ..zero }
            }
        })
    }

    /// Whether all its numbers are finite, so that a motion can be computed with it.
    pub fn is_finite(&self) -> bool {
        let numbers = [self.damping, self.voltage, self.current, self.load, self.coil];
        numbers.into_iter().all(f64::is_finite) && self.circuit.is_none_or(|circuit| circuit.is_finite())
    }

    /// Output at a velocity in m/s and an electrical state in A or V.
    pub fn output(&self, v: f64, electrical: f64) -> Output {
        let signal = if self.circuit.is_some() { electrical } else { v };
        let power = self.load * signal * signal;
        Output { voltage: self.voltage * signal, current: self.current * signal, power }
    }

    /// Energies in J into the load and lost in the coil, from the time integral of the squared signal; from
    /// its mean, the mean powers in W.
    pub fn energies(&self, squared: f64) -> (f64, f64) {
        (self.load * squared, self.coil * squared)
    }

    /// Root mean square of the voltage over the load in V, from that of the signal.
    pub fn voltage_rms(&self, signal: f64) -> f64 {
        self.voltage.abs() * signal
    }

    /// The state of this transducer if it takes over from `before` in the state `electrical`: a current
    /// continues as a current and a voltage as a voltage.
    pub fn electrical_after(&self, before: &Self, electrical: f64) -> f64 {
        match (&self.circuit, &before.circuit) {
            (Some(circuit), Some(previous)) if circuit.is_voltage == previous.is_voltage => electrical,
            _ => 0.0,
        }
    }

    /// Explains why a circuit that is far faster than a motion of this time scale in s makes the steps short,
    /// and how to model the scene without it; `None` for a slower circuit. `mass` in kg.
    pub fn fast_circuit(&self, mass: f64, time: f64) -> Option<String> {
        let circuit = self.circuit.as_ref()?;
        let (coupling, decay) = (circuit.coupling.abs(), circuit.decay);
        if !(coupling.max(decay) * time > FAST_RATIO) {
            return None;
        }
        // the error of leaving out the state: its lag, and the mass that it adds or removes
        let apart = (1.0 / (decay * time)).max((coupling / decay).powi(2));
        if !(apart < NEGLIGIBLE_SHARE) {
            let storage = if circuit.is_voltage { "capacitance_nf" } else { "inductance_mh" };
            return Some(format!(
                "mass and circuit exchange their energy in {} s, and a step covers only a few such times; a \
                 larger {storage} or a weaker coupling makes that slower",
                short(1.0 / coupling)
            ));
        }
        let alternative = if circuit.is_voltage {
            let (load, force) = (1.0 / self.current, coupling * mass / circuit.amount);
            let [coupling, load] = [force * load, load].map(short);
            format!(
                "transducer=Electromagnetic(coupling_v_s_per_m: {coupling}, coil_ohm: 0, load_ohm: {load}) \
                 gives the same voltage, current and power without an electrical state"
            )
        } else if coupling * coupling / decay * time < OPEN_CIRCUIT_SHARE {
            "load_ohm: inf is the open circuit that this is".to_owned()
        } else {
            "without inductance_mh the coil is a damping".to_owned()
        };
        let constant = short(1.0 / decay);
        Some(format!(
            "the circuit's time constant is {constant} s, and a step covers only a few time constants; \
             {alternative}, to a relative error of about {apart:.0e}"
        ))
    }

    /// Description in words, for `check`.
    pub fn describe(&self) -> String {
        let Some(circuit) = &self.circuit else {
            let [c, v, a] = [self.damping, self.voltage, self.current].map(short);
            return format!(
                "transducer: a damping of {c} N s/m; {v} V over the load and {a} A through it at 1 m/s"
            );
        };
        let state = if circuit.is_voltage { "a voltage" } else { "a current" };
        format!(
            "transducer: {state} with a time constant of {} s beside the motion",
            short(1.0 / circuit.decay)
        )
    }
}
