//! `furrow simulate`: recordings of the simulated field, one or a campaign of them. Rendering belongs to
//! `furrow_field`.

mod campaign;
mod recording;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use campaign::record_campaign;
use furrow_field::{CameraSettings, Date, Site, Traversal, Weather};
use furrow_model::TimeSlot;
use recording::{print_summary, record_with_bar};
use std::path::PathBuf;

/// Record a traversal of the simulated field, as a robot would record it.
///
/// Writes an MCAP file (ROS 2) or a ROS 1 bag, by the extension of the output, and beside it the true poses and the sun
/// and exposure of each frame. Equal arguments give equal bytes. With --campaign, records all traversals of a file that
/// are not there yet, and prints the commands that ingest them.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow simulate --site backsburg --slot 08:00 --length 20 -o morning.mcap\n  \
furrow ingest morning.mcap --site backsburg --route main --slot 08:00 --purpose experience\n\n  \
furrow simulate --campaign campaign.toml     where campaign.toml holds, for example:\n    \
folder = \"recordings\"\n    site = \"old-zoo\"\n    length_m = 40\n    [[pass]]\n    \
slots = [\"08:00\", \"10:00\"]\n    purposes = [\"experience\", \"evaluation\"]\n    [[pass]]\n    \
route = \"vocabulary\"\n    slots = [\"10:00\"]\n    purposes = [\"vocabulary\"]")]
pub struct Simulate {
    /// Record every traversal of a campaign file that is not recorded yet.
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["site", "slot", "output"])]
    campaign: Option<PathBuf>,
    /// The site: backsburg, lindenhof or old-zoo.
    #[arg(long, required_unless_present = "campaign")]
    site: Option<Site>,
    /// The time of day.
    #[arg(long, required_unless_present = "campaign", value_name = "HH:MM")]
    slot: Option<TimeSlot>,
    /// The route: main, or vocabulary for other ground of the same kind.
    #[arg(long, default_value = "main")]
    route: String,
    /// The day.
    #[arg(long, default_value_t = Date::DEFAULT, value_name = "YYYY-MM-DD")]
    date: Date,
    /// Seeds the traversal: another seed is another traversal of the same world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The number of the traversal in its slot: higher ones start later, on another line.
    #[arg(long, default_value_t = 0, value_name = "N")]
    number: u32,
    /// Length of the traversal in metres.
    #[arg(long, default_value_t = 30.0, value_name = "METRES")]
    length: f64,
    /// Image size.
    #[arg(long, default_value = "640x360", value_name = "COLUMNSxROWS", value_parser = parse_size)]
    size: (u32, u32),
    /// The weather: clear, hazy, cloudy or overcast.
    #[arg(long, default_value_t = Weather::Clear)]
    weather: Weather,
    /// Stereo pairs per second.
    #[arg(long, default_value_t = CameraSettings::default().rate_hz, value_name = "HZ")]
    rate: f64,
    /// Record raw images of distorting lenses with their calibration, instead of rectified ones.
    #[arg(long)]
    distorted: bool,
    /// The share of pairs of which one or both images are lost, 0 to 0.5.
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    dropped: f64,
    /// How much faster than true time the camera's clock runs, in parts per million.
    #[arg(long, default_value_t = 0.0, value_name = "PPM", allow_negative_numbers = true)]
    clock_skew: f64,
    /// How much later than the left images the right ones are stamped, in milliseconds.
    #[arg(long, default_value_t = 0.0, value_name = "MS", allow_negative_numbers = true)]
    clock_offset: f64,
    /// The recording to write.
    #[arg(short, long, value_name = "FILE.mcap|FILE.bag", required_unless_present = "campaign")]
    output: Option<PathBuf>,
}

fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let wrong_size = || format!("'{text}' is no image size: expected COLUMNSxROWS, as in 640x360");
    let (width, height) = text.split_once('x').ok_or_else(wrong_size)?;
    Ok((width.parse().map_err(|_| wrong_size())?, height.parse().map_err(|_| wrong_size())?))
}

impl Simulate {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match (&self.campaign, self.site, self.slot, &self.output) {
            (Some(file), ..) => record_campaign(file, context)?,
            (None, Some(site), Some(slot), Some(output)) => {
                let summary = record_with_bar(&self.traversal(site, slot), output, "recording the simulated field")?;
                print_summary(&summary, output, context)?;
            }
            _ => return Err(Failure::usage("expected --site, --slot and --output, or --campaign FILE.toml")),
        }
        Ok(Ending::Done)
    }

    fn traversal(&self, site: Site, slot: TimeSlot) -> Traversal {
        Traversal {
            site,
            route: self.route.clone(),
            slot,
            date: self.date,
            weather: self.weather,
            seed: self.seed,
            number: self.number,
            length_m: self.length,
            size: self.size,
            camera: CameraSettings {
                rate_hz: self.rate,
                distorted: self.distorted,
                dropped: self.dropped,
                clock_skew_ppm: self.clock_skew,
                clock_offset_ms: self.clock_offset,
            },
        }
    }
}
