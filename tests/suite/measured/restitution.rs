//! Restitution of bounces, exact and with noise and jitter of known size.

use interwell_studies::study::{Unidentified, restitution, restitution_of_times};

use super::{Noise, SEEDS, covered, holds, number};

const GRAVITY: f64 = 9.81;

/// Height over time of a ball that falls from 0.1 m, and its first impact times and speeds.
fn bounces(e: f64, count: u32) -> (impl Fn(f64) -> f64, Vec<f64>, Vec<f64>) {
    let first = (2.0 * 0.1 / GRAVITY).sqrt();
    let speed = GRAVITY * first;
    let mut impacts = vec![first];
    let mut speeds = vec![speed];
    for k in 1..=count {
        let out = speed * e.powi(k as i32);
        impacts.push(impacts[impacts.len() - 1] + 2.0 * out / GRAVITY);
        speeds.push(out);
    }
    let (times, outs) = (impacts.clone(), speeds.clone());
    let height = move |t: f64| {
        let k = times.partition_point(|time| *time <= t);
        if k == 0 {
            return 0.1 - 0.5 * GRAVITY * t * t;
        }
        let (since, out) = (t - times[k - 1], e * outs[k - 1]);
        (out * since - 0.5 * GRAVITY * since * since).max(0.0)
    };
    (height, impacts, speeds)
}

#[test]
fn without_noise_the_ratio_of_each_impact_has_its_digits() {
    for e in [0.36, 0.7, 0.9] {
        let (height, impacts, speeds) = bounces(e, 6);
        let end = impacts[3] + 0.4 * (impacts[4] - impacts[3]);
        let times: Vec<f64> = (0..).map(|i| f64::from(i) * 1e-4).take_while(|t| *t < end).collect();
        let x: Vec<f64> = times.iter().map(|t| height(*t)).collect();
        let found = restitution(&times, &x, None).unwrap();
        let column = |name: &str| found.rows.numbers(name).unwrap();
        assert_eq!(found.rows.rows(), 4, "{e}");
        for k in 0..4 {
            assert!((column("t_s")[k] - impacts[k]).abs() < 1e-9, "{e}: {k}");
            assert!((column("v_in_m_per_s")[k] / -speeds[k] - 1.0).abs() < 1e-8, "{e}: {k}");
            assert!((column("restitution")[k] - e).abs() < 1e-8, "{e}: {k}");
        }
        assert!((number(&found, "restitution").value - e).abs() < 1e-8, "{e}");
    }
}

#[test]
fn with_noise_and_jitter_the_intervals_hold_the_ratio_in_95_of_100_records() {
    for (e, noise, jitter) in [(0.36, 5e-5, 0.0), (0.7, 2e-4, 0.0), (0.7, 5e-5, 0.1)] {
        let (height, impacts, _) = bounces(e, 6);
        let end = impacts[3] + 0.5 * (impacts[4] - impacts[3]);
        let (mut hits, mut rows, mut all) = (0, 0, 0);
        for seed in 0..SEEDS {
            let mut random = Noise::new(seed);
            let times: Vec<f64> = (0..).map(|i| f64::from(i) * 5e-4).take_while(|t| *t < end).collect();
            let mut value =
                |t: &f64| height((t + jitter * 5e-4 * random.next()).max(0.0)) + noise * random.next();
            let x: Vec<f64> = times.iter().map(&mut value).collect();
            let found = restitution(&times, &x, None).unwrap();
            hits += u64::from(holds(number(&found, "restitution"), e));
            let column = |name: &str| found.rows.numbers(name).unwrap();
            let ends = column("restitution_low").iter().zip(column("restitution_high"));
            rows += ends.clone().filter(|(low, high)| (**low..=**high).contains(&e)).count();
            all += ends.count();
        }
        covered(hits, "restitution");
        // that of one impact holds the differences between fits too, which noise makes
        let share = rows as f64 / all as f64;
        assert!(share > 0.92 && all >= 300, "{share} of {all} impacts hold {e}");
    }
}

#[test]
fn smooth_turns_are_no_impacts() {
    let times: Vec<f64> = (0..3000).map(|i| f64::from(i) * 1e-3).collect();
    let mut random = Noise::new(1);
    for noise in [0.0, 1e-5] {
        let x: Vec<f64> = times.iter().map(|t| 1e-3 * (20.0 * t).sin() + noise * random.next()).collect();
        assert!(matches!(restitution(&times, &x, None), Err(Unidentified::NoImpact { .. })), "{noise}");
    }
}

#[test]
fn impact_times_alone_give_the_ratio_of_the_flights() {
    let (_, impacts, _) = bounces(0.8, 9);
    let found = restitution_of_times(&impacts).unwrap();
    assert!((number(&found, "restitution").value - 0.8).abs() < 1e-12);
    let mut hits = 0;
    for seed in 0..SEEDS {
        let mut random = Noise::new(seed);
        let times: Vec<f64> = impacts.iter().map(|t| t + 2e-4 * random.next()).collect();
        hits += u64::from(holds(number(&restitution_of_times(&times).unwrap(), "restitution"), 0.8));
    }
    covered(hits, "restitution of times");
    assert!(matches!(restitution_of_times(&[0.0, 1.0, 2.0]), Err(Unidentified::NoBounces(3, _))));
    assert!(restitution_of_times(&[0.0, 1.0, 3.0, 7.0, 15.0]).is_err());
}

/// A record of 301 samples a second of a mass that rests on its stop between impacts, of which few have
/// flights long enough: the restitution is 0.243 and the stop is at -10.28 mm.
#[test]
fn few_impacts_of_a_slow_record_hold_what_made_it() {
    let rows: Vec<[f64; 3]> = include_str!("slow-camera.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|number| number.parse().unwrap()).collect();
            numbers.try_into().unwrap()
        })
        .collect();
    let column = |of: usize| rows.iter().map(|row| row[of]).collect::<Vec<f64>>();
    let found = restitution(&column(0), &column(1), Some(&column(2))).unwrap();
    let restitution = number(&found, "restitution");
    assert!(holds(restitution, 0.243) && restitution.interval.1 - restitution.interval.0 < 0.1);
    let stop = number(&found, "left_stop_m");
    assert!(holds(stop, -10.28e-3) && stop.interval.1 - stop.interval.0 < 2e-3, "{:?}", stop.interval);
}
