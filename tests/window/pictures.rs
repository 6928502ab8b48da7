//! What pictures over the displacement show: axes that fit, labels clear of lines, contact without overlap.

use std::f64::consts::TAU;

use eframe::egui::{Color32, Pos2, Rect, Shape, epaint::ColorMode, vec2};
use egui_kittest::{Harness, kittest::Queryable as _};
use interwell::app::views::View;
use interwell::app::window::{Command, Window};
use interwell::scene::Excitation;

use crate::support::{PROJECTED, WIDE, command, is_painted, painted, window};

const MASS: Color32 = Color32::from_rgb(230, 159, 0);

/// A window that shows these views alone.
fn showing(preset: &str, size: [f32; 2], views: &[View]) -> Harness<'static, Window> {
    let mut harness = window(preset, size);
    for view in View::ALL {
        command(&mut harness, Command::Show(view, views.contains(&view)));
    }
    harness.state_mut().session.player.set_playing(false);
    harness.run_steps(8);
    harness
}

fn set(harness: &mut Harness<'static, Window>, path: &str, value: f64) {
    harness.state_mut().session.set_number(path, value).unwrap();
    harness.state_mut().session.end_gesture();
    harness.run_steps(8);
}

fn number(text: &str) -> Option<f64> {
    text.replace('\u{2212}', "-").parse().ok()
}

/// Whether a text is the name of a vertical axis, or its unit alone.
fn is_title(text: &(String, Rect, Rect), name: &str) -> bool {
    text.0 == name && (text.1.height() > text.1.width() || name.len() < 5)
}

/// The numbers of the vertical axis of the picture that is called so at its side, with their heights; and
/// those of the axis below it.
pub fn axes(harness: &Harness<'static, Window>, name: &str) -> [Vec<(f64, f32)>; 2] {
    let all = painted(harness);
    let title =
        all.iter().find(|text| is_title(text, name)).unwrap_or_else(|| panic!("{name}: {all:?}")).clone();
    let beside = |text: &&(String, Rect, Rect)| {
        let gap = text.1.left() - title.1.right();
        (-8.0..60.0).contains(&gap) && title.2.intersects(text.1)
    };
    let numbers = all.iter().filter_map(|text| Some((number(&text.0)?, text))).collect::<Vec<_>>();
    let up = numbers.iter().filter(|number| beside(&number.1));
    let up: Vec<_> = up.map(|(value, text)| (*value, text.1.center().y)).collect();
    // the lowest row of numbers in the picture
    let inside = numbers.iter().map(|number| number.1).filter(|text| title.2.contains_rect(text.1));
    let right: Vec<_> = inside.filter(|text| text.1.left() > title.1.right() + 30.0).collect();
    let lowest = right.iter().map(|text| text.1.center().y).fold(0.0, f32::max);
    let below = numbers.iter().filter(|(_, text)| right.contains(text) && text.1.center().y > lowest - 2.0);
    [up, below.map(|(value, text)| (*value, text.1.center().x)).collect()]
}

fn shapes(harness: &Harness<'static, Window>) -> Vec<Shape> {
    fn flat(shape: &Shape, into: &mut Vec<Shape>) {
        match shape {
            Shape::Vec(all) => all.iter().for_each(|shape| flat(shape, into)),
            other => into.push(other.clone()),
        }
    }
    let mut all = Vec::new();
    harness.output().shapes.iter().for_each(|clipped| flat(&clipped.shape, &mut all));
    all
}

/// The circle of the mass, and the box.
fn masses(harness: &Harness<'static, Window>) -> (Option<Rect>, Option<Rect>) {
    let all = shapes(harness);
    let ball = all.iter().find_map(|shape| match shape {
        Shape::Circle(circle) if circle.fill == MASS && circle.radius > 10.0 => {
            Some(Rect::from_center_size(circle.center, eframe::egui::Vec2::splat(2.0 * circle.radius)))
        }
        _ => None,
    });
    let body = all.iter().find_map(|shape| match shape {
        Shape::Rect(rect) if rect.fill == MASS && rect.rect.height() > 30.0 => Some(rect.rect),
        _ => None,
    });
    (ball, body)
}

fn wall(harness: &Harness<'static, Window>, name: &str) -> Rect {
    use egui_kittest::kittest::Queryable as _;
    let grab = harness.get_by_role_and_label(eframe::egui::accesskit::Role::Slider, name).rect();
    Rect::from_center_size(grab.center(), eframe::egui::vec2(10.0, grab.height()))
}

#[test]
fn the_well_has_an_axis_of_energy_and_the_height_of_its_barrier() {
    let mut harness = showing("first-look", WIDE, &[View::Well]);
    let [before, _] = axes(&harness, "energy (mJ)");
    assert!(before.len() > 2, "{before:?}");
    assert!(is_painted(&harness, "barrier 0.92 mJ"), "{:?}", painted(&harness));
    // its scale holds while the preload moves, and afterwards
    set(&mut harness, "mechanism.preload_mm", 1.6);
    let [after, _] = axes(&harness, "energy (mJ)");
    assert_eq!(before, after);
    assert!(!is_painted(&harness, "barrier 0.92 mJ") && is_painted(&harness, "barrier 0."));
    // energy is counted from the bottom of the deepest well
    let height = harness.state().session.model().mechanism().landscape.barrier.unwrap().from_left_j;
    assert!(is_painted(&harness, &format!("barrier {:.2} mJ", height * 1e3)), "{height}");
    // a harder push than that of the reference has another scale
    set(&mut harness, "excitation.amplitude_g", 1.8);
    assert_ne!(axes(&harness, "energy (mJ)")[0], before);
}

#[test]
fn every_curve_of_the_well_is_in_its_legend() {
    let harness = showing("paper", WIDE, &[View::Well]);
    for name in ["with the push", "without the push", "beyond the stops"] {
        assert!(is_painted(&harness, name), "{name}");
    }
    assert!(!is_painted(&showing("first-look", WIDE, &[View::Well]), "beyond the stops"));
    // where nothing shakes there is no push
    let ball = showing("bouncing-ball", WIDE, &[View::Well]);
    assert!(is_painted(&ball, "potential") && !is_painted(&ball, "with the push"));
}

#[test]
fn the_force_curve_has_the_force_and_the_push_that_frees_the_mass() {
    for size in [WIDE, PROJECTED] {
        let harness = showing("paper", size, &[View::ForceCurve]);
        let all = painted(&harness);
        let model = harness.state().session.model();
        let force = model.mechanism().curve.force(1.5e-3).abs();
        let text = format!("frees the mass: {force:.3} N = {:.3} g", force / model.mass() / 9.80665);
        assert_eq!(all.iter().filter(|label| label.0 == text).count(), 1, "{text}");
        keep_apart(&harness);
    }
}

/// No two texts lie over each other.
fn keep_apart(harness: &Harness<'static, Window>) {
    let all = painted(harness);
    let seen: Vec<_> = all.iter().filter(|text| text.2.intersects(text.1) && text.1.is_positive()).collect();
    for (i, text) in seen.iter().enumerate() {
        for other in &seen[i + 1..] {
            let over = text.1.shrink(1.5).intersects(other.1.shrink(1.5));
            assert!(!over || text.0 == other.0, "{text:?} {other:?}");
        }
    }
}

#[test]
fn axes_fit_what_they_show() {
    let ends = |view: View, name: &str| {
        let harness = showing("paper", WIDE, &[view]);
        let numbers = axes(&harness, name);
        let axis = &numbers[usize::from(view != View::Displacement)];
        (axis.len(), axis.iter().map(|number| number.0.abs()).fold(0.0, f64::max))
    };
    // the stops are at 1.5 mm, the wells at 6.3 mm
    for (view, name) in [
        (View::Displacement, "displacement (mm)"),
        (View::PhasePortrait, "velocity (mm/s)"),
        (View::Section, "velocity (mm/s)"),
    ] {
        let (count, largest) = ends(view, name);
        assert!(count > 2 && (1.5..2.5).contains(&largest), "{}: {count} {largest}", view.name());
    }
    for (view, name) in [(View::Well, "energy (mJ)"), (View::ForceCurve, "holding force (N)")] {
        let (count, largest) = ends(view, name);
        assert!(count > 2 && (6.0..9.0).contains(&largest), "{}: {count} {largest}", view.name());
    }
}

#[test]
fn every_axis_has_three_numbers_and_its_unit_in_its_name() {
    let names = [
        (View::Well, ["energy (mJ)", "mJ"]),
        (View::ForceCurve, ["holding force (N)", "N"]),
        (View::PhasePortrait, ["velocity (mm/s)", "mm/s"]),
        (View::Displacement, ["displacement (mm)", "mm"]),
    ];
    for size in [WIDE, PROJECTED, [1920.0, 1080.0]] {
        let mut harness = window("paper", size);
        command(&mut harness, Command::Arrange(interwell::scene::Layout::Study));
        harness.run_steps(8);
        for (view, names) in names {
            if !harness.state().tiling.shows(view) {
                continue;
            }
            let all = painted(&harness);
            // none where it is behind another tab
            let Some(name) = names.into_iter().find(|name| all.iter().any(|text| is_title(text, name)))
            else {
                continue;
            };
            let [up, _] = axes(&harness, name);
            assert!(up.len() > 2, "{size:?} {}: {up:?}", view.name());
        }
        let with_unit = |text: &str| text.strip_suffix(" mm").is_some_and(|text| number(text).is_some());
        // but for the bar that shows a length
        assert!(painted(&harness).iter().all(|text| text.0 == "10 mm" || !with_unit(&text.0)));
    }
}

/// In the mechanism the mass touches its stop; in the well its middle, which is read on the axis, is at the
/// face.
#[test]
fn the_mass_meets_its_stop_at_the_travel_limit() {
    for (preset, view) in [("paper", View::Mechanism), ("paper", View::Well), ("duffing", View::Well)] {
        let mut harness = showing(preset, WIDE, &[view]);
        if preset == "duffing" {
            assert!(masses(&harness).0.unwrap().width() > 26.0);
            continue;
        }
        harness.state_mut().session.player.hold(1.5e-3);
        harness.run_steps(3);
        let (ball, body) = masses(&harness);
        let (mass, touching) = match view {
            View::Well => (ball.unwrap(), ball.unwrap().center().x),
            _ => (body.unwrap(), body.unwrap().right()),
        };
        let stop = wall(&harness, "right stop");
        assert!(mass.width() > 26.0 && (touching - stop.left()).abs() < 1.0, "{mass:?} {stop:?}");
    }
}

/// Whether a line of this colour runs through `place`.
fn is_crossed(all: &[Shape], place: Rect, colour: Color32) -> bool {
    let through = |points: &[Pos2]| {
        points.windows(2).any(|pair| {
            let steps = pair[0].distance(pair[1]).ceil().clamp(1.0, 2000.0);
            (0..=steps as u32).any(|i| place.contains(pair[0].lerp(pair[1], i as f32 / steps)))
        })
    };
    all.iter().any(|shape| match shape {
        Shape::Path(path) => path.stroke.color == ColorMode::Solid(colour) && through(&path.points),
        _ => false,
    })
}

#[test]
fn names_of_parts_keep_clear_of_what_is_drawn() {
    let names = ["mass", "flexure", "stop", "spring", "magnets", "load", "coil", "spring 50"];
    for (preset, size) in [("paper", WIDE), ("first-look", WIDE), ("magnet", WIDE), ("harvester", PROJECTED)]
    {
        let mut harness = showing(preset, size, &[View::Mechanism]);
        let mut count = 0;
        for step in -8..=8 {
            harness.state_mut().session.player.hold(f64::from(step) * 0.8e-3);
            harness.run_steps(2);
            let (_, body) = masses(&harness);
            let all = shapes(&harness);
            let ink = interwell::app::ui::style::Style::of(&harness.ctx, false).ink();
            for (text, place, _) in painted(&harness) {
                if names.iter().any(|name| text.starts_with(name)) && !text.contains(" from ") {
                    let inner = place.shrink(1.0);
                    assert!(!is_crossed(&all, inner, ink), "{preset} at {step}: {text} {place:?}");
                    assert!(!body.unwrap().intersects(inner), "{preset} at {step}: {text}");
                    count += 1;
                }
            }
        }
        assert!(count > 17, "{preset}: {count}");
    }
}

#[test]
fn a_legend_is_whole_in_a_narrow_card() {
    let names = [
        (View::Well, &["with the push", "without the push", "beyond the stops"][..]),
        (View::Displacement, &["at rest on a stop", "stop", "impact"]),
        (View::PhasePortrait, &["separatrix", "once a period", "impact", "at rest", "unstable equilibrium"]),
    ];
    let mut count = 0;
    for size in [[1024.0, 700.0], [640.0, 480.0], PROJECTED, WIDE] {
        for (view, names) in names {
            let mut harness = showing("paper", size, &[view, View::Mechanism]);
            harness.state_mut().session.player.set_playing(true);
            harness.state_mut().session.player.speed = 1.0;
            harness.run_steps(20);
            let Some(place) = harness.state().tiling.place_of(view) else { continue };
            let all = painted(&harness);
            count += 1;
            for name in names {
                let is_whole = |text: &&(String, Rect, Rect)| {
                    text.0 == *name && place.contains_rect(text.1) && text.2.contains_rect(text.1)
                };
                assert!(all.iter().any(|text| is_whole(&text)), "{view:?} {size:?}: {name} {place:?}");
            }
        }
    }
    assert!(count >= 9, "{count}");
}

/// Every circle of this radius whose middle is seen.
fn circles(harness: &Harness<'static, Window>, radius: f32) -> Vec<(Rect, Rect)> {
    let all = harness.output().shapes.iter().filter_map(|clipped| match &clipped.shape {
        Shape::Circle(circle) if circle.radius == radius && clipped.clip_rect.contains(circle.center) => {
            Some((Rect::from_center_size(circle.center, vec2(2.0 * radius, 2.0 * radius)), clipped.clip_rect))
        }
        _ => None,
    });
    all.collect()
}

#[test]
fn the_mass_is_whole_at_the_ends_of_the_axes() {
    for (view, radius) in [(View::ForceCurve, 7.0), (View::Well, 13.5)] {
        let mut harness = showing("paper-unconstrained", WIDE, &[view]);
        let mut seen = 0;
        for i in 0..80 {
            harness.state_mut().session.player.hold((6.0 + 0.025 * f64::from(i)) * 1e-3);
            harness.run_steps(1);
            let all = circles(&harness, radius);
            let frame = harness.state().tiling.place_of(view).unwrap();
            for (circle, clip) in all.into_iter().filter(|ball| frame.contains_rect(ball.0)) {
                // one that is drawn beyond the axis is not seen
                let is_inside = clip.shrink(radius + 1.0).contains(circle.center());
                assert!(!is_inside || clip.contains_rect(circle), "{view:?} {circle:?} {clip:?}");
                seen += usize::from(is_inside);
            }
        }
        assert!(seen > 10, "{view:?}: {seen}");
    }
}

#[test]
fn a_coil_lies_clear_of_the_stops() {
    for size in [WIDE, PROJECTED, [1920.0, 1080.0]] {
        let harness = showing("harvester", size, &[View::Mechanism]);
        let style = interwell::app::ui::style::Style::of(&harness.ctx, false);
        let rects = |fill: eframe::egui::Color32| -> Vec<Rect> {
            let of_shape = |shape: &Shape| match shape {
                Shape::Rect(rect) if rect.fill == fill => Some(rect.rect),
                _ => None,
            };
            let parts = |clipped: &eframe::egui::epaint::ClippedShape| match &clipped.shape {
                Shape::Vec(all) => all.iter().filter_map(of_shape).collect(),
                shape => of_shape(shape).into_iter().collect::<Vec<Rect>>(),
            };
            harness.output().shapes.iter().flat_map(parts).collect()
        };
        let (walls, coil) = (rects(style.stop()), rects(style.colour(interwell::output::Role::Frame)));
        let coil: Vec<Rect> = coil.into_iter().filter(|rect| (6.0..8.0).contains(&rect.height())).collect();
        assert!(walls.len() >= 2 && coil.len() >= 2, "{size:?} {walls:?} {coil:?}");
        for wall in walls {
            assert!(coil.iter().all(|row| !row.intersects(wall)), "{size:?} {wall:?} {coil:?}");
        }
    }
}

#[test]
fn the_headings_of_energy_stand_apart() {
    for size in [WIDE, PROJECTED, [1024.0, 700.0], [1920.0, 1080.0]] {
        keep_apart(&showing("paper", size, &[View::Energy]));
    }
    let mut harness = window("paper", [1024.0, 700.0]);
    command(&mut harness, Command::Arrange(interwell::scene::Layout::Study));
    command(&mut harness, Command::Show(View::Energy, true));
    let all = painted(&harness);
    let heads = [["since the start", "last period"], ["total", "period"]];
    let heads = heads.iter().find_map(|pair| {
        let [a, b] = pair.map(|head| all.iter().find(|text| text.0 == head && text.2.intersects(text.1)));
        Some((a?.1, b?.1))
    });
    assert!(heads.is_none_or(|(start, period)| period.right() + 6.0 < start.left()), "{heads:?}");
}

/// The texts that are seen and lie at least in part in one of a view.
fn seen_in(harness: &Harness<'static, Window>, view: View) -> Vec<(String, Rect)> {
    let place = harness.state().tiling.place_of(view).unwrap();
    let all =
        painted(harness).into_iter().filter(|text| text.2.intersects(text.1) && place.intersects(text.1));
    all.map(|text| (text.0, text.1)).collect()
}

#[test]
fn what_is_read_under_the_pointer_lies_over_no_title() {
    let readings = [
        (View::PhasePortrait, "mm/s", ["displacement (mm)", "velocity (mm/s)"]),
        (View::ForceCurve, "holds it at", ["displacement (mm)", "holding force (N)"]),
        (View::Displacement, " mm at ", ["time (s)", "displacement (mm)"]),
    ];
    for size in [WIDE, PROJECTED] {
        for (view, reading, titles) in readings {
            let mut harness = showing("paper", size, &[view]);
            let place = harness.state().tiling.place_of(view).unwrap();
            harness.hover_at(place.center());
            harness.run_steps(3);
            let all = seen_in(&harness, view);
            let begins = |text: &str| text.starts_with(|c: char| c == '\u{2212}' || c.is_ascii_digit());
            let read = all.iter().find(|text| text.0.contains(reading) && begins(&text.0));
            let (_, read) = read.unwrap_or_else(|| panic!("{view:?}: {all:?}"));
            for title in titles {
                let title =
                    all.iter().find(|text| text.0 == title).unwrap_or_else(|| panic!("{title}: {all:?}"));
                assert!(!title.1.intersects(*read), "{view:?} {size:?}: {read:?} {title:?}");
            }
            // in the row of the legend or a corner of the picture, over no other text
            let others = all.iter().filter(|text| text.1 != *read);
            let over: Vec<_> = others.filter(|text| text.1.intersects(*read)).collect();
            assert!(over.is_empty(), "{view:?}: {read:?} {over:?}");
            let (x, y) = (read.center().x, read.center().y);
            let is_aside = (x - place.center().x).abs() > 0.1 * place.width()
                && (y - place.center().y).abs() > 0.25 * place.height();
            assert!(is_aside, "{view:?}: {read:?} {place:?}");
        }
    }
}

#[test]
fn the_legend_of_the_phase_portrait_has_the_square_at_rest() {
    assert!(is_painted(&showing("paper", WIDE, &[View::PhasePortrait]), "at rest"));
    let harness = showing("first-look", WIDE, &[View::PhasePortrait]);
    assert!(is_painted(&harness, "separatrix") && !is_painted(&harness, "at rest"));
}

/// Axes, grid, separatrix and legend are one shape, the path and its points another.
#[test]
fn a_live_picture_is_few_shapes() {
    for view in [View::PhasePortrait, View::ForceCurve, View::Displacement, View::Power, View::Well] {
        let mut harness = showing("paper", WIDE, &[view]);
        harness.state_mut().session.player.speed = 1.0;
        harness.state_mut().session.player.tick(2.0);
        harness.run_steps(3);
        let place = harness.state().tiling.place_of(view).unwrap();
        let is_text = |shape: &Shape| matches!(shape, Shape::Text(_) | Shape::Noop);
        let of_view = harness.output().shapes.iter().filter(|clipped| place.contains_rect(clipped.clip_rect));
        let count = of_view.filter(|clipped| !is_text(&clipped.shape)).count();
        // the hatching of two walls among them
        assert!(count < 250, "{view:?}: {count}");
    }
}

#[test]
fn a_force_on_the_mass_is_drawn_in_newtons_and_moves_no_base() {
    let push = |harness: &Harness<'static, Window>| {
        let texts = painted(harness).into_iter().map(|text| text.0);
        texts.filter(|text| text.starts_with("push ")).collect::<Vec<_>>()
    };
    let mut harness = showing("paper", WIDE, &[View::Mechanism]);
    let foot = harness.state().tiling.place_of(View::Mechanism).unwrap().left_bottom();
    harness.hover_at(foot + vec2(40.0, -36.0));
    harness.run_steps(90);
    assert!(harness.query_by_label_contains("The base moves by \u{b1}27.6 mm").is_some());
    assert!(matches!(&push(&harness)[..], [text] if text.ends_with(" g")), "{:?}", push(&harness));
    harness.state_mut().session.edit_once(|scene| {
        scene.excitation =
            Excitation::Force { amplitude_n: 0.149, frequency_rad_per_s: TAU * 3.0, phase_deg: 0.0 };
    });
    harness.run_steps(8);
    let [text] = &push(&harness)[..] else { panic!("{:?}", push(&harness)) };
    let newtons: f64 = text.strip_prefix("push ").unwrap().strip_suffix(" N").unwrap().parse().unwrap();
    let session = &harness.state().session;
    let expected = session.shown().mass() * session.player.state().base_accel.abs();
    assert!((newtons - expected).abs() <= 0.005 + 1e-9, "{newtons}, not {expected}");
    assert!(!is_painted(&harness, "base"), "nothing is said of a base that stands still");
}

/// The numbers of the travel limits stand outside of the walls, where the mass does not cover them.
#[test]
fn numbers_of_travel_limits_stand_outside() {
    let mut harness = showing("paper", WIDE, &[View::Well]);
    for limit in [0.1, 0.3, 0.6, 1.0, 1.5, 2.5, 4.0] {
        set(&mut harness, "stops.travel_limit_mm", limit);
        // without the stops of the reference
        harness.state_mut().session.pin().unwrap();
        harness.run_steps(2);
        let all = painted(&harness);
        let written = format!("{limit:.2}");
        let [_, below] = axes(&harness, "energy (mJ)");
        // the field of the slider stands to the left of the picture
        let inside = |x: &f32| *x > below[0].1;
        let at = |text: &str| {
            all.iter().filter(|found| found.0 == text).map(|found| found.1.center().x).find(inside).unwrap()
        };
        let (left, right) = (at(&format!("\u{2212}{written}")), at(&written));
        let scale = (below[1].1 - below[0].1) / (below[1].0 - below[0].0) as f32;
        let middle = below[0].1 - below[0].0 as f32 * scale;
        let lines = [-limit, limit].map(|mm| middle + mm as f32 * scale);
        assert!(left < lines[0] && right > lines[1], "{limit}: {left} and {right} about {lines:?}");
    }
}
