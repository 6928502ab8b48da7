//! Prints tables of built-in scenes as CSV, to be compared with those of the page: `tables PRESET ..`.

use interwell_studies as interwell;

#[path = "../src/tables.rs"]
mod tables;

fn main() {
    for preset in std::env::args().skip(1) {
        match tables::tables(&preset) {
            Ok(text) => print!("{text}"),
            Err(error) => eprintln!("{error}"),
        }
    }
}
