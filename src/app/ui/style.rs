//! Colours, line widths and text sizes, with what each stands for.
//!
//! What a picture on paper shows has the colour that its role has there ([`Theme`]). No meaning depends on a
//! hue alone: every regime has a shape as well. Light, dark and projector modes differ in background, widths
//! and zoom, not in meanings.

use std::sync::Arc;

use eframe::egui::{self, Color32, FontData, FontDefinitions, FontFamily, FontId, Stroke, TextStyle};

use crate::app::words::kind::Kind;
use crate::output::{Ink, Role, Theme};

/// Zoom of the projector in a window of 1280x720, which has room for this many points.
pub const PROJECTOR_ZOOM: f32 = 1.5;
const PROJECTED_HEIGHT: f32 = 480.0;
/// Width in points that the bars and views need at least.
const PROJECTED_WIDTH: f32 = 740.0;
/// How much larger a view that fills the window is drawn by a projector.
pub const FILLED_ZOOM: f32 = 1.25;

/// The zoom of the projector in a window of `size` in points at zoom 1: text, marks and lines are always the
/// same share of its height, if it is not too narrow for them.
pub fn projector_zoom(size: egui::Vec2) -> f32 {
    (size.y / PROJECTED_HEIGHT).min(size.x / PROJECTED_WIDTH).max(1.0)
}

/// Width in points below which the window is laid out for a projector: two controls in a row, two views.
pub const COMPACT_BELOW: f32 = 1000.0;

/// Size in points of a window above which there is room for one more tile.
pub const LARGE_FROM: egui::Vec2 = egui::Vec2::new(1600.0, 880.0);

/// Size of a text that would not fit at another one.
pub const LEAST: f32 = 9.5;
pub const SMALL: f32 = 11.5;
pub const BODY: f32 = 14.0;
pub const STATUS: f32 = 18.0;
/// Size of the status sentence in points where room is short.
pub const STATUS_COMPACT: f32 = 16.0;

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

    pub fn mass(&self) -> Color32 {
        ORANGE
    }

    /// The colours of pictures in this appearance.
    pub fn theme(&self) -> Theme {
        Theme::of(self.dark, None)
    }

    /// The colour of what stands for `role`.
    pub fn colour(&self, role: Role) -> Color32 {
        colour(self.theme().look(role).ink)
    }

    /// The line of what stands for `role`.
    pub fn stroke(&self, role: Role) -> Stroke {
        let look = self.theme().look(role);
        Stroke::new(self.width(STROKE * look.width as f32), colour(look.ink))
    }

    pub fn kind(&self, kind: Kind) -> Color32 {
        match kind {
            Kind::Resting | Kind::Other => self.faint(),
            Kind::Intrawell => self.colour(Role::Regime(1)),
            Kind::Irregular => self.colour(Role::Second),
            Kind::Interwell | Kind::Crossing | Kind::Fault => self.impact(),
        }
    }

    pub fn measured(&self) -> Color32 {
        self.kind(Kind::Irregular)
    }

    pub fn stop(&self) -> Color32 {
        self.colour(Role::Stop)
    }

    /// The base, its acceleration and its push.
    pub fn base(&self) -> Color32 {
        self.colour(Role::Drive)
    }

    /// Time at rest on a stop.
    pub fn rest_shade(&self) -> Color32 {
        self.colour(Role::Rest)
    }

    pub fn impact(&self) -> Color32 {
        self.colour(Role::Impact)
    }

    pub fn width(&self, points: f32) -> f32 {
        // three pixels at the zoom of the projector mode
        if self.projector { points.max(3.0 / PROJECTOR_ZOOM) } else { points }
    }

    /// The radius of a point in a picture.
    pub fn dot(&self, points: f32) -> f32 {
        if self.projector { 1.4 * points } else { points }
    }

    pub fn cursor_stroke(&self) -> Stroke {
        Stroke::new(self.width(1.3), self.kind(Kind::Irregular))
    }

    /// A pinned motion, over time and in the phase portrait.
    pub fn ghost_motion_stroke(&self) -> Stroke {
        Stroke::new(self.width(1.6), self.ink().gamma_multiply(0.6))
    }

    /// Many measured samples, below the computed line.
    pub fn measured_stroke(&self) -> Stroke {
        Stroke::new(self.width(4.5), self.measured().lerp_to_gamma(self.ground(), 0.25))
    }

    pub fn grid_stroke(&self) -> Stroke {
        Stroke::new(1.0, self.grid())
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

    pub fn small(&self) -> FontId {
        FontId::proportional(SMALL)
    }

    pub fn body(&self) -> FontId {
        FontId::proportional(BODY)
    }
}

/// Methods of [`Style`] that return a colour: its name, the colour in light mode and that in dark mode.
macro_rules! colours {
    ($($(#[$doc:meta])* $name:ident: $light:expr, $dark:expr;)+) => {
        impl Style {
            $($(#[$doc])*
            pub fn $name(&self) -> Color32 {
                self.pick($light, $dark)
            })+
        }
    };
}

colours! {
    /// Text and axes.
    ink: colour(Theme::LIGHT.ink), colour(Theme::DARK.ink);
    /// Secondary text and lines: ticks, units, notes.
    faint: colour(Theme::LIGHT.soft), colour(Theme::DARK.soft);
    /// Edges of controls, with a contrast of at least 3:1 to the background.
    edge: gray(135), gray(118);
    grid: colour(Theme::LIGHT.grid), colour(Theme::DARK.grid);
    ground: colour(Theme::LIGHT.paper), colour(Theme::DARK.paper);
    /// Text about the proof mass.
    mass_ink: rgb(140, 92, 0), ORANGE;
    mass_edge: rgb(122, 84, 0), rgb(255, 214, 128);
    frame_colour: gray(190), gray(85);
    /// Background of panels, and cells that are not computed yet.
    panel: gray(246), gray(34);
    /// Veil over a map that is not that of the scene.
    veil: Color32::from_white_alpha(140), Color32::from_black_alpha(130);
}

/// Methods of [`Style`] that return the line of a role: its name and the role.
macro_rules! roles {
    ($($(#[$doc:meta])* $name:ident: $role:ident;)+) => {
        impl Style {
            $($(#[$doc])*
            pub fn $name(&self) -> Stroke {
                self.stroke(Role::$role)
            })+
        }
    };
}

roles! {
    /// The potential with the base's push, on which the mass rides.
    tray_stroke: Curve;
    /// The potential without the push.
    ghost_stroke: Reference;
    /// The motion over time.
    motion_stroke: Motion;
    /// Power of a transducer over time.
    power_stroke: Motion;
    /// Acceleration of the base over time, and its push.
    base_stroke: Drive;
    /// An impact: a tick on a time axis, a jump of the velocity.
    impact_stroke: Impact;
    stop_stroke: Stop;
}

/// Methods of [`Style`] that return a stroke: its name, its width in points and its colour. In projector mode
/// it is thicker.
macro_rules! strokes {
    ($($(#[$doc:meta])* $name:ident: $points:expr, $colour:ident;)+) => {
        impl Style {
            $($(#[$doc])*
            pub fn $name(&self) -> Stroke {
                Stroke::new(self.width($points), self.$colour())
            })+
        }
    };
}

strokes! {
    /// The outline of a pinned motion's mass.
    ghost_mass_stroke: 1.8, mass_ink;
    /// The height of the barrier where energies are compared with it.
    barrier_stroke: 2.0, ink;
    /// Frame of what has the keyboard focus.
    focus_stroke: 2.0, base;
    /// Frame of what a lesson points at.
    pointing_stroke: 3.0, mass_ink;
    arrow_stroke: 3.0, base;
    flexure_stroke: 2.0, ink;
    /// Outline of the cell under the pointer.
    cell_stroke: 2.0, ink;
}

const fn gray(level: u8) -> Color32 {
    Color32::from_gray(level)
}

const fn rgb(red: u8, green: u8, blue: u8) -> Color32 {
    Color32::from_rgb(red, green, blue)
}

/// Installs fonts, text sizes and spacing of the window; to be called once.
pub fn install(ctx: &egui::Context) {
    let mut fonts = FontDefinitions::default();
    let inter = FontData::from_static(include_bytes!("../../../assets/fonts/Inter-Regular.ttf"));
    let strong = FontData::from_static(include_bytes!("../../../assets/fonts/Inter-SemiBold.ttf"));
    fonts.font_data.insert("inter".into(), Arc::new(inter));
    fonts.font_data.insert("inter-strong".into(), Arc::new(strong));
    let proportional = fonts.families.entry(FontFamily::Proportional).or_default();
    proportional.insert(0, "inter".into());
    let mut heavy = proportional.clone();
    heavy.insert(0, "inter-strong".into());
    fonts.families.insert(strong_family(), heavy);
    ctx.set_fonts(fonts);
    ctx.all_styles_mut(|style| {
        let dark = style.visuals.dark_mode;
        let ink = Style { dark, projector: false };
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(SMALL)),
            (TextStyle::Body, FontId::proportional(BODY)),
            (TextStyle::Button, FontId::proportional(BODY)),
            (TextStyle::Monospace, FontId::monospace(BODY)),
            (TextStyle::Heading, FontId::new(BODY, strong_family())),
        ]
        .into();
        style.spacing.slider_width = 150.0;
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        // scroll bars are always visible
        style.spacing.scroll =
            egui::style::ScrollStyle { bar_width: 7.0, ..egui::style::ScrollStyle::solid() };
        style.visuals.override_text_color = Some(ink.ink());
        style.visuals.slider_trailing_fill = true;
        // buttons and check boxes have an edge that is visible on every background
        style.visuals.widgets.inactive.bg_stroke = Stroke::new(1.0, ink.edge());
        // the widget with the keyboard focus has this frame as well
        style.visuals.widgets.active.bg_stroke = ink.focus_stroke();
    });
}

/// The font family of headings and of text that is to be read first.
pub fn strong_family() -> FontFamily {
    FontFamily::Name("strong".into())
}
