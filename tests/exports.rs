//! What else a report is written as: figures with their data, tables for LaTeX, a PDF.

use crate::browser::Browser;
use crate::command::{furrow, json, text};
use crate::pages::reported;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The files of a folder with an ending, of which there must be some.
pub fn files_in(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|found| found == ending));
    files.sort();
    assert!(!files.is_empty(), "{} holds no .{ending}", folder.display());
    files
}

#[test]
fn a_report_is_exported_with_the_numbers_of_the_run() {
    let made = reported();
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let tex = folder.path().join("tables.tex");
    let export = ["report", "latest", "-o", text(&page), "--latex", text(&tex)];
    let told = json(made.store.path(), &[&export[..], &["--figures", "svg"]].concat());
    json(made.store.path(), &[&export[..], &["--figures", "png", "--data", "parquet"]].concat());
    let figures = folder.path().join("page-figures");
    let written: BTreeSet<&str> = told["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    for drawing in files_in(&figures, "svg") {
        assert!(written.contains(text(&drawing)));
        let svg = std::fs::read_to_string(&drawing).unwrap();
        assert!(svg.contains("</svg>") && !svg.contains("var(") && !svg.contains("system-ui"), "{}", drawing.display());
        let png = std::fs::read(drawing.with_extension("png")).unwrap();
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
        let width = u32::from_be_bytes(png[16..20].try_into().unwrap());
        let units: f64 = svg.split("width=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        assert_eq!(f64::from(width), (3.0 * units).ceil(), "{}", drawing.display());
    }
    assert_eq!(files_in(&figures, "parquet").len(), files_in(&figures, "csv").len());
    let caption = std::fs::read_to_string(figures.join("s0-counts.txt")).unwrap();
    assert!(caption.contains("bootstrap") && caption.contains("Made by: furrow report "), "{caption}");

    // The counts' data are the run's own numbers.
    let csv = std::fs::read_to_string(figures.join("s0-counts.csv")).unwrap();
    let mut rows = csv.lines();
    assert_eq!(rows.next(), Some("cell,live,experience,slot,good,low,high,frames"));
    let mut seen = 0;
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        let cells = made.run["cells"].as_array().unwrap();
        let cell = cells.iter().find(|cell| cell["key"].as_str().unwrap().starts_with(fields[0])).unwrap();
        let evaluation = &cell["evaluation"];
        assert_eq!(fields[4], evaluation["good"].to_string());
        assert_eq!(fields[5], evaluation["good_interval"][0].to_string());
        assert_eq!(fields[6], evaluation["good_interval"][1].to_string());
        assert_eq!(fields[7], evaluation["frames"].to_string());
        seen += 1;
    }
    assert_eq!(seen, 3);
    let tex = std::fs::read_to_string(&tex).unwrap();
    assert!(tex.contains("\\toprule") && tex.matches("\\\\\n").count() >= 3);
}

#[test]
fn a_page_is_printed_where_a_browser_is_installed() {
    let made = reported();
    let folder = tempfile::tempdir().unwrap();
    let (page, pdf) = (folder.path().join("page.html"), folder.path().join("page.pdf"));
    let print = |path: Option<&str>| {
        let mut command = furrow();
        command.arg("--store").arg(made.store.path()).args([
            "report",
            "latest",
            "-o",
            text(&page),
            "--pdf",
            text(&pdf),
        ]);
        if let Some(path) = path {
            command.env("PATH", path);
        }
        command.output().unwrap()
    };
    let refused = print(Some(text(folder.path())));
    let said = String::from_utf8_lossy(&refused.stderr);
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("found no chromium") && !pdf.exists(), "{said}");
    if Browser::start().is_some() {
        let done = print(None);
        assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
        assert!(std::fs::read(&pdf).unwrap().starts_with(b"%PDF-"));
    }
}
