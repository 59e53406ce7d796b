use super::chosen_run;
use super::report_files::{DataForm, FigureForm, figures_folder, write_figures, write_pdf};
use super::report_input::report_input;
use crate::{Context, Ending, Failure, print_json};
use furrow_catalog::write_file;
use furrow_reports::{latex, page};
use std::path::PathBuf;

/// Write a run's report: one HTML page that needs nothing else, and its figures and numbers for other programs.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow report latest -o report.html\n  furrow report latest -o report.html --figures svg --data parquet   # into report-figures/\n  furrow report latest -o report.html --pdf report.pdf --latex tables.tex"
)]
pub struct Report {
    /// The run: its id, the beginning of it, or `latest`.
    run: String,
    /// The page to write.
    #[arg(short, long, value_name = "FILE.html")]
    output: PathBuf,
    /// Write every figure beside the page, into PAGE-figures/, with its data and its caption.
    #[arg(long, value_enum, value_name = "FORM")]
    figures: Option<FigureForm>,
    /// Write the data of every figure there; CSV where only --figures is given.
    #[arg(long, value_enum, value_name = "FORM")]
    data: Option<DataForm>,
    /// Print the page to a PDF file, with the Chromium that is installed.
    #[arg(long, value_name = "FILE.pdf")]
    pdf: Option<PathBuf>,
    /// Write the numbers as LaTeX tables.
    #[arg(long, value_name = "FILE.tex")]
    latex: Option<PathBuf>,
}

impl Report {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let id = chosen_run(&catalog, &self.run)?;
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
                eprintln!("and {} files more, the last {}", files.len() - 1, files[files.len() - 1].display());
            }
        }
        Ok(Ending::Done)
    }
}
