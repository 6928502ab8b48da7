//! Scenes: reading and writing of every variant, checks, and fields that are set.

use interwell::scene::*;

mod arithmetic;
mod checking;
mod files;
mod flexures;
mod links;
mod properties;
mod reading;
mod setting;

/// A small valid scene with some fields given another text.
fn text(changes: &[(&str, &str)]) -> String {
    let mut fields = vec![
        ("title", "\"t\""),
        ("mass_g", "15.2"),
        ("mechanism", "Cubic(linear_n_per_m: -40, cubic_n_per_m3: 8.2e5)"),
        ("run", "(duration_s: 10)"),
    ];
    for (name, value) in changes {
        fields.retain(|(field, _)| field != name);
        fields.push((name, value));
    }
    let lines: Vec<String> = fields.iter().map(|(name, value)| format!("    {name}: {value},\n")).collect();
    format!("(\n{})\n", lines.concat())
}

fn document(changes: &[(&str, &str)]) -> Document {
    Document::from_text("s.ron", &text(changes), Files::default()).unwrap()
}

fn refused(text: &str) -> String {
    Document::from_text("s.ron", text, Files::default()).unwrap_err().to_string()
}

fn faults(changes: &[(&str, &str)]) -> String {
    document(changes).check().unwrap_err().to_string()
}

fn reads_back(scene: &Scene) {
    let written = write(scene).unwrap();
    let again = Document::from_text("again", &written, Files::default());
    assert_eq!(&again.unwrap_or_else(|error| panic!("{error}\n{written}")).scene, scene, "{written}");
}

/// The prototype's flexures, with what may be left out left out.
const FLEXURES: &str = "Flexures(preload_mm: 2.7, thickness_mm: 0.1, young_gpa: 190, \
    parallel: (count: 2, length_mm: 26, width_mm: 20), buckling: (count: 1, length_mm: 27.7, width_mm: 6.8))";

/// A scene that has every numeric field but those of the other variants.
fn broad(variant: usize) -> Document {
    let pick = |all: &[&'static str]| all[variant % all.len()];
    document(&[
        (
            "mechanism",
            pick(&[
                "Cubic(linear_n_per_m: -1, cubic_n_per_m3: 1)",
                "DoubleWell(equilibrium_mm: 7, barrier_mj: 0.5)",
                "Polynomial(coefficients_si: [1, 2, 3])",
                "Table(path: \"a.csv\")",
                FLEXURES,
            ]),
        ),
        ("damping", pick(&["Ratio(0.1)", "Coefficient(c_n_s_per_m: 1)"])),
        (
            "stops",
            pick(&[
                "Rigid(travel_limit_mm: 1, restitution: 0.5)",
                "Uneven(left_mm: 1, restitution_left: 0.5)",
            ]),
        ),
        (
            "excitation",
            pick(&[
                "Sine(frequency_hz: 3, amplitude_g: 1)",
                "Sum([Constant(accel_g: 1), AmplitudeRamp(frequency_hz: 3, from_g: 0, to_g: 2, over_s: 10), \
                 Sum([Sine(frequency_hz: 3, amplitude_g: 1)])])",
                "Chirp(from_hz: 1, to_hz: 9, over_s: 5, amplitude_g: 0.5)",
                "Noise(rms_g: 0.5, low_hz: 1, high_hz: 9, seed: 7, lines: 16)",
            ]),
        ),
        ("start", "At(x_mm: 0.5, v_m_per_s: 0)"),
        ("sweep", "[(field: \"mass_g\", from: 1, to: 2, step: 1)]"),
        ("app", "(stops_when_on: Rigid(travel_limit_mm: 1, restitution: 0.5))"),
    ])
}
