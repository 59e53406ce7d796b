use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::{CellFilter, MatrixFile};
use crate::output::print;
use crate::views::cells::{CellView, find_origins};
use crate::views::contrasts::{asked_json, asked_text};
use crate::views::listing::Listing;
use furrow_catalog::records::record_id;
use furrow_model::RunId;
use furrow_runner::study::estimate::{StageCost, estimate};
use serde_json::json;
use std::fmt::Write;

/// Show the cells of a matrix: which are finished and in what run, which are blocked and why, and the cost of the rest.
///
/// Computes nothing. The cost is estimated from the time that stages took in past runs of this store.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow plan matrix.toml\n  furrow plan matrix.toml --only 'live=08:00,words=6000'"
)]
pub struct PlanMatrix {
    #[command(flatten)]
    matrix: MatrixFile,
    #[command(flatten)]
    filter: CellFilter,
}

impl PlanMatrix {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let mut study = self.matrix.read(&catalog)?;
        self.filter.apply(&mut study)?;
        let run = RunId(record_id(&study.record(&catalog)?)?.0);
        let origins = find_origins(&catalog, run)?;
        let cells = study.cells().filter(|(_, cell)| cell.asked).map(|(part, cell)| {
            let view = match &cell.outcome {
                Some(outcome) => CellView::of(outcome, true),
                None => CellView::planned(
                    cell.key,
                    part.live(cell.live).record.slot,
                    &cell.label,
                    part.matrix.localiser.method(),
                ),
            };
            view.with_setting(&part.setting).with_origin(&origins)
        });
        let cells: Vec<CellView> = cells.collect();
        let costs = estimate(&catalog, &study)?;
        let more = vec![("estimate", json!(costs)), ("contrasts", asked_json(&study))];
        Listing { run, study: &study, cells: &cells, failed: &[] }.print(context, more)?;
        if !context.json {
            print(&(asked_text(&study) + &cost_text(&costs)))?;
        }
        Ok(Ending::Done)
    }
}

fn cost_text(costs: &[StageCost]) -> String {
    if costs.is_empty() {
        return "nothing is left to compute\n".to_owned();
    }
    let mut text = "still to compute:\n".to_owned();
    for cost in costs {
        let took = cost.seconds.map_or("unknown: no past run".to_owned(), |seconds| format!("about {seconds:.0} s"));
        let _ = writeln!(text, "  {:<36} {:>7}  {took}", cost.stage, cost.units);
    }
    let known: Vec<f64> = costs.iter().filter_map(|cost| cost.seconds).collect();
    if !known.is_empty() {
        let rest = if known.len() < costs.len() { ", and the unknown" } else { "" };
        let _ = writeln!(text, "  in all about {:.0} s on this machine{rest}", known.iter().sum::<f64>());
    }
    text
}
