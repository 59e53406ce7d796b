//! Days.

use super::bad_name::BadName;
use std::fmt;
use std::str::FromStr;

/// A day of the Gregorian calendar. Written `YYYY-MM-DD`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Date {
    year: i32,
    month: u32,
    day: u32,
}

impl Date {
    /// A day on which the sun rises about 06:00: 15 January 2026.
    pub const DEFAULT: Date = Date { year: 2026, month: 1, day: 15 };

    /// The day `day` (from 1) of `month` (from 1), where there is such a day between 1971 and 2200.
    pub fn new(year: i32, month: u32, day: u32) -> Option<Date> {
        let sound = (1971..=2200).contains(&year) && (1..=12).contains(&month);
        (sound && (1..=days_of(year, month)).contains(&day)).then_some(Date { year, month, day })
    }

    /// 1 for the first of January.
    pub fn day_of_year(self) -> u32 {
        (1..self.month).map(|month| days_of(self.year, month)).sum::<u32>() + self.day
    }

    /// Days since 1 January 1970.
    pub fn days_since_epoch(self) -> i64 {
        let years: i64 = (1970..self.year).map(|year| if leap(year) { 366 } else { 365 }).sum();
        years + i64::from(self.day_of_year()) - 1
    }
}

fn leap(year: i32) -> bool {
    (year % 4 == 0 && year % 100 != 0) || year % 400 == 0
}

fn days_of(year: i32, month: u32) -> u32 {
    match month {
        2 if leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

impl fmt::Display for Date {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}-{:02}-{:02}", self.year, self.month, self.day)
    }
}

impl FromStr for Date {
    type Err = BadName;
    fn from_str(text: &str) -> Result<Self, BadName> {
        let bad = || BadName { given: text.to_owned(), what: "date", expected: "YYYY-MM-DD, as in 2026-01-15" };
        let mut parts = text.split('-');
        let mut next = |digits: usize| {
            let part = parts.next().filter(|part| part.len() == digits && part.bytes().all(|b| b.is_ascii_digit()));
            part.and_then(|part| part.parse::<u32>().ok()).ok_or_else(bad)
        };
        let (year, month, day) = (next(4)?, next(2)?, next(2)?);
        if parts.next().is_some() {
            return Err(bad());
        }
        Date::new(year as i32, month, day).ok_or_else(bad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_count_days() {
        let date: Date = "2024-12-31".parse().expect("a date");
        assert_eq!((date.day_of_year(), date.days_since_epoch()), (366, 20_088));
        assert_eq!(Date::DEFAULT.days_since_epoch(), 20_468);
    }
}
