//! Cost of what a scene does not use, which should be none: `cargo bench --bench absent`.
//!
//! First the same scene by the general path and written out by hand (`by_hand`): the end is the same bit for
//! bit (a test holds that), the time should be within a few per cent. By hand there is the motion alone, and
//! with the crossings counted, as every run of a scene with a well counts them; the ratio is to the latter.
//! Both count them by the same search, and neither locates them: their instants are asked for only in a
//! settled window under a periodic drive, and by events.
//!
//! Where nothing is asked for but this, the general path goes on in a loop of its own
//! (`dynamics/run/event_free.rs`), which asks of each step whether it comes near an end of the mode, the
//! barrier, or a border of time. What keeps the ratio above 1: some 1.5 us a run for what begins and ends
//! one, and 10 to 20 ns a step: these questions, the origin of the piece, and the series as a call of its
//! own. How the compiler lays out the loops makes a twentieth either way, and where the machine's other
//! threads leave less of the processor, instructions count for more and the ratio rises.
//!
//! Then what is asked for, or stands in the scene without an effect, against the same scene without it. A
//! ratio is the median over pairs run in turn.

mod by_hand;
mod shared;

use by_hand::{End, Problem};
use interwell::dynamics::{Model, Request, Run};

const PAIRS: usize = 401;

/// One well that hardens, and the preset's two. The window of the statistics is the last millisecond, so that
/// nothing is summed before.
const ONE_WELL: [&str; 3] = [
    "mechanism=Cubic(linear_n_per_m: 40, cubic_n_per_m3: 816326.530612245)",
    "stops=None",
    "run.settle_s=9.999",
];
const TWO_WELLS: [&str; 2] = ["stops=None", "run.settle_s=9.999"];
const SINE: &str = "excitation.amplitude_g=1.1";
const STILL: [&str; 2] = ["excitation=None", "start=At(x_mm: 9, v_m_per_s: 0)"];

fn main() {
    println!(
        "| scene | tolerance | motion by hand, us | with crossings, us | general, us | ratio | same bits |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for tolerance in ["1e-6", "1e-9"] {
        let set = format!("run.tolerance={tolerance}");
        let model = |well: &[&str], drive: &[&str]| {
            shared::preset("nominal-cubic", &[well, drive, &[set.as_str()]].concat())
        };
        let (sine, still) = (Some((1.1, 3.0)), (9e-3, 0.0));
        by_hand("one well, sine", tolerance, &model(&ONE_WELL, &[SINE]), sine, (0.0, 0.0));
        by_hand("one well, no drive", tolerance, &model(&ONE_WELL, &STILL), None, still);
        let two = model(&TWO_WELLS, &[SINE]);
        let rest = two.mechanism().landscape.right_stable().unwrap().x;
        by_hand("two wells, sine", tolerance, &two, sine, (rest, 0.0));
        by_hand("two wells, no drive", tolerance, &model(&TWO_WELLS, &STILL), None, still);
    }
    println!();
    println!("| what is added | without, us | with, us | with over without | same motion |");
    println!("| --- | --- | --- | --- | --- |");
    let none = Request::default();
    let times: Vec<f64> = (1..=1000).map(|i| f64::from(i) * 0.01).collect();
    let asked = [
        ("events", Request { events: true, ..none }),
        ("ledger", Request { ledger: true, ..none }),
        ("1000 samples", Request { sample_times: &times, ..none }),
    ];
    let free = |more: &[&str]| shared::preset("nominal-cubic", &[&["stops=None", SINE], more].concat());
    let p1 = free(&[]);
    let far = "stops=Rigid(travel_limit_mm: 1e6, restitution: 0.36)";
    let silent =
        "excitation=Sum([Sine(frequency_hz: 3, amplitude_g: 1.1), Sine(frequency_hz: 3, amplitude_g: 0)])";
    compare("no stops: statistics over half the run", (&free(&["run.settle_s=9.999"]), &none), (&p1, &none));
    compare("no stops: stops out of reach", (&p1, &none), (&free(&[far]), &none));
    compare("no stops: a second tone of amplitude 0", (&p1, &none), (&free(&[silent]), &none));
    let open = "transducer=Electromagnetic(coupling_v_s_per_m: 5, coil_ohm: 40, load_ohm: inf)";
    let coil = "transducer=Electromagnetic(coupling_v_s_per_m: 0.1, coil_ohm: 40, load_ohm: 60)";
    let damped = "damping=Coefficient(c_n_s_per_m: 0.1)";
    compare("no stops: a transducer in an open circuit", (&p1, &none), (&free(&[open]), &none));
    let (bare, with) = (free(&[damped]), free(&[damped, coil, "transducer.inductance_mh=50"]));
    compare("no stops: a transducer with a state", (&bare, &none), (&with, &none));
    for (name, request) in &asked {
        compare(&format!("no stops: {name}"), (&p1, &none), (&p1, request));
    }
    let p2 = shared::preset("nominal-cubic", &[]);
    for (name, request) in &asked {
        compare(&format!("stops at 4 mm: {name}"), (&p2, &none), (&p2, request));
    }
}

fn end(run: &Run) -> End {
    let summary = &run.summary;
    End { x: summary.final_x, v: summary.final_v, steps: summary.steps, crossings: summary.total_crossings }
}

fn by_hand(name: &str, tolerance: &str, model: &Model, sine: Option<(f64, f64)>, start: (f64, f64)) {
    let problem = Problem::new(model, sine, start);
    let request = Request::default();
    let same = if problem.run_counting() == end(&model.run(&request)) { "yes" } else { "NO" };
    let pairs = shared::rounds(PAIRS);
    let (bare, _, _) = shared::compare(pairs, || problem.run(), || ());
    let (hand, general, ratio) = shared::compare(pairs, || problem.run_counting(), || model.run(&request));
    println!(
        "| {name} | {tolerance} | {:.0} | {:.0} | {:.0} | {ratio:.3} | {same} |",
        bare * 1e6,
        hand * 1e6,
        general * 1e6
    );
}

fn compare(name: &str, without: (&Model, &Request), with: (&Model, &Request)) {
    let same = if end(&without.0.run(without.1)) == end(&with.0.run(with.1)) { "yes" } else { "to rounding" };
    let (a, b, ratio) =
        shared::compare(shared::rounds(PAIRS), || without.0.run(without.1), || with.0.run(with.1));
    println!("| {name} | {:.0} | {:.0} | {ratio:.3} | {same} |", a * 1e6, b * 1e6);
}
