//! The promises that the fuzz targets try to break: those of the test suite, which holds the small corpus to
//! them.

#[path = "../../tests/suite/untrusted/promises.rs"]
pub mod promises;
