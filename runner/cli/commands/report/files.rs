//! What a report can be besides a page: figures with their data, and a PDF.

use crate::ending::Failure;
use clap::ValueEnum;
use furrow_catalog::{tables, write_file};
use furrow_reports::{FigureFiles, Painter, ReportInput, figure_files};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// How figures are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum FigureForm {
    /// SVG, one file per chart.
    Svg,
    /// PNG, one file per chart.
    Png,
}

/// How the numbers of figures are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum DataForm {
    /// CSV, with all digits.
    Csv,
    /// Parquet.
    Parquet,
}

/// The folder of figures beside a page: `page.html` has `page-figures`.
pub fn figures_folder(page: &Path) -> PathBuf {
    let stem = page.file_stem().map_or_else(|| "report".into(), |stem| stem.to_string_lossy());
    page.with_file_name(format!("{stem}-figures"))
}

/// Writes every figure's charts and data with its caption; gives the files.
pub fn write_figures(
    folder: &Path,
    input: &ReportInput,
    charts: Option<FigureForm>,
    data: DataForm,
) -> Result<Vec<PathBuf>, Failure> {
    let folder_error =
        |error: std::io::Error| Failure::new(format!("cannot create the folder {}: {error}", folder.display()));
    std::fs::create_dir_all(folder).map_err(folder_error)?;
    let painter = if charts == Some(FigureForm::Png) { Some(Painter::new()?) } else { None };
    let mut written = Vec::new();
    let mut write = |name: String, bytes: &[u8]| -> Result<(), Failure> {
        let file = folder.join(name);
        write_file(&file, bytes)?;
        written.push(file);
        Ok(())
    };
    for figure in figure_files(input)? {
        for (name, svg) in figure.charts.iter().filter(|_| charts.is_some()) {
            match &painter {
                Some(painter) => write(format!("{name}.png"), &painter.png(svg)?)?,
                None => write(format!("{name}.svg"), svg.as_bytes())?,
            }
        }
        let (ending, bytes) = render_data(&figure, data)?;
        write(format!("{}.{ending}", figure.name), &bytes)?;
        write(format!("{}.txt", figure.name), figure.caption.as_bytes())?;
    }
    Ok(written)
}

fn render_data(figure: &FigureFiles, form: DataForm) -> Result<(&'static str, Vec<u8>), Failure> {
    let data_error = |error: String| Failure::new(format!("writing the data of figure {}: {error}", figure.name));
    match form {
        DataForm::Csv => Ok(("csv", figure.csv().into_bytes())),
        DataForm::Parquet => {
            let frame = figure.frame().map_err(|error| data_error(error.to_string()))?;
            Ok(("parquet", tables::to_parquet(&figure.name, frame)?))
        }
    }
}

/// Prints a page with the Chromium that is installed.
pub fn write_pdf(file: &Path, html: &str) -> Result<(), Failure> {
    let print_error = |what: String| Failure::new(format!("printing the page to {}: {what}", file.display()));
    let chromium = find_chromium().ok_or_else(|| {
        print_error("found no chromium, chromium-browser or google-chrome on PATH; install one, or print the page from a browser".to_owned())
    })?;
    let folder = tempfile::tempdir().map_err(|error| print_error(format!("making a temporary folder: {error}")))?;
    let (page, pdf) = (folder.path().join("page.html"), folder.path().join("page.pdf"));
    std::fs::write(&page, html).map_err(|error| print_error(format!("writing a copy of the page: {error}")))?;
    let mut command = Command::new(&chromium);
    command
        .args(["--headless", "--disable-gpu", "--no-pdf-header-footer", "--disable-background-networking"])
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("--print-to-pdf={}", pdf.display()));
    // Chromium refuses to run its sandbox as root. The page is our own and lets no script in but its own.
    if is_root() {
        command.arg("--no-sandbox");
    }
    let output = command.arg(format!("file://{}", page.display())).stdin(Stdio::null()).output();
    let output = output.map_err(|error| print_error(format!("starting {}: {error}", chromium.display())))?;
    let bytes = std::fs::read(&pdf).unwrap_or_default();
    if !bytes.starts_with(b"%PDF") {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("nothing").to_owned();
        return Err(print_error(format!(
            "{} ended with {} and no PDF; it said: {last}",
            chromium.display(),
            output.status
        )));
    }
    Ok(write_file(file, &bytes)?)
}

fn find_chromium() -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let found = |name: &str| folders.iter().map(|folder| folder.join(name)).find(|file| file.is_file());
    ["chromium", "chromium-browser", "google-chrome"].into_iter().find_map(found)
}

fn is_root() -> bool {
    use std::os::unix::fs::MetadataExt;
    std::fs::metadata("/proc/self").is_ok_and(|process| process.uid() == 0)
}
