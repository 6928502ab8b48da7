//! Flexures: the solved force curve against exact answers, a second method, laws that it must obey, and what
//! it promises.

mod agreement;
mod exact;
mod extremes;
mod laws;
mod promises;
mod prototype;
mod random;
mod strong_form;
mod sweeps;
mod verdict;

use interwell::mechanics::flexure::{Flexures, Geometry, Group, State};
use interwell::mechanics::{ForceCurve, Mechanism};

use crate::support::{near, near_relative};

/// The prototype of the presets.
fn prototype() -> Geometry {
    Geometry {
        preload: 2.7e-3,
        thickness: 1e-4,
        young: 190e9,
        poisson: 0.34,
        plane_strain: false,
        initial_bow: 0.0,
        yield_stress: 2e9,
        parallel: Group { count: 2, length: 26e-3, width: 20e-3 },
        buckling: Group { count: 1, length: 27.7e-3, width: 6.8e-3 },
    }
}

/// The prototype with every length `scale` times as long, of a material as soft as may be.
fn scaled(scale: f64) -> Geometry {
    let group = |g: Group| Group { count: g.count, length: scale * g.length, width: scale * g.width };
    let p = prototype();
    Geometry {
        preload: scale * p.preload,
        thickness: scale * p.thickness,
        young: 1e-60,
        parallel: group(p.parallel),
        buckling: group(p.buckling),
        ..p
    }
}

#[track_caller]
fn solve(geometry: &Geometry) -> (ForceCurve, Flexures) {
    Flexures::solve(geometry, 1e-8).unwrap_or_else(|e| panic!("{e}\n{geometry:?}"))
}
