use crate::choosing::choose_traversal;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use clap::ValueEnum;
use furrow_catalog::tables;
use furrow_ingest::odometry::compare::{
    Alignment, Delta, LengthError, Spread, Track, align, associate, errors_per_length, position_errors, step_errors,
};
use furrow_model::Se3;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// Measure the errors of a trajectory: absolute (APE) and relative (RPE) as evo does, and KITTI's drift per length.
///
/// Files are in TUM form (seconds tx ty tz qx qy qz qw) or KITTI form (twelve numbers a row). Poses are matched by
/// their stamps, or by their number in the file if one of the two files has no stamps.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow compare-trajectory morning.groundtruth.tum 3fa8\n  furrow compare-trajectory truth.tum estimate.tum --align scaled --delta-m 5 --json"
)]
pub struct CompareTrajectory {
    /// The true trajectory: a file.
    reference: String,
    /// The estimated trajectory: a file, or a traversal of the store by the beginning of its id.
    estimate: String,
    /// How the estimate is aligned with the reference before absolute errors are measured.
    #[arg(long, value_enum, default_value = "rigid")]
    align: Align,
    /// The largest difference between the stamps of matched poses, in seconds.
    #[arg(long, value_name = "S", default_value_t = 0.01)]
    max_difference: f64,
    /// The number of poses over which a relative error is measured.
    #[arg(long, value_name = "POSES", default_value_t = 1, conflicts_with = "delta_m")]
    delta: usize,
    /// The distance along the estimate over which a relative error is measured, in place of --delta.
    #[arg(long, value_name = "M")]
    delta_m: Option<f64>,
    /// The lengths in metres over which KITTI's drift is measured; those longer than the trajectory are skipped.
    #[arg(long, value_name = "M,M,...", value_delimiter = ',', default_values_t = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0])]
    lengths: Vec<f64>,
}

/// How the estimate is aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Align {
    /// Not at all.
    None,
    /// The first pose on the first pose.
    First,
    /// By the rotation and translation of least squared distance (Umeyama).
    Rigid,
    /// The same with a scale factor.
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
        let reference = read_track(&self.reference)?;
        let estimate = self.read_estimate(context)?;
        let (truth, found) = self.match_poses(&reference, &estimate)?;
        let (aligned, scale) = align(&truth, &found, self.align.into()).ok_or_else(|| {
            Failure::new(
                "the positions lie on a line, so that no rotation fits best: use --align first or --align none",
            )
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

    fn read_estimate(&self, context: &Context) -> Result<Track, Failure> {
        if Path::new(&self.estimate).exists() {
            return read_track(&self.estimate);
        }
        let catalog = context.catalog().map_err(|error| {
            Failure::new(format!("{}: no such file, and no store to look for a traversal in: {error}", self.estimate))
        })?;
        let id = choose_traversal(&catalog, &self.estimate)?;
        let chain = catalog.traversal(id)?.chain;
        Ok(Track::of_chain(&tables::chain_from_parquet(catalog.objects().read(chain)?)?))
    }

    /// The poses that belong together.
    fn match_poses(&self, reference: &Track, estimate: &Track) -> Result<(Vec<Se3>, Vec<Se3>), Failure> {
        let (a, b) = (&reference.poses, &estimate.poses);
        let pairs = match (&reference.stamps_s, &estimate.stamps_s) {
            (Some(a), Some(b)) => associate(a, b, self.max_difference),
            _ if a.len() == b.len() => (0..a.len()).map(|i| (i, i)).collect(),
            _ => {
                return Err(Failure::new(format!(
                    "{} has {} poses and {} has {}, and not both have stamps: give both in TUM form",
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

fn read_track(path: &str) -> Result<Track, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::new(format!("{path}: {error}")))?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Failure::new(format!("{path}: byte {at} is no text: expected a trajectory in TUM or KITTI form"))
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
