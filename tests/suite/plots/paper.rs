//! Pictures on paper: size, text, kinds of files, what made them, surfaces and cuts, and the numbers drawn.

use std::fs;
use std::path::Path;

use interwell::output::text_width;

use super::super::cli::stdout;
use super::{MELNIKOV, SMALL_MAP, pixels, plot, says, with_plot};

const PAPER: &str = "--plot-width-mm 85 --font-pt 8";
const SHORT: &str = "--set run.settle_s=None --set run.duration_s=2";

fn bytes(line: &str, folder: &Path, name: &str) -> Vec<u8> {
    fs::read(plot(line, folder, name)).unwrap()
}

/// What made the picture, from the metadata of a PNG or an SVG.
fn made(path: &Path) -> serde_json::Value {
    let text = if path.extension().is_some_and(|ending| ending == "png") {
        let file = std::io::BufReader::new(fs::File::open(path).unwrap());
        let reader = png::Decoder::new(file).read_info().unwrap();
        let chunks = &reader.info().utf8_text;
        let description = chunks.iter().find(|chunk| chunk.keyword == "Description").unwrap();
        description.get_text().unwrap()
    } else {
        let svg = fs::read_to_string(path).unwrap();
        let metadata = svg.split("<metadata>").nth(1).unwrap().split("</metadata>").next().unwrap();
        metadata.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
    };
    serde_json::from_str(&text).unwrap()
}

/// A text of an SVG as it stands: its words, and left, upper, right and lower edge of its box.
fn boxes(svg: &str) -> Vec<(String, [f64; 4])> {
    let texts = svg.split("<text ").skip(1).map(|piece| piece.split("</text>").next().unwrap());
    let box_of = |piece: &str| {
        let (tag, words) = piece.split_once('>').unwrap();
        let value = |name: &str| {
            let rest = tag.split(&format!("{name}=\"")).nth(1)?;
            rest.split('"').next().map(str::to_owned)
        };
        let number = |name: &str| value(name).unwrap().parse::<f64>().unwrap();
        let (x, y, size) = (number(" x").max(0.0), number(" y"), number("font-size"));
        let signs = [("&lt;", "<"), ("&gt;", ">"), ("&apos;", "'"), ("&quot;", "\""), ("&amp;", "&")];
        let words = signs.iter().fold(words.trim().to_owned(), |text, (sign, is)| text.replace(sign, is));
        // a capital is 0.73 em high
        let long = text_width(&words, size, value("font-weight").is_some());
        let before = match value("text-anchor").unwrap().as_str() {
            "start" => 0.0,
            "middle" => 0.5 * long,
            _ => long,
        };
        let (top, bottom) = (-0.66 * size, 0.0);
        let area = if tag.contains("rotate(") {
            [x + top, y - long + before, x + bottom, y + before]
        } else {
            [x - before, y + top, x - before + long, y + bottom]
        };
        (words, area)
    };
    texts.map(|piece| box_of(&format!(" {piece}"))).collect()
}

#[test]
fn a_width_in_mm_and_a_size_in_points_hold_on_paper() {
    let folder = tempfile::tempdir().unwrap();
    let path = plot(&format!("curve {PAPER} --no-title"), folder.path(), "a.png");
    let (width, height, _) = pixels(&path);
    // 85 mm at 300 pixels an inch, and 5/8 of it and a row of the legend
    assert_eq!(width, 1004);
    assert!((627..900).contains(&height), "{height}");
    let file = std::io::BufReader::new(fs::File::open(&path).unwrap());
    let dims = png::Decoder::new(file).read_info().unwrap().info().pixel_dims.unwrap();
    assert_eq!((dims.xppu, dims.unit), (11811, png::Unit::Meter));
    let line = format!("curve {PAPER} --plot-height-mm 100");
    assert_eq!(pixels(&plot(&format!("{line} --dpi 254"), folder.path(), "b.png")).1, 1000);
    let svg = fs::read_to_string(plot(&line, folder.path(), "a.svg")).unwrap();
    assert!(svg.contains("width=\"85mm\" height=\"100mm\""), "{}", &svg[..200]);
    let units: f64 = {
        let view = svg.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap();
        view.split(' ').nth(2).unwrap().parse().unwrap()
    };
    let tick = svg.split("<text ").find(|piece| piece.contains("stable equilibrium")).unwrap();
    let size = tick.split("font-size=\"").nth(1).unwrap().split('"').next().unwrap();
    let points = size.parse::<f64>().unwrap() / units * 85.0 / 25.4 * 72.0;
    assert!((points - 8.0).abs() < 1e-3, "{points}");
    let pdf = bytes(&line, folder.path(), "a.pdf");
    let pdf = String::from_utf8_lossy(&pdf).into_owned();
    let page = pdf.split("/MediaBox [").nth(1).unwrap().split(']').next().unwrap();
    let sides: Vec<f64> = page.split(' ').map(|side| side.parse().unwrap()).collect();
    assert!((sides[2] - 85.0 / 25.4 * 72.0).abs() < 1e-3 && (sides[3] - 100.0 / 25.4 * 72.0).abs() < 1e-3);
    // text is text, in a font that is in the file, without a date
    assert!(pdf.contains("Inter-Regular") && pdf.contains("/ToUnicode") && pdf.contains("/FontFile"));
    assert!(!pdf.contains("/CreationDate") && !pdf.contains("xmp:CreateDate"));
}

/// Asserts for pictures of a scene with a title of forty characters, at four sizes, that no text lies on
/// another or leaves the picture.
fn no_text_lies_on_another(lines: &[&str]) {
    let title = "title=A bistable harvester with travel stops x";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.svg");
    for line in lines {
        let titled = if line.starts_with("identify") { vec![] } else { vec!["--set", title] };
        for size in ["", "--plot-width-mm 60 --font-pt 6", PAPER, "--plot-width-mm 170 --font-pt 9"] {
            let options = [&*titled, &["--out", "/dev/null", "--quiet"]].concat();
            with_plot(line, &path).args(size.split_whitespace()).args(options).assert().success();
            let svg = fs::read_to_string(&path).unwrap();
            let view = svg.split("viewBox=\"").nth(1).unwrap().split('"').next().unwrap();
            let canvas: Vec<f64> = view.split(' ').map(|side| side.parse().unwrap()).collect();
            let boxes = boxes(&svg);
            assert!(boxes.len() > 8, "{line}: {boxes:?}");
            for (i, (words, a)) in boxes.iter().enumerate() {
                let inside = a[0] >= -1.0 && a[1] >= -1.0 && a[2] <= canvas[2] && a[3] <= canvas[3];
                assert!(inside, "{line} {size}: `{words}` leaves the picture: {a:?} of {canvas:?}");
                for (other, b) in &boxes[i + 1..] {
                    let apart = a[2] <= b[0] || b[2] <= a[0] || a[3] <= b[1] || b[3] <= a[1];
                    assert!(apart, "{line} {size}: `{words}` lies on `{other}`");
                }
            }
        }
    }
}

#[test]
fn no_text_lies_on_another_in_a_picture_of_a_sweep() {
    let line = format!("sweep paper {SHORT} --over excitation.amplitude_g=0:2:0.25");
    let cuts = "--cut travel_limit_mm=2 --cut amplitude_g=1";
    let regime_cuts = format!("{cuts} --quantity regime");
    let both = "--carry both";
    let both_periods = "--carry both --quantity period";
    let [period, side, settled] = ["period", "side", "settled"].map(|name| format!("--quantity {name}"));
    let over_one =
        ["", both, both_periods, &period, &side, &settled, "--uncertain damping.xi=+-20% --draws 5"];
    let over_two = [
        "",
        "--surface",
        cuts,
        &regime_cuts,
        "--quantity regime",
        both,
        both_periods,
        &period,
        &side,
        &settled,
    ];
    let lines = over_one.iter().map(|more| format!("{line} {more}"));
    let maps = over_two.iter().map(|more| format!("{SMALL_MAP} {more}"));
    let few = format!("sweep {SHORT} --over stops.travel_limit_mm=1,2 --over excitation.amplitude_g=0:2:0.2");
    let lines: Vec<String> = lines.chain(maps).chain([few]).collect();
    no_text_lies_on_another(&lines.iter().map(String::as_str).collect::<Vec<_>>());
}

#[test]
fn no_text_lies_on_another_in_a_picture_of_one_motion_or_of_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, line: &str| {
        let path = folder.path().join(name);
        fs::write(&path, stdout(line)).unwrap();
        path.display().to_string()
    };
    let record = write("record.csv", &format!("simulate paper {SHORT} --dt 0.001"));
    let pull = write("pull.csv", "curve paper --points 2001");
    let free =
        "simulate nominal-cubic --set stops=None --set excitation=None --set start=At(x_mm:7.6,v_m_per_s:0)";
    let decay = write("decay.csv", &format!("{free} --set run.duration_s=3 --dt 0.002"));
    let hertz = "stops=Hertz(travel_limit_mm:1.5,radius_mm:5,young_gpa:69,loss_s_per_m:10.4)";
    let lines = [
        "curve paper",
        "curve paper --at-mm 0,7 > --shapes-plot",
        "curve paper --at-mm -1.5 > --mechanism-plot",
        "curve harvester > --mechanism-plot",
        "curve magnet > --mechanism-plot",
        "curve paper --at-mm 1,-2 --beside harvester > --mechanism-plot",
        "curve paper --at-mm -1.5 --base-accel-g 0.8 > --well-plot",
        "curve bouncing-ball > --well-plot",
        &format!("curve paper --set {hertz} > --contact-plot"),
        &format!("curve paper --measured {pull}"),
        &format!("identify {pull} --of force"),
        &format!("identify {decay} --of damping"),
        &format!("identify {record} --of restitution"),
        &format!("simulate paper {SHORT}"),
        &format!("simulate paper {SHORT} --set excitation.amplitude_g=0.1"),
        &format!("simulate paper {SHORT} --beside uneven-stops --beside paper-unconstrained"),
        &format!("simulate paper {SHORT} --panels displacement"),
        &format!("simulate paper {SHORT} --panels portrait"),
        &format!("simulate paper {SHORT} --panels velocity,portrait"),
        &format!("simulate paper {SHORT} --panels energy"),
        &format!("simulate harvester {SHORT} --panels ledger"),
        &format!("accuracy paper {SHORT} --step-s 1/60"),
        &format!("simulate harvester {SHORT} --panels displacement,power"),
        &format!("simulate paper {SHORT} --measured {record} --inset 1:1.5"),
        &format!("section paper {SHORT}"),
        "spectrum random-shaking --of accel --quantity psd --rate-hz 50",
    ];
    no_text_lies_on_another(&lines);
}

#[test]
fn no_text_lies_on_another_in_a_picture_of_another_study() {
    let grazing = "--locus grazing --and excitation.frequency_hz=0.1:0.116";
    let noise = "--set excitation=Noise(rms_g:0.8,low_hz:0.5,high_hz:20,seed:1)";
    let lines = [
        "section paper --over excitation.amplitude_g=0.5:1:0.25",
        &format!("section paper {SHORT} --over excitation.amplitude_g=0.5:1:0.25 --at impacts"),
        "threshold paper --of release --over stops.travel_limit_mm=1:6:1",
        MELNIKOV,
        "basins paper --x-mm -1:1:3 --v -0.1:0.1:3",
        "basins paper --x-mm -1:1 --v -0.1:0.1 --random 4",
        "orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.06",
        "orbit impact-oscillator --branch excitation.amplitude_g=0.056:0.0545 --switch 1",
        &format!("orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.07 {grazing}"),
        "exponents duffing --over excitation.amplitude_g=0.2:0.4:0.1 --periods 20",
        &format!(
            "escape paper-unconstrained {noise} --runs 5 --within 5 --over excitation.rms_g=0.5:0.8:0.1"
        ),
        "compare paper uneven-stops",
        &format!("best paper {SHORT} --over stops.travel_limit_mm=1:3:0.5"),
        &format!("best paper {SHORT} --over stops.travel_limit_mm=1:3:1 --over mass_g=10:20:5"),
    ];
    no_text_lies_on_another(&lines);
}

#[test]
fn the_arguments_in_a_picture_make_it_again_byte_for_byte() {
    let (folder, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let map = format!("{SMALL_MAP} {PAPER} --jobs 1");
    for line in ["curve --set mass_g=14 --dark", "simulate paper --tolerance 1e-6 --no-title", &map] {
        for kind in ["png", "svg", "pdf"] {
            let original = bytes(line, folder.path(), &format!("a.{kind}"));
            assert!(original == bytes(line, other.path(), &format!("b.{kind}")));
            // that of a PDF is not read here: its arguments are those of the PNG
            let read = if kind == "pdf" { "c.png".to_owned() } else { format!("a.{kind}") };
            let from = plot(line, folder.path(), &read);
            let made = made(&from);
            let arguments: Vec<&str> = made["arguments"]
                .as_array()
                .unwrap()
                .iter()
                .map(|argument| argument.as_str().unwrap())
                .collect();
            assert!(
                !arguments.iter().any(|argument| ["--jobs", "--quiet", "--out"].contains(argument)),
                "{arguments:?}"
            );
            let arguments =
                arguments.iter().map(|argument| argument.replace("plot.png", &format!("plot.{kind}")));
            let mut again = assert_cmd::Command::cargo_bin("interwell").unwrap();
            again.args(arguments).args(["--out", "/dev/null", "--quiet", "--jobs", "2"]);
            again.current_dir(other.path()).assert().success();
            let again = fs::read(other.path().join(format!("plot.{kind}"))).unwrap();
            assert!(original == again, "{line} {kind}");
        }
    }
}

#[test]
fn a_picture_says_what_made_it() {
    let folder = tempfile::tempdir().unwrap();
    let line = "simulate random-shaking --set mass_g=14 --set excitation.seed=5 --tolerance 1e-7";
    for kind in ["png", "svg"] {
        let made = made(&plot(line, folder.path(), &format!("a.{kind}")));
        assert_eq!(made["program"], "interwell");
        assert_eq!(made["version"], env!("CARGO_PKG_VERSION"));
        assert_eq!(made["scene_name"], "built-in random-shaking");
        assert_eq!((made["tolerance"].as_f64(), made["seed"].as_u64()), (Some(1e-7), Some(5)));
        assert_eq!(made["changes"], serde_json::json!(["mass_g=14", "excitation.seed=5"]));
        // the scene's text runs, and has every argument applied
        let scene = folder.path().join("again.ron");
        fs::write(&scene, made["scene_ron"].as_str().unwrap()).unwrap();
        let output = stdout(&format!("simulate {}", scene.display()));
        assert_eq!(output, stdout(line));
    }
    let pdf = bytes(line, folder.path(), "a.pdf");
    let pdf = String::from_utf8_lossy(&pdf).into_owned();
    let software = format!("interwell {}", env!("CARGO_PKG_VERSION"));
    assert!(pdf.contains(&software) && pdf.contains("excitation.seed=5") && pdf.contains("dc:description"));
    // a footer too long for a line has several
    let long = "simulate paper --set mass_g=14 --set damping=Ratio(0.02) --set stops.travel_limit_mm=2 \
        --set stops.restitution=0.5 --set mechanism.preload_mm=2.6 --set excitation.frequency_hz=4 \
        --set run.duration_s=4";
    let long = format!("{long} --set run.settle_s=None");
    says(&long, &["mass_g=14", "stops.restitution=0.5", "excitation.frequency_hz=4", "run.settle_s=None"]);
}

/// The rows of a CSV file by the word in their first cell.
fn series<'a>(csv: &'a str, name: &str) -> Vec<Vec<&'a str>> {
    let rows = csv.lines().skip(1).map(|row| row.split(',').collect::<Vec<_>>());
    rows.filter(|row| row[0] == name).collect()
}

fn drawn(line: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("drawn.csv");
    let mut command = with_plot(line, &folder.path().join("a.svg"));
    command.arg("--plot-data").arg(&data).args(["--out", "/dev/null", "--quiet"]).assert().success();
    fs::read_to_string(data).unwrap()
}

#[test]
fn the_data_of_a_picture_are_the_rows_that_it_shows() {
    let map = drawn(SMALL_MAP);
    let rows = stdout(&format!("{SMALL_MAP} --quiet"));
    let cells = series(&map, "cell");
    assert_eq!(map.lines().next().unwrap(), "series,travel_limit_mm,amplitude_g,rms_velocity_m_per_s,regime");
    assert_eq!(cells.len(), 63);
    for (cell, row) in cells.iter().zip(rows.lines().skip(1)) {
        assert_eq!(cell[1..], row.split(',').take(4).collect::<Vec<_>>());
    }
    assert!(series(&map, "release").len() > 100 && series(&map, "first_crossing").len() >= 14);
    // in the ranges alone
    let part = drawn(&format!("{SMALL_MAP} --plot-x 2:4 --plot-y 0.5:1 --quantity max_abs_x_m"));
    assert_eq!(series(&part, "cell").len(), 9);
    assert!(part.starts_with("series,travel_limit_mm,amplitude_g,max_abs_x_m,regime\n"));

    let run = drawn(&format!("simulate paper {SHORT} --plot-time 0.5:1"));
    let times: Vec<f64> = series(&run, "run").iter().map(|row| row[1].parse().unwrap()).collect();
    assert!(times.len() > 100 && times.is_sorted());
    assert!(times.first() >= Some(&0.5) && times.last() <= Some(&1.0));
    let stops: Vec<&str> = series(&run, "stop").iter().map(|row| row[2]).collect();
    assert_eq!(stops, ["-0.0015", "0.0015"]);
    assert!(!series(&run, "impact").is_empty() && !series(&run, "portrait").is_empty());

    let curve = drawn("curve paper --plot-x 0:4");
    let x: Vec<f64> = series(&curve, "curve").iter().map(|row| row[1].parse().unwrap()).collect();
    assert!(x.len() > 500 && x.iter().all(|x| (0.0..=0.004).contains(x)));
    assert_eq!(series(&curve, "unstable_equilibrium"), [["unstable_equilibrium", "0", "0", "0"]]);

    let line = "threshold paper --of release --over stops.travel_limit_mm=1:6:1";
    assert!(
        drawn(line).starts_with("series,travel_limit_mm,least_amplitude_g,low,high,windows\nthreshold,1,0.")
    );
    for (line, header) in [
        ("spectrum paper", "series,frequency_hz,amplitude\n"),
        ("section paper --over excitation.amplitude_g=0.5:1:0.25", "series,amplitude_g,x_m,v_m_per_s\n"),
        ("basins paper --x-mm -1:1:3 --v -0.1:0.1:3", "series,x_mm,v_m_per_s,attractor,sure\nstart,-1,-0.1,"),
        (
            "orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.06",
            "series,amplitude_g,x_m,stable,event\nbranch,0.05,",
        ),
    ] {
        let csv = drawn(line);
        assert!(csv.starts_with(header) && csv.lines().count() > 9, "{line}: {}", &csv[..200.min(csv.len())]);
    }
}

#[test]
fn a_map_is_shown_as_a_surface_and_with_cuts() {
    let surface = format!("{SMALL_MAP} --surface");
    says(&surface, &["travel limit (mm)", "amplitude (g)", "RMS velocity (mm/s)", "at rest"]);
    says(&format!("{surface} --quantity impacts --dark"), &["impacts"]);
    // a column that is not written can be shown
    says(&format!("{surface} --quantity travel_m"), &["travel (mm)"]);
    let cuts = format!("{SMALL_MAP} --cut travel_limit_mm=2 --cut excitation.amplitude_g=1.25");
    let words = says(&cuts, &["at travel limit 2 mm", "at amplitude 1.25 g", "intrawell", "first crossing"]);
    assert_eq!(words.join(" ").matches("RMS velocity (mm/s)").count(), 3, "{words:?}");
    // the release along a cut is |F(limit)|/mass
    let data = drawn(&cuts);
    let release = series(&data, "cut_release");
    let least = stdout("threshold paper --of release --set stops.travel_limit_mm=2 --quiet");
    let least: f64 = least.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
    let found: f64 = release.iter().find(|row| row[1] == "2").unwrap()[2].parse().unwrap();
    assert!((found / least - 1.0).abs() < 1e-4, "{found} {least}");
    assert_eq!(release.iter().filter(|row| row[2] == "1.25").count(), 2);
}

#[test]
fn a_height_that_is_too_low_is_raised_and_said() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pdf");
    let low =
        with_plot("curve --plot-width-mm 85 --plot-height-mm 40 --out /dev/null", &path).assert().success();
    let said = String::from_utf8_lossy(&low.get_output().stderr).into_owned();
    assert!(said.contains("warning: --plot-height-mm: 40 mm are too low"), "{said}");
}
