//! Names as a person writes them, looked up among the known names.

use super::unit::{Unit, unit_ending};

/// Smallest similarity, by Jaro and Winkler, of a name that may have been meant.
const SIMILAR: f64 = 0.87;

/// Earlier names, each with the present one.
const EARLIER: [(&str, &str); 1] = [("mean_power_w", "mean_load_power_w")];

/// The name among `known` that is written as `name`: the same, or the only one that is the same without the
/// unit at its end, as `rms_velocity` is short for `rms_velocity_m_per_s`, or the present one in place of an
/// earlier one. Otherwise a sentence that says
/// what `kind` of name is missing, which one may have been meant, and which there are.
///
/// ```
/// # use interwell_kernel as interwell;
/// use interwell::scene::find_name;
///
/// let known = ["x_m", "first_crossing_s", "first_crossing_g"];
/// assert_eq!(find_name("column", "x", &known), Ok("x_m"));
/// assert!(find_name("column", "first_crossing", &known).unwrap_err().contains("is short for"));
/// assert!(find_name("column", "first_crosing_s", &known).unwrap_err().contains("did you mean"));
/// ```
#[doc(hidden)]
pub fn find_name<'a>(kind: &str, name: &str, known: &[&'a str]) -> Result<&'a str, String> {
    let name = name.trim();
    if let Some(same) = known.iter().find(|known| **known == name) {
        return Ok(same);
    }
    let short: Vec<&str> = known.iter().copied().filter(|known| without_unit(known) == name).collect();
    let meant = match short[..] {
        [only] => return Ok(only),
        [] => {
            let is_earlier = |(earlier, _): &&(&str, &str)| *earlier == name || without_unit(earlier) == name;
            let present = EARLIER.iter().find(is_earlier).map(|(_, present)| *present);
            if let Some(present) = known.iter().find(|known| Some(**known) == present) {
                return Ok(present);
            }
            let without =
                || known.iter().copied().filter(|known| nearest(name, [without_unit(known)]).is_some());
            let near = nearest(name, known.iter().copied()).or_else(|| without().next());
            near.map(|near| format!("did you mean `{near}`?"))
        }
        _ => Some(format!("it is short for {}.", short.join(" and "))),
    };
    let list = known.join(", ");
    Err(match meant {
        Some(meant) => format!("no such {kind}; {meant} There are {list}"),
        None => format!("no such {kind}; there are {list}"),
    })
}

/// A name without the unit at its end: `x` of `x_mm`, `x (mm)`, `x [mm]` and `x, mm`.
fn without_unit(name: &str) -> &str {
    let of_record = || Unit::of_name(name).and_then(|_| name.rfind(['(', '[', ',']));
    match unit_ending(name) {
        Some((ending, _)) => name.strip_suffix(ending).unwrap_or(name),
        None => of_record().map_or(name, |end| name[..end].trim_end()),
    }
}

/// The known name that an unknown one is most similar to, as a whole or in its last part, if any is.
pub(super) fn nearest<'a>(unknown: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
    let wanted = last(unknown);
    let similarity = |name: &str| {
        let (whole, part) = (strsim::jaro_winkler(name, unknown), strsim::jaro_winkler(&last(name), &wanted));
        // the last part weighs less, so that the nearest of several names with the same last part is taken
        whole.max(0.9 * part + 0.1 * whole)
    };
    let rated = known.into_iter().map(|name| (similarity(name), name));
    let best = rated.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|best| best.0 >= SIMILAR);
    best.map(|(_, name)| name)
}
