//! Wrong input: refused with a message that names it, and never a panic.

use std::fs;
use std::path::PathBuf;

use super::{headless, refused};

/// A folder with a file of this name and content in it.
fn file(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn scene_with(fields: &str) -> String {
    let mut text = String::from("(title: \"t\", ");
    let defaults = [
        ("mass_g:", "mass_g: 15.2"),
        ("mechanism:", "mechanism: Cubic(linear_n_per_m: -40.0, cubic_n_per_m3: 8.2e5)"),
        ("run:", "run: (duration_s: 1.0)"),
    ];
    for (name, default) in defaults {
        if !fields.contains(name) {
            text += &format!("{default}, ");
        }
    }
    format!("{text}{fields})")
}

#[test]
fn what_is_no_scene() {
    let brackets = vec![b'('; 10 << 20];
    let noise: Vec<u8> = (0..4096_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
    let nested = [b"[".repeat(100_000), b"]".repeat(100_000)].concat();
    for bytes in [&b""[..], b" \n", &noise, &brackets, &nested, b"\xff\xfe", b"(title: \"t\")", b"null"] {
        let (_folder, path) = file("bad.ron", bytes);
        for command in ["check", "simulate", "sweep", "curve"] {
            let mut command = headless(command);
            command.arg(&path);
            refused(command, &["bad.ron"]);
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_path_that_is_no_text_is_named() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    for line in ["check", "simulate", "sweep"] {
        let mut command = headless(line);
        command.arg(OsStr::from_bytes(b"bad\xff.ron"));
        refused(command, &["`bad\u{fffd}.ron`", "UTF-8"]);
    }
    // An output may be called so.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(OsStr::from_bytes(b"bad\xff.csv"));
    headless("sweep --over mass_g=15 --quiet --out").arg(&path).assert().success();
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    let mut command = headless("sweep --over mass_g=15 --out /no/such");
    command.arg("--plot").arg(OsStr::from_bytes(b"bad\xff.jpg"));
    refused(command, &["bad\u{fffd}.jpg"]);
}

#[test]
fn a_record_that_is_too_long_names_the_limit() {
    let rows: String = (0..1_000_001).map(|i| format!("{i},0\n")).collect();
    let scene = scene_with("excitation: Recorded(path: \"r.csv\")");
    let (folder, path) = file("long.ron", scene.as_bytes());
    fs::write(folder.path().join("r.csv"), format!("t_s,accel_m_per_s2\n{rows}")).unwrap();
    let mut command = headless("check");
    command.arg(&path);
    refused(command, &["long.ron:1:", "r.csv", "more than 1000000 rows", "thin it out"]);
}

#[test]
fn edges_that_are_valid() {
    for line in [
        "simulate --set excitation.amplitude_g=0",
        "simulate --set excitation.amplitude_g=-1",
        "simulate --set stops.restitution=0",
        "simulate --set stops.restitution=1",
        "simulate --set damping.xi=0",
        "simulate --tolerance 1e-3",
        "simulate elastic-box --set start.x_mm=10",
        "simulate --set run.duration_s=1e9 --set stops=None --set excitation=None --at 0,1e9",
    ] {
        headless(line).assert().success();
    }
}

#[test]
fn tables_that_are_no_curves() {
    let rows = |f: &dyn Fn(usize) -> String| -> String {
        (0..50).fold("x_m,force_n\n".into(), |text: String, i| text + &f(i) + "\n")
    };
    let x = |i: usize| (i as f64 - 24.5) * 3e-4;
    let cubic = |x: f64| -40.0 * x + 8.2e5 * x.powi(3);
    let bad: [(&str, String); 6] = [
        ("two rows", "x_m,force_n\n0,0\n0.001,1\n".into()),
        ("no header", "0,0\n1,1\n2,2\n3,3\n4,4\n".into()),
        ("other columns", rows(&|i| format!("{},{}", x(i), cubic(x(i)))).replace("force_n", "force_mn")),
        (
            "not a number",
            rows(&|i| if i == 7 { "0,NaN".into() } else { format!("{},{}", x(i), cubic(x(i))) }),
        ),
        ("not ascending", rows(&|i| format!("{},{}", x(i % 25), cubic(x(i))))),
        ("empty", String::new()),
    ];
    let scene = scene_with("mechanism: Table(path: \"curve.csv\")");
    for (what, text) in bad {
        let (folder, path) = file("table.ron", scene.as_bytes());
        fs::write(folder.path().join("curve.csv"), text).unwrap();
        let mut command = headless("check");
        let output = command.arg(&path).assert().code(2).get_output().stderr.clone();
        let message = String::from_utf8_lossy(&output).into_owned();
        assert!(message.contains("curve.csv"), "{what}: {message}");
    }
    // Values that look like millimetres are said to look so.
    let (folder, path) = file("table.ron", scene.as_bytes());
    let millimetres = rows(&|i| format!("{},{}", x(i) * 1e3, cubic(x(i))));
    fs::write(folder.path().join("curve.csv"), millimetres).unwrap();
    let output = headless("check").arg(&path).output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(said.contains("if these are millimetres, divide the column by 1000"), "{said}");

    // A table that is not there, wherever the rows would go.
    let (folder, path) = file("table.ron", scene.as_bytes());
    for line in ["curve", "sweep --over mass_g=1,2", "simulate --out", "sweep --over mass_g=1,2 --out"] {
        let mut command = headless(line);
        if line.ends_with("--out") {
            command.arg(folder.path().join("rows.csv"));
        }
        command.arg(&path);
        refused(command, &["table.ron:1:", "mechanism.path", "curve.csv"]);
    }
}
