//! The generation stage of a run: experiences of the axis that are generated are made, and their generators measured.

use super::painter::Painter;
use super::{generate, register_named};
use crate::RunError;
use crate::generation::gate::gate;
use crate::inputs::contender::Contender;
use crate::progress::Progress;
use furrow_catalog::Catalog;

/// A contender as it localises: generated ones with their own images. With it, why its generator is to be doubted.
pub(crate) fn make_contender(
    catalog: &Catalog,
    contender: &Contender,
    progress: Progress<'_>,
) -> Result<(Contender, Vec<String>), RunError> {
    let Some(making) = &contender.making else { return Ok((contender.clone(), Vec::new())) };
    register_named(catalog, &making.record)?;
    let painter = Painter::load(catalog, &making.record)?;
    let made = generate(catalog, &making.request(), &painter, progress)?;
    let gates =
        gate(catalog, &making.parent, (making.generator, &painter), &[making.domainness], making.seed, progress)?;
    let name = &making.record.name;
    let doubts = gates
        .iter()
        .flat_map(|gate| &gate.doubts)
        .map(|doubt| format!("generator '{name}' on {}: {doubt}", contender.label));
    let doubts = doubts.collect();
    Ok((Contender { id: made.id, record: made.experience, ..contender.clone() }, doubts))
}
