//! One traversal as it is asked for, and the chance that follows from it.

use super::date::Date;
use super::site::Site;
use super::weather::Weather;
use crate::camera::settings::CameraSettings;
use crate::chance::{Dice, derive, derive_name};
use crate::sun::{SunPosition, sun_position};
use furrow_model::TimeSlot;

/// One run along a route. The world is that of `site` and `route` alone; everything else makes the traversal.
#[derive(Debug, Clone, PartialEq)]
pub struct Traversal {
    /// Where.
    pub site: Site,
    /// Which route of it: `main`, `vocabulary` (longer, elsewhere), or any other name: a region of its own.
    pub route: String,
    /// When it begins, to some minutes.
    pub slot: TimeSlot,
    /// On which day.
    pub date: Date,
    /// In which weather.
    pub weather: Weather,
    /// Chance of the traversal: line, speed, wind, litter, sensor noise.
    pub seed: u64,
    /// Its number among those of the slot, from 0: each begins six minutes later than the one before, with its own
    /// chance.
    pub number: u32,
    /// How far it leads, in metres; the route's length at most.
    pub length_m: f64,
    /// Columns and rows of an image, both even, from 64x36 on.
    pub size: (u32, u32),
    /// How the camera takes, stamps and delivers its images.
    pub camera: CameraSettings,
}

impl Traversal {
    /// A traversal of 30 m along the main route on the default day in clear weather at 640x360, with the camera's
    /// default settings.
    pub fn new(site: Site, slot: TimeSlot) -> Traversal {
        Traversal {
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

    /// The chance of the world: that of the site and route, the same in every traversal.
    pub fn world_seed(&self) -> u64 {
        derive_name(derive_name(0x6675_7272_6f77, &self.site.to_string()), &self.route)
    }

    /// Where the route's region lies from the site's reference point, metres east and north: the main route begins
    /// there, others lie some hundred metres off, on a ring around it. Ground truth and satellite fixes are given from
    /// the reference point.
    pub fn region_m(&self) -> [f64; 2] {
        if self.route == "main" {
            return [0.0; 2];
        }
        let mut place = Dice::of(self.world_seed(), 7);
        let angle = std::f64::consts::TAU * f64::from(place.unit());
        let far = f64::from(place.within(500.0, 900.0));
        [far * libm::cos(angle), far * libm::sin(angle)]
    }

    /// The chance of this traversal.
    pub fn traversal_seed(&self) -> u64 {
        let day = derive(derive(self.seed, self.date.days_since_epoch() as u64), u64::from(self.slot.minutes()));
        derive(derive_name(self.world_seed(), &self.weather.to_string()), derive(day, u64::from(self.number)))
    }

    /// Seconds after local midnight at which it begins: up to two minutes after the slot, and six minutes more for each
    /// number.
    pub fn start_s(&self) -> f64 {
        let late_s = f64::from(Dice::of(self.traversal_seed(), 1).within(0.0, 120.0));
        f64::from(self.slot.minutes()) * 60.0 + 360.0 * f64::from(self.number) + late_s.floor()
    }

    /// The stamp of the first frame: nanoseconds since 1970, UTC.
    pub fn start_ns(&self) -> i64 {
        let zone_s = self.site.place().zone_hours * 3600.0;
        (self.date.days_since_epoch() * 86_400 + (self.start_s() - zone_s) as i64) * 1_000_000_000
    }

    /// The sun at the start; it stands still for the minutes that follow.
    pub fn sun(&self) -> SunPosition {
        sun_position(self.site.place(), self.date.day_of_year(), self.start_s() / 3600.0)
    }
}
