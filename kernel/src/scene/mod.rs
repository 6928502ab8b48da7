//! Scenes: their fields, checks and files, and the presets.
//!
//! A [`Scene`] is what a person writes: mass, [`Mechanism`], damping, [`Stops`], [`Transducer`], excitation,
//! start and run. A [`Document`] is a scene with its text, the changes to it and the files that it names. An
//! [`Axis`] is a field with the values that it takes in a sweep; [`read_measured`] and [`read_record`] read
//! measured data. [`PRESETS`] lists the built-in scenes.
//!
//! # Units
//!
//! Every number has its unit in the name of its field (`mass_g`, `travel_limit_mm`, `amplitude_g` in units of
//! [`STANDARD_GRAVITY`]) and a range in [`FIELDS`]. `docs/scene.md` of the repository describes the file.
//!
//! # Errors
//!
//! A [`SceneError`] has all faults of a scene at once, each a [`Fault`] with field, value, problem
//! and remedy, and the line where the value is written.
//!
//! A scene is read by [`Document::load`], changed by [`Document::set`] and checked by [`Document::check`]. A
//! scene that passes becomes a `dynamics::Model`, which is always valid. [`Document::error_from`] adds file
//! and line to faults that only the model can find.
//!
//! # Example
//!
//! ```
//! # use interwell_kernel as interwell;
//! use interwell::scene::Document;
//!
//! let mut document = Document::load("paper")?;
//! document.set("stops.travel_limit_mm=2")?;
//! assert_eq!(document.check()?, Vec::<String>::new());
//! document.set("stops.restitution=1.2")?;
//! let error = document.check().unwrap_err().to_string();
//! assert!(error.contains("stops.restitution = 1.2: must be 0 to 1"), "{error}");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod arguments;
mod arithmetic;
mod axis;
mod check;
mod columns;
mod data;
mod document;
mod error;
mod field_table;
mod fields;
mod files;
mod harmonic;
#[doc(hidden)]
pub mod lesson;
mod link;
mod manifest;
mod measured;
mod mechanism;
mod names;
mod periodic;
mod pieces;
mod presets;
mod record;
mod scanner;
mod shape;
mod stops;
mod text;
mod timing;
mod transducer;
mod unit;
mod walk;
mod written;

pub use arguments::arguments;
pub use arithmetic::read_number;
pub use axis::{Axis, MAX_AXES, MAX_AXIS_VALUES, column_names};
pub(crate) use check::is_sound;
pub use check::{Checked, check, corners};
pub use columns::{Columns, ColumnsError, MAX_ROWS, read_columns};
pub use data::*;
pub use document::{Document, Source, is_scene_file, named_paths, named_texts, read_records};
pub use error::{ArgumentError, Fault, Origin, PlacedFault, SceneError};
pub use field_table::{
    Control, FIELDS, FieldInfo, MAX_COEFFICIENTS, Range, Scale, TOLERANCES, field_info, without_indices,
};
pub use fields::{FieldPath, all_fields, is_whole, numeric_fields};
pub use files::{FileError, Files, MAX_TABLE_BYTES};
pub use harmonic::{Amplitude, Harmonic};
pub use link::{LinkError, is_link, linked_lesson};
pub use manifest::{PROGRAM, SweepRequest, Uncertain, is_manifest};
pub use measured::{
    Channel, ChosenColumn, ColumnOptions, ColumnRequest, MAX_MEASURED_BYTES, MAX_MEASURED_ROWS, Measured,
    MeasuredError, MeasuredText, read_measured,
};
pub use mechanism::{FlexureGroup, ForcePiece, Mechanism, Moments};
pub use names::find_name;
pub use periodic::{DriveError, PeriodicDrive};
pub use presets::{EmbeddedTable, PRESETS, Preset, TABLES, export};
pub use record::{Record, read_record};
pub use scanner::{Place, Places, has_comments};
pub use stops::Stops;
pub use text::{MAX_SCENE_BYTES, write};
pub use timing::Timing;
pub use transducer::Transducer;
pub use unit::{Quantity, STANDARD_GRAVITY, Unit, unit_ending};
