use furrow_localiser::Hub;
use furrow_localiser::hub::{Candidate, Freshness, Membership, Moment, PairAnswer, PairId, Reason, Receipt};
use proptest::prelude::*;

const SECOND: i64 = 1_000_000_000;

fn at(seconds: f64, travelled_m: f64) -> Moment {
    Moment { stamp_ns: (seconds * SECOND as f64) as i64, travelled_m }
}

fn accepted(inliers: u32, log_likelihood: f64) -> PairAnswer {
    PairAnswer::Accepted(Candidate { node_stamp_ns: 5, log_likelihood, inliers })
}

fn rejected(inliers: u32) -> PairAnswer {
    PairAnswer::Rejected(Candidate { node_stamp_ns: 5, log_likelihood: 0.0, inliers })
}

fn hub_of(pairs: u32) -> (Hub, Vec<Membership>) {
    let mut hub = Hub::new(Freshness::DEFAULT);
    let memberships = (0..pairs).map(|pair| hub.register(PairId(pair))).collect();
    (hub, memberships)
}

fn winner(hub: &Hub, now: Moment) -> Option<u32> {
    hub.decide(now).winner.map(|winner| winner.pair.0)
}

#[test]
fn every_pair_gets_its_reason() {
    let (mut hub, m) = hub_of(6);
    hub.report(m[4], at(8.9, 0.0), accepted(99, 0.0));
    let answers =
        [(m[0], accepted(20, 0.0)), (m[1], accepted(30, 0.0)), (m[2], rejected(50)), (m[3], PairAnswer::NewPlace)];
    let decision = hub.step(at(10.0, 0.5), &answers);
    let reasons: Vec<Reason> = decision.reasons.iter().map(|(_, reason)| *reason).collect();
    use Reason::{Accepted, NewPlace, NoResult, Outvoted, Rejected, Stale};
    assert_eq!(reasons, [Outvoted, Accepted, Rejected, NewPlace, Stale, NoResult]);
    assert_eq!(decision.winner.map(|w| (w.pair, w.candidate.inliers, w.age_ns)), Some((PairId(1), 30, 0)));
    assert_eq!(decision.runner_up.map(|r| r.pair), Some(PairId(0)));
}

#[test]
fn where_two_must_agree_one_is_alone() {
    let mut hub = Hub::new(Freshness::DEFAULT).needing(2);
    let m: Vec<Membership> = (0..3).map(|pair| hub.register(PairId(pair))).collect();
    let alone = hub.step(at(1.0, 0.0), &[(m[0], rejected(9)), (m[1], accepted(90, 0.0)), (m[2], PairAnswer::NewPlace)]);
    assert_eq!((alone.winner, alone.runner_up), (None, None));
    assert_eq!(alone.reasons[1].1, Reason::Alone);
    let together = hub.step(at(2.0, 0.0), &[(m[0], accepted(30, 0.0)), (m[1], accepted(40, 0.0))]);
    assert_eq!(together.winner.map(|winner| winner.pair), Some(PairId(1)));
    assert_eq!(together.runner_up.map(|second| second.pair), Some(PairId(0)));
}

#[test]
fn ties_go_to_likelihood_then_the_newer_then_the_lower_id() {
    let (mut hub, m) = hub_of(4);
    hub.report(m[3], at(0.2, 0.0), accepted(20, -5.0));
    hub.report(m[2], at(0.2, 0.0), accepted(20, -5.0));
    hub.report(m[1], at(0.1, 0.0), accepted(20, -5.0));
    hub.report(m[0], at(0.3, 0.0), accepted(20, -6.0));
    let mut order = Vec::new();
    while let Some(pair) = winner(&hub, at(0.3, 0.0)) {
        order.push(pair);
        assert!(hub.deregister(m[pair as usize]));
    }
    assert_eq!(order, [2, 3, 1, 0]);
}

#[test]
fn one_second_and_one_metre_are_still_fresh() {
    let (mut hub, m) = hub_of(1);
    hub.report(m[0], at(10.0, 5.0), accepted(20, 0.0));
    let just_late = Moment { stamp_ns: 11 * SECOND + 1, travelled_m: 5.0 };
    assert_eq!(winner(&hub, at(11.0, 6.0)), Some(0));
    assert_eq!(winner(&hub, just_late), None);
    assert_eq!(winner(&hub, at(10.0, 6.001)), None);
    assert_eq!(winner(&hub, at(10.0, f64::NAN)), None);
    assert_eq!(winner(&hub, at(9.9, 5.0)), None, "a result from a later moment");
}

#[test]
fn a_newer_no_match_replaces_and_a_late_result_does_not() {
    let (mut hub, m) = hub_of(1);
    assert_eq!(hub.report(m[0], at(1.0, 0.0), accepted(200, 0.0)), Receipt::Kept);
    assert_eq!(hub.report(m[0], at(1.2, 0.0), PairAnswer::NewPlace), Receipt::Kept);
    assert_eq!(hub.report(m[0], at(1.1, 0.0), accepted(200, 0.0)), Receipt::Late);
    assert_eq!(winner(&hub, at(1.2, 0.0)), None);
}

#[test]
fn removing_the_winner_hands_over_at_once_and_its_late_results_are_discarded() {
    let (mut hub, m) = hub_of(2);
    hub.step(at(1.0, 0.0), &[(m[0], accepted(20, 0.0)), (m[1], accepted(40, 0.0))]);
    assert!(hub.deregister(m[1]) && !hub.deregister(m[1]));
    assert_eq!(winner(&hub, at(1.0, 0.0)), Some(0));
    let again = hub.register(PairId(1));
    assert_eq!(hub.report(m[1], at(1.1, 0.0), accepted(40, 0.0)), Receipt::Departed);
    assert_eq!(winner(&hub, at(1.1, 0.0)), Some(0));
    assert_eq!(hub.report(again, at(1.1, 0.0), accepted(40, 0.0)), Receipt::Kept);
    assert_eq!(winner(&hub, at(1.1, 0.0)), Some(1));
    assert_eq!(hub.pairs().collect::<Vec<_>>(), [PairId(0), PairId(1)]);
}

fn answer() -> impl Strategy<Value = PairAnswer> {
    let scored = (10u32..14, -2i8..2).prop_map(|(inliers, likelihood)| accepted(inliers, f64::from(likelihood)));
    prop_oneof![3 => scored, 1 => Just(rejected(3)), 1 => Just(PairAnswer::NewPlace)]
}

proptest! {
    #[test]
    fn the_winner_is_the_best_latest_fresh_result(reports in proptest::collection::vec((0usize..5, 0i64..30, answer()), 0..40)) {
        let (mut hub, m) = hub_of(5);
        let moment = |tenths: i64| Moment { stamp_ns: tenths * SECOND / 10, travelled_m: tenths as f64 * 0.05 };
        reports.iter().for_each(|&(pair, tenths, answer)| { hub.report(m[pair], moment(tenths), answer); });
        let now = 29;
        let latest = |pair: usize| {
            let newest = reports.iter().filter(|report| report.0 == pair).map(|report| report.1).max();
            reports.iter().rfind(|report| report.0 == pair && Some(report.1) == newest)
        };
        let offers = (0..5).filter_map(latest).filter(|report| now - report.1 <= 10);
        let key = |&&(pair, tenths, answer): &&(usize, i64, PairAnswer)| match answer {
            PairAnswer::Accepted(c) => Some((c.inliers, c.log_likelihood as i64, tenths, -(pair as i64))),
            _ => None,
        };
        let expected = offers.filter_map(|report| key(&report)).max().map(|key| -key.3 as u32);
        prop_assert_eq!(winner(&hub, moment(now)), expected);
    }
}
