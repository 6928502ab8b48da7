//! Sliders with a number that can be dragged, stepped by keys, or typed.
//!
//! The value changes only by input: passing the focus through the number, or leaving its text as it is,
//! changes no digit.

use std::cell::RefCell;

use eframe::egui::layers::ShapeIdx;
use eframe::egui::{self, Color32, DragValue, Key, Response, RichText, Shape, Slider, Ui, pos2};

use crate::app::words::fields::Reach;
use crate::app::words::numbers::{decimal, decimals, exact, rounded, shown, with_minus};
use crate::scene::read_number;

use super::style::{CONTROL, NARROW_BELOW, NUMBER, Style};
use super::widgets::hover_beside;

/// Height in points of a slider, 2.5 times the radius of its handle.
const SLIDER: f32 = 18.0;
/// Smallest width of a slider in points, beside a long number.
const MIN_SLIDER: f32 = 30.0;

/// Time in s for which the reason of a refusal is shown.
const REFUSAL_TIME: f64 = 8.0;
/// Largest width in points of the reason of a refusal.
const REFUSAL_WIDTH: f32 = 300.0;

/// A slider with its number.
#[derive(Debug, Clone, Copy)]
pub struct Knob<'a> {
    /// Identifies the control, for the reason of a refused input.
    pub id: egui::Id,
    pub name: &'a str,
    /// The unit after the number; empty for a ratio.
    pub unit: &'a str,
    /// The range of the slider; a typed number may lie outside.
    pub reach: Reach,
    /// Smallest and largest number that may be typed.
    pub typed: (f64, f64),
    /// The effect of an increase.
    pub hover: &'a str,
    /// Width of the slider in points.
    pub width: f32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum How {
    /// At once: typed, or set by a screen reader.
    #[default]
    Once,
    /// By a press of an arrow key, which more may follow.
    Pressed,
    Dragged,
}

/// An input on a knob.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Turn {
    /// The new value, if it changed.
    pub value: Option<f64>,
    pub how: How,
    pub ended: bool,
}

impl Knob<'_> {
    pub fn ui(&self, ui: &mut Ui, value: f64) -> Turn {
        let decimals = decimals(self.reach.step);
        // read first, since the widgets consume the arrow keys
        let pressed = ui.input(|input| {
            let arrows = [Key::ArrowLeft, Key::ArrowRight, Key::ArrowUp, Key::ArrowDown];
            arrows.iter().any(|key| input.key_pressed(*key))
        });
        let name = hover_beside(ui.label(self.name), self.hover);
        let mut turned = value;
        let (slider, field, typed) = ui
            .horizontal(|ui| {
                let slider = ui.scope(|ui| self.slider_ui(ui, &mut turned, decimals)).inner;
                let slider = slider.labelled_by(name.id);
                let slid = turned;
                let (field, typed) = self.number_ui(ui, &mut turned, (decimals, NUMBER));
                if slid != value {
                    turned = slid;
                }
                (slider, field.labelled_by(name.id), typed)
            })
            .inner;
        let how = match (slider.dragged() || field.dragged(), pressed) {
            (true, _) => How::Dragged,
            (_, true) if !typed => How::Pressed,
            _ => How::Once,
        };
        let ended = slider.drag_stopped() || field.drag_stopped();
        let response = hover_beside(slider.union(field), self.hover);
        let changed = turned != value && !turned.is_nan();
        if changed {
            clear_refusal(ui);
        }
        refusal_ui(ui, self.id, &response);
        Turn { value: changed.then_some(turned), how, ended }
    }

    /// Draws the number alone, without a slider. Returns the new number if one was typed or dragged to.
    pub fn alone_ui(&self, ui: &mut Ui, value: f64) -> Option<f64> {
        let mut turned = value;
        let (field, _) = self.number_ui(ui, &mut turned, (0, 0.0));
        ui.ctx().accesskit_node_builder(field.id, |node| node.set_label(self.name));
        refusal_ui(ui, self.id, &field);
        let changed = turned != value && !turned.is_nan();
        if changed {
            clear_refusal(ui);
        }
        changed.then_some(turned)
    }

    fn slider_ui(&self, ui: &mut Ui, value: &mut f64, decimals: usize) -> Response {
        let (present, Reach { low, high, step, ratios }) = (*value, self.reach);
        ui.spacing_mut().slider_width = self.slider_width(ui, present, decimals);
        if ratios {
            return logarithmic_ui(ui, value, (low, high));
        }
        let slider = Slider::new(value, low.min(present)..=high.max(present))
            .show_value(false)
            .clamping(egui::SliderClamping::Never)
            .smart_aim(false)
            .step_by(step);
        let slider = slider_ui(ui, slider);
        if *value != present && !slider.dragged() && slider.has_focus() && ui.input(|i| i.modifiers.shift) {
            *value = present + 10.0 * (*value - present);
        }
        // the value of a slider is a multiple of its step
        if *value != present && value.abs() < 1e12 * step {
            *value = decimal((*value / step).round() * step);
        }
        slider
    }

    /// Draws the number, in a field of at least `width` points. Returns its response, and whether an
    /// acceptable number was typed.
    fn number_ui(&self, ui: &mut Ui, value: &mut f64, (decimals, width): (usize, f32)) -> (Response, bool) {
        let present = *value;
        let editing = ui.memory(|memory| memory.has_focus(ui.next_auto_id()));
        let write = |number: f64| match editing {
            // as it was shown, so that the field keeps its width
            true => shown(number, decimals),
            false => with_minus(&shown(number, decimals)),
        };
        let entered = RefCell::new(None);
        let mut edited = present;
        let field = DragValue::new(&mut edited)
            .speed(self.reach.step)
            .suffix(self.suffix())
            .min_size(egui::vec2(width, CONTROL))
            .custom_formatter(|number, _| write(number))
            .update_while_editing(false)
            .custom_parser(|text| {
                let text = &text.trim().replace('\u{2212}', "-");
                // a text that was not changed leaves the value as it is
                if *text == shown(present, decimals) || *text == exact(present, decimals) {
                    return Some(present);
                }
                let number = self.parsed(text, present);
                *entered.borrow_mut() = Some(number.clone());
                number.ok()
            });
        let response = ui.add(field);
        let entered = entered.into_inner();
        let typed = matches!(entered, Some(Ok(_)));
        match entered {
            Some(Err(why)) => refuse(ui, self.id, why),
            _ if edited != present => {
                let multiple = decimal((edited / self.reach.step).round() * self.reach.step);
                *value = if typed { edited } else { multiple };
            }
            _ => {}
        }
        (response, typed)
    }

    /// The unit as it follows a number.
    fn suffix(&self) -> String {
        let space = if self.unit.is_empty() || self.unit == "°" { "" } else { " " };
        format!("{space}{}", self.unit)
    }

    fn parsed(&self, text: &str, present: f64) -> Result<f64, String> {
        let unit = self.suffix();
        let number =
            text.strip_suffix(self.unit).unwrap_or(text).trim().replace('−', "-").replace('∞', "inf");
        let stays = format!("{} stays {}{unit}.", self.name, shown(present, 0));
        if number.is_empty() {
            return Err(format!("No number was typed: {stays}"));
        }
        let is_number = |value: &f64| value.is_finite() || *value == self.typed.1;
        let read = |text: &str| read_number(text).ok().filter(is_number);
        // the end of arithmetic may look like the unit, as in 0.21/g
        let Some(value) = read(&with_point(&number)).or_else(|| read(&text.replace('−', "-"))) else {
            let point = match read(&number.replace(',', "")) {
                Some(_) if number.contains(',') => " Write it with a point or without a comma.",
                _ => "",
            };
            return Err(format!("“{}” is no number: {stays}{point}", clipped(&number)));
        };
        // the present value is always allowed
        let (low, high) = (self.typed.0.min(present), self.typed.1.max(present));
        if !(low..=high).contains(&value) {
            let ([value, low, high], name) =
                ([value, low, high].map(|number| with_minus(&shown(number, 0))), self.name);
            return Err(format!("{value}{unit} was not taken: {name} may be {low} to {high}{unit}."));
        }
        Ok(value)
    }

    /// Width of the slider, reduced for a long number so that both together keep their width.
    fn slider_width(&self, ui: &Ui, value: f64, decimals: usize) -> f32 {
        let text = format!("{} {}", with_minus(&shown(value, decimals)), self.unit);
        let font = egui::TextStyle::Button.resolve(ui.style());
        let text = ui.painter().layout_no_wrap(text, font, Color32::PLACEHOLDER).size().x;
        let number = text + 2.0 * ui.spacing().button_padding.x;
        (self.width - (number - NUMBER).max(0.0)).max(MIN_SLIDER)
    }
}

/// A slider with a thin track, whose handle has the ground of a card: a slider fills both alike.
fn slider_ui(ui: &mut Ui, slider: Slider<'_>) -> Response {
    let style = Style::of(ui.ctx(), false);
    ui.spacing_mut().interact_size.y = SLIDER;
    ui.visuals_mut().selection.bg_fill = style.accent();
    ui.visuals_mut().widgets.inactive.bg_fill = style.track();
    let response = ui.add(slider);
    if response.drag_started() {
        response.request_focus(); // the arrow keys go on from there
    }
    let handle = ui.painter().add(Shape::Noop).0.checked_sub(1);
    ui.ctx().graphics_mut(|graphics| {
        let list = graphics.get_mut(ui.layer_id()).zip(handle);
        list.into_iter().for_each(|(list, handle)| {
            list.mutate_shape(ShapeIdx(handle), |shape| {
                if let Shape::Circle(circle) = &mut shape.shape {
                    circle.fill = style.ground();
                }
            });
        });
    });
    response
}

/// A logarithmic slider; a value beyond its ends is shown at the end.
fn logarithmic_ui(ui: &mut Ui, value: &mut f64, (low, high): (f64, f64)) -> Response {
    let present = *value;
    let slider = Slider::new(value, low..=high).show_value(false).logarithmic(true);
    let slider = slider_ui(ui, slider.clamping(egui::SliderClamping::Never));
    if *value == present {
        return slider;
    }
    if !slider.dragged() && slider.has_focus() && ui.input(|input| input.modifiers.shift) {
        let from = present.clamp(low, high);
        *value = from * (*value / from).powi(10);
    }
    *value = rounded(value.clamp(low, high), 3);
    slider
}

/// Replaces a decimal comma by a point; `1,234` stays, since its comma may separate thousands.
fn with_point(number: &str) -> String {
    let Some((whole, part)) = number.split_once(',') else { return number.to_owned() };
    let digits = part.chars().take_while(char::is_ascii_digit).count();
    let is_thousands = digits == 3 && !whole.trim_matches(['-', '+', '0']).is_empty();
    let is_plain = digits > 0 && !part.contains([',', '.']) && !whole.contains('.');
    if is_plain && !is_thousands { format!("{whole}.{part}") } else { number.to_owned() }
}

fn clipped(text: &str) -> String {
    let short: String = text.chars().take(20).collect();
    if short.len() < text.len() { format!("{short}..") } else { short }
}

/// An input that was refused.
#[derive(Debug, Clone)]
struct Refused {
    id: egui::Id,
    why: String,
    /// Time in s of the input.
    at: f64,
}

fn slot() -> egui::Id {
    egui::Id::unique("refused")
}

/// Shows at a control why an input was refused, for some seconds or until another one is accepted.
pub fn refuse(ui: &Ui, id: egui::Id, why: String) {
    let refused = Refused { id, why, at: ui.input(|input| input.time) };
    ui.data_mut(|data| data.insert_temp(slot(), refused));
}

fn clear_refusal(ui: &Ui) {
    ui.data_mut(|data| data.remove::<Refused>(slot()));
}

/// Shows why an input was refused: beside its control if that is in a column, else below it.
fn refusal_ui(ui: &Ui, id: egui::Id, response: &Response) {
    let Some(refused) = ui.data(|data| data.get_temp::<Refused>(slot())).filter(|last| last.id == id) else {
        return;
    };
    let left = REFUSAL_TIME - (ui.input(|input| input.time) - refused.at);
    if left <= 0.0 {
        clear_refusal(ui);
        return;
    }
    ui.ctx().request_repaint_after_secs(left as f32);
    let (rect, window) = (response.rect, ui.ctx().content_rect());
    let beside = window.width() >= NARROW_BELOW && window.right() - rect.right() > REFUSAL_WIDTH + 40.0;
    let at = if beside {
        pos2(rect.right() + 10.0, rect.top())
    } else {
        rect.left_bottom() + egui::vec2(0.0, 4.0)
    };
    let style = Style::of(ui.ctx(), false);
    let area = egui::Area::new(slot().with(id)).order(egui::Order::Tooltip).fixed_pos(at);
    area.constrain(true).interactable(false).show(ui.ctx(), |ui| {
        let frame = egui::Frame::popup(ui.style()).stroke(egui::Stroke::new(1.5, style.impact()));
        frame.show(ui, |ui| {
            ui.set_max_width(REFUSAL_WIDTH);
            ui.add(egui::Label::new(RichText::new(refused.why).color(style.ink())).wrap());
        });
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knob() -> Knob<'static> {
        let reach = Reach::even(0.0, 2.0, 0.01);
        let (id, typed) = (egui::Id::NULL, (-10.0, 10.0));
        Knob { id, name: "amplitude", unit: "g", reach, typed, hover: "", width: 100.0 }
    }

    #[test]
    fn a_text_is_a_number_or_says_why_not() {
        let parsed = |text: &str| knob().parsed(text, 0.9);
        assert_eq!(parsed("1.137"), Ok(1.137));
        assert_eq!((parsed("1.5 g"), parsed("−2"), parsed("1e0")), (Ok(1.5), Ok(-2.0), Ok(1.0)));
        // a comma that can only stand for a point
        for (text, value) in
            [("1,2", 1.2), ("0,125", 0.125), ("-1,5 g", -1.5), ("1,2345", 1.2345), ("2,5e-1", 0.25)]
        {
            assert_eq!(parsed(text), Ok(value));
        }
        // arithmetic, with and without the unit, whose letter is also standard gravity
        for (text, value) in [
            ("1/3", 1.0 / 3.0),
            ("sqrt(2)/3 g", 2.0_f64.sqrt() / 3.0),
            ("0.21/g", 0.21 / 9.80665),
            ("0.21/g g", 0.21 / 9.80665),
            ("−(1+2)^2", -9.0),
            ("1,5/2", 0.75),
        ] {
            assert_eq!(parsed(text), Ok(value), "{text}");
        }
        for text in ["1/0", "2*x", "1/", "(1+2"] {
            assert_eq!(parsed(text), Err(format!("“{text}” is no number: amplitude stays 0.9 g.")));
        }
        let with_comma = "is no number: amplitude stays 0.9 g. Write it with a point or without a comma.";
        for (text, why) in [("1,5,2", with_comma), ("1,234", with_comma)]
            .into_iter()
            .chain(["abc", "a,5", "nan"].map(|text| (text, "is no number: amplitude stays 0.9 g.")))
        {
            assert_eq!(parsed(text), Err(format!("“{text}” {why}")));
        }
        assert_eq!(parsed(""), Err("No number was typed: amplitude stays 0.9 g.".to_owned()));
        assert_eq!(
            parsed("1e9"),
            Err("1e9 g was not taken: amplitude may be \u{2212}10 to 10 g.".to_owned())
        );
        // infinity is accepted if it is in the range
        assert!(parsed("inf").is_err());
        let load = Knob { typed: (0.0, f64::INFINITY), ..knob() };
        assert_eq!((load.parsed("inf", 60.0), load.parsed("0", 60.0)), (Ok(f64::INFINITY), Ok(0.0)));
        assert!(load.parsed("-inf", 60.0).is_err() && load.parsed("nan", 60.0).is_err());
        // the present value may be typed again
        assert_eq!(knob().parsed("50", 50.0), Ok(50.0));
    }
}
