//! Why the codebook or a generator must not be judged on a traversal: each question is asked once for all cells.

use super::draft::Draft;
use super::index::{ContenderIx, LiveIx};
use super::leakage::{Trained, leak};
use crate::RunError;
use crate::inputs::contender::Contender;
use furrow_model::ObjectId;

impl Draft<'_> {
    /// Why no cell of a live traversal can be run.
    pub(super) fn refusal(&self, live: LiveIx) -> Result<Option<String>, RunError> {
        if self.codebook.is_none() {
            return Ok(Some(self.traversals.no_vocabulary()));
        }
        let live = self.live(live);
        leak(self.catalog.objects(), &self.codebook_training(), &live.record, live.images())
    }

    fn codebook_training(&self) -> Trained<'_> {
        Trained { what: "the codebook's vocabulary traversal", traversals: &self.vocabulary }
    }

    /// Why a generator among the members must not be judged on a live traversal; looked up once for each generator.
    pub(super) fn generators_leak(
        &mut self,
        live: LiveIx,
        members: &[ContenderIx],
    ) -> Result<Option<String>, RunError> {
        for i in members {
            let Some(making) = &self.contender(*i).making else { continue };
            let key = (live, making.generator);
            if !self.known_leaks.contains_key(&key) {
                let traversal = self.live(live);
                let images: Vec<ObjectId> = traversal.images().collect();
                let leak = self.generator_leak(self.contender(*i), &traversal.record, images.into_iter())?;
                self.known_leaks.insert(key, leak);
            }
            if let Some(Some(reason)) = self.known_leaks.get(&key) {
                return Ok(Some(reason.clone()));
            }
        }
        Ok(None)
    }

    /// For each experience, why the codebook or its own generator must not be judged on it: looked up once, whatever
    /// cells it is in.
    pub(super) fn leaks(&self) -> Result<Vec<Option<String>>, RunError> {
        let leak_of = |contender: &Contender| {
            let trained = self.codebook_training();
            let parents = contender.making.as_ref().map_or(&contender.record, |making| &making.parent);
            let images = parents.nodes.iter().map(|node| node.left);
            match leak(self.catalog.objects(), &trained, &contender.traversal, images.clone())? {
                None => self.generator_leak(contender, &contender.traversal, images),
                known => Ok(known),
            }
        };
        self.contenders.iter().map(leak_of).collect()
    }
}
