//! What the steps of one plan share: codebook, contenders as far as they are made, and how recognisers reach words.

use super::codebook::find_or_train_codebook;
use super::threshold::inlier_threshold;
use super::words::{WordImages, WordRules, ensure_words, words};
use crate::RunError;
use crate::generation::stage::make_contender;
use crate::inputs::codebook::CodebookPlan;
use crate::inputs::contender::Contender;
use crate::inputs::recogniser::Context;
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::{ReadyCodebook, Words};
use crate::plan::{ContenderIx, LiveIx, Plan};
use crate::progress::Progress;
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::{Catalog, Objects};

/// What all steps of a plan share.
pub(crate) struct Shared<'a> {
    pub catalog: &'a Catalog,
    pub plan: &'a Plan,
    pub progress: Progress<'a>,
    /// None until it is found or trained, and where the recogniser knows no words.
    pub codebook: Option<ReadyCodebook>,
    pub features: FeatureParameters,
    /// The plan's contenders, generated ones as far as they were made.
    contenders: Vec<Contender>,
    /// Why generators are to be doubted.
    pub doubts: Vec<String>,
    /// Bytes that verification stays within.
    pub memory: u64,
}

impl<'a> Shared<'a> {
    /// Nothing yet.
    pub fn new(catalog: &'a Catalog, plan: &'a Plan, progress: Progress<'a>) -> Result<Self, RunError> {
        let Some(spec) = &plan.codebook else {
            return Err(RunError::Codebook("the plan has cells but no codebook".to_owned()));
        };
        let (contenders, doubts) = (plan.contenders.clone(), Vec::new());
        let (features, memory) = (spec.features, super::memory::usual());
        Ok(Self { catalog, plan, progress, codebook: None, features, contenders, doubts, memory })
    }

    pub fn contender(&self, contender: ContenderIx) -> &Contender {
        &self.contenders[contender.0]
    }

    /// Finds or trains the codebook, if the recogniser has words.
    pub fn prepare_codebook(&mut self) -> Result<(), RunError> {
        let codebook = codebook_of(self.plan).map(|spec| find_or_train_codebook(self.catalog, spec, self.progress));
        self.codebook = codebook.transpose()?;
        Ok(())
    }

    /// Gives a contender its own images, if it is generated.
    pub fn make(&mut self, contender: ContenderIx) -> Result<(), RunError> {
        // An axis may name one experience several times: each name has its own label and doubts, and the images are
        // painted for the first.
        let planned = self.plan.contender(contender).id;
        for (own, plan) in self.contenders.iter_mut().zip(&self.plan.contenders) {
            if plan.id == planned {
                let (made, doubts) = make_contender(self.catalog, own, self.progress)?;
                *own = made;
                self.doubts.extend(doubts);
            }
        }
        Ok(())
    }

    /// Computes the words of a live traversal's frames or of a contender's nodes if the store does not have them.
    pub fn ensure_words(&self, images: &WordImages<'_>) -> Result<(), RunError> {
        ensure_words(self.objects(), images, self.word_rules()?, self.progress)
    }

    fn word_rules(&self) -> Result<WordRules<'_>, RunError> {
        Ok(WordRules { codebook: self.codebook()?, features: self.features })
    }

    /// The inliers that a localisation of this traversal needs: what wrong places reach by chance depends on how many
    /// cameras look.
    pub fn threshold(&self, live: LiveIx) -> Result<u32, RunError> {
        let rig = &self.plan.live(live).record.rig;
        inlier_threshold(self.catalog.objects(), self.plan, rig, self.features, self.progress)
    }
}

impl Context for Shared<'_> {
    fn objects(&self) -> &Objects {
        self.catalog.objects()
    }

    fn progress(&self) -> Progress<'_> {
        self.progress
    }

    fn codebook(&self) -> Result<&ReadyCodebook, RunError> {
        self.codebook.as_ref().ok_or_else(|| RunError::Codebook("there is none, and words are asked for".to_owned()))
    }

    fn live_words(&self, live: &LiveTraversal) -> Result<Words, RunError> {
        words(self.objects(), &WordImages::of_live(live), self.word_rules()?, self.progress)
    }

    fn contender_words(&self, contender: &Contender) -> Result<Words, RunError> {
        words(self.objects(), &WordImages::of_contender(contender), self.word_rules()?, self.progress)
    }
}

/// The codebook that the recogniser of a plan needs, where it has words.
pub(crate) fn codebook_of(plan: &Plan) -> Option<&CodebookPlan> {
    plan.codebook.as_ref().filter(|_| plan.recogniser.needs_codebook())
}
