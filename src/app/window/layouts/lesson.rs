//! Tiles of a lesson: only its views, two or three of them side by side.

use eframe::egui;
use egui_tiles::{LinearDir, TileId, Tiles, Tree};

use crate::app::views::View;

use super::trees::{LEFT_SHARE, MAP_SHARE, MECHANISM_SHARE, pair};
use super::{Room, Tiling};

/// Share of the width that the first of two views has in a compact window.
const HALF: f32 = 0.5;
/// Share of the width that views with legends have in a compact window.
const MUCH: f32 = 0.62;

/// Whether a view has legends that need room.
fn is_wide(view: View) -> bool {
    matches!(view, View::Map | View::UpAndDown | View::Basins | View::Spectrum)
}

impl Tiling {
    /// The tiles of a lesson with these views. The left column has the views along the displacement, with the
    /// mechanism on top; if there are views with legends, such as a map, it has only these. In a compact
    /// window all are side by side; the third and later of four or more, and those beside a map, share tabs.
    pub fn of_lesson(views: &[View], room: Room) -> Self {
        let mut tiles = Tiles::default();
        let tree = match room {
            Room::Compact => beside(tiles, views),
            Room::Wide | Room::Large => {
                let is_left = |view: &&View| match views.iter().any(|view| is_wide(*view)) {
                    true => is_wide(**view),
                    false => view.is_along_x(),
                };
                let (mut left, mut right): (Vec<View>, Vec<View>) = views.iter().partition(is_left);
                left.sort_by_key(|view| *view != View::Mechanism);
                if left.is_empty() {
                    std::mem::swap(&mut left, &mut right);
                }
                // two views are side by side, except that the mechanism is above a view with the same axis
                if right.is_empty() && left.len() == 2 && left[0] != View::Mechanism {
                    right = left.split_off(1);
                }
                let share = if left.iter().any(|view| is_wide(*view)) { MAP_SHARE } else { LEFT_SHARE };
                let columns: Vec<TileId> = [left, right]
                    .into_iter()
                    .filter(|views| !views.is_empty())
                    .map(|views| column(&mut tiles, &views))
                    .collect();
                let root = match columns[..] {
                    [left, right] => pair(&mut tiles, LinearDir::Horizontal, left, right, share),
                    _ => tiles.insert_horizontal_tile(columns),
                };
                Tree::new(egui::Id::unique("lesson"), root, tiles)
            }
        };
        Self { tree, room }
    }
}

/// Views one below another. The mechanism, if it is the first of two, gets less than half of the height.
fn column(tiles: &mut Tiles<View>, views: &[View]) -> TileId {
    let panes: Vec<TileId> = views.iter().map(|view| tiles.insert_pane(*view)).collect();
    match (views, &panes[..]) {
        ([View::Mechanism, _], [first, second]) => {
            pair(tiles, LinearDir::Vertical, *first, *second, MECHANISM_SHARE)
        }
        (_, [one]) => *one,
        _ => tiles.insert_vertical_tile(panes),
    }
}

/// Views side by side; the third and later ones share tabs if there are more than three. Beside views with
/// legends all others share tabs.
fn beside(mut tiles: Tiles<View>, views: &[View]) -> Tree<View> {
    let (wide, others): (Vec<View>, Vec<View>) = views.iter().partition(|view| is_wide(**view));
    if !wide.is_empty() && !others.is_empty() {
        let mut tabs = |views: Vec<View>| {
            let panes = views.into_iter().map(|view| tiles.insert_pane(view)).collect();
            tiles.insert_tab_tile(panes)
        };
        let (left, right) = (tabs(wide), tabs(others));
        let root = pair(&mut tiles, LinearDir::Horizontal, left, right, MUCH);
        return Tree::new(egui::Id::unique("compact lesson"), root, tiles);
    }
    let panes: Vec<TileId> = views.iter().map(|view| tiles.insert_pane(*view)).collect();
    let root = match panes[..] {
        [one] => one,
        [left, right] => pair(&mut tiles, LinearDir::Horizontal, left, right, HALF),
        [left, middle, ..] if panes.len() > 3 => {
            let tabs = tiles.insert_tab_tile(panes[2..].to_vec());
            tiles.insert_horizontal_tile(vec![left, middle, tabs])
        }
        _ => tiles.insert_horizontal_tile(panes),
    };
    Tree::new(egui::Id::unique("compact lesson"), root, tiles)
}
