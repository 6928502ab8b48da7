//! Elements of the plots that have other axes than the displacement.

use eframe::egui::{AsIdSalt, Rect, TextStyle, Ui, UiBuilder, vec2};
use egui_plot::{GridMark, Plot};

use crate::app::ui::style::Style;
use crate::output::PlotAxis;

/// Margin in points between the edge of a view and the name of the vertical axis.
pub const MARGIN: f32 = 6.0;

/// Width in points that every vertical axis takes, so that plots below each other line up.
pub const AXIS_WIDTH: f32 = 58.0;

/// Height in points below which the names of the axes are left out.
pub const LOW: f32 = 150.0;

/// A child of `ui` in which the labels of axes have the style of the views.
pub fn plot_place(ui: &mut Ui, style: &Style, rect: Rect) -> Ui {
    let mut child = ui.new_child(UiBuilder::new().max_rect(rect));
    child.style_mut().text_styles.insert(TextStyle::Body, style.small());
    child.visuals_mut().override_text_color = Some(style.faint());
    child
}

/// A plot with fixed axes and without a grid, since the views draw the grid in their own colours.
pub fn still_plot<'a>(name: impl AsIdSalt) -> Plot<'a> {
    Plot::new(name)
        .allow_drag(false)
        .allow_scroll(false)
        .allow_zoom(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .allow_double_click_reset(false)
        .show_background(false)
        .show_grid(false)
        .y_axis_min_width(AXIS_WIDTH)
        .set_margin_fraction(vec2(0.0, 0.0))
        .x_axis_formatter(|mark, _| plain(mark))
        .y_axis_formatter(|mark, _| plain(mark))
        .label_formatter(|_| None)
        .show_crosshair(false)
}

/// Grid marks at the ticks of an axis.
pub fn marks(axis: &PlotAxis) -> Vec<GridMark> {
    let step_size = axis.ticks.windows(2).next().map_or(1.0, |pair| pair[1].0 - pair[0].0);
    axis.ticks.iter().map(|tick| GridMark { value: tick.0, step_size }).collect()
}

/// An axis with about `count` ticks, and at least three.
pub fn even(low: f64, high: f64, count: f64) -> PlotAxis {
    named(low, high, "", count)
}

/// The same with a name.
pub fn named(low: f64, high: f64, name: &str, count: f64) -> PlotAxis {
    let least = count.clamp(2.0, 10.0) as usize;
    let axis = |count| PlotAxis::between(low, high, name).with_ticks(count);
    (least..least + 6).map(axis).find(|axis| axis.ticks.len() > 2).unwrap_or_else(|| axis(least))
}

/// Label of a tick, with the decimals that distinguish it from the next one.
pub fn plain(mark: GridMark) -> String {
    let decimals = (-(mark.step_size * 1.001).log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", mark.value + 0.0).replace('-', "\u{2212}")
}
