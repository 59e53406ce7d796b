//! What else a report is written as: figures with their data, tables for LaTeX.

use super::files_in;
use crate::support::command::quoted;
use crate::support::recordings::{Ran, ran};
use std::collections::BTreeSet;

#[test]
fn a_report_is_exported_with_the_numbers_of_the_run() {
    let Ran { store, run } = ran();
    let folder = tempfile::tempdir().unwrap();
    let [page, tex] = ["page.html", "tables.tex"].map(|name| quoted(folder.path().join(name)));
    let export = format!("report latest -o {page} --latex {tex}");
    let report = store.json(format!("{export} --figures svg"));
    store.json(format!("{export} --figures png --data parquet"));
    let figures = folder.path().join("page-figures");
    let written: BTreeSet<&str> =
        report["files"].as_array().unwrap().iter().map(|file| file.as_str().unwrap()).collect();
    for drawing in files_in(&figures, "svg") {
        assert!(written.contains(quoted(&drawing).text()));
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
    assert!(caption.contains("95 % intervals") && caption.contains("Made by: furrow report "), "{caption}");

    // The counts' data are the run's own numbers.
    let csv = std::fs::read_to_string(figures.join("s0-counts.csv")).unwrap();
    let mut rows = csv.lines();
    assert_eq!(rows.next(), Some("cell,live,experience,slot,good,low,high,frames"));
    let mut seen = 0;
    for row in rows {
        let fields: Vec<&str> = row.split(',').collect();
        let cells = run["cells"].as_array().unwrap();
        let cell = cells.iter().find(|cell| cell["key"].as_str().unwrap().starts_with(fields[0])).unwrap();
        let evaluation = &cell["evaluation"];
        assert_eq!(fields[4], evaluation["good"].to_string());
        // The drive is too short for an interval.
        assert_eq!((&evaluation["good_interval"], fields[5], fields[6]), (&serde_json::Value::Null, "", ""));
        assert_eq!(fields[7], evaluation["frames"].to_string());
        seen += 1;
    }
    assert_eq!(seen, 3);
    let tex = std::fs::read_to_string(&tex).unwrap();
    assert!(tex.contains("\\toprule") && tex.matches("\\\\\n").count() >= 3);
}
