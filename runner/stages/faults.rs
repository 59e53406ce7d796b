//! What failed, and what fails with it.

use super::graph::NodeIx;
use crate::RunError;
use std::collections::BTreeMap;

/// Steps of a graph that failed, and whether the others go on.
pub(crate) struct Faults {
    pub keep_going: bool,
    /// Where each failure began, with the reason.
    failed: BTreeMap<NodeIx, (NodeIx, String)>,
}

impl Faults {
    pub fn new(keep_going: bool) -> Self {
        Self { keep_going, failed: BTreeMap::new() }
    }

    /// Whether nothing has failed.
    pub fn is_empty(&self) -> bool {
        self.failed.is_empty()
    }

    /// Why a step failed, if it did.
    pub fn reason(&self, node: NodeIx) -> Option<&str> {
        self.failed.get(&node).map(|(_, reason)| reason.as_str())
    }

    /// What was computed for some steps; where it failed and the others go on, nothing.
    pub fn take<T>(&mut self, computed: Result<T, RunError>, nodes: &[NodeIx]) -> Result<Option<T>, RunError> {
        match computed {
            Ok(value) => Ok(Some(value)),
            Err(error) => {
                let reason = error.to_string();
                nodes.iter().for_each(|node| _ = self.failed.entry(*node).or_insert_with(|| (*node, reason.clone())));
                if self.keep_going { Ok(None) } else { Err(error) }
            }
        }
    }

    /// Whether a step cannot be computed: it fails with the first of its needs that failed.
    pub fn is_blocked(&mut self, node: NodeIx, needs: &[NodeIx]) -> bool {
        let first = needs.iter().filter_map(|need| self.failed.get(need)).min_by_key(|(begun, _)| *begun);
        if let Some(fault) = first.cloned() {
            self.failed.entry(node).or_insert(fault);
        }
        self.failed.contains_key(&node)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_hangs_on_a_failed_step_fails_with_its_reason() {
        let mut faults = Faults::new(true);
        let wrong = |text: &str| Err::<(), _>(RunError::Codebook(text.to_owned()));
        assert!(faults.take(wrong("the second"), &[NodeIx(1)]).unwrap().is_none());
        assert!(faults.take(wrong("the first"), &[NodeIx(0)]).unwrap().is_none());
        assert!(!faults.is_blocked(NodeIx(2), &[]));
        assert!(faults.is_blocked(NodeIx(3), &[NodeIx(2), NodeIx(1)]));
        assert!(faults.is_blocked(NodeIx(4), &[NodeIx(3), NodeIx(0)]));
        assert_eq!(faults.reason(NodeIx(3)), Some("codebook: the second"));
        assert_eq!(faults.reason(NodeIx(4)), Some("codebook: the first"));
        assert_eq!(faults.reason(NodeIx(2)), None);
        assert!(Faults::new(false).take(wrong("at once"), &[NodeIx(0)]).is_err());
    }
}
