//! Tiles of a lesson: its views alone, two or three beside each other.

use eframe::egui;
use egui_tiles::{LinearDir, TileId, Tiles, Tree};

use crate::app::views::View;

use super::{LEFT_SHARE, MAP_SHARE, MECHANISM_SHARE, Room, Tiling, pair};

/// Share of the width that the first of two views has where room is short.
const HALF: f32 = 0.5;

impl Tiling {
    /// The tiles of a lesson with these views. What has the displacement along it stands on the left, the
    /// mechanism over the others; a map has the left for itself. Where room is short all stand side by side,
    /// from the fourth on as tabs.
    pub fn of_lesson(views: &[View], room: Room) -> Self {
        let mut tiles = Tiles::default();
        let tree = match room {
            Room::Compact => beside(tiles, views),
            Room::Wide | Room::Large => {
                let is_left = |view: &&View| match views.contains(&View::Map) {
                    true => **view == View::Map,
                    false => view.is_along_x(),
                };
                let (mut left, mut right): (Vec<View>, Vec<View>) = views.iter().partition(is_left);
                left.sort_by_key(|view| *view != View::Mechanism);
                if left.is_empty() {
                    std::mem::swap(&mut left, &mut right);
                }
                // two alone stand side by side, but the mechanism over what it shares its axis with
                if right.is_empty() && left.len() == 2 && left[0] != View::Mechanism {
                    right = left.split_off(1);
                }
                let share = if left == [View::Map] { MAP_SHARE } else { LEFT_SHARE };
                let columns: Vec<TileId> = [left, right]
                    .into_iter()
                    .filter(|own| !own.is_empty())
                    .map(|own| column(&mut tiles, &own))
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

/// Views below each other; the mechanism, which is first, is lower than the other.
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

/// Views side by side, from the fourth on behind the third.
fn beside(mut tiles: Tiles<View>, views: &[View]) -> Tree<View> {
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
