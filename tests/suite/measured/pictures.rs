//! Pictures of what was identified, and of a measured force over the curve: what they say and draw.

use std::path::Path;

use crate::cli::{column, headless};
use crate::plots::texts;

/// Draws what `line` with the file asks for; the texts of the picture, and the numbers that are drawn.
fn drawn(line: &str, file: &Path) -> (Vec<String>, String) {
    let [plot, data] = ["a.svg", "a.csv"].map(|name| file.with_file_name(name));
    let mut command = headless(line);
    command.arg(file).arg("--plot").arg(&plot).arg("--plot-data").arg(&data);
    command.args(["--out", "/dev/null", "--quiet"]).assert().success().stdout("").stderr("");
    (texts(&plot), std::fs::read_to_string(data).unwrap())
}

fn says(texts: &[String], words: &[&str]) {
    for word in words {
        assert!(texts.iter().any(|text| text.contains(word)), "`{word}` is not in {texts:?}");
    }
}

/// The numbers of a column in the rows of one series.
fn of_series(csv: &str, series: &str, name: &str) -> Vec<f64> {
    let rows = column(csv, "series").into_iter().zip(column(csv, name));
    rows.filter(|row| row.0 == series).map(|row| row.1.parse().unwrap()).collect()
}

fn file(
    folder: &Path,
    name: &str,
    header: &str,
    rows: impl Iterator<Item = (f64, f64)>,
) -> std::path::PathBuf {
    let rows: String = rows.map(|(a, b)| format!("{a:?},{b:?}\n")).collect();
    std::fs::write(folder.join(name), format!("{header}\n{rows}")).unwrap();
    folder.join(name)
}

#[test]
fn the_envelope_of_a_decay_is_the_one_that_made_it() {
    let folder = tempfile::tempdir().unwrap();
    let away = |t: f64| 2.0 * (-0.8 * t).exp();
    let record = (0..4000).map(|i| {
        let t = f64::from(i) * 1e-3;
        (t, 7.0 + away(t) * (40.0 * t).cos())
    });
    let path = file(folder.path(), "decay.csv", "t_s,x_mm", record);
    let (texts, csv) = drawn("identify --of damping", &path);
    says(&texts, &["decay.csv", "damping ratio 0.02", "95 % interval", "time (s)", "displacement (mm)"]);
    says(&texts, &["measured", "identified envelope", "identify decay.csv --of damping"]);
    says(&texts, &["of eight turning points", "95 % interval"]);
    let (t, upper) = (of_series(&csv, "upper_envelope", "t_s"), of_series(&csv, "upper_envelope", "x_m"));
    assert!(t.len() > 100);
    // the maxima of x lie below its envelope by the square of the ratio, 2e-4 of it
    for (t, upper) in t.iter().zip(&upper) {
        let exact = 7.0 + away(*t);
        assert!((upper * 1e3 - exact).abs() < 3e-4 * away(*t) + 1e-6, "{upper} {exact} at {t}");
    }
    let ratios = of_series(&csv, "damping_ratio", "damping_ratio");
    assert!(
        !ratios.is_empty() && ratios.iter().all(|ratio| (ratio - 0.8 / 40.0_f64.hypot(0.8)).abs() < 1e-5)
    );
}

#[test]
fn impacts_and_rebounds_stand_on_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("ball.csv");
    let mut command = headless("simulate bouncing-ball --dt 0.0005 --quiet");
    command.arg("--out").arg(&path).assert().success();
    let (texts, csv) = drawn("identify --of restitution", &path);
    says(&texts, &["restitution 0.8", "impact", "end of a rebound", "restitution"]);
    // from 1 m up 0.64 m, and so on by 0.64
    let (at, top) = (of_series(&csv, "impact", "x_m"), of_series(&csv, "rebound", "x_m"));
    assert!((at[0] + 1.0).abs() < 1e-9, "{}", at[0]);
    for (k, top) in top.iter().take(5).enumerate() {
        assert!((top + 1.0 - 0.64_f64.powi(k as i32 + 1)).abs() < 2e-6, "{k}: {top}");
    }
    // times alone have no record to draw
    let times = [0.0, 1.0, 1.8, 2.44, 2.952].map(|t| (t, 0.0));
    let path = file(folder.path(), "times.csv", "t_s,n", times.into_iter());
    let (_, csv) = drawn("identify --of restitution --impact-times", &path);
    assert_eq!(of_series(&csv, "measured", "t_s").len(), 0);
    assert_eq!(of_series(&csv, "restitution", "restitution").len(), 3);
}

#[test]
fn what_is_left_of_a_pull_is_its_friction() {
    let folder = tempfile::tempdir().unwrap();
    let force = |mm: f64| -40.0 * mm + 0.8 * mm * mm * mm;
    let there = (-900..=900).map(|i| f64::from(i) / 100.0);
    let back = there.clone().rev();
    let rows = there.map(|x| (x, force(x) + 5.0)).chain(back.map(|x| (x, force(x) - 5.0)));
    let path = file(folder.path(), "pull.csv", "x_mm,f_mn", rows);
    let (texts, csv) = drawn("identify --of force", &path);
    says(&texts, &["wells at \u{2212}7.071 and 7.071 mm", "hysteresis 0.01 N", "residual (N)"]);
    let residual = of_series(&csv, "residual", "force_n");
    assert!(residual.len() > 3000 && residual.iter().all(|left| (left.abs() - 5e-3).abs() < 1e-9));
    let scene = "--set mechanism=Cubic(linear_n_per_m:-40,cubic_n_per_m3:8e5)";
    let (texts, csv) = drawn(&format!("curve nominal-cubic {scene} --measured"), &path);
    says(&texts, &["RMS difference 0.005 N", "at most 0.005 N", "computed", "difference (N)"]);
    let difference = of_series(&csv, "difference", "force_n");
    assert_eq!(difference.len(), 3602);
    assert!((difference[0] + 5e-3).abs() < 1e-12 && (difference[3601] - 5e-3).abs() < 1e-12);
    assert_eq!(of_series(&csv, "computed", "force_n").len(), 3001);
    // steep ends leave the picture, and it says so
    let walls = (-800..=800).map(|i| f64::from(i) / 100.0);
    let steep =
        |x: f64| (0.01 * x * (x * x - 49.0)).clamp(-0.5, 0.5) + 100.0 * (x.abs() - 7.5).max(0.0) * x.signum();
    let path = file(folder.path(), "walls.csv", "x_mm,f_n", walls.map(|x| (x, steep(x))));
    for line in ["identify --of force", &format!("curve nominal-cubic {scene} --measured")] {
        let (texts, _) = drawn(line, &path);
        says(&texts, &["force leaves the picture ("]);
        assert!(texts.iter().any(|text| text == "0.5" || text == "0.4"), "{texts:?}");
    }
}
