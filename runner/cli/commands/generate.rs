use super::generator::{gate_json, gate_text};
use super::{chosen, short};
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_model::{Domainness, ExperienceKind, ObjectId, TimeSlot};
use furrow_runner::gate::gate;
use furrow_runner::generation::painter::Painter;
use furrow_runner::generation::{self, Request};
use serde_json::json;

/// Make an experience mimic another time of day: its images repainted, its stamps and trajectory its own.
///
/// One experience for each domainness: 0 leaves the images as they are, 1 takes them all the way, beyond is extrapolation. What the quality
/// gate measures of the generator on these images is stored and shown. Killed, the same command goes on with the images that are missing.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow generate 3fa8 --generator 'otf:10:00>16:00' --z 0.33,0.66,1.0\n  furrow generate 3fa8 --generator noise:3 --z 1 --mimics 10:00"
)]
pub struct Generate {
    /// The recorded experience, or the beginning of its id.
    experience: String,
    /// The generator: its name or the beginning of its id; identity, invariant, gamma:0.8, noise:3 and blur:0.8 need no training.
    #[arg(long, value_name = "G")]
    generator: String,
    /// How far to move the images; several separated by commas.
    #[arg(long, value_delimiter = ',', required = true, value_name = "Z", allow_negative_numbers = true)]
    z: Vec<f64>,
    /// The slots that the results stand for, one for each z; worked out from the generator's slots where left out.
    #[arg(long, value_delimiter = ',', value_name = "HH:MM")]
    mimics: Vec<TimeSlot>,
    /// Seeds what is drawn at random.
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

impl Generate {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if let Some(z) = self.z.iter().find(|z| !z.is_finite()) {
            return Err(Failure::usage(format!("--z {z}: expected numbers, as in --z 0.33,0.66,1.0")));
        }
        if !self.mimics.is_empty() && self.mimics.len() != self.z.len() {
            return Err(Failure::usage(format!(
                "--mimics has {} slots for {} domainnesses: name one for each, or none",
                self.mimics.len(),
                self.z.len()
            )));
        }
        let catalog = context.catalog()?;
        let parent_id = chosen("experience", &self.experience, catalog.experiences()?.into_iter().map(|row| row.id))?;
        let parent = catalog.experience(parent_id)?;
        if parent.kind != ExperienceKind::Recorded {
            return Err(Failure::new(format!(
                "experience {} is generated itself: grandchildren are refused, name a recorded one",
                parent_id.short()
            )));
        }
        let (generator, record) = generation::found(&catalog, &self.generator)?;
        generation::register_named(&catalog, &record)?;
        let painter = Painter::load(&catalog, &record)?;
        let bar = Bar::units();
        let progress = |at: furrow_runner::StageProgress<'_>| bar.show(at.stage, at.done, at.total);
        let mut made = Vec::new();
        for (i, z) in self.z.iter().enumerate() {
            let mimics = self.mimics.get(i).copied().unwrap_or_else(|| generation::mimicked(&record, parent.slot, *z));
            let request = Request {
                parent: &parent,
                generator,
                domainness: Domainness(*z),
                mimics,
                seed: self.seed,
                files: painter.files(),
            };
            made.push((*z, mimics, generation::generate(&catalog, &request, &painter, &progress)?));
        }
        let wanted: Vec<Domainness> = self.z.iter().copied().map(Domainness).collect();
        let measured = gate(&catalog, &parent, (generator, &painter), &wanted, self.seed, &progress)?;
        bar.finish();
        if context.json {
            let experiences: Vec<_> = made
                .iter()
                .map(|(z, mimics, made)| json!({ "experience": made.id, "parent": parent_id, "generator": generator, "domainness": z, "mimics": mimics, "nodes": made.experience.nodes.len(), "painted": made.painted, "extrapolated": !(0.0..=1.0).contains(z) }))
                .collect();
            print_json(&json!({ "experiences": experiences, "gate": gate_json(&parent_id, &measured) }))?;
        } else {
            let mut text = gate_text(&parent_id.short(), &measured);
            for (z, mimics, made) in &made {
                let extrapolated = if (0.0..=1.0).contains(z) { "" } else { ", extrapolated" };
                text += &format!(
                    "{} mimics {mimics}: z = {z}{extrapolated}, {} nodes, {} images painted\n",
                    short(ObjectId(made.id.0)),
                    made.experience.nodes.len(),
                    made.painted
                );
            }
            print(&text)?;
        }
        Ok(Ending::Done)
    }
}
