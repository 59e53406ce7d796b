//! The generators of a report: what the quality gate measured, and contact sheets.

use crate::ending::Failure;
use crate::views::generators::read_gates;
use furrow_catalog::Catalog;
use furrow_catalog::records::{self, GateRecord, GeneratorRecord, RunRecord};
use furrow_model::{Experience, ExperienceId, ExperienceKind, ObjectId};
use furrow_reports::{CellInput, GateCurve, GatePoint, GeneratorInput};
use furrow_runner::generation;
use std::collections::BTreeSet;

/// Contact sheets of generators.
const SHEETS_IN_ALL: usize = 6;

/// The parents of the generated experiences in the cells.
pub fn find_parents(catalog: &Catalog, cells: &[CellInput]) -> Result<BTreeSet<ExperienceId>, Failure> {
    let members: BTreeSet<ExperienceId> =
        cells.iter().flat_map(|cell| &cell.outcome.members).map(|member| member.id).collect();
    let mut parents = BTreeSet::new();
    for member in members {
        let record: Experience = records::read(catalog.objects(), ObjectId(member.0))?;
        if let ExperienceKind::Generated { parent, .. } = record.kind {
            parents.insert(parent);
        }
    }
    Ok(parents)
}

/// The generators of a run: what the gate measured on its own parents, and contact sheets of trained ones.
pub fn read_generators(
    catalog: &Catalog,
    record: &RunRecord,
    parents: &BTreeSet<ExperienceId>,
    pictures: bool,
) -> Result<Vec<GeneratorInput>, Failure> {
    let mut found = Vec::new();
    let mut sheets = 0;
    for id in &record.generators {
        let generator = catalog.generator(*id)?;
        let curves = read_gates(catalog, *id, |parent| parents.contains(&parent))?;
        let wanted = pictures && generator.source.is_some() && sheets < SHEETS_IN_ALL;
        let sheet = match curves.keys().next().filter(|_| wanted) {
            Some(parent) => Some(make_sheet(catalog, &generator, *parent, curves.values().flatten())?),
            None => None,
        };
        sheets += usize::from(sheet.is_some());
        let curves = curves.into_iter().map(|(parent, gates)| make_curve(catalog, parent, &gates));
        found.push(GeneratorInput { name: generator.name, curves: curves.collect::<Result<_, _>>()?, sheet });
    }
    Ok(found)
}

/// A contact sheet at the domainnesses of the gates, and its caption.
fn make_sheet<'a>(
    catalog: &Catalog,
    generator: &GeneratorRecord,
    parent: ExperienceId,
    gates: impl Iterator<Item = &'a GateRecord>,
) -> Result<(Vec<u8>, String), Failure> {
    let zs: BTreeSet<u64> = gates.map(|gate| gate.measures.z.to_bits()).collect();
    let zs: Vec<f64> = zs.into_iter().map(f64::from_bits).collect();
    let jpeg = generation::contact_sheet(catalog, generator, Some(&catalog.experience(parent)?), &zs)?;
    let levels: Vec<String> = zs.iter().map(|z| format!("z = {z}")).collect();
    let caption = format!("recorded, {}, and the hour it mimics as recorded on the training route", levels.join(", "));
    Ok((jpeg, caption))
}

/// Good matches over domainness.
fn make_curve(catalog: &Catalog, parent: ExperienceId, gates: &[GateRecord]) -> Result<GateCurve, Failure> {
    let points = gates.iter().map(|gate| &gate.measures);
    Ok(GateCurve {
        parent: format!("{}, experience {}", catalog.experience(parent)?.slot, parent.short()),
        points: points.map(|m| GatePoint { z: m.z, good_matches: m.good_matches, matchable: m.matchable }).collect(),
    })
}
