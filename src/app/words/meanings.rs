//! Explanations of terms, for the labels that use them.

use std::ops::Range;

/// Terms in lower case, and their meanings.
const MEANINGS: &[(&str, &str)] = &[
    (
        "barrier",
        "The top of the potential between the two wells, where the mass could just stand. Its height is an \
         energy: what the mass needs to get from the bottom of a well to the other side.",
    ),
    (
        "restitution",
        "The share of its speed that the mass keeps when it rebounds from a stop. At 1 an impact takes no \
         energy, at 0 the mass stays on the stop.",
    ),
    (
        "basin",
        "All starts from which the mass ends in the same steady motion. Where basins are finely mixed, a \
         start next to another may end elsewhere.",
    ),
    (
        "period",
        "The time that the shaking takes to repeat: at 3 Hz a third of a second. A motion of period two \
         repeats after two of these.",
    ),
    (
        "bulge",
        "How far the buckled flexure bows sideways between its two ends. It is largest with the mass in \
         the middle and shrinks towards the wells.",
    ),
    (
        "taut",
        "The buckled flexure is pulled straight: it has no bow left to give, and the force rises steeply \
         from here on.",
    ),
    (
        "push",
        "The force that the mass feels because the base accelerates, as in a bus that brakes, in multiples \
         of its weight; or, in N, the force that acts on the mass while the base stands still.",
    ),
    (
        "reach",
        "The largest distance from the middle that the mass gets to once its motion has settled, to \
         either side.",
    ),
    (
        "crosses from",
        "The least shaking at this frequency whose settled motion, begun at rest, crosses the barrier \
         between these stops, or without any. Stops near the middle lower it; stops further out, up to the \
         wells, can raise it above that without stops, since every impact takes energy.",
    ),
    (
        "release",
        "For a moment the push exceeds the force with which the mechanism presses the mass on its stop: \
         the mass leaves the stop. That is not yet a crossing.",
    ),
    ("impact", "The mass strikes a stop and rebounds; the energy that it loses goes into the stop."),
    ("crossing", "The mass passes the top of the barrier between the two wells, in either direction."),
    (
        "intrawell",
        "It stays on its side: the push never carries it over the barrier. It swings within one well, \
         or hops on the stop there.",
    ),
    (
        "interwell",
        "It crosses from well to well, again and again. Its crossings repeat after one or a few periods \
         of the shaking.",
    ),
    (
        "irregular",
        "It crosses, and its crossings did not repeat while it was watched: chaos, or a motion that had \
         not settled yet.",
    ),
    (
        "attractor",
        "A motion that others settle on: at rest, repeating, or irregular for good. All starts that lead to \
         it are its basin.",
    ),
    (
        "flexure",
        "A thin strip of metal or plastic that guides the mass by bending, without a joint. Pushed together \
         end to end it buckles, and the mass has two places to rest.",
    ),
    ("travel limit", "How far the mass can move from the middle before it strikes a stop."),
    ("hopping", "It leaves its stop and falls back on the same one, without crossing."),
    (
        "rms velocity",
        "The root of the mean square of the velocity relative to the base, over the second half of the run \
         or the settled window that the scene sets. The mean power that damping takes grows with its square.",
    ),
    (
        "settling",
        "After a change the motion needs some periods until it repeats; what the window says is about the \
         time after that.",
    ),
    (
        "chaotic",
        "Two motions that begin almost alike part quickly, so that rounding errors grow too: a single \
         path is right only up to some time, while averages hold for longer.",
    ),
    (
        "path reliable",
        "Small errors of the path grow: after this time the true path may be another one, while averages \
         hold for longer.",
    ),
    (
        "separatrix",
        "The states with just the energy to stand on top of the barrier: inside either loop the mass stays \
         in its well, outside it crosses, as long as nothing shakes it.",
    ),
    ("turned up", "From the least value to the greatest, each run from the end of the one before."),
    ("turned down", "From the greatest value to the least, each run from the end of the one before."),
    ("hysteresis", "The motion on the way down differs from that on the way up: it depends on its history."),
    ("once a period", "The state once a forcing period, always at the same phase of the shaking."),
    ("at rest on a stop", "The mechanism presses the mass on its stop, harder than the push pulls."),
    ("impacts", "The mass strikes a stop and rebounds; the energy that it loses goes into the stop."),
    ("stops", "Where the stops stand: the travel limit on either side."),
    ("with the push", "The mechanism's potential, tipped by the push: the mass moves as a ball on it."),
    (
        "potential",
        "The energy that the mechanism stores with the mass at a place. Its slope is the force on the mass; \
         it has a well at every place where the mass can rest.",
    ),
    (
        "preload",
        "How far the flexures were pushed together, end to end, when the device was built. It buckles them: \
         the more of it, the higher the barrier.",
    ),
    (
        "phase portrait",
        "The velocity over the displacement, a point for every instant. A motion that repeats is a closed \
         loop.",
    ),
    (
        "path error",
        "The largest distance of the computed path from the exact one, as estimated from its sensitivity \
         to rounding.",
    ),
    (
        "energy of the mass",
        "Its potential and kinetic energy: it can cross while their sum is above the barrier.",
    ),
    ("without the push", "The potential of the mechanism without any push."),
    (
        "holds the mass there",
        "The force that would hold the mass at each place, positive to the right. The mechanism pulls \
         as hard in the opposite direction.",
    ),
];

/// The meaning of a label by the term at its beginning; what follows, such as a number, is ignored.
pub fn meaning(label: &str) -> Option<&'static str> {
    let label = label.to_lowercase();
    let begins = |word: &str| {
        label.strip_prefix(word).is_some_and(|rest| !rest.starts_with(|c: char| c.is_alphanumeric()))
    };
    MEANINGS.iter().find(|(word, _)| begins(word)).map(|term| term.1)
}

/// The terms of the glossary in alphabetical order; each has a meaning.
#[rustfmt::skip]
pub const GLOSSARY: [&str; 26] = [
    "attractor", "barrier", "basin", "bulge", "chaotic", "flexure", "hopping", "hysteresis", "impact",
    "interwell", "intrawell", "irregular", "once a period", "path error", "period", "phase portrait",
    "potential", "preload", "push", "reach", "release", "restitution", "RMS velocity", "separatrix",
    "settling", "travel limit",
];

/// The terms that are underlined in a text; those with a second meaning are left out.
#[rustfmt::skip]
pub const UNDERLINED: [&str; 14] = [
    "barrier", "basin", "chaotic", "hysteresis", "interwell", "intrawell", "period", "phase portrait",
    "potential", "preload", "release", "restitution", "RMS velocity", "separatrix",
];

/// The byte ranges of glossary terms in a text, each with its term.
pub fn terms(text: &str) -> Vec<(Range<usize>, &'static str)> {
    // the ranges hold in `text` too: only ASCII letters change
    let small = text.to_ascii_lowercase();
    let is_letter = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    let mut found = Vec::new();
    for word in UNDERLINED {
        for (at, matched) in small.match_indices(&word.to_ascii_lowercase()) {
            let mut end = at + matched.len();
            end += usize::from(small[end..].starts_with('s'));
            let before = small[..at].chars().next_back();
            if !is_letter(before) && !is_letter(small[end..].chars().next()) {
                found.push((at..end, word));
            }
        }
    }
    found.sort_by_key(|term| term.0.start);
    found
}

/// The response of a label, with the meaning of the label as hover text.
pub fn explained(response: eframe::egui::Response, label: &str) -> eframe::egui::Response {
    match meaning(label) {
        Some(text) => response.on_hover_text(text),
        None => response,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_known_by_their_first_words() {
        let all = [
            "bulge 5.2 mm",
            "taut: no bulge left",
            "reach",
            "crosses from",
            "Release",
            "Intrawell: stays in the right-hand well",
            "interwell",
            "RMS velocity",
            "settling: 0.6 s to go",
            "separatrix",
            "Path reliable up to 4.0 s",
        ];
        for label in all {
            let text = meaning(label).unwrap_or_else(|| panic!("{label}"));
            assert!(text.ends_with('.') && text.matches(". ").count() <= 1, "{text}");
        }
        for word in GLOSSARY {
            let text = meaning(word).unwrap_or_else(|| panic!("{word}"));
            assert!(text.ends_with('.') && text.matches(". ").count() <= 1, "{text}");
        }
        assert_eq!((meaning("basement"), meaning("")), (None, None));
    }

    #[test]
    fn words_of_the_glossary_are_found_in_a_text() {
        let text = "Its RMS velocity falls: two basins, one Barrier, periodic, a release.";
        let found: Vec<(&str, &str)> = terms(text).into_iter().map(|(at, word)| (&text[at], word)).collect();
        let expected = [("RMS velocity", "RMS velocity"), ("basins", "basin"), ("Barrier", "barrier")];
        assert_eq!(found, [expected.as_slice(), &[("release", "release")]].concat());
    }
}
