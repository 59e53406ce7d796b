//! What an unfinished plan will cost, from what stages took in past runs of the same store. Nothing is computed here.

use crate::RunError;
use crate::inputs::codebook::codebook_key;
use crate::inputs::contender::Contender;
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::WordTables;
use crate::matrix::Trainer;
use crate::plan::{ContenderIx, LiveIx, Plan};
use crate::stages::verifying::{AnyVerifier, Verifier};
use crate::stages::words::words_key;
use crate::study::Study;
use crate::study::work;
use furrow_catalog::Catalog;
use furrow_catalog::records::record_id;
use furrow_model::{CodebookId, ExperienceId, ObjectId};
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
/// Verification and calibration of thresholds are only known to be due where the words are known; else they are counted as due.
///
/// # Errors
/// Where the store cannot be read.
pub fn estimate(catalog: &Catalog, study: &Study) -> Result<Vec<StageCost>, RunError> {
    let mut due = Due::default();
    for part in &study.parts {
        due.add(catalog, part)?;
    }
    let threads = rayon::current_num_threads() as f64;
    let mut costs = Vec::new();
    for (stage, units) in due.units {
        let past = catalog.timings(stage, RUNS)?;
        let (done, thread_s) = past.iter().fold((0.0, 0.0), |(done, thread_s), row| {
            (done + row.units as f64, thread_s + row.seconds * f64::from(row.threads))
        });
        let seconds = (done > 0.0).then(|| units as f64 * thread_s / done / threads);
        costs.push(StageCost { stage: stage.to_owned(), units, seconds });
    }
    Ok(costs)
}

/// Units by stage; what several settings need is counted once.
#[derive(Default)]
struct Due {
    units: BTreeMap<&'static str, u64>,
    seen: BTreeSet<ObjectId>,
}

impl Due {
    fn count(&mut self, stage: &'static str, key: ObjectId, units: usize) {
        if self.seen.insert(key) {
            *self.units.entry(stage).or_default() += units as u64;
        }
    }

    fn add(&mut self, catalog: &Catalog, part: &Plan) -> Result<(), RunError> {
        let objects = catalog.objects();
        let due = part.cells.iter().filter(|cell| cell.is_due());
        let pairs: BTreeSet<(LiveIx, ContenderIx)> =
            due.clone().flat_map(|cell| cell.members.iter().map(|member| (cell.live, *member))).collect();
        let Some(spec) = part.codebook.as_ref().filter(|_| !pairs.is_empty()) else { return Ok(()) };
        *self.units.entry(work::CELLS).or_default() += due.count() as u64;
        let key = codebook_key(spec);
        let codebook = objects.derived(key)?.map(|id| CodebookId(id.0));
        let words = part.recogniser.needs_codebook();
        if words && codebook.is_none() {
            self.count(work::FEATURES, key, spec.images.len());
            if spec.trainer == Trainer::KMeans {
                self.count(work::TRAINING, crate::inputs::key::key_of(work::TRAINING, &key), 15);
            }
        }
        for (_, member) in &pairs {
            let contender = part.contender(*member);
            if contender.making.as_ref().is_some_and(|making| !making.made) {
                self.count(work::PAINTING, ObjectId(contender.id.0), contender.record.nodes.len());
            }
        }
        for (live, member) in pairs {
            let (pass, contender) = (part.live(live), part.contender(member));
            let known = match codebook.filter(|_| words) {
                Some(codebook) => self.known(catalog, part, pass, member, codebook)?,
                None => false,
            };
            if known {
                continue;
            }
            let salt = |what: &str, id: ObjectId| crate::inputs::key::key_of(what, &(key, id));
            if words && codebook.is_none() {
                self.count(work::WORDS, salt("live", ObjectId(pass.id.0)), pass.frames.len());
                self.count(work::WORDS, salt("experience", ObjectId(contender.id.0)), contender.record.nodes.len());
            }
            self.count(work::VERIFYING, salt("verifying", ObjectId(pass.id.0)), pass.frames.len());
        }
        Ok(())
    }

    /// Whether a pair of live pass and experience is verified already; counts words that are missing.
    fn known(
        &mut self,
        catalog: &Catalog,
        part: &Plan,
        pass: &LiveTraversal,
        member: ContenderIx,
        codebook: CodebookId,
    ) -> Result<bool, RunError> {
        let (objects, contender) = (catalog.objects(), part.contender(member));
        let Some(spec) = &part.codebook else { return Ok(false) };
        let features = spec.features;
        let images: Vec<ObjectId> = pass.images().collect();
        let nodes: Vec<ObjectId> = contender.images().collect();
        let of_live = words_key(pass.record.calibration, &images, codebook, features);
        let of_map = words_key(contender.record.calibration, &nodes, codebook, features);
        let (live, map) = (objects.derived(of_live)?, objects.derived(of_map)?);
        if live.is_none() {
            self.count(work::WORDS, of_live, images.len());
        }
        if map.is_none() {
            self.count(work::WORDS, of_map, nodes.len());
        }
        let (Some(live), Some(map)) = (live, map) else { return Ok(false) };
        let tables = WordTables { codebook, live: (live, images.len()), map: (map, nodes.len()) };
        let Some(key) = part.recogniser.answers_key(pass, &tables) else { return Ok(false) };
        let Some(matches) = objects.derived(key)? else { return Ok(false) };
        // A generated experience is verified under its own id, not that of its making.
        let own = Contender { id: ExperienceId(record_id(&contender.record).0), ..contender.clone() };
        let candidates = part.matrix.localiser.candidates;
        let verified = match AnyVerifier::of(&pass.record.rig, features) {
            AnyVerifier::Three(verifier) => verifier.key(pass, &own, matches, candidates),
            AnyVerifier::Two(verifier) => verifier.key(pass, &own, matches, candidates),
        };
        Ok(objects.derived(verified)?.is_some())
    }
}
