use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::progress::with_bar;
use crate::views::generators::{generator_json, generator_line};
use furrow_model::TimeSlot;
use furrow_runner::generation::{TrainingRequest, train};
use furrow_runner::generator::Strengths;

/// Train an optimal-transport flow from one slot to another.
///
/// It learns from the traversals of one route at both slots. The plan of a matrix refuses a generator that was trained
/// on the ground it is judged on: train on the vocabulary route.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow generator train --site old-zoo --from 10:00 --to 16:00\n  \
furrow generator train --site old-zoo --from 10:00 --to 16:00 --relight 1 --name relit\n  \
furrow generate 3fa8 --generator 'otf:10:00>16:00' --z 0.33,0.66,1.0")]
pub struct TrainGenerator {
    /// The site.
    #[arg(long)]
    site: String,
    /// The slot to move images from.
    #[arg(long, value_name = "HH:MM")]
    from: TimeSlot,
    /// The slot to move them to.
    #[arg(long, value_name = "HH:MM")]
    to: TimeSlot,
    /// The route whose traversals to train on.
    #[arg(long, default_value = "vocabulary")]
    route: String,
    /// Its name. [default: 'otf:FROM>TO']
    #[arg(long)]
    name: Option<String>,
    /// Use at most N images of each slot, evenly spread.
    #[arg(long, default_value_t = 500, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    images: u32,
    /// How strongly the camera's noise moves to the target's, 0 (off) to 4.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    sensor: f64,
    /// How strongly the depth of shadows moves to the target's, 0 (off) to 4.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    shadow: f64,
    /// How strongly surfaces that face the target's sun brighten and others darken, 0 (off) to 4. Needs a stereo
    /// camera, and satellite fixes of the parents.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    relight: f64,
    /// The position of the site in degrees north and east, for --relight. [default: from the satellite fixes]
    #[arg(
        long,
        value_name = "LATITUDE,LONGITUDE",
        value_delimiter = ',',
        num_args = 1,
        allow_hyphen_values = true,
        requires = "relight"
    )]
    place: Vec<f64>,
}

impl TrainGenerator {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let request = self.request()?;
        let catalog = context.catalog()?;
        let (id, record) = with_bar(|progress| train(&catalog, &request, progress))?;
        if context.json {
            print_json(&generator_json(id, &record))?;
        } else {
            print(&generator_line(id, &record))?;
        }
        Ok(Ending::Done)
    }

    fn request(self) -> Result<TrainingRequest, Failure> {
        if self.from == self.to {
            return Err(Failure::usage(format!(
                "--from and --to are both {}: a generator goes from one slot to another",
                self.from
            )));
        }
        for (flag, strength) in [("--sensor", self.sensor), ("--shadow", self.shadow), ("--relight", self.relight)] {
            if !(0.0..=4.0).contains(&strength) {
                return Err(Failure::usage(format!("{flag} {strength}: expected a number from 0 (off) to 4")));
            }
        }
        let place = match self.place.as_slice() {
            [] => None,
            &[latitude, longitude] if latitude.abs() <= 90.0 && longitude.abs() <= 180.0 => Some([latitude, longitude]),
            other => {
                return Err(Failure::usage(format!(
                    "--place {other:?}: expected degrees north and east, as in --place -33.95,18.46"
                )));
            }
        };
        Ok(TrainingRequest {
            name: self.name.unwrap_or_else(|| format!("otf:{}>{}", self.from, self.to)),
            site: self.site,
            route: self.route,
            from: self.from,
            to: self.to,
            images: self.images as usize,
            strengths: Strengths { sensor: self.sensor, shadow: self.shadow, relight: self.relight },
            place,
        })
    }
}
