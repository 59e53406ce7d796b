use crate::choosing::choose_experience;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::progress::with_bar;
use crate::views::generators::{gate_json, gate_text};
use furrow_catalog::Catalog;
use furrow_catalog::records::GateRecord;
use furrow_model::{Domainness, Experience, ExperienceId, ObjectId, TimeSlot};
use furrow_runner::Progress;
use furrow_runner::generation::gate::gate;
use furrow_runner::generation::making::check_parent;
use furrow_runner::generation::painter::Painter;
use furrow_runner::generation::{self, Generated, Request};
use serde_json::json;

/// Generate experiences that mimic another time of day from a recorded one.
///
/// A generator changes the images; timestamps and trajectory stay. One experience for each domainness: 0 leaves the
/// images as they are, 1 moves them to the target slot, beyond is extrapolation. The quality gate measures the
/// generator on these images; its measures are stored and shown. Killed, the same command continues.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow generate 3fa8 --generator 'otf:10:00>16:00' --z 0.33,0.66,1.0\n  \
furrow generate 3fa8 --generator noise:3 --z 1 --mimics 10:00")]
pub struct Generate {
    /// The parent: a recorded experience, by the beginning of its id.
    experience: String,
    #[arg(long, value_name = "NAME", help = generator_help())]
    generator: String,
    /// The domainness of each experience to generate, separated by commas.
    #[arg(long, value_delimiter = ',', required = true, value_name = "Z,Z,...", allow_negative_numbers = true)]
    z: Vec<f64>,
    /// The slots that the results mimic, one for each z. [default: on the generator's way between its slots]
    #[arg(long, value_delimiter = ',', value_name = "HH:MM")]
    mimics: Vec<TimeSlot>,
    /// Seeds all that is drawn at random.
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

fn generator_help() -> String {
    let untrained = generation::named_examples("and");
    format!("The generator: its name, or the beginning of its id. {untrained} need no training")
}

/// A generated experience and what it mimics.
struct Child {
    z: f64,
    mimics: TimeSlot,
    made: Generated,
}

impl Generate {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        self.check()?;
        let catalog = context.catalog()?;
        let parent_id = choose_experience(&catalog, &self.experience)?;
        let parent = catalog.experience(parent_id)?;
        check_parent(parent_id, &parent).map_err(Failure::new)?;
        let (generator, children, gates) = with_bar(|progress| self.generate(&catalog, &parent, progress))?;
        if context.json {
            let experiences = children.iter().map(|Child { z, mimics, made }| {
                json!({
                    "experience": made.id, "parent": parent_id, "generator": generator, "domainness": z,
                    "mimics": mimics, "nodes": made.experience.nodes.len(), "painted": made.painted,
                    "extrapolated": !(0.0..=1.0).contains(z),
                })
            });
            let experiences: Vec<_> = experiences.collect();
            print_json(&json!({ "experiences": experiences, "gate": gate_json(&parent_id, &gates) }))?;
        } else {
            print(&text(parent_id, &children, &gates))?;
        }
        Ok(Ending::Done)
    }

    fn check(&self) -> Result<(), Failure> {
        if let Some(z) = self.z.iter().find(|z| !z.is_finite()) {
            return Err(Failure::usage(format!("--z {z}: expected numbers, as in --z 0.33,0.66,1.0")));
        }
        if !self.mimics.is_empty() && self.mimics.len() != self.z.len() {
            return Err(Failure::usage(format!(
                "--mimics has {} slots for {} domainnesses: give one for each, or none",
                self.mimics.len(),
                self.z.len()
            )));
        }
        Ok(())
    }

    fn generate(
        &self,
        catalog: &Catalog,
        parent: &Experience,
        progress: Progress<'_>,
    ) -> Result<(ObjectId, Vec<Child>, Vec<GateRecord>), Failure> {
        let (generator, record) = generation::find_generator(catalog, &self.generator)?;
        generation::register_named(catalog, &record)?;
        let painter = Painter::load(catalog, &record)?;
        let mut children = Vec::new();
        for (i, z) in self.z.iter().copied().enumerate() {
            let mimics =
                self.mimics.get(i).copied().unwrap_or_else(|| generation::mimicked_slot(&record, parent.slot, z));
            let request = Request {
                parent,
                generator,
                domainness: Domainness(z),
                mimics,
                seed: self.seed,
                files: painter.files(),
            };
            children.push(Child { z, mimics, made: generation::generate(catalog, &request, &painter, progress)? });
        }
        let wanted: Vec<Domainness> = self.z.iter().copied().map(Domainness).collect();
        let gates = gate(catalog, parent, (generator, &painter), &wanted, self.seed, progress)?;
        Ok((generator, children, gates))
    }
}

fn text(parent: ExperienceId, children: &[Child], gates: &[GateRecord]) -> String {
    let mut text = gate_text(&parent.short(), gates);
    for Child { z, mimics, made } in children {
        let extrapolated = if (0.0..=1.0).contains(z) { "" } else { ", extrapolated" };
        text += &format!(
            "{} mimics {mimics}: z = {z}{extrapolated}, {} nodes, {} images painted\n",
            made.id.short(),
            made.experience.nodes.len(),
            made.painted
        );
    }
    text
}
