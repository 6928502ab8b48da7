//! Tiles of the views in each arrangement.

use std::collections::HashMap;

use eframe::egui::{self, Stroke, Ui, WidgetText};
use egui_tiles::{Container, ResizeState, SimplificationOptions, Tabs, Tile, TileId, Tree, UiResponse};

use crate::app::ui::style::{GAP, NARROW_BELOW};
use crate::app::views::{View, ViewContext};
use crate::scene::Layout;

use super::card::{Answer, Title, card_ui};

use trees::{lesson_tree, narrow_tree, views_of, wide_tree};

mod trees;

/// Size class of the window.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Room {
    /// The views are two groups of tabs, and the controls open by a button.
    Narrow,
    /// The views have tiles beside the controls.
    Wide,
}

impl Room {
    /// The size class of a window of this width in points.
    pub fn of(width: f32) -> Self {
        if width < NARROW_BELOW { Self::Narrow } else { Self::Wide }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arrangement {
    /// A built-in arrangement.
    Layout(Layout),
    /// The arrangement that the user has made.
    Custom,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Tiling {
    tree: Tree<View>,
    room: Room,
    /// Whether surveys are hidden while a lesson covers them.
    hides_surveys: bool,
}

impl Tiling {
    pub fn new(layout: Layout, room: Room) -> Self {
        let tree = match room {
            Room::Narrow => narrow_tree(&views_of(layout)),
            Room::Wide => wide_tree(layout),
        };
        Self { tree, room, hides_surveys: false }
    }

    pub fn of_lesson(views: &[View], room: Room) -> Self {
        let tree = if room == Room::Narrow { narrow_tree(views) } else { lesson_tree(views) };
        Self { tree, room, hides_surveys: false }
    }

    /// Leaves the room of a map or another survey to the other views while it is `covered`, if there are any.
    pub fn cover_surveys(&mut self, covered: bool) {
        if covered == self.hides_surveys {
            return;
        }
        let shown = |view: &View| self.shows(*view);
        let (surveys, others): (Vec<View>, Vec<View>) =
            View::ALL.into_iter().filter(|view| !covered || shown(view)).partition(|view| view.is_survey());
        if covered && others.is_empty() {
            return;
        }
        self.hides_surveys = covered;
        for id in surveys.iter().filter_map(|view| self.tree.tiles.find_pane(view)).collect::<Vec<_>>() {
            self.tree.set_visible(id, !covered);
        }
    }

    /// The tiles of the custom arrangement as they were saved; in a narrow window, the same views as tabs.
    pub fn custom(saved: &Tree<View>, room: Room) -> Self {
        let tree = if room == Room::Narrow {
            let is_shown = |view: &View| saved.tiles.find_pane(view).is_some_and(|id| saved.is_visible(id));
            let views: Vec<View> = View::ALL.into_iter().filter(is_shown).collect();
            narrow_tree(&views)
        } else {
            saved.clone()
        };
        Self { tree, room, hides_surveys: false }
    }

    /// The present tiles, to be saved; `None` in a narrow window.
    pub fn tree_to_save(&self) -> Option<&Tree<View>> {
        (self.room == Room::Wide).then_some(&self.tree)
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

    /// The view with the largest place on the screen.
    pub fn largest(&self) -> View {
        let area = |view: &View| self.place_of(*view).map_or(0.0, |place| place.area());
        View::ALL.into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or(View::Well)
    }

    /// Whether a view is shown, if only as a tab behind another.
    pub fn shows(&self, view: View) -> bool {
        self.tree.tiles.find_pane(&view).is_some_and(|id| self.tree.is_visible(id))
    }

    /// Shows or hides a view. A view without a tile joins those of its kind, in a narrow window as a tab.
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
        if shown && self.room == Room::Narrow {
            self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(pane) if *pane == view));
        }
    }

    /// Shows a view. A view without a tile becomes a tab beside `other`, if that is shown among tabs.
    pub fn show_beside(&mut self, view: View, other: View) {
        // gives new tiles their tabs
        self.tree.simplify(&simplification());
        let tiles = &mut self.tree.tiles;
        let shown = tiles.find_pane(&other).filter(|id| tiles.is_visible(*id));
        let is_tabs = |id: &TileId| matches!(tiles.get_container(*id), Some(Container::Tabs(_)));
        let place = shown.and_then(|id| tiles.parent_of(id)).filter(is_tabs);
        if let Some(place) = place.filter(|_| tiles.find_pane(&view).is_none()) {
            let id = tiles.insert_pane(view);
            if let Some(Tile::Container(container)) = tiles.get_mut(place) {
                container.add_child(id);
            }
        }
        self.show(view, true);
        self.tree.make_active(|_, tile| matches!(tile, Tile::Pane(pane) if *pane == view));
    }

    /// Brings a view that is shown to the front of its tabs.
    pub fn show_in_front(&mut self, view: View) {
        self.bring_to_front(self.tree.tiles.find_pane(&view));
    }

    pub fn has_tabs(&self) -> bool {
        self.tab_after(None).is_some()
    }

    /// The next tab in the group of `view`, or else in the first group with several tabs.
    fn tab_after(&self, view: Option<View>) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        view.into_iter().chain(View::ALL).find_map(|view| {
            let place = tiles.parent_of(tiles.find_pane(&view)?)?;
            let Some(Tile::Container(Container::Tabs(tabs))) = tiles.get(place) else { return None };
            let shown: Vec<TileId> =
                tabs.children.iter().copied().filter(|id| tiles.is_visible(*id)).collect();
            let active = shown.iter().position(|id| Some(*id) == tabs.active)?;
            (shown.len() > 1).then(|| shown[(active + 1) % shown.len()])
        })
    }

    /// Brings the next tab to the front, in the group of `view` or else in the first group with several tabs.
    pub fn next_tab(&mut self, view: Option<View>) {
        self.bring_to_front(self.tab_after(view));
    }

    fn bring_to_front(&mut self, tab: Option<TileId>) {
        if let Some(tab) = tab
            && let Some(place) = self.tree.tiles.parent_of(tab)
            && let Some(Tile::Container(Container::Tabs(tabs))) = self.tree.tiles.get_mut(place)
        {
            tabs.set_active(tab);
        }
    }

    /// The container of the views of the same kind, along the displacement or not. In a narrow window the
    /// mechanism is among the others.
    fn place_for(&self, view: View) -> Option<TileId> {
        let tiles = &self.tree.tiles;
        let apart = |view: &View| self.room == Room::Narrow && *view == View::Mechanism;
        let is_along = |view: &View| view.is_along_x() && !apart(view);
        let alike = |other: &&View| is_along(other) == is_along(&view);
        let neighbour = View::ALL.iter().filter(alike).find_map(|other| tiles.find_pane(other))?;
        let mut place = tiles.parent_of(neighbour)?;
        while self.room == Room::Wide
            && let Some(Container::Tabs(_)) = tiles.get_container(place)
        {
            place = tiles.parent_of(place)?;
        }
        Some(place)
    }

    /// Draws the views in their cards; `fill` is set if a view is to fill the window.
    pub fn ui(&mut self, ui: &mut Ui, context: &mut ViewContext<'_>, fill: &mut Option<View>) {
        // gives new tiles their tabs
        self.tree.simplify(&simplification());
        let mut behavior = Behavior { titles: self.titles(), context, fill, chosen: None };
        self.tree.ui(&mut behavior, ui);
        let chosen = behavior.chosen;
        self.bring_to_front(chosen.and_then(|view| self.tree.tiles.find_pane(&view)));
    }

    /// The titles in the card of each view that is in front.
    fn titles(&self) -> HashMap<TileId, Vec<Title>> {
        let title = |id: &TileId| {
            let view = *self.tree.tiles.get_pane(id).filter(|_| self.tree.is_visible(*id))?;
            Some(Title { view, id: id.egui_id(self.tree.id()) })
        };
        let group = |tile: &Tile<View>| {
            let Tile::Container(Container::Tabs(tabs)) = tile else { return None };
            let titles: Vec<Title> = tabs.children.iter().filter_map(title).collect();
            Some((tabs.next_active(&self.tree.tiles)?, titles))
        };
        self.tree.tiles.iter().filter_map(|(_, tile)| group(tile)).collect()
    }
}

/// Every view keeps its title.
fn simplification() -> SimplificationOptions {
    SimplificationOptions { all_panes_must_have_tabs: true, ..SimplificationOptions::default() }
}

struct Behavior<'a, 'b> {
    titles: HashMap<TileId, Vec<Title>>,
    context: &'a mut ViewContext<'b>,
    fill: &'a mut Option<View>,
    /// The view whose title was clicked.
    chosen: Option<View>,
}

impl egui_tiles::Behavior<View> for Behavior<'_, '_> {
    fn tab_title_for_pane(&mut self, view: &View) -> WidgetText {
        view.name().into()
    }

    fn pane_ui(&mut self, ui: &mut Ui, id: TileId, view: &mut View) -> UiResponse {
        let titles = self.titles.get(&id).map_or(&[][..], Vec::as_slice);
        let Answer { chosen, fills } = card_ui(ui, titles, *view, self.context);
        self.chosen = chosen.or(self.chosen);
        if fills {
            *self.fill = Some(*view);
        }
        UiResponse::None
    }

    /// The titles stand in the cards.
    fn is_tab_bar_visible(&self, _: TileId, _: &Tabs) -> bool {
        false
    }

    fn resize_stroke(&self, _: &egui::Style, state: ResizeState) -> Stroke {
        match state {
            ResizeState::Idle => Stroke::NONE,
            ResizeState::Hovering | ResizeState::Dragging => self.context.style.focus_stroke(),
        }
    }

    fn gap_width(&self, _: &egui::Style) -> f32 {
        GAP
    }

    fn min_size(&self) -> f32 {
        60.0
    }

    fn simplification_options(&self) -> SimplificationOptions {
        simplification()
    }
}
