//! Turning points of values in a row.

/// A turning point: a sample from which the values go back by more than noise does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Turn {
    /// Which sample.
    pub at: usize,
    /// Whether it is a maximum.
    pub maximum: bool,
}

/// The turning points of `values`, maxima and minima in turn: where they go back by more than `back`. The
/// first is where they begin.
pub fn turns(values: &[f64], back: f64) -> Vec<Turn> {
    let mut turns = Vec::new();
    let (mut least, mut greatest) = (0, 0);
    // whether the values rise, once that is known
    let mut rising: Option<bool> = None;
    for (i, value) in values.iter().enumerate() {
        if *value > values[greatest] {
            greatest = i;
        }
        if *value < values[least] {
            least = i;
        }
        if rising != Some(false) && values[greatest] - value > back {
            turns.push(Turn { at: greatest, maximum: true });
            (rising, least) = (Some(false), i);
        } else if rising != Some(true) && value - values[least] > back {
            turns.push(Turn { at: least, maximum: false });
            (rising, greatest) = (Some(true), i);
        }
    }
    turns
}
