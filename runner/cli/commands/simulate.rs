use crate::progress::Bar;
use crate::{Context, Ending, Failure, print_json};
use furrow_field::record::record;
use furrow_field::{Date, Pass, Site, Weather};
use furrow_model::TimeSlot;
use std::path::PathBuf;

/// Drive a simulated robot through a simulated field and record it as a robot would.
///
/// Writes an MCAP file (ROS 2) or a ROS 1 bag, by the output's extension, with the true poses and per-frame sun and exposure beside it. The same
/// arguments give the same bytes.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow simulate --site backsburg --slot 08:00 --length 20 -o morning.mcap\n  \
furrow ingest morning.mcap --site backsburg --route main --slot 08:00 --pass experience")]
pub struct Simulate {
    /// The site: backsburg, lindenhof or old-zoo.
    #[arg(long)]
    site: Site,
    /// The time of day, HH:MM.
    #[arg(long)]
    slot: TimeSlot,
    /// The route: main, or vocabulary for other ground of the same kind.
    #[arg(long, default_value = "main")]
    route: String,
    /// The day, YYYY-MM-DD.
    #[arg(long, default_value_t = Date::DEFAULT)]
    date: Date,
    /// Seeds the drive: another seed is another pass through the same world.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The pass of that slot: later ones start later, on another line.
    #[arg(long, default_value_t = 0, value_name = "N")]
    number: u32,
    /// Metres to drive.
    #[arg(long, default_value_t = 30.0)]
    length: f64,
    /// Image size, COLUMNSxROWS.
    #[arg(long, default_value = "640x360", value_parser = size)]
    size: (u32, u32),
    /// The weather: clear, hazy, cloudy or overcast.
    #[arg(long, default_value_t = Weather::Clear)]
    weather: Weather,
    /// The recording to write.
    #[arg(short, long, value_name = "FILE.mcap|FILE.bag")]
    output: PathBuf,
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let bad = || format!("'{text}' is no image size: expected COLUMNSxROWS, as in 640x360");
    let (width, height) = text.split_once('x').ok_or_else(bad)?;
    Ok((width.parse().map_err(|_| bad())?, height.parse().map_err(|_| bad())?))
}

impl Simulate {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let pass = Pass {
            site: self.site,
            route: self.route,
            slot: self.slot,
            date: self.date,
            weather: self.weather,
            seed: self.seed,
            number: self.number,
            length_m: self.length,
            size: self.size,
        };
        let bar = Bar::units();
        let recorded =
            record(&pass, &self.output, &mut |done, total| bar.show("recording the simulated field", done, total));
        bar.finish();
        let summary = recorded.map_err(|error| Failure::new(error.to_string()))?;
        if context.json {
            print_json(&serde_json::json!({
                "files": summary.files,
                "pairs": summary.pairs,
                "length_m": summary.length_m,
                "bytes": summary.bytes,
                "first_stamp_ns": summary.stamps_ns.0,
                "last_stamp_ns": summary.stamps_ns.1,
            }))?;
        } else {
            let (file, pairs, length) = (self.output.display(), summary.pairs, summary.length_m);
            eprintln!("{file}: {pairs} stereo pairs over {length:.1} m");
        }
        Ok(Ending::Done)
    }
}
