//! Built-in scenes with fields changed, as documents and as models: for both test binaries and the benches.

// Each of them uses its part.
#![allow(dead_code)]

use std::sync::{Arc, OnceLock};

use interwell::dynamics::Model;
use interwell::mechanics::Mechanism;
use interwell::scene::{self, Document, SweepAxis};

/// A built-in scene with fields changed, each as `FIELD=VALUE`.
pub fn changed(name: &str, changes: &[&str]) -> Document {
    let mut document = Document::load(name).unwrap();
    for change in changes {
        document.set(change).unwrap();
    }
    document
}

/// The model of a built-in scene with fields changed.
pub fn preset(name: &str, changes: &[&str]) -> Model {
    build(&changed(name, changes))
}

/// The model of a document that must be without faults.
pub fn build(document: &Document) -> Model {
    document.check().unwrap();
    Model::build(&document.scene, mechanism(document)).unwrap()
}

/// The mechanism of a document that must be without faults. The prototype's flexures are solved once by a
/// program that includes this, by whoever comes first: tests make hundreds of models of them.
pub fn mechanism(document: &Document) -> Arc<Mechanism> {
    static PROTOTYPE: OnceLock<(scene::Mechanism, Arc<Mechanism>)> = OnceLock::new();
    let solved =
        |document: &Document| Arc::new(Mechanism::build(&document.scene.mechanism, &document.files).unwrap());
    let (described, prototype) = PROTOTYPE.get_or_init(|| {
        let paper = Document::load("paper").unwrap();
        (paper.scene.mechanism.clone(), solved(&paper))
    });
    if document.scene.mechanism == *described { prototype.clone() } else { solved(document) }
}

/// An axis of a map over `field`.
pub fn axis(field: &str, (from, to, step): (f64, f64, f64)) -> SweepAxis {
    SweepAxis { field: field.to_owned(), from, to, step, values: Vec::new() }
}
