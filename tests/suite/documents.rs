//! The documents: every field, column and word of the program stands in them, and what they show works.

mod alternatives;
mod declared;

use std::fs;
use std::path::Path;

use interwell::dynamics::{EventKind, Outcome, Phase, Regime};
use interwell::scene::{Document, FIELDS, Files};
use interwell_studies::study::{Cell, SUMMARY_FIELDS};

use crate::cli::{headless, stdout};

const README: &str = include_str!("../../README.md");
const SCENE: &str = include_str!("../../docs/scene.md");
const OUTPUT: &str = include_str!("../../docs/output.md");
const MEASURED: &str = include_str!("../../docs/measured.md");
const STUDIES: &str = include_str!("../../docs/studies.md");

/// Whether `name` stands in `page` as code.
fn says(page: &str, name: &str) -> bool {
    page.contains(&format!("`{name}`"))
}

/// The blocks of a page in this language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let fence = format!("```{language}\n");
    page.split(fence.as_str()).skip(1).map(|rest| rest.split_once("```").unwrap().0).collect()
}

/// Each declared field of a scene, `name: Type,` in the source, with the comment above it.
fn declared_fields() -> Vec<(String, String)> {
    let sources = [
        include_str!("../../kernel/src/scene/data.rs"),
        include_str!("../../kernel/src/scene/mechanism.rs"),
        include_str!("../../kernel/src/scene/stops.rs"),
        include_str!("../../kernel/src/scene/transducer.rs"),
    ];
    let (mut fields, mut comment) = (Vec::new(), String::new());
    for line in sources.iter().flat_map(|text| text.lines()).map(str::trim) {
        if let Some(text) = line.strip_prefix("///") {
            comment.push_str(text);
            continue;
        }
        if line.starts_with('#') {
            continue;
        }
        let declared = line.strip_prefix("pub ").unwrap_or(line).split_once(": ");
        let is_name =
            |name: &str| name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
        match declared {
            _ if line == "Ratio(f64)," => fields.push(("xi".to_owned(), comment.clone())),
            Some((name, kind))
                if kind.ends_with(',')
                    && !line.contains(['(', ')', '=', '{', '}'])
                    && is_name(name)
                    && name != "record" =>
            {
                fields.push((name.to_owned(), comment.clone()));
            }
            _ => {}
        }
        comment.clear();
    }
    fields
}

#[test]
fn every_field_of_a_scene_is_documented_with_its_range() {
    let declared = declared_fields();
    let dictionaries = ["scene.dict", "arguments.dict"].map(|name| {
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/dictionaries").join(name))
            .unwrap()
    });
    let rows = |name: &str| -> Vec<&str> {
        SCENE.lines().filter(|row| row.starts_with("| `") && says(row, name)).collect()
    };
    for (name, _) in declared.iter().filter(|(name, _)| name != "xi") {
        let known = |text: &String| [": ", "="].iter().any(|end| text.contains(&format!("\"{name}{end}")));
        assert!(dictionaries.iter().all(known), "fuzz/dictionaries do not hold `{name}`");
        assert!(!rows(name).is_empty(), "docs/scene.md has no row for `{name}`");
    }
    assert!(declared.len() > 60, "{} fields found", declared.len());
    for field in FIELDS {
        let name = field.path.rsplit('.').next().unwrap();
        let range = field.range.to_string();
        let commented = declared.iter().any(|(other, comment)| other == name && comment.contains(&range));
        assert!(commented, "kernel/src/scene does not say that `{name}` is {range}");
        let range = range.trim_start_matches("whole, ");
        let in_text = SCENE.lines().any(|line| says(line, field.path) && line.contains(range));
        let in_rows = rows(name).iter().any(|row| row.contains(range));
        assert!(in_rows || in_text, "docs/scene.md: `{}` is {range}", field.path);
    }
    // a comment that states a range states that of the table
    let is_number = |word: &str| word.trim_end_matches([',', '.', ';']).parse::<f64>().is_ok();
    for (name, comment) in &declared {
        let words: Vec<&str> = comment.split(' ').collect();
        let states_range = words.windows(3).any(|w| is_number(w[0]) && w[1] == "to" && is_number(w[2]));
        let ends_with_name = |path: &str| path.rsplit('.').next() == Some(name.as_str());
        let known = FIELDS.iter().filter(|field| ends_with_name(field.path));
        let stated = known.filter(|field| comment.contains(&field.range.to_string())).count();
        assert!(!states_range || stated > 0, "{name}: `{comment}` states another range");
    }
}

#[test]
fn every_column_and_word_of_the_output_is_documented() {
    let words = SUMMARY_FIELDS.iter().map(|field| field.name).chain(
        [Regime::Rest, Regime::Intrawell, Regime::Interwell, Regime::Irregular, Regime::Crossing]
            .map(Regime::name),
    );
    let kinds = [EventKind::Impact, EventKind::Rest, EventKind::Release, EventKind::Crossing];
    let compliant = [EventKind::Contact, EventKind::Separate].map(EventKind::name);
    let phases = [Phase::Free, Phase::LeftStop, Phase::RightStop].map(Phase::name);
    for word in words.chain(kinds.map(EventKind::name)).chain(compliant).chain(phases) {
        assert!(says(OUTPUT, word), "docs/output.md does not say `{word}`");
    }
    let outcomes = [
        Outcome::Done,
        Outcome::LeftTable { at: 0.0 },
        Outcome::ImpactBudget { at: 0.0, count: 0 },
        Outcome::StepBudget { at: 0.0, count: 0 },
        Outcome::NotFinite { at: 0.0 },
        Outcome::Inaccurate { residual: 0.0 },
        Outcome::Cancelled { at: 0.0 },
    ];
    for word in outcomes.map(Outcome::name).into_iter().chain([Cell::Unsolved.outcome()]) {
        assert!(says(OUTPUT, word), "docs/output.md does not say `{word}`");
    }

    let hertz = "--set stops=Hertz(travel_limit_mm:1.5,stiffness_n_per_m1_5:3.7e9,loss_s_per_m:10)";
    let tables = [
        "simulate paper --at 0,1".to_owned(),
        "simulate paper --at 0 --out /dev/null --events -".to_owned(),
        "curve paper --full --points 3".to_owned(),
        "curve paper --out /dev/null --shapes - --points 3".to_owned(),
        format!("curve paper --out /dev/null --contact - {hertz}"),
        "threshold paper --of release".to_owned(),
        "exponents paper --quiet".to_owned(),
        "escape paper --runs 1 --within 1 --set excitation=Noise(rms_g:1,low_hz:1,high_hz:9,seed:1) --quiet"
            .to_owned(),
        "threshold paper --probability 0.5 --runs 1 --within 1 --field excitation.rms_g=0:1 \
         --set excitation=Noise(rms_g:1,low_hz:1,high_hz:9,seed:1) --quiet"
            .to_owned(),
        "threshold duffing --field excitation.amplitude_g=0:0.1:0.1 --melnikov --quiet".to_owned(),
        "spectrum paper --rate-hz 30 --quiet".to_owned(),
        "section paper --over excitation.amplitude_g=1 --carry up --quiet".to_owned(),
        "section paper --at impacts".to_owned(),
        "basins paper --x-mm 0:1:2 --v 0:0:1 --quiet".to_owned(),
        "basins paper --x-mm 0:1:2 --v 0:0:1 --quiet --out /dev/null --attractors -".to_owned(),
        "orbit impact-oscillator --branch excitation.amplitude_g=0.05:0.06 --quiet".to_owned(),
        "accuracy --case grazing --out - --quiet".to_owned(),
        "accuracy nominal-cubic --out - --quiet".to_owned(),
        "sweep paper --over excitation.amplitude_g=1 --columns all --out - --quiet".to_owned(),
        "compare nominal-cubic --quiet".to_owned(),
        "best nominal-cubic --over stops.travel_limit_mm=3:4:1 --set run.duration_s=1 --set run.settle_s=0 \
         --environment excitation.amplitude_g=0.5,1 --quiet"
            .to_owned(),
    ];
    for command in tables {
        let csv = stdout(&command);
        let header = csv.lines().next().unwrap();
        for column in header.split(',').filter(|name| !["amplitude_g", "travel_limit_mm"].contains(name)) {
            assert!(says(OUTPUT, column), "docs/output.md does not say `{column}` of {command}");
        }
    }
    for (command, least) in
        [("simulate paper --out /dev/null --summary -", 30), ("curve paper --out /dev/null --landscape -", 5)]
    {
        let json: serde_json::Value = serde_json::from_str(&stdout(command)).unwrap();
        let keys: Vec<&String> = json.as_object().unwrap().keys().collect();
        assert!(keys.len() >= least);
        for key in keys {
            assert!(says(OUTPUT, key), "docs/output.md does not say `{key}` of {command}");
        }
    }
}

#[test]
fn the_keys_of_a_manifest_are_documented() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().join("map.csv");
    headless("sweep paper --over excitation.amplitude_g=1 --quiet --out").arg(&data).assert().success();
    let starts = folder.path().join("starts.csv");
    let line = "basins paper --x-mm 0:1:2 --v 0:0:1 --quiet --out";
    headless(line).arg(&starts).assert().success();
    let compared = folder.path().join("compared.csv");
    headless("compare monostable --quiet --out").arg(&compared).assert().success();
    for name in ["map.csv.json", "starts.csv.json", "compared.csv.json"] {
        let text = fs::read_to_string(folder.path().join(name)).unwrap();
        let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
        for key in manifest.as_object().unwrap().keys() {
            assert!(says(OUTPUT, key), "docs/output.md does not say `{key}` of {name}");
        }
    }
}

#[test]
fn scenes_in_the_documents_are_valid() {
    let scenes: Vec<&str> = [README, SCENE].iter().flat_map(|page| blocks(page, "ron")).collect();
    assert_eq!(scenes.len(), 9);
    for text in scenes {
        Document::from_text("document", text, Files::default()).unwrap().check().unwrap();
    }
}

/// The commands of a page, without the program's name.
fn commands(page: &str) -> Vec<&str> {
    let lines = blocks(page, "sh").into_iter().flat_map(str::lines);
    lines.filter_map(|line| line.strip_prefix("interwell --headless ")).collect()
}

/// The picture that a command makes.
fn picture(command: &str) -> &str {
    command.split("--plot ").nth(1).unwrap().split(' ').next().unwrap()
}

#[test]
fn each_picture_of_the_studies_is_made_by_a_command_beside_it() {
    let commands = commands(STUDIES);
    assert!(commands.len() >= 9, "{commands:?}");
    for command in &commands {
        let shown = format!("](../assets/{})", picture(command));
        assert!(STUDIES.contains(&shown), "docs/studies.md does not show {}", picture(command));
    }
    assert_eq!(STUDIES.matches("](../assets/").count(), commands.len());
    // the long ones are only read
    for command in &commands {
        headless(command).arg("--help").assert().success();
    }
    let quick = ["hysteresis-stops.png", "branch.png", "basins-stops.png", "spectrum.png"];
    let folder = tempfile::tempdir().unwrap();
    for command in commands.into_iter().filter(|command| quick.contains(&picture(command))) {
        headless(command).arg("--quiet").current_dir(folder.path()).assert().success();
    }
    for made in quick {
        assert!(fs::metadata(folder.path().join(made)).unwrap().len() > 0, "{made}");
    }
}

#[test]
fn the_commands_on_measured_data_work_and_what_they_write_is_documented() {
    let folder = tempfile::tempdir().unwrap();
    for command in commands(MEASURED) {
        let mut words = command.split('\'');
        let mut line = headless(words.next().unwrap());
        if let Some(quoted) = words.next() {
            line.arg(quoted).args(words.next().unwrap_or_default().split_whitespace());
        }
        line.arg("--quiet").current_dir(folder.path()).assert().success();
    }
    assert!(fs::metadata(folder.path().join("measured.png")).unwrap().len() > 0);
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();
    for name in ["difference.csv", "ratio.csv", "impacts.csv", "force.csv"] {
        for column in read(name).lines().next().unwrap().split(',') {
            assert!(says(OUTPUT, column), "docs/output.md does not say `{column}` of {name}");
        }
    }
    for quantity in read("difference.csv").lines().skip(1).map(|line| line.split(',').next().unwrap()) {
        assert!(says(OUTPUT, quantity), "docs/output.md does not say `{quantity}`");
    }
    for name in ["ratio.json", "force.json"] {
        let json: serde_json::Value = serde_json::from_str(&read(name)).unwrap();
        for key in json.as_object().unwrap().keys() {
            assert!(says(OUTPUT, key), "docs/output.md does not say `{key}` of {name}");
        }
    }
}

#[test]
fn the_readmes_commands_work() {
    let folder = tempfile::tempdir().unwrap();
    let commands = commands(README);
    assert!(commands.len() >= 5, "{commands:?}");
    for command in commands {
        headless(command).arg("--quiet").current_dir(folder.path()).assert().success();
    }
    for made in ["run.csv", "events.csv", "run.json", "run.png", "map.csv", "map.csv.json"] {
        assert!(fs::metadata(folder.path().join(made)).unwrap().len() > 0, "{made}");
    }
}

/// How the damping ratio is read decides how far out stops help: README and notes say the same of it, and
/// `check` prints the numbers.
#[test]
fn the_reading_of_the_damping_ratio_is_the_same_everywhere() {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (readme, notes) = (words(README), words(&Document::load("paper").unwrap().scene.notes));
    for claim in ["it takes about 1.4 g without stops, and stops up to 3.4 mm lower that", "0.358 N s/m"] {
        assert!(readme.contains(claim), "README.md does not say: {claim}");
        assert!(notes.contains(claim), "the notes of paper do not say: {claim}");
    }
    assert!(readme.contains("With stops up to 2.6 mm the mass crosses at weaker shaking"));
    let checked = stdout("check paper");
    assert!(checked.contains("c = 2 xi sqrt(k m) = 0.0663") && checked.contains("c = 0.3579"), "{checked}");
}

#[test]
fn links_and_pictures_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let pages = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md"];
    let mut pages = pages.map(|page| root.join(page)).to_vec();
    pages.extend(fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path()));
    let mut links = 0;
    for page in pages.iter().filter(|page| page.extension().is_some_and(|ending| ending == "md")) {
        let text = fs::read_to_string(page).unwrap();
        for target in text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap()) {
            if !target.starts_with("http") {
                let path = page.parent().unwrap().join(target.split('#').next().unwrap());
                assert!(path.exists(), "{}: {target}", page.display());
                links += 1;
            }
        }
    }
    assert!(links > 8, "{links}");
}

#[test]
fn the_version_is_the_same_everywhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let version = env!("CARGO_PKG_VERSION");
    let citation = fs::read_to_string(root.join("CITATION.cff")).unwrap();
    assert!(citation.lines().any(|line| line == format!("version: {version}")), "CITATION.cff");
    for name in [format!("interwell_{version}_amd64.deb"), format!("interwell-{version}-x86_64-linux.tar.gz")]
    {
        assert!(README.contains(&name), "README.md does not name {name}");
    }
}
