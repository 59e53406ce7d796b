//! The browser sees what it is there to see: it would be no witness otherwise.

use crate::support::browser::{Browser, View};

const GOOD: &str = "<!DOCTYPE html><html lang=en><head><meta charset=utf-8>\
    <meta name=viewport content='width=device-width'><link rel=icon href='data:,'><title>good</title>\
    <style>body { background: white } @media (prefers-color-scheme: dark) { \
    body { background: black; color: white } }</style></head><body><main><h1>Good</h1><button id=b>press</button>\
    <script>const seen = []; b.onclick = () => seen.push('click'); b.onmouseover = () => seen.push('hover'); \
    b.onkeydown = e => seen.push(e.key);</script></main></body></html>";
const BAD: &str = "<!DOCTYPE html><html><head><title>bad</title></head><body><img src='http://127.0.0.1:9/picture.png'>\
    <div style='width:2000px'>wide</div><script>alert('boo'); console.error('loud'); \
    setTimeout(() => { throw new Error('thrown') }); setTimeout(() => window.done = 1, 50)</script></body></html>";

#[test]
fn the_browser_sees_what_pages_do() {
    let Some(mut browser) = Browser::start() else { return };
    let folder = tempfile::tempdir().unwrap();
    let [good, bad] = [("good.html", GOOD), ("bad.html", BAD)].map(|(name, text)| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        format!("file://{}", file.display())
    });

    let mut page = browser.open(&good, View { width: 1280, dark: true });
    page.hover("#b");
    page.click("#b");
    page.press("x");
    page.press("ArrowRight");
    page.until("seen.length >= 4");
    assert_eq!(page.eval("seen"), serde_json::json!(["hover", "click", "x", "ArrowRight"]));
    assert_eq!(page.eval("getComputedStyle(document.body).backgroundColor"), "rgb(0, 0, 0)", "dark");
    let shot = folder.path().join("shot.png");
    page.screenshot(&shot, true);
    assert!(std::fs::read(&shot).unwrap().starts_with(b"\x89PNG"));
    page.assert_quiet("file://");
    page.assert_accessible();
    page.assert_fits();
    assert_eq!(page.requests(), [good]);
    drop(page);

    let mut page = browser.open(&bad, View { width: 390, dark: false });
    assert_eq!(page.eval("innerWidth >= 390 && !matchMedia('(prefers-color-scheme: dark)').matches"), true);
    page.until("window.done");
    let complaints = page.complaints().join("\n");
    for expected in ["boo", "loud", "thrown"] {
        assert!(complaints.contains(expected), "{expected} is not among {complaints}");
    }
    assert!(page.requests().contains(&"http://127.0.0.1:9/picture.png".to_owned()));
    let barriers = page.barriers().join("\n");
    assert!(barriers.contains("image-alt") && barriers.contains("html-has-lang"), "{barriers}");
    assert_eq!(page.eval("document.documentElement.scrollWidth > 1900"), true);
}
