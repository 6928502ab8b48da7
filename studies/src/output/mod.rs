//! Output formats of tables: CSV, JSON, text for a terminal, pictures.
//!
//! Nothing is computed here. A number is written in the shortest form that parses back to the same double, a
//! missing one as an empty cell (CSV) or `null` (JSON).
//!
//! [`csv()`] gives a table as text, [`csv_table`] reads it again; [`summary`] gives the summary of a run as
//! JSON. A picture is made in three steps: one of the functions below makes a [`Chart`] of an answer,
//! [`Chart::figure`] lays it out for a screen or, by a [`Sheet`], for a width on paper in mm, and
//! [`Format::bytes`] makes PNG, SVG or PDF of the [`Figure`]. [`Sink`] writes a file as a whole or not at
//! all. A [`Manifest`] says what made a file, so that it can be made again.
//!
//! Tables are in SI units, as the names of their columns say; axes of pictures have the units of their
//! labels.
//!
//! # Pictures
//!
//! | of the answer of | the chart |
//! | --- | --- |
//! | a run, by itself or with a measured motion over it | [`RunPicture`] |
//! | [`Curve`], its flexures | [`curve_chart`], [`shapes_chart`] |
//! | [`Simulation::compared_force`] | [`measured_force_chart`] |
//! | [`Simulation::impact`] | [`contact_chart`] |
//! | [`Sweep`] | [`sweep_chart`] |
//! | [`Branch`], [`Locus`] | [`branch_chart`], [`loci_chart`] |
//! | [`Spectrum`] | [`spectrum_chart`] |
//! | [`Basins`] | [`basins_chart`] |
//! | [`Compare`], [`Distance`] | [`comparison_chart`], [`distance_chart`] |
//! | [`Best`] | [`best_chart`] |
//! | [`Identify`] | [`identified_chart`] |
//! | [`Accuracy`] | [`scene_accuracy_chart`] |
//!
//! [`mechanism_chart`] draws the mechanism itself, [`well_chart`] the mass in its potential well.
//!
//! [`Curve`]: crate::questions::Curve
//! [`Simulation::impact`]: crate::questions::Simulation::impact
//! [`Simulation::compared_force`]: crate::questions::Simulation::compared_force
//! [`Accuracy`]: crate::questions::Accuracy
//! [`Sweep`]: crate::questions::Sweep
//! [`Branch`]: crate::questions::Branch
//! [`Locus`]: crate::questions::Locus
//! [`Spectrum`]: crate::questions::Spectrum
//! [`Basins`]: crate::questions::Basins
//! [`Compare`]: crate::questions::Compare
//! [`Distance`]: crate::questions::Distance
//! [`Best`]: crate::questions::Best
//! [`Identify`]: crate::questions::Identify
//!
//! # Errors
//!
//! [`NoPicture`], [`SheetError`] and [`StatesError`] say why there is no picture, [`OpenError`] why there is
//! no file.
//!
//! # Example
//!
//! ```
//! # use interwell_studies as interwell;
//! use interwell::output::{Caption, Format, Ranges, Theme, csv, curve_chart};
//! use interwell::questions::{Curve, Simulation};
//!
//! let simulation = Simulation::preset("nominal-cubic")?;
//! let table = Curve { positions: Some(vec![0.0]) }.run(&simulation)?;
//! assert_eq!(csv(&table), "x_m,force_n,potential_j,stiffness_n_per_m\n0,0,0,-40\n");
//!
//! // the force curve between the stops at 4 mm as a picture
//! let table = Curve::default().run(&simulation)?;
//! let chart = curve_chart(&table, simulation.mechanism(), (-4e-3, 4e-3), Ranges::default());
//! let caption = Caption { title: simulation.scene().title.clone(), ..Caption::default() };
//! let figure = chart.figure(&caption, &Theme::LIGHT);
//! assert!(Format::Svg.bytes(&figure).unwrap().starts_with(b"<svg"));
//! # Ok::<(), interwell::questions::Error>(())
//! ```

mod arguments;
mod csv;
mod json;
mod manifest;
mod plan;
mod plot;
mod text;

pub use arguments::{Argument, picture_arguments, repeated};
pub use csv::{csv, csv_table, header, rows};
pub use json::{identified, landscape, summary};
pub use manifest::{Made, Manifest, Provenance, manifest_path, merged_manifest};
pub use plan::{plan, plan_differences};
pub use plot::*;
pub use text::aligned;

pub use crate::numeric::push_number;
pub use crate::system::{OpenError, Sink, is_regular, write_file};
