//! Digits of a file name as a frame number or as a moment, by how many they are.

use chrono::NaiveDate;

/// What digits say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    /// A frame number.
    Frame(u64),
    /// A moment, nanoseconds since 1970, or since the camera was switched on.
    Stamp(i64),
}

/// Frame numbers have at most so many digits, leading zeros aside: a camera counts that far in a month.
const FRAME_DIGITS: usize = 8;
/// Moments lie from 2001-09-09, from when on seconds since 1970 have ten digits …
const FIRST_S: i64 = 1_000_000_000;
/// … to the year 2100.
const LAST_S: i64 = 4_102_444_800;
/// Clocks that count from power-on are taken for less than three years.
const MOST_UPTIME_S: i64 = 100_000_000;
const NS: i64 = 1_000_000_000;

/// Reads one run of digits; the error says what was expected of so many.
pub(super) fn read_digits(digits: &str) -> Result<Reading, String> {
    let significant = digits.trim_start_matches('0');
    let is_padded = digits.len() > 1 && digits.starts_with('0');
    if significant.len() <= FRAME_DIGITS && (is_padded || digits.len() <= FRAME_DIGITS) {
        return Ok(Reading::Frame(significant.parse().unwrap_or(0)));
    }
    let scale = match digits.len() {
        10 => NS,
        13 => 1_000_000,
        16 => 1_000,
        19 => 1,
        14 | 17 | 20 | 23 => {
            let no_date = || format!("{digits} is no date and time YYYYMMDDhhmmss of the years 1990 to 2100");
            return date_ns(digits).map(Reading::Stamp).ok_or_else(no_date);
        }
        length => {
            return Err(format!(
                "a number of {length} digits is neither a frame number (at most {FRAME_DIGITS} digits) nor a stamp: \
                 10 digits are seconds since 1970, 13 milliseconds, 16 microseconds, 19 nanoseconds, and 14 or 17 a \
                 date YYYYMMDDhhmmss with or without milliseconds"
            ));
        }
    };
    let stamp = digits.parse::<i64>().ok().and_then(|number| number.checked_mul(scale));
    let stamp = stamp.filter(|stamp_ns| (FIRST_S..LAST_S).contains(&(stamp_ns / NS)));
    stamp.map(Reading::Stamp).ok_or_else(|| {
        let unit = match scale {
            NS => "seconds",
            1_000_000 => "milliseconds",
            1_000 => "microseconds",
            _ => "nanoseconds",
        };
        format!("{digits} is no moment of the years 2001 to 2100 in {unit} since 1970")
    })
}

/// Whole seconds and a decimal fraction, as in 1700000000.250000.
pub(super) fn decimal_ns(seconds: &str, fraction: &str) -> Option<i64> {
    if fraction.len() > 9 {
        return None;
    }
    let seconds_ns = seconds.parse::<i64>().ok()?.checked_mul(NS)?;
    let is_plausible = (FIRST_S..LAST_S).contains(&(seconds_ns / NS)) || seconds_ns / NS < MOST_UPTIME_S;
    let fraction_ns = format!("{fraction:0<9}").parse::<i64>().ok()?;
    seconds_ns.checked_add(fraction_ns).filter(|_| is_plausible)
}

/// `YYYYMMDDhhmmss` and three, six or nine digits of a second, in UTC; `None` where there is no such moment.
pub(crate) fn date_ns(digits: &str) -> Option<i64> {
    if !matches!(digits.len(), 14 | 17 | 20 | 23) {
        return None;
    }
    let field = |from: usize, to: usize| digits.get(from..to)?.parse::<i64>().ok();
    let days = days_of(digits.get(..8)?)?;
    let (hour, minute, second) = (field(8, 10)?, field(10, 12)?, field(12, 14)?);
    let fraction_ns = format!("{:0<9}", digits.get(14..)?).parse::<i64>().ok()?;
    let seconds = days * 86_400 + hour * 3_600 + minute * 60 + second;
    (hour < 24 && minute < 60 && second < 60).then_some(seconds * NS + fraction_ns)
}

/// Days since 1970 of a date `YYYYMMDD` of the years 1990 to 2099.
pub(super) fn days_of(digits: &str) -> Option<i64> {
    let field = |from: usize, to: usize| digits.get(from..to)?.parse::<u32>().ok();
    let year = field(0, 4).filter(|year| digits.len() == 8 && (1990..2100).contains(year))?;
    let date = NaiveDate::from_ymd_opt(year.cast_signed(), field(4, 6)?, field(6, 8)?)?;
    // The default date is the first of January 1970.
    Some(date.signed_duration_since(NaiveDate::default()).num_days())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_by_their_number() {
        let stamp = |digits: &str| read_digits(digits).unwrap();
        assert_eq!(stamp("1418381798"), Reading::Stamp(1_418_381_798 * NS));
        assert_eq!(stamp("1418381798086"), Reading::Stamp(1_418_381_798_086_000_000));
        assert_eq!(stamp("1418381798086398"), Reading::Stamp(1_418_381_798_086_398_000));
        assert_eq!(stamp("1418381798086398123"), Reading::Stamp(1_418_381_798_086_398_123));
        // As `date -u -d '2024-06-12 10:15:30' +%s` says.
        assert_eq!(stamp("20240612101530"), Reading::Stamp(1_718_187_330 * NS));
        assert_eq!(stamp("20240612101530125"), Reading::Stamp(1_718_187_330 * NS + 125_000_000));
        for (digits, number) in [("0", 0), ("7", 7), ("000012", 12), ("0000000123", 123), ("12345678", 12_345_678)] {
            assert_eq!(stamp(digits), Reading::Frame(number));
        }
        let long = "9".repeat(400);
        for digits in [
            "123456789",
            "9999999999",
            "12345678901",
            "123456789012",
            "9999999999999",
            "20241312101530",
            "20230229101530",
            "20240612251530",
            "999999999999999",
            "9999999999999999",
            "123456789012345678",
            "9999999999999999999",
            "18446744073709551616",
            "0123456789012",
            &long,
        ] {
            assert!(read_digits(digits).is_err(), "{digits}");
        }
    }

    #[test]
    fn every_day_follows_the_one_before() {
        // 1990-01-01, as `date -u -d 1990-01-01 +%s` divided by 86400.
        let mut expected = 7_305;
        for date in 19_900_101..21_000_101 {
            if let Some(days) = days_of(&date.to_string()) {
                assert_eq!(days, expected, "{date}");
                expected += 1;
            }
        }
        // Up to 2100-01-01.
        assert_eq!(expected, 47_482);
    }

    #[test]
    fn decimal_seconds() {
        assert_eq!(decimal_ns("1700000000", "25"), Some(1_700_000_000_250_000_000));
        assert_eq!(decimal_ns("12", "000000001"), Some(12_000_000_001));
        assert_eq!(decimal_ns("500000000", "0"), None);
        assert_eq!(decimal_ns("99999999999999999999", "0"), None);
        assert_eq!(decimal_ns("1700000000", "1234567890"), None);
    }
}
