//! A report as a PDF.

use crate::support::browser::Browser;
use crate::support::command::quoted;
use crate::support::recordings::ran;

#[test]
fn a_page_is_printed_where_a_browser_is_installed() {
    let folder = tempfile::tempdir().unwrap();
    let [page, pdf] = ["page.html", "page.pdf"].map(|name| quoted(folder.path().join(name)));
    let print = || ran().store.furrow(format!("report latest -o {page} --pdf {pdf}"));
    print().env("PATH", folder.path()).fails(1, &["found no chromium"]);
    assert!(!pdf.exists());
    if Browser::start().is_some() {
        print().text();
        assert!(std::fs::read(&pdf).unwrap().starts_with(b"%PDF-"));
    }
}
