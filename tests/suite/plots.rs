//! Pictures: what they show, and their bytes.

mod asked;
mod documented;
mod legends;
mod lines;
mod manifests;
mod paper;
mod seams;
mod search;
mod studies;
mod sweeps;
mod thinned;
mod walked;

use std::path::{Path, PathBuf};

use assert_cmd::Command;
use predicates::str::contains;

use super::cli::{column, headless, stdout};

/// Runs `line --plot FILE` with the rows thrown away; the picture's place.
fn plot(line: &str, folder: &Path, name: &str) -> PathBuf {
    let path = folder.join(name);
    with_plot(line, &path).args(["--out", "/dev/null", "--quiet"]).assert().success().stdout("");
    path
}

/// What follows a `>` in `line` is the option that names the picture.
fn with_plot(line: &str, path: &Path) -> Command {
    let (line, option) = line.split_once(" > ").unwrap_or((line, "--plot"));
    let mut command = headless(line);
    command.arg(option).arg(path);
    command
}

/// Width, height and pixels of a PNG; a wrong one fails.
fn pixels(path: &Path) -> (u32, u32, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgb);
    (info.width, info.height, pixels)
}

/// An SVG without what made it.
fn texts_and_shapes(path: &Path) -> String {
    let svg = std::fs::read_to_string(path).unwrap();
    let (before, rest) = svg.split_once("<metadata>").unwrap();
    before.to_owned() + rest.split_once("</metadata>").unwrap().1
}

/// The texts of an SVG whose tags must be closed in order and whose signs must be escaped.
pub fn texts(path: &Path) -> Vec<String> {
    let svg = texts_and_shapes(path);
    assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
    let (mut open, mut texts) = (Vec::new(), Vec::new());
    for part in svg.split('<').skip(1) {
        let (tag, text) = part.split_once('>').unwrap();
        let name = tag.split([' ', '/']).find(|word| !word.is_empty()).unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name));
        } else if !tag.ends_with('/') {
            open.push(name);
        }
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        assert!(!text.contains(|c: char| c.is_control() && c != '\n'), "{text}");
        for rest in text.split('&').skip(1) {
            assert!(["lt;", "gt;", "amp;", "quot;", "apos;"].iter().any(|entity| rest.starts_with(entity)));
        }
        texts.extend(Some(text.trim()).filter(|text| !text.is_empty()).map(str::to_owned));
    }
    assert!(open.is_empty());
    texts
}

fn says(line: &str, words: &[&str]) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let texts = texts(&plot(line, folder.path(), "a.svg"));
    // a label may have several lines
    let joined = texts.join(" ");
    for word in words {
        assert!(joined.contains(word), "`{word}` is not in {line}: {texts:?}");
    }
    texts
}

/// Thresholds beside Melnikov's, of short runs.
const MELNIKOV: &str = "threshold duffing --melnikov --set run.duration_s=100 --set run.settle_s=50 \
    --until-settled 200 --field excitation.amplitude_g=0:0.2:0.1 --over excitation.frequency_hz=0.1,0.2";

const SMALL_MAP: &str = "sweep paper --set run.settle_s=None --set run.duration_s=2 \
    --over stops.travel_limit_mm=1:7:1 \
                         --over excitation.amplitude_g=0:2:0.25";

#[test]
fn every_command_draws_light_and_dark() {
    let folder = tempfile::tempdir().unwrap();
    for (i, line) in ["curve", "simulate --set run.settle_s=None --set run.duration_s=2", SMALL_MAP]
        .into_iter()
        .enumerate()
    {
        let light = pixels(&plot(line, folder.path(), &format!("{i}.png")));
        let dark = pixels(&plot(&format!("{line} --dark"), folder.path(), &format!("{i}-dark.PNG")));
        assert_eq!((light.0, light.1, dark.0, dark.1), (1600, 1000, 1600, 1000));
        assert!(light.2[..3].iter().all(|byte| *byte == 255) && dark.2[..3].iter().all(|byte| *byte < 64));
        // Something is on it.
        let inked = light.2.chunks(3).filter(|pixel| **pixel != light.2[..3]).count();
        assert!(inked > 50_000, "{line}: {inked}");
    }
}

#[test]
fn pictures_say_what_they_show() {
    says(
        "curve",
        &[
            "Prototype with travel limits",
            "displacement (mm)",
            "holding force (N)",
            "potential above the well (mJ)",
        ],
    );
    says("curve", &["stable equilibrium", "unstable equilibrium", "kink of the force", "stop", "barrier"]);
    let version =
        format!("interwell {} \u{b7} built-in paper \u{b7} tolerance 1e-9", env!("CARGO_PKG_VERSION"));
    says(
        "simulate",
        &[&version, "time (s)", "displacement (mm)", "velocity (mm/s)", "base acceleration (g)"],
    );
    says(
        "simulate",
        &["impact", "at rest on a stop", "phase portrait", "interwell", "RMS velocity 49.49 mm/s"],
    );
    says(SMALL_MAP, &["travel limit (mm)", "amplitude (g)", "RMS velocity (mm/s)", "at rest"]);
    says(
        SMALL_MAP,
        &[
            "release: leaves the stop (closed form)",
            "first crossing",
            "7 \u{d7} 9 runs of 2 s, each from rest",
        ],
    );
    let line = "exponents duffing --periods 50 --over excitation.amplitude_g=";
    says(
        &format!("{line}0.02:0.05:0.01"),
        &["first exponent", "standard error", "Lyapunov exponent (1/s)", "amplitude (g)", "4 motions"],
    );
    let resting = says("exponents paper --over excitation.amplitude_g=0.5,1", &["(rests on a stop)"]);
    assert!(!resting.iter().any(|text| text == "first exponent"), "nothing is drawn: {resting:?}");
    let line = "sweep duffing --set run.settle_s=100 --set run.duration_s=300 \
        --over excitation.amplitude_g=0.02,0.05";
    says(line, &["amplitude (g)", "RMS velocity (mm/s)", "2 runs of 300 s", "intrawell"]);
    // A long name is cut, signs of XML are not taken for XML.
    let title = format!("title=<a> & \"b\" {}", "long ".repeat(200));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    with_plot("curve --out /dev/null", &path).arg("--set").arg(title).assert().success();
    assert!(
        texts(&path).iter().any(|text| text.starts_with("&lt;a&gt; &amp;"))
            && texts(&path).iter().any(|text| text.ends_with('\u{2026}'))
    );
}

#[test]
fn a_wall_leaves_the_picture_and_the_picture_says_so() {
    // 25 N at 8 mm against 0.2 N between the wells: the axis shows the wells.
    let texts =
        says("curve paper-table", &["force leaves the picture (", " N at 8 mm)", "0.2", "holding force (N)"]);
    assert!(!texts.iter().any(|text| text == "20" || text == "10"), "{texts:?}");
    // The rows have all of it.
    let force =
        |line: &str| super::cli::stdout(line).lines().last().unwrap().split(',').nth(1).unwrap().parse();
    let last: f64 = force("curve paper-table --at-mm 8").unwrap();
    assert!(last > 10.0, "{last}");
    assert!(!says("curve nominal-cubic", &[]).iter().any(|text| text.contains("leaves")));
}

#[test]
fn lines_over_a_map_stand_only_where_they_mean_something() {
    for line in [
        // From elsewhere than rest; over other fields; without a sine.
        "--set start=At(x_mm:0.5,v_m_per_s:0) --over stops.travel_limit_mm=1,2 \
         --over excitation.amplitude_g=0,1",
        "--over stops.restitution=0.2,0.4 --over excitation.amplitude_g=0,1",
        "--set excitation=Constant(accel_g:1) --over stops.travel_limit_mm=1,2 --over excitation.accel_g=0,1",
        "--over stops.travel_limit_mm=7.2,8 --over excitation.amplitude_g=0,1",
    ] {
        let texts = says(&format!("sweep --set run.settle_s=None --set run.duration_s=1 {line}"), &[]);
        assert!(!texts.iter().any(|text| text.contains("release")), "{line}: {texts:?}");
    }
    // The other way round is the same map on its side.
    let turned = "sweep paper --set run.settle_s=None --set run.duration_s=2 \
        --over excitation.amplitude_g=0:2:0.25 \
                  --over stops.travel_limit_mm=1:7:1";
    says(turned, &["release: leaves the stop (closed form)", "first crossing"]);
}

#[test]
fn the_rows_are_the_same_with_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    for line in [
        "simulate --at 3,0,1.5,3 --set run.settle_s=None --set run.duration_s=4",
        "simulate bouncing-ball --dt 0.5",
        "curve --at-mm 3,-1",
        SMALL_MAP,
    ] {
        let path = folder.path().join("a.png");
        let output = with_plot(line, &path).assert().success().get_output().stdout.clone();
        assert_eq!(String::from_utf8(output).unwrap(), stdout(line), "{line}");
    }
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let read = |line: &str, name: &str| std::fs::read(plot(line, folder.path(), name)).unwrap();
    // without the arguments that made it
    let seen = |line: &str, name: &str| match name {
        "a.png" => pixels(&plot(line, folder.path(), name)).2,
        _ => texts_and_shapes(&plot(line, folder.path(), name)).into_bytes(),
    };
    for name in ["a.png", "a.svg"] {
        for line in [
            "curve paper",
            "simulate --set run.settle_s=None --set run.duration_s=2",
            "simulate bouncing-ball",
        ] {
            // However sparse the samples are.
            let sparse = if line.starts_with("curve") { "--at-mm 1" } else { "--at 1" };
            assert!(seen(line, name) == seen(&format!("{line} {sparse}"), name), "{line}");
        }
        let jobs = |n: u32| read(&format!("{SMALL_MAP} --jobs {n}"), name);
        assert!(jobs(1) == jobs(3));
    }
}

#[test]
fn odd_data_have_pictures_too() {
    let folder = tempfile::tempdir().unwrap();
    let polynomial = |c: &str| format!("curve elastic-box --set mechanism=Polynomial(coefficients_si:[{c}])");
    for (i, line) in [
        // One cell, one row, one column, values in any order and twice.
        "sweep --set run.settle_s=None --set run.duration_s=1 --over mass_g=15",
        "sweep --set run.settle_s=None --set run.duration_s=1 --over mass_g=15 \
         --over stops.travel_limit_mm=1",
        "sweep --set run.settle_s=None --set run.duration_s=1 --over mass_g=15 \
         --over excitation.amplitude_g=2,0,1,2",
        "sweep --set run.settle_s=None --set run.duration_s=1 --over excitation.phase_deg=-90,0 \
         --over excitation.amplitude_g=-1,-2",
        // Every cell leaves the table before its settled window.
        "sweep --set stops=None --set start=At(x_mm:7,v_m_per_s:9) --over excitation.amplitude_g=40,50",
        "sweep --set stops=None --set start=At(x_mm:7,v_m_per_s:9) --over mass_g=15,16 \
         --over excitation.amplitude_g=40,50",
        // All at rest; nothing moves at all.
        "sweep --set run.settle_s=None --set run.duration_s=1 --over excitation.amplitude_g=0 \
         --over stops.travel_limit_mm=1,2",
        "simulate --set excitation=None",
        "simulate elastic-box --set start=At(x_mm:0,v_m_per_s:0)",
        // Ends at once; ends by its budget; lasts no time or very long.
        "simulate --set stops=None --set start=At(x_mm:7,v_m_per_s:900)",
        "simulate elastic-box --set start=At(x_mm:0,v_m_per_s:1e9)",
        "simulate elastic-box --set run.settle_s=None --set run.duration_s=1e-15",
        "simulate elastic-box --set run.settle_s=None --set run.duration_s=1e9 \
         --set start=At(x_mm:0,v_m_per_s:1e-9) --dt 1e8",
        "simulate elastic-box --set start=At(x_mm:0,v_m_per_s:1e-30)",
        "simulate elastic-box --set stops=None --set start=At(x_mm:1e15,v_m_per_s:1e10)",
        "simulate bouncing-ball --set stops=None",
        "simulate --set excitation.amplitude_g=1e20",
        // Curves of nothing, of a constant, of huge and of tiny numbers.
        &polynomial("0.0"),
        &polynomial("1e200"),
        &polynomial("-1e-200,1e-200"),
        &polynomial("0,0,0,1e200"),
        "curve --range-mm 1:1.0000000000001",
        "curve elastic-box --range-mm -1e15:1e15",
        "curve nominal-cubic --set stops=Uneven(right_mm:1e15,restitution_right:0.5)",
    ]
    .into_iter()
    .enumerate()
    {
        let small = format!("{line} --plot-size 800x500");
        pixels(&plot(&small, folder.path(), &format!("{i}.png")));
        texts(&plot(line, folder.path(), &format!("{i}.svg")));
    }
}

#[test]
fn a_long_run_is_drawn_soon_and_whole() {
    let folder = tempfile::tempdir().unwrap();
    let ramp = "simulate --set excitation=AmplitudeRamp(frequency_hz:3,from_g:0,to_g:2,over_s:300) \
                --set run.settle_s=None --set run.duration_s=300 --at 0";
    let path = plot(ramp, folder.path(), "ramp.svg");
    let length = std::fs::metadata(&path).unwrap().len();
    assert!(length < 1_500_000, "{length} bytes");
    // It rests until the ramp frees it, then crosses to both stops.
    let texts = texts(&path);
    assert!(
        texts.iter().any(|text| text == "impact") && texts.iter().any(|text| text == "at rest on a stop")
    );
}

#[test]
fn a_picture_fails_like_any_output() {
    let folder = tempfile::tempdir().unwrap();
    let full = folder.path().join("full.png");
    #[cfg(target_os = "linux")]
    {
        std::os::unix::fs::symlink("/dev/full", &full).unwrap();
        with_plot("curve --out /dev/null", &full).assert().code(1).stderr(contains("full.png"));
    }
}

#[test]
fn no_font_of_the_machine_is_needed() {
    let tree = std::process::Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "-e", "normal,build", "--prefix", "none"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(tree.status.success());
    let tree = String::from_utf8_lossy(&tree.stdout).into_owned();
    for line in tree.lines() {
        let name = line.split(' ').next().unwrap_or_default();
        let system = ["font-kit", "fontconfig", "freetype", "yeslogic"]
            .iter()
            .any(|library| name.starts_with(library));
        assert!(!system, "`{line}` looks for fonts of the machine");
    }
    assert!(tree.contains("tiny-skia") && !tree.contains("ab_glyph"));
}
