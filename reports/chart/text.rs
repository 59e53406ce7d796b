//! How wide texts are, and texts cut to their room.

fn advance(c: char) -> f64 {
    match c {
        '\u{2e81}'.. => 1.0,
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

/// Numbers with a space between them, for the data of an element.
pub(crate) fn spaced(numbers: impl Iterator<Item = f64>) -> String {
    numbers.map(|number| number.to_string()).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
