//! Scenes: their fields, checks and files, and the presets.
//!
//! A scene is read by [`Document::load`], changed by [`Document::set`], checked by [`Document::check`];
//! what passes is turned into a `dynamics::Model`, which cannot be wrong. Faults that only show there go
//! back through [`Document::error_from`] to get their file and line.
//!
//! ```
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
mod assign;
mod axis;
mod check;
mod clip;
mod columns;
mod data;
mod document;
mod error;
mod fields;
mod files;
pub mod lesson;
mod locate;
mod manifest;
mod measured;
mod mechanism;
mod presets;
mod ranges;
mod record;
mod scanner;
mod shape;
mod steps;
mod stops;
mod text;
mod timing;
mod transducer;
mod unit;
mod walk;

pub use arguments::arguments;
pub use axis::{Axis, LARGEST_AXIS, MOST_AXES, column_names};
pub(crate) use check::is_sound;
pub use check::{Checked, check, corners};
pub use columns::{Columns, ColumnsError, MOST_ROWS, read_columns};
pub use data::*;
pub use document::{Document, Source, is_scene_file, named_paths};
pub use error::{ArgumentError, Fault, Origin, PlacedFault, SceneError};
pub use fields::{FieldPath, all_fields, is_whole, numeric_fields};
pub use files::{FileError, Files, LARGEST_TABLE};
pub use locate::{Place, Places};
pub use manifest::{PROGRAM, Swept, is_manifest};
pub use measured::{
    Ask, Channel, ChosenColumn, LARGEST_MEASURED, MOST_MEASURED, Measured, MeasuredError, MeasuredText,
    read_measured,
};
pub use mechanism::{FlexureGroup, Mechanism};
pub use presets::{EmbeddedTable, PRESETS, Preset, TABLES, export};
pub(crate) use ranges::number_text;
pub use ranges::{MAX_COEFFICIENTS, TOLERANCES};
pub use record::{Record, RecordError, read_record};
pub use scanner::has_comments;
pub use stops::Stops;
pub use text::{LARGEST_SCENE, write};
pub use timing::Timing;
pub use transducer::Transducer;
pub use unit::{Quantity, STANDARD_GRAVITY, Unit};
