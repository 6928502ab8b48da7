//! Prints tables of built-in scenes as CSV, to be compared with those of the page: `tables PRESET ..`, or
//! with `map` as the first argument the sweeps that the scenes name.

use interwell_studies as interwell;

#[path = "../web/src/tables.rs"]
mod tables;

fn main() {
    let mut arguments = std::env::args().skip(1).peekable();
    let is_map = arguments.next_if_eq("map").is_some();
    for preset in arguments {
        match if is_map { tables::map(&preset) } else { tables::tables(&preset) } {
            Ok(text) => print!("{text}"),
            Err(error) => eprintln!("{error}"),
        }
    }
}
