//! Old Zoo.
use super::Plan;
/// Plan.
pub fn plan(seed: u64, longer: bool) -> Plan {
    super::backsburg::plan(seed, longer)
}
