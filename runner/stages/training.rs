//! Training of a vocabulary that may be killed: every round's state lies in the store's `tmp/` until the vocabulary is
//! done. An ingest that clears `tmp/` in between costs the rounds, nothing else.

use crate::RunError;
use crate::progress::{Progress, Stage, StageProgress};
use furrow_catalog::{Catalog, to_json, write_file};
use furrow_localiser::Vocabulary;
use furrow_localiser::vocabulary::{KMeans, KMeansCheckpoint, TrainingRecord, TrainingSample};
use furrow_model::ObjectId;
use std::path::{Path, PathBuf};

/// Trains the codebook of `key` on `sample`, from the last round of an earlier attempt where there was one. The bytes
/// are those of a training that was never stopped.
pub(crate) fn train(
    catalog: &Catalog,
    key: ObjectId,
    sample: TrainingSample,
    progress: Progress<'_>,
) -> Result<(Vocabulary, TrainingRecord), RunError> {
    let state = state_of(catalog, key);
    // A state that cannot be taken up costs its rounds, no more.
    let taken_up = last_round(&state).and_then(|checkpoint| KMeans::resume(sample.clone(), checkpoint).ok());
    let begun = taken_up.map_or_else(|| KMeans::start(sample), Ok);
    let mut training = begun.map_err(|error| RunError::Codebook(error.to_string()))?;
    loop {
        let round = training.step();
        let (done, total) = (round.iteration as u64, round.max_iterations as u64);
        progress(StageProgress::whole(Stage::VocabularyTraining, done, total));
        if training.is_finished() {
            return Ok(training.finish());
        }
        write_file(&state, &to_json(&training.checkpoint())?)?;
    }
}

/// Removes the state, once the codebook of `key` is stored. Where it cannot be removed, the next ingest clears it away.
pub(crate) fn forget(catalog: &Catalog, key: ObjectId) {
    let _ = std::fs::remove_file(state_of(catalog, key));
}

fn state_of(catalog: &Catalog, key: ObjectId) -> PathBuf {
    catalog.unfinished_file(&format!("training-{key}.json"))
}

/// The state after the last round of an attempt; none where there is no file or an unreadable one, which costs rounds
/// only.
fn last_round(state: &Path) -> Option<KMeansCheckpoint> {
    serde_json::from_slice(&std::fs::read(state).ok()?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;

    fn sample() -> TrainingSample {
        let number = |i: u32, k: u32| (i.wrapping_mul(2_654_435_761).wrapping_add(k * 7919) % 1000) as f32 / 1000.0;
        let descriptors: Vec<[f32; 64]> =
            (0..2000).map(|i| std::array::from_fn(|k| number(i % 300, k as u32) + 0.1 * number(i, k as u32))).collect();
        let mut sample = TrainingSample::new(80, 3).unwrap();
        sample.offer(&descriptors).unwrap();
        sample
    }

    #[test]
    fn a_killed_training_goes_on_after_its_last_round() {
        let folder = tempfile::tempdir().unwrap();
        let catalog = Catalog::init(folder.path()).unwrap();
        let key = furrow_catalog::digest(b"a codebook");
        let state = catalog.unfinished_file(&format!("training-{key}.json"));
        let rounds = Mutex::new(Vec::new());
        let train = || {
            rounds.lock().unwrap().clear();
            let note_round = |progress: StageProgress<'_>| rounds.lock().unwrap().push(progress.done);
            let trained = train(&catalog, key, sample(), &note_round).unwrap();
            assert!(state.exists());
            forget(&catalog, key);
            assert!(!state.exists());
            (trained, rounds.lock().unwrap().clone())
        };
        let (straight, all) = train();
        assert!(all.len() > 3, "{all:?}");

        let mut killed = KMeans::start(sample()).unwrap();
        killed.step();
        killed.step();
        write_file(&state, &serde_json::to_vec(&killed.checkpoint()).unwrap()).unwrap();
        assert_eq!(train(), (straight.clone(), all[2..].to_vec()));

        write_file(&state, b"half a st").unwrap();
        assert_eq!(train(), (straight, all));
    }
}
