//! The picture of `best`: every design that was tried, the one that was found, and broken constraints.

use interwell::output::{Chart, Marks, Ranges, best_chart};
use interwell_studies::study::{BestDesign, BestQuestion, DesignRange, Table};

use super::*;
use crate::best::{at_most, found_by, linear, question};

fn charted(question: &BestQuestion) -> (BestDesign, Chart) {
    let design = found_by(question, 2).unwrap();
    let chart = best_chart(question, &design, Ranges::default());
    (design, chart)
}

/// The numbers of the rows of a series.
fn rows(data: &Table, series: &str, column: &str) -> Vec<f64> {
    let numbers = data.numbers(column).unwrap();
    let of_series = data.words("series").iter().zip(numbers).filter(|row| *row.0 == series);
    of_series.map(|(_, number)| *number).collect()
}

fn points(chart: &Chart, name: &str) -> Vec<(f64, f64)> {
    let layers = chart.panels().flat_map(|panel| &panel.layers).filter(|layer| layer.name == name);
    let points = layers.flat_map(|layer| match &layer.marks {
        Marks::Points(points) | Marks::Cloud(points) | Marks::Path(points) => points.clone(),
        other => panic!("{other:?}"),
    });
    points.collect()
}

/// The RMS velocity of an oscillator shaken at its own frequency is A m/(c sqrt 2), the displacement A m/(c
/// w0): those that break the limit are crosses at their value.
#[test]
fn over_one_field_every_value_is_where_the_closed_form_has_it() {
    let mut document = linear();
    document.set("damping=Coefficient(c_n_s_per_m: 1)").unwrap();
    let mut asked = question(&document, ("damping.c_n_s_per_m", 2.0, 12.0), 50);
    let limit = 0.02;
    asked.subject_to = vec![at_most("max_abs_x_m", limit)];
    let (design, chart) = charted(&asked);
    let (c, speed) = ("c_n_s_per_m", "rms_velocity_m_per_s");
    let exact = 1.0 / (limit * 4.0 * std::f64::consts::PI);
    for (series, name, breaks) in [("tried", "tried", false), ("broken", "a constraint broken", true)] {
        let (places, values) = (rows(&chart.data, series, c), rows(&chart.data, series, speed));
        assert!(places.len() > 10 && places.iter().all(|c| (*c < exact) == breaks), "{series}: {places:?}");
        for (c, value) in places.iter().zip(&values) {
            assert!((value * c * 2.0_f64.sqrt() - 1.0).abs() < 1e-6, "{series} {c}: {value}");
        }
        // drawn in mm/s
        let drawn: Vec<(f64, f64)> = places.into_iter().zip(values.iter().map(|value| 1e3 * value)).collect();
        assert_eq!(points(&chart, name), drawn);
    }
    assert_eq!(
        rows(&chart.data, "tried", c).len() + rows(&chart.data, "broken", c).len(),
        design.tried.len()
    );
    assert_eq!(rows(&chart.data, "found", c), design.optimum.at);
    assert_eq!(chart.panels().next().map(|panel| (panel.x.low, panel.x.high)), Some((2.0, 12.0)));
    assert_eq!(points(&chart, "found"), [(design.optimum.at[0], 1e3 * design.optimum.value)]);
    let best = rows(&chart.data, "tried", speed).into_iter().fold(0.0, f64::max);
    assert_eq!(best, design.optimum.value);
}

#[test]
fn over_two_fields_the_scan_is_a_map_and_over_more_the_values_stand_in_order() {
    let mut document = linear();
    document.set("damping=Coefficient(c_n_s_per_m: 1)").unwrap();
    document.set("run.duration_s=20").unwrap();
    document.set("run.settle_s=10").unwrap();
    let mut asked = question(&document, ("damping.c_n_s_per_m", 4.0, 12.0), 4);
    asked.over.push(DesignRange::new("excitation.frequency_hz", (1.0, 3.0), 6));
    let (design, chart) = charted(&asked);
    let [panel] = chart.panels().collect::<Vec<_>>()[..] else { panic!() };
    let (mut map, mut dots) = (Vec::new(), Vec::new());
    for layer in &panel.layers {
        match &layer.marks {
            Marks::Cells(cells) => map = cells.cells.iter().map(|cell| cell.value().unwrap()).collect(),
            Marks::Valued(points, _) => dots = points.clone(),
            _ => {}
        }
    }
    // the scan, each place once, then all others
    assert_eq!((map.len(), map.len() + dots.len()), (5 * 7, design.tried.len()));
    let mut scan: Vec<f64> = design.tried[..35].iter().map(|tried| 1e3 * tried.value.unwrap()).collect();
    scan.sort_by(f64::total_cmp);
    map.sort_by(f64::total_cmp);
    assert_eq!(map, scan);
    assert_eq!(points(&chart, "found"), [(design.optimum.at[0], design.optimum.at[1])]);
    assert!(panel.bar.is_some());
    // the axes span what was searched, and the value has the unit of the bar
    assert_eq!([panel.x.low, panel.x.high, panel.y.low, panel.y.high], [4.0, 12.0, 1.0, 3.0]);
    assert!(chart.subtitle.ends_with(" mm/s"), "{}", chart.subtitle);

    asked.over.push(DesignRange::new("mass_g", (900.0, 1100.0), 2));
    let (design, chart) = charted(&asked);
    let count = design.tried.len() as f64;
    let order = rows(&chart.data, "tried", "evaluation");
    assert_eq!((order.len() as f64, order[0], order[order.len() - 1]), (count, 1.0, count));
    let so_far = points(&chart, "best so far");
    assert!(so_far.windows(2).all(|pair| pair[0].0 <= pair[1].0 && pair[0].1 <= pair[1].1));
    assert!(so_far.last().unwrap().1 >= 1e3 * design.optimum.value);
    let found = points(&chart, "found")[0];
    assert!(so_far.contains(&found), "{found:?}");
}

#[test]
fn the_command_draws_a_search_and_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let line = "best paper --set run.duration_s=6 --over stops.travel_limit_mm=0.5:3:0.25 --vary \
        stops.travel_limit_mm=-5%:5% --plot-data data.csv";
    let mut command = with_plot(line, &folder.path().join("a.svg"));
    command.args(["--out", "/dev/null", "--quiet"]).current_dir(folder.path()).assert().success();
    let texts = texts(&folder.path().join("a.svg"));
    for words in ["travel limit (mm)", "RMS velocity (mm/s)", "tried", "found", "best worst case"] {
        assert!(texts.iter().any(|text| text == words), "{words}: {texts:?}");
    }
    let data = std::fs::read_to_string(folder.path().join("data.csv")).unwrap();
    assert_eq!(data.lines().next(), Some("series,evaluation,travel_limit_mm,rms_velocity_m_per_s"));
    let count = |series: &str| column(&data, "series").iter().filter(|name| *name == series).count();
    assert_eq!((count("found"), count("best_worst_case")), (1, 1));
    assert!(count("tried") > 30);
}
