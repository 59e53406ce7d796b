//! The page as people use it: pointed at, filtered, zoomed, clicked, read on a phone. Its numbers are those of `run
//! --json`.

use super::{WIDE, page, url};
use crate::support::browser::{Browser, View};
use crate::support::command::furrow;
use crate::support::recordings::ran;
use serde_json::Value;
use std::path::Path;

#[test]
fn a_page_is_read_with_the_mouse() {
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&url(&page()), WIDE);
    let figures = ["s0-counts", "s0-heat", "s0-lost", "s0-route", "s0-inliers", "s0-precision"];
    for figure in figures {
        let marks = ["cell", "count"].map(|data| format!("#{figure}-figure .stage [data-{data}]")).join(", ");
        let shown = page.eval(&format!("document.querySelectorAll('{marks}').length"));
        assert!(shown.as_u64() > Some(0), "figure {figure} is empty");
    }
    // Pointing at a cell of the heat map shows its count, which is the run's.
    let cell = &ran().run["cells"][0];
    let key = &cell["key"].as_str().unwrap()[..12];
    page.hover(&format!("#s0-heat-figure g[data-cell='{key}'] rect"));
    page.until("!document.querySelector('#tip').hidden");
    let said = page.eval("document.querySelector('#tip').textContent");
    assert!(said.as_str().unwrap().contains(&format!("{} good of {} frames", cell["good"], cell["frames"])), "{said}");

    // A switch of the legend takes a series away and brings it back.
    let drawn = "[...document.querySelectorAll('#s0-lost0-survival-title')].map(t => \
        t.closest('svg').querySelectorAll('.stage path.line:not(.off)').length)[0]";
    let before = page.eval(drawn).as_u64().unwrap();
    page.click("#s0-lost-figure .switches button");
    assert_eq!(
        page.eval("document.querySelector('#s0-lost-figure .switches button').getAttribute('aria-pressed')"),
        "false"
    );
    assert_eq!(page.eval(drawn).as_u64().unwrap(), before - 1);
    page.click("#s0-lost-figure .switches button");
    assert_eq!(page.eval(drawn).as_u64().unwrap(), before);

    // The filter leaves one experience in the table and in the figures.
    let rows = "document.querySelectorAll('tr[data-cell]:not(.off)').length";
    assert_eq!(page.eval(rows).as_u64(), Some(3));
    page.choose("#filter-experience", "10:00");
    assert_eq!(page.eval(rows).as_u64(), Some(1));
    let left = page.eval(
        "new Set([...document.querySelectorAll('#s0-lost-figure .stage [data-cell]:not(.off)')].map(e => \
         e.dataset.cell)).size",
    );
    assert_eq!(left.as_u64(), Some(1));
    assert!(page.eval("document.querySelector('#filter output').textContent").as_str().unwrap().starts_with("1 of 3"));
    page.click("#filter .reset");
    assert_eq!(page.eval(rows).as_u64(), Some(3));

    // Zoom, and all of it back.
    let at = "document.querySelector('#s0-lost-figure .stage').getAttribute('transform')";
    page.click("#s0-lost-figure .tools button");
    assert!(page.eval(at).as_str().unwrap().contains("scale(1.6)"));
    page.click("#s0-lost-figure .tools .reset");
    assert_eq!(page.eval(at), Value::Null);

    // A frame that is pictured: a click on its dot opens the facts and the pictures.
    page.click("#s0-route-figure .stage path.line[data-m]");
    page.until("document.querySelector('#frame').open");
    assert!(
        page.eval("document.querySelector('#frame .facts').textContent").as_str().unwrap().contains("threshold 40")
    );
    if page.eval("document.querySelectorAll('#frame .tiles figure').length") == 0 {
        page.click("#frame .pictured");
    }
    page.until("document.querySelectorAll('#frame .tiles figure image').length > 0");
    page.press("Escape");
    page.until("!document.querySelector('#frame').open");
    page.assert_quiet("file://");
}

#[test]
fn a_page_is_read_with_the_keyboard() {
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&url(&page()), WIDE);
    page.eval("document.querySelector('#s0-lost-figure svg.chart').focus()");
    page.press("ArrowRight");
    page.until(
        "!document.querySelector('#tip').hidden && document.querySelector('#said').textContent.includes('d = ')",
    );
    let first = page.eval("document.querySelector('#said').textContent");
    page.press("ArrowRight");
    assert_ne!(page.eval("document.querySelector('#said').textContent"), first, "the next mark speaks for itself");
    page.press("+");
    assert_eq!(page.eval("document.querySelector('#s0-lost-figure svg.chart').classList.contains('zoomed')"), true);
    page.press("0");
    assert_eq!(page.eval("document.querySelector('#s0-lost-figure svg.chart').classList.contains('zoomed')"), false);
    page.eval("document.querySelector('#s0-heat-figure svg.chart').focus()");
    page.press("ArrowRight");
    page.press("Enter");
    page.until("document.querySelector('#frame').open");
    let stamp = "document.querySelector('#frame .facts').textContent";
    let before = page.eval(stamp);
    page.click("#frame button:not(:disabled)");
    assert_ne!(page.eval(stamp), before, "the neighbouring frame");
    page.assert_quiet("file://");
}

#[test]
fn a_page_is_readable_on_a_phone_in_the_dark_and_for_all() {
    let Some(mut browser) = Browser::start() else { return };
    for width in [1280, 390] {
        for dark in [false, true] {
            let mut page = browser.open(&url(&page()), View { width, dark });
            // Left where a person can look at them.
            let keep = |name: &str| {
                let scheme = if dark { "dark" } else { "light" };
                Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}-{width}-{scheme}.png"))
            };
            page.assert_fits();
            page.assert_accessible();
            page.screenshot(&keep("page"), true);
            page.eval("document.querySelector('#s0-heat-figure svg.chart').focus()");
            page.press("ArrowRight");
            page.press("Enter");
            page.until("document.querySelector('#frame').open");
            page.assert_accessible();
            page.screenshot(&keep("frame"), false);
            page.assert_quiet("file://");
        }
    }
}

#[test]
fn metrics_are_explained_in_the_words_of_the_page() {
    let all: Value = serde_json::from_slice(&furrow("explain --json").output().stdout).unwrap();
    let page = std::fs::read_to_string(page()).unwrap();
    let shown = |text: &str| text.replace('\'', "&#x27;").replace('/', "&#x2f;");
    let metrics = all["metrics"].as_array().unwrap();
    assert!(metrics.len() > 20);
    for metric in metrics {
        assert!(page.contains(&shown(metric["meaning"].as_str().unwrap())), "{metric}");
    }
    assert!(page.contains(all["right"].as_str().unwrap()));
    let one = furrow("explain percent_of_frames").text();
    assert!(one.starts_with("percent_of_frames (% of frames): ") && one.lines().count() == 1, "{one}");
    furrow("explain nonsense").fails(1, &["nonsense", "recall_at_1"]);
}

#[test]
fn the_page_says_the_numbers_of_run_json() {
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&url(&page()), WIDE);
    for cell in ran().run["cells"].as_array().unwrap() {
        let key = &cell["key"].as_str().unwrap()[..12];
        let (e, truth) = (&cell["evaluation"], &cell["evaluation"]["ground_truth"]);
        for (name, expected) in [
            ("frames", &e["frames"]),
            ("good", &e["good"]),
            ("percent_of_frames", &e["percent_of_frames"]),
            ("percent_good", &e["percent_good"]),
            ("jumps", &e["jumps"]),
            ("lost_fraction", &e["lost"]["lost_fraction"]),
            ("max_lost_m", &e["lost"]["max_lost_m"]),
            ("mean_lost_m", &e["lost"]["mean_lost_m"]),
            ("correct", &truth["correct"]),
            ("wrong", &truth["wrong"]),
            ("recall_at_1", &truth["recall_at_1"]),
            ("recall_of_answers", &truth["recall_of_answers"]),
            ("recall_at_full_precision", &truth["recall_at_full_precision"]),
            ("average_precision", &truth["average_precision"]),
            ("position_rmse_m", &truth["position_rmse_m"]),
        ] {
            let shown = page.eval(&format!("document.querySelector('#cell-{key} data.{name}').value"));
            let shown = shown.as_str().unwrap().parse::<f64>().ok();
            assert_eq!(shown, expected.as_f64(), "{name} of cell {key}");
            let link = page.eval(&format!("document.querySelector('#cell-{key} data.{name}').closest('a').hash"));
            assert_eq!(link, format!("#lineage-{key}").as_str());
        }
    }
}
