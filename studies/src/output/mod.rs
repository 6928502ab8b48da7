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

pub use csv::{csv, csv_table, header, rows};
pub use json::{identified, landscape, summary};
pub use manifest::{Made, Manifest, Provenance, merged_manifest};
pub use plan::{plan, plan_checksum, plan_differences};
pub use plot::{
    Area, Argument, BLACK, Caption, Cell, Cells, Chart, Colours, Column, ComparisonPicture, Cut,
    ExponentPicture, Figure, Format, Frame, INTER, Ink, Layer, Look, MAX_PICTURE_CELLS, Marks, NoPicture,
    Note, OverTime, Overlay, PaintError, Panel, PlotAxis, Projection, RMS, Ranges, Role, Room, RunPanel,
    SectionPicture, Shape, Sheet, SheetError, SheetText, Side, SpectrumQuantity, SurfaceFrame, SweepPicture,
    TICK, Text, Theme, ThresholdPicture, UnknownFormat, View, accuracy_chart, basins_chart, branch_chart,
    can_show, can_show_exponents, can_show_starts, can_show_thresholds, comparison_chart, contact_chart,
    curve_chart, exponents_chart, force_panel, identified_chart, is_fine, measured_chart,
    measured_force_chart, picture_arguments, portrait_panel, quantities, run_chart, section_chart,
    shapes_chart, spectrum_chart, suited_unit, sweep_about, sweep_chart, threshold_chart, viridis, words_of,
};
pub use text::aligned;

pub use crate::numeric::push_number;
pub use crate::system::{OpenError, Sink, is_regular, same_target, write_file};
