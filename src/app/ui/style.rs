//! Colours, line widths and text sizes, with what each stands for. Lines and marks that also occur in
//! pictures on paper have the colours of their roles there ([`Theme`]). No meaning depends on a hue alone:
//! every regime has a shape as well. Light, dark and projector modes differ in background, widths and zoom,
//! not in meanings.

use std::sync::Arc;

use eframe::egui::{self, Color32, FontData, FontDefinitions, FontFamily, FontId, Stroke, TextStyle};

use crate::app::words::kind::Kind;
use crate::output::{HACK, INTER, Ink, Role, Theme};

/// Zoom of the projector in a window of 1280x720, which has room for this many points.
pub const PROJECTOR_ZOOM: f32 = 1.5;
const PROJECTED_HEIGHT: f32 = 480.0;
/// Width in points that the bars and views need at least.
const PROJECTED_WIDTH: f32 = 740.0;
/// Additional zoom, for a projector, of a view that fills the window.
pub const FILLED_ZOOM: f32 = 1.25;

/// The zoom of the projector in a window of `size` in points at zoom 1: text, marks and lines are always the
/// same share of its height, if it is not too narrow for them.
pub fn projector_zoom(size: egui::Vec2) -> f32 {
    (size.y / PROJECTED_HEIGHT).min(size.x / PROJECTED_WIDTH).max(1.0)
}

/// Width in points below which a window is narrow: the controls open by a button.
pub const NARROW_BELOW: f32 = 1000.0;

/// The three text sizes in points: labels of pictures and notes, text and controls, the headline.
pub const SMALL: f32 = 12.0;
pub const BODY: f32 = 14.0;
pub const STATUS: f32 = 18.0;
/// Smallest text size in points, for texts that do not fit at a larger one.
pub const LEAST: f32 = 9.5;

/// Height in points of every control, and of the row with the title of a view.
pub const CONTROL: f32 = 28.0;
/// Width in points of the field with the number of a slider.
pub const NUMBER: f32 = 76.0;
/// Distance in points between cards, and between a card and the edge of the window.
pub const GAP: f32 = 8.0;
/// Radius in points of the corners of a card.
pub const CORNER: u8 = 6;
/// Radius in points of the corners of a control.
const CONTROL_CORNER: u8 = 5;
/// Height in points of the track of a slider.
const TRACK: f32 = 4.0;

/// Radius in points of the proof mass where it rides on a curve; stops are drawn this far outside their
/// limit, so that the mass touches them at the limit.
pub const BALL: f32 = 13.5;

/// Distance in points within which something can be grabbed.
pub const GRAB: f32 = 14.0;

/// Time in s in which the ring of an impact grows and fades.
pub const RING_SECONDS: f64 = 0.3;

/// Points of the screen in a unit of a line's width on paper.
const STROKE: f32 = 2.0 / 3.0;

const ORANGE: Color32 = rgb(230, 159, 0);

/// A colour of a picture on paper.
pub const fn colour(Ink(red, green, blue): Ink) -> Color32 {
    rgb(red, green, blue)
}

/// The colours and widths of one appearance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    pub dark: bool,
    /// Whether lines are thick enough to be seen from the last row of a lecture hall.
    pub projector: bool,
}

impl Style {
    pub fn of(ctx: &egui::Context, projector: bool) -> Self {
        Self { dark: ctx.theme() == egui::Theme::Dark, projector }
    }

    fn pick(&self, light: Color32, dark: Color32) -> Color32 {
        if self.dark { dark } else { light }
    }

    /// The colours of pictures in this appearance: those on paper, on the ground of a card.
    pub fn theme(&self) -> Theme {
        let ink_of = |colour: Color32| Ink(colour.r(), colour.g(), colour.b());
        let [paper, ink, soft, grid] = [self.ground(), self.ink(), self.faint(), self.grid()].map(ink_of);
        Theme { paper, ink, soft, grid, ..Theme::of(self.dark, None) }
    }

    /// The colour of a role.
    pub fn colour(&self, role: Role) -> Color32 {
        colour(self.theme().look(role).ink)
    }

    /// The line of a role.
    pub fn stroke(&self, role: Role) -> Stroke {
        let look = self.theme().look(role);
        Stroke::new(self.line(look.width), colour(look.ink))
    }

    /// The width in points on the screen of a line with this width on paper.
    pub fn line(&self, width: f64) -> f32 {
        self.width(STROKE * width as f32)
    }

    pub fn kind(&self, kind: Kind) -> Color32 {
        match kind {
            Kind::Resting | Kind::Other => self.faint(),
            Kind::Intrawell => self.colour(Role::Regime(1)),
            Kind::Irregular => self.colour(Role::Second),
            Kind::Interwell | Kind::Crossing | Kind::Fault => self.impact(),
        }
    }

    pub fn width(&self, points: f32) -> f32 {
        // three pixels at the zoom of the projector mode
        if self.projector { points.max(3.0 / PROJECTOR_ZOOM) } else { points }
    }

    /// The mark of the scene on a map, in the colour of the mass: outline and mark.
    pub fn marker_strokes(&self) -> [Stroke; 2] {
        let width = self.width(2.4);
        [Stroke::new(width + 2.6, Color32::BLACK), Stroke::new(width, ORANGE)]
    }

    /// The trail of the scene on a map: outline and line.
    pub fn trail_strokes(&self) -> [Stroke; 2] {
        let width = self.width(1.8);
        [Stroke::new(width + 1.8, Color32::BLACK), Stroke::new(width, ORANGE)]
    }
}

/// Methods of [`Style`] of one expression: name, type and value.
macro_rules! methods {
    ($($(#[$doc:meta])* $name:ident($style:ident) -> $type:ty = $value:expr;)+) => {
        impl Style {
            $($(#[$doc])*
            pub fn $name(&self) -> $type {
                let $style = self;
                $value
            })+
        }
    };
}

methods! {
    /// Text and axes.
    ink(style) -> Color32 = style.pick(hex(0x1b1e22), hex(0xe8eaed));
    /// Secondary text and lines: ticks, units, notes.
    faint(style) -> Color32 = style.pick(hex(0x5a6067), hex(0xa3a9b0));
    /// The window around the cards, and cells that are not computed yet.
    panel(style) -> Color32 = style.pick(hex(0xf6f7f8), hex(0x15171a));
    /// A card, on which views are drawn.
    ground(style) -> Color32 = style.pick(hex(0xffffff), hex(0x1d2024));
    /// The frame of a card.
    border(style) -> Color32 = style.pick(hex(0xe1e4e8), hex(0x2b2f35));
    card_stroke(style) -> Stroke = Stroke::new(1.0, style.border());
    /// Edges of controls, with a contrast of at least 3:1 to the background.
    edge(style) -> Color32 = style.pick(hex(0x858b93), hex(0x6c727a));
    grid(style) -> Color32 = style.pick(hex(0xeceef0), hex(0x2b2f35));
    /// The track of a slider.
    track(style) -> Color32 = style.pick(hex(0xd3d8dd), hex(0x40454d));
    /// A control under the pointer.
    pointed(style) -> Color32 = style.pick(hex(0xe9edf1), hex(0x2a2e34));
    /// The chosen one of several options.
    chosen(style) -> Color32 = style.pick(hex(0xd3e6f4), hex(0x1f4560));
    /// Links, and the filled part of a track.
    accent(style) -> Color32 = style.pick(hex(0x17689f), hex(0x6cbcec));
    /// A primary action.
    action(style) -> Color32 = style.pick(hex(0x17689f), hex(0x2272a8));
    on_action(style) -> Color32 = style.pick(hex(0xffffff), hex(0xffffff));
    mass(_style) -> Color32 = ORANGE;
    /// The reference.
    compared(style) -> Color32 = style.colour(Role::Compared);
    /// Text about the proof mass.
    mass_ink(style) -> Color32 = style.pick(rgb(140, 92, 0), ORANGE);
    mass_edge(style) -> Color32 = style.pick(rgb(122, 84, 0), rgb(255, 214, 128));
    /// Veil over a map that is not that of the scene.
    veil(style) -> Color32 = style.pick(Color32::from_white_alpha(140), Color32::from_black_alpha(130));
    stop(style) -> Color32 = style.colour(Role::Stop);
    stop_stroke(style) -> Stroke = style.stroke(Role::Stop);
    /// The base, its acceleration and its push.
    base(style) -> Color32 = style.colour(Role::Drive);
    /// Time at rest on a stop.
    rest_shade(style) -> Color32 = style.colour(Role::Rest);
    /// An impact: a tick on a time axis, a jump of the velocity.
    impact(style) -> Color32 = style.colour(Role::Impact);
    impact_stroke(style) -> Stroke = style.stroke(Role::Impact);
    /// The potential with the base's push, on which the mass rides.
    tray_stroke(style) -> Stroke = style.stroke(Role::Curve);
    /// The potential without the push.
    ghost_stroke(style) -> Stroke = style.stroke(Role::Reference);
    /// The height of the barrier where energies are compared with it.
    barrier_stroke(style) -> Stroke = Stroke::new(style.width(2.0), style.ink());
    /// Frame of the widget with the keyboard focus.
    focus_stroke(style) -> Stroke = Stroke::new(style.width(2.0), style.accent());
    /// Frame around the control or view that a lesson points at.
    pointing_stroke(style) -> Stroke = Stroke::new(style.width(3.0), style.mass_ink());
    cursor_stroke(style) -> Stroke = Stroke::new(style.width(1.3), style.kind(Kind::Irregular));
    /// The lines over a view that is covered.
    hatching_stroke(style) -> Stroke = Stroke::new(style.width(1.0), style.border());
    /// Outline of the cell under the pointer.
    cell_stroke(style) -> Stroke = Stroke::new(style.width(2.0), style.ink());
    small(_style) -> FontId = FontId::proportional(SMALL);
    body(_style) -> FontId = FontId::proportional(BODY);
}

const fn hex(code: u32) -> Color32 {
    let [_, red, green, blue] = code.to_be_bytes();
    rgb(red, green, blue)
}

const fn rgb(red: u8, green: u8, blue: u8) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// Installs fonts, text sizes and spacing of the window; to be called once.
pub fn install(ctx: &egui::Context) {
    let mut fonts = FontDefinitions::empty();
    for (name, bytes) in [("inter", INTER[0]), ("inter-strong", INTER[1]), ("hack", HACK)] {
        fonts.font_data.insert(name.into(), Arc::new(FontData::from_static(bytes)));
    }
    for (family, names) in [
        (FontFamily::Proportional, ["inter", "hack"]),
        (strong_family(), ["inter-strong", "hack"]),
        (FontFamily::Monospace, ["hack", "inter"]),
    ] {
        fonts.families.insert(family, names.map(String::from).to_vec());
    }
    ctx.set_fonts(fonts);
    ctx.all_styles_mut(|style| {
        let dark = style.visuals.dark_mode;
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(SMALL)),
            (TextStyle::Body, FontId::proportional(BODY)),
            (TextStyle::Button, FontId::proportional(BODY)),
            (TextStyle::Monospace, FontId::monospace(BODY)),
            (TextStyle::Heading, FontId::new(BODY, strong_family())),
        ]
        .into();
        let spacing = &mut style.spacing;
        spacing.slider_width = 150.0;
        spacing.slider_rail_height = TRACK;
        spacing.interact_size.y = CONTROL;
        spacing.item_spacing = egui::vec2(8.0, 4.0);
        spacing.button_padding = egui::vec2(8.0, 4.0);
        // scroll bars are always visible, in the colour of text, since that of a button is the ground's
        let solid = egui::style::ScrollStyle::solid();
        spacing.scroll = egui::style::ScrollStyle { bar_width: 5.0, foreground_color: true, ..solid };
        paint(&mut style.visuals, Style { dark, projector: false });
    });
}

/// Colours of the widgets: controls are outlined, and filled with a tint under the pointer.
fn paint(visuals: &mut egui::Visuals, style: Style) {
    let (ink, ground) = (style.ink(), style.ground());
    visuals.slider_trailing_fill = true;
    visuals.handle_shape = egui::style::HandleShape::Circle;
    visuals.weak_text_color = Some(style.faint());
    visuals.hyperlink_color = style.accent();
    visuals.panel_fill = style.panel();
    (visuals.window_fill, visuals.window_stroke) = (ground, style.card_stroke());
    (visuals.extreme_bg_color, visuals.faint_bg_color) = (ground, style.panel());
    (visuals.window_corner_radius, visuals.menu_corner_radius) = (CORNER.into(), CORNER.into());
    visuals.selection.bg_fill = style.chosen();
    visuals.selection.stroke = Stroke::new(1.0, ink);
    let widgets = &mut visuals.widgets;
    let edge = Stroke::new(1.0, style.edge());
    for (widget, fill, stroke) in [
        (&mut widgets.noninteractive, style.panel(), style.card_stroke()),
        // buttons and check boxes have an edge that is visible on every background
        (&mut widgets.inactive, ground, edge),
        (&mut widgets.hovered, style.pointed(), edge),
        // the widget with the keyboard focus has this frame as well
        (&mut widgets.active, style.pointed(), style.focus_stroke()),
        (&mut widgets.open, style.pointed(), edge),
    ] {
        (widget.bg_fill, widget.weak_bg_fill, widget.bg_stroke) = (fill, fill, stroke);
        widget.fg_stroke = Stroke::new(1.5, ink);
        (widget.corner_radius, widget.expansion) = (CONTROL_CORNER.into(), 0.0);
    }
}

/// The font family of headings and of text that is to be read first.
pub fn strong_family() -> FontFamily {
    FontFamily::Name("strong".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contrast of two colours by the rule of WCAG 2.
    fn contrast(a: Color32, b: Color32) -> f64 {
        let luminance = |colour: Color32| {
            let linear = |part: u8| {
                let share = f64::from(part) / 255.0;
                if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * linear(colour.r()) + 0.7152 * linear(colour.g()) + 0.0722 * linear(colour.b())
        };
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn every_text_has_a_contrast_of_four_and_a_half() {
        assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 1e-9);
        for dark in [false, true] {
            let style = Style { dark, projector: false };
            let both = [style.panel(), style.ground()];
            for (least, name, colour, grounds) in [
                (4.5, "primary", style.ink(), &both[..]),
                (4.5, "secondary", style.faint(), &both),
                (4.5, "link", style.accent(), &both),
                (4.5, "the mass", style.mass_ink(), &both),
                (4.5, "the base", style.base(), &[style.ground()]),
                (4.5, "a primary action", style.on_action(), &[style.action()]),
                (4.5, "what is chosen", style.ink(), &[style.chosen()]),
                (4.5, "what is under the pointer", style.ink(), &[style.pointed()]),
                (3.0, "the edge", style.edge(), &both),
            ] {
                for ground in grounds {
                    let contrast = contrast(colour, *ground);
                    assert!(contrast >= least, "{name}, dark {dark}: {contrast:.2} on {ground:?}");
                }
            }
        }
    }

    #[test]
    fn spaces_are_steps_of_four_points() {
        let ctx = egui::Context::default();
        install(&ctx);
        let style = ctx.style_of(egui::Theme::Light);
        let spacing = &style.spacing;
        let spaces = [CONTROL, NUMBER, GAP, TRACK, spacing.slider_rail_height, spacing.interact_size.y];
        let pairs = [spacing.item_spacing, spacing.button_padding].map(|pair| [pair.x, pair.y]);
        for space in spaces.into_iter().chain(pairs.into_iter().flatten()) {
            assert!(space > 0.0 && space % 4.0 == 0.0, "{space}");
        }
    }
}
