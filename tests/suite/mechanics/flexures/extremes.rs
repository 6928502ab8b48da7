//! Valid geometries at the ends of their ranges: an answer that holds, or an error that says where; never a
//! panic.

use super::verdict::Verdict;
use super::*;
use interwell::mechanics::FlexureError;

/// Solves and verifies; an error must be one that names a place on the way.
fn holds_or_says(geometry: &Geometry) -> Option<FlexureError> {
    match Flexures::solve(geometry, 1e-8) {
        Ok(solved) => {
            let verdict = Verdict::of(geometry, 1e-8, &solved, &[0.03, 0.2, 0.41, 0.63, 0.77, 0.99]);
            assert!(verdict.faults.is_empty(), "{geometry:?}\n{:#?}", verdict.faults);
            None
        }
        Err(e) => {
            let (FlexureError::NotConverged { x, .. }
            | FlexureError::Unstable { x, .. }
            | FlexureError::TooMuchWork { x, .. }) = e;
            assert!(x.is_finite() && x >= 0.0, "{e:?}");
            let preloaded = geometry.preload > 0.0;
            assert_eq!(e.to_string().contains("try a smaller preload or other proportions"), preloaded);
            assert_eq!(e.to_string().contains("try other proportions"), !preloaded);
            Some(e)
        }
    }
}

#[track_caller]
fn holds(geometry: &Geometry) {
    assert_eq!(holds_or_says(geometry), None, "{geometry:?}");
}

#[test]
fn thin() {
    for thickness in [2.6e-6, 1e-6, 1e-7] {
        holds(&Geometry { thickness, ..prototype() });
        holds(&Geometry { thickness, initial_bow: 1e-5, ..prototype() });
    }
    holds(&Geometry { thickness: 2.6e-6, preload: 0.0, ..prototype() });
}

#[test]
fn thick() {
    for preload in [0.0, 1e-4, 1.4e-3, 5e-3] {
        holds(&Geometry { thickness: 2.6e-3, preload, ..prototype() });
    }
}

#[test]
fn many_flexures() {
    for (parallel, buckling) in [(50, 1), (1, 50), (50, 50)] {
        let mut geometry = prototype();
        (geometry.parallel.count, geometry.buckling.count) = (parallel, buckling);
        holds(&geometry);
    }
}

#[test]
fn widths_far_apart_and_nearly_equal() {
    for (parallel, buckling) in [(1e-3, 1.0), (1.0, 1e-3), (20e-3, 20e-3 * (1.0 + 1e-3)), (1.0, 1.0)] {
        let mut geometry = prototype();
        geometry.parallel = Group { count: 1, length: 27.7e-3, width: parallel };
        geometry.buckling = Group { count: 1, length: 27.7e-3, width: buckling };
        holds(&geometry);
    }
}

#[test]
fn lengths_far_apart() {
    for (parallel, buckling) in [(5e-3, 0.1), (0.1, 5e-3)] {
        let mut geometry = Geometry { preload: 1.25e-3, ..prototype() };
        (geometry.parallel.length, geometry.buckling.length) = (parallel, buckling);
        holds(&geometry);
    }
}

/// Beyond a quarter of the shorter flexure nothing is promised but an end.
#[test]
fn preload_up_to_half_the_length() {
    for part in [0.25, 0.3, 0.35, 0.4, 0.45, 0.5] {
        holds_or_says(&Geometry { preload: part * 26e-3, ..prototype() });
        let mut equal = prototype();
        equal.parallel.length = 27.7e-3;
        holds_or_says(&Geometry { preload: part * 27.7e-3, ..equal });
    }
    holds(&Geometry { preload: 6.5e-3, ..prototype() });
}

#[test]
fn no_bulk_or_much() {
    for poisson in [0.0, 0.49, 0.5] {
        holds(&Geometry { poisson, plane_strain: true, ..prototype() });
        holds(&Geometry { poisson, thickness: 2e-3, ..prototype() });
    }
}

#[test]
fn the_largest_bow() {
    for preload in [0.0, 1e-6, 1e-3, 6.5e-3] {
        holds(&Geometry { initial_bow: 27.7e-3 / 20.0, preload, ..prototype() });
    }
}

/// The ends of the range of lengths; nothing has a size of its own.
#[test]
fn absurd_sizes() {
    for scale in [1e-15, 1e-9, 1e9, 1e14] {
        holds(&scaled(scale));
    }
}

/// Groups that buckle under the same load, or nearly: both bulge, and lose their bulges together or one after
/// the other.
#[test]
fn equal_groups() {
    for part in [1e-3, 0.01, 0.1, 0.25] {
        for apart in [0.0, 1e-13, 1e-11, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, -1e-12, -1e-6, -1e-3] {
            for length in [27.7e-3, 20e-3] {
                let mut geometry = prototype();
                geometry.buckling = Group { count: 1, length: 27.7e-3, width: 10e-3 };
                let width =
                    geometry.buckling.width * (length / geometry.buckling.length).powi(2) * (1.0 + apart);
                geometry.parallel = Group { count: 1, length, width };
                holds(&Geometry { preload: part * length, ..geometry });
            }
        }
    }
}
