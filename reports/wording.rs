//! Names and numbers as people read them.

use bytesize::ByteSize;

pub(crate) use furrow_model::shown;

/// A text of several lines, each as [`shown`].
pub(crate) fn shown_lines(text: &str) -> String {
    text.lines().map(shown).collect::<Vec<_>>().join("\n")
}

/// `1 234`, thin spaces between thousands.
pub(crate) fn count(value: u32) -> String {
    let digits = value.to_string();
    let mut text = String::with_capacity(digits.len() + 4);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push('\u{202f}');
        }
        text.push(digit);
    }
    text
}

/// `12.3`; `–` for what does not exist.
pub(crate) fn tenths(value: impl Into<Option<f64>>) -> String {
    value.into().map_or_else(|| "–".to_owned(), |value| format!("{value:.1}"))
}

/// A share between 0 and 1 as `45.0 %`; `–` for what does not exist.
pub(crate) fn percent(share: impl Into<Option<f64>>) -> String {
    // The sum of nothing is -0: adding 0 takes its sign away.
    share.into().map_or_else(|| "–".to_owned(), |share| format!("{:.1}\u{202f}%", 100.0 * share + 0.0))
}

/// `1 frame`, `2 frames`.
pub(crate) fn counted(number: usize, one: &str, many: &str) -> String {
    format!("{} {}", count(u32::try_from(number).unwrap_or(u32::MAX)), if number == 1 { one } else { many })
}

/// A size in bytes, `201.5 MB`.
pub(crate) fn bytes(count: u64) -> String {
    ByteSize::b(count).display().si().to_string()
}

/// `a`, `a and b`, `a, b and c`.
pub(crate) fn listed(names: impl IntoIterator<Item = String>) -> String {
    let names: Vec<String> = names.into_iter().collect();
    match names.split_last() {
        None => String::new(),
        Some((last, [])) => last.clone(),
        Some((last, rest)) => format!("{} and {last}", rest.join(", ")),
    }
}

/// A number to three decimals: metres to the millimetre, in the data of a page.
pub(crate) fn thousandths(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_nothing_has_no_sign() {
        assert_eq!(percent(Vec::<f64>::new().iter().sum::<f64>()), "0.0\u{202f}%");
        assert_eq!(percent(None::<f64>), "–");
    }

    #[test]
    fn numbers_read_as_written_by_hand() {
        assert_eq!([count(7), count(1234), count(1234567)], ["7", "1\u{202f}234", "1\u{202f}234\u{202f}567"]);
        assert_eq!([percent(0.45), percent(None), tenths(3.04)], ["45.0\u{202f}%", "–", "3.0"]);
    }

    #[test]
    fn sizes_are_decimal() {
        assert_eq!([bytes(999), bytes(1000), bytes(201_472_478)], ["999 B", "1.0 kB", "201.5 MB"]);
    }
}
