//! Generators, and what the quality gate measured of them.

use crate::ending::Failure;
use furrow_catalog::Catalog;
use furrow_catalog::records::{self, GateRecord, GeneratorRecord, TrainingDomain};
use furrow_model::{ExperienceId, ObjectId};
use furrow_runner::generator::quality::doubts;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A generator as programs read it.
pub fn generator_json(id: ObjectId, record: &GeneratorRecord) -> Value {
    let images = |domain: &Option<TrainingDomain>| domain.as_ref().map(|domain| domain.images.len());
    let slot = |domain: &Option<TrainingDomain>| domain.as_ref().map(|domain| domain.slot);
    json!({
        "generator": id, "name": record.name, "kind": record.kind, "algorithm": record.algorithm, "weights": record.weights,
        "from": slot(&record.source), "to": slot(&record.target),
        "source_images": images(&record.source), "target_images": images(&record.target),
    })
}

/// A generator in a line.
pub fn generator_line(id: ObjectId, record: &GeneratorRecord) -> String {
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
    format!("{:<13} {:<24} {:<9} {trained}{}\n", id.short(), record.name, record.kind, stages.collect::<String>())
}

/// What the gate measured of a generator, by experience, in rising domainness.
pub fn read_gates(
    catalog: &Catalog,
    generator: ObjectId,
    wanted: impl Fn(ExperienceId) -> bool,
) -> Result<BTreeMap<ExperienceId, Vec<GateRecord>>, Failure> {
    let mut found: BTreeMap<ExperienceId, Vec<GateRecord>> = BTreeMap::new();
    for row in catalog.gates(generator)?.into_iter().filter(|row| wanted(row.parent)) {
        found.entry(row.parent).or_default().push(records::read(catalog.objects(), row.object)?);
    }
    Ok(found)
}

/// What the gate measured on an experience, over domainness, as programs read it.
pub fn gate_json(parent: &ExperienceId, curve: &[GateRecord]) -> Value {
    let measures: Vec<Value> = curve
        .iter()
        .map(|gate| {
            let mut measures = json!(gate.measures);
            measures["retention"] = json!(gate.measures.retention());
            measures
        })
        .collect();
    let doubts = list_doubts(curve);
    json!({
        "parent": parent, "switch": curve.first().and_then(|gate| gate.switch), "curve": measures,
        "passed": doubts.is_empty(), "doubts": doubts,
    })
}

/// The same as a table.
pub fn gate_text(parent: &str, curve: &[GateRecord]) -> String {
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
    let doubts = list_doubts(curve);
    text += if doubts.is_empty() { "passes the quality gate\n" } else { "does not pass the quality gate:\n" };
    doubts.iter().for_each(|doubt| text += &format!("  {doubt}\n"));
    text
}

/// Why the gate doubts a generator on an experience, over all domainnesses that were measured there.
fn list_doubts(curve: &[GateRecord]) -> Vec<String> {
    let measures: Vec<_> = curve.iter().map(|gate| gate.measures).collect();
    doubts(curve.first().and_then(|gate| gate.switch.as_ref()), &measures)
}
