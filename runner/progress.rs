//! How a run reports how far it is: as data. Only the command makes words of it.

use furrow_model::TimeSlot;
use std::borrow::Cow;
use std::sync::atomic::{AtomicU64, Ordering};

/// A kind of work. What is counted as one unit stands with each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Features of the images that a codebook is trained on.
    VocabularyFeatures,
    /// Rounds of a vocabulary's training.
    VocabularyTraining,
    /// Images whose words are found.
    Words,
    /// Images that become small ones.
    SmallImages,
    /// Frames, then pairs of them, that a threshold is calibrated on.
    Calibration,
    /// Candidate nodes whose features are found.
    NodeFeatures,
    /// Live frames that are verified.
    Verification,
    /// Images that are painted.
    Painting,
    /// Images whose colours a generator is trained on.
    Colours,
    /// Images on which it is measured how evenly a generator moves.
    SwitchIndex,
    /// Images on which a generator is measured.
    GeneratorMeasures,
    /// Cells.
    Cells,
    /// Frames that are written to a recording.
    Export,
    /// Traversals that are ingested again.
    Reingestion,
    /// Tasks of a cluster.
    ClusterTasks,
}

/// Each stage's name in the catalogue's timings and in JSON. Names are stored: they never change.
const NAMES: [(Stage, &str); 15] = [
    (Stage::VocabularyFeatures, "features of the vocabulary images"),
    (Stage::VocabularyTraining, "training the vocabulary"),
    (Stage::Words, "words of"),
    (Stage::SmallImages, "small images"),
    (Stage::Calibration, "calibrating the threshold"),
    (Stage::NodeFeatures, "features of candidate nodes"),
    (Stage::Verification, "verifying"),
    (Stage::Painting, "painting"),
    (Stage::Colours, "colours at"),
    (Stage::SwitchIndex, "moving the generator from z = 0 to 1"),
    (Stage::GeneratorMeasures, "measuring the generator"),
    (Stage::Cells, "cells"),
    (Stage::Export, "exporting"),
    (Stage::Reingestion, "ingesting again"),
    (Stage::ClusterTasks, "tasks on the cluster"),
];

impl Stage {
    /// Its name in the catalogue's timings and in JSON.
    pub fn name(self) -> &'static str {
        NAMES.iter().find(|(stage, _)| *stage == self).map_or("", |(_, name)| name)
    }
}

/// What a stage works on, where it is not the only one of its kind.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Subject<'a> {
    /// There is only one.
    #[default]
    Whole,
    /// The live traversal at a slot.
    Live(TimeSlot),
    /// The experience of a label.
    Experience(Cow<'a, str>),
    /// Images of a slot.
    Slot(TimeSlot),
    /// Images that are to mimic a slot, at a domainness.
    Mimicked(TimeSlot, f64),
    /// Tasks, of which so many are running now.
    Running(usize),
}

impl<'a> Subject<'a> {
    /// An experience by its label.
    pub fn experience(label: &'a str) -> Self {
        Self::Experience(Cow::Borrowed(label))
    }

    /// Itself, to be kept.
    pub fn into_owned(self) -> Subject<'static> {
        match self {
            Self::Whole => Subject::Whole,
            Self::Live(slot) => Subject::Live(slot),
            Self::Experience(label) => Subject::Experience(Cow::Owned(label.into_owned())),
            Self::Slot(slot) => Subject::Slot(slot),
            Self::Mimicked(slot, domainness) => Subject::Mimicked(slot, domainness),
            Self::Running(tasks) => Subject::Running(tasks),
        }
    }
}

/// A stage's progress.
#[derive(Debug, Clone, PartialEq)]
pub struct StageProgress<'a> {
    /// What is being done.
    pub stage: Stage,
    /// On what.
    pub of: Subject<'a>,
    /// Units done.
    pub done: u64,
    /// Units in all.
    pub total: u64,
}

impl StageProgress<'_> {
    /// The progress of a stage that works on one thing only.
    pub fn whole(stage: Stage, done: u64, total: u64) -> Self {
        Self { stage, of: Subject::Whole, done, total }
    }
}

/// Receives progress, from any thread.
pub type Progress<'a> = &'a (dyn Fn(StageProgress<'_>) + Sync);

/// Counts the units of one stage.
pub(crate) struct Counter<'a> {
    progress: Progress<'a>,
    stage: Stage,
    of: Subject<'a>,
    total: u64,
    done: AtomicU64,
}

impl<'a> Counter<'a> {
    pub fn new(progress: Progress<'a>, (stage, of): (Stage, Subject<'a>), total: usize) -> Self {
        let counter = Self { progress, stage, of, total: total as u64, done: 0.into() };
        counter.report(0);
        counter
    }

    /// One more unit is done.
    pub fn tick(&self) {
        self.report(self.done.fetch_add(1, Ordering::Relaxed) + 1);
    }

    fn report(&self, done: u64) {
        (self.progress)(StageProgress { stage: self.stage, of: self.of.clone(), done, total: self.total });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_stage_has_its_stored_name() {
        let stored = [
            (Stage::VocabularyFeatures, "features of the vocabulary images"),
            (Stage::VocabularyTraining, "training the vocabulary"),
            (Stage::Words, "words of"),
            (Stage::SmallImages, "small images"),
            (Stage::NodeFeatures, "features of candidate nodes"),
            (Stage::Verification, "verifying"),
            (Stage::Painting, "painting"),
            (Stage::Colours, "colours at"),
            (Stage::Cells, "cells"),
        ];
        for (stage, name) in stored {
            assert_eq!(stage.name(), name, "stores of earlier versions have rows of this name");
        }
        let stages: BTreeSet<Stage> = NAMES.iter().map(|(stage, _)| *stage).collect();
        let names: BTreeSet<&str> = NAMES.iter().map(|(_, name)| *name).collect();
        assert_eq!((stages.len(), names.len()), (NAMES.len(), NAMES.len()));
    }
}
