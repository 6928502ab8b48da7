//! Tiles of the views in each arrangement.

use eframe::egui::{self, Response, Ui, Vec2, WidgetText};
use egui_tiles::{Container, SimplificationOptions, Tabs, Tile, TileId, Tiles, Tree, UiResponse};

use crate::app::ui::style::{BODY, COMPACT_BELOW, LARGE_FROM, LEAST};
use crate::app::ui::widgets::{Icon, icon_button_ui};
use crate::app::views::{Memory, View, ViewContext, view_ui};
use crate::scene::Layout;

use trees::{compact_lesson_tree, compact_tree, lesson_tree, tabs_tree, views_of, wide_tree};

mod trees;

const TITLE_MARGIN: f32 = 6.0;
/// Width in points of the buttons beside the titles.
const BUTTONS: f32 = 58.0;

/// Size class of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Room {
    /// As on a projector: two groups of tabs.
    Compact,
    /// Four tiles, or six.
    Wide,
    /// One more tile than a wide window.
    Large,
}

impl Room {
    /// The size class of a window of `size` in points.
    pub fn of(size: Vec2) -> Self {
        if size.x < COMPACT_BELOW {
            Self::Compact
        } else if size.x > LARGE_FROM.x && size.y > LARGE_FROM.y {
            Self::Large
        } else {
            Self::Wide
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// One that comes with the program.
    Layout(Layout),
    /// The one that the user has made.
    Custom,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Tiling {
    tree: Tree<View>,
    room: Room,
}

impl Tiling {
    pub fn new(layout: Layout, room: Room) -> Self {
        let tree = match room {
            Room::Compact if matches!(layout, Layout::Map | Layout::Explore) => tabs_tree(&views_of(layout)),
            Room::Compact => compact_tree(&views_of(layout)),
            Room::Wide | Room::Large => wide_tree(layout, room == Room::Large),
        };
        Self { tree, room }
    }

    pub fn of_lesson(views: &[View], room: Room) -> Self {
        let tree = if room == Room::Compact { compact_lesson_tree(views) } else { lesson_tree(views) };
        Self { tree, room }
    }

    /// The tiles of the custom arrangement as they were saved; in a compact window, the same views as tabs.
    pub fn custom(saved: &Tree<View>, room: Room) -> Self {
        let tree = if room == Room::Compact {
            let view = |(id, tile): (&TileId, &Tile<View>)| match tile {
                Tile::Pane(view) => saved.is_visible(*id).then_some(*view),
                Tile::Container(_) => None,
            };
            let shown: Vec<View> = saved.tiles.iter().filter_map(view).collect();
            compact_tree(&View::ALL.into_iter().filter(|view| shown.contains(view)).collect::<Vec<_>>())
        } else {
            saved.clone()
        };
        Self { tree, room }
    }

    /// The present tiles, to be saved; `None` in a compact window.
    pub fn tree_to_save(&self) -> Option<&Tree<View>> {
        (self.room != Room::Compact).then_some(&self.tree)
    }

    /// The size class of the window that it was made for.
    pub fn room(&self) -> Room {
        self.room
    }

    /// The rectangle of a view on the screen; `None` if it is not visible.
    pub fn place_of(&self, view: View) -> Option<egui::Rect> {
        let id = self.tree.tiles.find_pane(&view)?;
        let is_visible = self.tree.active_tiles().contains(&id);
        is_visible.then(|| self.tree.tiles.rect(id)).flatten()
    }

    /// Whether a view is shown, if only as a tab behind another.
    pub fn shows(&self, view: View) -> bool {
        self.tree.tiles.find_pane(&view).is_some_and(|id| self.tree.is_visible(id))
    }

    /// Shows or hides a view. A view without a tile joins those of its kind, in a compact window as a tab.
    pub fn show(&mut self, view: View, shown: bool) {
        match self.tree.tiles.find_pane(&view) {
            Some(id) => self.tree.set_visible(id, shown),
            None if shown => {
                let id = self.tree.tiles.insert_pane(view);
                let place = self.place_for(view).or(self.tree.root());
                if let Some(Tile::Container(container)) = place.and_then(|id| self.tree.tiles.get_mut(id)) {
                    container.add_child(id);
                }
            }
            None => return,
        }
        if shown && self.room == Room::Compact {
            self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(pane) if *pane == view));
        }
    }

    /// Shows a view. A view without a tile becomes a tab beside `other`, if that is shown among tabs.
    pub fn show_beside(&mut self, view: View, other: View) {
        // new tiles have no tabs until they are drawn
        self.tree.simplify(&simplification());
        let tiles = &mut self.tree.tiles;
        let shown = tiles.find_pane(&other).filter(|id| tiles.is_visible(*id));
        let place = shown.and_then(|id| tiles.parent_of(id));
        if tiles.find_pane(&view).is_none()
            && let Some(place) =
                place.filter(|id| matches!(tiles.get_container(*id), Some(Container::Tabs(_))))
        {
            let id = tiles.insert_pane(view);
            if let Some(Tile::Container(container)) = tiles.get_mut(place) {
                container.add_child(id);
            }
        }
        self.show(view, true);
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(pane) if *pane == view));
    }

    pub fn has_tabs(&self) -> bool {
        self.tab_after(None).is_some()
    }

    /// The next tab and its group: that of `view`, or else the first group with several tabs.
    fn tab_after(&self, view: Option<View>) -> Option<(TileId, TileId)> {
        let tiles = &self.tree.tiles;
        view.into_iter().chain(View::ALL).find_map(|view| {
            let place = tiles.parent_of(tiles.find_pane(&view)?)?;
            let Some(Tile::Container(Container::Tabs(tabs))) = tiles.get(place) else { return None };
            let shown: Vec<TileId> =
                tabs.children.iter().copied().filter(|id| tiles.is_visible(*id)).collect();
            let active = shown.iter().position(|id| Some(*id) == tabs.active)?;
            (shown.len() > 1).then(|| (place, shown[(active + 1) % shown.len()]))
        })
    }

    /// Brings the next tab to the front, in the group of `view` or else in the first group with several tabs.
    pub fn next_tab(&mut self, view: Option<View>) {
        if let Some((place, tab)) = self.tab_after(view)
            && let Some(Tile::Container(Container::Tabs(tabs))) = self.tree.tiles.get_mut(place)
        {
            tabs.set_active(tab);
        }
    }

    /// The container of the views of the same kind, along the displacement or not. In a compact window the
    /// mechanism is among the others.
    fn place_for(&self, view: View) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        let apart = |view: &View| self.room == Room::Compact && *view == View::Mechanism;
        let is_along = |view: &View| view.is_along_x() && !apart(view);
        let alike = |other: &&View| is_along(other) == is_along(&view);
        let neighbour = View::ALL.iter().filter(alike).find_map(|other| tiles.find_pane(other))?;
        let mut place = tiles.parent_of(neighbour)?;
        while self.room != Room::Compact
            && let Some(Container::Tabs(_)) = tiles.get_container(place)
        {
            place = tiles.parent_of(place)?;
        }
        Some(place)
    }

    /// The greatest text size at which the titles of every group of tabs fit side by side.
    fn title_size(&self, ui: &Ui) -> f32 {
        let width = |id: &TileId| {
            let view = self.tree.tiles.get_pane(id).filter(|_| self.tree.is_visible(*id))?;
            let (name, font) = (view.name().to_owned(), egui::FontId::proportional(BODY));
            Some(ui.painter().layout_no_wrap(name, font, egui::Color32::PLACEHOLDER).size().x)
        };
        let fitting = |(id, tile): (&TileId, &Tile<View>)| {
            let Tile::Container(Container::Tabs(tabs)) = tile else { return None };
            let widths: Vec<f32> = tabs.children.iter().filter_map(width).collect();
            let buttons = if self.room == Room::Compact { BUTTONS } else { 1.7 * BUTTONS };
            let room =
                self.tree.tiles.rect(*id)?.width() - buttons - 2.0 * TITLE_MARGIN * widths.len() as f32;
            Some(BODY * room / widths.iter().sum::<f32>().max(1.0))
        };
        let least = self.tree.tiles.iter().filter_map(fitting).fold(BODY, f32::min);
        least.max(LEAST)
    }

    /// Draws the views; `fill` is set if a view is to fill the window.
    pub fn ui(&mut self, ui: &mut Ui, context: &mut ViewContext<'_>, fill: &mut Option<View>) {
        let title = self.title_size(ui);
        let mut behavior = Behavior { context, fill, title, room: self.room };
        self.tree.ui(&mut behavior, ui);
    }
}

/// Every view keeps its title.
fn simplification() -> SimplificationOptions {
    SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
}

struct Behavior<'a, 'b> {
    context: &'a mut ViewContext<'b>,
    fill: &'a mut Option<View>,
    title: f32,
    room: Room,
}

/// The button that holds the axes of a view; `None` if it has no axes.
pub(super) fn hold_ui(ui: &mut Ui, view: View, memory: &mut Memory) -> Option<Response> {
    let (icon, name, hover) = match memory.are_axes_held(view)? {
        true => (Icon::Held, "let go of the axes of", "The axes are held. A click lets go of them (L)."),
        false => (Icon::Free, "hold the axes of", "Hold the axes as they are, whatever comes (L)."),
    };
    let response = icon_button_ui(ui, icon, 22.0, &format!("{name} {}", view.name()), hover);
    if response.clicked() {
        memory.hold_axes(view);
    }
    Some(response)
}

impl egui_tiles::Behavior<View> for Behavior<'_, '_> {
    fn tab_title_for_pane(&mut self, view: &View) -> WidgetText {
        egui::RichText::new(view.name()).size(self.title).into()
    }

    fn tab_title_spacing(&self, _: &egui::Visuals) -> f32 {
        TITLE_MARGIN
    }

    fn pane_ui(&mut self, ui: &mut Ui, _: TileId, view: &mut View) -> UiResponse {
        view_ui(ui, *view, self.context);
        UiResponse::None
    }

    fn tab_bar_height(&self, _: &egui::Style) -> f32 {
        26.0
    }

    fn on_tab_button(&mut self, tiles: &mut Tiles<View>, id: TileId, button: Response) -> Response {
        match tiles.get_pane(&id) {
            Some(view) => button.on_hover_text(view.about()),
            None => button,
        }
    }

    fn top_bar_right_ui(&mut self, tiles: &Tiles<View>, ui: &mut Ui, _: TileId, tabs: &Tabs, _: &mut f32) {
        let Some(view) = tabs.active.and_then(|id| tiles.get_pane(&id)) else { return };
        let name = format!("fill the window with {}", view.name());
        let hover = "This view over the whole window (Z)";
        let fill = icon_button_ui(ui, Icon::Fill, 22.0, &name, hover);
        if fill.clicked() {
            *self.fill = Some(*view);
        }
        let name = format!("figure of {}", view.name());
        let hover = "Save a figure of this view (Ctrl+E)";
        if self.room != Room::Compact && icon_button_ui(ui, Icon::Figure, 22.0, &name, hover).clicked() {
            self.context.memory.figure = Some(*view);
        }
        let hold = hold_ui(ui, *view, self.context.memory);
        // keys act on the view whose buttons have the focus
        if fill.has_focus() || hold.is_some_and(|button| button.has_focus()) {
            self.context.memory.hovered = Some(*view);
        }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        4.0
    }

    fn min_size(&self) -> f32 {
        60.0
    }

    fn simplification_options(&self) -> SimplificationOptions {
        simplification()
    }
}
