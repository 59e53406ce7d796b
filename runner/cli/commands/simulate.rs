use crate::progress::Bar;
use crate::{Context, Ending, Failure, print_json};
use furrow_field::campaign::{Campaign, Planned};
use furrow_field::record::{Summary, record};
use furrow_field::{CameraSettings, Date, Pass, Site, Weather};
use furrow_model::TimeSlot;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Drive a simulated robot through a simulated field and record it as a robot would.
///
/// Writes an MCAP file (ROS 2) or a ROS 1 bag, by the output's extension, with the true poses and per-frame sun and exposure beside it. The same
/// arguments give the same bytes. With --campaign, many passes are recorded out of one file; those that are there already are left alone.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow simulate --site backsburg --slot 08:00 --length 20 -o morning.mcap\n  \
furrow ingest morning.mcap --site backsburg --route main --slot 08:00 --pass experience\n\n  \
furrow simulate --campaign campaign.toml     where campaign.toml holds, for example:\n    \
folder = \"recordings\"\n    site = \"old-zoo\"\n    length_m = 40\n    [[pass]]\n    \
slots = [\"08:00\", \"10:00\"]\n    purposes = [\"experience\", \"evaluation\"]\n    [[pass]]\n    \
route = \"vocabulary\"\n    slots = [\"10:00\"]\n    purposes = [\"vocabulary\"]")]
pub struct Simulate {
    /// Record every pass of a campaign file that is not there yet.
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["site", "slot", "output"])]
    campaign: Option<PathBuf>,
    /// The site: backsburg, lindenhof or old-zoo.
    #[arg(long, required_unless_present = "campaign")]
    site: Option<Site>,
    /// The time of day, HH:MM.
    #[arg(long, required_unless_present = "campaign")]
    slot: Option<TimeSlot>,
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
    /// Stereo pairs per second.
    #[arg(long, default_value_t = CameraSettings::default().rate_hz, value_name = "HZ")]
    rate: f64,
    /// Record the raw images of distorting lenses with their calibration, instead of rectified ones.
    #[arg(long)]
    distorted: bool,
    /// Share of pairs that lose one or both images on the way, 0 to 0.5.
    #[arg(long, default_value_t = 0.0, value_name = "SHARE")]
    dropped: f64,
    /// How fast the camera's clock runs against true time, in parts per million.
    #[arg(long, default_value_t = 0.0, value_name = "PPM", allow_negative_numbers = true)]
    clock_skew: f64,
    /// How much later the right images are stamped than the left ones, in milliseconds.
    #[arg(long, default_value_t = 0.0, value_name = "MS", allow_negative_numbers = true)]
    clock_offset: f64,
    /// The recording to write.
    #[arg(short, long, value_name = "FILE.mcap|FILE.bag", required_unless_present = "campaign")]
    output: Option<PathBuf>,
}

fn size(text: &str) -> Result<(u32, u32), String> {
    let bad = || format!("'{text}' is no image size: expected COLUMNSxROWS, as in 640x360");
    let (width, height) = text.split_once('x').ok_or_else(bad)?;
    Ok((width.parse().map_err(|_| bad())?, height.parse().map_err(|_| bad())?))
}

impl Simulate {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match (&self.campaign, self.site, self.slot, &self.output) {
            (Some(file), ..) => campaign(file, context),
            (None, Some(site), Some(slot), Some(output)) => {
                let summary = recorded(&self.pass(site, slot), output, "recording the simulated field")?;
                tell(&summary, output, context)
            }
            _ => Err(Failure::new("expected --site, --slot and --output, or --campaign FILE.toml".to_owned())),
        }
    }

    fn pass(&self, site: Site, slot: TimeSlot) -> Pass {
        Pass {
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

fn recorded(pass: &Pass, output: &Path, stage: &str) -> Result<Summary, Failure> {
    let bar = Bar::units();
    let recorded = record(pass, output, &mut |done, total| bar.show(stage, done, total));
    bar.finish();
    recorded.map_err(|error| Failure::new(error.to_string()))
}

fn tell(summary: &Summary, output: &Path, context: &Context) -> Result<Ending, Failure> {
    if context.json {
        print_json(&told(summary))?;
    } else {
        eprintln!("{}", line(summary, output));
    }
    Ok(Ending::Done)
}

fn told(summary: &Summary) -> Value {
    json!({
        "files": summary.files,
        "frames": summary.frames,
        "pairs": summary.pairs,
        "length_m": summary.length_m,
        "bytes": summary.bytes,
        "first_stamp_ns": summary.stamps_ns.0,
        "last_stamp_ns": summary.stamps_ns.1,
    })
}

fn line(summary: &Summary, output: &Path) -> String {
    format!("{}: {} stereo pairs over {:.1} m", output.display(), summary.pairs, summary.length_m)
}

/// Records what a campaign lacks, and says how each of its recordings is ingested.
fn campaign(file: &Path, context: &Context) -> Result<Ending, Failure> {
    let unreadable = |error: std::io::Error| Failure::new(format!("cannot read {}: {error}", file.display()));
    let text = std::fs::read_to_string(file).map_err(unreadable)?;
    let campaign = Campaign::read(&text, file).map_err(|error| Failure::new(error.to_string()))?;
    let folder = file.parent().unwrap_or(Path::new("")).join(&campaign.folder);
    let uncreatable = |error| Failure::new(format!("cannot create {}: {error}", folder.display()));
    std::fs::create_dir_all(&folder).map_err(uncreatable)?;
    let missing = campaign.missing(&folder);
    let here = campaign.passes.len() - missing.len();
    if here > 0 {
        eprintln!("{here} of {} passes are recorded already", campaign.passes.len());
    }
    let mut summaries = Vec::new();
    for (done, planned) in missing.iter().enumerate() {
        let output = folder.join(&planned.file);
        let stage = format!("recording {} of {}: {}", done + 1, missing.len(), planned.file);
        let summary = recorded(&planned.pass, &output, &stage)?;
        eprintln!("{}", line(&summary, &output));
        summaries.push(told(&summary));
    }
    if context.json {
        let passes: Vec<Value> = campaign.passes.iter().map(|planned| described(planned, &folder)).collect();
        print_json(&json!({"recorded": summaries, "passes": passes}))?;
    } else {
        eprintln!("to ingest them:");
        campaign.passes.iter().for_each(|planned| println!("{}", ingesting(planned, &folder)));
    }
    Ok(Ending::Done)
}

fn described(planned: &Planned, folder: &Path) -> Value {
    json!({
        "file": folder.join(&planned.file), "purpose": planned.purpose, "site": planned.pass.site.to_string(),
        "route": planned.pass.route, "slot": planned.pass.slot,
    })
}

/// The command that ingests a recording, for a shell.
fn ingesting(planned: &Planned, folder: &Path) -> String {
    let Pass { site, route, slot, .. } = &planned.pass;
    let file = folder.join(&planned.file).display().to_string().replace('\'', "'\\''");
    format!("furrow ingest '{file}' --site {site} --route {route} --slot {slot} --pass {}", planned.purpose)
}
