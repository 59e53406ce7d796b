//! The names that sets for place recognition give their images, as VPR-datasets-downloader writes them:
//! `@UTM_east@UTM_north@zone@letter@latitude@longitude@pano_id@tile@heading@pitch@roll@height@timestamp@note@.jpg`.
//! Fields that are not known are empty. Programs that are trained on such sets read the first two.

use super::error::ImportError;
use super::posture::{along_the_way, looking_along};
use super::truth::ImportedTruth;
use crate::folder::date_stamp_ns;
use chrono::DateTime;
use furrow_model::Se3;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What such a name says.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PlaceName {
    /// Metres east and north, in a UTM zone or in a site's own frame.
    pub utm_m: [f64; 2],
    /// The zone's number and letter, as they stand there.
    pub zone: Option<(u8, char)>,
    /// Latitude and longitude, degrees.
    pub geodetic_deg: Option<[f64; 2]>,
    /// Where the camera looks, degrees clockwise from north.
    pub heading_deg: Option<f64>,
    /// Metres above the ground or the sea.
    pub height_m: Option<f64>,
    /// When, nanoseconds since 1970.
    pub stamp_ns: Option<i64>,
}

/// Fields between the first `@` and the extension.
const FIELDS: usize = 14;

impl PlaceName {
    /// Reads a file's name.
    ///
    /// # Errors
    /// What was expected, in words.
    pub fn parse(name: &str) -> Result<Self, String> {
        let parts: Vec<&str> = name.split('@').collect();
        let fields = parts.get(1..parts.len().saturating_sub(1)).unwrap_or_default();
        if parts.first() != Some(&"") || fields.len() < 2 {
            return Err("expected a name that begins with @UTM_east@UTM_north@".to_owned());
        }
        let field = |place: usize| fields.get(place).copied().filter(|field| !field.is_empty());
        let number = |place: usize, what: &str| match field(place).map(str::parse::<f64>) {
            None => Ok(None),
            Some(Ok(number)) if number.is_finite() => Ok(Some(number)),
            Some(_) => Err(format!("expected {what} in field {} between @, found '{}'", place + 1, fields[place])),
        };
        let required = |place: usize, what: &str| {
            number(place, what)?
                .ok_or_else(|| format!("expected {what} in field {} between @, found nothing", place + 1))
        };
        let utm_m = [required(0, "UTM_east in metres")?, required(1, "UTM_north in metres")?];
        let zone = field(2).and_then(|zone| zone.parse().ok()).zip(field(3).and_then(|letter| letter.chars().next()));
        let [latitude, longitude] = [number(4, "a latitude")?, number(5, "a longitude")?];
        let (heading_deg, height_m) = (number(8, "a heading in degrees")?, number(11, "a height in metres")?);
        let exact = field(13).filter(|note| note.len() == 19).and_then(|note| note.parse().ok());
        let digits = |text: &str| text.chars().filter(char::is_ascii_digit).collect::<String>();
        let stamp_ns = exact.or_else(|| field(12).and_then(|stamp| date_stamp_ns(&digits(stamp))));
        let geodetic_deg = latitude.zip(longitude).map(|(latitude, longitude)| [latitude, longitude]);
        Ok(Self { utm_m, zone, geodetic_deg, heading_deg, height_m, stamp_ns })
    }

    /// The name of image `number`, which keeps names of one place apart. The note holds the stamp in nanoseconds, since
    /// the field `timestamp` tells seconds only.
    pub fn format(&self, number: usize, extension: &str) -> String {
        let [east, north] = self.utm_m.map(|metres| format!("{metres:010.2}"));
        let (zone, letter) =
            self.zone.map_or_else(Default::default, |(zone, letter)| (format!("{zone:02}"), letter.to_string()));
        let degrees = |place: usize, width: usize| {
            self.geodetic_deg.map_or_else(String::new, |geodetic| format!("{:0width$.5}", geodetic[place]))
        };
        let (latitude, longitude) = (degrees(0, 9), degrees(1, 10));
        let heading =
            self.heading_deg.map_or_else(String::new, |heading| format!("{:03}", heading.rem_euclid(360.0).floor()));
        let height = self.height_m.map_or_else(String::new, |metres| format!("{metres:.2}"));
        let timestamp = self.stamp_ns.map_or_else(String::new, |stamp_ns| {
            DateTime::from_timestamp_nanos(stamp_ns).format("%Y%m%d_%H%M%S").to_string()
        });
        let note = self.stamp_ns.filter(|stamp| *stamp >= 0).map_or_else(String::new, |stamp| format!("{stamp:019}"));
        let fields: [String; FIELDS] = [
            east,
            north,
            zone,
            letter,
            latitude,
            longitude,
            format!("{number:06}"),
            String::new(),
            heading,
            String::new(),
            String::new(),
            height,
            timestamp,
            note,
        ];
        format!("@{}@{extension}", fields.join("@"))
    }
}

/// The stamps of images with such names: their own where every image has one and no two the same, else a second apart.
pub(super) fn stamps_of_places(files: &[PathBuf]) -> Result<Vec<i64>, ImportError> {
    let names = files.iter().map(|path| parse_file(path)).collect::<Result<Vec<_>, _>>()?;
    let own: Option<Vec<i64>> = names.iter().map(|name| name.stamp_ns).collect();
    let is_clear = |stamps: &Vec<i64>| {
        let mut sorted = stamps.clone();
        sorted.sort_unstable();
        sorted.windows(2).all(|pair| pair[0] < pair[1]) && sorted.first().is_none_or(|first| *first >= 0)
    };
    Ok(own.filter(is_clear).unwrap_or_else(|| (0..files.len() as i64).map(|place| place * 1_000_000_000).collect()))
}

/// The poses that such names tell: where no heading is told, the camera is taken to look along the way.
pub(super) fn truth_of_places(root: &Path, images: &BTreeMap<u64, PathBuf>) -> Result<ImportedTruth, ImportError> {
    let names = images.values().map(|path| parse_file(path)).collect::<Result<Vec<_>, _>>()?;
    let positions: Vec<[f64; 3]> =
        names.iter().map(|name| [name.utm_m[0], name.utm_m[1], name.height_m.unwrap_or_default()]).collect();
    let along = along_the_way(&positions);
    let pose = |((name, position), along): ((&PlaceName, &[f64; 3]), Se3)| {
        name.heading_deg.map_or(along, |heading| {
            let (east, north) = libm::sincos(heading.to_radians());
            looking_along([east, north], *position)
        })
    };
    let poses = names.iter().zip(&positions).zip(along).map(pose);
    let stamps = images.keys().map(|stamp| stamp.cast_signed());
    Ok(ImportedTruth { path: root.to_owned(), poses: stamps.zip(poses).collect() })
}

fn parse_file(path: &Path) -> Result<PlaceName, ImportError> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    PlaceName::parse(&name).map_err(|fault| ImportError::file(path, fault))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_read_back_and_those_of_others_are_read() {
        let name = PlaceName {
            utm_m: [543_256.96, 4_178_906.7],
            zone: Some((10, 'S')),
            geodetic_deg: Some([37.756_38, -122.509_73]),
            heading_deg: Some(271.0),
            height_m: Some(12.5),
            stamp_ns: Some(1_703_250_856_123_456_789),
        };
        let text = name.format(7, ".jpg");
        assert_eq!(
            text,
            "@0543256.96@4178906.70@10@S@037.75638@-122.50973@000007@@271@@@12.50@20231222_131416@1703250856123456789@.jpg"
        );
        assert_eq!(text.matches('@').count(), FIELDS + 1);
        assert_eq!(PlaceName::parse(&text), Ok(name));
        let bare = PlaceName::parse("@0551102.21@4183141.25@10@S@@@@@@@@@201807@@.jpg").unwrap();
        assert_eq!((bare.utm_m, bare.stamp_ns, bare.heading_deg), ([551_102.21, 4_183_141.25], None, None));
        for wrong in ["0001.jpg", "@12.5.jpg", "@x@2@.jpg", "@1@@.jpg", "@1@inf@.jpg", ""] {
            assert!(PlaceName::parse(wrong).unwrap_err().contains("expected"), "{wrong}");
        }
    }
}
