//! When and what for: the slot and the purpose of a traversal.

use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;
use std::str::FromStr;

/// The time of day that a traversal stands for, to the minute, in the site's local time. Written `HH:MM`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct TimeSlot {
    minutes: u16,
}

/// A text that is no time of day.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is no time slot: expected HH:MM between 00:00 and 23:59, as in 08:00")]
pub struct BadSlot(pub String);

impl TimeSlot {
    /// Minutes since local midnight, 0 to 1439.
    pub fn minutes(self) -> u16 {
        self.minutes
    }

    /// Minutes to another time of day the shorter way around the clock, 0 to 720.
    pub fn apart_min(self, other: TimeSlot) -> u16 {
        let apart = self.minutes.abs_diff(other.minutes);
        apart.min(24 * 60 - apart)
    }

    /// The slot that an image stands for that has travelled the part `z` of the way from this slot to `target`: the
    /// nearest of the whole even hours and the two slots themselves. From 10:00 to 16:00, z = 0.33, 0.66 and 1 mimic
    /// 12:00, 14:00 and 16:00 (Church 2023, Fig. 7.11). Of two equally near ones the earlier; beyond midnight the
    /// clock goes round.
    pub fn towards(self, target: Self, z: f64) -> Self {
        let (from, to) = (f64::from(self.minutes), f64::from(target.minutes));
        let place = from + z * (to - from);
        let even = (-12..=24).map(|k| f64::from(k) * 120.0);
        let nearest = even.chain([from, to]).min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()));
        Self { minutes: (nearest.unwrap_or(from) as i32).rem_euclid(1440) as u16 }
    }

    /// Hours since local midnight.
    pub fn hours(self) -> f64 {
        f64::from(self.minutes) / 60.0
    }
}

impl fmt::Display for TimeSlot {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}:{:02}", self.minutes / 60, self.minutes % 60)
    }
}

impl FromStr for TimeSlot {
    type Err = BadSlot;
    fn from_str(text: &str) -> Result<Self, BadSlot> {
        let bad = || BadSlot(text.to_owned());
        let (hours, minutes) = text.split_once(':').ok_or_else(bad)?;
        let two_digits = |part: &str| part.len() == 2 && part.bytes().all(|b| b.is_ascii_digit());
        if !two_digits(hours) || !two_digits(minutes) {
            return Err(bad());
        }
        let hours: u16 = hours.parse().map_err(|_| bad())?;
        let minutes: u16 = minutes.parse().map_err(|_| bad())?;
        (hours < 24 && minutes < 60).then_some(Self { minutes: hours * 60 + minutes }).ok_or_else(bad)
    }
}

impl Serialize for TimeSlot {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for TimeSlot {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

/// What a traversal is for. No images of one purpose may serve another: that is the leakage guard's rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Purpose {
    /// Becomes an experience to localise against.
    Experience,
    /// Plays the robot, against experiences.
    Evaluation,
    /// Trains codebooks.
    Vocabulary,
}

impl Purpose {
    /// All purposes, in order.
    pub const ALL: [Purpose; 3] = [Purpose::Experience, Purpose::Evaluation, Purpose::Vocabulary];
}

impl fmt::Display for Purpose {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Purpose::Experience => "experience",
            Purpose::Evaluation => "evaluation",
            Purpose::Vocabulary => "vocabulary",
        })
    }
}

impl FromStr for Purpose {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        Purpose::ALL
            .into_iter()
            .find(|purpose| purpose.to_string() == text)
            .ok_or_else(|| format!("'{text}' is no purpose: expected experience, evaluation or vocabulary"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Domainnesses and the slots they mimic in the figures of Church 2023: 7.11, 7.10 and 7.13.
    #[test]
    fn parts_of_the_way_mimic_the_slots_of_the_thesis() {
        let check = |from: &str, to: &str, expected: &[(f64, &str)]| {
            let (from, to): (TimeSlot, TimeSlot) = (from.parse().unwrap(), to.parse().unwrap());
            for (z, slot) in expected {
                assert_eq!(from.towards(to, *z).to_string(), *slot, "{from} to {to} at {z}");
            }
        };
        check("10:00", "16:00", &[(0.0, "10:00"), (0.33, "12:00"), (0.66, "14:00"), (1.0, "16:00")]);
        check("10:00", "04:30", &[(0.33, "08:00"), (0.66, "06:00"), (1.0, "04:30")]);
        let day =
            [(0.165, "06:00"), (0.33, "08:00"), (0.495, "10:00"), (0.66, "12:00"), (0.825, "14:00"), (1.0, "16:00")];
        check("04:30", "16:00", &day);
        check("23:00", "22:00", &[(2.0, "20:00")]);
        check("23:00", "23:59", &[(2.0, "00:00")]);
    }

    #[test]
    fn slots_read_back_and_others_are_refused() {
        for text in ["00:00", "04:30", "08:00", "23:59"] {
            assert_eq!(text.parse::<TimeSlot>().map(|slot| slot.to_string()), Ok(text.to_owned()));
        }
        for text in ["", "8:00", "24:00", "08:60", "0800", "08:00:00", "+8:00"] {
            assert!(text.parse::<TimeSlot>().is_err(), "{text}");
        }
    }
}
