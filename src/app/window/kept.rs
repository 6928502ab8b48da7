//! State of the window that is kept from one start of the program to the next.
//!
//! eframe saves the size in points at the zoom of that time and restores it before a zoom is set, so that a
//! window in projector mode would become smaller with every start. The size is therefore saved here, in
//! points at zoom 1.

use eframe::egui::{Context, Vec2, ViewportCommand, vec2};
use eframe::{Storage, get_value, set_value};
use egui_tiles::{Tile, TileId, Tree};

use crate::app::ui::style::{FILLED_ZOOM, PROJECTOR_ZOOM, projector_zoom};
use crate::app::views::View;

use super::Window;

const RECENT: &str = "recent";
/// Key of the window's size in points at zoom 1.
const SIZE: &str = "size";
const CUSTOM: &str = "arrangement";
const LESSONS: &str = "lessons";
/// Key of the place of the lecturer's notes in points at zoom 1.
const NOTES: &str = "notes";

impl Window {
    /// Restores the saved state except the settings.
    pub fn restore(&mut self, storage: &dyn Storage) {
        // a page has no files of the last time, and the size that the browser gives it
        if cfg!(not(target_arch = "wasm32")) {
            self.recent = get_value(storage, RECENT).unwrap_or_default();
            self.restore_size(get_value(storage, SIZE));
        }
        self.custom = get_value(storage, CUSTOM).map(compared_once);
        self.set_records(get_value(storage, LESSONS).unwrap_or_default());
        self.restore_notes_place(get_value(storage, NOTES));
    }

    pub(super) fn save_state(&self, storage: &mut dyn Storage) {
        set_value(storage, eframe::APP_KEY, &self.settings);
        set_value(storage, RECENT, &self.recent);
        set_value(storage, LESSONS, &self.records());
        if let Some(size) = self.size() {
            set_value(storage, SIZE, &size);
        }
        if let Some(place) = self.notes_place() {
            set_value(storage, NOTES, &place);
        }
        if let Some(tree) = &self.custom {
            set_value(storage, CUSTOM, tree);
        }
    }

    /// Restores a saved size; `None` at the first start.
    pub fn restore_size(&mut self, size: Option<[f32; 2]>) {
        let sane = |size: &Vec2| size.is_finite() && size.min_elem() >= 1.0;
        let wanted = size.map(|[x, y]| vec2(x, y)).filter(sane);
        self.window_size = WindowSize { wanted, ..WindowSize::default() };
    }

    /// The size to save, in points at zoom 1.
    pub fn size(&self) -> Option<[f32; 2]> {
        self.window_size.size.map(|size| [size.x, size.y])
    }
}

/// Leaves *Compare* one tile: in an arrangement of an earlier version it has those of views that are gone.
fn compared_once(mut tree: Tree<View>) -> Tree<View> {
    let is_compare = |(id, tile): (&TileId, &Tile<View>)| (*tile == Tile::Pane(View::Compare)).then_some(*id);
    let mut tiles: Vec<TileId> = tree.tiles.iter().filter_map(is_compare).collect();
    tiles.sort_by_key(|id| (!tree.is_visible(*id), id.0));
    for id in tiles.into_iter().skip(1) {
        tree.remove_recursively(id);
    }
    tree
}

/// Number of frames after a change of the zoom from which on reported sizes are those at the new zoom.
const SETTLED: u32 = 3;
/// Number of frames within which the window system reports the size of the window's decoration.
const DECORATED: u32 = 90;

/// Size of the window, and how far it has been restored.
#[derive(Debug, Clone, Default)]
pub(super) struct WindowSize {
    /// The size to restore; `None` once it has been requested.
    wanted: Option<Vec2>,
    /// Number of frames since the zoom last changed, and that zoom.
    frames: u32,
    zoom: f32,
    /// Whether the window was larger than the screen and has been maximized.
    fitted: bool,
    /// The last size of the window that was neither maximized nor full-screen.
    size: Option<Vec2>,
    /// The present size, in points at zoom 1.
    present: Option<Vec2>,
}

impl WindowSize {
    /// The zoom of the projector in the present window, which follows its size; larger for a view over it.
    pub fn projector_zoom(&self, filled: bool) -> f32 {
        let zoom = self.present.map_or(PROJECTOR_ZOOM, projector_zoom);
        if filled { FILLED_ZOOM * zoom } else { zoom }
    }

    /// To be called in every frame.
    pub fn follow(&mut self, ctx: &Context) {
        let zoom = ctx.zoom_factor();
        self.frames = if (zoom - self.zoom).abs() < 1e-3 { self.frames.saturating_add(1) } else { 0 };
        self.zoom = zoom;
        if self.frames < SETTLED {
            ctx.request_repaint();
            return;
        }
        let (inner, outer, screen, fills_screen) = ctx.input(|input| {
            let view = input.viewport();
            let fills_screen = view.maximized == Some(true) || view.fullscreen == Some(true);
            (view.inner_rect, view.outer_rect, view.monitor_size, fills_screen)
        });
        let page = || cfg!(target_arch = "wasm32").then(|| ctx.content_rect());
        let Some(inner) = inner.or_else(page).map(|rect| rect.size()) else { return };
        if fills_screen || self.wanted.is_none() {
            self.present = Some(inner * zoom);
        }
        if fills_screen {
            return;
        }
        if let Some(wanted) = self.wanted.take() {
            if (inner * zoom - wanted).abs().max_elem() > 1.0 {
                ctx.send_viewport_cmd(ViewportCommand::InnerSize(wanted / zoom));
                self.frames = 0;
            }
            return;
        }
        // with its decoration it may be larger than the screen, which then cuts off the lowest bar
        if let Some(screen) = screen.filter(|_| !self.fitted && self.frames < DECORATED) {
            let outer = outer.map_or(inner, |rect| rect.size()).max(inner);
            if outer.x > screen.x + 1.0 || outer.y > screen.y + 1.0 {
                self.fitted = true;
                ctx.send_viewport_cmd(ViewportCommand::Maximized(true));
            }
        }
        self.size = Some(inner * zoom);
    }
}
