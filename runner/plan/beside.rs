//! What stands beside a collective so that its answers can be judged: the parents of its generated members, and its first members.

use super::{Against, Contender, Draft};
use furrow_catalog::records::record_id;
use furrow_localiser::hub::Policy;
use furrow_model::ExperienceId;

impl Draft<'_> {
    /// The recorded parents of generated members, each once, in the order of the members: their places; or why there are none.
    pub(super) fn parents(&mut self, members: &[usize]) -> Result<Vec<usize>, String> {
        let mut places: Vec<usize> = Vec::new();
        for i in members {
            let Some(making) = self.contenders[*i].making.clone() else {
                return Err(
                    "parents stand beside generated experiences, and it has recorded ones: set parents = false \
                            or select generated ones"
                        .to_owned(),
                );
            };
            let id = ExperienceId(record_id(&making.parent).0);
            let known = self.contenders.iter().position(|contender| contender.id == id);
            let place = known.unwrap_or_else(|| {
                let label = making.parent_slot.to_string();
                let (slot, record) = (making.parent_slot, making.parent.clone());
                let parent = Contender { label, slot, id, record, making: None, ..self.contenders[*i].clone() };
                self.contenders.push(parent);
                self.contenders.len() - 1
            });
            if !places.contains(&place) {
                places.push(place);
            }
        }
        Ok(places)
    }
}

/// Collectives of the first two members, the first three, and so on up to all but the last (the first alone has its own cells): how many frames any of so many localises. Whichever member
/// has most inliers wins, so a frame is localised where any of them alone would be.
pub(super) fn union_of(label: &str, members: &[usize]) -> Vec<Against> {
    let first = |count: usize| Against {
        label: format!("{label} (any of the first {count})"),
        members: members[..count].to_vec(),
        policy: Policy::All,
    };
    (2..members.len()).map(first).collect()
}
