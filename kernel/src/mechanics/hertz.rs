//! Impact of a mass on a compliant stop, without other forces.
//!
//! A Hertzian point contact with the loss of Hunt and Crossley (1975, "Coefficient of restitution interpreted
//! as damping in vibroimpact", eq. 9): the stop pushes back with k d^1.5 (1 + a d'), where d is the depth of
//! the contact, and never pulls. This module has the closed forms of one contact without other forces;
//! [`dynamics`](crate::dynamics) integrates a contact with other forces.
//!
//! During the contact the speed is a function of the depth. With z = a d', the kinetic side of
//! m d'' = -k d^1.5 (1 + z) integrates to gamma(z) = z - ln(1 + z), and
//!
//! ```text
//! gamma(a v) - gamma(z) = a^2 (2 k / (5 m)) d^2.5
//! ```
//!
//! With gamma(z) = gamma(a v) cos^2(angle), z has the sign of the cosine and is analytic in it, so that the
//! angle from 0 (touch) over pi/2 (largest depth) to pi (separation) parametrises the whole contact without a
//! singular speed.

use std::f64::consts::PI;

use crate::numeric::{bisect, elementary, even_half};
use crate::scene::Stops;

/// Default of Poisson's ratio: that of aluminium, as for flexures.
const POISSON: f64 = 0.34;

/// Default of the yield strength in Pa: that of the common wrought alloy 6061-T6.
const YIELD: f64 = 0.276e9;

/// Pressure at the centre of a point contact at which it begins to yield (below its surface), relative to the
/// yield strength in tension (Johnson 1985, "Contact Mechanics", section 6.1, for a Poisson's ratio of 0.3).
const PRESSURE_OVER_YIELD: f64 = 1.6;

/// Half the number of points of the rule for the contact time. Its integrand is analytic in the fifth root of
/// the angle, and this many points integrate it to rounding.
const TIME_POINTS: usize = 40;

/// Golden-section steps of the search for the largest force. The force is flat there, so that half the digits
/// of its position give all digits of its value.
const PEAK_STEPS: usize = 60;

/// A compliant stop, in SI units: at the depth d it pushes back with k d^1.5 (1 + a d') and never pulls
/// (Hertz 1882; Hunt and Crossley 1975). The methods are closed forms or quadratures for one impact without
/// other forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hertz {
    /// Stiffness k in N/m^1.5.
    pub stiffness: f64,
    /// Loss a in s/m.
    pub loss: f64,
    /// Material of the contact, if known.
    pub material: Option<ContactMaterial>,
}

/// Two equal cylinders of one material, crossed at a right angle, in SI units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactMaterial {
    /// Radius in m; the contact is that of a ball of this radius on a plane.
    pub radius: f64,
    /// Contact modulus in Pa: 1/E* = 2 (1 - nu^2)/E.
    pub modulus: f64,
    /// Yield strength in tension in Pa.
    pub yield_strength: f64,
}

impl Hertz {
    /// The compliant stop of a scene that has passed its check; `None` if its stops are rigid or absent.
    pub fn of(stops: &Stops) -> Option<Self> {
        let Stops::Hertz {
            stiffness_n_per_m1_5, loss_s_per_m, radius_mm, young_gpa, poisson, yield_gpa, ..
        } = *stops
        else {
            return None;
        };
        let material = radius_mm.zip(young_gpa).map(|(radius, young)| {
            let poisson = poisson.unwrap_or(POISSON);
            ContactMaterial {
                radius: radius / 1e3,
                modulus: young * 1e9 / (2.0 * (1.0 - poisson * poisson)),
                yield_strength: yield_gpa.map_or(YIELD, |gpa| gpa * 1e9),
            }
        });
        let stiffness = stiffness_n_per_m1_5.or(material.as_ref().map(ContactMaterial::stiffness))?;
        Some(Self { stiffness, loss: loss_s_per_m, material })
    }

    /// Rebound speed over impact speed at `speed` in m/s, 0 or above; without other forces.
    ///
    /// The root e of ln((1 + a v)/(1 - a v e)) = a v (1 + e), to a few units of rounding. It depends on a v
    /// alone, is 1 - (2/3) a v for slow impacts and falls to 1/(a v) for fast ones.
    pub fn restitution(&self, speed: f64) -> f64 {
        let impact = self.loss * speed;
        if impact > 0.0 { -inverse(-(2.0 * gamma(impact)).sqrt()) / impact } else { 1.0 }
    }

    /// Loss times impact speed at a given [`restitution`](Self::restitution), which depends on that product
    /// alone. It is 0 at a restitution of 1; `None` at 0 and outside 0 to 1.
    ///
    /// Method: bisection of its logarithm, to a few units of rounding; the restitution falls monotonically.
    pub fn loss_times_speed(restitution: f64) -> Option<f64> {
        if restitution == 1.0 {
            return Some(0.0);
        } else if !(restitution > 0.0 && restitution < 1.0) {
            return None;
        }
        // The restitution lies between 1 - (2/3) a v and 1/(a v).
        let (low, high) = (elementary::ln(0.5 * (1.0 - restitution)), -elementary::ln(restitution));
        let at = |impact: f64| Self { stiffness: 1.0, loss: impact, material: None }.restitution(1.0);
        let (low, high) = bisect(low, high, 80, |logarithm| at(elementary::exp(logarithm)) > restitution);
        Some(elementary::exp(0.5 * (low + high)))
    }

    /// Largest depth in m of the impact of `mass` in kg at `speed` in m/s; without other forces.
    pub fn depth(&self, mass: f64, speed: f64) -> f64 {
        elementary::powf(2.5 * mass * self.energy_speed(speed).powi(2) / (2.0 * self.stiffness), 0.4)
    }

    /// Duration in s of the impact of `mass` in kg at `speed` in m/s, above 0; without other forces.
    ///
    /// Without loss it is (4/5) B(2/5, 1/2) d/v = 2.943 d/v, where d is the largest depth; with loss it is
    /// integrated by Gauss' rule over the angle, to about 1e-13.
    pub fn contact_time(&self, mass: f64, speed: f64) -> f64 {
        let scale = self.energy_speed(speed);
        let q_max = self.loss * scale; // sqrt(2 gamma(a v))
        let mut integral = 0.0;
        for (node, weight) in even_half(TIME_POINTS) {
            for node in [0.5 - 0.5 * node, 0.5 + 0.5 * node] {
                // angle^(-1/5) is integrated as a polynomial in the fifth root of the angle
                let angle = 0.5 * PI * node.powi(5);
                let (sine, cosine) = elementary::sin_cos(angle);
                let measure = 0.5 * PI * 5.0 * node.powi(4) * 0.5 * weight * elementary::powf(sine, -0.2);
                let q = q_max * cosine;
                integral += measure * (1.0 / z_over_q(q) + 1.0 / z_over_q(-q));
            }
        }
        0.8 * self.depth(mass, speed) / scale * integral
    }

    /// Largest force in N of the impact of `mass` in kg at `speed` in m/s; without other forces.
    pub fn peak_force(&self, mass: f64, speed: f64) -> f64 {
        let q_max = self.loss * self.energy_speed(speed);
        let deepest = self.stiffness * elementary::powf(self.depth(mass, speed), 1.5);
        let force = |angle: f64| {
            let (sine, cosine) = elementary::sin_cos(angle);
            let q = q_max * cosine;
            deepest * elementary::powf(sine, 1.2) * (1.0 + q * z_over_q(q))
        };
        // Golden section: the force has one maximum while the depth increases.
        let ratio = 0.5 * (5.0_f64.sqrt() - 1.0);
        let (mut low, mut high) = (0.0, 0.5 * PI);
        for _ in 0..PEAK_STEPS {
            let inner = (high - ratio * (high - low), low + ratio * (high - low));
            if force(inner.0) < force(inner.1) {
                low = inner.0;
            } else {
                high = inner.1;
            }
        }
        force(0.5 * (low + high))
    }

    /// Pressure in Pa at the centre of the contact under `force` in N; `None` if the material is not known.
    pub fn pressure(&self, force: f64) -> Option<f64> {
        self.material.map(|material| material.pressure(force))
    }

    /// Depth in m of the contact under a static `force` in N, 0 or above.
    pub fn static_depth(&self, force: f64) -> f64 {
        elementary::powf(force / self.stiffness, 2.0 / 3.0)
    }

    /// Elastic energy in J stored in the contact at `depth` in m.
    pub fn energy(&self, depth: f64) -> f64 {
        0.4 * self.stiffness * depth * depth * depth.sqrt()
    }

    /// The impact speed that reaches the same depth without loss: sqrt(2 gamma(a v))/a.
    fn energy_speed(&self, speed: f64) -> f64 {
        let impact = self.loss * speed;
        if impact > 0.0 { (2.0 * gamma(impact)).sqrt() / self.loss } else { speed }
    }
}

impl ContactMaterial {
    /// k = (4/3) E* sqrt(R) in N/m^1.5 (Johnson 1985, eq. 4.23).
    pub fn stiffness(&self) -> f64 {
        4.0 / 3.0 * self.modulus * self.radius.sqrt()
    }

    /// Pressure in Pa at the centre under `force` in N: (6 F E*^2/(pi^3 R^2))^(1/3) (Johnson 1985, eq. 4.24).
    pub fn pressure(&self, force: f64) -> f64 {
        elementary::cbrt(6.0 * force / (PI * self.radius * self.radius))
            * elementary::powf(self.modulus / PI, 2.0 / 3.0)
    }

    /// The pressure in Pa at which the material begins to yield.
    pub fn yield_pressure(&self) -> f64 {
        PRESSURE_OVER_YIELD * self.yield_strength
    }
}

/// z - ln(1 + z) for z above -1; by its series near 0, where the difference would cancel.
fn gamma(z: f64) -> f64 {
    if z.abs() > 0.1 {
        return z - elementary::ln_1p(z);
    }
    let (mut power, mut sum) = (z, 0.0);
    for k in 2..20 {
        power *= -z;
        sum -= power / f64::from(k);
    }
    sum
}

/// z/q, where gamma(z) = q^2/2 and z has the sign of q.
fn z_over_q(q: f64) -> f64 {
    if q.abs() < 1e-3 {
        // z = q + q^2/3 + q^3/36 - q^4/270 + ..
        return 1.0 + q * (1.0 / 3.0 + q * (1.0 / 36.0 - q * (1.0 / 270.0 - q / 4320.0)));
    }
    inverse(q) / q
}

/// The z with the sign of `q` and gamma(z) = q^2/2. With z = e^y - 1 this is e^y - 1 - y = q^2/2, which is
/// convex in y, so that Newton's method converges monotonically from the outer side.
fn inverse(q: f64) -> f64 {
    let value = 0.5 * q * q;
    let mut y = if q > 0.0 { q.min(elementary::ln(1.0 + 2.0 * value) + 1.0) } else { -(value - q) };
    for _ in 0..100 {
        let slope = elementary::exp_m1(y);
        let excess = exp_minus_tangent(y) - value;
        if slope == 0.0 || !(excess > 0.0) {
            break;
        }
        let next = y - excess / slope;
        if next == y {
            break;
        }
        y = next;
    }
    elementary::exp_m1(y)
}

/// e^y - 1 - y.
fn exp_minus_tangent(y: f64) -> f64 {
    if y.abs() > 0.1 {
        return elementary::exp_m1(y) - y;
    }
    let (mut term, mut sum) = (y, 0.0);
    for k in 2..14 {
        term *= y / f64::from(k);
        sum += term;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stop(loss: f64) -> Hertz {
        Hertz { stiffness: 3.68e9, loss, material: None }
    }

    #[test]
    fn restitution_solves_its_equation_and_has_its_limits() {
        for impact in [1e-9, 1e-6, 1e-3, 0.05, 0.3, 2.427, 30.0, 1e4] {
            let e = stop(1.0).restitution(impact);
            assert!((0.0..1.0).contains(&e), "{impact} {e}");
            // gamma on both sides, relative: the equation itself loses all digits at low speed
            let sides = (gamma(impact), gamma(-impact * e));
            if impact < 10.0 {
                assert!((sides.0 / sides.1 - 1.0).abs() < 1e-12, "{impact} {sides:?}");
            } else {
                // 1 + z = e^(z - gamma), and z has become -1
                assert!((1.0 - impact * e - (-1.0 - sides.0).exp()).abs() < 1e-14, "{impact} {e}");
            }
            assert!(impact > 1e-3 || ((1.0 - e) / (2.0 / 3.0 * impact) - 1.0).abs() < 2.0 * impact + 1e-6);
        }
        assert!((stop(2.427).restitution(1.0) - 0.36).abs() < 1e-4);
        assert!((stop(1.0).restitution(1e4) * 1e4 - 1.0).abs() < 1e-9);
        assert_eq!((stop(0.0).restitution(0.5), stop(3.0).restitution(0.0)), (1.0, 1.0));
    }

    #[test]
    fn the_loss_for_a_restitution_gives_that_restitution() {
        // ln((1 + a v)/(1 - a v e)) = a v (1 + e)
        assert!((Hertz::loss_times_speed(0.36).unwrap() / 2.426_877_191_846 - 1.0).abs() < 1e-11);
        for e in [1e-9, 1e-3, 0.1, 0.36, 0.7, 0.99, 1.0 - 1e-7] {
            let found = Hertz::loss_times_speed(e).unwrap();
            assert!((stop(1.0).restitution(found) / e - 1.0).abs() < 1e-12, "{e}: {found}");
        }
        assert_eq!(Hertz::loss_times_speed(1.0), Some(0.0));
        assert!([0.0, -0.1, 1.1, f64::NAN].into_iter().all(|e| Hertz::loss_times_speed(e).is_none()));
    }

    #[test]
    fn without_loss_the_contact_time_is_a_beta_function() {
        // (4/5) B(2/5, 1/2), from B(a, b) = gamma(a) gamma(b)/gamma(a + b)
        const FACTOR: f64 = 2.943_275_184_324_704_7;
        let (mass, speed) = (0.0152, 0.5);
        let stop = stop(0.0);
        let depth = (1.25 * mass * speed * speed / stop.stiffness).powf(0.4);
        assert!((stop.depth(mass, speed) / depth - 1.0).abs() < 1e-14);
        let time = stop.contact_time(mass, speed);
        assert!((time / (FACTOR * depth / speed) - 1.0).abs() < 1e-9, "{}", time * speed / depth);
        assert!((stop.peak_force(mass, speed) / (stop.stiffness * depth.powf(1.5)) - 1.0).abs() < 1e-12);
        // a little loss changes little: the two branches of the formulas meet
        let near = Hertz { loss: 1e-9, ..stop };
        assert!((near.contact_time(mass, speed) / time - 1.0).abs() < 1e-8);
    }

    #[test]
    fn crossed_cylinders_of_the_prototype() {
        let stops = Stops::Hertz {
            travel_limit_mm: 1.5,
            stiffness_n_per_m1_5: None,
            loss_s_per_m: 0.0,
            radius_mm: Some(5.0),
            young_gpa: Some(69.0),
            poisson: Some(0.34),
            yield_gpa: None,
        };
        let stop = Hertz::of(&stops).unwrap();
        let material = stop.material.unwrap();
        assert!((stop.stiffness / 3.678e9 - 1.0).abs() < 1e-3, "{}", stop.stiffness);
        let pressure = stop.pressure(stop.peak_force(0.0152, 0.5)).unwrap();
        assert!((pressure / 1.47e9 - 1.0).abs() < 5e-3, "{pressure}");
        // p0 = 3 F/(2 pi a^2) with a^2 = R d
        let depth = stop.depth(0.0152, 0.5);
        let other = 3.0 * stop.peak_force(0.0152, 0.5) / (2.0 * PI * material.radius * depth);
        assert!((pressure / other - 1.0).abs() < 1e-12);
        assert!(pressure > material.yield_pressure());
        let time = stop.contact_time(0.0152, 0.5);
        assert!(time > 0.9e-4 && time < 1.1e-4, "{time}");
    }
}
