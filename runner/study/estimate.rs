//! What an unfinished plan will cost, from what stages took in past runs of the same store. Nothing is computed here.

use crate::RunError;
use crate::plan::Plan;
use crate::progress::Stage;
use crate::stages::graph::{Graph, Part};
use crate::study::Study;
use furrow_catalog::Catalog;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Past runs that are looked at.
const RUNS: u32 = 8;

/// A stage that is to be computed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageCost {
    /// Its kind.
    pub stage: String,
    /// Images, frames, nodes or cells.
    pub units: u64,
    /// Wall clock on the threads at hand, seconds; none where no past run did this.
    pub seconds: Option<f64>,
}

/// What is still to be computed, by stage; a stage that the store has all of is not listed.
///
/// Verification and calibration of thresholds are only known to be due where the words are known; else they are counted
/// as due.
///
/// # Errors
/// Where the store cannot be read.
pub fn estimate(catalog: &Catalog, study: &Study) -> Result<Vec<StageCost>, RunError> {
    let mut units: BTreeMap<&'static str, u64> = BTreeMap::new();
    for (stage, more) in units_left(catalog, study)? {
        *units.entry(stage.name()).or_default() += more;
    }
    let threads = rayon::current_num_threads() as f64;
    let mut costs = Vec::new();
    for (stage, units) in units {
        let past = catalog.timings(stage, RUNS)?;
        let (done, thread_s) = past.iter().fold((0.0, 0.0), |(done, thread_s), row| {
            (done + row.units as f64, thread_s + row.seconds * f64::from(row.threads))
        });
        let seconds = (done > 0.0).then(|| units as f64 * thread_s / done / threads);
        costs.push(StageCost { stage: stage.to_owned(), units, seconds });
    }
    Ok(costs)
}

/// The work of all steps that are not finished; what several of them are of is counted once.
fn units_left(catalog: &Catalog, study: &Study) -> Result<Vec<(Stage, u64)>, RunError> {
    let part = |(setting, plan)| Part { setting, plan, cells: Plan::due_cells(plan) };
    let graph = Graph::new(study.parts.iter().enumerate().map(part).filter(|part| !part.cells.is_empty()).collect())?;
    let states = graph.states(catalog.objects())?;
    let left = graph.nodes().iter().zip(states).filter(|(_, state)| !state.is_finished());
    let mut seen = BTreeSet::new();
    let work = left.flat_map(|(node, _)| &node.work).filter(|work| seen.insert((work.stage, work.of)));
    Ok(work.map(|work| (work.stage, work.units)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stages::graph::example;

    #[test]
    fn units_are_those_of_the_graphs_unfinished_steps() {
        let folder = tempfile::tempdir().unwrap();
        let catalog = Catalog::init(folder.path()).unwrap();
        let plan = example::plan();
        let study = Study { matrix: plan.matrix.clone(), parts: vec![plan] };
        let units: Vec<(String, u64)> =
            estimate(&catalog, &study).unwrap().into_iter().map(|cost| (cost.stage, cost.units)).collect();
        let live: usize = example::LIVE_FRAMES.iter().sum();
        let expected = [
            ("cells", 4),
            ("features of the vocabulary images", example::VOCABULARY_IMAGES),
            ("painting", example::NODES),
            ("training the vocabulary", 15),
            ("verifying", live),
            ("words of", live + 2 * example::NODES),
        ];
        assert_eq!(units, expected.map(|(stage, units)| (stage.to_owned(), units as u64)));
    }
}
