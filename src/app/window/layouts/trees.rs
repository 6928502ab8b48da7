//! Tiles of each layout.

use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, TileId, Tiles, Tree};

use crate::app::views::View;
use crate::scene::Layout;

/// Share of the width that the left column has in the layout Look: 590 of 1030 points.
pub(super) const LEFT_SHARE: f32 = 590.0 / 1030.0;
/// Share of the height that the displacement has in the right column: 340 of 584 points.
const DISPLACEMENT_SHARE: f32 = 340.0 / 584.0;

/// Share of the width that the map has in the layout Map.
pub(super) const MAP_SHARE: f32 = 640.0 / 1030.0;

/// Share of the height that the mechanism has above the well.
pub(super) const MECHANISM_SHARE: f32 = 0.4;

/// Share of the width that the first column has in the layout Study.
const STUDY_COLUMN: f32 = 0.34;
/// Share of the width that the first of two groups has in a compact window.
const COMPACT_SHARE: f32 = 0.5;

pub(super) fn views_of(layout: Layout) -> Vec<View> {
    let look = [View::Well, View::Mechanism, View::Displacement, View::BeforeNow];
    let study = [View::PhasePortrait, View::ForceCurve, View::Energy];
    match layout {
        Layout::Look => look.to_vec(),
        Layout::Map => vec![View::Map, View::Well, View::BeforeNow],
        Layout::Explore => {
            vec![
                View::UpAndDown,
                View::Basins,
                View::Spectrum,
                View::Well,
                View::PhasePortrait,
                View::Displacement,
            ]
        }
        Layout::Study => look.into_iter().chain(study).collect(),
    }
}

pub(super) fn wide_tree(layout: Layout, large: bool) -> Tree<View> {
    match layout {
        Layout::Look => look_tree(large),
        Layout::Map => map_tree(),
        Layout::Explore => explore_tree(),
        Layout::Study => study_tree(large),
    }
}

fn look_tree(large: bool) -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let (mechanism, well) = (pane(View::Mechanism), pane(View::Well));
    let (displacement, card) = (pane(View::Displacement), pane(View::BeforeNow));
    let phase = large.then(|| pane(View::PhasePortrait));
    let left = pair(&mut tiles, LinearDir::Vertical, mechanism, well, MECHANISM_SHARE);
    let right = match phase {
        Some(phase) => tiles.insert_vertical_tile(vec![displacement, phase, card]),
        None => pair(&mut tiles, LinearDir::Vertical, displacement, card, DISPLACEMENT_SHARE),
    };
    let root = pair(&mut tiles, LinearDir::Horizontal, left, right, LEFT_SHARE);
    Tree::new(egui::Id::unique("wide"), root, tiles)
}

/// Views along the displacement in two columns, the others in a third.
fn study_tree(large: bool) -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let (mechanism, well) = (pane(View::Mechanism), pane(View::Well));
    let (phase, force) = (pane(View::PhasePortrait), pane(View::ForceCurve));
    let (displacement, energy, card) = (pane(View::Displacement), pane(View::Energy), pane(View::BeforeNow));
    let left = pair(&mut tiles, LinearDir::Vertical, mechanism, well, MECHANISM_SHARE);
    let middle = tiles.insert_vertical_tile(vec![phase, force]);
    let right = if large {
        tiles.insert_vertical_tile(vec![displacement, energy, card])
    } else {
        let tabs = tiles.insert_tab_tile(vec![energy, card]);
        tiles.insert_vertical_tile(vec![displacement, tabs])
    };
    let others = pair(&mut tiles, LinearDir::Horizontal, middle, right, 0.5);
    let root = pair(&mut tiles, LinearDir::Horizontal, left, others, STUDY_COLUMN);
    Tree::new(egui::Id::unique("wide"), root, tiles)
}

/// Two groups of tabs: the views along the displacement except the mechanism, and the mechanism with the
/// other views.
pub(super) fn compact_tree(views: &[View]) -> Tree<View> {
    let mut tiles = Tiles::default();
    let is_first = |view: &&View| view.is_along_x() && **view != View::Mechanism;
    let (along, others): (Vec<View>, Vec<View>) = views.iter().partition(is_first);
    let mut groups: Vec<TileId> = Vec::new();
    for group in [along, others] {
        let panes: Vec<TileId> = group.into_iter().map(|view| tiles.insert_pane(view)).collect();
        if !panes.is_empty() {
            groups.push(tiles.insert_tab_tile(panes));
        }
    }
    let root = match groups[..] {
        [left, right] => pair(&mut tiles, LinearDir::Horizontal, left, right, COMPACT_SHARE),
        _ => tiles.insert_horizontal_tile(groups),
    };
    Tree::new(egui::Id::unique("compact"), root, tiles)
}

/// One view at a time over the whole width.
pub(super) fn tabs_tree(views: &[View]) -> Tree<View> {
    let mut tiles = Tiles::default();
    let panes = views.iter().map(|view| tiles.insert_pane(*view)).collect();
    let root = tiles.insert_tab_tile(panes);
    Tree::new(egui::Id::unique("compact map"), root, tiles)
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

/// The views of studies, with the motion beside them.
fn explore_tree() -> Tree<View> {
    let mut tiles = Tiles::default();
    let mut pane = |view| tiles.insert_pane(view);
    let studies = [View::UpAndDown, View::Basins, View::Spectrum].map(&mut pane);
    let (well, phase, displacement) = (pane(View::Well), pane(View::PhasePortrait), pane(View::Displacement));
    let studies = tiles.insert_tab_tile(studies.to_vec());
    let tabs = tiles.insert_tab_tile(vec![phase, displacement]);
    let right = pair(&mut tiles, LinearDir::Vertical, well, tabs, 0.45);
    let root = pair(&mut tiles, LinearDir::Horizontal, studies, right, MAP_SHARE);
    Tree::new(egui::Id::unique("explore"), root, tiles)
}

pub(super) fn pair(
    tiles: &mut Tiles<View>,
    direction: LinearDir,
    first: TileId,
    second: TileId,
    share: f32,
) -> TileId {
    let linear = Linear::new_binary(direction, [first, second], share);
    tiles.insert_container(Container::Linear(linear))
}
