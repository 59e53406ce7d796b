//! The control hub with a thread for each experience.

use super::mailbox::Mailbox;
use furrow_localiser::hub::{Decision, Freshness, Hub, Membership, Moment, PairAnswer, PairId};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

/// A frame on its way to the localisers.
type Letter<F> = (Moment, Arc<F>);

struct Worker<F> {
    membership: Membership,
    mailbox: Arc<Mailbox<Letter<F>>>,
    skipped: u64,
}

/// Localisers that work side by side, and the best of what they last said. Localisers come and go at any time; none
/// waits for another.
pub struct LiveHub<F> {
    hub: Arc<Mutex<Hub>>,
    workers: BTreeMap<PairId, Worker<F>>,
    threads: Vec<JoinHandle<()>>,
}

impl<F: Send + Sync + 'static> LiveHub<F> {
    /// A hub without localisers.
    pub fn new(hub: Hub) -> Self {
        Self { hub: Arc::new(Mutex::new(hub)), workers: BTreeMap::new(), threads: Vec::new() }
    }

    /// Adds a localiser, which answers frames on a thread of its own. One that was registered as `pair` before is
    /// removed.
    pub fn add(&mut self, pair: PairId, mut localise: impl FnMut(&F) -> PairAnswer + Send + 'static) -> Membership {
        self.remove(pair);
        let membership = lock(&self.hub).register(pair);
        let mailbox: Arc<Mailbox<Letter<F>>> = Arc::new(Mailbox::new());
        let (hub, letters) = (Arc::clone(&self.hub), Arc::clone(&mailbox));
        self.threads.retain(|thread| !thread.is_finished());
        self.threads.push(std::thread::spawn(move || {
            let letters = Closing(&letters);
            while let Some((moment, frame)) = letters.0.take() {
                let answer = localise(&frame);
                // Of a localiser that was removed meanwhile the hub takes no answer.
                lock(&hub).report(membership, moment, answer);
            }
        }));
        self.workers.insert(pair, Worker { membership, mailbox, skipped: 0 });
        membership
    }

    /// Removes a localiser; its answers are gone at once, also the one it is working on. False where there was none.
    pub fn remove(&mut self, pair: PairId) -> bool {
        let Some(worker) = self.workers.remove(&pair) else { return false };
        worker.mailbox.close();
        lock(&self.hub).deregister(worker.membership)
    }

    /// Hands a frame to every localiser. Those that are still at work find it when they are done, unless a newer one
    /// has come.
    pub fn offer(&mut self, moment: Moment, frame: F) {
        let frame = Arc::new(frame);
        for worker in self.workers.values_mut() {
            worker.skipped += u64::from(worker.mailbox.put((moment, Arc::clone(&frame))));
        }
    }

    /// What the hub says at moment `now`.
    pub fn decide(&self, now: Moment) -> Decision {
        lock(&self.hub).decide(now)
    }

    /// Waits until every localiser has answered what it was offered.
    pub fn settle(&self) {
        self.workers.values().for_each(|worker| worker.mailbox.settle());
    }

    /// How many frames each localiser never looked at, because newer ones came while it was at work.
    pub fn skipped(&self) -> impl Iterator<Item = (PairId, u64)> + '_ {
        self.workers.iter().map(|(pair, worker)| (*pair, worker.skipped))
    }
}

impl<F: Send + Sync + 'static> Default for LiveHub<F> {
    fn default() -> Self {
        Self::new(Hub::new(Freshness::DEFAULT))
    }
}

impl<F> Drop for LiveHub<F> {
    fn drop(&mut self) {
        self.workers.values().for_each(|worker| worker.mailbox.close());
        for thread in self.threads.drain(..) {
            // A localiser that panicked has said so on stderr; the others are none the worse.
            drop(thread.join());
        }
    }
}

/// Closes the box when its reader ends, however it ends: who waits for it must not wait for ever.
struct Closing<'a, T>(&'a Mailbox<T>);

impl<T> Drop for Closing<'_, T> {
    fn drop(&mut self) {
        self.0.close();
    }
}

fn lock(hub: &Mutex<Hub>) -> MutexGuard<'_, Hub> {
    // The hub changes in single assignments, which a panic elsewhere cannot tear.
    hub.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_localiser::hub::{Candidate, Reason};
    use std::sync::mpsc::channel;

    fn at(frame: u32) -> Moment {
        Moment { stamp_ns: i64::from(frame) * 100_000_000, travelled_m: f64::from(frame) * 0.1 }
    }

    /// A made-up answer that depends on frame and pair only.
    fn answer(frame: u32, pair: u32) -> PairAnswer {
        let number = (frame.wrapping_mul(2_654_435_761) ^ pair.wrapping_mul(40_503)) >> 5;
        let candidate = Candidate { node_stamp_ns: 7, log_likelihood: -f64::from(number % 9), inliers: number % 60 };
        match number % 5 {
            0 => PairAnswer::NewPlace,
            1 => PairAnswer::Rejected(candidate),
            _ => PairAnswer::Accepted(candidate),
        }
    }

    #[test]
    fn without_latency_it_decides_as_in_lockstep() {
        let mut lockstep = Hub::new(Freshness::DEFAULT);
        let memberships: Vec<Membership> = (0..5).map(|pair| lockstep.register(PairId(pair))).collect();
        let mut live: LiveHub<u32> = LiveHub::default();
        for pair in 0..5 {
            live.add(PairId(pair), move |frame| answer(*frame, pair));
        }
        let mut winners = 0;
        for frame in 0..300 {
            live.offer(at(frame), frame);
            live.settle();
            let answers: Vec<_> = memberships.iter().zip(0..).map(|(m, pair)| (*m, answer(frame, pair))).collect();
            let expected = lockstep.step(at(frame), &answers);
            winners += u32::from(expected.winner.is_some());
            assert_eq!(live.decide(at(frame)), expected, "frame {frame}");
        }
        assert!(winners > 100 && live.skipped().all(|(_, frames)| frames == 0));
    }

    #[test]
    fn a_slow_localiser_skips_stale_frames_and_stops_nobody() {
        let mut live: LiveHub<u32> = LiveHub::default();
        let (go, wait) = channel::<()>();
        let (seen, slow_saw) = channel();
        live.add(PairId(0), move |frame| {
            seen.send(*frame).unwrap();
            wait.recv().unwrap();
            answer(*frame, 0)
        });
        live.offer(at(0), 0);
        assert_eq!(slow_saw.recv(), Ok(0));
        live.add(PairId(1), |frame| {
            PairAnswer::Accepted(Candidate { node_stamp_ns: 1, log_likelihood: 0.0, inliers: *frame })
        });
        for frame in 1..20 {
            live.offer(at(frame), frame);
            live.workers[&PairId(1)].mailbox.settle();
        }
        let decision = live.decide(at(19));
        assert_eq!(decision.winner.map(|winner| (winner.pair, winner.candidate.inliers)), Some((PairId(1), 19)));
        assert_eq!(decision.reasons[0], (PairId(0), Reason::NoResult));
        go.send(()).unwrap();
        // It goes on with the newest frame; eighteen went by.
        assert_eq!(slow_saw.recv(), Ok(19));
        assert_eq!(live.skipped().collect::<Vec<_>>(), [(PairId(0), 18), (PairId(1), 0)]);
        go.send(()).unwrap();
        live.settle();
    }

    #[test]
    fn what_is_removed_is_gone_at_once_and_another_takes_over() {
        let mut live: LiveHub<u32> = LiveHub::default();
        let with = |inliers: u32| {
            move |_: &u32| PairAnswer::Accepted(Candidate { node_stamp_ns: 1, log_likelihood: 0.0, inliers })
        };
        live.add(PairId(0), with(90));
        live.add(PairId(1), with(50));
        live.offer(at(0), 0);
        live.settle();
        let winner = |live: &LiveHub<u32>, frame| live.decide(at(frame)).winner.map(|winner| winner.pair.0);
        assert_eq!(winner(&live, 0), Some(0));
        assert!(live.remove(PairId(0)) && !live.remove(PairId(0)));
        assert_eq!(winner(&live, 0), Some(1));
        // Added anew it begins without results, and wins with its first.
        live.add(PairId(0), with(90));
        assert_eq!(winner(&live, 0), Some(1));
        live.offer(at(1), 1);
        live.settle();
        assert_eq!(winner(&live, 1), Some(0));
    }

    #[test]
    fn an_answer_that_comes_after_the_removal_counts_for_nothing() {
        let mut live: LiveHub<u32> = LiveHub::default();
        let (go, wait) = channel::<()>();
        let (started, begun) = channel();
        live.add(PairId(3), move |_| {
            started.send(()).unwrap();
            wait.recv().unwrap();
            PairAnswer::Accepted(Candidate { node_stamp_ns: 1, log_likelihood: 0.0, inliers: 99 })
        });
        live.offer(at(0), 0);
        begun.recv().unwrap();
        live.remove(PairId(3));
        go.send(()).unwrap();
        while live.threads.iter().any(|thread| !thread.is_finished()) {
            std::thread::yield_now();
        }
        assert_eq!(live.decide(at(0)).winner, None);
    }
}
