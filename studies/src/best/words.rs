//! Sentences about the result of `best`.

use super::{BestDesign, BestQuestion, SAMPLES, Seeds};
use crate::numeric::short;
use crate::scene::column_names;
use crate::study::label_and_unit;

impl BestDesign {
    /// The result in sentences.
    pub fn words(&self, question: &BestQuestion) -> Vec<String> {
        let names = names(question);
        let maximised = question.maximise.name;
        let at = place(&names, &self.optimum.at);
        let mean = if question.environments.len() > 1 { "the mean of " } else { "" };
        let value = |number: f64| quantity(number, maximised);
        let error = match &self.seeds {
            Seeds::Averaged { count, standard_error, .. } => {
                format!(" with a standard error of {} from {count} seeds", value(*standard_error))
            }
            Seeds::None | Seeds::Alone => String::new(),
        };
        let largest = format!("{mean}{maximised} is largest at {at}: {}{error}", value(self.optimum.value));
        let mut lines = vec![largest];
        if self.seeds == Seeds::Alone {
            lines.push(
                "the noise has one seed: place and value are those of this seed, and how far those of others \
                 lie is not known; several seeds in the environment say, such as \
                 excitation.seed=1,2,3,4,5,6,7,8"
                    .to_owned(),
            );
        }
        if self.flat {
            lines.push(format!("{maximised} is the same wherever it was looked, so that no place is better"));
        }
        if let Some(later) = self.later {
            let then =
                if later.is_nan() { "has no result".to_owned() } else { format!("gives {}", value(later)) };
            lines.push(format!(
                "the motion there has not repeated by the end of its run: followed for twice as long it \
                 {then}, so place and margins are uncertain"
            ));
        }
        for (i, name) in names.iter().enumerate() {
            let (range, resolution) = (&question.over[i], quantity(self.resolution[i], name));
            let side = |margin: Option<f64>, way: &str, end: f64| match margin {
                Some(margin) => format!("{} {way}", quantity(margin, name)),
                None => {
                    format!("nowhere {way}, as far as the range goes to {}", in_unit(&end.to_string(), name))
                }
            };
            let [low, high] = self.margins[i];
            let (low, high) = (side(low, "below", range.low), side(high, "above", range.high));
            let steps = self.margin_steps[i].map(|step| quantity(step, name));
            let broken = if question.subject_to.is_empty() { "" } else { ", or a constraint broken," };
            lines.push(format!(
                "{name}: a tenth of it is lost{broken} {low}, and {high}, tried in steps of up to {} below \
                 and {} above",
                steps[0], steps[1]
            ));
            lines.push(match &self.seeds {
                Seeds::Averaged { intervals, .. } => format!(
                    "{name}: the seeds leave the best value between {} and {} (95 %)",
                    in_unit(&intervals[i][0].to_string(), name),
                    in_unit(&intervals[i][1].to_string(), name)
                ),
                Seeds::None => format!("{name}: located to {resolution}"),
                Seeds::Alone => format!("{name}: located to {resolution} for this seed"),
            });
            if self.at_border[i] && !self.flat {
                lines.push(format!("{name} is best at an end of its range: a wider range may hold better"));
            }
        }
        if question.environments.len() > 1 {
            for (environment, each) in question.environments.iter().zip(&self.optimum.of_each) {
                lines.push(format!("{}: {}", environment.name, value(*each)));
            }
        }
        if !question.vary.is_empty() {
            let number = |result: f64| if result.is_nan() { "no result".to_owned() } else { value(result) };
            let spread = &self.spread;
            lines.push(format!(
                "of {SAMPLES} samples of what varies the worst gives {}, one in twenty less than {}",
                number(spread.worst),
                number(spread.quantile_5)
            ));
            lines.push(match &self.stepped_back {
                None => {
                    "no place beside it along the first field, of those tried, has a better worst case".into()
                }
                Some((other, spread)) => format!(
                    "at {} the worst gives {}, one in twenty less than {}; the value there is {}, {} % less",
                    place(&names[..1], &other.at),
                    number(spread.worst),
                    number(spread.quantile_5),
                    value(other.value),
                    short(100.0 * (1.0 - other.value / self.optimum.value))
                ),
            });
        }
        lines
    }
}

/// A place as `field = value` with its unit, field by field.
pub fn place(names: &[String], at: &[f64]) -> String {
    let each = names.iter().zip(at);
    let each = each.map(|(name, value)| format!("{name} = {}", in_unit(&value.to_string(), name)));
    each.collect::<Vec<_>>().join(", ")
}

/// The shortest names of the fields of the design.
pub fn names(question: &BestQuestion) -> Vec<String> {
    let fields: Vec<&str> = question.over.iter().map(|range| range.field.as_str()).collect();
    column_names(&fields)
}

/// A value with the unit that the name of its field or column ends with.
pub fn quantity(value: f64, name: &str) -> String {
    in_unit(&short(value), name)
}

/// A number with the unit of a field or column, in letters that any terminal has.
fn in_unit(number: &str, name: &str) -> String {
    // a name such as `n_per_m` is a unit alone
    let (_, unit) = label_and_unit(&format!("_{}", name.rsplit('.').next().unwrap_or_default()));
    let unit = match unit {
        "\u{b0}" => "degrees".to_owned(),
        unit => unit.replace('\u{b3}', "^3").replace('\u{2074}', "^4"),
    };
    format!("{number} {unit}").trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use crate::scene::{Document, PRESETS, numeric_fields};
    use crate::study::SUMMARY_FIELDS;

    use super::*;

    #[test]
    fn a_number_has_the_unit_of_its_name() {
        for (name, expected) in [
            ("travel_limit_mm", "2 mm"),
            ("n_per_m", "2 N/m"),
            ("1.n_per_m", "2 N/m"),
            ("linear_n_per_m", "2 N/m"),
            ("c_n_s_per_m", "2 N s/m"),
            ("rms_velocity_m_per_s", "2 m/s"),
            ("mean_load_power_w", "2 W"),
            ("yield_gpa", "2 GPa"),
            ("amplitude_g", "2 g"),
            ("impacts", "2"),
            ("coefficients_si.2", "2"),
        ] {
            assert_eq!(quantity(2.0, name), expected);
        }
    }

    /// A name that ends with a compound unit must not get the unit of its last letter alone.
    #[test]
    fn no_unit_is_part_of_a_longer_one() {
        let scenes = PRESETS.iter().map(|preset| Document::load(preset.name).unwrap().scene);
        let fields = scenes.flat_map(|scene| numeric_fields(&scene));
        let columns = SUMMARY_FIELDS.iter().map(|field| field.name.to_owned());
        for name in fields.chain(columns) {
            let text = quantity(2.0, &name);
            let per = name.contains("_per_") || name.contains(".n_per_");
            assert_eq!(text.contains('/'), per, "{name}: {text}");
        }
    }
}
