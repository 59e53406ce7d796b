//! Seconds in decimal text as whole nanoseconds. An `f64` holds stamps of this century only to 2e-7 s.

/// Seconds in decimal or scientific notation (`1317045935.500923136`, `1.5e-3`) as nanoseconds, rounded to the nearest
/// and from a half away from zero. `None` where the text is no finite number, or one beyond the 292 years that an `i64`
/// holds.
pub fn parse_seconds_ns(text: &str) -> Option<i64> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, parse_exponent(exponent)?),
        None => (text, 0),
    };
    let is_negative = mantissa.starts_with('-');
    let unsigned = mantissa.strip_prefix(['-', '+']).unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once('.').unwrap_or((unsigned, ""));
    let digits = [whole, fraction].concat();
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    // The decimal point of the nanoseconds stands behind this many digits.
    let point = whole.len() as i64 + exponent + 9;
    let nanoseconds = round_digits(digits.as_bytes(), point)?;
    i64::try_from(if is_negative { -nanoseconds } else { nanoseconds }).ok()
}

/// The exponent of a number in scientific notation; one that is too large for any stamp is cut to a large one.
fn parse_exponent(text: &str) -> Option<i64> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let size = digits.parse().unwrap_or(i64::from(i32::MAX)).min(i64::from(i32::MAX));
    Some(if text.starts_with('-') { -size } else { size })
}

/// The number with these digits and its decimal point behind the first `point` of them, rounded; `None` where it is too
/// large for an `i64` by far.
fn round_digits(digits: &[u8], point: i64) -> Option<i128> {
    let zeros = digits.iter().take_while(|digit| **digit == b'0').count();
    let (digits, point) = (&digits[zeros..], point - zeros as i64);
    if digits.is_empty() || point < 0 {
        return Some(0);
    }
    let point = usize::try_from(point).ok().filter(|point| *point <= 20)?;
    let digit = |place: usize| i128::from(digits.get(place).map_or(0, |digit| digit - b'0'));
    let whole = (0..point).fold(0, |number, place| 10 * number + digit(place));
    Some(whole + i128::from(digit(point) >= 5))
}

#[cfg(test)]
mod tests {
    use super::parse_seconds_ns;

    #[test]
    fn every_nanosecond_is_kept() {
        for (text, stamp_ns) in [
            ("0", 0),
            ("3", 3_000_000_000),
            ("0.1", 100_000_000),
            (".5", 500_000_000),
            ("5.", 5_000_000_000),
            ("+1.25", 1_250_000_000),
            ("-0.5", -500_000_000),
            ("1317045935.500923136", 1_317_045_935_500_923_136),
            ("1768457151.184334112", 1_768_457_151_184_334_112),
            ("1.317045935500923136e9", 1_317_045_935_500_923_136),
            ("1.036224000e-01", 103_622_400),
            ("0.0000001E+2", 10_000),
            ("9223372036.854775807", i64::MAX),
            ("-9223372036.854775808", i64::MIN),
        ] {
            assert_eq!(parse_seconds_ns(text), Some(stamp_ns), "{text}");
        }
    }

    #[test]
    fn further_digits_are_rounded() {
        for (text, stamp_ns) in [
            ("0.0000000004", 0),
            ("0.0000000005", 1),
            ("-0.0000000005", -1),
            ("1.9999999999", 2_000_000_000),
            ("1768457151.1843341129", 1_768_457_151_184_334_113),
            ("1e-10", 0),
            ("5e-10", 1),
            ("1e-99999999999999999999", 0),
        ] {
            assert_eq!(parse_seconds_ns(text), Some(stamp_ns), "{text}");
        }
    }

    #[test]
    fn other_text_is_refused() {
        let beyond = ["9223372036.854775808", "99999999999999999999", "1e30", "1e99999999999999999999"];
        let wrong = ["", ".", "-", "e5", "1e", "1e+", "1.+5", "1.2.3", "--1", "1 ", "nan", "inf", "now", "1_0", "0x1"];
        for text in beyond.iter().chain(&wrong) {
            assert_eq!(parse_seconds_ns(text), None, "{text}");
        }
    }
}
