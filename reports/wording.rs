//! Names and numbers as people read them.

pub(crate) use furrow_model::shown;

fn advance(c: char) -> f64 {
    match c {
        '\u{1100}'.. if c > '\u{2e80}' => 1.0,
        'i' | 'l' | 'j' | '.' | ',' | ':' | '\'' | '|' | ' ' | 't' | 'f' | 'r' | 'I' => 0.4,
        'm' | 'w' | 'M' | 'W' | '@' | '%' => 0.97,
        'A'..='Z' => 0.72,
        _ => 0.63,
    }
}

/// About how wide a text is, in SVG units, in a system sans-serif font of `size`.
pub(crate) fn width(text: &str, size: f64) -> f64 {
    text.chars().map(advance).sum::<f64>() * size
}

/// The text, with an ellipsis for its middle where it is wider than `room`: names often differ in their last letters.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> String {
    if width(text, size) <= room {
        return text.to_owned();
    }
    let within = |room: f64| {
        let mut used = 0.0;
        move |c: &char| {
            used += advance(*c) * size;
            used <= room
        }
    };
    let letters = room - size;
    let head: String = text.chars().take_while(within(0.6 * letters)).collect();
    let tail: Vec<char> = text.chars().rev().take_while(within(0.4 * letters)).collect();
    let tail: String = tail.into_iter().rev().collect();
    format!("{}…{}", head.trim_end(), tail.trim_start())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_nothing_has_no_sign() {
        assert_eq!(percent(Vec::<f64>::new().iter().sum::<f64>()), "0.0\u{202f}%");
        assert_eq!(percent(None::<f64>), "–");
    }

    #[test]
    fn long_names_are_cut_to_their_room() {
        let cut = fitted(&"x".repeat(300), 11.0, 100.0);
        assert!(cut.contains('…') && width(&cut, 11.0) <= 105.0, "{cut}");
        let [one, other] =
            ["0.25", "0.5"].map(|z| fitted(&format!("10:00 as 12:00 (otf:10:00>16:00 z {z})"), 11.0, 150.0));
        assert!(
            one.starts_with("10:00 as 12") && one.ends_with("z 0.25)") && other.ends_with("z 0.5)"),
            "{one} {other}"
        );
        assert_eq!(fitted("10:00", 11.0, 3.0), "…");
        assert_eq!(fitted("10:00", 11.0, 100.0), "10:00");
    }

    #[test]
    fn numbers_read_as_written_by_hand() {
        assert_eq!([count(7), count(1234), count(1234567)], ["7", "1\u{202f}234", "1\u{202f}234\u{202f}567"]);
        assert_eq!([percent(0.45), percent(None), tenths(3.04)], ["45.0\u{202f}%", "–", "3.0"]);
    }
}
