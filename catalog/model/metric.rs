//! What the numbers of a cell mean, in the words that the page, `furrow explain` and `--json` share.

/// A number of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Metric {
    /// Its key in `--json` and on the page.
    pub name: &'static str,
    /// The heading of its column.
    pub heading: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

/// When a place is right.
pub const RIGHT: &str = "right: by ground truth the place lies within 2.5 m of the live frame along the route (or the \
                         keyframe spacing, if that is more), within 2 m across, and looks within 15 degrees of the \
                         same way; a place of unknown truth is neither right nor wrong";

const fn metric_of(name: &'static str, heading: &'static str, meaning: &'static str) -> Metric {
    Metric { name, heading, meaning }
}

/// All of them, in the order of the page.
pub const METRICS: [Metric; 24] = [
    metric_of("frames", "frames", "live frames"),
    metric_of("good", "good", "good localisations: the returned place reached the threshold of inliers"),
    metric_of("percent_of_frames", "% of frames", "good localisations of 100 live frames; cells are ranked by it"),
    metric_of(
        "percent_good",
        "% of returned",
        "good localisations of 100 returned places (not \u{201c}new place\u{201d}); it may rise where fewer \
         frames are localised",
    ),
    metric_of(
        "jumps",
        "jumps",
        "consecutive good localisations that lie over 5 m further apart than the distance travelled between them",
    ),
    metric_of("lost_fraction", "lost", "fraction of the route travelled while lost"),
    metric_of("max_lost_m", "longest lost, m", "longest distance travelled without a localisation"),
    metric_of("mean_lost_m", "mean lost, m", "mean distance travelled without a localisation"),
    metric_of("correct", "right", "accepted and right, according to the ground truth"),
    metric_of("wrong", "wrong", "accepted and wrong, according to the ground truth"),
    metric_of("precision", "precision", "right / (right + wrong)"),
    metric_of("recall", "recall", "right / live frames that have a mapped place"),
    metric_of(
        "recall_of_answers",
        "recall of answers",
        "the verified candidate with most inliers is right, whatever the threshold; of the frames that have a \
         mapped place. What a collective's hub answers with",
    ),
    metric_of(
        "recall_at_full_precision",
        "recall at 100 %",
        "the greatest recall that some threshold gives without a wrong answer",
    ),
    metric_of(
        "recall_at_1",
        "recall@1",
        "the best candidate of a single experience, before verification, is right; of the frames that have a \
         mapped place. Candidates are nodes: neighbours on the route count one by one",
    ),
    metric_of("recall_at_5", "recall@5", "one of the five likeliest candidates before verification is right"),
    metric_of("recall_at_10", "recall@10", "one of the ten likeliest candidates before verification is right"),
    metric_of("recall_at_20", "recall@20", "one of the twenty likeliest candidates before verification is right"),
    metric_of("average_precision", "AP", "area under the precision-recall curve over all thresholds"),
    metric_of("false_positive_rate", "false pos.", "accepted fraction of the frames that have no mapped place"),
    metric_of("position_rmse_m", "rmse, m", "root mean square distance of accepted localisations to the true position"),
    metric_of("returned", "returned", "frames for which a place was returned, not \u{201c}new place\u{201d}"),
    metric_of("new_place", "new place", "frames answered \u{201c}new place\u{201d}"),
    metric_of("rejected", "rejected", "frames whose place did not reach the threshold"),
];

/// Those that are curves, told in each cell's lineage and in `--json`.
pub const CURVES: [Metric; 2] = [
    metric_of(
        "recall_within",
        "recall by tolerance",
        "accepted within so many metres of the true position, on the ground and whatever the heading; of the \
         frames that have a mapped place",
    ),
    metric_of(
        "route_recalled",
        "route by local recall",
        "fraction of the stretches of 10 m that have mapped frames in which at least this share of them is \
         localised right",
    ),
];

/// The metric of a name.
pub fn metric(name: &str) -> Option<&'static Metric> {
    METRICS.iter().chain(&CURVES).find(|metric| metric.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_metric_has_a_name_of_its_own() {
        for metric in METRICS.iter().chain(&CURVES) {
            assert_eq!(super::metric(metric.name), Some(metric), "{}", metric.name);
            assert!(!metric.heading.is_empty() && !metric.meaning.is_empty());
        }
    }
}
