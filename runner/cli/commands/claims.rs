use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_catalog::write_file;
use furrow_reports::{ClaimInput, ClaimsInput, RunInput, claims_page};
use furrow_runner::claims::{Claim, Evidence, claims};
use serde_json::json;
use std::fmt::Write;
use std::path::PathBuf;

/// Check the thesis' claims C1 to C11 against the latest runs of its experiments X01 to X15 in this store.
///
/// A claim holds, does not hold, is not separable within 95 % intervals, or was not measured. `make thesis` records
/// and runs all experiments.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow claims\n  furrow claims -o thesis.html --reports reports")]
pub struct Claims {
    /// Also write a page.
    #[arg(short, long, value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// The folder with the reports of the runs, as EXPERIMENT.html, for links from the page. Relative to the page.
    #[arg(long, value_name = "DIR", requires = "output")]
    reports: Option<PathBuf>,
}

impl Claims {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let (evidence, claims) = claims(&context.catalog()?)?;
        if let Some(output) = &self.output {
            write_file(output, claims_page(&self.input(&evidence, &claims, output))?.as_bytes())?;
            eprintln!("claims: {}", output.display());
        }
        if context.json {
            print_json(&json!({ "claims": claims }))?;
        } else {
            let mut text = String::new();
            for claim in &claims {
                let _ = writeln!(
                    text,
                    "{:<13} {}\n    thesis: {}\n    here:   {}\n    why:    {}",
                    claim.id, claim.verdict, claim.finding, claim.ours, claim.why
                );
            }
            print(&text)?;
        }
        Ok(Ending::Done)
    }

    fn input(&self, evidence: &Evidence, claims: &[Claim], output: &std::path::Path) -> ClaimsInput {
        let claim = |claim: &Claim| ClaimInput {
            id: claim.id.to_owned(),
            experiments: claim.experiments.to_owned(),
            finding: claim.finding.to_owned(),
            ours: claim.ours.clone(),
            verdict: claim.verdict.to_string(),
            why: claim.why.clone(),
        };
        let folder = output.parent().unwrap_or(std::path::Path::new(""));
        let report = |experiment: &str| {
            let file = self.reports.as_ref()?.join(format!("{experiment}.html"));
            folder.join(&file).is_file().then(|| file.display().to_string())
        };
        let runs = evidence.runs.iter().map(|(experiment, ran)| RunInput {
            experiment: experiment.clone(),
            name: ran.name.clone(),
            site: ran.site.clone(),
            run: ran.run.short(),
            cells: ran.cells.len(),
            missing: ran.missing,
            report: report(experiment),
        });
        ClaimsInput {
            claims: claims.iter().map(claim).collect(),
            runs: runs.collect(),
            command: format!("furrow claims -o {}", output.display()),
            furrow_version: env!("CARGO_PKG_VERSION").to_owned(),
        }
    }
}
