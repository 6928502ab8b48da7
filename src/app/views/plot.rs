//! Elements of the plots that have other axes than the displacement.

use eframe::egui::{AsIdSalt, Rect, TextStyle, Ui, UiBuilder, vec2};
use egui_plot::{GridMark, Plot};

use crate::app::ui::style::Style;

use super::span::ticks;

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

/// Grid marks at about `count` round numbers.
pub fn marks(low: f64, high: f64, count: f64) -> Vec<GridMark> {
    let (mut values, _) = ticks(low, high, count);
    // at least two, since the axis has no scale with one
    if values.len() < 2 {
        (values, _) = ticks(low, high, 2.0 * count);
    }
    let step_size = values.windows(2).next().map_or(1.0, |pair| (pair[1] - pair[0]) * 1e3);
    values.iter().map(|value| GridMark { value: value * 1e3, step_size }).collect()
}

/// Label of a tick, with the decimals that distinguish it from the next one.
pub fn plain(mark: GridMark) -> String {
    let decimals = (-(mark.step_size * 1.001).log10().floor()).clamp(0.0, 9.0) as usize;
    format!("{:.decimals$}", mark.value + 0.0)
}

/// Grid marks at powers of ten, or at every n-th power so that there are about `count`.
pub fn decades(low: f64, high: f64, count: f64) -> Vec<GridMark> {
    let every = ((high - low) / count).ceil().max(1.0);
    let first = (low / every).ceil() as i32;
    let last = (high / every).floor() as i32;
    (first..=last).map(|i| GridMark { value: f64::from(i) * every, step_size: every }).collect()
}

/// Label of the number with this decimal logarithm.
pub fn power(logarithm: f64) -> String {
    match logarithm.round() as i32 {
        power @ 0..=3 => format!("{}", 10_i32.pow(power as u32)),
        -1 => "0.1".to_owned(),
        -2 => "0.01".to_owned(),
        power => format!("1e{power}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decades_are_whole_and_few() {
        let values =
            |low, high, count| decades(low, high, count).iter().map(|mark| mark.value).collect::<Vec<_>>();
        assert_eq!(values(-3.2, 0.4, 7.0), [-3.0, -2.0, -1.0, 0.0]);
        assert_eq!(values(-5.7, 0.3, 3.0), [-4.0, -2.0, 0.0]);
        assert_eq!([-3.0, -2.0, 0.0, 2.0].map(power), ["1e-3", "0.01", "1", "100"]);
    }
}
