//! What is to be driven: a pass over a route of a site, at a time, in some weather.

pub mod check;
mod description;

use crate::camera::settings::CameraSettings;
use crate::chance::{Dice, derive, derive_name};
use crate::sun::{Place, SunPosition, sun_position};
use furrow_model::TimeSlot;
use std::fmt;
use std::str::FromStr;

/// The three sites of the thesis, as worlds of our own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Site {
    /// Open rows of blueberry bushes under a net, 104.7 m.
    Backsburg,
    /// Road, a dark dense nectarine row of 110 m, road: 157.8 m.
    Lindenhof,
    /// A loop of about 210 m on tarred paths through trees, past walls and cages.
    OldZoo,
}

impl Site {
    /// All sites.
    pub const ALL: [Site; 3] = [Site::Backsburg, Site::Lindenhof, Site::OldZoo];

    /// Where the site lies; the sun of SPEC 8.1 is that of all three.
    pub fn place(self) -> Place {
        Place { latitude_deg: -33.95, longitude_deg: 18.46, zone_hours: 2.0 }
    }
}

impl fmt::Display for Site {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Site::Backsburg => "backsburg",
            Site::Lindenhof => "lindenhof",
            Site::OldZoo => "old-zoo",
        })
    }
}

/// A text that names none of the things it should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{given}' is no {what}: expected {expected}")]
pub struct BadName {
    given: String,
    what: &'static str,
    expected: &'static str,
}

impl FromStr for Site {
    type Err = BadName;
    fn from_str(text: &str) -> Result<Self, BadName> {
        Site::ALL.into_iter().find(|site| site.to_string() == text).ok_or_else(|| BadName {
            given: text.to_owned(),
            what: "site",
            expected: "backsburg, lindenhof or old-zoo",
        })
    }
}

/// What stands between the sun and the field.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Weather {
    /// Blue sky, hard shadows, a few thin clouds.
    Clear,
    /// Thin high cloud: softer light.
    Hazy,
    /// Scattered clouds, the sun mostly out.
    Cloudy,
    /// Closed cloud: no shadows.
    Overcast,
}

impl Weather {
    /// All weathers.
    pub const ALL: [Weather; 4] = [Weather::Clear, Weather::Hazy, Weather::Cloudy, Weather::Overcast];
}

impl fmt::Display for Weather {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Weather::Clear => "clear",
            Weather::Hazy => "hazy",
            Weather::Cloudy => "cloudy",
            Weather::Overcast => "overcast",
        })
    }
}

impl FromStr for Weather {
    type Err = BadName;
    fn from_str(text: &str) -> Result<Self, BadName> {
        Weather::ALL.into_iter().find(|weather| weather.to_string() == text).ok_or_else(|| BadName {
            given: text.to_owned(),
            what: "weather",
            expected: "clear, hazy, cloudy or overcast",
        })
    }
}

/// A day of the Gregorian calendar. Written `YYYY-MM-DD`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Date {
    year: i32,
    month: u32,
    day: u32,
}

impl Date {
    /// The day on which 06:00 is sunrise: 15 January 2026 (SPEC 8.1).
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

/// One drive along a route. The world is that of `site` and `route` alone; everything else makes the drive.
#[derive(Debug, Clone, PartialEq)]
pub struct Pass {
    /// Where.
    pub site: Site,
    /// Which route of it: `main`, `vocabulary` (longer, elsewhere), or any other name: a region of its own.
    pub route: String,
    /// When the outing sets out, to some minutes.
    pub slot: TimeSlot,
    /// On which day.
    pub date: Date,
    /// In which weather.
    pub weather: Weather,
    /// Chance of the drive: line, speed, wind, litter, sensor noise.
    pub seed: u64,
    /// The how-manieth pass of the slot, from 0: sets out six minutes later than the one before, with its own chance.
    pub number: u32,
    /// How far to drive, in metres; the route's length at most.
    pub length_m: f64,
    /// Columns and rows of an image, both even, from 64x36 on.
    pub size: (u32, u32),
    /// How the camera takes, stamps and delivers its images.
    pub camera: CameraSettings,
}

impl Pass {
    /// A pass of 30 m over the main route on the default day in clear weather at 640x360, with the camera's default settings.
    pub fn new(site: Site, slot: TimeSlot) -> Pass {
        Pass {
            site,
            route: "main".to_owned(),
            slot,
            date: Date::DEFAULT,
            weather: Weather::Clear,
            seed: 1,
            number: 0,
            length_m: 30.0,
            size: (640, 360),
            camera: CameraSettings::default(),
        }
    }

    /// The chance of the world: that of the site and route, the same in every pass.
    pub fn world_seed(&self) -> u64 {
        derive_name(derive_name(0x6675_7272_6f77, &self.site.to_string()), &self.route)
    }

    /// Where the route's region lies from the site's reference point, metres east and north: the main route begins there, others lie some
    /// hundred metres off, on a ring around it. Ground truth and satellite fixes are given from the reference point.
    pub fn region_m(&self) -> [f64; 2] {
        if self.route == "main" {
            return [0.0; 2];
        }
        let mut place = Dice::of(self.world_seed(), 7);
        let angle = std::f64::consts::TAU * f64::from(place.unit());
        let far = f64::from(place.within(500.0, 900.0));
        [far * libm::cos(angle), far * libm::sin(angle)]
    }

    /// The chance of this drive.
    pub fn drive_seed(&self) -> u64 {
        let day = derive(derive(self.seed, self.date.days_since_epoch() as u64), u64::from(self.slot.minutes()));
        derive(derive_name(self.world_seed(), &self.weather.to_string()), derive(day, u64::from(self.number)))
    }

    /// Seconds after local midnight at which the drive sets out: up to 7 minutes after the slot, and 16 more per pass number.
    pub fn start_s(&self) -> f64 {
        let late_s = f64::from(Dice::of(self.drive_seed(), 1).within(0.0, 120.0));
        f64::from(self.slot.minutes()) * 60.0 + 360.0 * f64::from(self.number) + late_s.floor()
    }

    /// The stamp of the first frame: nanoseconds since 1970, UTC.
    pub fn start_ns(&self) -> i64 {
        let zone_s = self.site.place().zone_hours * 3600.0;
        (self.date.days_since_epoch() * 86_400 + (self.start_s() - zone_s) as i64) * 1_000_000_000
    }

    /// The sun at the start of the drive; it stands still for the minutes that follow.
    pub fn sun(&self) -> SunPosition {
        sun_position(self.site.place(), self.date.day_of_year(), self.start_s() / 3600.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_read_back_and_others_are_refused() {
        for site in Site::ALL {
            assert_eq!(site.to_string().parse(), Ok(site));
        }
        for weather in Weather::ALL {
            assert_eq!(weather.to_string().parse(), Ok(weather));
        }
        let error = "Old Zoo".parse::<Site>().expect_err("no such site").to_string();
        assert_eq!(error, "'Old Zoo' is no site: expected backsburg, lindenhof or old-zoo");
        for text in ["2026-02-29", "2026-1-15", "2026-13-01", "15-01-2026", "2026-01-15-1", ""] {
            assert!(text.parse::<Date>().is_err(), "{text}");
        }
    }

    #[test]
    fn dates_count_days() {
        let date: Date = "2024-12-31".parse().expect("a date");
        assert_eq!((date.day_of_year(), date.days_since_epoch()), (366, 20_088));
        assert_eq!(Date::DEFAULT.days_since_epoch(), 20_468);
    }
}
