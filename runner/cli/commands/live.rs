use super::matrix::read_single;
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_model::TimeSlot;
use furrow_runner::live::{LiveHub, Localisers, Seen};
use furrow_runner::localiser::hub::{Decision, Moment, PairAnswer, PairId};
use furrow_runner::plan::{LivePass, Plan};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// Drive a live pass of a matrix as it happened: each frame against all experiences of the axis at once, on the clock.
///
/// Every experience has a localiser of its own that works on the newest frame and skips what went by meanwhile; the control hub keeps the best
/// fresh answer. With --lockstep every localiser answers every frame, as fast as the machine can: the decisions are those of `furrow run`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow live matrix.toml                      # the first live pass, at its own pace\n  \
furrow live matrix.toml --at 08:00 --speed 2\n  furrow live matrix.toml --lockstep --json"
)]
pub struct Live {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
    /// The slot of the live pass; the first of the axis where left out.
    #[arg(long, value_name = "HH:MM")]
    at: Option<TimeSlot>,
    /// How many times faster than it was driven.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, conflicts_with = "lockstep")]
    speed: f64,
    /// Every localiser answers every frame, without a clock.
    #[arg(long)]
    lockstep: bool,
}

/// A decision as programs read it.
#[derive(Debug, Serialize)]
struct DecisionView {
    stamp_ns: i64,
    travelled_m: f64,
    /// The experience that localises; none where lost.
    experience: Option<String>,
    node_stamp_ns: Option<i64>,
    inliers: Option<u32>,
    /// Age of the frame that the answer is about.
    age_s: Option<f64>,
    runner_up: Option<String>,
}

/// What became of a drive.
#[derive(Debug, Serialize)]
struct Drive {
    live: TimeSlot,
    threshold_inliers: u32,
    experiences: Vec<String>,
    /// Frames of the pass, and how many were looked at at all.
    frames: usize,
    looked_at: usize,
    localised: usize,
    wall_s: f64,
    steps_per_s: f64,
    /// Frames that a localiser never saw, because it was at work on an earlier one.
    skipped: Vec<(String, u64)>,
    decisions: Vec<DecisionView>,
}

impl Live {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if !(self.speed > 0.0 && self.speed.is_finite()) {
            return Err(Failure::usage(format!(
                "--speed {} is no factor: expected a number above 0, as in 2",
                self.speed
            )));
        }
        let catalog = context.catalog()?;
        let plan = read_single(&catalog, &self.matrix)?;
        let live = self.pass(&plan)?;
        let bar = Bar::units();
        let localisers = Localisers::prepare(&catalog, &plan, live, &|progress| {
            bar.show(progress.stage, progress.done, progress.total)
        });
        bar.finish();
        let drive = self.drive(&plan.lives[live], Arc::new(localisers?), context)?;
        if context.json {
            print_json(&drive)?;
        } else {
            print(&told(&drive))?;
        }
        Ok(Ending::Done)
    }

    fn pass(&self, plan: &Plan) -> Result<usize, Failure> {
        let slots = || plan.lives.iter().map(|pass| pass.record.slot.to_string()).collect::<Vec<_>>().join(", ");
        match (self.at, plan.lives.is_empty()) {
            (_, true) => {
                Err(Failure::new("no live pass of the matrix is in the store: `furrow plan` says what is missing"))
            }
            (None, false) => Ok(0),
            (Some(slot), false) => plan
                .lives
                .iter()
                .position(|pass| pass.record.slot == slot)
                .ok_or_else(|| Failure::new(format!("no live pass at {slot}: the matrix has {}", slots()))),
        }
    }

    fn drive(&self, pass: &LivePass, localisers: Arc<Localisers>, context: &Context) -> Result<Drive, Failure> {
        let labels: Vec<String> = localisers.experiences().map(|(_, label, _)| label.to_owned()).collect();
        let mut hub: LiveHub<Seen> = LiveHub::default();
        let (failed, failures) = channel();
        for number in 0..labels.len() {
            let (localisers, failed) = (Arc::clone(&localisers), failed.clone());
            hub.add(PairId(number as u32), move |seen| {
                localisers.answer(number, seen).unwrap_or_else(|error| {
                    // Nobody listens any more where the drive has ended on another failure.
                    drop(failed.send(error));
                    PairAnswer::NewPlace
                })
            });
        }
        let moments: Vec<Moment> = pass
            .chain
            .poses()
            .iter()
            .map(|pose| Moment { stamp_ns: pose.stamp_ns, travelled_m: pose.travelled_m })
            .collect();
        let (begun, mut decisions, mut next) = (Instant::now(), Vec::new(), 0);
        while let Some(frame) = self.newest(&moments, next, begun) {
            next = frame + 1;
            let seen = localisers.look_at(&pass.frames[frame])?;
            hub.offer(moments[frame], seen);
            if self.lockstep {
                hub.settle();
            }
            if let Ok(error) = failures.try_recv() {
                return Err(error.into());
            }
            let decision = DecisionView::of(moments[frame], &hub.decide(moments[frame]), &labels);
            if !context.json {
                print(&decision.line())?;
            }
            decisions.push(decision);
        }
        hub.settle();
        let wall_s = begun.elapsed().as_secs_f64();
        Ok(Drive {
            live: pass.record.slot,
            threshold_inliers: localisers.threshold(),
            frames: moments.len(),
            looked_at: decisions.len(),
            localised: decisions.iter().filter(|decision| decision.experience.is_some()).count(),
            wall_s,
            steps_per_s: decisions.len() as f64 / wall_s.max(1e-9),
            skipped: hub.skipped().map(|(pair, frames)| (labels[pair.0 as usize].clone(), frames)).collect(),
            experiences: labels,
            decisions,
        })
    }

    /// The newest frame that the camera has taken by now, from `next` on; waits for one where the robot has to drive first. In lockstep simply
    /// the next. `None` at the end of the pass.
    fn newest(&self, moments: &[Moment], next: usize, begun: Instant) -> Option<usize> {
        let first = moments.first()?.stamp_ns;
        let due = |i: usize| Duration::from_secs_f64((moments[i].stamp_ns - first).max(0) as f64 / 1e9 / self.speed);
        if next >= moments.len() || self.lockstep {
            return (next < moments.len()).then_some(next);
        }
        std::thread::sleep(due(next).saturating_sub(begun.elapsed()));
        let now = begun.elapsed();
        Some(next + (next + 1..moments.len()).take_while(|i| due(*i) <= now).count())
    }
}

impl DecisionView {
    fn of(moment: Moment, decision: &Decision, labels: &[String]) -> Self {
        let label = |pair: PairId| labels[pair.0 as usize].clone();
        let winner = decision.winner.as_ref();
        Self {
            stamp_ns: moment.stamp_ns,
            travelled_m: moment.travelled_m,
            experience: winner.map(|winner| label(winner.pair)),
            node_stamp_ns: winner.map(|winner| winner.candidate.node_stamp_ns),
            inliers: winner.map(|winner| winner.candidate.inliers),
            age_s: winner.map(|winner| winner.age_ns as f64 / 1e9),
            runner_up: decision.runner_up.as_ref().map(|second| label(second.pair)),
        }
    }

    fn line(&self) -> String {
        let place = match (&self.experience, self.inliers, self.age_s) {
            (Some(experience), Some(inliers), Some(age_s)) => {
                format!("{experience:<24} {inliers:>4} inliers, {age_s:.2} s old")
            }
            _ => "lost".to_owned(),
        };
        format!("{:8.2} m  {place}\n", self.travelled_m)
    }
}

fn told(drive: &Drive) -> String {
    let skipped: Vec<String> = drive.skipped.iter().map(|(label, frames)| format!("{label}: {frames}")).collect();
    format!(
        "live {}: {} of {} frames looked at, {} localised ({} inliers and more), {:.1} steps/s over {} experiences\nframes that a localiser \
         skipped: {}\n",
        drive.live,
        drive.looked_at,
        drive.frames,
        drive.localised,
        drive.threshold_inliers,
        drive.steps_per_s,
        drive.experiences.len(),
        skipped.join(", ")
    )
}
