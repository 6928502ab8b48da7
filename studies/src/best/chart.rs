//! Picture of the search for a best design: the designs that were tried, and the one that was found.

use super::{BestDesign, BestQuestion, Optimum, Tried, names, scan_places};
use crate::numeric::short;
use crate::output::{
    Chart, Colours, Drawn, Marks, Panel, PlotAxis, Point, Ranges, Role, Shade, Shades, Side, suited_unit,
};
use crate::study::{Edges, label_and_unit, with_unit};

/// Words of the legend.
const NO_VALUE: &str = "no value";
const BROKEN: &str = "a constraint broken";

/// The picture of the search that found a design: over one field the values of all designs that were tried,
/// over two a map of the scan with the further designs in the colours of their values, over more the values
/// in the order in which they were tried. The design that was found is marked, and designs that break a
/// constraint are crossed.
///
/// `question` and `design` are the fields of a [`BestAnswer`](super::BestAnswer).
pub fn best_chart(question: &BestQuestion, design: &BestDesign, ranges: Ranges) -> Chart {
    let shown = Shown::new(question, design, ranges);
    let panel = match question.over.len() {
        1 => shown.over_one_field(),
        2 => shown.over_two_fields(),
        _ => shown.in_order(),
    };
    let fields = names(question).into_iter().zip(&design.optimum.at);
    let at = fields.map(|(name, value)| {
        let (words, unit) = label_and_unit(&name);
        format!("{words} {value} {unit}").trim_end().to_owned()
    });
    let (at, value) = (at.collect::<Vec<_>>().join(", "), short(design.optimum.value * shown.scale));
    let about = format!("{} places tried; largest at {at}: {value} {}", design.tried.len(), shown.unit);
    let data = shown.data(&panel);
    Chart::stack(vec![panel], about.trim_end(), data)
}

struct Shown<'a> {
    question: &'a BestQuestion,
    design: &'a BestDesign,
    ranges: Ranges,
    tried: &'a [Tried],
    /// The factor from the unit of the maximised result to that of its axis, and that unit.
    scale: f64,
    unit: &'static str,
    /// The label of its axis.
    label: String,
}

impl<'a> Shown<'a> {
    fn new(question: &'a BestQuestion, design: &'a BestDesign, ranges: Ranges) -> Self {
        let (tried, maximised) = (&*design.tried, question.maximise);
        let (_, unit) = label_and_unit(maximised.name);
        let (scale, unit) = suited_unit(unit, tried.iter().filter_map(|tried| tried.value));
        let mean = if question.environments.len() > 1 { "mean " } else { "" };
        let label = with_unit(format!("{mean}{}", maximised.label), unit);
        Self { question, design, ranges, tried, scale, unit, label }
    }

    /// The value of a design in the unit of its axis; NaN if it has none.
    fn value(&self, tried: &Tried) -> f64 {
        tried.value.map_or(f64::NAN, |value| value * self.scale)
    }

    /// The axis of a field over its range.
    fn field_axis(&self, field: usize, given: Option<(f64, f64)>) -> PlotAxis {
        let range = &self.question.over[field];
        let (words, unit) = label_and_unit(&names(self.question)[field]);
        PlotAxis::between(range.low, range.high, &with_unit(words, unit)).or_given(given)
    }

    /// The axis of the values, from 0 or below.
    fn value_axis(&self, margin: f64) -> PlotAxis {
        PlotAxis::from_zero(self.tried.iter().map(|tried| self.value(tried)), margin, &self.label)
    }

    fn over_one_field(&self) -> Panel {
        let Ranges { x, y } = self.ranges;
        let mut panel = Panel::new(self.field_axis(0, x), self.value_axis(0.06).or_given(y));
        let mut line: Vec<Point> = self.points(|tried, _| tried.at[0], |tried| tried.keeps);
        // a design may be tried again, beside the optimum
        line.sort_by(|a, b| a.0.total_cmp(&b.0));
        panel.draw(Role::Joined, Marks::Path(line));
        self.designs(&mut panel, |tried, _| tried.at[0]);
        self.found(&mut panel, |design| (design.at[0], design.value * self.scale));
        panel
    }

    fn over_two_fields(&self) -> Panel {
        let Ranges { x, y } = self.ranges;
        let scan = (scan_places(self.question) as usize).min(self.tried.len());
        let (scan, nearer) = self.tried.split_at(scan);
        let values = |field: usize| scan.iter().map(|tried| tried.at[field]).collect::<Vec<f64>>();
        let (across, up) = (Edges::new(&values(0)), Edges::new(&values(1)));
        let mut cells = vec![Shade::Blank; across.values.len() * up.values.len()];
        for tried in scan {
            if let (Some(column), Some(row)) = (across.place(tried.at[0]), up.place(tried.at[1])) {
                let value = tried.value.map(|value| Shade::Value(value * self.scale));
                cells[column * up.values.len() + row] = value.unwrap_or(Shade::Missing);
            }
        }
        let bar = self.value_axis(0.0);
        let colours = Colours::Scale(bar.clone());
        let mut panel = Panel::new(self.field_axis(0, x), self.field_axis(1, y));
        panel.bar = Some(bar);
        let cells = Shades { across, up, cells, colours: colours.clone(), missing: NO_VALUE.to_owned() };
        panel.draw(Role::Motion, Marks::Cells(cells));
        let place = |tried: &Tried| (tried.at[0], tried.at[1]);
        let valued = nearer.iter().filter(|tried| tried.keeps && tried.value.is_some());
        let valued = valued.map(|tried| (place(tried), self.value(tried))).collect();
        panel.layer(Role::Motion, "tried", Marks::Valued(valued, colours));
        let broken = self.tried.iter().filter(|tried| !tried.keeps).map(place).collect();
        panel.layer_if_any(Role::Broken, BROKEN, Marks::Points(broken));
        self.found(&mut panel, |design| (design.at[0], design.at[1]));
        panel
    }

    /// Marks the design that was found, and the safer one beside it.
    fn found(&self, panel: &mut Panel, place: impl Fn(&Optimum) -> Point) {
        let BestDesign { optimum, stepped_back, .. } = self.design;
        let back = stepped_back.iter().map(|(back, _)| place(back)).collect();
        panel.layer_if_any(Role::SteppedBack, "best worst case", Marks::Points(back));
        panel.layer(Role::Found, "found", Marks::Points(vec![place(optimum)]));
    }

    fn in_order(&self) -> Panel {
        let Ranges { x, y } = self.ranges;
        let across = PlotAxis::around([1.0, self.tried.len() as f64], 0.02, "evaluation").or_given(x);
        let mut panel = Panel::new(across, self.value_axis(0.06).or_given(y));
        self.designs(&mut panel, |_, number| number);
        let mut best = f64::NEG_INFINITY;
        let mut line: Vec<Point> = Vec::new();
        for (x, value) in self.points(|_, number| number, |tried| tried.keeps) {
            if value > best {
                // upright steps
                line.extend((best > f64::NEG_INFINITY).then_some((x, best)));
                line.push((x, value));
                best = value;
            }
        }
        line.extend(line.last().map(|last| (self.tried.len() as f64, last.1)));
        panel.layer(Role::Best, "best so far", Marks::Path(line));
        let optimum = &self.design.optimum;
        let found = self.tried.iter().position(|tried| tried.at == optimum.at);
        let found = found.map(|place| ((place + 1) as f64, optimum.value * self.scale));
        panel.layer(Role::Found, "found", Marks::Points(found.into_iter().collect()));
        panel
    }

    /// The values of the designs that are `wanted`, over a number of each; its place in the order counts from
    /// 1.
    fn points(&self, over: impl Fn(&Tried, f64) -> f64, wanted: impl Fn(&Tried) -> bool) -> Vec<Point> {
        let all = self.tried.iter().enumerate().filter(|(_, tried)| tried.value.is_some() && wanted(tried));
        all.map(|(i, tried)| (over(tried, (i + 1) as f64), self.value(tried))).collect()
    }

    /// Draws the designs: dots, crosses where a constraint is broken, ticks where there is no value.
    fn designs(&self, panel: &mut Panel, over: impl Fn(&Tried, f64) -> f64) {
        panel.layer(Role::Motion, "tried", Marks::Cloud(self.points(&over, |tried| tried.keeps)));
        let broken = self.points(&over, |tried| !tried.keeps);
        panel.layer_if_any(Role::Broken, BROKEN, Marks::Cloud(broken));
        let missing = self.tried.iter().enumerate().filter(|(_, tried)| tried.value.is_none());
        let missing = missing.map(|(i, tried)| over(tried, (i + 1) as f64)).collect();
        panel.layer_if_any(Role::Missing, NO_VALUE, Marks::Ticks(missing, Side::Bottom));
    }

    /// The designs that are within the axes, with the numbers of their evaluations.
    fn data(&self, panel: &Panel) -> crate::study::Table {
        let (fields, maximised) = (names(self.question), self.question.maximise.name);
        let columns = fields.iter().map(String::as_str);
        let mut drawn = Drawn::new(["evaluation"].into_iter().chain(columns).chain([maximised]), &[]);
        let inside = |number: f64, at: &[f64]| match at {
            [x] => panel.x.contains(*x),
            [x, y] => panel.contains((*x, *y)),
            _ => panel.x.contains(number),
        };
        let mut put = |series: &'static str, number: f64, at: &[f64], value: f64| {
            if inside(number, at) {
                let numbers: Vec<f64> = [&[number], at, &[value]].concat();
                drawn.put(series, &numbers, &[]);
            }
        };
        for (i, tried) in self.tried.iter().enumerate() {
            let series = match tried.value {
                None => "no_value",
                Some(_) if !tried.keeps => "broken",
                Some(_) => "tried",
            };
            put(series, (i + 1) as f64, &tried.at, tried.value.unwrap_or(f64::NAN));
        }
        let BestDesign { optimum, stepped_back, .. } = self.design;
        let back =
            stepped_back.as_ref().filter(|_| fields.len() < 3).map(|(back, _)| ("best_worst_case", back));
        for (series, design) in [("found", optimum)].into_iter().chain(back) {
            let number = self.tried.iter().position(|tried| tried.at == design.at);
            put(series, number.map_or(f64::NAN, |place| (place + 1) as f64), &design.at, design.value);
        }
        drawn.table()
    }
}
