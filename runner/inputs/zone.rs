//! The day at a site: what is known of its clocks. No id depends on it.

use crate::RunError;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Catalog, tables};
use furrow_model::{TimeSlot, is_satellite_fix};

/// What is known of a site's clocks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SiteClock {
    /// They are so many minutes ahead of UTC, as the user said.
    Given(i32),
    /// They are about so many minutes ahead: the sun is, at the longitude of the satellite fixes.
    Estimated(i32),
    /// Nothing: the slot alone tells how far they are ahead, but for whole days.
    Unknown,
}

/// The middle of what clocks are ahead of UTC where people live, in minutes: from Hawaii, at -10 h, to New Zealand's
/// summer, at +13 h, with half an hour to spare for a traversal that began before or after its slot.
const MIDDLE_MIN: i64 = 90;
const DAY_MIN: i64 = 24 * 60;

impl SiteClock {
    /// What is known of the clocks where a traversal was driven.
    ///
    /// # Errors
    /// Where the store cannot be read.
    pub fn of(catalog: &Catalog, traversal: &TraversalRecord) -> Result<Self, RunError> {
        if let Some(minutes) = catalog.utc_offset_min(&traversal.site)? {
            return Ok(Self::Given(minutes));
        }
        let place = first_fix_deg(catalog, traversal)?;
        Ok(place.map_or(Self::Unknown, |[_, degrees]| Self::Estimated((degrees / 15.0).round() as i32 * 60)))
    }

    /// The day of a stamp (UTC) as the clocks show it. A slot is a time of day there: where the user said nothing, the
    /// clocks show about `slot` at that moment.
    pub fn day(self, stamp_ns: i64, slot: TimeSlot) -> String {
        let utc_s = stamp_ns.div_euclid(1_000_000_000);
        let ahead_s = match self {
            Self::Given(minutes) => i64::from(minutes) * 60,
            Self::Estimated(minutes) => by_slot_s(utc_s, slot, minutes.into()),
            Self::Unknown => by_slot_s(utc_s, slot, MIDDLE_MIN),
        };
        let local = utc_s.checked_add(ahead_s).and_then(|local_s| chrono::DateTime::from_timestamp(local_s, 0));
        local.map_or_else(|| "no date".to_owned(), |local| local.format("%Y-%m-%d").to_string())
    }
}

/// How far clocks are ahead of UTC that show `slot` at this moment, in seconds: within half a day of `about_min`.
fn by_slot_s(utc_s: i64, slot: TimeSlot, about_min: i64) -> i64 {
    let (day_s, from_s) = (DAY_MIN * 60, (about_min - DAY_MIN / 2) * 60);
    (i64::from(slot.minutes()) * 60 - utc_s.rem_euclid(day_s) - from_s).rem_euclid(day_s) + from_s
}

/// Latitude and longitude of a traversal's first satellite fix, degrees north and east; `None` where it has none.
pub(crate) fn first_fix_deg(catalog: &Catalog, traversal: &TraversalRecord) -> Result<Option<[f64; 2]>, RunError> {
    for part in traversal.sensors.iter().filter(|sensor| sensor.kind == "nav_sat_fix").flat_map(|sensor| &sensor.parts)
    {
        let table = tables::from_parquet("satellite fixes", catalog.objects().read(*part)?)?;
        let [status, latitude, longitude] =
            ["status", "latitude_deg", "longitude_deg"].map(|name| tables::f64s(&table, name));
        let rows = status?.into_iter().zip(latitude?).zip(longitude?);
        let is_fix =
            |&((status, latitude), longitude): &((f64, f64), f64)| is_satellite_fix(status, latitude, longitude);
        if let Some(((_, latitude_deg), longitude_deg)) = rows.into_iter().find(is_fix) {
            return Ok(Some([latitude_deg, longitude_deg]));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2026-01-15 at this time of day in UTC.
    fn stamp_ns(time: &str) -> i64 {
        (1_768_435_200 + i64::from(slot(time).minutes()) * 60) * 1_000_000_000
    }

    fn slot(text: &str) -> TimeSlot {
        text.parse().unwrap()
    }

    #[test]
    fn a_day_is_the_one_on_the_wall_where_the_robot_drives() {
        let day = |utc: &str, slot_there: &str| SiteClock::Unknown.day(stamp_ns(utc), slot(slot_there));
        // 22:03 UTC is 00:03 of the next day in Stellenbosch, and 14:03 of the same one in California.
        assert_eq!(day("22:03", "00:00"), "2026-01-16");
        assert_eq!(day("22:03", "14:00"), "2026-01-15");
        assert_eq!(day("22:03", "22:00"), "2026-01-15");
    }

    #[test]
    fn every_inhabited_zone_has_its_own_day() {
        // An outing at any time of day, up to half an hour about its slot, at any whole hour of zones.
        for zone_min in (-10 * 60..=13 * 60).step_by(30) {
            for local_min in (0..24 * 60).step_by(17) {
                for slot_min in [local_min - 29, local_min, local_min + 29] {
                    let (day, local) = (1_768_435_200 / 60, i64::from(local_min));
                    let stamp_ns = (day + local - zone_min) * 60_000_000_000;
                    let slot_min = i64::from(slot_min).rem_euclid(DAY_MIN);
                    let slot = slot(&format!("{:02}:{:02}", slot_min / 60, slot_min % 60));
                    // A slot on the other side of midnight belongs to the neighbouring day unless the zone is given.
                    let given = SiteClock::Given(zone_min as i32).day(stamp_ns, slot);
                    assert_eq!(given, "2026-01-15", "{zone_min} {local_min}");
                    if (29..24 * 60 - 29).contains(&local_min) {
                        assert_eq!(SiteClock::Unknown.day(stamp_ns, slot), given, "{zone_min} {local_min} {slot}");
                        // The sun is up to three hours from the clocks.
                        let estimated = SiteClock::Estimated(zone_min as i32 - 180);
                        assert_eq!(estimated.day(stamp_ns, slot), given, "{zone_min} {local_min} {slot}");
                    }
                }
            }
        }
    }

    #[test]
    fn satellite_fixes_and_users_tell_what_the_slot_cannot() {
        // 08:00 at UTC+14 in Kiribati, 18:00 of the day before in UTC; without a word it would be Hawaii's.
        let day = |clock: SiteClock| clock.day(stamp_ns("18:00"), slot("08:00"));
        assert_eq!(day(SiteClock::Unknown), "2026-01-15");
        assert_eq!(day(SiteClock::Given(14 * 60)), "2026-01-16");
        // 08:00 at UTC-11 in Samoa is 19:00 UTC, east and west of the date line.
        assert_eq!(SiteClock::Estimated(-11 * 60).day(stamp_ns("19:00"), slot("08:00")), "2026-01-15");
        assert_eq!(SiteClock::Estimated(12 * 60).day(stamp_ns("19:00"), slot("08:00")), "2026-01-16");
        assert_eq!(SiteClock::Given(14 * 60).day(i64::MAX, slot("08:00")), "2262-04-12");
    }
}
