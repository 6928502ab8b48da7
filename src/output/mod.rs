//! Output formats of tables: CSV, JSON, text for a terminal, pictures.
//!
//! Nothing is computed here. A number is written in the shortest form that parses back to the same double, a
//! missing one as an empty cell (CSV) or `null` (JSON).

mod csv;
mod json;
mod manifest;
mod plan;
mod plot;
mod text;

pub use csv::{csv_table, header, rows};
pub use json::{identified, landscape, summary};
pub use manifest::{Made, Provenance, basins_manifest, exponents_manifest, manifest, merged_manifest};
pub use plan::{plan, plan_checksum, plan_differences};
pub use plot::{
    AXIS_EDGES, Argument, BACK_EDGES, BLACK, BoxPlace, Caption, ComparisonPicture, Cut, ExponentPicture,
    Face, Figure, Format, Ink, MAX_PICTURE_CELLS, NoPicture, Overlay, PaintError, Panel, PlotAxis,
    Projection, RMS, Ranges, SIDES, SectionPicture, Sheet, SheetError, SheetText, SpectrumQuantity,
    SweepPicture, Theme, ThresholdPicture, UnknownFormat, View, accuracy_figure, attractor_colour,
    basins_figure, branch_figure, can_show, can_show_exponents, can_show_starts, can_show_thresholds,
    comparison_figure, contact_figure, curve_figure, exponents_figure, identified_figure, measured_figure,
    measured_force_figure, picture_arguments, quantities, run_figure, section_figure, spectrum_figure,
    speed_unit, surface_faces, sweep_about, sweep_figure, threshold_figure, viridis, wall_lines, words_of,
};
pub use text::aligned;

pub use crate::numeric::push_number;
pub use crate::system::{OpenError, Sink, is_regular, same_target, write_file};
