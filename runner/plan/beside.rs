//! What stands beside a collective so that its answers can be judged: the parents of its generated members, and its
//! first members.

use super::draft::Draft;
use super::index::ContenderIx;
use crate::RunError;
use crate::inputs::contender::parent_of;

impl Draft<'_> {
    /// The members with the recorded parent in place of each generated one, each once, in their order: their places; or
    /// why there are none.
    pub(super) fn parents(&mut self, members: &[ContenderIx]) -> Result<Result<Vec<ContenderIx>, String>, RunError> {
        if members.iter().all(|i| self.contender(*i).making.is_none()) {
            let reason = "parents stand for generated experiences, and it has recorded ones only: set parents = false or select generated ones";
            return Ok(Err(reason.to_owned()));
        }
        let mut places: Vec<ContenderIx> = Vec::new();
        for i in members {
            let place = match parent_of(self.contender(*i))? {
                None => *i,
                Some(parent) => {
                    let known = self.contenders.iter().position(|known| known.id == parent.id);
                    ContenderIx(known.unwrap_or_else(|| {
                        self.contenders.push(parent);
                        self.contenders.len() - 1
                    }))
                }
            };
            if !places.contains(&place) {
                places.push(place);
            }
        }
        Ok(Ok(places))
    }
}
