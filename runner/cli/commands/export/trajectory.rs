use crate::choosing::choose_traversal;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::print_json;
use clap::{Args, ValueEnum};
use furrow_catalog::{tables, write_file};
use furrow_model::Trajectory;
use std::fmt::Write;
use std::path::PathBuf;

/// Write the trajectory of a traversal.
///
/// Poses of the left camera relative to its first: x right, y down, z forward, metres.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  furrow export trajectory 3fa8 --format tum -o morning.tum && evo_traj tum morning.tum\n  furrow export trajectory 3fa8 --format csv -o morning.csv"
)]
pub struct ExportTrajectory {
    /// The traversal, by the beginning of its id.
    traversal: String,
    /// The form of the file.
    #[arg(long, value_enum)]
    format: Format,
    /// The file to write.
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// A form of trajectory files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// `seconds tx ty tz qx qy qz qw`.
    Tum,
    /// Twelve numbers a row: the 3x4 pose by rows.
    Kitti,
    /// A header, then poses, and for each step its matches and its standard deviations in the later camera's frame.
    Csv,
}

impl ExportTrajectory {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let id = choose_traversal(&catalog, &self.traversal)?;
        let record = catalog.traversal(id)?;
        let chain = tables::chain_from_parquet(catalog.objects().read(record.chain)?)?;
        let text = match self.format {
            Format::Tum => tum(&chain),
            Format::Kitti => kitti(&chain),
            Format::Csv => csv(&chain),
        };
        write_file(&self.output, text.as_bytes())?;
        if context.json {
            print_json(&serde_json::json!({ "traversal": id, "file": self.output, "poses": chain.frames() }))?;
        } else {
            eprintln!("{}: {} poses", self.output.display(), chain.frames());
        }
        Ok(Ending::Done)
    }
}

fn tum(chain: &Trajectory) -> String {
    chain.poses().iter().fold(String::new(), |mut text, pose| {
        let [tx, ty, tz] = pose.start_from_here.translation_m;
        let [qx, qy, qz, qw] = pose.start_from_here.quaternion_xyzw();
        let (seconds, nanos) = (pose.stamp_ns.div_euclid(1_000_000_000), pose.stamp_ns.rem_euclid(1_000_000_000));
        let _ = writeln!(text, "{seconds}.{nanos:09} {tx} {ty} {tz} {qx} {qy} {qz} {qw}");
        text
    })
}

fn kitti(chain: &Trajectory) -> String {
    chain.poses().iter().fold(String::new(), |mut text, pose| {
        let (r, t) = (pose.start_from_here.rotation, pose.start_from_here.translation_m);
        let rows: Vec<String> = (0..3).map(|i| format!("{} {} {} {}", r[i][0], r[i][1], r[i][2], t[i])).collect();
        let _ = writeln!(text, "{}", rows.join(" "));
        text
    })
}

fn csv(chain: &Trajectory) -> String {
    let mut text = String::from("stamp_ns,tx_m,ty_m,tz_m,qx,qy,qz,qw,travelled_m,matches,inliers,valid,");
    text += "sigma_rx_rad,sigma_ry_rad,sigma_rz_rad,sigma_tx_m,sigma_ty_m,sigma_tz_m\n";
    for (i, pose) in chain.poses().iter().enumerate() {
        let step = i.checked_sub(1).and_then(|i| chain.steps.get(i));
        let (matches, inliers) = step.map_or((0, 0), |step| (step.matches, step.inliers));
        let [tx, ty, tz] = pose.start_from_here.translation_m;
        let [qx, qy, qz, qw] = pose.start_from_here.quaternion_xyzw();
        let (stamp, travelled, valid) = (pose.stamp_ns, pose.travelled_m, pose.valid);
        let _ = write!(text, "{stamp},{tx},{ty},{tz},{qx},{qy},{qz},{qw},{travelled},{matches},{inliers},{valid}");
        let stds = step.and_then(|step| step.covariance).map(|covariance| covariance.stds());
        for i in 0..6 {
            let _ = write!(text, ",{}", stds.map_or_else(String::new, |stds| stds[i].to_string()));
        }
        text.push('\n');
    }
    text
}
