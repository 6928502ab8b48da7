//! Walks run by run: what the sweep and the section that carry the state give, in the order of the walk.

use std::sync::Mutex;
use std::sync::atomic::AtomicBool;

use interwell::system::threads::Pool;
use interwell_studies::study::{Direction, Family, Task, Visit, up_and_down};

use super::cli::{column, stdout};
use super::support::*;

const AMPLITUDE: &str = "excitation.amplitude_g";

/// The visits of a built-in scene over a field.
fn visits((name, changes): (&str, &[&str]), field: &str, values: &[f64], jobs: usize) -> Vec<Visit> {
    let document = changed(name, changes);
    let mechanism = mechanism(&document);
    let family = Family::new(&document.scene, &document.files, &mechanism, field);
    let (found, cancel) = (Mutex::new(Vec::new()), AtomicBool::new(false));
    let task = Task { tick: &|| (), cancel: &cancel };
    let each = |visit: Visit| found.lock().unwrap().push(visit);
    assert!(up_and_down(&family, values, &Direction::ALL, &Pool::new(jobs).unwrap(), &task, &each));
    found.into_inner().unwrap()
}

fn of(visits: &[Visit], direction: Direction) -> Vec<Visit> {
    visits.iter().filter(|visit| visit.direction == direction).cloned().collect()
}

#[test]
fn they_are_the_rows_of_the_sweep_and_of_the_section() {
    let changes = ["run.duration_s=200", "run.settle_s=150"];
    let values: Vec<f64> = (0..6).map(|i| f64::from(10 + 4 * i) / 100.0).collect();
    let visits = visits(("duffing", &changes), AMPLITUDE, &values, 2);
    let over = "--over excitation.amplitude_g=0.1:0.3:0.04 --carry both --quiet \
                --set run.duration_s=200 --set run.settle_s=150";
    let sweep = stdout(&format!("sweep duffing {over} --columns rms_velocity_m_per_s"));
    let section = stdout(&format!("section duffing {over}"));
    let fields = ["direction", "amplitude_g"].map(|name| column(&section, name));
    for direction in [Direction::Up, Direction::Down] {
        let chosen = of(&visits, direction);
        let ways = column(&sweep, "direction");
        let rows: Vec<usize> = (0..ways.len()).filter(|row| ways[*row] == direction.name()).collect();
        let read = |name: &str, row: usize| column(&sweep, name)[row].parse::<f64>().unwrap();
        let expected: Vec<(f64, f64)> =
            rows.iter().map(|row| (read("amplitude_g", *row), read("rms_velocity_m_per_s", *row))).collect();
        let got: Vec<(f64, f64)> =
            chosen.iter().map(|visit| (visit.value, visit.summary.rms_velocity.unwrap())).collect();
        assert_eq!(got, expected);
        for visit in &chosen {
            let amplitude = visit.value.to_string();
            let of_it = |row: &usize| fields[0][*row] == direction.name() && fields[1][*row] == amplitude;
            let x = column(&section, "x_m");
            let strobes: Vec<f64> = (0..x.len()).filter(of_it).map(|row| x[row].parse().unwrap()).collect();
            assert!(!strobes.is_empty());
            assert_eq!(visit.strobes, strobes[strobes.len().saturating_sub(60)..]);
        }
    }
    // each way in its own order
    assert!(of(&visits, Direction::Up).windows(2).all(|pair| pair[0].value < pair[1].value));
    assert!(of(&visits, Direction::Down).windows(2).all(|pair| pair[0].value > pair[1].value));
}

#[test]
fn a_value_without_a_scene_is_passed_over_and_threads_change_nothing() {
    // of the three, one is more than the flexures are long
    let walked = |jobs: usize| visits(("paper", &[]), "mechanism.preload_mm", &[2.6, 50.0, 2.7], jobs);
    let bare = |visits: Vec<Visit>| {
        let mut all: Vec<Visit> = visits;
        all.iter_mut().for_each(|visit| visit.summary.cpu_s = 0.0);
        all.sort_by(|a, b| {
            (a.direction.name(), a.value).partial_cmp(&(b.direction.name(), b.value)).unwrap()
        });
        all
    };
    let one = bare(walked(1));
    assert_eq!(one.iter().map(|visit| visit.value).collect::<Vec<_>>(), [2.6, 2.7, 2.6, 2.7]);
    assert_eq!(one, bare(walked(3)));
}

#[test]
fn it_ends_when_it_is_cancelled() {
    let document = changed("paper", &[]);
    let mechanism = mechanism(&document);
    let family = Family::new(&document.scene, &document.files, &mechanism, AMPLITUDE);
    let (count, cancel) = (Mutex::new(0), AtomicBool::new(false));
    let task = Task { tick: &|| cancel.store(true, std::sync::atomic::Ordering::Relaxed), cancel: &cancel };
    let values: Vec<f64> = (1..1000).map(|i| f64::from(i) / 1e3).collect();
    let count_one = |_| *count.lock().unwrap() += 1;
    let whole = up_and_down(&family, &values, &Direction::ALL, &Pool::new(1).unwrap(), &task, &count_one);
    assert!(!whole);
    assert_eq!(*count.lock().unwrap(), 1);
}
