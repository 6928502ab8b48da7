//! Measured records: reading, comparison with a run, and what is identified from them.

mod reading;
