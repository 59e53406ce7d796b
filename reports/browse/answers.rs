//! What a cell of a run answered for each frame of its live traversal.

use super::error::BrowseError;
use super::reply::Reply;
use super::store::Store;
use crate::figures::events::{EventRow, Events};
use crate::wording;
use furrow_catalog::{CatalogError, tables};
use furrow_model::{CellKey, ExperienceId, Outcome, TraversalId};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// An entry per frame of the traversal; null where the run did not ask about it.
pub(super) fn answers(store: &Store, (id, cell): (String, String)) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let unknown = || BrowseError::not_here("answer of a run to this traversal", &cell);
    let key: CellKey = cell.parse().map_err(|_| unknown())?;
    let traversal: TraversalId = id.parse().map_err(|_| unknown())?;
    let outcome = store.catalog()?.outcome(key)?.filter(|outcome| outcome.live_traversal == traversal);
    let outcome = outcome.ok_or_else(unknown)?;
    let table = tables::from_parquet("events", store.objects().read(outcome.events)?)?;
    let events = Events::read(&table).map_err(CatalogError::table("events"))?;
    let best: BTreeMap<i64, EventRow<'_>> =
        events.best_of_each_frame().into_iter().map(|row| (row.live_stamp_ns, row)).collect();
    let answer = |stamp_ns| best.get(&stamp_ns).map_or(Ok(Value::Null), |row| answer_of(store, &outcome, row));
    let answers: Vec<Value> =
        store.frames(&record)?.iter().map(|frame| answer(frame.stamp_ns)).collect::<Result<_, BrowseError>>()?;
    Ok(Reply::json(&json!({ "answers": answers })))
}

fn answer_of(store: &Store, outcome: &Outcome, row: &EventRow<'_>) -> Result<Value, BrowseError> {
    let member = outcome.members.iter().find(|member| member.id.to_string() == row.experience);
    let mut words = vec![row.decision.to_owned()];
    words.extend(row.inliers.map(|inliers| format!("{inliers} inliers (threshold {})", outcome.threshold_inliers)));
    words.extend(row.correct.map(|correct| if correct { "right".to_owned() } else { "wrong".to_owned() }));
    words.extend(row.error_m.map(|error| format!("{error:.1} m off")));
    words.extend(member.map(|member| format!("experience of {}", member.slot)));
    let node = match (row.node_stamp_ns, member) {
        (Some(stamp_ns), Some(member)) => node_of(store, member.id, stamp_ns)?,
        _ => None,
    };
    Ok(json!({
        "experience": member.map(|member| member.id.to_string()),
        "node": node,
        "text": wording::shown(&words.join(", ")),
        "accepted": row.is_accepted(),
    }))
}

/// Which node of an experience has a stamp.
fn node_of(store: &Store, experience: ExperienceId, stamp_ns: i64) -> Result<Option<usize>, BrowseError> {
    let (_, record) = store.experience(&experience.to_string())?;
    Ok(record.nodes.binary_search_by_key(&stamp_ns, |node| node.stamp_ns).ok())
}
