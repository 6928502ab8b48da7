//! The scale of the colours beside a map.

use std::ops::RangeInclusive;

use eframe::egui::{Rect, Sense, TextStyle, Ui, UiBuilder, vec2};
use egui_plot::{AxisHints, GridInput, GridMark, HPlacement, Plot, PlotBounds};

use crate::app::ui::style::Style;
use crate::output::{Colours, Marks, Panel, PlotAxis, Role, Shade, Shades};
use interwell_studies::study::Edges;

use super::super::layer::LayerItem;
use super::super::plot::{LEAST, UPRIGHT, name_within};

/// Number of steps of the scale.
const STEPS: usize = 128;

/// The colours along an axis, over its shares from 0 to 1.
pub fn scale_of(axis: &PlotAxis, colours: &Colours) -> Panel {
    let shares: Vec<f64> = (0..STEPS).map(|i| (i as f64 + 0.5) / STEPS as f64).collect();
    let is_signed = matches!(colours, Colours::Signed(_));
    let value = |share: &f64| if is_signed { axis.low + share * (axis.high - axis.low) } else { *share };
    let ticks = axis.ticks.iter().map(|(value, words)| (axis.share(*value), words.clone())).collect();
    let mut panel =
        Panel::new(PlotAxis::given(0.0, 1.0, Vec::new(), ""), PlotAxis::given(0.0, 1.0, ticks, &axis.label));
    panel.draw(
        Role::Motion,
        Marks::Cells(Shades {
            across: Edges { values: vec![0.5], edges: vec![0.0, 1.0] },
            up: Edges::new(&shares),
            cells: shares.iter().map(|share| Shade::Value(value(share))).collect(),
            colours: if is_signed {
                colours.clone()
            } else {
                Colours::Scale(PlotAxis::between(0.0, 1.0, ""))
            },
            missing: String::new(),
        }),
    );
    panel
}

/// Draws a scale of colours in `frame`, with its numbers at the right.
pub fn scale_ui(ui: &mut Ui, style: &Style, frame: Rect, scale: &Panel) {
    let words = |mark: GridMark, _: &RangeInclusive<f64>| {
        let near = |tick: &&(f64, String)| (tick.0 - mark.value).abs() < 1e-9;
        scale.y.ticks.iter().find(near).map_or_else(String::new, |tick| tick.1.clone())
    };
    let ticks = |_: GridInput| {
        let apart = LEAST / frame.height() * scale.y.ticks.len() as f32;
        let ticks = scale.y.ticks.iter().step_by(apart.ceil().max(1.0) as usize);
        ticks.map(|tick| GridMark { value: tick.0, step_size: 1.0 }).collect()
    };
    let axis = AxisHints::new_y()
        .placement(HPlacement::Right)
        .label(name_within(ui, style, &scale.y, frame.height()))
        .formatter(words);
    let id = ui.scope_id().with("scale");
    let plot = Plot::new("scale")
        .id(id)
        .width(frame.width() + UPRIGHT)
        .height(frame.height())
        .show_axes([false, true])
        .custom_y_axes(vec![axis.min_thickness(UPRIGHT)])
        .y_grid_spacer(ticks)
        .show_grid(false)
        .show_x(false)
        .show_y(false)
        .sense(Sense::hover());
    let area = Rect::from_min_size(frame.min, vec2(frame.width() + UPRIGHT, frame.height()));
    ui.scope_builder(UiBuilder::new().max_rect(area), |ui| {
        ui.style_mut().text_styles.insert(TextStyle::Body, style.small());
        plot.show(ui, |plot| {
            plot.set_plot_bounds(PlotBounds::from_min_max([0.0, 0.0], [1.0, 1.0]));
            for layer in &scale.layers {
                plot.add(LayerItem::new(id.with("colours"), ("", layer), scale, style, false));
            }
        });
    });
}
