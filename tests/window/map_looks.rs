//! The map in its looks: as a surface, with cuts, of any column, with a trail; its cost; zoom by keys.

use eframe::egui::epaint::ColorMode;
use eframe::egui::{Event, Key, Modifiers, Pos2, Shape, accesskit::Role, pos2, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::export::map_command_line;
use interwell::app::session::map::Map;
use interwell::app::window::{Command, Window};
use interwell::app::words::columns::{COLUMNS, title};
use interwell::output::{
    Area, Cut, Marks, Panel, PlotAxis, Role as Drawn, Shade, SurfaceFrame, View, words_of,
};
use interwell::scene::{Layout, Stops, SweepAxis};
use interwell_studies::study::{Cell, RMS_VELOCITY, STANDARD_COLUMNS, SummaryField};

use crate::shared::axis;
use crate::support::{
    LONG, PROJECTED, WIDE, choose_in_map, click_on, command, is_painted, painted, press, session, sliced,
    window,
};

/// A small map, so that a test takes no longer than it must.
fn axes(steps: (f64, f64)) -> [SweepAxis; 2] {
    [axis("stops.travel_limit_mm", (1.0, 3.0, steps.0)), axis("excitation.amplitude_g", (0.5, 1.5, steps.1))]
}

/// A window on a map that is whole, paused so that no frame differs.
fn open(size: [f32; 2], steps: (f64, f64)) -> Harness<'static, Window> {
    let mut harness = window("paper", size);
    harness.state_mut().session.player.set_playing(false);
    harness.state_mut().session.map.choose(Some(axes(steps)));
    command(&mut harness, Command::Arrange(Layout::Map));
    assert!(harness.state_mut().session.wait_for_map(LONG));
    harness.run_steps(3);
    harness
}

fn map(window: &Window) -> &Map {
    window.session.map.map().unwrap()
}

#[test]
fn a_scene_without_stops_is_marked_outside_the_map_with_what_it_does() {
    let mut harness = window("first-look", WIDE);
    harness.state_mut().session.player.set_playing(false);
    harness.state_mut().session.map.choose(Some(axes((0.1, 0.05))));
    command(&mut harness, Command::Arrange(Layout::Map));
    assert!(harness.state_mut().session.wait_for_map(LONG));
    harness.state_mut().session.wait(LONG);
    harness.run_steps(3);
    let (words, place, _) = painted(&harness).into_iter().find(|text| text.0.contains("no stops")).unwrap();
    let settled = harness.state().session.settled_now().unwrap().rms_velocity.unwrap();
    let value = format!("now: no stops, RMS velocity {:.0} mm/s", 1e3 * settled);
    assert!(words.starts_with(&value) && words.contains("; it crosses from about 1.1"), "{words}");
    // it hides no line of the map
    let frame = harness.get_by_role_and_label(Role::Image, "map").rect();
    let chart = map(harness.state()).chart(&RMS_VELOCITY, &View::Cuts(Vec::new())).unwrap();
    let panel = chart.panels().next().unwrap();
    let share = |axis: &PlotAxis, value: f64| ((value - axis.low) / (axis.high - axis.low)) as f32;
    let lines = panel.layers.iter().filter_map(|layer| match &layer.marks {
        Marks::Path(points) => Some(points.iter()),
        _ => None,
    });
    let at = lines.flatten().map(|(x, y)| vec2(share(&panel.x, *x), 1.0 - share(&panel.y, *y)));
    let at: Vec<Pos2> = at.map(|share| frame.min + share * frame.size()).collect();
    assert!(at.len() > 20 && frame.contains_rect(place), "{frame:?} {place:?}");
    assert!(at.iter().all(|at| !place.contains(*at)), "{place:?}");
}

/// A click, after which some frames pass.
fn click(harness: &mut Harness<'static, Window>, at: Pos2) {
    harness.drag_at(at);
    harness.run_steps(1);
    harness.drop_at(at);
    harness.run_steps(8);
}

fn stops_mm(harness: &Harness<'static, Window>) -> f64 {
    let Stops::Rigid { travel_limit_mm, .. } = harness.state().session.scene().stops else { panic!("stops") };
    travel_limit_mm
}

fn amplitude_g(harness: &Harness<'static, Window>) -> f64 {
    harness.state().session.amplitude_g().unwrap()
}

fn rms(cell: &Cell) -> f64 {
    cell.summary().unwrap().rms_velocity.unwrap()
}

#[test]
fn a_click_on_the_surface_takes_the_scene_there() {
    let mut harness = open(WIDE, (0.25, 0.25));
    choose_in_map(&mut harness, "Surface");
    let rect = harness.get_by_role_and_label(Role::Image, "map as a surface").rect();
    let [left, top, right, bottom] = [rect.left(), rect.top(), rect.right(), rect.bottom()].map(f64::from);
    let [x, y, z] = [(); 3].map(|()| PlotAxis::given(0.0, 1.0, Vec::new(), ""));
    let surface = SurfaceFrame { area: Area::new(left, top, right, bottom), x, y, z };
    let most = map(harness.state()).known_cells().map(rms).fold(0.0, f64::max);
    // 2.5 mm and 1.25 g, whose height is its share of the largest velocity: no face hides it
    let (column, row) = (6, 3);
    let speed = rms(map(harness.state()).cell(column, row).unwrap().0);
    assert!(speed > 0.5 * most);
    let (x, y) = surface.point((0.75, 0.75, speed / most));
    click(&mut harness, pos2(x as f32, y as f32 + 1.0));
    assert_eq!((stops_mm(&harness), amplitude_g(&harness)), (2.5, 1.25));
    // words have no height
    harness.state_mut().session.map.show(SummaryField::find("regime").unwrap());
    harness.run_steps(3);
    harness.get_by_role_and_label(Role::Image, "map");
    assert!(is_painted(&harness, "Words have no height"));
}

#[test]
fn cuts_are_rows_of_the_table_and_lead_to_their_cells() {
    let mut harness = open(WIDE, (0.25, 0.25));
    choose_in_map(&mut harness, "Cuts");
    assert!(is_painted(&harness, "at travel limit 1.5 mm") && is_painted(&harness, "at amplitude 1 g"));
    let map = map(harness.state());
    let cut = |i: usize, value: f64| Cut { column: map.grid().columns()[i].clone(), value };
    let view = View::Cuts(vec![cut(1, 1.0), cut(0, 1.5)]);
    let chart = map.chart(&RMS_VELOCITY, &view).unwrap();
    let panels: Vec<&Panel> = chart.panels().collect();
    let path = |panel: usize, role: Drawn| {
        panels[panel].layers.iter().find(|layer| layer.role == role).map(|layer| layer.marks.clone()).unwrap()
    };
    // across at 1 g, upward at 1.5 mm
    let row = |column: usize| (map.edges[0].values[column], 1e3 * rms(map.cell(column, 2).unwrap().0));
    let column = |row: usize| (1e3 * rms(map.cell(2, row).unwrap().0), map.edges[1].values[row]);
    assert_eq!(path(1, Drawn::Joined), Marks::Path((0..9).map(row).collect()));
    assert_eq!(path(2, Drawn::Joined), Marks::Path((0..5).map(column).collect()));
    // both thresholds of 1.5 mm: release in closed form, and the step from 0.5 to 0.75 g
    let Marks::Horizontals(release) = path(2, Drawn::Release) else { panic!("a line at the release") };
    assert!(release.len() == 1 && (release[0] - 0.688).abs() < 2e-3, "{release:?}");
    assert_eq!(path(2, Drawn::FirstCrossing), Marks::Horizontals(vec![0.625]));
    let place = |harness: &Harness<'static, Window>, name: &str| {
        harness.get_by_role_and_label(Role::Image, name).rect()
    };
    let (whole, upward, across) =
        (place(&harness, "map"), place(&harness, "cut upward"), place(&harness, "cut across"));
    // in line with the map
    assert_eq!((upward.top(), upward.bottom()), (whole.top(), whole.bottom()));
    assert_eq!((across.left(), across.right()), (whole.left(), whole.right()));
    let at = pos2(upward.center().x, upward.top() + 0.1 * upward.height());
    click(&mut harness, at);
    assert_eq!((stops_mm(&harness), amplitude_g(&harness)), (1.5, 1.5));
    let at = pos2(across.center().x, across.center().y);
    click(&mut harness, at);
    assert_eq!((stops_mm(&harness), amplitude_g(&harness)), (2.0, 1.5));
}

/// A map that was stopped early has cells that stand in for others; its cuts have only those that are known.
#[test]
fn a_cut_through_a_coarse_map_has_its_own_cells() {
    let mut session = session("paper", &["run.duration_s=100", "run.recurrence=false"]);
    session.map.choose(Some(axes((0.005, 0.005))));
    session.want_map(0.0);
    crate::support::wait_until("a coarse map", || {
        session.map.take();
        session.map.map().is_some_and(Map::is_covered)
    });
    session.map.stop();
    let map = session.map.map().unwrap();
    assert!(!map.is_whole());
    let [columns, rows] = map.size();
    for column in [0, 1, columns / 2, columns - 1] {
        let cut = Cut { column: map.grid().columns()[0].clone(), value: map.edges[0].values[column] };
        let chart = map.chart(&RMS_VELOCITY, &View::Cuts(vec![cut])).unwrap();
        let panels: Vec<&Panel> = chart.panels().collect();
        let known: Vec<f64> = (0..rows)
            .filter(|row| map.cell(column, *row).unwrap().1)
            .map(|row| map.edges[1].values[row])
            .collect();
        let shown = panels[1].layers.iter().find_map(|layer| match &layer.marks {
            Marks::Regimes(points, _) => Some(points.iter().map(|point| point.0.1).collect::<Vec<f64>>()),
            _ => None,
        });
        assert!(known.len() < rows && shown.as_ref() == Some(&known), "{column}: {shown:?}");
        let is_blank = |cell: &Shade| *cell == Shade::Blank;
        assert!(!panels[0].cells().unwrap().cells.iter().any(is_blank));
    }
}

#[test]
fn every_column_is_a_quantity_with_its_unit() {
    let mut harness = open(WIDE, (0.5, 0.5));
    harness.get_by_role_and_label(Role::ComboBox, "map of RMS velocity").click();
    harness.run_steps(4);
    // beside the menu of that name
    harness.query_all_by_label("Motion").last().unwrap().click();
    harness.run_steps(3);
    click_on(&mut harness, "Reach");
    assert_eq!(harness.state().session.map.quantity().name, "max_abs_x_m");
    assert!(is_painted(&harness, "reach (mm)"));
    for field in COLUMNS.iter().flat_map(|group| group.1).map(|name| SummaryField::find(name).unwrap()) {
        harness.state_mut().session.map.show(field);
        harness.run_steps(2);
        assert!(harness.state_mut().session.wait_for_map(LONG), "{}", field.name);
        harness.run_steps(3);
        let label = format!("map of {}", title(field));
        harness.get_by_role_and_label(Role::ComboBox, &label);
        assert!(
            words_of(field.name).is_some()
                || painted(&harness)
                    .iter()
                    .any(|text| text.0.contains(field.label) || field.name == "period"),
            "{}",
            field.name
        );
    }
    // what no run has is said
    for (column, words) in [
        ("peak_contact_force_n", "no compliant stop is touched"),
        ("first_release_g", "no release, or the shaking does not change"),
    ] {
        harness.state_mut().session.map.show(SummaryField::find(column).unwrap());
        harness.run_steps(3);
        assert!(is_painted(&harness, words), "{column}");
    }
}

/// With a column of the energy ledger and one without, byte for byte, as the copied command makes it.
#[test]
fn more_columns_are_those_of_the_command_line() {
    let mut session = session("paper", &[]);
    session.map.choose(Some(axes((1.0, 0.25))));
    for (column, more) in [
        ("max_abs_x_m", None),
        ("travel_m", Some("travel_m")),
        ("mean_x_m", Some("mean_x_m")),
        // what was summed up is kept
        ("impact_share", Some("mean_x_m,impact_share")),
        ("rms_velocity_m_per_s", Some("mean_x_m")),
    ] {
        session.map.show(SummaryField::find(column).unwrap());
        session.want_map(0.0);
        assert!(session.wait_for_map(LONG));
        let command = map_command_line(&session).unwrap();
        let asked = command.split_once(" --columns ").map(|parts| parts.1.to_owned());
        let standard = STANDARD_COLUMNS.join(",");
        assert_eq!(asked, more.map(|more| format!("{standard},{more}")), "{command}");
        let words = command.split(' ').skip(1);
        let output = assert_cmd::Command::cargo_bin("interwell").unwrap().args(words).output().unwrap();
        assert_eq!(session.map.csv().unwrap(), String::from_utf8(output.stdout).unwrap(), "{command}");
    }
}

#[test]
fn the_trail_is_where_the_motion_has_been() {
    let mut harness = open(WIDE, (0.25, 0.25));
    let trail = |harness: &mut Harness<'static, Window>| harness.state_mut().session.map.trail_places();
    assert_eq!(trail(&mut harness), [[Some(1.5), Some(1.0)]]);
    // paths in the colour of the mass, however faint
    let lines = |harness: &Harness<'static, Window>| {
        let mut count = 0;
        each_shape(harness, &mut |shape| {
            if let Shape::Path(path) = shape
                && let ColorMode::Solid(color) = path.stroke.color
            {
                let ratio = f32::from(color.g()) / f32::from(color.r().max(1));
                count += usize::from(color.b() == 0 && color.r() > 20 && (0.66..0.72).contains(&ratio));
            }
        });
        count
    };
    assert_eq!(lines(&harness), 0);
    let place = harness.get_by_role_and_label(Role::Image, "map").rect();
    click(&mut harness, place.center());
    harness.state_mut().session.set_number("mass_g", 16.0).unwrap();
    harness.state_mut().session.end_gesture();
    harness.state_mut().session.switch_stops(false);
    harness.run_steps(3);
    let been = [[Some(1.5), Some(1.0)], [Some(2.0), Some(1.0)], [None, Some(1.0)]];
    assert_eq!(trail(&mut harness), been);
    assert_eq!(lines(&harness), 1);
    harness.state_mut().session.undo();
    // over another field it has other places, and it is cleared when that is asked for
    harness
        .state_mut()
        .session
        .map
        .choose(Some([axes((0.5, 0.5))[0].clone(), axis("mass_g", (12.0, 18.0, 2.0))]));
    harness.run_steps(3);
    assert_eq!(
        trail(&mut harness),
        [(1.5, 15.2), (2.0, 15.2), (2.0, 16.0)]
            .map(|(x, y)| [Some(x), Some(y)])
            .iter()
            .copied()
            .chain([[None, Some(16.0)], [Some(2.0), Some(16.0)]])
            .collect::<Vec<_>>()
    );
    click_on(&mut harness, "Options");
    click_on(&mut harness, "Clear the trail");
    assert_eq!(trail(&mut harness), [[Some(2.0), Some(16.0)]]);
    assert_eq!(lines(&harness), 0);
}

/// Hands every shape of the last frame on, those within others too.
fn each_shape(harness: &Harness<'static, Window>, each: &mut dyn FnMut(&Shape)) {
    fn inner(shape: &Shape, each: &mut dyn FnMut(&Shape)) {
        match shape {
            Shape::Vec(all) => all.iter().for_each(|shape| inner(shape, each)),
            single => each(single),
        }
    }
    harness.output().shapes.iter().for_each(|clipped| inner(&clipped.shape, each));
}

/// A finer map has no more shapes in a frame: its picture, its hatching and its surface are each one.
#[test]
fn the_cost_of_a_frame_does_not_grow_with_the_map() {
    let count = |steps: (f64, f64), look: &[&str], column: &str| {
        let mut harness = open(WIDE, steps);
        harness.state_mut().session.map.show(SummaryField::find(column).unwrap());
        look.iter().for_each(|label| choose_in_map(&mut harness, label));
        let place = harness.get_by_label("Options").rect();
        harness.hover_at(place.left_top() - vec2(400.0, 80.0));
        harness.run_steps(3);
        let mut count = 0_usize;
        each_shape(&harness, &mut |_| count += 1);
        count
    };
    for (look, column) in
        [(&[][..], "rms_velocity_m_per_s"), (&[], "regime"), (&["Surface"], "rms_velocity_m_per_s")]
    {
        let [coarse, fine] = [(0.5, 0.25), (0.1, 0.05)].map(|steps| count(steps, look, column));
        assert!(fine <= coarse + 30, "{look:?} {column}: {coarse} {fine}");
    }
}

#[test]
fn nothing_is_cut_in_any_look() {
    for size in [WIDE, [1920.0, 1080.0], PROJECTED] {
        let mut harness = open(size, (0.25, 0.25));
        for label in ["Cuts", "Surface", "Flat"] {
            choose_in_map(&mut harness, label);
            assert_eq!(sliced(&harness), Vec::<String>::new(), "{size:?} {label}");
            if label != "Surface" {
                let place = harness.get_by_role_and_label(Role::Image, "cut across").rect();
                assert!(place.right() <= size[0] && place.bottom() <= size[1] && place.width() > 80.0);
            }
        }
    }
}

#[test]
fn keys_enlarge_and_go_back() {
    let mut harness = open(WIDE, (0.25, 0.25));
    let ranges = |harness: &Harness<'static, Window>| {
        harness.state().session.map_axes().unwrap().map(|axis| (axis.from, axis.to, axis.step))
    };
    let before = ranges(&harness);
    let scene = harness.state().session.scene().clone();
    harness.get_by_role_and_label(Role::Slider, "cross-hair").focus();
    harness.run_steps(2);
    let mut key = |key: Key| {
        press(&mut harness, key);
        ranges(&harness)
    };
    let once = key(Key::Plus);
    let twice = key(Key::Plus);
    for i in 0..2 {
        assert!(once[i].0 >= before[i].0 && once[i].1 <= before[i].1 && once[i].2 < before[i].2, "{once:?}");
        assert!(twice[i].1 - twice[i].0 < once[i].1 - once[i].0, "{twice:?}");
    }
    assert_eq!(key(Key::Minus), once);
    assert_eq!(key(Key::Minus), before);
    assert_eq!(key(Key::Minus), before);
    assert_eq!(*harness.state().session.scene(), scene);
}

#[test]
fn a_range_that_cannot_be_is_refused_where_it_was_typed() {
    let mut harness = open(WIDE, (0.25, 0.25));
    click_on(&mut harness, "Options");
    let before = harness.state().session.map_axes();
    for (name, text, words) in [
        ("up, step", "0", "step"),
        ("across, step", "0.0000001", "values are more than an axis may have"),
        ("across, from", "-1", "travel limit"),
        ("up, to", "0.1", "amplitude, to"),
    ] {
        harness.get_by_role_and_label(Role::SpinButton, name).click();
        harness.run_steps(2);
        harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        harness.event(Event::Text(text.to_owned()));
        harness.run_steps(2);
        press(&mut harness, Key::Enter);
        assert_eq!(harness.state().session.map_axes(), before, "{name}");
        assert!(painted(&harness).iter().any(|text| text.0.contains(words)), "{name}: {words}");
    }
    // each is well alone, and together they are too many
    let mut many = axes((0.002, 0.002));
    many[0].to = 3.0;
    let (_, part, why) = harness.state().session.map_problem(&many).unwrap();
    assert!(part == "step" && why.contains("the window computes at most 200000 cells"), "{why}");
}

#[test]
fn fields_that_are_offered_have_names_of_their_own() {
    let harness = window("first-look", WIDE);
    let fields = harness.state().session.map_fields();
    for path in ["mechanism.parallel.length_mm", "mechanism.buckling.length_mm", "mechanism.young_gpa"] {
        assert!(fields.iter().any(|field| field == path), "{path}");
    }
}
