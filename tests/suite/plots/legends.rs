//! Legends of the picture of a run: each entry is told from the others and from every other line.

use interwell::output::{Look, Marks, Ranges, Role, RunPanel, Theme, run_chart};
use interwell::scene::PRESETS;
use interwell_studies::study::{Keep, simulate_with_trace};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng as _, SeedableRng as _};

use crate::shared::preset;

/// Whether a layer is drawn as a line.
fn is_line(marks: &Marks) -> bool {
    matches!(marks, Marks::Path(_) | Marks::Trace(_) | Marks::Horizontals(_) | Marks::Verticals(_))
}

#[test]
fn no_two_entries_of_a_legend_look_alike_in_any_set_of_panels() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for scene in PRESETS {
        let model = preset(scene.name, &["run.duration_s=2", "run.settle_s=1"]);
        let keep = Keep { times: Vec::new(), events: false, until_settled: None };
        let (simulation, trace) = simulate_with_trace(&model, &keep, None, None);
        for _ in 0..3 {
            let mut panels = RunPanel::ALL.to_vec();
            panels.retain(|_| random.next_u32() % 3 > 0);
            let chart = run_chart(&trace, &simulation.summary, &model, &panels, Ranges::default());
            let layers: Vec<_> = chart.panels().flat_map(|panel| &panel.layers).collect();
            for theme in [Theme::LIGHT, Theme::DARK] {
                let look = |role: Role| -> Look { theme.look(role) };
                for (i, named) in layers.iter().enumerate().filter(|(_, layer)| !layer.name.is_empty()) {
                    let others = layers.iter().enumerate().filter(|(j, layer)| {
                        i != *j && layer.name != named.name && is_line(&layer.marks) == is_line(&named.marks)
                    });
                    for (_, other) in others {
                        let (a, b) = (&named.name, &other.name);
                        let alike = look(named.role) == look(other.role);
                        assert!(!alike, "{}, {panels:?}: {a:?} and {b:?} look alike", scene.name);
                    }
                }
            }
            let names = |panel| panels.contains(&panel);
            let has = |name: &str| layers.iter().any(|layer| layer.name == name);
            assert_eq!(has("potential energy"), names(RunPanel::Energy), "{}", scene.name);
        }
    }
}

#[test]
fn a_state_once_a_period_lies_over_the_mass_at_rest() {
    let model = preset("paper", &["run.duration_s=2", "run.settle_s=None", "excitation.amplitude_g=0.1"]);
    let keep = Keep { times: Vec::new(), events: false, until_settled: None };
    let (simulation, trace) = simulate_with_trace(&model, &keep, None, None);
    let chart = run_chart(&trace, &simulation.summary, &model, &[RunPanel::Portrait], Ranges::default());
    let layers: Vec<&str> =
        chart.panels().flat_map(|panel| &panel.layers).map(|layer| &*layer.name).collect();
    let place = |name: &str| layers.iter().position(|layer| *layer == name).unwrap();
    assert!(place("once a period") > place("the mass at rest"), "{layers:?}");
}
