//! `furrow report`: a run as a page, and as files for other programs. Drawing belongs to
//! `furrow_reports`; here are options and file names.

mod cells;
mod files;
mod generators;
mod input;
mod pictures;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::WhichRun;
use crate::output::print_json;
use files::{DataForm, FigureForm, figures_folder, write_figures, write_pdf};
use furrow_catalog::write_file;
use furrow_reports::{latex, page};
use std::path::PathBuf;

pub use input::{contrast_input, report_input};

/// Write the report of a run: one self-contained HTML page, and its figures and numbers for other programs.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow report latest -o report.html\n  \
furrow report latest -o report.html --figures svg --data parquet   # into report-figures/\n  \
furrow report latest -o report.html --pdf report.pdf --latex tables.tex")]
pub struct Report {
    #[command(flatten)]
    which: WhichRun,
    /// The page to write.
    #[arg(short, long, value_name = "FILE.html")]
    output: PathBuf,
    /// Also write every figure with its data and its caption, into the folder PAGE-figures/ beside the page.
    #[arg(long, value_enum, value_name = "FORM")]
    figures: Option<FigureForm>,
    /// Also write the data of every figure there. [default: csv, with --figures]
    #[arg(long, value_enum, value_name = "FORM")]
    data: Option<DataForm>,
    /// Also print the page to a PDF file, with the Chromium that is installed.
    #[arg(long, value_name = "FILE.pdf")]
    pdf: Option<PathBuf>,
    /// Also write the numbers as LaTeX tables.
    #[arg(long, value_name = "FILE.tex")]
    latex: Option<PathBuf>,
}

impl Report {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let id = self.which.run.find(&catalog)?;
        let input = report_input(&catalog, id, format!("furrow report {id} -o {}", self.output.display()))?;
        let html = page(&input)?;
        write_file(&self.output, html.as_bytes())?;
        let mut files = vec![self.output.clone()];
        if self.figures.is_some() || self.data.is_some() {
            let (folder, data) = (figures_folder(&self.output), self.data.unwrap_or(DataForm::Csv));
            files.extend(write_figures(&folder, &input, self.figures, data)?);
        }
        if let Some(file) = self.latex {
            write_file(&file, latex(&input)?.as_bytes())?;
            files.push(file);
        }
        if let Some(file) = self.pdf {
            write_pdf(&file, &html)?;
            files.push(file);
        }
        if context.json {
            let (run, bytes) = (input.run, html.len());
            print_json(&serde_json::json!({ "run": run, "file": self.output, "bytes": bytes, "files": files }))?;
        } else {
            eprintln!("report: {}", self.output.display());
            if files.len() > 1 {
                eprintln!("and {} more files, the last {}", files.len() - 1, files[files.len() - 1].display());
            }
        }
        Ok(Ending::Done)
    }
}
