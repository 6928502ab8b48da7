//! Builders of the scenes of the cases.

use std::fmt::Display;
use std::sync::Arc;

use crate::dynamics::{Model, STANDARD_GRAVITY};
use crate::mechanics::{ForceCurve, Mechanism as Built};
use crate::scene::{
    Damping, Document, Excitation, Fault, Files, Mechanism, RunSettings, Scene, Start, Stops, Transducer,
};

/// Every case runs at the tightest tolerance, so that only rounding is left.
pub(super) const TOLERANCE: f64 = 1e-14;

/// Why the study has no result.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum Stopped {
    /// It was cancelled.
    #[error("cancelled")]
    Cancelled,
    /// A scene of the study cannot be run: a fault of the program.
    #[error("a scene of the study cannot be run: {0}")]
    Scene(String),
}

/// A scene under construction, and the force curve that replaces that of its mechanism.
#[derive(Debug, Clone)]
pub(super) struct Setup {
    pub scene: Scene,
    curve: Option<ForceCurve>,
}

impl Setup {
    /// 1 kg at `x` in m with `v` in m/s, without damping, stops or drive; all of the run is judged.
    pub fn new(mechanism: Mechanism, (x, v): (f64, f64), duration_s: f64) -> Self {
        Self {
            scene: Scene {
                title: "accuracy".to_owned(),
                notes: String::new(),
                mass_g: 1000.0,
                mechanism,
                damping: Damping::None,
                stops: Stops::None,
                transducer: Transducer::None,
                excitation: Excitation::None,
                start: Start::At { x_mm: x * 1e3, v_m_per_s: v, electrical: 0.0 },
                run: RunSettings { duration_s, settle_s: Some(0.0), tolerance: TOLERANCE, recurrence: false },
                sweep: Vec::new(),
                app: None,
            },
            curve: None,
        }
    }

    /// The cubic of the prototype's size (wells at 7 mm, 15.2 g, ratio 0.023) between stops, from rest.
    pub fn nominal(limit_mm: f64, restitution: f64, excitation: Excitation, duration_s: f64) -> Self {
        let cubic = Mechanism::Cubic { linear_n_per_m: -40.0, cubic_n_per_m3: 40.0 / 49e-6 };
        let mut setup = Self::new(cubic, (0.0, 0.0), duration_s);
        setup.scene.mass_g = 15.2;
        setup.scene.damping = Damping::Ratio(0.023);
        setup.scene.start = Start::Rest;
        setup.stops(rigid(limit_mm, restitution)).drive(excitation)
    }

    /// A built-in scene at the tightest tolerance, with fields changed, each as `FIELD=VALUE`.
    pub fn preset(name: &str, changes: &[&str]) -> Result<Self, Stopped> {
        let mut document = Document::load(name).map_err(invalid)?;
        for change in changes {
            document.set(change).map_err(invalid)?;
        }
        document.scene.run.tolerance = TOLERANCE;
        // the integrator is measured, not the recurrence
        document.scene.run.recurrence = false;
        document.scene.sweep.clear();
        Ok(Self { scene: document.scene, curve: None })
    }

    pub fn stops(mut self, stops: Stops) -> Self {
        self.scene.stops = stops;
        self
    }

    pub fn drive(mut self, excitation: Excitation) -> Self {
        self.scene.excitation = excitation;
        self
    }

    pub fn damping(mut self, c_n_s_per_m: f64) -> Self {
        self.scene.damping = Damping::Coefficient { c_n_s_per_m };
        self
    }

    pub fn start(mut self, x: f64, v: f64) -> Self {
        self.scene.start = Start::At { x_mm: x * 1e3, v_m_per_s: v, electrical: 0.0 };
        self
    }

    /// With a transducer whose electrical state in A or V is this at the start.
    pub fn beside(mut self, transducer: Transducer, state: f64) -> Self {
        self.scene.transducer = transducer;
        if let Start::At { electrical, .. } = &mut self.scene.start {
            *electrical = state;
        }
        self
    }

    /// Replaces the force of the scene's mechanism by `curve`.
    pub fn on(mut self, curve: ForceCurve) -> Self {
        self.curve = Some(curve);
        self
    }

    /// The scene as run.
    pub fn model(&self) -> Result<Model, Stopped> {
        let mechanism = match &self.curve {
            Some(curve) => Built::new(curve.clone()),
            None => Built::build(&self.scene.mechanism, &Files::default()).map_err(invalid)?,
        };
        Model::build(&self.scene, Arc::new(mechanism)).map_err(|faults| {
            let text = |fault: &Fault| format!("{} = {}: {}", fault.field, fault.value, fault.problem);
            Stopped::Scene(faults.first().map_or_else(String::new, text))
        })
    }
}

fn invalid(error: impl Display) -> Stopped {
    Stopped::Scene(error.to_string())
}

pub(super) fn polynomial(coefficients_si: &[f64]) -> Mechanism {
    Mechanism::Polynomial { coefficients_si: coefficients_si.to_vec() }
}

/// m = 1 kg, F = x^3 - x.
pub(super) fn unit_well() -> Mechanism {
    Mechanism::Cubic { linear_n_per_m: -1.0, cubic_n_per_m3: 1.0 }
}

pub(super) fn rigid(travel_limit_mm: f64, restitution: f64) -> Stops {
    Stops::Rigid { travel_limit_mm, restitution }
}

/// Stops of one restitution at these distances from x = 0.
pub(super) fn stops_at(left_mm: Option<f64>, right_mm: Option<f64>, restitution: f64) -> Stops {
    let of = |limit: Option<f64>| limit.map(|_| restitution);
    Stops::Uneven { left_mm, right_mm, restitution_left: of(left_mm), restitution_right: of(right_mm) }
}

/// A coil of this coupling in V s/m, resistance in ohm, load and all, and inductance in H.
pub(super) fn coil(coupling: f64, resistance: f64, inductance: f64) -> Transducer {
    Transducer::Electromagnetic {
        coupling_v_s_per_m: coupling,
        coil_ohm: 0.0,
        load_ohm: resistance,
        inductance_mh: inductance * 1e3,
    }
}

/// A piezoelectric layer of this coupling in N/V and capacitance in F beside a load in ohm.
pub(super) fn layer(coupling: f64, capacitance: f64, load: f64) -> Transducer {
    Transducer::Piezoelectric {
        coupling_n_per_v: coupling,
        capacitance_nf: capacitance * 1e9,
        load_kohm: load / 1e3,
    }
}

/// A sine of an amplitude in m/s^2.
pub(super) fn sine(frequency_hz: f64, amplitude: f64, phase_deg: f64) -> Excitation {
    Excitation::Sine { frequency_hz, amplitude_g: amplitude / STANDARD_GRAVITY, phase_deg }
}

/// A constant acceleration in m/s^2.
pub(super) fn constant(acceleration: f64) -> Excitation {
    Excitation::Constant { accel_g: acceleration / STANDARD_GRAVITY }
}
