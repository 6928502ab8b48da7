//! Which views stand where? Trees of tiles for each layout, and for windows that are as small as a projector's.

use eframe::egui::{self, Ui, WidgetText};
use egui_tiles::{
    Container, Linear, LinearDir, SimplificationOptions, Tile, TileId, Tiles, Tree, UiResponse,
};

use crate::scene::Layout;

use super::style::BODY;
use super::views::{View, ViewContext, view_ui};

/// Shares of the window in the layout Look: left of 1030 points 590, of 584 points of height 220 on the left and 340
/// on the right.
const LEFT_SHARE: f32 = 590.0 / 1030.0;
const MECHANISM_SHARE: f32 = 220.0 / 584.0;
const DISPLACEMENT_SHARE: f32 = 340.0 / 584.0;

/// Share of the width that the map has in the layout Map.
const MAP_SHARE: f32 = 640.0 / 1030.0;

/// The tiles of one layout.
pub struct Tiling {
    tree: Tree<View>,
    compact: bool,
}

impl Tiling {
    /// The tiles of a layout; `compact` for a small window.
    pub fn new(layout: Layout, compact: bool) -> Self {
        let tree = match (layout, compact) {
            (Layout::Map, false) => map_tree(),
            (Layout::Map, true) => compact_map_tree(),
            (_, false) => wide_tree(layout),
            (_, true) => compact_tree(),
        };
        Self { tree, compact }
    }

    /// Whether it is the one for a small window.
    pub fn is_compact(&self) -> bool {
        self.compact
    }

    /// Whether a view is shown somewhere.
    pub fn shows(&self, view: View) -> bool {
        self.tree.tiles.find_pane(&view).is_some_and(|id| self.tree.is_visible(id))
    }

    /// Shows or hides a view.
    pub fn show(&mut self, view: View, shown: bool) {
        match self.tree.tiles.find_pane(&view) {
            Some(id) => self.tree.set_visible(id, shown),
            None if shown => {
                let id = self.tree.tiles.insert_pane(view);
                let root = self.tree.root().and_then(|root| self.tree.tiles.get_mut(root));
                if let Some(Tile::Container(container)) = root {
                    container.add_child(id);
                }
            }
            None => {}
        }
    }

    /// Draws the views. Whether one changed something; `fill` is set where a view asks for the whole window.
    pub fn ui(&mut self, ui: &mut Ui, context: &mut ViewContext<'_>, fill: &mut Option<View>) -> bool {
        let mut behavior = Behavior { context, changed: false, fill };
        self.tree.ui(&mut behavior, ui);
        behavior.changed
    }
}

fn wide_tree(_: Layout) -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let (mechanism, well) = (pane(View::Mechanism), pane(View::Well));
    let (displacement, card) = (pane(View::Displacement), pane(View::BeforeNow));
    let left = pair(&mut tiles, LinearDir::Vertical, mechanism, well, MECHANISM_SHARE);
    let right = pair(&mut tiles, LinearDir::Vertical, displacement, card, DISPLACEMENT_SHARE);
    let root = pair(&mut tiles, LinearDir::Horizontal, left, right, LEFT_SHARE);
    Tree::new(egui::Id::unique("wide"), root, tiles)
}

fn compact_tree() -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let (well, mechanism) = (pane(View::Well), pane(View::Mechanism));
    let (displacement, card) = (pane(View::Displacement), pane(View::BeforeNow));
    let left = tiles.insert_tab_tile(vec![well, mechanism]);
    let right = tiles.insert_tab_tile(vec![displacement, card]);
    let root = pair(&mut tiles, LinearDir::Horizontal, left, right, LEFT_SHARE);
    Tree::new(egui::Id::unique("compact"), root, tiles)
}

/// The map, with the well and the card beside it.
fn map_tree() -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let (map, well, card) = (pane(View::Map), pane(View::Well), pane(View::BeforeNow));
    let right = pair(&mut tiles, LinearDir::Vertical, well, card, DISPLACEMENT_SHARE);
    let root = pair(&mut tiles, LinearDir::Horizontal, map, right, MAP_SHARE);
    Tree::new(egui::Id::unique("map"), root, tiles)
}

fn compact_map_tree() -> Tree<View> {
    let mut tiles = Tiles::default();
    let views = [View::Map, View::Well, View::BeforeNow].map(|view| tiles.insert_pane(view));
    let root = tiles.insert_tab_tile(views.to_vec());
    Tree::new(egui::Id::unique("compact map"), root, tiles)
}

fn pair(tiles: &mut Tiles<View>, direction: LinearDir, first: TileId, second: TileId, share: f32) -> TileId {
    let linear = Linear::new_binary(direction, [first, second], share);
    tiles.insert_container(Container::Linear(linear))
}

struct Behavior<'a, 'b> {
    context: &'a mut ViewContext<'b>,
    changed: bool,
    fill: &'a mut Option<View>,
}

impl egui_tiles::Behavior<View> for Behavior<'_, '_> {
    fn tab_title_for_pane(&mut self, view: &View) -> WidgetText {
        egui::RichText::new(view.name()).size(BODY).into()
    }

    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, view: &mut View) -> UiResponse {
        self.changed |= view_ui(ui, *view, self.context);
        UiResponse::None
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        26.0
    }

    fn top_bar_right_ui(
        &mut self,
        tiles: &Tiles<View>,
        ui: &mut Ui,
        _: TileId,
        tabs: &egui_tiles::Tabs,
        _: &mut f32,
    ) {
        let Some(view) = tabs.active.and_then(|id| tiles.get_pane(&id)) else { return };
        let name = format!("fill the window with {}", view.name());
        let hover = "This view over the whole window (Z)";
        if super::widgets::icon_button_ui(ui, super::widgets::Icon::Fill, 22.0, &name, hover).clicked() {
            *self.fill = Some(*view);
        }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        4.0
    }

    fn min_size(&self) -> f32 {
        60.0
    }

    fn simplification_options(&self) -> SimplificationOptions {
        // every view keeps its title
        SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
    }
}
