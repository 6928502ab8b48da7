//! Force curves of every kind, drawn in natural units; tables and flexures as they are.

use std::sync::{Arc, Mutex, OnceLock};

use interwell::mechanics::Mechanism as Built;
use interwell::scene::{Files, FlexureGroup, ForcePiece, Mechanism};
use proptest::prelude::*;

use super::units::{PROTOTYPE, Units};

/// A curve that is not odd, with a corner inside and another well than the mirror's.
const LOPSIDED: &str = "x_m,force_n
-0.009,-0.42
-0.008,-0.2
-0.007,-0.05
-0.006,0.04
-0.005,0.09
-0.0035,0.12
-0.002,0.09
-0.0005,0.03
0.0005,-0.02
0.002,-0.08
0.004,-0.15
0.0055,-0.13
0.006,0.0
0.0065,0.4
0.007,0.9
0.008,2.1
";

/// The same seen in a mirror: points turned about x = 0.
fn turned(table: &str) -> String {
    let opposite = |number: &str| number.strip_prefix('-').map_or(format!("-{number}"), str::to_owned);
    let row = |row: &str| row.split(',').map(opposite).collect::<Vec<_>>().join(",") + "\n";
    let (header, rows) = table.split_once('\n').unwrap();
    format!("{header}\n{}", rows.lines().rev().map(row).collect::<String>())
}

/// Name and text of a table that no file holds.
pub fn table_text(mechanism: &Mechanism) -> Option<(String, String)> {
    let Mechanism::Table { path, .. } = mechanism else { return None };
    let text = match path.as_str() {
        "lopsided.csv" => LOPSIDED.to_owned(),
        "turned.csv" => turned(LOPSIDED),
        _ => return None,
    };
    Some((path.clone(), text))
}

/// The curve of a mechanism. Tables are fitted and flexures solved once each.
pub fn built(mechanism: &Mechanism) -> Arc<Built> {
    type Known = (Mechanism, Arc<Built>);
    static KEPT: OnceLock<Mutex<Vec<Known>>> = OnceLock::new();
    let build = || {
        Arc::new(match (mechanism, table_text(mechanism)) {
            (Mechanism::Table { tolerance, .. }, Some((_, text))) => {
                Built::from_table(&text, *tolerance).unwrap()
            }
            _ => Built::build(mechanism, &Files::default()).unwrap(),
        })
    };
    if !matches!(mechanism, Mechanism::Table { .. } | Mechanism::Flexures { .. }) {
        return build();
    }
    let mut kept = KEPT.get_or_init(Mutex::default).lock().unwrap();
    if let Some((_, found)) = kept.iter().find(|(known, _)| known == mechanism) {
        return found.clone();
    }
    let made = build();
    kept.push((mechanism.clone(), made.clone()));
    made
}

/// F of a mass of 1, with distances of the wells of about 1: to be measured in units later.
fn formula() -> impl Strategy<Value = Mechanism> {
    let polynomial = |coefficients_si| Mechanism::Polynomial { coefficients_si };
    prop_oneof![
        4 => (prop_oneof![-3.0..-0.05f64, 0.05..0.5f64], 0.3..2.0f64)
            .prop_map(|(linear_n_per_m, cubic_n_per_m3)| Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 }),
        // seen in SI, barrier in mJ and equilibrium in mm: the units come later
        4 => (0.3..1.5f64, 0.05..0.5f64)
            .prop_map(|(x, j)| Mechanism::DoubleWell { equilibrium_mm: x * 1e3, barrier_mj: j * 1e3 }),
        2 => (-2.0..2.0f64, prop_oneof![-2.0..-0.1f64, 0.1..2.0f64], -2.0..2.0f64, -2.0..2.0f64)
            .prop_map(move |(c0, c1, c2, c3)| polynomial(vec![c0, c1, c2, c3, 0.0, 1.0])),
        1 => (-2.0..-0.1f64, prop::collection::vec(-1.0..1.0f64, 1..13)).prop_map(move |(c1, more)| {
            let mut all = vec![0.0, c1];
            all.extend(more);
            all.resize(all.len() + all.len() % 2, 0.0);
            *all.last_mut().unwrap() = 1.0;
            polynomial(all)
        }),
        1 => (-1.0..1.0f64, -1.0..1.0f64, 0.1..4.0f64, 0.1..4.0f64)
            .prop_map(|(at, force, left, right)| corner(at, force, left, right)),
        1 => prop_oneof![
            Just(polynomial(vec![0.0])),
            (-2.0..2.0f64).prop_map(move |c| polynomial(vec![c])),
            (0.1..4.0f64).prop_map(move |c| polynomial(vec![0.0, c])),
            (0.1..4.0f64).prop_map(move |c| polynomial(vec![0.0, 0.0, 0.0, c])),
        ],
    ]
}

/// Two springs that meet in a corner.
fn corner(at: f64, force: f64, left: f64, right: f64) -> Mechanism {
    let piece = |stiffness| ForcePiece { origin_m: at, coefficients_si: vec![force, stiffness] };
    let ends_m = vec![f64::NEG_INFINITY, at, f64::INFINITY];
    Mechanism::Pieces { ends_m, pieces: vec![piece(left), piece(right)], error_n: 0.0 }
}

fn table() -> impl Strategy<Value = Mechanism> {
    let paths = prop_oneof![Just("force_dl2.7.csv"), Just("lopsided.csv"), Just("turned.csv")];
    (paths, prop_oneof![Just(1e-2), Just(1e-4), Just(1e-6)])
        .prop_map(|(path, tolerance)| Mechanism::Table { path: path.to_owned(), tolerance })
}

/// Flexures of the prototype, and with less and without preload.
fn flexures() -> impl Strategy<Value = Mechanism> {
    prop_oneof![2 => Just(2.7), 1 => Just(1.2), 1 => Just(0.0)].prop_map(|preload_mm| Mechanism::Flexures {
        preload_mm,
        thickness_mm: 0.1,
        young_gpa: 190.0,
        parallel: FlexureGroup { count: 2, length_mm: 26.0, width_mm: 20.0 },
        buckling: FlexureGroup { count: 1, length_mm: 27.7, width_mm: 6.8 },
        poisson: 0.34,
        plane_strain: false,
        initial_bow_mm: 0.0,
        yield_gpa: 2.0,
    })
}

/// A mechanism and the units in which all about it is of the order of 1.
pub fn mechanism() -> impl Strategy<Value = (Mechanism, Units)> {
    let power = || (-6.0..6.0f64).prop_map(|power| 10f64.powf(power));
    let units = prop_oneof![
        4 => Just(Units { mass: 1.0, length: 1.0, time: 1.0 }),
        4 => Just(PROTOTYPE),
        1 => (power(), power(), power()).prop_map(|(mass, length, time)| Units { mass, length, time }),
    ];
    prop_oneof![
        8 => (formula(), units).prop_map(|(mechanism, units)| (units.mechanism(&mechanism), units)),
        1 => table().prop_map(|mechanism| (mechanism, PROTOTYPE)),
        1 => flexures().prop_map(|mechanism| (mechanism, PROTOTYPE)),
    ]
}
