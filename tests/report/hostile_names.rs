//! Names that would do something if they could.

use super::{WIDE, files_in, url};
use crate::support::browser::{Browser, View};
use crate::support::matrix::Matrix;
use crate::support::recordings::ran;

#[test]
fn hostile_names_are_shown_and_not_run() {
    let Some(mut browser) = Browser::start() else { return };
    let hostile = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\" onload=\"alert(3) שלום {{ 7 * 7 }}";
    let name = format!("{hostile}\u{202e}{}", "x".repeat(300));
    let store = ran().store.copy();
    let matrix = Matrix::small().without_collectives().named(&name).collective(&name, "recorded", "");
    store.json(format!("run {}", matrix.write(store.path())));
    let (file, tables) = (store.file("hostile.html"), store.file("hostile.tex"));
    store.json(format!("report latest -o {file} --figures svg --latex {tables}"));
    for width in [1280, 390] {
        let mut page = browser.open(&url(&file), View { width, dark: false });
        let shown = page.eval("document.body.textContent").as_str().unwrap().to_owned();
        assert!(shown.contains(hostile) && !shown.contains('\u{202e}'), "the name is not shown as it is");
        let options = page.eval("[...document.querySelectorAll('#filter-experience option')].map(o => o.value).join()");
        assert!(options.as_str().unwrap().contains(hostile), "{options}");
        assert_eq!(page.eval("document.images.length + document.scripts.length"), 2);
        page.eval("document.querySelector('#s0-route-figure svg.chart').focus()");
        page.press("ArrowLeft");
        page.press("Enter");
        page.until("document.querySelector('#frame').open");
        page.assert_fits();
        page.assert_accessible();
        page.assert_quiet("file://");
    }
    for drawing in files_in(&store.file("hostile-figures"), "svg") {
        browser.open(&url(&drawing), WIDE).assert_quiet("file://");
    }
    let tables = std::fs::read_to_string(&tables).unwrap();
    assert!(tables.contains("\\textless{}script\\textgreater{}alert(1)") && tables.contains("\\{\\{ 7 * 7 \\}\\}"));
}
