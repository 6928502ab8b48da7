//! What a picture leaves out: the extremes of each stretch of a column stand in it, and so does each gap.

use std::ops::Range;

use interwell::dynamics::{Event, EventKind, LiveLedger, Request};
use interwell::output::{
    Area, Caption, Frame, Layer, Marks, PlotAxis, Ranges, Role, RunPanel, Shape, Theme, distance_chart,
    measured_chart, run_chart,
};
use interwell::questions::DistanceAnswer;
use interwell::scene::Quantity;
use interwell_studies::study::{Comparison, Keep, Table, Trace, simulate_with_trace};
use proptest::prelude::*;
use proptest::test_runner::TestCaseError;

use crate::properties::harness::{Verdict, hold_for};
use crate::shared::{build, changed, preset};

type Point = (f64, f64);

/// Distance below which a point of a path is left out beside another one, in units of the canvas.
const NEAR: f64 = 0.36;
/// Half the length of the dash that stands for a single point.
const DASH: f64 = 4.0;

/// Values of a column with gaps of one or two rows: noise, with peaks a hundred times as high and jumps.
fn column() -> impl Strategy<Value = Vec<f64>> {
    let value = prop_oneof![20 => -1.0..1.0f64, 1 => -100.0..100.0f64];
    let stretch = (-20.0..20.0f64, prop::collection::vec(value, 1..300));
    let stretch = prop_oneof![6 => stretch.clone(), 1 => stretch.prop_map(|(at, mut all)| {
        all.truncate(1);
        (at, all)
    })];
    prop::collection::vec((stretch, 1..3usize), 1..7).prop_map(|stretches| {
        let mut values = Vec::new();
        for ((at, stretch), gap) in stretches {
            values.extend(stretch.iter().map(|value| at + value));
            values.extend(std::iter::repeat_n(f64::NAN, gap));
        }
        values
    })
}

/// The rows of each stretch without a gap.
fn stretches(points: &[Point]) -> Vec<Range<usize>> {
    let known = |i: usize| points[i].0.is_finite() && points[i].1.is_finite();
    let mut found: Vec<Range<usize>> = Vec::new();
    for i in (0..points.len()).filter(|i| known(*i)) {
        match found.last_mut() {
            Some(last) if last.end == i => last.end += 1,
            _ => found.push(i..i + 1),
        }
    }
    found
}

/// Holds the shapes of a line in a frame against its points.
fn shows_all(frame: &Frame, marks: Marks) -> Verdict {
    let (points, is_path) = match &marks {
        Marks::Trace(points) => (points.clone(), false),
        Marks::Path(points) => (points.clone(), true),
        other => return Err(TestCaseError::fail(format!("{other:?} is not a line"))),
    };
    let drawn: Vec<Vec<Point>> = frame
        .shapes(&[Layer::new(Role::Curve, "", marks)], &Theme::LIGHT)
        .into_iter()
        .map(|shape| match shape {
            Shape::Line(points, ..) => points,
            other => panic!("{other:?}"),
        })
        .collect();
    let parts = stretches(&points);
    for part in &parts {
        let places: Vec<Point> = points[part.clone()].iter().map(|point| frame.place(*point)).collect();
        if let [(x, y)] = places[..] {
            let dash = vec![(x - DASH, y), (x + DASH, y)];
            let is_drawn =
                drawn.iter().any(|line| line.iter().all(|at| (at.0 - x).abs() <= DASH && at.1 == y));
            prop_assert!(is_drawn, "no dash {dash:?}");
            continue;
        }
        let by = |a: &&Point, b: &&Point| a.1.total_cmp(&b.1);
        let ends = [places.first(), places.iter().min_by(by), places.iter().max_by(by), places.last()];
        for (x, y) in ends.into_iter().flatten() {
            let near = |at: &Point| (at.0 - x).hypot(at.1 - y) <= if is_path { NEAR } else { 1e-6 };
            // several points of a pixel may be as high
            let same = |at: &Point| (at.1 - y).abs() < 1e-6 && (at.0 - x).abs() <= 1.0;
            let is_drawn = drawn.iter().flatten().any(|at| near(at) || same(at));
            prop_assert!(is_drawn, "({x}, {y}) of {:?} is not drawn", part);
        }
    }
    for line in &drawn {
        let of = |pick: fn(f64, f64) -> f64, end: f64| line.iter().map(|at| at.0).fold(end, pick);
        let (left, right) = (of(f64::min, f64::INFINITY), of(f64::max, f64::NEG_INFINITY));
        let is_of = |part: &Range<usize>| {
            let more = if part.len() == 1 { DASH } else { 0.0 } + 1e-6;
            let ends = [part.start, part.end - 1].map(|i| frame.across(points[i].0));
            ends[0] - more <= left && right <= ends[1] + more
        };
        prop_assert!(parts.iter().any(is_of), "a line from {left} to {right} joins the ends of a gap");
    }
    Ok(())
}

fn frame_about(points: &[Point], width: f64) -> Frame {
    let x = PlotAxis::around(points.iter().map(|point| point.0), 0.0, "");
    let y = PlotAxis::around(points.iter().map(|point| point.1), 0.1, "");
    Frame { area: Area::new(40.0, 20.0, 40.0 + width, 520.0), x, y }
}

#[test]
fn a_line_shows_the_extremes_of_each_stretch_and_each_gap() {
    let drawn = (column(), 30.0..900.0f64, any::<bool>());
    let show = |drawn: &(Vec<f64>, f64, bool)| format!("{drawn:?}");
    hold_for("a_line_shows_extremes_and_gaps", 300, 1.0, drawn, show, |(values, width, is_path)| {
        let points: Vec<Point> = (0_u32..).map(f64::from).zip(values.iter().copied()).collect();
        let frame = frame_about(&points, *width);
        shows_all(&frame, if *is_path { Marks::Path(points) } else { Marks::Trace(points) })?;
        Ok(true)
    });
}

/// The lines of the panels of a chart, with the frames that they stand in.
fn lines(chart: &interwell::output::Chart) -> Vec<(Frame, Layer)> {
    let figure = chart.figure(&Caption::default(), &Theme::LIGHT);
    let layers = chart.panels().zip(&figure.frames).flat_map(|(panel, frame)| {
        let lines = panel.layers.iter().filter(|layer| {
            matches!(
                layer.role,
                Role::Motion | Role::Second | Role::Drive | Role::Total | Role::Potential | Role::Measured
            )
        });
        lines.map(move |layer| (frame.clone(), layer.clone()))
    });
    layers.filter(|(_, layer)| matches!(layer.marks, Marks::Trace(_) | Marks::Path(_))).collect()
}

/// Whether the points of a line are those of a column, in some unit.
fn is_column(points: &[Point], values: &[f64]) -> Verdict {
    prop_assert_eq!(points.len(), values.len());
    let ratio = |i: &usize| points[*i].1 / values[*i];
    let scale = (0..values.len()).filter(|i| values[*i].is_finite()).map(|i| ratio(&i)).next().unwrap_or(1.0);
    for i in 0..values.len() {
        let same = if values[i].is_finite() {
            (ratio(&i) / scale - 1.0).abs() < 1e-9
        } else {
            !points[i].1.is_finite()
        };
        prop_assert!(same, "row {i}: {} for {}", points[i].1, values[i]);
    }
    Ok(())
}

/// A run whose columns are these, one row every millisecond.
fn trace(columns: &[Vec<f64>; 4]) -> Trace {
    let count = columns.iter().map(Vec::len).min().unwrap_or(0).max(2);
    let of = |place: usize| -> Vec<f64> {
        (0..count).map(|i| columns[place].get(i).copied().unwrap_or(f64::NAN)).collect()
    };
    let t: Vec<f64> = (0..count).map(|i| i as f64 * 1e-3).collect();
    let end = t[count - 1];
    let names = ["x_m", "v_m_per_s", "base_accel_m_per_s2", "power_w"];
    let path = names
        .iter()
        .enumerate()
        .fold(Table::new().with("t_s", t.into_iter().collect()), |table, (i, name)| {
            table.with(*name, of(i).into_iter().collect())
        });
    let empty = |names: &[&str]| {
        names
            .iter()
            .fold(Table::new(), |table, name| table.with(*name, Vec::<f64>::new().into_iter().collect()))
    };
    Trace {
        path,
        has_load: true,
        impacts: empty(&["t_s"]),
        rests: empty(&["from_s", "to_s"]),
        strobes: empty(&["t_s", "x_m", "v_m_per_s"]),
        portrait_from: 0.0,
        shown_from: 0.0,
        shown_to: end,
        is_section: true,
        stops: (f64::NAN, f64::NAN),
        end,
        ledger: LiveLedger::default(),
    }
}

#[test]
fn every_picture_over_time_shows_the_extremes_and_gaps_of_its_column() {
    let model = preset("duffing", &["run.duration_s=1", "run.settle_s=None"]);
    let summary = model.run(&Request::default()).summary;
    let drawn = [column(), column(), column(), column()];
    let show = |columns: &[Vec<f64>; 4]| format!("{columns:?}");
    hold_for("pictures_show_extremes_and_gaps", 40, 1.0, drawn, show, |columns| {
        let trace = trace(columns);
        let column = |name: &str| trace.path.numbers(name).unwrap();
        let panels = [RunPanel::Displacement, RunPanel::Velocity, RunPanel::Acceleration, RunPanel::Power];
        let chart = run_chart(&trace, &summary, &model, &panels, Ranges::default());
        let lines_of = lines(&chart);
        prop_assert_eq!(lines_of.len(), panels.len());
        let names = ["x_m", "v_m_per_s", "base_accel_m_per_s2", "power_w"];
        for ((frame, layer), name) in lines_of.into_iter().zip(names) {
            let Marks::Trace(points) = &layer.marks else { panic!("{:?}", layer.marks) };
            is_column(points, column(name))?;
            shows_all(&frame, layer.marks)?;
        }
        let more = [RunPanel::Energy, RunPanel::Portrait];
        let chart = run_chart(&trace, &summary, &model, &more, Ranges::default());
        let gaps = |name: &str| column(name).iter().filter(|value| !value.is_finite()).count();
        for (frame, layer) in lines(&chart) {
            let (Marks::Trace(points) | Marks::Path(points)) = &layer.marks else { panic!("{layer:?}") };
            let here = points.iter().filter(|at| !(at.0.is_finite() && at.1.is_finite())).count();
            prop_assert!(here >= gaps("x_m"), "{:?}: {here} gaps", layer.role);
            // a portrait may turn back, so that its gaps are not told by their place
            if matches!(layer.marks, Marks::Trace(_)) {
                shows_all(&frame, layer.marks)?;
            }
        }
        // a motion with a measured one over it, and distances of motions
        let t = column("t_s").to_vec();
        let known: Vec<usize> = (0..t.len()).filter(|i| column("v_m_per_s")[*i].is_finite()).collect();
        let of = |values: &[f64]| known.iter().map(|i| values[*i]).collect::<Vec<f64>>();
        let found = Comparison {
            table: Table::new(),
            quantity: Quantity::Displacement,
            times: of(&t),
            measured: of(column("v_m_per_s")),
            computed: of(column("x_m")),
            shift: 0.0,
            rms: (1.0, 1.0),
            remarks: Vec::new(),
        };
        for (frame, layer) in lines(&measured_chart(&trace, &found, None, Ranges::default())) {
            if layer.role == Role::Motion {
                let Marks::Trace(points) = &layer.marks else { panic!("{layer:?}") };
                is_column(points, column("x_m"))?;
            }
            shows_all(&frame, layer.marks)?;
        }
        let line: Vec<Point> = t.iter().zip(column("x_m")).map(|(t, x)| (*t, 1e-3 * x.abs())).collect();
        let chart = distance_chart(&DistanceAnswer { times: (0.0, trace.end), lines: vec![line.clone()] });
        let panel = chart.panels().next().unwrap();
        let [layer] = &panel.layers[..] else { panic!("{:?}", panel.layers) };
        let Marks::Trace(points) = &layer.marks else { panic!("{layer:?}") };
        let gap = |at: &Point| !at.1.is_finite();
        prop_assert!(points.iter().map(gap).eq(line.iter().map(gap)), "the gaps of a distance");
        let frame =
            Frame { area: Area::new(40.0, 20.0, 700.0, 520.0), x: panel.x.clone(), y: panel.y.clone() };
        shows_all(&frame, layer.marks.clone())?;
        Ok(true)
    });
}

/// The power into the load at each impact, before and after it, of a coil without inductance:
/// k^2 R v^2 / (R + r)^2.
fn in_closed_form(event: &Event) -> [f64; 2] {
    let interwell::scene::Transducer::Electromagnetic {
        coupling_v_s_per_m: k,
        coil_ohm: r,
        load_ohm: load,
        ..
    } = changed("harvester", &[]).scene.transducer
    else {
        panic!("no coil")
    };
    [event.v_in, event.v_out].map(|v| load * (k * v / (r + load)).powi(2))
}

#[test]
fn the_power_over_time_has_its_peaks_at_impacts() {
    let drawn = (0.6..3.0f64, 0.1..0.9f64, 0.5..3.0f64);
    let show = |drawn: &(f64, f64, f64)| format!("{drawn:?}");
    hold_for(
        "the_power_has_its_peaks_at_impacts",
        30,
        0.5,
        drawn,
        show,
        |(amplitude, restitution, limit)| {
            let changes = [
                format!("excitation.amplitude_g={amplitude}"),
                format!("stops.restitution={restitution}"),
                format!("stops.travel_limit_mm={limit}"),
                "run.duration_s=3".to_owned(),
                "run.settle_s=None".to_owned(),
            ];
            let model = build(&changed("harvester", &changes.each_ref().map(String::as_str)));
            let (recorded, trace) =
                simulate_with_trace(&model, &Keep { events: true, ..Keep::default() }, None, None);
            let events = model.run(&Request { events: true, ..Request::default() }).events;
            let impacts: Vec<&Event> =
                events.iter().filter(|event| event.kind == EventKind::Impact).collect();
            let chart = run_chart(&trace, &recorded.summary, &model, &[RunPanel::Power], Ranges::default());
            let found = lines(&chart);
            let [(frame, layer)] = &found[..] else { panic!("{chart:?}") };
            let Marks::Trace(points) = &layer.marks else { panic!("{layer:?}") };
            let known = trace.path.numbers("power_w").unwrap();
            prop_assert!(known.iter().all(|power| power.is_finite()), "a row has no power");
            let scale = points
                .iter()
                .zip(known)
                .find(|(_, power)| **power > 0.0)
                .map_or(1.0, |(at, power)| at.1 / power);
            for impact in &impacts {
                for power in in_closed_form(impact) {
                    let has = |at: &&Point| {
                        at.0 == impact.t && (at.1 - scale * power).abs() <= 1e-12 * (scale * power).max(1e-9)
                    };
                    prop_assert!(points.iter().any(|at| has(&at)), "{power} W at {} s", impact.t);
                }
            }
            shows_all(frame, layer.marks.clone())?;
            Ok(!impacts.is_empty())
        },
    );
}
