//! Uncertain inputs of a sweep: bands against closed forms, with draws that are made here once more by their
//! documented method; edges of ranges, invalid draws, bytes and pictures.

use std::f64::consts::TAU;
use std::fs;

use interwell::questions::{Progress, Simulation, Sweep, Uncertain};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::cli::{column, headless, stdout};
use crate::plots::texts;
use crate::support::*;

const GRAVITY: f64 = 9.806_65;

/// A number evenly between two.
fn between(random: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}

/// The probability below `x` by the Taylor series of the standard normal density.
fn probability(x: f64) -> f64 {
    let (mut term, mut sum) = (x, x);
    for odd in (3..400).step_by(2) {
        term *= x * x / f64::from(odd);
        sum += term;
    }
    0.5 + sum * (-0.5 * x * x).exp() / TAU.sqrt()
}

/// The draws of the first of `fields` uncertain fields, ascending, in standard deviations: at uniform
/// probabilities of what lies above `least`.
fn draws(seed: u64, count: usize, fields: usize, least: f64) -> Vec<f64> {
    let below = if least > -6.0 { probability(least) } else { 0.0 };
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let uniform = (0..count * fields).map(|_| ((random.next_u64() >> 12) as f64 + 0.5) / 2_f64.powi(52));
    let drawn = uniform.collect::<Vec<f64>>().into_iter().step_by(fields).map(|share| {
        let wanted = below + share * (1.0 - below);
        let (mut low, mut high) = (-9.0, 9.0);
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            // beyond 6 the series loses its digits
            let is_below = middle < -6.0 || (middle <= 6.0 && probability(middle) < wanted);
            *(if is_below { &mut low } else { &mut high }) = middle;
        }
        0.5 * (low + high)
    });
    let mut drawn: Vec<f64> = drawn.collect();
    drawn.sort_by(f64::total_cmp);
    drawn
}

/// The k-th of n values is the quantile k/(n + 1), with straight lines between.
fn quantile(values: &[f64], share: f64) -> f64 {
    let place = (share * (values.len() + 1) as f64).clamp(1.0, values.len() as f64);
    let before = values[place as usize - 1];
    before + place.fract() * (values[(place as usize).min(values.len() - 1)] - before)
}

/// An oscillator on a linear spring, with its mass, stiffness and damping in SI.
struct Linear {
    mass: f64,
    stiffness: f64,
    damping: f64,
    amplitude: f64,
    frequency: f64,
}

impl Linear {
    /// One whose transient is gone after ten seconds.
    fn random(random: &mut ChaCha8Rng) -> Self {
        let (mass, own) = (between(random, 0.005, 0.05), TAU * between(random, 2.0, 8.0));
        Self {
            mass,
            stiffness: mass * own * own,
            damping: 2.0 * between(random, 0.3, 0.8) * mass * own,
            amplitude: between(random, 0.2, 2.0),
            frequency: between(random, 1.0, 12.0),
        }
    }

    fn simulation(&self, stiffness: f64, damping: f64) -> Simulation {
        let text = format!(
            "(mass_g: {:?}, mechanism: Linear(n_per_m: {stiffness:?}),
              damping: Coefficient(c_n_s_per_m: {damping:?}),
              excitation: Sine(frequency_hz: {:?}, amplitude_g: {:?}),
              run: (duration_s: {:?}, settle_s: 10, tolerance: 1e-12))",
            1e3 * self.mass,
            self.frequency,
            self.amplitude,
            10.0 + 5.0 / self.frequency
        );
        Simulation::from_text("linear", &text).unwrap()
    }

    /// RMS velocity of the settled motion.
    fn rms(&self, stiffness: f64, damping: f64) -> f64 {
        let w = TAU * self.frequency;
        let below = (stiffness - self.mass * w * w).hypot(damping * w);
        self.mass * self.amplitude * GRAVITY * w / below / 2_f64.sqrt()
    }
}

/// The one cell of a sweep: RMS velocity, and the ends of its band.
fn band(simulation: &Simulation, over: &str, value: f64, uncertain: Uncertain) -> [f64; 3] {
    let sweep = Sweep { uncertain, ..Sweep::over_values(over, [value]) };
    let table = sweep.run(simulation, &Progress::none()).unwrap();
    ["", "_low", "_high"].map(|end| table.numbers(&format!("rms_velocity_m_per_s{end}")).unwrap()[0])
}

fn one(field: String, draws: usize, seed: u64) -> Uncertain {
    Uncertain { fields: vec![field], draws: Some(draws as u64), seed: Some(seed) }
}

#[test]
fn the_band_of_a_linear_oscillator_over_its_amplitude_is_that_of_the_draws() {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    for case in 0..12 {
        let linear = Linear::random(&mut random);
        let (count, seed) = (1 + (random.next_u64() % 150) as usize, random.next_u64());
        let share = between(&mut random, 0.01, 0.25); // at most a quarter, far from 0
        let sigma = share * linear.amplitude;
        let field = match case % 3 {
            0 => format!("excitation.amplitude_g=+-{sigma:?}"),
            1 => format!("excitation.amplitude_g={:?}\u{b1}{sigma:?}", linear.amplitude),
            _ => format!("excitation.amplitude_g=+-{:?}%", 100.0 * share),
        };
        let simulation = linear.simulation(linear.stiffness, linear.damping);
        // the field may be swept itself, if its value is not given
        let over = match case % 6 {
            0 | 2 => ("excitation.amplitude_g", linear.amplitude),
            _ => ("mass_g", 1e3 * linear.mass),
        };
        let [own, low, high] = band(&simulation, over.0, over.1, one(field, count, seed));
        let exact = linear.rms(linear.stiffness, linear.damping);
        near(own, exact, 1e-9 * exact);
        // an amplitude may be negative, so that nothing is cut off
        let drawn = draws(seed, count, 1, f64::NEG_INFINITY);
        for (found, end) in [(low, 0.025), (high, 0.975)] {
            near(found, own * (1.0 + share * quantile(&drawn, end)), 1e-9 * own);
        }
    }
}

#[test]
fn quantiles_go_through_monotone_functions() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for case in 0..12 {
        let mut linear = Linear::random(&mut random);
        // with these numbers both quantiles are draws, of which none reaches an end of its range
        let (count, seed) = ([39, 79, 119][case % 3], random.next_u64());
        let drawn = draws(seed, count, 1, f64::NEG_INFINITY);
        let rank = (count + 1) / 40;
        let (least, largest) = (drawn[rank - 1], drawn[count - rank]);
        let over = ("excitation.amplitude_g", linear.amplitude);
        let (found, exact) = if case % 2 == 0 {
            let sigma = 0.1 * linear.damping;
            let field = format!("damping.c_n_s_per_m={:?}+-{sigma:?}", linear.damping);
            let at = |draw: f64| linear.rms(linear.stiffness, linear.damping + sigma * draw);
            // the value is that of the input, not of the scene
            let simulation = linear.simulation(linear.stiffness, 0.5 * linear.damping);
            let found = band(&simulation, over.0, over.1, one(field, count, seed));
            (found, [at(0.0), at(largest), at(least)])
        } else {
            // far below its own frequency a stiffer spring moves less; the mechanism is another for each draw
            linear.frequency =
                between(&mut random, 0.05, 0.1) * (linear.stiffness / linear.mass).sqrt() / TAU;
            let field = format!("mechanism.n_per_m=+-{:?}", 0.1 * linear.stiffness);
            let at = |draw: f64| linear.rms(linear.stiffness * (1.0 + 0.1 * draw), linear.damping);
            let simulation = linear.simulation(linear.stiffness, linear.damping);
            let found = band(&simulation, over.0, over.1, one(field, count, seed));
            (found, [at(0.0), at(largest), at(least)])
        };
        for (found, exact) in found.into_iter().zip(exact) {
            near(found, exact, 1e-8 * exact);
        }
    }
}

/// A mass without a spring, which a damper brakes: v = v0 exp(-c t/m) has the draws of c.
#[test]
fn draws_lie_in_the_range_of_their_field_even_at_its_edge() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for case in 0..10 {
        let (mass, seed) = (between(&mut random, 0.01, 0.1), random.next_u64());
        let sigma = between(&mut random, 0.01, 0.1);
        let value = if case < 5 { 0.0 } else { between(&mut random, 0.0, 2.0) * sigma };
        let text = format!(
            "(mass_g: {:?}, mechanism: Linear(n_per_m: 0), damping: Coefficient(c_n_s_per_m: {value:?}),
              start: At(x_mm: 0, v_m_per_s: 1), run: (duration_s: 1, settle_s: 0, tolerance: 1e-12))",
            1e3 * mass
        );
        let sweep = Sweep {
            columns: vec!["final_v_m_per_s".to_owned()],
            // a second field, which changes nothing but the draws
            uncertain: Uncertain {
                fields: vec![format!("damping.c_n_s_per_m=+-{sigma:?}"), "start.x_mm=+-0".to_owned()],
                draws: Some(79),
                seed: Some(seed),
            },
            ..Sweep::over_values("run.duration_s", [0.5, 1.0])
        };
        let simulation = Simulation::from_text("braked", &text).unwrap();
        let table = sweep.run(&simulation, &Progress::none()).unwrap();
        let drawn = draws(seed, 79, 2, -value / sigma);
        assert!(drawn.iter().all(|draw| value + sigma * draw >= 0.0));
        for (row, t) in [0.5, 1.0].into_iter().enumerate() {
            let at = |draw: f64| (-(value + sigma * draw) * t / mass).exp();
            for (end, exact) in [("_low", at(drawn[77])), ("_high", at(drawn[1])), ("", at(0.0))] {
                let found = table.numbers(&format!("final_v_m_per_s{end}")).unwrap()[row];
                near(found, exact, 1e-10);
            }
        }
    }
}

#[test]
fn without_a_deviation_the_band_is_the_line() {
    for scene in ["nominal-cubic", "duffing", "bouncing-ball", "elastic-box"] {
        let short = "--set run.duration_s=3 --set run.settle_s=1";
        let line = format!("sweep {scene} {short} --over mass_g=10,20 --columns all --quiet");
        let (plain, banded) = (stdout(&line), stdout(&format!("{line} --uncertain mass_g=+-0 --draws 3")));
        for name in plain.lines().next().unwrap().split(',') {
            let own = column(&plain, name);
            assert_eq!(column(&banded, name), own, "{scene} {name}");
            if name == "mass_g" {
                continue;
            }
            let has =
                |end: &str| banded.lines().next().unwrap().split(',').any(|c| c == format!("{name}{end}"));
            if has("_share") {
                let share = column(&banded, &format!("{name}_share"));
                let whole = own.iter().map(|word| if word.is_empty() { "" } else { "1" });
                assert!(share.iter().map(String::as_str).eq(whole), "{scene} {name}: {share:?}");
            } else {
                assert_eq!(column(&banded, &format!("{name}_low")), own, "{scene} {name}");
                assert_eq!(column(&banded, &format!("{name}_high")), own, "{scene} {name}");
            }
        }
        assert_eq!(column(&banded, "draws"), ["3", "3"]);
    }
}

/// A draw that is no valid scene, here one that starts beyond a stop, and the share of a word.
#[test]
fn draws_that_are_no_scene_are_not_counted() {
    let mut random = ChaCha8Rng::seed_from_u64(4);
    for _ in 0..4 {
        let (seed, middle) = (random.next_u64() % 1000, between(&mut random, -0.9, 0.9));
        let line = format!(
            "sweep nominal-cubic --set stops.travel_limit_mm=1 --set run.duration_s=0.1 --set run.settle_s=0 \
             --set excitation=None --columns side,outcome --over mass_g=15 --quiet --draws 60 --seed {seed}"
        );
        let start = format!("start=At(x_mm:{middle},v_m_per_s:0)");
        let mut command = headless(&line);
        command.args(["--set", &start, "--uncertain", "start.x_mm=+-0.5"]);
        let csv = command.assert().success().get_output().stdout.clone();
        let csv = String::from_utf8(csv).unwrap();
        let starts = draws(seed, 60, 1, f64::NEG_INFINITY).into_iter().map(|draw| middle + 0.5 * draw);
        let starts: Vec<f64> = starts.filter(|x| x.abs() <= 1.0).collect();
        assert_eq!(column(&csv, "draws"), [starts.len().to_string()]);
        // the mass goes to the stop on its side of the barrier
        let same = starts.iter().filter(|x| (**x > 0.0) == (middle > 0.0)).count();
        let share = (same as f64 / starts.len() as f64).to_string();
        assert_eq!(column(&csv, "side_share"), [share.as_str()]);
        let all = format!("{}", starts.len() as f64 / 60.0);
        assert_eq!(column(&csv, "outcome_share"), [all.as_str()]);
    }
}

const BANDS: &str = "sweep nominal-cubic --quiet --set run.duration_s=1 --set run.settle_s=0 \
    --tolerance 1e-6 \
    --over excitation.amplitude_g=0.4:1.6:0.1 --over stops.travel_limit_mm=2,3 --draws 21 --seed 5 \
    --uncertain stops.travel_limit_mm=+-2% --uncertain mechanism.linear_n_per_m=-38+-1 \
    --uncertain stops.restitution=+-0.02";

#[test]
fn bands_have_the_same_bytes_for_any_number_of_threads_and_shards() {
    let text = stdout(BANDS);
    for jobs in [1, 2, 3] {
        assert_eq!(stdout(&format!("{BANDS} --jobs {jobs}")), text, "{jobs}");
    }
    assert_ne!(stdout(&BANDS.replace("--seed 5", "--seed 6")), text);
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for number in 1..=3 {
        let line = format!("{BANDS} --shard {number}/3 --out p{number}.csv");
        headless(&line).current_dir(folder).assert().success();
    }
    let merge = "merge p1.csv p2.csv p3.csv --out map.csv --quiet";
    headless(merge).current_dir(folder).assert().success();
    assert_eq!(fs::read_to_string(folder.join("map.csv")).unwrap(), text);
    // the manifest holds all that the rows are made of
    headless("sweep map.csv.json --check --quiet").current_dir(folder).assert().success();
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(folder.join("map.csv.json")).unwrap()).unwrap();
    let fields = ["stops.travel_limit_mm=+-2%", "mechanism.linear_n_per_m=+-1", "stops.restitution=+-0.02"];
    let uncertain = serde_json::json!({ "fields": fields, "draws": 21, "seed": 5 });
    assert_eq!(manifest["plan"]["uncertain"], uncertain);
    assert_eq!(manifest["cells"], 26);
    assert_eq!(manifest["mechanisms"], 22);
    // a cell of the map is the sweep of that cell alone, whether its field is swept or set
    let set = "--set stops.travel_limit_mm=3";
    let alone = BANDS.replace("0.4:1.6:0.1", "0.9").replace("--over stops.travel_limit_mm=2,3", set);
    let line = stdout(&alone).lines().nth(1).unwrap().split_once(',').unwrap().1.to_owned();
    assert!(text.lines().any(|row| row == format!("0.9,3,{line}")), "{line}");
    // a file that has all its rows goes on with nothing
    let whole = format!("{BANDS} --out one.csv");
    headless(&whole).current_dir(folder).assert().success();
    headless(&format!("{whole} --resume")).current_dir(folder).assert().success();
    let another = whole.replace("--draws 21", "--draws 22") + " --resume";
    headless(&another).current_dir(folder).assert().code(2);
    let forecast = stdout(&format!("{BANDS} --dry-run"));
    assert!(forecast.starts_with("26 rows: 13 amplitude_g x 2 travel_limit_mm; 22 columns"), "{forecast}");
}

#[test]
fn a_band_is_drawn_about_a_line() {
    let folder = tempfile::tempdir().unwrap();
    let draw = |line: &str| {
        let mut command = headless(&format!("{line} --out rows.csv --plot a.svg --plot-data a.csv"));
        command.current_dir(folder.path()).assert().success();
        let [data, rows] =
            ["a.csv", "rows.csv"].map(|name| fs::read_to_string(folder.path().join(name)).unwrap());
        (texts(&folder.path().join("a.svg")).join(" "), data, rows)
    };
    let line = BANDS.replace("--over stops.travel_limit_mm=2,3", "");
    let (words, data, rows) = draw(&line);
    let about = "95 % of 21 draws of stops.travel_limit_mm=4\u{b1}2%, mechanism.linear_n_per_m=-38\u{b1}1";
    for word in ["95 % of the draws", about] {
        assert!(words.contains(word), "`{word}` is not in: {words}");
    }
    let of_cells: Vec<bool> = column(&data, "series").iter().map(|series| *series == "cell").collect();
    for end in ["", "_low", "_high"] {
        let name = format!("rms_velocity_m_per_s{end}");
        let drawn = column(&data, &name).into_iter().zip(&of_cells).filter(|(_, is_cell)| **is_cell);
        assert_eq!(drawn.map(|(value, _)| value).collect::<Vec<_>>(), column(&rows, &name));
    }
    // a map is that of the cells themselves, and the share of a word can be shown
    let map = BANDS.replace("0.4:1.6:0.1", "0.4:1.6:0.4").replace("=2,3", "=2:3:0.25");
    let words = draw(&map).0;
    assert!(!words.contains("95 % of the draws"), "{words}");
    assert!(words.contains("the band of 95 % of 21 draws") && words.contains("is in the table"), "{words}");
    for (quantity, label) in [
        ("regime_share", "regime share"),
        ("rms_velocity_m_per_s_low", "RMS velocity, lower end of the band (mm/s)"),
    ] {
        let words = draw(&format!("{map} --quantity {quantity}")).0;
        assert!(words.contains(label), "{words}");
    }
}
