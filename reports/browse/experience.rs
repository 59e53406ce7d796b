//! An experience beside its parent or its children.

use super::error::BrowseError;
use super::family::Family;
use super::places::site_key;
use super::reply::Reply;
use super::store::Store;
use crate::wording;
use furrow_model::ExperienceKind;
use serde::Serialize;

#[derive(Serialize)]
struct View {
    id: String,
    short: String,
    title: String,
    site: String,
    site_key: String,
    route: String,
    nodes: usize,
    width: u32,
    height: u32,
    facts: Vec<(String, String)>,
    digests: Vec<(String, String)>,
    traversals: Vec<(String, String)>,
    family: Family,
}

pub(super) fn page(store: &Store, typed: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let (id, record) = store.experience(&typed)?;
    let family = Family::of(store, &catalog, id)?;
    let traversals = catalog.traversals_of(family.parent_id)?;
    let traversals = traversals.iter().map(|row| (row.id.to_string(), row.id.short())).collect();
    let title = match &record.kind {
        ExperienceKind::Recorded => format!("Experience of {}", record.slot),
        ExperienceKind::Generated { mimics, domainness, .. } => {
            format!("Generated experience, z = {}, mimics {mimics}", domainness.0)
        }
    };
    let rig = &record.rig;
    let mut facts = vec![
        ("Nodes".to_owned(), wording::count(record.nodes.len() as u32)),
        (
            "Keyframes".to_owned(),
            format!("every {} m or {} rad", record.keyframes.distance_m, record.keyframes.yaw_rad),
        ),
        ("Slot".to_owned(), record.slot.to_string()),
        (
            "Rectified rig".to_owned(),
            format!("{} x {} pixels, focal length {:.1} pixels", rig.width, rig.height, rig.focal_px),
        ),
    ];
    if let ExperienceKind::Generated { generator, domainness, mimics, .. } = &record.kind {
        let name = catalog.generators()?.into_iter().find(|row| row.id == *generator).map(|row| row.name);
        facts.push(("Generator".to_owned(), wording::shown(&name.unwrap_or_else(|| generator.short()))));
        facts.push(("z".to_owned(), domainness.0.to_string()));
        facts.push(("Mimics".to_owned(), mimics.to_string()));
    }
    let mut digests = vec![
        ("Experience".to_owned(), id.to_string()),
        ("Chain (Parquet)".to_owned(), record.chain.to_string()),
        ("Calibration".to_owned(), record.calibration.to_string()),
    ];
    if let ExperienceKind::Generated { parent, generator, .. } = &record.kind {
        digests.push(("Parent".to_owned(), parent.to_string()));
        digests.push(("Generator".to_owned(), generator.to_string()));
    }
    let view = View {
        id: id.to_string(),
        short: id.short(),
        title,
        site: wording::shown(&record.site),
        site_key: site_key(&record.site),
        route: wording::shown(&record.route),
        nodes: record.nodes.len(),
        width: rig.width,
        height: rig.height,
        facts,
        digests,
        traversals,
        family,
    };
    store.render("experience.html", view)
}
