//! Shortest text of a double that parses back to the same double.

use std::fmt::Write;

/// Appends `value` in its shortest form: plain (`0.58`) or with an exponent (`1e-9`), whichever has fewer
/// characters, and plain if they are equal. Zero of either sign is `0`. Minus infinity (the logarithm of 0)
/// is `-inf`, plus infinity (an open circuit) is `inf`, and NaN appends nothing.
///
/// The digits are the fewest that parse back to the same double (the standard library's `{:e}`, after Grisu,
/// Loitsch 2010). Only their layout is chosen here, so both forms need a single conversion.
pub fn push_number(text: &mut String, value: f64) {
    if value.is_infinite() {
        text.push_str(if value > 0.0 { "inf" } else { "-inf" });
    }
    if !value.is_finite() {
        return;
    }
    let begin = text.len();
    // Adding 0 makes -0 a plain 0.
    let _ = write!(text, "{:e}", value + 0.0);
    // sign, digits and exponent of `-d.dddde-x`
    let written = &text[begin..];
    let (mantissa, exponent) = written.split_once('e').unwrap_or((written, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let negative = mantissa.starts_with('-');
    let mut digits = [0_u8; 24];
    let mut count = 0;
    for byte in mantissa.bytes().filter(u8::is_ascii_digit).take(digits.len()) {
        digits[count] = byte;
        count += 1;
    }
    let places = count as i32;
    let plain = if exponent >= places - 1 {
        exponent + 1
    } else if exponent >= 0 {
        places + 1
    } else {
        places + 1 - exponent
    } + i32::from(negative);
    if plain as usize > written.len() {
        return;
    }
    text.truncate(begin);
    if negative {
        text.push('-');
    }
    if exponent < 0 {
        text.push_str("0.");
        (1..-exponent).for_each(|_| text.push('0'));
    }
    for (i, digit) in digits[..count].iter().enumerate() {
        if exponent >= 0 && i as i32 == exponent + 1 {
            text.push('.');
        }
        text.push(char::from(*digit));
    }
    (places..=exponent).for_each(|_| text.push('0'));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn short(value: f64) -> String {
        let mut text = String::new();
        push_number(&mut text, value);
        text
    }

    #[test]
    fn the_shorter_of_two_forms_that_parse_back() {
        let mut values = vec![0.0, 1.0, -1.0, 0.58, 0.1 * 3.0, 100.0, 1e3, 12345.678, 1e-2, 1e-3, 1e21];
        values.extend([5e-324, f64::MAX, f64::MIN_POSITIVE, 1e22, 123456789012345680.0, -1.5e-9, 9.80665]);
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            values.push(f64::from_bits(bits));
            values.push((bits >> 40) as f64 / 1024.0);
            values.push((bits >> 48) as f64 * 1e-3);
        }
        for value in values.into_iter().filter(|v| v.is_finite()) {
            let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
            let right = if scientific.len() < plain.len() { scientific } else { plain };
            let written = short(value);
            assert_eq!(written, right);
            assert_eq!(written.parse::<f64>().unwrap().to_bits(), value.to_bits());
        }
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!((short(-0.0), short(0.0)), ("0".to_owned(), "0".to_owned()));
    }

    #[test]
    fn a_missing_number_is_an_empty_cell() {
        assert_eq!(short(f64::NAN), "");
        assert_eq!(short(f64::INFINITY), "inf");
    }

    #[test]
    fn minus_infinity_reads_back() {
        assert_eq!(short(f64::NEG_INFINITY).parse(), Ok(f64::NEG_INFINITY));
    }
}
