//! A measured force beside the force curve: the numbers of the difference, and the command.

use interwell::mechanics::{ForceCurve, Landscape, Mechanism};
use interwell_studies::study::{Table, Values, compare_force};

use super::Noise;
use crate::cli::{headless, refused};

/// The force -40 x + 8e5 x^3.
fn cubic() -> Mechanism {
    let curve = ForceCurve::polynomial(&[0.0, -40.0, 0.0, 8e5]);
    Mechanism { landscape: Landscape::default(), ..Mechanism::new(curve) }
}

fn row(table: &Table, quantity: &str) -> [f64; 4] {
    let Values::Words(words) = &table.column("quantity").unwrap().values else { panic!("no words") };
    let at = words.iter().position(|word| *word == quantity).unwrap();
    ["measured", "computed", "difference", "difference_percent"].map(|name| table.numbers(name).unwrap()[at])
}

#[test]
fn the_numbers_are_those_of_the_difference() {
    let mechanism = cubic();
    let x: Vec<f64> = (-80..=80).map(|i| f64::from(i) * 1e-4).collect();
    // 2 mN too much everywhere, and 30 mN more at -3 mm
    let force: Vec<f64> =
        x.iter().map(|x| mechanism.curve.force(*x) + if *x == -3e-3 { 0.032 } else { 0.002 }).collect();
    let found = compare_force(&mechanism, &x, &force).unwrap();
    let rms = ((160.0 * 0.002_f64.powi(2) + 0.032_f64.powi(2)) / 161.0).sqrt();
    assert!((found.rms.0 - rms).abs() < 1e-15, "{:?}", found.rms);
    assert_eq!(found.largest.0, -3e-3);
    let [measured, computed, difference, percent] = row(&found.table, "largest_difference");
    assert!((difference + 0.032).abs() < 1e-15 && measured - computed == -difference, "{difference}");
    let whole = (force.iter().map(|value| value * value).sum::<f64>() / 161.0).sqrt();
    assert!((percent - 100.0 * difference / whole).abs() < 1e-12, "{percent}");
    assert_eq!(row(&found.table, "largest_difference_at")[..2], [-3e-3, -3e-3]);
    assert_eq!(row(&found.table, "minimum")[1], mechanism.curve.force(x[121]));
    // in any order, both ways
    let back: Vec<f64> = x.iter().rev().copied().collect();
    let other: Vec<f64> = force.iter().rev().copied().collect();
    assert!((compare_force(&mechanism, &back, &other).unwrap().rms.0 - found.rms.0).abs() < 1e-16);
}

#[test]
fn noise_of_known_size_is_the_rms_of_the_difference() {
    let (mechanism, mut random) = (cubic(), Noise::new(11));
    let x: Vec<f64> = (0..40_000).map(|i| -8e-3 + 4e-7 * f64::from(i)).collect();
    let force: Vec<f64> = x.iter().map(|x| mechanism.curve.force(*x) + 3e-3 * random.next()).collect();
    let found = compare_force(&mechanism, &x, &force).unwrap();
    // the standard deviation of that of n normal numbers is 1/sqrt(2 n), here 0.35 %
    assert!((found.rms.0 / 3e-3 - 1.0).abs() < 0.014, "{:?}", found.rms);
}

#[test]
fn the_command_compares_and_says_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pull.csv");
    let rows: String = (-60..=60)
        .map(|i| {
            let mm = f64::from(i) / 10.0;
            format!("{mm:?};{:?}\n", -40.0 * mm + 0.8 * mm * mm * mm + 1.0).replace('.', ",")
        })
        .collect();
    std::fs::write(&file, format!("Position [mm];Load cell [mN]\n{rows}")).unwrap();
    let scene = "--set mechanism=Cubic(linear_n_per_m:-40,cubic_n_per_m3:8e5) --set stops=None";
    let out = folder.path().join("difference.csv");
    let mut command = headless(&format!("curve nominal-cubic {scene} --out /dev/null --quiet --measured"));
    command.arg(&file).arg("--comparison").arg(&out).assert().success().stdout("").stderr("");
    let rows = std::fs::read_to_string(&out).unwrap();
    let rms: f64 = rows.lines().nth(1).unwrap().split(',').nth(4).unwrap().parse().unwrap();
    assert!((rms - 1e-3).abs() < 1e-15, "{rows}");
    let line = |line: &str| {
        let mut command = headless(line);
        command.arg(&file);
        command
    };
    refused(line("curve --out /dev/null --position Place --measured"), &["pull.csv", "no column Place"]);
    let meters = "curve paper-table --out /dev/null --position-unit m --unit N --measured";
    refused(line(meters), &["pull.csv", "1 of 121 positions", "unit"]);
    refused(line("curve --out /dev/null --unit g --measured"), &["--unit", "`g`", "force", "mN"]);
}
