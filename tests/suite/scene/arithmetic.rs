//! Arithmetic in place of numbers: values against trees that the tests evaluate themselves, what is kept of
//! it when a scene is written, and errors.

use std::f64::consts::PI;

use interwell::numeric::elementary;
use interwell::scene::*;
use proptest::prelude::*;

use super::*;
use crate::properties::harness::hold_for;
use crate::support::{build, every, run_at, same_bits};

/// An expression as a tree.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Pi,
    Gravity,
    Minus(Box<Tree>),
    Root(Box<Tree>),
    Of(char, Box<Tree>, Box<Tree>),
}

use Tree::*;

impl Tree {
    /// The value; `None` if it or that of a part is not finite.
    fn value(&self) -> Option<f64> {
        let value = match self {
            Number(value) => *value,
            Pi => PI,
            Gravity => 9.80665,
            Minus(inner) => -inner.value()?,
            Root(inner) => inner.value()?.sqrt(),
            Of(sign, left, right) => {
                let (left, right) = (left.value()?, right.value()?);
                match sign {
                    '+' => left + right,
                    '-' => left - right,
                    '*' => left * right,
                    '/' => left / right,
                    _ => elementary::powf(left, right),
                }
            }
        };
        value.is_finite().then_some(value)
    }

    /// How closely it binds: sums 0, products 1, signs 2, powers 3, anything else 4.
    fn rank(&self) -> u32 {
        match self {
            Of('+' | '-', ..) => 0,
            Of('*' | '/', ..) => 1,
            Minus(_) => 2,
            Of(..) => 3,
            _ => 4,
        }
    }

    /// The text where at least `rank` is needed, with blanks and spare parentheses by the bits of `chance`.
    fn text(&self, rank: u32, chance: &mut u64) -> String {
        let mut draw = |of: u64| {
            *chance = chance.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (*chance >> 33) % of
        };
        let is_inside = self.rank() < rank || draw(6) == 0;
        let blank = [" ", "", "", "\n", "/* 2/ */", "// 1+\n", "\t"][draw(7) as usize];
        let form = draw(3);
        let text = match self {
            Number(value) if form == 0 || !(1e-6..1e15).contains(value) => format!("{value:e}"),
            Number(value) => format!("{value}"),
            Pi => "pi".to_owned(),
            Gravity => "g".to_owned(),
            Minus(part) => format!("-{blank}{}", part.text(2, chance)),
            Root(part) => format!("sqrt{blank}({})", part.text(0, chance)),
            Of('^', left, right) => {
                format!("{}{blank}^{}", left.text(4, chance), right.text(2, chance))
            }
            Of(sign, left, right) => {
                let rank = self.rank();
                format!("{}{blank}{sign} {}", left.text(rank, chance), right.text(rank + 1, chance))
            }
        };
        if is_inside { format!("({blank}{text})") } else { text }
    }
}

fn tree() -> impl Strategy<Value = Tree> {
    let number = prop_oneof![
        (0_u32..20).prop_map(f64::from),
        0.001..1000.0,
        any::<f64>().prop_map(f64::abs).prop_filter("finite", |value| value.is_finite()),
    ];
    let leaf = prop_oneof![4 => number.prop_map(Number), 1 => Just(Pi), 1 => Just(Gravity)];
    leaf.prop_recursive(6, 40, 2, |inner| {
        let sign = prop_oneof![Just('+'), Just('-'), Just('*'), Just('/'), Just('^')];
        prop_oneof![
            1 => inner.clone().prop_map(|part| Minus(Box::new(part))),
            1 => inner.clone().prop_map(|part| Root(Box::new(part))),
            5 => (sign, inner.clone(), inner)
                .prop_map(|(sign, left, right)| Of(sign, Box::new(left), Box::new(right))),
        ]
    })
}

fn mass(document: &Document) -> u64 {
    document.scene.mass_g.to_bits()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn expressions_have_the_bits_of_their_trees(tree in tree(), mut chance in any::<u64>()) {
        let written = tree.text(0, &mut chance);
        prop_assume!(written.len() <= 1000);
        let value = tree.value();
        let read = read_number(&written);
        prop_assert_eq!(read.ok().map(f64::to_bits), value.map(f64::to_bits), "{}", written);
        let of_file = Document::from_text("s.ron", &text(&[("mass_g", &written)]), Files::default());
        let mut set = document(&[]);
        let after_set = set.set(&format!("mass_g={written}"));
        let over = Axis::parse(&format!("mass_g={written},{written}"), &set.scene);
        let Some(value) = value else {
            prop_assert!(of_file.is_err() && after_set.is_err() && over.is_err(), "{}", written);
            return Ok(());
        };
        prop_assert_eq!(mass(&of_file.unwrap()), value.to_bits(), "{}", written);
        prop_assert_eq!(mass(&set), value.to_bits(), "{}", written);
        set.set(&format!("mechanism=Polynomial(coefficients_si: [1, {written}])")).unwrap();
        let coefficient = FieldPath::new("mechanism.coefficients_si.1").get(&set.scene);
        prop_assert_eq!(coefficient.map(f64::to_bits), Some(value.to_bits()), "{}", written);
        if (1e-15..1e15).contains(&value) {
            prop_assert_eq!(over.map(|axis| axis.values), Ok(vec![value; 2]), "{}", written);
        }
    }

    #[test]
    fn plain_numbers_keep_their_bits(value in any::<f64>()) {
        for written in [format!("{value}"), format!("{value:e}"), format!("{value:?}")] {
            let plain = written.parse::<f64>().unwrap();
            prop_assert_eq!(read_number(&written).map(f64::to_bits), Ok(plain.to_bits()));
        }
    }

    #[test]
    fn a_range_ends_where_its_steps_lead(from in -5.0..5.0, span in 0.1..50.0, count in 1_u32..200) {
        let to = from + span;
        let scene = document(&[("start", "At(x_mm: 0, v_m_per_s: 0)")]).scene;
        let axis = Axis::parse(&format!("start.x_mm={from}:{to}:({to} - ({from}))/{count}"), &scene).unwrap();
        prop_assert_eq!(axis.values.len(), count as usize + 1);
        prop_assert_eq!((axis.values[0], axis.values[count as usize]), (from, to));
        let even = |i: usize| -> f64 { from + span * i as f64 / f64::from(count) };
        let is_even = |(i, value): (usize, &f64)| (value - even(i)).abs() <= 1e-13;
        prop_assert!(axis.values.iter().enumerate().all(is_even), "{:?}", axis.values);
        let again = Axis::from_scene(&axis.to_scene(&scene), &scene).unwrap();
        prop_assert_eq!(again.values, axis.values);
    }
}

#[test]
fn ranges_of_arithmetic_and_of_decimals_agree() {
    let scene = document(&[("start", "At(x_mm: 0, v_m_per_s: 0)")]).scene;
    let values = |range: &str| Axis::parse(&format!("start.x_mm={range}"), &scene).unwrap().values;
    let turn = values("0:2*pi:pi/8");
    assert_eq!((turn.len(), turn[16], turn[4]), (17, 2.0 * PI, PI / 2.0));
    assert_eq!(values("0:1/2:0.1"), values("0:0.5:0.1"));
    assert_eq!(values("-1/2:0.5:1/4"), [-0.5, -0.25, 0.0, 0.25, 0.5]);
    assert_eq!(values("0:1:3/10"), [0.0, 0.3, 0.6, 0.9]);
    let listed = |axis: &str| {
        let sweep = format!("[(field: \"mass_g\", {axis})]");
        document(&[("sweep", &sweep)]).axes::<&str>(&[]).unwrap()[0].values.clone()
    };
    assert_eq!(listed("from: 1, to: 2, step: 1/3"), [1.0, 1.0 + 1.0 / 3.0, 1.0 + 2.0 / 3.0, 2.0]);
    assert_eq!(listed("values: [1/4, g, 2*(1 + 1)]"), [0.25, 9.80665, 4.0]);
}

/// The text with each of its numbers, one a line, as arithmetic of the same value.
fn rewritten(text: &str) -> (String, usize) {
    let mut count = 0;
    let mut number = |written: &str| -> Option<String> {
        let value = written.parse::<f64>().ok().filter(|value| value.is_finite())?;
        count += 1;
        Some(match count % 7 {
            0 => format!("({written})"),
            1 => format!("{written}*1"),
            2 => format!("-(-{value:e})"),
            3 => format!("{written} / 1"),
            4 => format!("({written})^1"),
            5 => format!("{written} - 0"),
            _ => format!("1 * /* {value} */ (({written}))"),
        })
    };
    let line = |line: &str| {
        let (body, comma) = line.strip_suffix(',').map_or((line, ""), |body| (body, ","));
        let begin = body.rfind([' ', '(']).map_or(0, |at| at + 1);
        let end = body.len() - usize::from(body.ends_with(')'));
        let changed = body.get(begin..end).and_then(&mut number);
        changed.map_or(line.to_owned(), |to| format!("{}{to}{}{comma}", &body[..begin], &body[end..]))
    };
    let lines: Vec<String> = text.lines().map(line).collect();
    (lines.join("\n"), count)
}

#[test]
fn presets_with_arithmetic_are_the_same_scenes_and_run_alike() {
    for preset in PRESETS {
        let plain = Document::preset(preset.name).unwrap();
        let (text, count) = rewritten(&write(&plain.scene).unwrap());
        let changed =
            Document::from_text("s.ron", &text, plain.files.clone()).unwrap_or_else(|e| panic!("{e}"));
        let numbers = numeric_fields(&plain.scene);
        // the state of a circuit is left out where it is 0
        let given = numbers.iter().filter(|field| **field != "start.electrical");
        let given = given.filter(|field| FieldPath::new(field).get(&plain.scene).is_some());
        assert!(count >= given.count(), "{}: {count} numbers in {text}", preset.name);
        assert_eq!(format!("{:?}", changed.scene), format!("{:?}", plain.scene));
        assert_eq!(changed.check().unwrap().len(), plain.check().unwrap().len());
        let times = every(0.1 * plain.scene.run.duration_s, 9);
        let run = |document: &Document| run_at(&build(document), &times);
        same_bits(&run(&changed), &run(&plain));
        // all of it is there again when the scene is written
        let kept = changed.write(&changed.scene).unwrap();
        assert_eq!(kept.trim(), text.trim());
    }
}

/// A scene with comments, and strings that look like arithmetic.
const COMMENTED: &str = "(
    // 1/2 of nothing
    title: \"1/2\", notes: \"2*pi, (1+2)\",
    mass_g: 30.4 /* 2*15.2 */ / 2, // half
    mechanism: Cubic(linear_n_per_m: -(2 * 20), cubic_n_per_m3: 8.2e5),
    damping: Ratio(1/(2*25)),
    stops: Uneven(left_mm: Some(3/2), right_mm: sqrt(2), restitution_left: 0.36),
    excitation: Sine(frequency_hz: 2*pi, amplitude_g: 0.21/g, phase_deg: 90),
    run: (duration_s: 10),
    sweep: [(field: \"mass_g\", from: 1/4, to: 3/4, step: 1/8), (field: \"damping.xi\", values: [1/3, 0.5])],
)";

#[test]
fn what_was_written_stays_until_that_field_changes() {
    let read = |text: &str| Document::from_text("s.ron", text, Files::default()).unwrap();
    let mut document = read(COMMENTED);
    document.check().unwrap();
    assert_eq!((document.scene.title.as_str(), document.scene.mass_g), ("1/2", 15.2));
    assert_eq!(document.text, COMMENTED);
    let all = [
        "mass_g: 30.4 /* 2*15.2 */ / 2,",
        "linear_n_per_m: -(2 * 20),",
        "Ratio(1/(2*25))",
        "left_mm: 3/2,",
        "right_mm: sqrt(2),",
        "frequency_hz: 2*pi,",
        "amplitude_g: 0.21/g,",
        "to: 3/4,",
        "1/3,",
    ];
    let has = |text: &str, without: &str| {
        for part in all {
            assert_eq!(text.contains(part), part != without, "{part} in {text}");
        }
    };
    let written = document.write(&document.scene).unwrap();
    has(&written, "");
    let again = read(&written);
    assert_eq!(again.scene, document.scene);
    assert_eq!(again.write(&again.scene).unwrap(), written);

    // a field that is changed by a number, by the window, and by arithmetic
    document.set("excitation.phase_deg=180/2").unwrap();
    document.set("excitation.amplitude_g=0.3").unwrap();
    let text = document.write(&document.scene).unwrap();
    has(&text, "amplitude_g: 0.21/g,");
    assert!(text.contains("amplitude_g: 0.3,") && text.contains("phase_deg: 180/2,"), "{text}");
    let mut moved = document.scene.clone();
    moved.excitation = Excitation::Sine { frequency_hz: 3.0, amplitude_g: 0.21 / 9.80665, phase_deg: 90.0 };
    let text = read(COMMENTED).write(&moved).unwrap();
    has(&text, "frequency_hz: 2*pi,");
    assert!(text.contains("frequency_hz: 3.0,"), "{text}");

    // a whole part that is replaced
    document.set("stops=Rigid(travel_limit_mm: 3/8, restitution: 1-0.64)").unwrap();
    let text = document.write(&document.scene).unwrap();
    assert!(text.contains("travel_limit_mm: 3/8,") && text.contains("restitution: 1-0.64,"), "{text}");
    assert!(!text.contains("sqrt") && !text.contains("3/2"), "{text}");
    assert_eq!(read(&text).scene, document.scene);
}

#[test]
fn links_keep_arithmetic() {
    let mut paper = Document::preset("paper").unwrap();
    for change in ["mass_g=15.2*9/8", "excitation.amplitude_g=3/g", "stops.travel_limit_mm=2"] {
        paper.set(change).unwrap();
    }
    paper.set("stops.travel_limit_mm=2.5").unwrap();
    let linked = Document::load(&paper.link().unwrap()).unwrap();
    assert_eq!(linked.scene, paper.scene);
    let changes: Vec<&str> = linked.changes().collect();
    assert_eq!(changes, ["mass_g=15.2*9/8", "stops.travel_limit_mm=2.5", "excitation.amplitude_g=3/g"]);
    let file = Document::from_text("s.ron", COMMENTED, Files::default()).unwrap();
    let linked = Document::load(&file.link().unwrap()).unwrap();
    assert_eq!(linked.scene, file.scene);
    assert_eq!(linked.write(&linked.scene), file.write(&file.scene));
}

#[test]
fn whole_numbers_may_be_arithmetic() {
    let noise = |seed: &str| format!("Noise(rms_g: 0.1, low_hz: 1, high_hz: 9, seed: {seed}, lines: 2^4)");
    let document = document(&[("excitation", &noise("7*6"))]);
    let numbers =
        ["excitation.seed", "excitation.lines"].map(|path| FieldPath::new(path).get(&document.scene));
    assert_eq!(numbers, [Some(42.0), Some(16.0)]);
    let mut set = document;
    set.set("excitation.seed=2^53").unwrap();
    assert_eq!(FieldPath::new("excitation.seed").get(&set.scene), Some(9_007_199_254_740_992.0));
    for (value, shown) in [("5/2", "2.5"), ("1-3", "-2"), ("2^70", "1180591620717411300000")] {
        let error = set.set(&format!("excitation.seed={value}")).unwrap_err().to_string();
        assert!(error.contains(&format!("`{value}` = {shown} is not a whole number from 0 up;")), "{error}");
    }
    let error = refused(&text(&[("excitation", &noise("5/2"))]));
    assert!(error.starts_with("s.ron:6:64: excitation.seed: ") && error.ends_with("`5/2` is 2.5"), "{error}");
}

#[test]
fn faults_show_what_was_written_and_what_it_is() {
    let mut document = document(&[("stops", "Rigid(travel_limit_mm: 1/4 - 1, restitution: 3/2)")]);
    let error = document.check().unwrap_err().to_string();
    let lines: Vec<&str> = error.lines().collect();
    assert!(lines[0].starts_with("s.ron:6:18: stops.travel_limit_mm = 1/4 - 1 = -0.75: must be "), "{error}");
    assert!(lines[1].starts_with("s.ron:6:44: stops.restitution = 3/2 = 1.5: must be 0 to 1"), "{error}");
    document.set("stops.travel_limit_mm=-sqrt(4)").unwrap();
    let error = document.check().unwrap_err().to_string();
    let place =
        "s.ron: --set stops.travel_limit_mm=-sqrt(4): stops.travel_limit_mm = -sqrt(4) = -2: must be ";
    assert!(error.starts_with(place), "{error}");
}

#[test]
fn broken_arithmetic_has_a_place_and_a_remedy() {
    let deep = format!("1*{}1{}", "(".repeat(65), ")".repeat(65));
    let long = format!("1{}", "+1".repeat(500));
    for (written, column, problem) in [
        ("2*mass", 15, "`2*mass`: `mass` is unknown; arithmetic has pi, g (9.80665) and sqrt(..)"),
        ("sin(1) + 2*cos(1)", 13, "expected a number"),
        ("1 + sin(2)", 17, "`sin` is unknown"),
        ("1/0", 14, "`1/0`: a division by 0; give another divisor"),
        ("1/(pi - pi)", 14, "a division by 0"),
        ("sqrt(1-2)", 13, "a root or a broken power of a negative number"),
        ("(0-8)^(1/3)", 18, "a root or a broken power of a negative number"),
        ("1e200*1e200/1e300", 18, "the result is beyond the largest number, 1.8e308"),
        ("2*1e400", 15, "`1e400` is beyond the largest number"),
        ("2*", 15, "it ends where a number is expected"),
        ("2*(1+3", 15, "this `(` has no `)`"),
        ("sqrt 2", 18, "`(` is missing after `sqrt`"),
        ("2*(3 4)", 15, "this `(` has no `)`"),
        ("1/2 g", 17, "a unit stands in the name of its field"),
        (deep.as_str(), 0, "it is nested deeper than 64 levels"),
        (long.as_str(), 13, "it is longer than 1000 bytes"),
    ] {
        let error = refused(&text(&[("mass_g", written)]));
        assert!(error.contains("mass_g: ") && error.contains(problem), "{written} gives {error}");
        assert!(column == 0 || error.starts_with(&format!("s.ron:5:{column}: ")), "{written} gives {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
        let mut document = document(&[]);
        let before = document.scene.clone();
        let error = document.set(&format!("mass_g={written}")).unwrap_err().to_string();
        assert!(error.starts_with("--set mass_g=") && document.scene == before, "{error}");
        let over = document.axes(&[format!("mass_g={written},5")]).unwrap_err().to_string();
        assert!(over.starts_with("--over mass_g="), "{over}");
    }
    // words, units and lists are what they were
    for plain in ["heavy", "15,2", "15 g", "g2", "(a: 1)", "[1, 2]", "\"1/2\"", "1..2", "pie"] {
        let error = refused(&text(&[("mass_g", plain)]));
        assert!(!error.contains("arithmetic"), "{plain} gives {error}");
    }
    // all of them at once, and what stands before them first
    let error = refused(&text(&[("mass_g", "1/0"), ("damping", "Ratio(2*x)"), ("run", "(duration_s: 10)")]));
    let places: Vec<&str> = error.lines().map(|line| line.split(": ").next().unwrap()).collect();
    assert_eq!(places, ["s.ron:4:14", "s.ron:5:22"], "{error}");
    let error = refused(&text(&[("colour", "3"), ("mass_g", "1/0")]));
    assert!(error.starts_with("s.ron:5:5: unknown field `colour`"), "{error}");
    assert!(error.contains("s.ron:6:14: mass_g: `1/0`: a division by 0"), "{error}");
}

#[test]
fn places_behind_arithmetic_are_those_of_the_text() {
    let error = refused(&text(&[("mass_g", "1\n/\n3"), ("stops", "Rigid(travel_mm: 1)")]));
    assert!(error.starts_with("s.ron:8:18: unknown field `travel_mm` in Rigid"), "{error}");
    let error = refused(&text(&[("stops", "Rigid(travel_limit_mm: 1/3, limit: 2/7)")]));
    assert!(error.starts_with("s.ron:6:40: unknown field `limit` in Rigid"), "{error}");
    let error = faults(&[("stops", "Rigid(travel_limit_mm: 1/3, restitution: 2)")]);
    assert!(error.starts_with("s.ron:6:40: stops.restitution = 2"), "{error}");
}

#[test]
fn hostile_arithmetic_is_refused_in_time() {
    let count = 100_000;
    for hostile in [
        format!("{}1{}", "(".repeat(count), ")".repeat(count)),
        format!("2*{}1{}", "(".repeat(count), ")".repeat(count)),
        "(".repeat(count),
        "(-".repeat(count),
        format!("{}1", "-".repeat(count)),
        format!("1{}", "^2".repeat(count)),
        format!("1{}", "+1".repeat(count)),
        format!("{}1", "sqrt(".repeat(count)),
        format!("1/*{}", "/*".repeat(count)),
        format!("1{}2", "/*".repeat(count)),
    ] {
        assert!(refused(&text(&[("mass_g", &hostile)])).len() < 700);
        assert!(document(&[]).set(&format!("mass_g={hostile}")).unwrap_err().to_string().len() < 700);
        assert!(read_number(&hostile).unwrap_err().len() < 400);
    }
    let many = "1/0, ".repeat(count);
    let error = refused(&text(&[("mechanism", &format!("Polynomial(coefficients_si: [{many}])"))]));
    assert!(error.lines().count() <= 51, "{}", error.lines().count());
}

/// Parentheses, roots, signs and powers within each other, in any order: 64 levels are read, and no more.
#[test]
fn sixty_four_levels_are_read_and_no_more() {
    let nested = proptest::collection::vec(0..4_usize, 1..100);
    let check = |levels: &Vec<usize>| {
        // the value stays 1
        let inner = levels.iter().fold("1".to_owned(), |inner, level| match level {
            0 => format!("({inner})"),
            1 => format!("sqrt({inner})"),
            2 => format!("1^{inner}"),
            _ => format!("--{inner}"),
        });
        let depth: usize = levels.iter().map(|level| if *level == 3 { 2 } else { 1 }).sum();
        let written = format!("2*{inner}");
        if depth <= 64 {
            prop_assert_eq!(read_number(&written), Ok(2.0));
            let scene = Document::from_text("s.ron", &text(&[("mass_g", &written)]), Files::default());
            prop_assert_eq!(scene.unwrap().scene.mass_g, 2.0);
        } else {
            let error = read_number(&written).unwrap_err();
            prop_assert!(error.contains("it is nested deeper than 64 levels"), "{error}");
        }
        Ok((50..80).contains(&depth))
    };
    hold_for("nested", 400, 0.1, nested, |levels| format!("{levels:?}"), check);
}
