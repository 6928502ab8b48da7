//! Mechanisms as scenes describe them: the change to SI, and building that is cancelled.

use std::sync::atomic::AtomicBool;

use interwell::mechanics::Mechanism;
use interwell::mechanics::flexure::{Geometry, Group};
use interwell::scene::{self, Document};

use super::{build, polynomial};

#[test]
fn flexures_enter_in_si() {
    let group = |count, length_mm, width_mm| scene::FlexureGroup { count, length_mm, width_mm };
    let mechanism = build(scene::Mechanism::Flexures {
        preload_mm: 2.7,
        thickness_mm: 0.1,
        young_gpa: 190.0,
        parallel: group(2, 26.0, 20.0),
        buckling: group(1, 27.7, 6.8),
        poisson: 0.34,
        plane_strain: true,
        initial_bow_mm: 0.0,
        yield_gpa: 2.0,
    });
    let expected = Geometry {
        preload: 2.7e-3,
        thickness: 1e-4,
        young: 190e9,
        poisson: 0.34,
        plane_strain: true,
        initial_bow: 0.0,
        yield_stress: 2e9,
        parallel: Group { count: 2, length: 26e-3, width: 20e-3 },
        buckling: Group { count: 1, length: 27.7e-3, width: 6.8e-3 },
    };
    assert_eq!(mechanism.flexures.as_ref().unwrap().geometry(), &expected);
    assert_eq!(polynomial(&[0.0, 1.0]).flexures, None);
}

#[test]
fn building_ends_once_it_is_told_to() {
    for name in ["paper", "paper-table", "nominal-cubic"] {
        let document = Document::load(name).unwrap();
        let build = |told: bool| {
            let cancel = AtomicBool::new(told);
            Mechanism::build_cancellable(&document.scene.mechanism, &document.files, &cancel)
        };
        let whole = Mechanism::build(&document.scene.mechanism, &document.files);
        assert!(build(true).is_none(), "{name}");
        assert_eq!(build(false).unwrap().unwrap().curve, whole.unwrap().curve, "{name}");
    }
}
