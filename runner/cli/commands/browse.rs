use super::report::{contrast_input, report_input};
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_catalog::records::{self, GateRecord, RunRecord, TraversalRecord};
use furrow_catalog::{Catalog, Objects};
use furrow_model::{ObjectId, Outcome, RunId};
use furrow_reports::browse::{Agreement, BrowseError, Browser, GateReading, Insight, TrueTrack, insight::ViewPoint};
use furrow_reports::{ContrastInput, page};
use furrow_runner::evaluate::truth::{Frame, GroundTruth};
use furrow_runner::export::pictures;
use furrow_runner::inputs::zone::SiteClock;

/// Show the store in a web browser, read only: sites, traversals, experiences, runs.
///
/// Serves pages to this machine only, at the address that is printed, until Ctrl-C. Changes nothing in the store.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow browse\n  furrow browse --port 8080")]
pub struct Browse {
    /// The port on 127.0.0.1; 0 takes any that is free.
    #[arg(long, default_value_t = 0)]
    port: u16,
}

impl Browse {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let root = context.root()?;
        let browser = Browser::listen(&root, Box::new(Computed), self.port)?;
        if context.json {
            print_json(&serde_json::json!({ "url": browser.url(), "port": browser.port(), "store": root }))?;
        } else {
            print(&format!("{}\n", browser.url()))?;
            eprintln!("serving the catalogue of {} until Ctrl-C", root.display());
        }
        browser.serve()?;
        Ok(Ending::Done)
    }
}

/// Computes what pages ask for.
struct Computed;

fn insight_error(error: impl std::fmt::Display) -> BrowseError {
    BrowseError::Insight(error.to_string())
}

impl Insight for Computed {
    fn day(&self, catalog: &Catalog, traversal: &TraversalRecord, stamp_ns: i64) -> Result<String, BrowseError> {
        let clock = SiteClock::of(catalog, traversal).map_err(insight_error)?;
        Ok(clock.day(stamp_ns, traversal.slot))
    }

    fn keypoints(&self, objects: &Objects, at: ViewPoint<'_>) -> Result<Vec<[f32; 3]>, BrowseError> {
        pictures::keypoints(objects, at.traversal, at.frame).map_err(insight_error)
    }

    fn agreement(
        &self,
        objects: &Objects,
        at: ViewPoint<'_>,
        node: ObjectId,
        calibration: ObjectId,
    ) -> Result<Agreement, BrowseError> {
        let found = pictures::common(objects, at.traversal, at.frame, (node, calibration)).map_err(insight_error)?;
        Ok(Agreement { matches: found.matches, lines: found.lines })
    }

    fn true_track(
        &self,
        objects: &Objects,
        traversal: &TraversalRecord,
        frame_of: Option<&TraversalRecord>,
        stamps_ns: &[i64],
    ) -> Result<Option<TrueTrack>, BrowseError> {
        let Some(truth) = GroundTruth::of(objects, traversal).map_err(insight_error)? else { return Ok(None) };
        let other = frame_of.map(|other| GroundTruth::of(objects, other)).transpose().map_err(insight_error)?.flatten();
        let truth = match &other {
            Some(other) => truth.in_frame_of(other),
            None => truth,
        };
        let position = |stamp_ns: &i64| truth.at(*stamp_ns).map(|pose| [pose.east_m, pose.north_m]);
        Ok(Some(TrueTrack {
            positions: stamps_ns.iter().map(position).collect(),
            relative: truth.frame == Frame::Geodetic,
            source: truth.source,
        }))
    }

    fn gate(&self, objects: &Objects, record: ObjectId) -> Result<GateReading, BrowseError> {
        let gate: GateRecord = records::read(objects, record)?;
        let m = &gate.measures;
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let mut figures = vec![
            ("good matches".to_owned(), format!("{:.0} of {:.0}", m.good_matches, m.matchable)),
            ("descriptor distance".to_owned(), format!("{:.4}", m.descriptor_distance)),
            ("detail (Laplacian) against the source".to_owned(), format!("{:.2}", m.laplacian_ratio)),
            ("clipped pixels".to_owned(), format!("{}, source {}", percent(m.clipped), percent(m.clipped_source))),
            ("invented keypoints".to_owned(), percent(m.hallucinated)),
        ];
        if let Some(switch) = &gate.switch {
            let text = format!("{:.1}, largest step at z = {:.2}", switch.kappa, switch.at);
            figures.push(("switch index".to_owned(), text));
        }
        Ok(GateReading { doubts: gate.doubts, figures })
    }

    fn contrasts(
        &self,
        objects: &Objects,
        run: &RunRecord,
        outcomes: &[&Outcome],
    ) -> Result<ContrastInput, BrowseError> {
        contrast_input(objects, &run.contrasts, outcomes).map_err(insight_error)
    }

    fn report(&self, catalog: &Catalog, run: RunId) -> Result<String, BrowseError> {
        let input = report_input(catalog, run, format!("furrow report {run} -o report.html")).map_err(insight_error)?;
        page(&input).map_err(insight_error)
    }
}
