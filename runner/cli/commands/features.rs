use crate::ending::{Ending, Failure};
use crate::output::print;
use furrow_catalog::images::decode_grey;
use furrow_runner::localiser::surf::{Features as Found, SurfParams, surf};
use std::fmt::Write;
use std::path::PathBuf;

/// Print the SURF keypoints of an image.
///
/// With --csv a table, strongest first: index, x, y (pixels; (0, 0) is the centre of the top left pixel), size,
/// angle_deg, response, octave, laplacian_sign.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow features image.jpg\n  furrow features image.jpg --csv --descriptors > surf.csv"
)]
pub struct Features {
    /// A JPEG or PNG file; colour is converted to grey.
    image: PathBuf,
    /// The smallest determinant of the Hessian of a keypoint.
    #[arg(long, default_value_t = 400.0)]
    hessian: f32,
    /// Do not estimate the orientation of keypoints: U-SURF.
    #[arg(long)]
    upright: bool,
    /// Print a CSV table instead of a count.
    #[arg(long)]
    csv: bool,
    /// Add the 64 numbers of each descriptor to the table, d0 to d63.
    #[arg(long, requires = "csv")]
    descriptors: bool,
}

impl Features {
    pub fn run(self) -> Result<Ending, Failure> {
        let image_error = |error: &dyn std::fmt::Display| Failure::new(format!("{}: {error}", self.image.display()));
        if !(self.hessian >= 0.0 && self.hessian.is_finite()) {
            return Err(Failure::usage(format!("--hessian {}: expected a number of at least 0", self.hessian)));
        }
        let bytes = std::fs::read(&self.image).map_err(|error| image_error(&error))?;
        let image = decode_grey(&bytes, None).map_err(|error| image_error(&error))?;
        let params = SurfParams { hessian_threshold: self.hessian, upright: self.upright, ..SurfParams::GOLDEN };
        let found = surf(&image, &params);
        if self.csv {
            print(&csv(&found, self.descriptors))?;
        } else {
            print(&format!("{} keypoints\n", found.keypoints.len()))?;
        }
        Ok(Ending::Done)
    }
}

fn csv(found: &Found, descriptors: bool) -> String {
    let mut text = String::from("index,x,y,size,angle_deg,response,octave,laplacian_sign");
    if descriptors {
        (0..64).for_each(|d| text += &format!(",d{d}"));
    }
    text.push('\n');
    for (i, (point, descriptor)) in found.keypoints.iter().zip(&found.descriptors).enumerate() {
        let _ = write!(
            text,
            "{i},{},{},{},{},{},{},{}",
            f64::from(point.x_px),
            f64::from(point.y_px),
            f64::from(point.size_px),
            f64::from(point.angle_deg),
            f64::from(point.response),
            point.octave,
            point.laplacian_sign
        );
        if descriptors {
            descriptor.iter().for_each(|d| text += &format!(",{}", f64::from(*d)));
        }
        text.push('\n');
    }
    text
}
