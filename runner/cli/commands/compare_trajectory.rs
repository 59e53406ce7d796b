use super::chosen;
use crate::{Context, Ending, Failure, print, print_json};
use clap::ValueEnum;
use furrow_catalog::tables;
use furrow_ingest::odometry::compare::{
    Alignment, Delta, LengthError, Spread, Track, align, associate, errors_per_length, position_errors, step_errors,
};
use furrow_model::Se3;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Say how far a trajectory strays from a reference: absolute (APE) and relative errors (RPE) as evo defines them, and KITTI's errors per length.
///
/// Files are in TUM's form (seconds tx ty tz qx qy qz qw) or in KITTI's (twelve numbers a row). Poses are matched by their stamps, or by
/// their place in the file where one of the two has no stamps.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow compare-trajectory morning.groundtruth.tum 3fa8\n  furrow compare-trajectory truth.tum estimate.tum --align none --delta-m 5"
)]
pub struct CompareTrajectory {
    /// The truth: a file.
    reference: String,
    /// What is judged: a file, or a traversal of the store by the beginning of its id.
    estimate: String,
    /// How the estimate is laid over the reference before absolute errors are taken.
    #[arg(long, value_enum, default_value = "rigid")]
    align: Align,
    /// Stamps that differ by more belong to different moments, in seconds.
    #[arg(long, value_name = "S", default_value_t = 0.01)]
    max_difference: f64,
    /// Poses between the two ends of a relative error.
    #[arg(long, value_name = "POSES", default_value_t = 1, conflicts_with = "delta_m")]
    delta: usize,
    /// Metres along the estimate between the two ends of a relative error.
    #[arg(long, value_name = "M")]
    delta_m: Option<f64>,
    /// Lengths of KITTI's stretches in metres; those longer than the track are left out.
    #[arg(long, value_name = "M,M,...", value_delimiter = ',', default_values_t = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0])]
    lengths: Vec<f64>,
}

/// How tracks are laid over each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Align {
    /// As they are.
    None,
    /// First pose on first pose.
    First,
    /// Rotation and shift of least squared distance.
    Rigid,
    /// The same with a factor on lengths.
    Scaled,
}

impl CompareTrajectory {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if !self.lengths.iter().copied().all(positive) || self.delta == 0 || !self.delta_m.is_none_or(positive) {
            return Err(Failure::usage("--lengths, --delta and --delta-m must be greater than zero"));
        }
        if self.max_difference.is_nan() || self.max_difference < 0.0 {
            return Err(Failure::usage("--max-difference must be zero or more seconds"));
        }
        let reference = read(&self.reference)?;
        let estimate = self.estimate(context)?;
        let (truth, found) = self.matched(&reference, &estimate)?;
        let (aligned, scale) = align(&truth, &found, self.align.into()).ok_or_else(|| {
            Failure::new("the positions lie on a line, so no rotation fits best: use --align first or --align none")
        })?;
        let delta = self.delta_m.map_or(Delta::Frames(self.delta), Delta::Metres);
        let (absolute, relative) = (position_errors(&truth, &aligned), step_errors(&truth, &found, delta));
        let report = Report {
            poses: truth.len(),
            scale,
            ape_m: Spread::of(&absolute.translation_m),
            ape_deg: Spread::of(&absolute.rotation_deg),
            rpe_m: Spread::of(&relative.translation_m),
            rpe_deg: Spread::of(&relative.rotation_deg),
            lengths: errors_per_length(&truth, &found, &self.lengths),
        };
        if context.json {
            print_json(&json!({
                "reference": self.reference, "estimate": self.estimate, "report": report,
                "reference_poses": reference.poses.len(), "estimate_poses": estimate.poses.len(),
            }))?;
        } else {
            print(&report.table(&reference, &estimate))?;
        }
        Ok(Ending::Done)
    }

    fn estimate(&self, context: &Context) -> Result<Track, Failure> {
        if Path::new(&self.estimate).exists() {
            return read(&self.estimate);
        }
        let catalog = context.catalog().map_err(|error| {
            Failure::new(format!("{}: no such file, and no store to look for a traversal in: {error}", self.estimate))
        })?;
        let id = chosen("traversal", &self.estimate, catalog.traversals()?.into_iter().map(|row| row.id))?;
        let chain = catalog.traversal(id)?.chain;
        Ok(Track::of_chain(&tables::chain_from_parquet(catalog.objects().read(chain)?)?))
    }

    /// The poses that belong together.
    fn matched(&self, reference: &Track, estimate: &Track) -> Result<(Vec<Se3>, Vec<Se3>), Failure> {
        let (a, b) = (&reference.poses, &estimate.poses);
        let pairs = match (&reference.stamps_s, &estimate.stamps_s) {
            (Some(a), Some(b)) => associate(a, b, self.max_difference),
            _ if a.len() == b.len() => (0..a.len()).map(|i| (i, i)).collect(),
            _ => {
                return Err(Failure::new(format!(
                    "{} has {} poses and {} has {}, and not both have stamps: give both in TUM's form",
                    self.reference,
                    a.len(),
                    self.estimate,
                    b.len()
                )));
            }
        };
        if pairs.len() < 3 {
            return Err(Failure::new(format!(
                "only {} poses of {} and {} have stamps within {} s of each other, three are needed: are both by the same clock? \
                 --max-difference allows more",
                pairs.len(),
                self.reference,
                self.estimate,
                self.max_difference
            )));
        }
        Ok(pairs.into_iter().map(|(i, j)| (a[i], b[j])).unzip())
    }
}

fn read(path: &str) -> Result<Track, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::new(format!("{path}: {error}")))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::new(format!("{path}: byte {at} is no text: expected a trajectory in TUM's or KITTI's form"))
    })?;
    Track::parse(&text).map_err(|error| Failure::new(format!("{path}: {error}")))
}

impl From<Align> for Alignment {
    fn from(align: Align) -> Alignment {
        match align {
            Align::None => Alignment::None,
            Align::First => Alignment::First,
            Align::Rigid => Alignment::Rigid,
            Align::Scaled => Alignment::Scaled,
        }
    }
}

#[derive(serde::Serialize)]
struct Report {
    poses: usize,
    scale: f64,
    ape_m: Option<Spread>,
    ape_deg: Option<Spread>,
    rpe_m: Option<Spread>,
    rpe_deg: Option<Spread>,
    lengths: Vec<LengthError>,
}

impl Report {
    fn table(&self, reference: &Track, estimate: &Track) -> String {
        let mut text = format!(
            "{} poses compared (reference {}, estimate {}), scale {:.5}\n\n{:<10}{:>10}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
            self.poses,
            reference.poses.len(),
            estimate.poses.len(),
            self.scale,
            "",
            "rmse",
            "mean",
            "median",
            "std",
            "min",
            "max"
        );
        let rows = [("APE m", self.ape_m), ("APE deg", self.ape_deg), ("RPE m", self.rpe_m), ("RPE deg", self.rpe_deg)];
        for (name, spread) in rows {
            let Some(s) = spread else { continue };
            let Spread { rmse, mean, median, std, min, max, .. } = s;
            let _ = writeln!(text, "{name:<10}{rmse:>10.4}{mean:>10.4}{median:>10.4}{std:>10.4}{min:>10.4}{max:>10.4}");
        }
        if !self.lengths.is_empty() {
            let _ = writeln!(text, "\n{:<10}{:>12}{:>12}{:>12}", "length m", "drift %", "deg per m", "stretches");
        }
        for error in &self.lengths {
            let (percent, turn) = (100.0 * error.translation, error.rotation_deg_per_m);
            let _ = writeln!(text, "{:<10}{percent:>12.3}{turn:>12.4}{:>12}", error.length_m, error.count);
        }
        text
    }
}
