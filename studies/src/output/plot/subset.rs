//! Subset of a TrueType font with the outlines of some glyphs, which keep their numbers.

/// The tables that a PDF needs (ISO 32000-1, 9.9), in the order of the file.
const TABLES: [&[u8; 4]; 6] = [b"glyf", b"head", b"hhea", b"hmtx", b"loca", b"maxp"];

/// Flags of a part of a composite glyph (OpenType 1.9, `glyf`).
const WORDS: u16 = 0x0001;
const SCALE: u16 = 0x0008;
const MORE: u16 = 0x0020;
const TWO_SCALES: u16 = 0x0040;
const MATRIX: u16 = 0x0080;

/// The font in `bytes` with only the outlines of `glyphs` and of their components.
pub fn subset(bytes: &[u8], glyphs: impl IntoIterator<Item = usize>) -> Vec<u8> {
    let table = |name: &[u8; 4]| {
        let found = (0..short(bytes, 4)).map(|i| 12 + 16 * i).find(|at| bytes.get(*at..at + 4) == Some(name));
        let (from, length) = found.map_or((0, 0), |at| (long(bytes, at + 8), long(bytes, at + 12)));
        bytes.get(from..from + length).unwrap_or_default()
    };
    let (head, loca, outlines) = (table(b"head"), table(b"loca"), table(b"glyf"));
    let is_long = short(head, 50) == 1;
    let place = |glyph: usize| if is_long { long(loca, 4 * glyph) } else { 2 * short(loca, 2 * glyph) };
    let outline = |glyph: usize| outlines.get(place(glyph)..place(glyph + 1)).unwrap_or_default();
    let count = short(table(b"maxp"), 4);
    let mut kept = vec![false; count];
    let mut open: Vec<usize> = glyphs.into_iter().chain([0]).collect();
    while let Some(glyph) = open.pop() {
        if kept.get(glyph) == Some(&false) {
            kept[glyph] = true;
            open.extend(parts(outline(glyph)));
        }
    }
    let (mut glyf, mut places) = (Vec::new(), Vec::new());
    let put = |places: &mut Vec<u8>, at: usize| match is_long {
        true => places.extend((at as u32).to_be_bytes()),
        false => places.extend(((at / 2) as u16).to_be_bytes()),
    };
    for (glyph, is_kept) in kept.iter().enumerate() {
        put(&mut places, glyf.len());
        if *is_kept {
            glyf.extend(outline(glyph));
            glyf.resize(glyf.len().next_multiple_of(4), 0);
        }
    }
    put(&mut places, glyf.len());
    let tables = TABLES.map(|name| match name {
        b"glyf" => glyf.as_slice(),
        b"loca" => places.as_slice(),
        name => table(name),
    });
    let count = TABLES.len() as u16;
    let power = count.ilog2() as u16;
    let mut file = vec![0, 1, 0, 0];
    let search = [count, 16 << power, power, 16 * count - (16 << power)];
    search.iter().for_each(|word| file.extend(word.to_be_bytes()));
    let mut at = 12 + 16 * TABLES.len();
    for (name, table) in TABLES.iter().zip(tables) {
        file.extend(*name);
        let byte = |word: &[u8], i: usize| u32::from(*word.get(i).unwrap_or(&0));
        let words = table.chunks(4).map(|word| (0..4).fold(0, |sum, i| sum << 8 | byte(word, i)));
        file.extend(words.fold(0, u32::wrapping_add).to_be_bytes());
        file.extend((at as u32).to_be_bytes());
        file.extend((table.len() as u32).to_be_bytes());
        at = (at + table.len()).next_multiple_of(4);
    }
    for table in tables {
        file.extend(table);
        file.resize(file.len().next_multiple_of(4), 0);
    }
    file
}

/// The glyphs that an outline is composed of.
fn parts(outline: &[u8]) -> Vec<usize> {
    let mut parts = Vec::new();
    // the number of contours is negative for a composite glyph
    if outline.len() < 10 || outline[0] < 0x80 {
        return parts;
    }
    let mut at = 10;
    while at + 4 <= outline.len() {
        let flags = short(outline, at) as u16;
        parts.push(short(outline, at + 2));
        let transform = match flags {
            flags if flags & SCALE != 0 => 2,
            flags if flags & TWO_SCALES != 0 => 4,
            flags if flags & MATRIX != 0 => 8,
            _ => 0,
        };
        at += 4 + if flags & WORDS != 0 { 4 } else { 2 } + transform;
        if flags & MORE == 0 {
            break;
        }
    }
    parts
}

/// A number of two bytes; 0 beyond the end.
fn short(bytes: &[u8], at: usize) -> usize {
    bytes.get(at..at + 2).map_or(0, |word| usize::from(word[0]) << 8 | usize::from(word[1]))
}

/// A number of four bytes; 0 beyond the end.
fn long(bytes: &[u8], at: usize) -> usize {
    short(bytes, at) << 16 | short(bytes, at + 2)
}
