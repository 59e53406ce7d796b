//! The weather, by name.

use super::bad_name::BadName;
use std::fmt;
use std::str::FromStr;

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
