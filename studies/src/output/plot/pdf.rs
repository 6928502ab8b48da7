//! Painting of a list of shapes as PDF: paths, and text as text with the letters used embedded.
//!
//! The file has no date and no random identifier, so that equal pictures have equal bytes.

use std::collections::BTreeMap;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineCapStyle, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect, Ref, Str, TextStr};
use skrifa::GlyphId;
use xmp_writer::XmpWriter;

use super::figure::{Area, Figure, Point, Shape, Text, oriented};
use super::font::{FontFace, UNITS};
use super::style::Ink;
use super::subset::subset;

/// Points of PDF in a mm, and in a pixel of a screen.
const A_MM: f64 = 72.0 / 25.4;
const A_PIXEL: f64 = 72.0 / 96.0;

const CATALOG: Ref = Ref::new(1);
const PAGES: Ref = Ref::new(2);
const PAGE: Ref = Ref::new(3);
const CONTENT: Ref = Ref::new(4);
const INFO: Ref = Ref::new(5);
const METADATA: Ref = Ref::new(6);
/// The first object of the regular font; the heavier one has the next [`FONT_OBJECTS`].
const FONTS: i32 = 7;
const FONT_OBJECTS: i32 = 5;

/// Names of the two fonts in the content of the page.
const FONT_NAMES: [Name<'static>; 2] = [Name(b"R"), Name(b"B")];

/// How glyphs are numbered: as in the font's file.
const IDENTITY: SystemInfo<'static> =
    SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

pub fn pdf(figure: &Figure) -> Vec<u8> {
    let Area { left, top, right, bottom } = figure.shown;
    let (wide, high) = (right - left, bottom - top);
    let (width, height) = match (figure.size_mm(), figure.size) {
        (Some((width, height)), _) => (width * A_MM, height * A_MM),
        (None, Some((width, height))) => (f64::from(width) * A_PIXEL, f64::from(height) * A_PIXEL),
        (None, None) => (wide * A_PIXEL, high * A_PIXEL),
    };
    let scale = (width / wide).min(height / high);
    let move_by = (0.5 * (width - wide * scale) - left * scale, 0.5 * (height + high * scale) + top * scale);
    let used = [BTreeMap::new(), BTreeMap::new()];
    let mut sheet = Sheet { content: Content::new(), used, filling: None, drawing: None };
    if let Some(Shape::Rect(_, paper)) = figure.shapes.first() {
        sheet.fill(*paper);
        sheet.content.rect(0.0, 0.0, width as f32, height as f32).fill_nonzero();
    }
    // the vertical axis of the canvas points down, that of a page up
    let (x, y) = (move_by.0 as f32, move_by.1 as f32);
    sheet.content.transform([scale as f32, 0.0, 0.0, -scale as f32, x, y]);
    sheet.content.set_line_cap(LineCapStyle::RoundCap).set_line_join(LineJoinStyle::RoundJoin);
    let shapes = figure.shapes.get(1..).unwrap_or_default();
    // neighbouring polygons of one colour, as those of a band, leave no seam if they are one path
    let is_one =
        |a: &Shape, b: &Shape| matches!((a, b), (Shape::Polygon(_, a), Shape::Polygon(_, b)) if a == b);
    shapes.chunk_by(is_one).for_each(|shapes| sheet.paint(shapes));

    let mut pdf = Pdf::new();
    pdf.catalog(CATALOG).pages(PAGES).metadata(METADATA);
    pdf.pages(PAGES).kids([PAGE]).count(1);
    let mut page = pdf.page(PAGE);
    page.media_box(Rect::new(0.0, 0.0, width as f32, height as f32)).parent(PAGES).contents(CONTENT);
    let fonts = FONT_NAMES.into_iter().enumerate().map(|(place, name)| (name, font_object(place, 0)));
    page.resources().fonts().pairs(fonts);
    page.finish();
    pdf.stream(CONTENT, &packed(&sheet.content.finish())).filter(Filter::FlateDecode);
    for (place, used) in sheet.used.iter().enumerate() {
        embed(&mut pdf, place, used);
    }
    let title = figure.origin.get("title").and_then(|title| title.as_str()).unwrap_or_default();
    let (made, software) = (figure.made(), figure.software());
    pdf.document_info(INFO).title(TextStr(title)).subject(TextStr(&made)).creator(TextStr(&software));
    let mut xmp = XmpWriter::new();
    xmp.title([(None, title)]).description([(None, made.as_str())]).creator_tool(&software);
    pdf.metadata(METADATA, xmp.finish(None).as_bytes());
    pdf.finish()
}

/// An object of one of the two fonts: 0 the font, 1 its glyphs, 2 its descriptor, 3 its file, 4 its letters.
fn font_object(place: usize, object: i32) -> Ref {
    Ref::new(FONTS + FONT_OBJECTS * place as i32 + object)
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::new(9));
    // writing to a vector cannot fail
    let _ = encoder.write_all(bytes);
    encoder.finish().unwrap_or_default()
}

/// Writes a font with the glyphs that are used, each with its letter.
fn embed(pdf: &mut Pdf, place: usize, used: &BTreeMap<GlyphId, char>) {
    let face = FontFace::of(place == 1);
    // six letters before the name mark a subset of a font
    let name = format!("INTERW+{}", face.name);
    let name = Name(name.as_bytes());
    pdf.type0_font(font_object(place, 0))
        .base_font(name)
        .encoding_predefined(Name(b"Identity-H"))
        .descendant_font(font_object(place, 1))
        .to_unicode(font_object(place, 4));
    let mut glyphs = pdf.cid_font(font_object(place, 1));
    glyphs.subtype(CidFontType::Type2).base_font(name).system_info(IDENTITY);
    glyphs.font_descriptor(font_object(place, 2)).default_width(0.0);
    glyphs.cid_to_gid_map_predefined(Name(b"Identity"));
    let mut widths = glyphs.widths();
    for glyph in used.keys() {
        widths.consecutive(glyph.to_u32() as u16, [(1e3 * face.width(*glyph)) as f32]);
    }
    widths.finish();
    glyphs.finish();
    // bounds, ascent and descent of the whole font, in thousandths of an em
    let thousandth = |units: f64| (units * 1e3 / UNITS) as f32;
    let bounds = Rect::new(thousandth(-1513.0), thousandth(-660.0), thousandth(5290.0), thousandth(2269.0));
    pdf.font_descriptor(font_object(place, 2))
        .name(name)
        .flags(FontFlags::SYMBOLIC)
        .bbox(bounds)
        .italic_angle(0.0)
        .ascent(thousandth(1984.0))
        .descent(thousandth(-494.0))
        .cap_height(thousandth(1490.0))
        .stem_v(if place == 1 { 120.0 } else { 80.0 })
        .font_file2(font_object(place, 3));
    let file = subset(face.bytes, used.keys().map(|glyph| glyph.to_u32() as usize));
    let bytes = packed(&file);
    let mut stream = pdf.stream(font_object(place, 3), &bytes);
    stream.filter(Filter::FlateDecode).pair(Name(b"Length1"), file.len() as i32);
    stream.finish();
    let mut letters: UnicodeCmap<u16> = UnicodeCmap::new(Name(b"Letters"), IDENTITY);
    used.iter().for_each(|(glyph, letter)| letters.pair(glyph.to_u32() as u16, *letter));
    pdf.stream(font_object(place, 4), &packed(&letters.finish())).filter(Filter::FlateDecode);
}

/// The content of a page, and the glyphs of both fonts that it uses, with their letters.
struct Sheet {
    content: Content,
    used: [BTreeMap<GlyphId, char>; 2],
    /// The present colour of areas.
    filling: Option<Ink>,
    /// The present colour and width of lines.
    drawing: Option<(Ink, f64)>,
}

/// Red, green and blue from 0 to 1.
fn parts(Ink(red, green, blue): Ink) -> [f32; 3] {
    [red, green, blue].map(|part| f32::from(part) / 255.0)
}

/// A length on the canvas, rounded to less than any print can show.
fn rounded(length: f64) -> f32 {
    ((length * 100.0).round() / 100.0) as f32
}

impl Sheet {
    /// Sets the fill colour if it changes.
    fn fill(&mut self, ink: Ink) {
        if self.filling != Some(ink) {
            let [red, green, blue] = parts(ink);
            self.content.set_fill_rgb(red, green, blue);
            self.filling = Some(ink);
        }
    }

    /// Sets the colour and the width of lines if they change.
    fn pen(&mut self, ink: Ink, width: f64) {
        if self.drawing.is_none_or(|last| last.0 != ink) {
            let [red, green, blue] = parts(ink);
            self.content.set_stroke_rgb(red, green, blue);
        }
        if self.drawing.is_none_or(|last| last.1 != width) {
            self.content.set_line_width(rounded(width));
        }
        self.drawing = Some((ink, width));
    }

    /// Paints a shape, or several polygons of one colour.
    fn paint(&mut self, shapes: &[Shape]) {
        match &shapes[0] {
            Shape::Rect(Area { left, top, right, bottom }, ink) => {
                self.fill(*ink);
                let [left, top, right, bottom] = [*left, *top, *right, *bottom].map(rounded);
                self.content.rect(left, top, right - left, bottom - top).fill_nonzero();
            }
            Shape::Line(points, width, ink) => {
                self.pen(*ink, *width);
                self.outline(points);
                self.content.stroke();
            }
            Shape::Polygon(_, ink) => {
                self.fill(*ink);
                for shape in shapes {
                    if let Shape::Polygon(points, _) = shape {
                        self.outline(&oriented(points));
                        self.content.close_path();
                    }
                }
                self.content.fill_nonzero();
            }
            // a line of no length with round ends (ISO 32000-1, 8.4.3.3)
            Shape::Disc(centre, radius, ink) => {
                self.pen(*ink, 2.0 * radius);
                self.outline(&[*centre, *centre]);
                self.content.stroke();
            }
            Shape::Text(text) => self.write(text),
        }
    }

    fn outline(&mut self, points: &[Point]) {
        for (i, (x, y)) in points.iter().enumerate() {
            match i {
                0 => self.content.move_to(rounded(*x), rounded(*y)),
                _ => self.content.line_to(rounded(*x), rounded(*y)),
            };
        }
    }

    fn write(&mut self, text: &Text) {
        self.fill(text.ink);
        let mut glyphs = Vec::new();
        for letter in FontFace::of(text.bold).letters(&text.words) {
            glyphs.extend((letter.glyph.to_u32() as u16).to_be_bytes());
            self.used[usize::from(text.bold)].entry(letter.glyph).or_insert(letter.character);
        }
        let (back, (x, y)) = (text.before(), text.at);
        // letters stand upright on a canvas that goes down
        let matrix = match text.upright {
            false => [1.0, 0.0, 0.0, -1.0, rounded(x - back), rounded(y)],
            true => [0.0, -1.0, -1.0, 0.0, rounded(x), rounded(y + back)],
        };
        self.content.begin_text().set_font(FONT_NAMES[usize::from(text.bold)], rounded(text.size));
        self.content.set_text_matrix(matrix).show(Str(&glyphs)).end_text();
    }
}
