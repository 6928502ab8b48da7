//! Numbers as they were written: arithmetic that a scene keeps when it is saved.

use std::collections::HashMap;

use super::arithmetic::evaluate;
use super::scanner::Scanner;

/// The arithmetic of a scene by the paths of its fields, with the value of each.
#[derive(Debug, Clone, Default)]
pub(super) struct Written(HashMap<String, (String, f64)>);

impl Written {
    /// Replaces the arithmetic of a field and of those inside it by that in `text`, the RON value of the
    /// field. An empty path stands for the whole scene.
    pub fn update(&mut self, field: &str, text: &str) {
        if !self.0.is_empty() {
            self.0.retain(|path, _| !covers(field, path));
        }
        let scanned = Scanner::over(text);
        for number in scanned.numbers.iter().filter(|number| number.is_arithmetic) {
            let written = &text[number.bytes.clone()];
            if let Ok(value) = evaluate(written) {
                self.0.insert(joined(field, scanned.path(number)), (written.to_owned(), value));
            }
        }
    }

    /// The RON value `text` of a field in which each number that has its value still is written as it was.
    pub fn restored(&self, field: &str, text: String) -> String {
        if self.0.is_empty() {
            return text;
        }
        let scanned = Scanner::over(&text);
        let (mut restored, mut from) = (String::new(), 0);
        for number in &scanned.numbers {
            let path = joined(field, scanned.path(number));
            if let Some((written, value)) = self.0.get(&path)
                && is_value(&text[number.bytes.clone()], *value)
            {
                restored.push_str(&text[from..number.bytes.start]);
                restored.push_str(written);
                from = number.bytes.end;
            }
        }
        restored + &text[from..]
    }

    /// The value of a field as it was written and as a number, if it is arithmetic with this value.
    pub fn shown(&self, field: &str, value: &str) -> Option<String> {
        let (written, number) = self.0.get(field)?;
        is_value(value, *number).then(|| format!("{written} = {value}"))
    }
}

/// Whether a path is that of a field or of one inside it; all are inside the empty path.
pub(super) fn covers(outer: &str, inner: &str) -> bool {
    let rest = inner.strip_prefix(outer);
    outer.is_empty() || rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

fn joined(outer: &str, inner: String) -> String {
    match (outer, inner.as_str()) {
        ("", _) => inner,
        (_, "") => outer.to_owned(),
        _ => format!("{outer}.{inner}"),
    }
}

fn is_value(text: &str, value: f64) -> bool {
    text.parse::<f64>().is_ok_and(|read| read.to_bits() == value.to_bits())
}
