//! Tiles of each layout, and of a lesson: only its views.

use eframe::egui;
use egui_tiles::{Container, Linear, LinearDir, TileId, Tiles, Tree};

use crate::app::views::View;
use crate::scene::Layout;

/// Share of the width that the left column has in the layout Look: 590 of 1030 points.
const LEFT_SHARE: f32 = 590.0 / 1030.0;
const MAP_SHARE: f32 = 640.0 / 1030.0;
/// Share of the height that the mechanism has above the well, and the displacement above the portrait.
const MECHANISM_SHARE: f32 = 0.4;
/// Share of the width that the first column has in the layout Study.
const STUDY_COLUMN: f32 = 0.34;
const HALF: f32 = 0.5;

enum Part {
    Pane(View),
    /// Views that share a place.
    Tabs(Vec<View>),
    /// Equal parts, one below another.
    Rows(Vec<Part>),
    /// Equal parts, side by side.
    Columns(Vec<Part>),
    /// Two parts, and the share of the first one.
    Pair(LinearDir, f32, Box<[Part; 2]>),
}

use Part::{Columns, Pane, Rows, Tabs};

impl Part {
    fn insert(self, tiles: &mut Tiles<View>) -> TileId {
        match self {
            Pane(view) => tiles.insert_pane(view),
            Tabs(views) => {
                let panes = views.into_iter().map(|view| tiles.insert_pane(view)).collect();
                tiles.insert_tab_tile(panes)
            }
            Rows(parts) => {
                let rows = parts.into_iter().map(|part| part.insert(tiles)).collect();
                tiles.insert_vertical_tile(rows)
            }
            Columns(parts) => {
                let columns = parts.into_iter().map(|part| part.insert(tiles)).collect();
                tiles.insert_horizontal_tile(columns)
            }
            Self::Pair(direction, share, parts) => {
                let children = parts.map(|part| part.insert(tiles));
                tiles.insert_container(Container::Linear(Linear::new_binary(direction, children, share)))
            }
        }
    }
}

fn above(first: Part, second: Part, share: f32) -> Part {
    Part::Pair(LinearDir::Vertical, share, Box::new([first, second]))
}

fn beside(first: Part, second: Part, share: f32) -> Part {
    Part::Pair(LinearDir::Horizontal, share, Box::new([first, second]))
}

/// Two parts side by side with the given share of the first one, or any other number of equal parts.
fn columns(parts: Vec<Part>, share: f32) -> Part {
    match <[Part; 2]>::try_from(parts) {
        Ok([first, second]) => beside(first, second, share),
        Err(parts) => Columns(parts),
    }
}

fn tree(id: &str, root: Part) -> Tree<View> {
    let mut tiles = Tiles::default();
    let root = root.insert(&mut tiles);
    Tree::new(egui::Id::unique(id), root, tiles)
}

pub(super) fn views_of(layout: Layout) -> Vec<View> {
    let look =
        [View::Well, View::PhasePortrait, View::Mechanism, View::Displacement, View::Compare].into_iter();
    match layout {
        Layout::Look => look.collect(),
        Layout::Map => vec![View::Map, View::Well, View::Compare],
        Layout::Explore => {
            let motion = [View::Well, View::PhasePortrait, View::Displacement];
            [View::UpAndDown, View::Basins, View::Spectrum].into_iter().chain(motion).collect()
        }
        Layout::Study => look.chain([View::ForceCurve, View::Energy]).collect(),
    }
}

pub(super) fn wide_tree(layout: Layout) -> Tree<View> {
    let mechanism_and_well = || above(Pane(View::Mechanism), Pane(View::Well), MECHANISM_SHARE);
    let displacement = Pane(View::Displacement);
    match layout {
        Layout::Look => {
            let states = Tabs(vec![View::PhasePortrait, View::Compare]);
            tree(
                "wide",
                beside(mechanism_and_well(), above(displacement, states, MECHANISM_SHARE), LEFT_SHARE),
            )
        }
        // the map, with the well and what is compared beside it
        Layout::Map => {
            let right = above(Pane(View::Well), Pane(View::Compare), HALF);
            tree("map", beside(Pane(View::Map), right, MAP_SHARE))
        }
        // the views of studies, with the motion beside them
        Layout::Explore => {
            let studies = Tabs(vec![View::UpAndDown, View::Basins, View::Spectrum]);
            let motion = Tabs(vec![View::PhasePortrait, View::Displacement]);
            tree("explore", beside(studies, above(Pane(View::Well), motion, HALF), MAP_SHARE))
        }
        // views along the displacement in two columns, the others in a third
        Layout::Study => {
            let middle = Rows(vec![Pane(View::PhasePortrait), Pane(View::ForceCurve)]);
            let right = Rows(vec![displacement, Tabs(vec![View::Energy, View::Compare])]);
            tree("wide", beside(mechanism_and_well(), beside(middle, right, HALF), STUDY_COLUMN))
        }
    }
}

/// Two groups of tabs: those that come first, and the mechanism with all others.
pub(super) fn narrow_tree(views: &[View]) -> Tree<View> {
    let has_wide = views.iter().any(|view| is_wide(*view));
    let is_first = |view: &&View| match has_wide {
        true => is_wide(**view),
        false => view.is_along_x() && **view != View::Mechanism,
    };
    let (first, others): (Vec<View>, Vec<View>) = views.iter().partition(is_first);
    let groups = [first, others].into_iter().filter(|group| !group.is_empty());
    let share = if has_wide { MAP_SHARE } else { HALF };
    tree("narrow", columns(groups.map(Tabs).collect(), share))
}

/// Whether a view has legends that need room.
fn is_wide(view: View) -> bool {
    matches!(view, View::Map | View::UpAndDown | View::Basins | View::Spectrum)
}

/// The tiles of a lesson with these views. The left column has the views along the displacement, with the
/// mechanism on top; if there are views with legends, such as a map, it has only these.
pub(super) fn lesson_tree(views: &[View]) -> Tree<View> {
    let has_wide = views.iter().any(|view| is_wide(*view));
    let is_left = |view: &&View| if has_wide { is_wide(**view) } else { view.is_along_x() };
    let (mut left, mut right): (Vec<View>, Vec<View>) = views.iter().partition(is_left);
    left.sort_by_key(|view| *view != View::Mechanism);
    // a fourth view shares the place of the motion over time
    if left.len() > 2 && right.len() == 1 {
        right.extend(left.split_off(2));
        let sides = columns(vec![column(&left), Tabs(right)], LEFT_SHARE);
        return tree("lesson", sides);
    }
    if left.is_empty() {
        std::mem::swap(&mut left, &mut right);
    }
    // two views are side by side, except that the mechanism is above a view with the same axis
    if right.is_empty() && left.len() == 2 && left[0] != View::Mechanism {
        right = left.split_off(1);
    }
    let share = if left.iter().any(|view| is_wide(*view)) { MAP_SHARE } else { LEFT_SHARE };
    let sides = [left, right].into_iter().filter(|views| !views.is_empty());
    tree("lesson", columns(sides.map(|views| column(&views)).collect(), share))
}

/// Views one below another. The mechanism, if it is the first of two, gets less than half of the height.
fn column(views: &[View]) -> Part {
    match views {
        [View::Mechanism, second] => above(Pane(View::Mechanism), Pane(*second), MECHANISM_SHARE),
        [one] => Pane(*one),
        _ => Rows(views.iter().copied().map(Pane).collect()),
    }
}
