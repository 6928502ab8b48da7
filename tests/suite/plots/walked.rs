//! Pictures of walks up and down a field: where the ways differ, where a motion jumps, what has not settled.

use interwell::output::{Caption, Layer, Marks, Role, Shape, SweepPicture, Theme, sweep_chart};
use interwell_studies::study::{Grid, Table};
use proptest::prelude::*;

use super::{column, plot, stdout};
use crate::properties::harness::hold_for;
use crate::shared::changed;

/// A walk with two branches of motions: number of values, the first and the last value at which the ways
/// differ, whether the upper branch crosses the barrier or is one of the same well, the slope of both, the
/// rows that have not settled, and whether the quantity is the RMS velocity.
#[derive(Debug, Clone)]
struct Walk {
    count: usize,
    differ: (usize, usize),
    crosses: bool,
    slope: f64,
    transients: Vec<bool>,
    is_rms: bool,
}

fn walks() -> impl Strategy<Value = Walk> {
    (6..40usize, any::<(bool, bool)>(), -1.0..1.0f64).prop_flat_map(|(count, (crosses, is_rms), slope)| {
        let differ = (1..count - 3).prop_flat_map(move |first| (Just(first), first + 1..count - 1));
        let transients = prop::collection::vec(prop_oneof![6 => Just(false), 1 => Just(true)], 2 * count);
        (differ, transients).prop_map(move |(differ, transients)| Walk {
            count,
            differ,
            crosses,
            slope,
            transients,
            is_rms,
        })
    })
}

impl Walk {
    /// The rows of both ways: value, way, whether it is on the upper branch, whether it may be a transient.
    fn rows(&self) -> Vec<(f64, &'static str, bool, bool)> {
        let row = |i: usize, way: &'static str| {
            let is_up = way == "up";
            let upper = if is_up { i > self.differ.1 } else { i >= self.differ.0 };
            let place = if is_up { i } else { self.count + i };
            // what tells the ways apart is known at the ends of a difference
            (self.at(i), way, upper, self.transients[place] && !(self.differ.0..=self.differ.1).contains(&i))
        };
        (0..self.count).map(|i| row(i, "up")).chain((0..self.count).rev().map(|i| row(i, "down"))).collect()
    }

    fn at(&self, i: usize) -> f64 {
        0.25 + 0.05 * i as f64
    }

    /// Height of a branch, in m/s or m.
    fn height(&self, at: f64, upper: bool) -> f64 {
        if upper { 0.5 + 0.02 * self.slope * at } else { 0.1 + 0.03 * self.slope * at }
    }

    fn table(&self) -> Table {
        let rows = self.rows();
        let regime = |upper: bool| match (self.crosses, upper) {
            (false, _) => "",
            (true, true) => "interwell",
            (true, false) => "intrawell",
        };
        let table =
            Table::new().each("amplitude_g", &rows, |row| row.0).each("direction", &rows, |row| row.1);
        let table = table.each("rms_velocity_m_per_s", &rows, |row| self.height(row.0, row.2));
        let table = table.each("max_abs_x_m", &rows, |row| 2.0 * self.height(row.0, row.2));
        let table = table.each("regime", &rows, |row| regime(row.2)).each("outcome", &rows, |_| "done");
        let table = table.each("period", &rows, |row| if row.3 { f64::NAN } else { 1.0 });
        let table = table.each("settled", &rows, |row| if row.3 { "false" } else { "true" });
        table.each("steady", &rows, |row| if row.3 { "false" } else { "true" })
    }

    /// The pairs of values between which the way `up` or `down` jumps.
    fn jump(&self, way: &str) -> (f64, f64) {
        let i = if way == "up" { self.differ.1 } else { self.differ.0 - 1 };
        (self.at(i), self.at(i + 1))
    }
}

#[test]
fn a_band_of_hysteresis_ends_at_rows_and_a_jump_is_a_gap() {
    let document = changed("paper", &[]);
    let show = |walk: &Walk| format!("{walk:?}");
    hold_for("hysteresis_ends_at_rows_and_a_jump_is_a_gap", 300, 1.0, walks(), show, |walk| {
        let over = format!("excitation.amplitude_g={}:{}:0.05", walk.at(0), walk.at(walk.count - 1));
        let grid = Grid::new(document.axes(&[over.as_str()]).unwrap()).unwrap();
        let rows = walk.table();
        let quantity = if walk.is_rms { "rms_velocity_m_per_s" } else { "max_abs_x_m" };
        let picture = SweepPicture::of_rows(&rows, &grid, &document.scene, quantity);
        let chart = sweep_chart(&picture).unwrap();
        let panel = chart.panels().next().unwrap();
        let of = |role: Role| panel.layers.iter().filter(move |layer| layer.role == role);
        let bands: Vec<&Layer> = of(Role::Hysteresis).collect();
        let ends = (walk.at(walk.differ.0), walk.at(walk.differ.1));
        let expected = Marks::Spans(vec![ends]);
        prop_assert!(matches!(&bands[..], [band] if band.marks == expected), "{bands:?} for {ends:?}");
        for (role, way) in [(Role::Curve, "up"), (Role::Down, "down")] {
            let line = of(role).next().unwrap();
            prop_assert_eq!(&line.name, way);
            let Marks::Path(points) = &line.marks else { panic!("{line:?}") };
            let known: Vec<_> =
                points.split(|at| !at.1.is_finite()).filter(|part| !part.is_empty()).collect();
            let jump = walk.jump(way);
            prop_assert_eq!(known.len(), 2, "{}: {:?}", way, points);
            prop_assert_eq!((known[0].last().unwrap().0, known[1][0].0), jump);
            prop_assert_eq!(known.concat().len(), walk.count);
        }
        let mut marked: Vec<(f64, f64)> = of(Role::Transient)
            .flat_map(|layer| match &layer.marks {
                Marks::Cloud(points) => points.clone(),
                other => panic!("{other:?}"),
            })
            .collect();
        let scale = if walk.is_rms { 1e3 } else { 2e3 };
        let transients = walk.rows().into_iter().filter(|row| row.3);
        let mut expected: Vec<(f64, f64)> =
            transients.map(|row| (row.0, scale * walk.height(row.0, row.2))).collect();
        let by = |a: &(f64, f64), b: &(f64, f64)| a.partial_cmp(b).unwrap();
        marked.sort_by(by);
        expected.sort_by(by);
        let near = |a: &(f64, f64), b: &(f64, f64)| a.0 == b.0 && (a.1 / b.1 - 1.0).abs() < 1e-12;
        prop_assert!(marked.len() == expected.len() && marked.iter().zip(&expected).all(|(a, b)| near(a, b)));
        // on the canvas: the shading stands upright at these places
        let figure = chart.figure(&Caption::default(), &Theme::LIGHT);
        let (frame, ink) = (&figure.frames[0], Theme::LIGHT.look(Role::Hysteresis).ink);
        let shaded = figure.shapes.iter().filter_map(|shape| match shape {
            Shape::Rect(area, of) if *of == ink && area.bottom - area.top > 100.0 => {
                Some((area.left, area.right))
            }
            _ => None,
        });
        let places = (frame.across(ends.0), frame.across(ends.1));
        prop_assert_eq!(shaded.collect::<Vec<_>>(), vec![places]);
        prop_assert!(!figure.shapes.iter().any(|shape| matches!(shape, Shape::Polygon(_, of) if *of == ink)));
        Ok(true)
    });
}

#[test]
fn the_picture_of_a_walk_shades_what_its_rows_say() {
    let line = "sweep paper-unconstrained --set run.duration_s=20 --set run.settle_s=10 \
                --over excitation.amplitude_g=0.6:1.2:0.1 --carry both \
                --columns rms_velocity_m_per_s,regime";
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("drawn.csv");
    plot(&format!("{line} --plot-data {}", data.display()), folder.path(), "a.svg");
    // the picture needs columns that are not written
    let text = stdout(&format!("{line} --quiet"));
    assert!(!text.contains("settled") && column(&text, "direction").len() == 14, "{text}");
    let drawn = std::fs::read_to_string(&data).unwrap();
    assert!(column(&drawn, "series").iter().filter(|series| *series == "cell").count() == 14, "{drawn}");
}
