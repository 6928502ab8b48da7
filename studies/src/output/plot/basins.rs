//! Picture of basins of attraction: the attractor of each start as colour, paler where it is not sure, and
//! the states of the attractors.

use super::axis::PlotAxis;
use super::cells::{Colours, Shade, Shades};
use super::chart::{Chart, Marks, Panel};
use super::drawn::Drawn;
use super::quantity::suited_unit;
use super::role::Role;
use super::style::{COOL, KINDS, WARM};
use crate::dynamics::Regime;
use crate::numeric::short;
use crate::study::{Answer, Attractor, BasinMap, Edges, Shares, Starts, Table};
use crate::sweep::{MAX_PICTURE_CELLS, NoPicture};

/// Number of attractors that the legend names, those with the largest shares.
const MAX_NAMED: usize = 9;

/// Whether a map of these starts can be drawn.
#[doc(hidden)]
pub fn can_show_starts(starts: &Starts) -> Result<(), NoPicture> {
    let count = starts.count() as u64;
    if count > MAX_PICTURE_CELLS { Err(NoPicture::Starts(count)) } else { Ok(()) }
}

/// The picture of a map of basins, of the fields of a [`BasinsAnswer`](crate::questions::BasinsAnswer), or of
/// a map that is still incomplete.
pub fn basins_chart(basins: &BasinMap, answer: &Answer) -> Chart {
    let starts = basins.starts();
    let all = || (0..starts.count()).map(|row| starts.at(row));
    let (across, up) = match starts.axes() {
        Some((x_mm, v)) => (Edges::new(x_mm).ends(), Edges::new(v).ends()),
        None => {
            let ends = |axis: PlotAxis| (axis.low, axis.high);
            let across = ends(PlotAxis::around(all().map(|start| start.0), 0.02, ""));
            (across, ends(PlotAxis::around(all().map(|start| start.1), 0.02, "")))
        }
    };
    let rightward = PlotAxis::between(across.0, across.1, "displacement at the start (mm)");
    let (scale, unit) = suited_unit("m/s", all().map(|start| start.1));
    let upward = PlotAxis::between(up.0 * scale, up.1 * scale, &format!("velocity at the start ({unit})"));
    let mut panel = Panel::new(rightward, upward);
    let (room, source) = (basins.room(), source_row(basins));
    let is_outside = |x_mm: f64| x_mm / 1e3 < room.0 || x_mm / 1e3 > room.1;
    let count = answer.attractors.len();
    // the attractors, then those of starts that are not sure
    let found = |row: usize| {
        let place = answer.rows[source(row)]?.0 as usize - 1;
        Some(if answer.sure.get(source(row)) == Some(&false) { count + place } else { place })
    };
    let paler = |role: &Role| if let Role::Kind(place) = role { Role::Unsure(*place) } else { *role };
    let (mut names, mut roles) = (names(basins, answer), roles(answer));
    names.extend_from_within(..);
    roles.extend(roles.iter().map(paler).collect::<Vec<Role>>());
    let missing = "none found";
    match starts.axes() {
        Some((x_mm, v)) => {
            let kinds = roles.iter().copied().zip(names.iter().cloned());
            let cell = |row: usize| match found(row) {
                Some(place) => Shade::Value(place as f64),
                None if is_outside(x_mm[row / v.len()]) => Shade::Blank,
                None => Shade::Missing,
            };
            let cells = Shades {
                across: Edges::new(x_mm),
                up: Edges::new(&v.iter().map(|v| v * scale).collect::<Vec<f64>>()),
                cells: (0..starts.count()).map(cell).collect(),
                colours: Colours::Categories(kinds.collect()),
                missing: missing.to_owned(),
            };
            panel.draw(Role::Motion, Marks::Cells(cells));
        }
        None => {
            let mut clouds = vec![Vec::new(); names.len() + 1];
            for (row, (x_mm, v)) in all().enumerate() {
                if !is_outside(x_mm) {
                    clouds[found(row).unwrap_or(names.len())].push((x_mm, v * scale));
                }
            }
            let roles = roles.iter().copied().chain([Role::Missing]);
            let words = names.iter().map(String::as_str).chain([missing]);
            for ((role, name), cloud) in roles.zip(words).zip(clouds) {
                panel.layer_if_any(role, name, Marks::Cloud(cloud));
            }
        }
    }
    if let Some(place) = (0..answer.rows.len()).filter_map(found).find(|place| *place >= count) {
        panel.layer(roles[place], "paler: not sure", Marks::Patch);
    }
    let more = count.saturating_sub(MAX_NAMED);
    if more > 0 {
        panel.layer(Role::Several, format!("{more} more"), Marks::Patch);
    }
    let (left, right) = basins.model().stop_positions();
    panel.upright_stops((left.map_or(f64::NAN, |x| x * 1e3), right.map_or(f64::NAN, |x| x * 1e3)));
    for (role, attractor) in roles.iter().zip(&answer.attractors) {
        let states = attractor.states.iter().map(|(x, v)| (1e3 * x, v * scale)).collect();
        panel.draw(*role, Marks::Points(states));
    }
    Chart::stack(vec![panel], about(basins, answer), drawn(basins, answer))
}

/// The data of the picture: the starts with the numbers of their attractors, and the attractors' states.
fn drawn(basins: &BasinMap, answer: &Answer) -> Table {
    let mut drawn = Drawn::new(["x_mm", "v_m_per_s", "attractor", "sure"], &[]);
    let source = source_row(basins);
    for row in 0..answer.rows.len() {
        let (x_mm, v) = basins.starts().at(row);
        let number = answer.rows[source(row)].map_or(f64::NAN, |found| f64::from(found.0));
        let sure = answer.sure.get(source(row)).map_or(f64::NAN, |sure| f64::from(u8::from(*sure)));
        drawn.put("start", &[x_mm, v, number, sure], &[]);
    }
    for (place, attractor) in answer.attractors.iter().enumerate() {
        for (x, v) in &attractor.states {
            drawn.put("attractor", &[1e3 * x, *v, (place + 1) as f64, f64::NAN], &[]);
        }
    }
    drawn.table()
}

/// For each row, the row whose answer is shown there: itself, or the nearest row that has been run.
fn source_row(basins: &BasinMap) -> impl Fn(usize) -> usize {
    let (levels, done) = basins.levels();
    move |row| {
        if basins.is_whole() || done == 0 { row } else { levels.stand_in(row as u64, done - 1) as usize }
    }
}

/// The roles of the attractors, in the order of their words: a finer level of starts finds the same
/// attractors in another order, and their colours stay. Interwell motion has the warm colours first, other
/// motion the cool ones.
fn roles(answer: &Answer) -> Vec<Role> {
    let mut order: Vec<(String, usize)> = answer.words().into_iter().zip(0..).collect();
    order.sort();
    let (mut cool, mut warm) = (COOL.to_vec(), WARM.to_vec());
    let mut more = KINDS.len()..;
    let mut roles = vec![Role::Several; order.len()];
    for (_, place) in order {
        let (suited, others) = match answer.attractors[place].regime {
            Regime::Interwell => (&mut warm, &mut cool),
            _ => (&mut cool, &mut warm),
        };
        let kind = if suited.is_empty() { others.pop() } else { Some(suited.remove(0)) };
        roles[place] = Role::Kind(kind.or_else(|| more.next()).unwrap_or(0));
    }
    roles
}

/// The names of the attractors with their shares; if there are many, only those with the largest shares have
/// a name.
fn names(basins: &BasinMap, answer: &Answer) -> Vec<String> {
    let mut order: Vec<usize> = (0..answer.attractors.len()).collect();
    order.sort_by_key(|place| std::cmp::Reverse(answer.attractors[*place].starts));
    let (mut names, kinds) = (vec![String::new(); order.len()], answer.words());
    for place in order.into_iter().take(MAX_NAMED) {
        // a finer level of starts may number them anew
        let has_number = kinds.len() > 1 && basins.is_whole();
        let number = if has_number { format!("{} ", place + 1) } else { String::new() };
        names[place] = number + &words(&kinds[place], &answer.attractors[place], basins.starts().is_grid());
    }
    names
}

/// Description of an attractor with its share; for random starts also the interval of the share.
fn words(kind: &str, attractor: &Attractor, is_grid: bool) -> String {
    let percent = |share: f64| match (1e3 * share).round() / 10.0 {
        0.0 if share > 0.0 => "below 0.1".to_owned(),
        percent => short(percent),
    };
    let Shares { share, low, high } = attractor.share;
    let interval = || format!(" ({} to {})", percent(low), percent(high));
    let interval = if is_grid { String::new() } else { interval() };
    format!("{kind}: {} %{interval}", percent(share))
}

/// The subtitle: which starts were run.
fn about(basins: &BasinMap, answer: &Answer) -> String {
    let counted = match basins.starts().axes() {
        Some((x_mm, v)) => format!("{} \u{d7} {} starts", x_mm.len(), v.len()),
        None => format!("{} random starts", answer.rows.len()),
    };
    let is_periodic = basins.model().is_shaken() && basins.model().forcing_period().is_some();
    let when = if is_periodic { " at time 0 of the drive" } else { "" };
    let intervals = if basins.starts().is_grid() { "" } else { "; 95 % intervals in brackets" };
    let coarse = if basins.is_whole() { "" } else { "coarse so far: " };
    format!("{coarse}where motions go from {counted}{when}; markers: the attractors{intervals}")
}
