//! Names of columns: without their unit, and those that may be meant by an unknown one.

use interwell::questions::{Best, Progress, Simulation, Sweep};
use interwell::scene::{find_name, unit_ending};
use interwell_studies::study::SUMMARY_FIELDS;

use super::{headless, refused, stdout};
use crate::support::Draw;

fn known() -> Vec<&'static str> {
    SUMMARY_FIELDS.iter().map(|field| field.name).collect()
}

#[test]
fn a_name_is_found_in_full_and_where_it_is_alone_without_its_unit() {
    let known = known();
    let mut short_of_several = 0;
    for name in &known {
        assert_eq!(find_name("column", name, &known), Ok(*name));
        let Some((ending, _)) = unit_ending(name) else { continue };
        let short = name.strip_suffix(ending).unwrap();
        let same: Vec<&&str> = known
            .iter()
            .filter(|other| {
                let without = unit_ending(other).and_then(|(ending, _)| other.strip_suffix(ending));
                **other == short || without == Some(short)
            })
            .collect();
        match (find_name("column", short, &known), same.len()) {
            (found, 1) => assert_eq!(found, Ok(*name), "{short}"),
            (found, _) => {
                let problem = found.unwrap_err();
                assert!(same.iter().all(|name| problem.contains(**name)), "{problem}");
                short_of_several += 1;
            }
        }
    }
    // three times in s, of which each is an amplitude in g too
    assert_eq!(short_of_several, 6);
}

/// One letter of a name is left out, doubled or exchanged with the next.
#[test]
fn a_name_with_a_slip_is_answered_with_the_one_that_is_meant() {
    let (known, mut draw) = (known(), Draw(11));
    let mut meant = 0;
    for _ in 0..500 {
        let name = known[draw.between(0.0, known.len() as f64) as usize];
        let mut letters: Vec<char> = name.chars().collect();
        let at = draw.between(1.0, letters.len() as f64 - 1.0) as usize;
        match draw.between(0.0, 3.0) as usize {
            0 => {
                letters.remove(at);
            }
            1 => letters.insert(at, letters[at]),
            _ => letters.swap(at, at + 1),
        }
        let slip: String = letters.into_iter().collect();
        if let Err(problem) = find_name("column", &slip, &known) {
            let near = problem.split('`').nth(1);
            assert!(near.is_some_and(|near| known.contains(&near)), "{slip}: {problem}");
            meant += usize::from(near == Some(name));
        }
    }
    assert!(meant > 400, "{meant} of 500");
    let far = find_name("column", "kjqzw", &known).unwrap_err();
    assert!(far.starts_with("no such column; there are final_x_m, "), "{far}");
}

#[test]
fn options_take_short_names_and_write_full_ones() {
    let sweep = "sweep nominal-cubic --over mass_g=10,12 --set run.duration_s=2 --set run.settle_s=1 --quiet";
    let full = stdout(&format!("{sweep} --columns rms_velocity_m_per_s,max_abs_x_m,period"));
    assert_eq!(stdout(&format!("{sweep} --columns rms_velocity,max_abs_x,period")), full);
    assert!(full.starts_with("mass_g,rms_velocity_m_per_s,max_abs_x_m,period\n"), "{full}");

    // an earlier name is answered with the present one
    let powered =
        "sweep harvester --over excitation.amplitude_g=0.9,1 --set run.duration_s=2 --quiet --columns";
    let full = stdout(&format!("{powered} mean_load_power_w"));
    assert!(full.starts_with("amplitude_g,mean_load_power_w\n"), "{full}");
    for name in ["mean_power_w", "mean_power", "mean_load_power"] {
        assert_eq!(stdout(&format!("{powered} {name}")), full);
    }
    let best =
        "best harvester --over stops.travel_limit_mm=1:2:0.5 --set run.duration_s=2 --quiet --maximise";
    let full = stdout(&format!("{best} mean_load_power_w"));
    assert!(full.contains(",mean_load_power_w,"), "{full}");
    assert_eq!(stdout(&format!("{best} mean_power_w --subject-to mean_power_w>=0")), full);

    let best = "best nominal-cubic --over stops.travel_limit_mm=1:5:1 --set run.duration_s=2 --quiet";
    let full = format!("{best} --maximise travel_m --subject-to max_abs_x_m<=0.003");
    assert_eq!(stdout(&format!("{best} --maximise travel --subject-to max_abs_x<=0.003")), stdout(&full));
}

#[test]
fn pictures_of_a_short_name_show_the_column() {
    let folder = tempfile::tempdir().unwrap();
    let data = |quantity: &str| {
        let line =
            "sweep nominal-cubic --over mass_g=10,12 --set run.duration_s=2 --set run.settle_s=1 --quiet";
        let mut command = headless(line);
        command.args([
            "--out",
            "/dev/null",
            "--plot",
            "a.svg",
            "--plot-data",
            "a.csv",
            "--quantity",
            quantity,
        ]);
        command.current_dir(folder.path()).assert().success();
        std::fs::read_to_string(folder.path().join("a.csv")).unwrap()
    };
    assert!(data("travel").lines().next().unwrap().contains("travel_m"));
    assert_eq!(data("travel"), data("travel_m"));
    assert_ne!(data("travel"), data("max_abs_x"));
}

#[test]
fn questions_take_short_names() {
    let simulation = Simulation::preset("nominal-cubic").unwrap();
    let columns = |names: &[&str]| {
        let columns = names.iter().map(|name| (*name).to_owned()).collect();
        let over = vec![("mass_g".to_owned(), vec![10.0])];
        Sweep { over, columns, ..Sweep::default() }.run(&simulation, &Progress::none())
    };
    let full = columns(&["rms_velocity_m_per_s", "voltage_rms_v"]).unwrap();
    let short = columns(&["rms_velocity", "voltage_rms"]).unwrap();
    // without a transducer a voltage is NaN, which equals nothing
    assert_eq!(format!("{short:?}"), format!("{full:?}"));
    let best = Best { maximise: "crosings".to_owned(), ..Best::over("mass_g", 10.0, 12.0) };
    let problem = best.run(&simulation, &Progress::none()).unwrap_err().to_string();
    assert!(problem.contains("did you mean `crossings`?"), "{problem}");
}

#[test]
fn columns_of_a_record_have_short_names_too() {
    let folder = tempfile::tempdir().unwrap();
    let row = |i: i32| {
        let t = f64::from(i) * 2e-3;
        let x = (-1.2 * t).exp() * (60.0 * t).cos();
        format!("{t},{x},{}\n", 2.0 * x)
    };
    let text = format!("t_s,laser (mm),other [mm]\n{}", (0..1000).map(row).collect::<String>());
    std::fs::write(folder.path().join("r.csv"), text).unwrap();
    let run = |column: &str| {
        let mut command = headless("identify r.csv --of damping --quiet --column");
        command.arg(column).current_dir(folder.path());
        command
    };
    let rows = |column: &str| run(column).assert().success().get_output().stdout.clone();
    assert_eq!(rows("laser"), rows("laser (mm)"));
    assert_ne!(rows("laser"), rows("other"));
    refused(run("lazer"), &["line 1", "no column lazer", "did you mean `laser (mm)`?"]);
}
