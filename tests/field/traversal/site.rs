//! The sites, by name.

use super::bad_name::BadName;
use crate::sun::Place;
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

    /// Where the site lies; one sun shines on all three, that of Cape Town.
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
