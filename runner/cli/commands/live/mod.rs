//! `furrow live`: a live traversal replayed against all experiences at once: the clock, and what is printed. Deciding
//! belongs to `furrow_runner::live`.

mod decision;
mod replay;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::MatrixFile;
use crate::output::{print, print_json};
use crate::progress::with_bar;
use furrow_model::TimeSlot;
use furrow_runner::live::Localisers;
use furrow_runner::plan::{LiveIx, Plan};
use replay::{Pace, replay};
use std::sync::Arc;

/// Replay a live traversal of a matrix on the clock, each frame against all experiences of the axis at once.
///
/// Every experience has a localiser of its own, on its own thread. It takes the newest frame and skips those that came
/// while it computed; the control hub keeps the best fresh answer. With --lockstep every localiser answers every frame,
/// as fast as the machine can: the decisions are those of `furrow run`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  \
furrow live matrix.toml                      # the first live traversal, at its own pace\n  \
furrow live matrix.toml --at 08:00 --speed 2\n  furrow live matrix.toml --lockstep --json")]
pub struct Live {
    #[command(flatten)]
    matrix: MatrixFile,
    /// The slot of the live traversal. [default: the first of the live axis]
    #[arg(long, value_name = "HH:MM")]
    at: Option<TimeSlot>,
    /// How many times faster than it was recorded.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, conflicts_with = "lockstep")]
    speed: f64,
    /// Have every localiser answer every frame, without a clock.
    #[arg(long)]
    lockstep: bool,
}

impl Live {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if !(self.speed > 0.0 && self.speed.is_finite()) {
            return Err(Failure::usage(format!("--speed {}: expected a factor above 0, as in 2", self.speed)));
        }
        let catalog = context.catalog()?;
        let plan = self.matrix.read_single(&catalog)?;
        let live = self.choose_traversal(&plan)?;
        let localisers = with_bar(|progress| Localisers::prepare(&catalog, &plan, live, progress))?;
        let pace = if self.lockstep { Pace::Lockstep } else { Pace::Clock { speed: self.speed } };
        let replayed = replay(plan.live(live), &Arc::new(localisers), pace, |decision| match context.json {
            true => Ok(()),
            false => print(&decision.line()),
        })?;
        if context.json {
            print_json(&replayed)?;
        } else {
            print(&replayed.text())?;
        }
        Ok(Ending::Done)
    }

    fn choose_traversal(&self, plan: &Plan) -> Result<LiveIx, Failure> {
        let slots =
            || plan.lives.iter().map(|traversal| traversal.record.slot.to_string()).collect::<Vec<_>>().join(", ");
        match (self.at, plan.lives.is_empty()) {
            (_, true) => {
                Err(Failure::new("no live traversal of the matrix is in the store: `furrow plan` says what is missing"))
            }
            (None, false) => Ok(LiveIx(0)),
            (Some(slot), false) => plan
                .lives
                .iter()
                .position(|traversal| traversal.record.slot == slot)
                .map(LiveIx)
                .ok_or_else(|| Failure::new(format!("no live traversal at {slot}: the matrix has {}", slots()))),
        }
    }
}
