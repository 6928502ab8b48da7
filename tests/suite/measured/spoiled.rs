//! Records drawn at random, of bounces in closed form and of shaken masses by fine steps, spoiled as cameras
//! and sensors spoil them: drift, tilt, noise, outliers, missing samples, a stop that ends.

use std::f64::consts::TAU;

use interwell::scene::{Channel, Quantity};
use interwell_studies::study::{damping, restitution};

use super::{Noise, hold_95_of_100, holds, number};
use crate::properties::harness::multiplied;

const GRAVITY: f64 = 9.81;

/// Parts of a sample's step in which a shaken mass is integrated.
const PARTS: usize = 16;

/// A record, and what is true of it. SI.
pub struct Spoiled {
    pub times: Vec<f64>,
    pub x: Vec<f64>,
    /// The acceleration of the base.
    pub base: Option<Vec<f64>>,
    /// Restitution of the left and the right stop.
    pub restitution: [f64; 2],
    /// Drift of the picture, if it is uniform.
    pub drift: Option<f64>,
    pub about: String,
}

fn one_in(random: &mut Noise, count: f64) -> bool {
    random.between(0.0, count) < 1.0
}

fn sign(random: &mut Noise) -> f64 {
    if one_in(random, 2.0) { 1.0 } else { -1.0 }
}

/// What a camera makes of displacements of a mass with impacts at `speed` and a way of `height`.
fn spoil(random: &mut Noise, record: &mut Spoiled, speed: f64, height: f64) {
    let noise = match one_in(random, 8.0) {
        true => 0.0,
        false => height * random.of_any_size(1e-5, 5e-3),
    };
    let mut rate = 0.0;
    let mut bend = 0.0;
    if !one_in(random, 4.0) {
        rate = sign(random) * speed * random.of_any_size(1e-4, 0.15);
    }
    let duration = record.times[record.times.len() - 1];
    if one_in(random, 5.0) {
        bend = sign(random) * speed * random.of_any_size(1e-4, 0.05) / duration;
    }
    let tilt = if one_in(random, 3.0) { random.between(-0.2, 0.2) } else { 0.0 };
    let across = speed * random.between(-0.3, 0.3);
    record.drift = (bend == 0.0).then_some(rate + across * tilt.sin());
    for (t, x) in record.times.iter().zip(&mut record.x) {
        *x =
            *x * tilt.cos() + across * t * tilt.sin() + rate * t + 0.5 * bend * t * t + noise * random.next();
    }
    let outliers = if one_in(random, 2.0) { random.of_any_size(1e-3, 2e-2) } else { 0.0 };
    for x in &mut record.x {
        if random.even() < outliers {
            let size = if one_in(random, 2.0) { noise * random.of_any_size(5.0, 300.0) } else { 0.0 };
            *x += sign(random) * if size > 0.0 { size } else { height * random.between(0.01, 0.5) };
        }
    }
    let mut lost = 0;
    if one_in(random, 3.0) {
        let share = random.between(0.0, 0.05);
        let mut kept: Vec<bool> = record.times.iter().map(|_| random.even() > share).collect();
        for _ in 0..random.between(0.0, 4.0) as usize {
            let from = random.between(0.0, kept.len() as f64) as usize;
            let to =
                (from + random.of_any_size(3.0, 0.03 * kept.len() as f64 + 4.0) as usize).min(kept.len());
            kept[from..to].fill(false);
        }
        lost = kept.iter().filter(|kept| !**kept).count();
        let keep = |values: &mut Vec<f64>| {
            let mut kept = kept.iter();
            values.retain(|_| *kept.next().unwrap());
        };
        keep(&mut record.times);
        keep(&mut record.x);
        record.base.iter_mut().for_each(keep);
    }
    record.about += &format!(
        ", noise {noise:.1e}, drift {:.2e} bend {bend:.1e}, outliers {outliers:.1e}, {lost} lost",
        rate + across * tilt.sin()
    );
}

/// A ball that falls on a floor, which may end during a flight: then it falls on, to the end of the record or
/// to another floor.
pub fn bounced(seed: u64) -> Spoiled {
    let random = &mut Noise::new(seed);
    let (e, height, place) =
        (random.between(0.2, 0.95), random.of_any_size(0.02, 1.0), random.between(-0.2, 0.2));
    let fall = (2.0 * height / GRAVITY).sqrt();
    let speed = GRAVITY * fall;
    // samples of the first rebound
    let samples = random.of_any_size(12.0, 400.0);
    let step = 2.0 * e * fall / samples;
    // the instants from which on it flies at a speed from a floor
    let (mut flights, mut floor, mut t, mut v) = (vec![(0.0, 0.0, height)], 0.0, fall, speed);
    let after = if one_in(random, 3.0) { random.between(2.0, 7.0) as usize } else { usize::MAX };
    let deeper = height * random.of_any_size(0.05, 0.8);
    let again = one_in(random, 2.0);
    let mut end = None;
    for k in 1.. {
        v *= e;
        flights.push((t, v, floor));
        if k == after {
            if !again {
                end = Some(t + (v + (v * v + 2.0 * GRAVITY * deeper).sqrt()) / GRAVITY);
                break;
            }
            let fast = (v * v + 2.0 * GRAVITY * deeper).sqrt();
            t += (v + fast) / GRAVITY;
            floor -= deeper;
            v = fast;
        } else {
            t += 2.0 * v / GRAVITY;
        }
        if v < 1e-9 * speed || flights.len() > 400 {
            break;
        }
    }
    let rest = t;
    // with two or three impacts at least, and up to where it lies
    let least = random.between(2.0, 4.0) as usize;
    let last = flights.get(least).map_or(rest, |flight| flight.0);
    let long = last + random.of_any_size(0.3, 1.2) * (rest - last).max(0.5 * fall);
    let end = end.unwrap_or(long).min(long);
    let times: Vec<f64> = (0..).map(|i| f64::from(i) * step).take_while(|t| *t < end).collect();
    let at = |t: &f64| {
        let (begin, v, from) = flights[flights.partition_point(|flight| flight.0 <= *t).max(1) - 1];
        let since = t - begin;
        let x = from + since * (v - 0.5 * GRAVITY * since);
        let floor = if end > rest { floor } else { f64::NEG_INFINITY };
        place + if *t >= rest { floor } else { x }
    };
    let x = times.iter().map(at).collect();
    let about = format!(
        "bounced {seed}: e {e:.3}, {samples:.0} samples a rebound, {} in all{}",
        times.len(),
        if after < 99 { ", a floor that ends" } else { "" }
    );
    let mut record = Spoiled { times, x, base: None, restitution: [e; 2], drift: None, about };
    spoil(random, &mut record, speed, height);
    record
}

/// A mass on a spring between stops, or before one, that is shaken by one sine or by many and has impacts;
/// the acceleration of the base is recorded.
pub fn shaken(seed: u64) -> Spoiled {
    let random = &mut Noise::new(seed);
    loop {
        if let Some(record) = shaken_by(random, seed) {
            return record;
        }
    }
}

fn shaken_by(random: &mut Noise, seed: u64) -> Option<Spoiled> {
    let left = random.between(0.2, 0.95);
    let right = if one_in(random, 2.5) { random.between(0.2, 0.95) } else { left };
    let natural = TAU * random.between(0.5, 3.0);
    let lines = if one_in(random, 3.0) { 1 } else { random.between(2.0, 20.0) as usize };
    let fastest = random.of_any_size(2.0, 20.0);
    let sines: Vec<[f64; 3]> = (0..lines)
        .map(|_| {
            [TAU * random.between(0.3 * fastest, fastest), random.between(0.3, 1.0), random.between(0.0, TAU)]
        })
        .collect();
    let size = random.of_any_size(2.0, 100.0) / (lines as f64).sqrt();
    let shake = |t: f64| sines.iter().map(|[w, a, phase]| size * a * (w * t + phase).sin()).sum::<f64>();
    // the way of the shaking alone
    let way = size * (lines as f64).sqrt() / (TAU * fastest).powi(2);
    let near = way * random.of_any_size(0.3, 3.0);
    let stops = match random.between(0.0, 4.0) as usize {
        0 => [-near, f64::INFINITY],
        1 => [-near, near],
        2 => [f64::NEG_INFINITY, near],
        _ => [-near, near * random.between(0.5, 2.0)],
    };
    let step = 1.0 / (fastest * random.of_any_size(15.0, 150.0));
    let count = (random.between(10.0, 60.0) / fastest / step) as usize;
    let damping = natural * random.between(0.0, 0.1);
    let pull = |x: f64, v: f64, t: f64| -shake(t) - natural * natural * x - 2.0 * damping * v;
    let advance = |(x, v): (f64, f64), t: f64, h: f64| {
        let slope = |x: f64, v: f64, t: f64| (v, pull(x, v, t));
        let a = slope(x, v, t);
        let b = slope(x + 0.5 * h * a.0, v + 0.5 * h * a.1, t + 0.5 * h);
        let c = slope(x + 0.5 * h * b.0, v + 0.5 * h * b.1, t + 0.5 * h);
        let d = slope(x + h * c.0, v + h * c.1, t + h);
        (x + h / 6.0 * (a.0 + 2.0 * (b.0 + c.0) + d.0), v + h / 6.0 * (a.1 + 2.0 * (b.1 + c.1) + d.1))
    };
    let (mut state, mut t, mut rests, mut impacts) = ((0.0, 0.0), 0.0, None, 0);
    let mut fastest_impact: f64 = 0.0;
    let h = step / PARTS as f64;
    let (mut times, mut xs, mut base) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..count * PARTS {
        if i % PARTS == 0 {
            times.push(i as f64 * h);
            xs.push(state.0);
            base.push(shake(t));
        }
        let mut left_over = h;
        while left_over > 0.0 {
            if let Some(side) = rests {
                let outward: f64 = if side == 0 { -1.0 } else { 1.0 };
                if outward * pull(state.0, 0.0, t) >= 0.0 {
                    (t, left_over) = (t + left_over, 0.0);
                    continue;
                }
                rests = None;
            }
            let next = advance(state, t, left_over);
            let beyond = |x: f64| {
                if x < stops[0] {
                    Some(0)
                } else if x > stops[1] {
                    Some(1)
                } else {
                    None
                }
            };
            let Some(side) = beyond(next.0) else {
                (state, t, left_over) = (next, t + left_over, 0.0);
                continue;
            };
            let (mut low, mut high) = (0.0, left_over);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                if beyond(advance(state, t, middle).0).is_some() { high = middle } else { low = middle }
            }
            let (_, v) = advance(state, t, low);
            impacts += 1;
            fastest_impact = fastest_impact.max(v.abs());
            let out = -[left, right][side] * v;
            if out.abs() < 1e-6 * fastest_impact {
                rests = Some(side);
            }
            state = (stops[side], if rests.is_some() { 0.0 } else { out });
            t += low;
            left_over -= low.max(1e-6 * h);
        }
        t = (i + 1) as f64 * h;
    }
    if impacts == 0 {
        return None;
    }
    let (low, high) = xs.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (x.min(a), x.max(b)));
    let about = format!(
        "shaken {seed}: e {left:.3} {right:.3}, stops {stops:?}, {lines} lines up to {fastest:.1} Hz, {:.0} \
         samples a period, {count} samples, {impacts} impacts",
        1.0 / (fastest * step)
    );
    let mut record =
        Spoiled { times, x: xs, base: Some(base), restitution: [left, right], drift: None, about };
    spoil(random, &mut record, fastest_impact, 0.5 * (high - low));
    Some(record)
}

/// A free decay of an oscillator in the picture of a camera: its damping ratio and the frequency of its
/// swings.
pub fn swung(seed: u64) -> (Spoiled, [f64; 2]) {
    let random = &mut Noise::new(seed);
    let (samples, cycles) = (random.of_any_size(24.0, 500.0), random.between(5.0, 50.0));
    let (ratio, phase) = (random.of_any_size(1.5e-3, 0.1), random.between(0.0, TAU));
    let hertz = random.of_any_size(1.0, 50.0);
    let rate = TAU * hertz * ratio / (1.0 - ratio * ratio).sqrt();
    let size = random.of_any_size(1e-3, 0.1);
    let times: Vec<f64> = (0..(samples * cycles) as u32).map(|i| f64::from(i) / (samples * hertz)).collect();
    let x = times.iter().map(|t| size * (-rate * t).exp() * (TAU * hertz * t + phase).cos()).collect();
    let about = format!("swung {seed}: ratio {ratio:.4}, {samples:.0} samples a swing, {cycles:.0} swings");
    let mut record = Spoiled { times, x, base: None, restitution: [0.0; 2], drift: None, about };
    // a picture that drifts by a swing over the record moves as fast as this part of the speed
    spoil(random, &mut record, size / cycles * hertz, size);
    (record, [ratio, hertz])
}

/// Holds the restitutions of so many records against the truth, and their drifts.
fn hold(draw: fn(u64) -> Spoiled, records: u64, least: f64, what: &str) {
    let (mut answered, mut numbers, mut held, mut drifts, mut drifts_held) = (0, 0, 0, 0, 0);
    for seed in 0..records {
        let record = draw(seed);
        let Ok(found) = restitution(&record.times, &record.x, record.base.as_deref()) else { continue };
        answered += 1;
        let is_still = found.remarks.iter().any(|remark| remark.contains("taken as at rest"));
        assert_eq!(is_still, found.summary.iter().all(|number| number.name != "stop_drift_m_per_s"));
        // a drift that nothing tells is no part of the interval
        if is_still {
            continue;
        }
        let sides = found.rows.words("side");
        let one = sides.iter().all(|side| *side == sides[0]);
        let of_first = record.restitution[usize::from(sides[0] == "right")];
        for identity in &found.summary {
            let exact = match identity.name {
                "restitution_left" => record.restitution[0],
                "restitution_right" => record.restitution[1],
                "restitution" if one || record.restitution[0] == record.restitution[1] => of_first,
                _ => continue,
            };
            numbers += 1;
            held += usize::from(holds(*identity, exact));
            if !holds(*identity, exact) {
                println!("{exact}: {}; {}", identity.describe(), record.about);
            }
        }
        if let Some(drift) = record.drift {
            drifts += 1;
            drifts_held += usize::from(holds(number(&found, "stop_drift_m_per_s"), drift));
        }
    }
    println!("{answered} of {records} records have an answer");
    assert!(answered as f64 > least * records as f64, "{answered} of {records} records have an answer");
    hold_95_of_100(held, numbers, &format!("the restitution of {what}"));
    let share = drifts_held as f64 / drifts as f64;
    assert!(
        share > 0.95 - 4.0 * (0.0475 / drifts as f64).sqrt(),
        "{drifts_held} of {drifts} drifts of {what}"
    );
}

#[test]
fn the_intervals_of_pictures_of_bounces_hold_the_restitution() {
    hold(bounced, multiplied(100).into(), 0.85, "pictures of bounces");
}

#[test]
fn the_intervals_of_shaken_records_with_their_base_hold_the_restitution() {
    hold(shaken, multiplied(60).into(), 0.85, "shaken records with their base");
}

#[test]
fn the_intervals_of_spoiled_decays_hold_the_damping_ratio() {
    let (records, mut answered, mut held) = (u64::from(multiplied(100)), 0, 0);
    for seed in 0..records {
        let (record, [ratio, _]) = swung(seed);
        let channel = Channel { quantity: Quantity::Displacement, column: "x_m".into(), values: record.x };
        let Ok(found) = damping(&record.times, &channel) else { continue };
        answered += 1;
        held += usize::from(holds(number(&found, "damping_ratio"), ratio));
    }
    assert!(answered as f64 > 0.75 * records as f64, "{answered} of {records} decays have an answer");
    // a drift makes the turning points scatter, and the intervals a little wide
    let (share, least) = (held as f64 / answered as f64, 0.95 - 4.0 * (0.0475 / answered as f64).sqrt());
    assert!(share > least, "{held} of {answered} intervals of the damping ratio of spoiled decays hold");
}
