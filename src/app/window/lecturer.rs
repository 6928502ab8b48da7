//! The window of the lecturer's notes: beside the main window, or where it was left.

use eframe::egui::{Context, Pos2, Rect, Vec2, ViewportBuilder, pos2, vec2};

use crate::app::panels::notes::lecturer_ui;

use super::Window;

/// Size in points of the window at its first opening.
const SIZE: Vec2 = vec2(520.0, 420.0);
/// The least width in points that it is given beside the main window.
const LEAST: f32 = 300.0;
/// Distance in points between the two windows.
const APART: f32 = 8.0;

/// Where a window is on the screen, in points at zoom 1: its upper left corner and the size within its frame.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Place {
    pub at: [f32; 2],
    pub size: [f32; 2],
}

impl Place {
    fn rect(self) -> Rect {
        Rect::from_min_size(self.at.into(), self.size.into())
    }
}

#[derive(Debug, Default)]
pub(super) struct Notes {
    pub is_open: bool,
    /// Where the window was last.
    pub place: Option<Place>,
    /// Whether the place is from an earlier start of the program, whose screens may be gone.
    pub is_old: bool,
    /// Position and size with which it was opened, in points at the zoom of that time; they stay the same as
    /// long as it is open, so that it can be moved.
    opened: Option<(Option<Pos2>, Vec2)>,
}

impl Notes {
    /// Position and size for an opening now, in points at the present zoom.
    fn opening(&self, ctx: &Context) -> (Option<Pos2>, Vec2) {
        let zoom = ctx.zoom_factor();
        let (window, screen) =
            ctx.input(|input| (input.viewport().outer_rect, input.viewport().monitor_size));
        // the centre of the window lies on a present screen
        let screens = screen.map(|screen| Rect::from_min_size(Pos2::ZERO, screen * zoom));
        let is_on = |place: &Place| screens.is_none_or(|screen| screen.contains(place.rect().center()));
        let is_there = |place: &Place| !self.is_old || is_on(place);
        if let Some(place) = self.place.filter(is_there) {
            let rect = place.rect() / zoom;
            return (Some(rect.min), rect.size());
        }
        let size = self.place.map_or(SIZE, |place| place.rect().size() / zoom);
        let beside = window.zip(screen).and_then(|(window, screen)| beside(window, screen, size));
        beside.map_or((None, size), |rect| (Some(rect.min), rect.size()))
    }
}

/// A place beside a window on its screen, to the right or else to the left of it, and narrower if necessary;
/// `None` if neither side has room. Screens are taken to be as wide as this one.
fn beside(window: Rect, screen: Vec2, size: Vec2) -> Option<Rect> {
    let left = (window.center().x / screen.x).floor() * screen.x;
    let (before, after) = (window.left() - APART - left, left + screen.x - window.right() - APART);
    let place = |from: f32, width: f32| Rect::from_min_size(pos2(from, window.top()), vec2(width, size.y));
    let width = size.x.min(before.max(after));
    match width >= LEAST {
        true if after >= width => Some(place(window.right() + APART, width)),
        true => Some(place(window.left() - APART - width, width)),
        false => None,
    }
}

impl Window {
    /// The lecturer's notes of the open lesson, if they are open.
    pub(super) fn lecturer_ui(&mut self, ctx: &Context) {
        let notes = &mut self.lessons.notes;
        let Some(lesson) = self.lessons.open.as_ref().filter(|_| notes.is_open) else {
            notes.opened = None;
            return;
        };
        let (at, size) = notes.opened.unwrap_or_else(|| notes.opening(ctx));
        notes.opened = Some((at, size));
        let builder = ViewportBuilder::default().with_title("Lecturer's notes - interwell");
        let builder = builder.with_inner_size(size);
        let builder = at.into_iter().fold(builder, ViewportBuilder::with_position);
        // the notes are read from near, not from the last row of a lecture hall
        let scale = if self.settings.projector { 1.0 / ctx.zoom_factor() } else { 1.0 };
        let shown = lecturer_ui(ctx, lesson, builder, scale);
        if let Some(rect) = shown.place.map(|rect| rect * ctx.zoom_factor()) {
            notes.place = Some(Place { at: rect.min.into(), size: rect.size().into() });
            notes.is_old = false;
        }
        notes.is_open &= !shown.is_closed;
        shown.action.into_iter().for_each(|action| self.act_in_lesson(action));
    }

    pub fn notes_place(&self) -> Option<Place> {
        self.lessons.notes.place
    }

    /// Restores where the notes were at an earlier start.
    pub fn restore_notes_place(&mut self, place: Option<Place>) {
        self.lessons.notes.place =
            place.filter(|place| place.rect().is_finite() && place.rect().is_positive());
        self.lessons.notes.is_old = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_stand_beside_the_window_where_there_is_room() {
        let screen = vec2(1920.0, 1080.0);
        let window = |left: f32, width: f32| Rect::from_min_size(pos2(left, 40.0), vec2(width, 720.0));
        let place = |left: f32, width: f32| beside(window(left, width), screen, SIZE);
        let at = |left: f32, width: f32| Some(Rect::from_min_size(pos2(left, 40.0), vec2(width, SIZE.y)));
        assert_eq!(place(0.0, 1280.0), at(1288.0, 520.0));
        assert_eq!(place(640.0, 1280.0), at(112.0, 520.0));
        // narrower, on the second screen, and not at all
        assert_eq!(place(200.0, 1280.0), at(1488.0, 432.0));
        assert_eq!(place(1920.0, 1280.0), at(3208.0, 520.0));
        assert_eq!(place(320.0, 1280.0), at(1608.0, 312.0));
        assert_eq!(place(0.0, 1920.0), None);
        for window in [window(200.0, 1280.0), window(640.0, 1280.0), window(2400.0, 1200.0)] {
            assert!(!beside(window, screen, SIZE).unwrap().intersects(window));
        }
    }
}
