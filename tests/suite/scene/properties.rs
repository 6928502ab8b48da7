//! Arbitrary texts, values and scenes: no panic, and what is read can be written.

use interwell::scene::*;
use proptest::prelude::*;

use super::*;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![any::<f64>().prop_filter("finite", |x| x.is_finite()), -10.0..10.0, Just(0.0)]
}

fn stops() -> impl Strategy<Value = Stops> {
    let side = || proptest::option::of(number());
    prop_oneof![
        Just(Stops::None),
        (number(), number())
            .prop_map(|(travel_limit_mm, restitution)| Stops::Rigid { travel_limit_mm, restitution }),
        (number(), side(), number(), side(), side(), side(), side()).prop_map(
            |(
                travel_limit_mm,
                stiffness_n_per_m1_5,
                loss_s_per_m,
                radius_mm,
                young_gpa,
                poisson,
                yield_gpa,
            )| {
                Stops::Hertz {
                    travel_limit_mm,
                    stiffness_n_per_m1_5,
                    loss_s_per_m,
                    radius_mm,
                    young_gpa,
                    poisson,
                    yield_gpa,
                }
            }
        ),
        (side(), side(), side(), side()).prop_map(
            |(left_mm, right_mm, restitution_left, restitution_right)| {
                Stops::Uneven { left_mm, right_mm, restitution_left, restitution_right }
            }
        ),
    ]
}

fn excitation() -> impl Strategy<Value = Excitation> {
    let leaf = prop_oneof![
        Just(Excitation::None),
        number().prop_map(|accel_g| Excitation::Constant { accel_g }),
        (number(), number(), number()).prop_map(|(frequency_hz, amplitude_g, phase_deg)| {
            Excitation::Sine { frequency_hz, amplitude_g, phase_deg }
        }),
        (number(), number(), number()).prop_map(|(frequency_rad_per_s, amplitude_n, phase_deg)| {
            Excitation::Force { amplitude_n, frequency_rad_per_s, phase_deg }
        }),
        (number(), number(), number(), number()).prop_map(|(frequency_hz, from_g, to_g, over_s)| {
            Excitation::AmplitudeRamp { frequency_hz, from_g, to_g, over_s }
        }),
    ];
    leaf.prop_recursive(4, 16, 4, |inner| proptest::collection::vec(inner, 0..4).prop_map(Excitation::Sum))
}

fn flexures() -> impl Strategy<Value = Mechanism> {
    let group = || {
        (0_u64..100, number(), number()).prop_map(|(count, length_mm, width_mm)| FlexureGroup {
            count,
            length_mm,
            width_mm,
        })
    };
    let sizes = (number(), number(), number(), number(), number(), number());
    (sizes, any::<bool>(), group(), group()).prop_map(
        |(
            (preload_mm, thickness_mm, young_gpa, poisson, initial_bow_mm, yield_gpa),
            plane_strain,
            parallel,
            buckling,
        )| {
            Mechanism::Flexures {
                preload_mm,
                thickness_mm,
                young_gpa,
                parallel,
                buckling,
                poisson,
                plane_strain,
                initial_bow_mm,
                yield_gpa,
            }
        },
    )
}

fn scene() -> impl Strategy<Value = Scene> {
    let mechanism = prop_oneof![
        (number(), number())
            .prop_map(|(linear_n_per_m, cubic_n_per_m3)| Mechanism::Cubic { linear_n_per_m, cubic_n_per_m3 }),
        proptest::collection::vec(number(), 0..20)
            .prop_map(|coefficients_si| Mechanism::Polynomial { coefficients_si }),
        (any::<String>(), number()).prop_map(|(path, tolerance)| Mechanism::Table { path, tolerance }),
        flexures(),
    ];
    let app =
        (proptest::option::of(number()), proptest::option::of(stops())).prop_map(|(speed, stops)| AppHints {
            layout: Some(Layout::Study),
            speed,
            stops_when_on: stops.filter(|stops| *stops != Stops::None),
        });
    let steps = (any::<String>(), number(), number(), number())
        .prop_map(|(field, from, to, step)| SweepAxis { field, from, to, step, values: Vec::new() });
    let listed = (any::<String>(), proptest::collection::vec(number(), 1..5))
        .prop_map(|(field, values)| SweepAxis { field, values, ..SweepAxis::default() });
    let axis = prop_oneof![steps, listed];
    let rest = (
        (number(), proptest::option::of(number()), number(), any::<bool>()),
        proptest::option::of(app),
        proptest::collection::vec(axis, 0..3),
    );
    let title = prop_oneof![any::<String>(), "[\"#r\\\\( \n]*"];
    ((title, number(), mechanism, stops(), excitation()), rest).prop_map(
        |(
            (title, mass_g, mechanism, stops, excitation),
            ((duration_s, settle_s, tolerance, recurrence), app, sweep),
        )| {
            Scene {
                title,
                notes: "Some \"notes\".\n\nMore.".into(),
                mass_g,
                mechanism,
                damping: Damping::Ratio(mass_g),
                stops,
                transducer: Default::default(),
                excitation,
                start: Start::At { x_mm: mass_g, v_m_per_s: tolerance, electrical: 0.0 },
                run: RunSettings { duration_s, settle_s, tolerance, recurrence },
                sweep,
                app,
            }
        },
    )
}

proptest! {
    #[test]
    fn arbitrary_text_never_panics(text in any::<String>(), argument in any::<String>()) {
        let _ = Document::from_text("s.ron", &text, Files::default());
        let mut document = broad(1);
        let _ = document.set(&argument);
        let _ = document.axes(&[argument]);
        let _ = Places::of(&text);
    }

    #[test]
    fn almost_scenes_never_panic(
        at in 0_usize..400,
        cut in 0_usize..6,
        insert in "[-()\\[\\]{}:,\"'/*# \nre0-9é]{0,6}",
    ) {
        let mut chars: Vec<char> = broad(1).text.chars().collect();
        let at = at.min(chars.len());
        let end = (at + cut).min(chars.len());
        chars.splice(at..end, insert.chars());
        let text: String = chars.into_iter().collect();
        if let Ok(document) = Document::from_text("s.ron", &text, Files::default()) {
            let _ = document.check().map_err(|error| error.to_string());
            let _ = document.axes::<&str>(&[]);
            reads_back(&document.scene);
        }
    }

    #[test]
    fn fields_take_arbitrary_values_without_panic(
        field in 0_usize..60,
        value in "\\PC{0,12}|[A-Z][a-z]+\\([a-z_: 0-9]*\\)",
    ) {
        let mut document = broad(1);
        let fields = all_fields(&document.scene);
        let _ = document.set(&format!("{}={value}", fields[field % fields.len()]));
        let _ = document.check().map_err(|error| error.to_string());
        let _ = document.axes::<&str>(&[]);
    }

    #[test]
    fn any_scene_reads_back_as_written(scene in scene()) {
        reads_back(&scene);
        let document = Document::from_text("s.ron", &write(&scene).unwrap(), Files::default()).unwrap();
        let places = Places::of(&document.text);
        for field in all_fields(&scene) {
            if FieldPath::new(&field).get(&scene).is_some() {
                prop_assert!(places.find(&field) > places.find("title"), "{} in\n{}", field, document.text);
            }
        }
    }

    #[test]
    fn grids_are_decimal(
        from in -10_000_i32..10_000,
        steps in 1_u32..300,
        step in 1_i32..5000,
        digits in 0_u32..6,
    ) {
        let decimal = |n: i64| format!("{n}e-{digits}");
        let to = i64::from(from) + i64::from(step) * i64::from(steps);
        let over = format!(
            "mechanism.linear_n_per_m={}:{}:{}", decimal(from.into()), decimal(to), decimal(step.into())
        );
        let axis = broad(0).axes(&[over]).unwrap().remove(0);
        prop_assert_eq!(axis.values.len() as u32, steps + 1);
        for (i, value) in axis.values.iter().enumerate() {
            let exact: f64 = decimal(i64::from(from) + i64::from(step) * i as i64).parse().unwrap();
            prop_assert_eq!(*value, exact);
        }
    }
}
