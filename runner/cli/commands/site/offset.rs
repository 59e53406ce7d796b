//! How far clocks are ahead of UTC, as people write it.

/// Minutes ahead of UTC as people write them, `+12:00`.
pub fn offset_text(minutes: i32) -> String {
    let sign = if minutes < 0 { '-' } else { '+' };
    format!("{sign}{:02}:{:02}", minutes.abs() / 60, minutes.abs() % 60)
}

/// Reads hours and minutes ahead of UTC, in minutes.
pub fn parse_offset(text: &str) -> Result<i32, String> {
    let wrong = || format!("'{text}' is no offset from UTC: expected +HH:MM between -12:00 and +14:00, as in +12:00");
    let (sign, digits) = match text.strip_prefix(['-', '−']) {
        Some(digits) => (-1, digits),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let (hours, minutes) = digits.split_once(':').unwrap_or((digits, "00"));
    let number = |part: &str, most: i32| {
        let is_short = matches!(part.len(), 1..=2) && part.bytes().all(|byte| byte.is_ascii_digit());
        is_short.then(|| part.parse::<i32>().ok()).flatten().filter(|number| *number <= most)
    };
    let minutes = number(hours, 14).zip(number(minutes, 59)).map(|(hours, minutes)| sign * (60 * hours + minutes));
    minutes.filter(|minutes| (-12 * 60..=14 * 60).contains(minutes)).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_read_as_people_write_them() {
        for (text, minutes) in
            [("+12:00", 720), ("12", 720), ("-3:30", -210), ("+00:00", 0), ("0", 0), ("+14:00", 840), ("-12:00", -720)]
        {
            assert_eq!(parse_offset(text), Ok(minutes), "{text}");
            assert_eq!(parse_offset(&offset_text(minutes)), Ok(minutes));
        }
        for text in ["", "+", "14:01", "-12:01", "1:60", "Pacific/Auckland", "+1:2:3", "+-1", "120", "1.5"] {
            assert!(parse_offset(text).is_err(), "{text}");
        }
    }
}
