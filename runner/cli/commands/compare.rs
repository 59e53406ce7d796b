use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::RunName;
use crate::output::{print, print_json};
use crate::views::cells::in_setting;
use furrow_runner::study::compare::{Comparison, compare};
use serde_json::json;
use std::fmt::Write;

/// Compare two runs cell by cell; with --max-drop, fail if the second is worse.
///
/// Cells are matched by live slot, name on the experience axis, and setting. With --max-drop the exit code is 3 if a
/// cell has fewer good localisations per 100 live frames in RUN_B than in RUN_A by more than is allowed, or if RUN_B
/// lacks it.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow compare 3fa8 latest\n  furrow compare 3fa8 latest --max-drop 2")]
pub struct Compare {
    /// The first run: its id, the beginning of it, or `latest`.
    #[arg(value_name = "RUN_A")]
    a: RunName,
    /// The second run.
    #[arg(value_name = "RUN_B")]
    b: RunName,
    /// The drop that is allowed in every cell, in good localisations per 100 live frames.
    #[arg(long, value_name = "POINTS", value_parser = parse_points)]
    max_drop: Option<f64>,
}

fn parse_points(text: &str) -> Result<f64, String> {
    let points = text.parse::<f64>().ok().filter(|points| (0.0..=100.0).contains(points));
    points.ok_or_else(|| "expected a number from 0 to 100, as in 2 or 0.5".to_owned())
}

impl Compare {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let (a, b) = (self.a.find(&catalog)?, self.b.find(&catalog)?);
        let comparison = compare(&catalog, a, b)?;
        let worse = self.max_drop.map_or(0, |points| comparison.worse_than(points).count());
        let broken = self.max_drop.is_some() && worse + comparison.missing() > 0;
        if context.json {
            print_json(
                &json!({ "comparison": comparison, "max_drop": self.max_drop, "worse": worse, "broken": broken }),
            )?;
        } else {
            let mut text = table(&comparison);
            if let Some(points) = self.max_drop {
                let _ = writeln!(
                    text,
                    "gate of {points} points: {worse} cells lost more, {} are missing: {}",
                    comparison.missing(),
                    if broken { "broken" } else { "held" }
                );
            }
            print(&text)?;
        }
        Ok(Ending::with_faults_if(broken))
    }
}

fn table(comparison: &Comparison) -> String {
    let labels = comparison.cells.iter().map(|cell| in_setting(&cell.experience, &cell.setting).chars().count());
    let wide = labels.max().unwrap_or(0).max(22);
    let mut text = format!("run {} and run {}\n", comparison.a.short(), comparison.b.short());
    let _ =
        writeln!(text, "live   {:<wide$}   good A   good B  change   lost A   lost B  wrong A  wrong B", "experience");
    for cell in &comparison.cells {
        let wrong = |wrong: Option<u32>| wrong.map_or("-".to_owned(), |wrong| wrong.to_string());
        let note = match (cell.same, cell.apart) {
            (true, _) => "  (the same cell)",
            (false, true) => "  (intervals apart)",
            (false, false) => "",
        };
        let _ = writeln!(
            text,
            "{:<6} {:<wide$} {:>8} {:>8} {:>+7.1} {:>6.1} % {:>6.1} % {:>8} {:>8}{note}",
            cell.live.to_string(),
            in_setting(&cell.experience, &cell.setting),
            cell.a.good,
            cell.b.good,
            cell.change_points,
            100.0 * cell.a.lost_fraction,
            100.0 * cell.b.lost_fraction,
            wrong(cell.a.wrong),
            wrong(cell.b.wrong),
        );
    }
    for cell in &comparison.unmatched {
        let name = in_setting(&cell.experience, &cell.setting);
        let _ = writeln!(text, "{:<6} {name:<wide$} only in run {}", cell.live.to_string(), cell.side.to_uppercase());
    }
    text
}
