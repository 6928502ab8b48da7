//! The look of the window: cards with one row for title, legend and tools, controls of one height, what
//! covers a view, what a view without data says.

use eframe::egui::accesskit::Role;
use eframe::egui::{self, Color32, Key, Rect, Shape, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable as _;
use interwell::app::ui::settings::Settings;
use interwell::app::ui::style::{CONTROL, GAP, NUMBER, Style};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Layout;
use interwell::scene::lesson::Step;

use crate::lessons::{go_to, opened_own};
use crate::support::{
    LONG, PROJECTED, WIDE, click_on, command, is_painted, painted, press, window, window_with,
};

const LIGHT: Style = Style { dark: false, projector: false };

fn shapes(harness: &Harness<'static, Window>) -> Vec<(Shape, Rect)> {
    fn flat(shape: &Shape, clip: Rect, into: &mut Vec<(Shape, Rect)>) {
        match shape {
            Shape::Vec(all) => all.iter().for_each(|shape| flat(shape, clip, into)),
            other => into.push((other.clone(), clip)),
        }
    }
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|clipped| flat(&clipped.shape, clipped.clip_rect, &mut all));
    all
}

/// Whether something is drawn within a place, apart from its ground.
fn is_drawn(harness: &Harness<'static, Window>, place: Rect) -> bool {
    let inner = place.expand(1.0);
    shapes(harness).iter().any(|(shape, clip)| {
        let bounds = shape.visual_bounding_rect();
        bounds.is_positive() && inner.contains_rect(bounds) && clip.intersects(bounds)
    })
}

fn text(harness: &Harness<'static, Window>, words: &str) -> Rect {
    let all = painted(harness);
    all.iter().find(|text| text.0 == words).unwrap_or_else(|| panic!("{words}: {all:?}")).1
}

#[test]
fn nothing_beside_the_mechanism_comes_and_goes_with_a_number() {
    for preset in ["first-look", "paper", "harvester", "uneven-stops"] {
        for size in [WIDE, PROJECTED, [1024.0, 700.0]] {
            let mut harness = window(preset, size);
            let mut seen = Vec::new();
            for _ in 0..40 {
                harness.run_steps(1);
                seen.push(is_painted(&harness, "push "));
            }
            seen.dedup();
            assert_eq!(seen.len(), 1, "{preset} {size:?}");
        }
    }
}

#[test]
fn a_title_stands_in_one_row_with_the_caption_of_its_drawing() {
    let harness = window("first-look", WIDE);
    let all = painted(&harness);
    // the heading of the controls has the same name
    let titles: Vec<Rect> = all.iter().filter(|text| text.0 == "Mechanism").map(|text| text.1).collect();
    let push = all.iter().find(|text| text.0.starts_with("push ")).unwrap().1;
    // the tail of a letter reaches below the row
    assert!(titles.iter().any(|title| (title.center().y - push.center().y).abs() <= 3.0), "{titles:?}");
}

#[test]
fn cards_have_a_frame_and_stand_apart() {
    for dark in [false, true] {
        let harness = window_with("paper", WIDE, Settings { dark, ..Settings::default() });
        let style = Style { dark, projector: false };
        let cards: Vec<Rect> =
            View::ALL.into_iter().filter_map(|view| harness.state().tiling.place_of(view)).collect();
        assert_eq!(cards.len(), 4);
        for (i, card) in cards.iter().enumerate() {
            let is_frame = |shape: &(Shape, Rect)| match &shape.0 {
                Shape::Rect(rect) => {
                    let apart = (rect.rect.min - card.min).length() + (rect.rect.max - card.max).length();
                    apart < 1.0 && rect.stroke == style.card_stroke()
                }
                _ => false,
            };
            assert!(shapes(&harness).iter().any(is_frame), "{card:?}");
            let others = cards.iter().skip(i + 1);
            assert!(others.clone().all(|other| !card.expand(GAP - 1.0).intersects(*other)), "{cards:?}");
            assert!(card.right() <= WIDE[0] - GAP + 0.1 && card.left() >= GAP);
        }
    }
}

#[test]
fn tools_are_quiet_until_the_pointer_comes_and_always_there_for_the_keyboard() {
    let mut harness = window("paper", WIDE);
    harness.hover_at(pos2(100.0, 10.0));
    harness.run_steps(3);
    let tool = |harness: &Harness<'static, Window>| {
        harness.get_by_role_and_label(Role::Button, "fill the window with Well").rect()
    };
    let place = tool(&harness);
    assert!(!is_drawn(&harness, place));
    let card = harness.state().tiling.place_of(View::Well).unwrap();
    harness.hover_at(card.center());
    harness.run_steps(3);
    assert!(is_drawn(&harness, place) && tool(&harness) == place);
    harness.hover_at(pos2(100.0, 10.0));
    harness.run_steps(3);
    assert!(!is_drawn(&harness, place));
    harness.get_by_role_and_label(Role::Button, "fill the window with Well").focus();
    harness.run_steps(3);
    assert!(is_drawn(&harness, place));
    press(&mut harness, Key::Enter);
    harness.get_by_label("all views");
    // a projector shows them all the time, and axes that are held say so
    let projected = Settings { projector: true, ..Settings::default() };
    let harness = window_with("paper", PROJECTED, projected);
    assert!(is_drawn(&harness, tool(&harness)));
    let mut harness = window("paper", WIDE);
    harness.hover_at(pos2(100.0, 10.0));
    harness.get_by_label("hold the axes of Well").click();
    harness.run_steps(3);
    harness.hover_at(pos2(100.0, 10.0));
    harness.run_steps(3);
    let held = harness.get_by_label("let go of the axes of Well").rect();
    assert!(is_drawn(&harness, held) && !is_drawn(&harness, tool(&harness)));
}

#[test]
fn controls_have_one_height_and_numbers_one_width() {
    let mut harness = window("paper", WIDE);
    harness.get_by_label("More").click();
    harness.run_steps(3);
    let column = |rect: &Rect| rect.right() < 250.0 && rect.top() > 70.0 && rect.bottom() < 660.0;
    let fields: Vec<Rect> =
        harness.query_all_by_role(Role::SpinButton).map(|field| field.rect()).filter(column).collect();
    assert!(fields.len() > 4);
    for field in &fields {
        assert_eq!((field.width(), field.height()), (NUMBER, CONTROL), "{field:?}");
        assert_eq!(field.left(), fields[0].left());
    }
    assert_eq!(harness.get_by_label("Find the best stops").rect().height(), CONTROL);
    assert_eq!(harness.get_by_label("restart").rect().height(), CONTROL);
    // the number follows its slider in one row
    for slider in harness.query_all_by_role(Role::Slider).map(|slider| slider.rect()).filter(column) {
        let beside = |field: &&Rect| (field.center().y - slider.center().y).abs() < 1.0;
        assert!(fields.iter().find(beside).is_some_and(|field| field.left() > slider.right()), "{slider:?}");
    }
}

#[test]
fn the_sizes_of_texts_are_three() {
    use interwell::app::ui::style::{BODY, LEAST, SMALL, STATUS};
    for (size, projector) in [(WIDE, false), (PROJECTED, true), ([1920.0, 1080.0], false)] {
        let harness = window_with("paper", size, Settings { projector, ..Settings::default() });
        let mut sizes: Vec<f32> = Vec::new();
        for (shape, clip) in shapes(&harness) {
            let Shape::Text(text) = &shape else { continue };
            let is_seen = clip.intersects(shape.visual_bounding_rect());
            let sections = text.galley.job.sections.iter().filter(|_| is_seen && !text.galley.is_empty());
            sizes.extend(sections.map(|section| section.format.font_id.size));
        }
        sizes.sort_by(f32::total_cmp);
        sizes.dedup_by(|a, b| (*a - *b).abs() < 0.01);
        let known = |size: &f32| [SMALL, BODY, STATUS].iter().any(|known| (size - known).abs() < 0.01);
        // and another where a text would not fit beside a projector
        sizes.retain(|size| !(projector && *size == LEAST));
        assert!(sizes.iter().all(known), "{size:?}: {sizes:?}");
    }
}

#[test]
fn a_covered_view_is_hatched_and_asks() {
    let mut harness = window("paper", WIDE);
    press(&mut harness, Key::C);
    let card = harness.state().tiling.place_of(View::Displacement).unwrap();
    let all = painted(&harness);
    let asked = all.iter().filter(|text| text.0 == "What do you expect?" && card.contains_rect(text.1));
    let asked: Vec<_> = asked.collect();
    assert_eq!(asked.len(), 1);
    assert!((asked[0].1.center().x - card.center().x).abs() < 2.0);
    let mark = all.iter().find(|text| text.0 == "?" && card.contains_rect(text.1)).unwrap();
    assert!((mark.1.center().x - card.center().x).abs() < 2.0 && mark.1.bottom() <= asked[0].1.top());
    let is_hatch = |shape: &(Shape, Rect)| match &shape.0 {
        Shape::LineSegment { points, stroke } => {
            *stroke == LIGHT.hatching_stroke() && card.contains(points[0]) && points[0].y != points[1].y
        }
        _ => false,
    };
    assert!(shapes(&harness).iter().filter(|shape| is_hatch(shape)).count() > 10);
    // in a lesson it is the question of the step
    let mut harness = opened_own(WIDE);
    assert!(go_to(&mut harness, |step| matches!(step, Step::Predict { .. })));
    let question = painted(&harness).into_iter().filter(|text| text.0.ends_with('?') && text.0.len() > 8);
    let places: Vec<Rect> = question.map(|text| text.1).collect();
    let card = harness.state().tiling.place_of(View::Displacement).unwrap();
    assert!(places.iter().any(|place| card.contains_rect(*place)), "{places:?} {card:?}");
}

#[test]
fn a_view_without_data_says_in_its_middle_what_would_give_it_some() {
    let mut harness = window("first-look", [1920.0, 1080.0]);
    let view = View::Measured;
    View::ALL.into_iter().for_each(|other| command(&mut harness, Command::Show(other, other == view)));
    let card = harness.state().tiling.place_of(view).unwrap();
    let all = painted(&harness);
    let (_, place, _) = all.iter().find(|text| text.0.starts_with("Drop a CSV on the window")).unwrap();
    assert!((place.center().x - card.center().x).abs() < 8.0, "{place:?} in {card:?}");
    assert!((place.center().y - card.center().y).abs() < 0.25 * card.height(), "{place:?}");
}

#[test]
fn the_bar_of_time_shows_the_run_and_the_events_that_there_are() {
    let mut harness = window("first-look", WIDE);
    harness.run_steps(30);
    let bar = harness.get_by_label("time").rect();
    let handle = shapes(&harness).into_iter().find_map(|(shape, _)| match shape {
        Shape::Circle(circle) if bar.contains(circle.center) && circle.fill == LIGHT.mass() => {
            Some(circle.center)
        }
        _ => None,
    });
    assert!(handle.unwrap().x < bar.center().x, "{handle:?} {bar:?}");
    let clock = painted(&harness).into_iter().find(|text| text.0.ends_with(" s") && text.1.top() > 660.0);
    assert!(clock.unwrap().1.right() <= bar.left());
    let length = text(&harness, "20 s");
    assert!(length.left() > bar.right() - 12.0 && (length.center().y - bar.center().y).abs() < 8.0);
    // from rest, it does not cross
    let below: Vec<_> =
        painted(&harness).into_iter().filter(|text| text.1.top() >= bar.bottom() - 1.0).collect();
    assert!(!below.iter().any(|text| text.0 == "crossing"), "{below:?}");
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.player.speed = 1.0;
    harness.run_steps(90);
    let harness_bar = harness.get_by_label("time").rect();
    assert!(text(&harness, "crossing").top() >= harness_bar.bottom() - 1.0);
    // what can be done with it is said below it, and not over a view
    harness.hover_at(harness_bar.center());
    harness.run_steps(60);
    assert!(text(&harness, "drag, or press the arrow keys, to look back").top() > 660.0);
}

#[test]
fn the_mass_shows_that_it_can_be_dragged() {
    let mut harness = window("paper", WIDE);
    harness.state_mut().session.player.set_playing(false);
    harness.run_steps(2);
    assert!(is_painted(&harness, "mass: drag me"));
    let outlined = |harness: &Harness<'static, Window>, place: Rect| {
        let stroke = LIGHT.pointing_stroke();
        shapes(harness).iter().any(|(shape, _)| match shape {
            Shape::Rect(rect) => rect.stroke == stroke && place.contains(rect.rect.center()),
            Shape::Circle(circle) => circle.stroke == stroke && place.contains(circle.center),
            _ => false,
        })
    };
    let masses: Vec<Rect> = harness.query_all_by_label("proof mass").map(|mass| mass.rect()).collect();
    assert_eq!(masses.len(), 2);
    for place in &masses {
        assert!(!outlined(&harness, *place));
        harness.hover_at(place.center());
        harness.run_steps(3);
        assert!(outlined(&harness, *place), "{place:?}");
    }
    let from = masses[0].center();
    harness.drag_at(from);
    harness.run_steps(2);
    harness.hover_at(from - egui::vec2(30.0, 0.0));
    harness.run_steps(2);
    harness.drop_at(from - egui::vec2(30.0, 0.0));
    harness.run_steps(3);
    assert!(!is_painted(&harness, "drag me") && is_painted(&harness, "mass"));
}

#[test]
fn nothing_is_offered_where_nothing_shakes() {
    let harness = window("bouncing-ball", WIDE);
    assert!(harness.query_by_label("Find the best stops").is_none());
    assert!(!is_painted(&harness, "push "));
    let harness = window("paper", WIDE);
    harness.get_by_label("Find the best stops");
}

#[test]
fn the_projector_keeps_a_view_over_the_window() {
    let mut harness = window("paper", WIDE);
    click_on(&mut harness, "fill the window with Well");
    press(&mut harness, Key::P);
    harness.run_steps(3);
    assert!(harness.state().settings.projector);
    harness.get_by_label("all views");
    press(&mut harness, Key::P);
    harness.get_by_label("all views");
}

#[test]
fn the_tools_of_a_map_are_whole_and_its_quantities_are_in_groups() {
    for size in [[1024.0, 700.0], WIDE, PROJECTED] {
        let mut harness = window("paper", size);
        command(&mut harness, Command::Arrange(Layout::Map));
        harness.state_mut().session.wait_for_map(LONG);
        harness.run_steps(4);
        let card = harness.state().tiling.place_of(View::Map).unwrap();
        let cut = painted(&harness).into_iter().filter(|label| {
            let text = label.1.shrink(1.0);
            card.contains(text.center())
                && label.2.intersects(text)
                && !label.2.expand(0.5).contains_rect(text)
        });
        assert_eq!(cut.map(|label| label.0).collect::<Vec<_>>(), [""; 0], "{size:?}");
        let names = ["map of RMS velocity", "Options"];
        let role = |name: &str| match name {
            "Cuts" => Role::CheckBox,
            name if name.starts_with("map") => Role::ComboBox,
            _ => Role::Button,
        };
        let names: Vec<(&str, Role)> = names.iter().map(|name| (*name, role(name))).collect();
        let places = names.iter().map(|tool| harness.get_by_role_and_label(tool.1, tool.0).rect());
        let places: Vec<Rect> = places.collect();
        for (i, (name, place)) in names.iter().zip(&places).enumerate() {
            assert!(card.contains_rect(*place), "{size:?}: {name:?} {place:?} in {card:?}");
            assert!(places[i + 1..].iter().all(|other| !other.shrink(1.0).intersects(*place)), "{name:?}");
        }
        click_on(&mut harness, "Options");
        let inside = harness.ctx.content_rect();
        for name in ["Flat", "Surface", "Cuts", "Show where the scene has been", "Recompute"] {
            let place = harness.get_by_label(name).rect();
            assert!(inside.contains_rect(place), "{size:?}: {name} {place:?}");
        }
        harness.get_by_role_and_label(Role::SpinButton, "up, step");
        press(&mut harness, Key::Escape);
        click_on(&mut harness, "map of RMS velocity");
        let groups = ["Motion", "Events", "First", "Power", "Energy", "Contact", "Run"];
        groups.iter().for_each(|group| assert!(harness.query_all_by_label(group).count() > 0, "{group}"));
        assert!(harness.query_by_label("Reach").is_none());
        // beside the menu of that name
        harness.query_all_by_label("Motion").last().unwrap().click();
        harness.run_steps(3);
        click_on(&mut harness, "Reach");
        assert_eq!(harness.state().session.map.quantity().name, "max_abs_x_m");
    }
}

#[test]
fn a_message_lies_over_hover_texts() {
    let mut harness = window("paper", WIDE);
    let switch = harness.get_by_role_and_label(Role::CheckBox, "Stops").rect();
    press(&mut harness, Key::R);
    command(&mut harness, Command::CopyAnswers);
    harness.hover_at(switch.center());
    harness.run_steps(60);
    assert!(is_painted(&harness, "Rigid walls that limit"));
    let top = harness.ctx.memory(|memory| memory.areas().top_layer_id(egui::Order::Tooltip));
    assert_eq!(top.map(|layer| layer.id), Some(egui::Id::unique("told")));
}

/// The colours of a coil's wires and frame.
fn is_coil(shape: &Shape, frame: Color32) -> Option<Rect> {
    // as thin as a clamp, and not as long
    let is_row = |rect: Rect| rect.height() < 9.0 && (60.0..300.0).contains(&rect.width());
    match shape {
        Shape::Rect(rect) if rect.fill == frame && is_row(rect.rect) => Some(rect.rect),
        _ => None,
    }
}

#[test]
fn a_coil_lies_around_its_magnet() {
    let mut harness = window("harvester", WIDE);
    harness.state_mut().session.player.set_playing(false);
    harness.run_steps(3);
    let all = shapes(&harness);
    let frame = LIGHT.colour(interwell::output::Role::Frame);
    let rows: Vec<Rect> = all.iter().filter_map(|shape| is_coil(&shape.0, frame)).collect();
    assert_eq!(rows.len(), 2, "{rows:?}");
    let (north, south) = (text(&harness, "N"), text(&harness, "S"));
    let [upper, lower] = [rows[0], rows[1]];
    assert!(upper.bottom() <= north.top() + 2.0 && south.bottom() <= lower.top() + 2.0);
    for place in [north, south] {
        assert!(upper.x_range().contains(place.center().x), "{rows:?} {place:?}");
    }
}
