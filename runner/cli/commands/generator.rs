use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use clap::{Args, Subcommand};
use furrow_catalog::records::{self, GeneratorRecord, TrainingDomain};
use furrow_catalog::{Catalog, write_file};
use furrow_model::{ExperienceId, ObjectId, TimeSlot};
use furrow_runner::gate::GateRecord;
use furrow_runner::generation::{self, TrainingRequest, translator};
use furrow_runner::generator::Strengths;
use furrow_runner::generator::quality::doubts;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Train, add and look at what moves images to another time of day.
#[derive(Debug, Subcommand)]
pub enum Generator {
    Train(TrainGenerator),
    Add(AddGenerator),
    Ls(ListGenerators),
    Show(ShowGenerator),
}

/// Train an optimal-transport flow between two slots.
///
/// It learns from the passes of one route at both slots. Nothing may be judged on the ground it was trained on: train on the vocabulary route.
#[derive(Debug, Args)]
#[command(
    after_help = "Example:\n  furrow generator train --site old-zoo --from 10:00 --to 16:00\n  furrow generator train --site old-zoo --from 10:00 --to 16:00 --relight 1 --name relit\n  furrow generate 3fa8 --generator 'otf:10:00>16:00' --z 0.33,0.66,1.0"
)]
pub struct TrainGenerator {
    /// The site.
    #[arg(long)]
    site: String,
    /// The slot to move images from.
    #[arg(long, value_name = "HH:MM")]
    from: TimeSlot,
    /// The slot to move them towards.
    #[arg(long, value_name = "HH:MM")]
    to: TimeSlot,
    /// The route whose passes to train on.
    #[arg(long, default_value = "vocabulary")]
    route: String,
    /// What it will be called; `otf:FROM>TO` where left out.
    #[arg(long)]
    name: Option<String>,
    /// At most so many images of each slot, evenly spread.
    #[arg(long, default_value_t = 500, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    images: u32,
    /// How strongly the camera's noise moves towards the target's; 0 is off.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    sensor: f64,
    /// How strongly the depth of shadows moves towards the target's; 0 is off.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    shadow: f64,
    /// How strongly surfaces brighten and darken as they face the target's sun or turn away; 0 is off. Needs stereo, and satellite fixes of the parents.
    #[arg(long, default_value_t = 0.0, value_name = "STRENGTH")]
    relight: f64,
    /// Where the site lies, degrees north and east, for --relight; the passes' satellite fixes tell where left out.
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

/// Add a generator of another program: an ONNX model or a command, described by a translator.json.
#[derive(Debug, Args)]
#[command(
    after_help = "Example of a translator.json:\n  {\"schema\": 1, \"name\": \"cut\", \"kind\": \"command\", \"command\": [\"python3\", \"translate.py\"],\n   \"directions\": [{\"from\": \"10:00\", \"to\": \"16:00\"}], \"z_range\": [0, 1], \"z_semantics\": \"displacement_from_input\"}\n\nA command reads lines {\"id\",\"in\",\"out\",\"z\",\"dir\",\"seed\"} and answers {\"id\",\"ok\",\"ms\",\"err\"}; an ONNX model has inputs image\nf32[1,3,H,W] and z f32[1,1], output image f32[1,3,H,W].\n\nWhat a command painted is remembered with the digest of its arguments that are files, its weights and what \"files\": [\"module.py\"] names."
)]
pub struct AddGenerator {
    /// The file.
    #[arg(value_name = "translator.json")]
    file: PathBuf,
}

/// List the generators of the store.
#[derive(Debug, Args)]
pub struct ListGenerators {}

/// Show a generator: where it comes from and what the quality gate measured.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  furrow generator show 'otf:10:00>16:00' --sheet sheet.jpg")]
pub struct ShowGenerator {
    /// Its name, or the beginning of its id.
    name: String,
    /// Write a contact sheet: rows of domainness between the real source and the real target.
    #[arg(long, value_name = "FILE.jpg")]
    sheet: Option<PathBuf>,
    /// The experience to show on the sheet, by the beginning of its id; the generator's own training images where left out.
    #[arg(long, requires = "sheet", value_name = "EXPERIENCE")]
    of: Option<String>,
    /// The domainnesses on the sheet.
    #[arg(long, value_delimiter = ',', default_value = "0,0.33,0.66,1,1.5", requires = "sheet")]
    z: Vec<f64>,
}

impl Generator {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match self {
            Self::Train(command) => command.run(context),
            Self::Add(command) => command.run(context),
            Self::Ls(command) => command.run(context),
            Self::Show(command) => command.run(context),
        }
    }
}

impl TrainGenerator {
    fn run(self, context: &Context) -> Result<Ending, Failure> {
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
        let request = TrainingRequest {
            name: self.name.unwrap_or_else(|| format!("otf:{}>{}", self.from, self.to)),
            site: self.site,
            route: self.route,
            from: self.from,
            to: self.to,
            images: self.images as usize,
            strengths: Strengths { sensor: self.sensor, shadow: self.shadow, relight: self.relight },
            place,
        };
        let catalog = context.catalog()?;
        let bar = Bar::units();
        let trained = generation::train(&catalog, &request, &|at| bar.show(at.stage, at.done, at.total));
        bar.finish();
        let (id, record) = trained?;
        if context.json {
            return print_json(&summary(id, &record)).map(|()| Ending::Done);
        }
        print(&format!("{}\n", line(id, &record)))?;
        Ok(Ending::Done)
    }
}

impl AddGenerator {
    fn run(self, context: &Context) -> Result<Ending, Failure> {
        let added = translator::add(&context.catalog()?, &self.file)?;
        if context.json {
            let all: Vec<Value> = added.iter().map(|(id, record)| summary(*id, record)).collect();
            return print_json(&json!({ "generators": all })).map(|()| Ending::Done);
        }
        print(&added.iter().map(|(id, record)| line(*id, record) + "\n").collect::<String>())?;
        Ok(Ending::Done)
    }
}

impl ListGenerators {
    fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let all = catalog.generators()?.into_iter().map(|row| Ok((row.id, catalog.generator(row.id)?)));
        let all = all.collect::<Result<Vec<_>, Failure>>()?;
        if context.json {
            let all: Vec<Value> = all.iter().map(|(id, record)| summary(*id, record)).collect();
            return print_json(&json!({ "generators": all })).map(|()| Ending::Done);
        }
        if all.is_empty() {
            print(
                "none yet: `furrow generator train` makes one; identity, invariant, gamma:0.8, noise:3 and blur:0.8 need no training\n",
            )?;
        } else {
            print(&all.iter().map(|(id, record)| line(*id, record) + "\n").collect::<String>())?;
        }
        Ok(Ending::Done)
    }
}

impl ShowGenerator {
    fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let (id, record) = generation::found(&catalog, &self.name)?;
        let gates = gates(&catalog, id)?;
        if let Some(file) = &self.sheet {
            let of = match &self.of {
                Some(typed) => Some(catalog.experience(super::chosen(
                    "experience",
                    typed,
                    catalog.experiences()?.into_iter().map(|row| row.id),
                )?)?),
                None => None,
            };
            write_file(file, &generation::contact_sheet(&catalog, &record, of.as_ref(), &self.z)?)?;
            eprintln!("contact sheet: {}", file.display());
        }
        if context.json {
            let mut shown = summary(id, &record);
            shown["parameters"] = json!(record.parameters);
            shown["training"] = json!({ "source": record.source, "target": record.target });
            shown["gates"] = gates.iter().map(|(parent, curve)| gate_json(parent, curve)).collect();
            return print_json(&shown).map(|()| Ending::Done);
        }
        let mut text = line(id, &record) + "\n";
        for (parent, curve) in &gates {
            text += &gate_text(&parent.short(), curve);
        }
        if gates.is_empty() {
            text += "not measured yet: `furrow generate` measures it\n";
        }
        print(&text)?;
        Ok(Ending::Done)
    }
}

/// What the gate measured, by experience, in rising domainness.
fn gates(catalog: &Catalog, generator: ObjectId) -> Result<BTreeMap<ExperienceId, Vec<GateRecord>>, Failure> {
    let mut found: BTreeMap<ExperienceId, Vec<GateRecord>> = BTreeMap::new();
    for row in catalog.gates(generator)? {
        found.entry(row.parent).or_default().push(records::read(catalog.objects(), row.object)?);
    }
    Ok(found)
}

/// Why a generator is to be doubted on an experience, seen over all that was measured there.
pub(super) fn all_doubts(curve: &[GateRecord]) -> Vec<String> {
    let measures: Vec<_> = curve.iter().map(|gate| gate.measures).collect();
    doubts(curve.first().and_then(|gate| gate.switch.as_ref()), &measures)
}

pub(super) fn gate_json(parent: &ExperienceId, curve: &[GateRecord]) -> Value {
    let measures: Vec<Value> = curve
        .iter()
        .map(|gate| {
            let mut measures = json!(gate.measures);
            measures["retention"] = json!(gate.measures.retention());
            measures
        })
        .collect();
    let doubts = all_doubts(curve);
    json!({ "parent": parent, "switch": curve.first().and_then(|gate| gate.switch), "curve": measures, "passed": doubts.is_empty(), "doubts": doubts })
}

/// The gate's table for people.
pub(super) fn gate_text(parent: &str, curve: &[GateRecord]) -> String {
    let mut text = format!("measured on experience {parent}");
    if let Some(switch) = curve.first().and_then(|gate| gate.switch) {
        let _ = write!(text, ": switch index {:.2}, its largest step at z = {:.3}", switch.kappa, switch.at);
    }
    text += "\n      z  good matches  retained  descriptor distance  Laplacian  clipped (source, target)  invented\n";
    for GateRecord { measures: m, .. } in curve {
        let _ = writeln!(
            text,
            "{:>7} {:>13.0} {:>8.1}% {:>20.4} {:>10.2} {:>8.1}% ({:.1}%, {}) {:>9.1}%",
            m.z,
            m.good_matches,
            100.0 * m.retention(),
            m.descriptor_distance,
            m.laplacian_ratio,
            100.0 * m.clipped,
            100.0 * m.clipped_source,
            m.clipped_target.map_or_else(|| "-".to_owned(), |target| format!("{:.1}%", 100.0 * target)),
            100.0 * m.hallucinated
        );
    }
    let doubts = all_doubts(curve);
    text += if doubts.is_empty() { "passes the quality gate\n" } else { "is to be doubted:\n" };
    doubts.iter().for_each(|doubt| text += &format!("  {doubt}\n"));
    text
}

fn summary(id: ObjectId, record: &GeneratorRecord) -> Value {
    let images = |domain: &Option<TrainingDomain>| domain.as_ref().map(|domain| domain.images.len());
    let slot = |domain: &Option<TrainingDomain>| domain.as_ref().map(|domain| domain.slot);
    json!({
        "generator": id, "name": record.name, "kind": record.kind, "algorithm": record.algorithm, "weights": record.weights,
        "from": slot(&record.source), "to": slot(&record.target),
        "source_images": images(&record.source), "target_images": images(&record.target),
    })
}

fn line(id: ObjectId, record: &GeneratorRecord) -> String {
    let trained = match (&record.source, &record.target) {
        (Some(source), Some(target)) if !source.images.is_empty() => {
            format!(
                "{} to {}, trained on {} and {} images",
                source.slot,
                target.slot,
                source.images.len(),
                target.images.len()
            )
        }
        (Some(source), Some(target)) => format!("{} to {}, trained elsewhere", source.slot, target.slot),
        _ => "needs no training".to_owned(),
    };
    let on = |stage: &&str| record.parameters["strengths"][*stage].as_f64().filter(|strength| *strength > 0.0);
    let stages = ["sensor", "shadow", "relight"].iter().filter_map(|stage| Some(format!(", {stage} {}", on(stage)?)));
    format!("{:<13} {:<24} {:<9} {trained}{}", id.short(), record.name, record.kind, stages.collect::<String>())
}
