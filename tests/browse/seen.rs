//! The pages as people see and use them.

use super::shown::{frames_of, shown};
use crate::support::browser::{Browser, View};
use crate::support::http::Served;

const WIDE: View = View { width: 1280, dark: false };
const PHONE: View = View { width: 390, dark: true };

/// Opens pages whose names would do something if they could.
pub fn nothing_is_executed(served: &Served, paths: &[String]) {
    let Some(mut browser) = Browser::start() else { return };
    for path in paths {
        let mut page = browser.open(&format!("{}{}", served.url, &path[1..]), PHONE);
        page.assert_quiet(&served.url);
        page.assert_fits();
    }
}

#[test]
fn every_page_fits_is_quiet_and_accessible() {
    let shown = shown();
    let served = Served::start(&shown.store);
    let start = served.page("/");
    let site = start.split("href=\"/site/").nth(1).unwrap()[..12].to_owned();
    let Some(mut browser) = Browser::start() else { return };
    let paths = [
        String::new(),
        "runs".to_owned(),
        format!("site/{site}"),
        format!("site/{site}/08:00/1"),
        format!("traversal/{}", shown.traversal("08:00", "experience")),
        format!("experience/{}", shown.parent),
        format!("run/{}", shown.run()),
    ];
    for view in [WIDE, PHONE] {
        for path in &paths {
            let mut page = browser.open(&format!("{}{path}", served.url), view);
            if path.starts_with("traversal") || path.starts_with("experience") {
                page.until("document.querySelector('[data-ready]')");
            }
            page.assert_accessible();
            page.assert_fits();
            page.assert_quiet(&served.url);
        }
    }
}

#[test]
fn the_first_page_has_thumbnails_by_hour() {
    let shown = shown();
    let served = Served::start(&shown.store);
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&served.url, WIDE);
    page.eval("document.querySelectorAll('img').forEach(i => i.loading = 'eager'), 0");
    page.until("[...document.images].every(i => i.complete && i.naturalWidth > 100)");
    assert_eq!(page.eval("document.images.length"), shown.traversals().len());
    let hours = page.eval("[...document.querySelectorAll('.slot h3')].map(h => h.textContent)");
    assert_eq!(hours, serde_json::json!(["08:00", "10:00"]));
    let below = page.eval(
        "(() => { const [a, b] = [...document.querySelectorAll('.slot')].map(e => e.getBoundingClientRect()); \
         return a.bottom <= b.top; })()",
    );
    assert_eq!(below, true);
    let counts =
        page.eval("[...document.querySelectorAll('.coverage tbody tr')].map(r => r.textContent.replace(/\\s+/g, ' '))");
    assert_eq!(counts, serde_json::json!(["experience11", "evaluation1–", "vocabulary–1"]));
}

#[test]
fn keys_scrub_pictures_and_track_together() {
    let shown = shown();
    let served = Served::start(&shown.store);
    let live = shown.traversal("08:00", "evaluation");
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&format!("{}traversal/{live}", served.url), WIDE);
    page.until("document.querySelector('#player').dataset.ready");
    let frames = frames_of(shown.traversals().iter().find(|one| one["traversal"] == live).unwrap());
    let middle = frames / 2;
    let marker = "[Number(here.getAttribute('cx')), Number(here.getAttribute('cy'))]";
    let start = page.eval(marker);
    page.eval("document.querySelector('#frame').focus(), 0");
    for _ in 0..5 {
        page.press("ArrowRight");
    }
    page.until(&format!("document.querySelector('#player').dataset.shown === '{}'", middle + 5));
    let left = page.eval("document.querySelector('#left').src.split('/').slice(-2).join('/')");
    assert_eq!(left, format!("{}/left.jpg", middle + 5));
    assert_eq!(page.eval("document.querySelector('#left').naturalWidth > 300"), true);
    assert_ne!(page.eval(marker), start, "the marker moves along the track");
    // The marker is where the track says, by the page's own picture of it: on the drawn path.
    let off = page.eval(
        "(() => { const path = document.querySelector('#track .line'), n = path.getTotalLength(); let best = 1e9; \
         for (let i = 0; i <= 2000; i += 1) { const p = path.getPointAtLength(n * i / 2000); \
         best = Math.min(best, Math.hypot(p.x - here.getAttribute('cx'), p.y - here.getAttribute('cy'))); } \
         return best; })()",
    );
    assert!(off.as_f64().unwrap() < 2.0, "{off}");
    page.press("ArrowLeft");
    page.until(&format!("document.querySelector('#player').dataset.shown === '{}'", middle + 4));

    page.click("#keypoints");
    page.until("document.querySelectorAll('#over-left circle').length > 50");
    page.click("#keypoints");
    page.choose("#beside", "before");
    page.click("#matches");
    page.until("document.querySelectorAll('#over-left path').length > 20");
    page.eval("document.activeElement.blur(), 0");
    page.press(" ");
    page.until(&format!("Number(document.querySelector('#player').dataset.shown) > {}", middle + 8));
    page.press(" ");
    page.until("document.querySelector('#play').textContent === 'Play'");
    page.assert_quiet(&served.url);
    drop(page);

    // A run's cell leads here, and shows the places that it answered.
    let run = served.page(&format!("/run/{}", shown.run()));
    let cell = run.split(&format!("/traversal/{live}#")).nth(1).unwrap()[..64].to_owned();
    let mut page = browser.open(&format!("{}traversal/{live}#{cell}", served.url), PHONE);
    page.until("document.querySelector('#player').dataset.ready");
    assert_eq!(page.eval("document.querySelector('#beside').value"), cell);
    page.until("document.querySelector('#second-text').textContent.startsWith('Node ')");
    page.until("[document.querySelector('#second')].some(i => i.src.includes('/node/') && i.naturalWidth > 300)");
    page.assert_accessible();
    page.assert_quiet(&served.url);
}

#[test]
fn the_slider_over_z_changes_the_picture() {
    let shown = shown();
    let served = Served::start(&shown.store);
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open(&format!("{}experience/{}", served.url, shown.parent), WIDE);
    page.until("document.querySelector('#family').dataset.ready");
    page.until("document.querySelector('#image').naturalWidth > 300");
    let grey = "(async () => { const i = document.querySelector('#image'); await i.decode(); \
        const c = document.createElement('canvas'); c.width = c.height = 8; const x = c.getContext('2d'); \
        x.drawImage(i, 0, 0, 8, 8); \
        return x.getImageData(0, 0, 8, 8).data.reduce((a, b) => a + b, 0); })()";
    let recorded = page.eval(grey).as_f64().unwrap();
    page.eval("document.querySelector('#z').focus(), 0");
    page.press("ArrowRight");
    page.press("ArrowRight");
    page.until(&format!("document.querySelector('#family').dataset.shown !== '0 {}'", shown.parent));
    assert_eq!(page.eval("document.querySelector('#which').textContent"), "1");
    // Gamma 0.8 brightens every grey between black and white.
    let brighter = page.eval(grey).as_f64().unwrap();
    assert!(brighter > recorded, "{recorded} to {brighter}");
    page.eval("document.querySelector('#place').focus(), 0");
    page.press("ArrowRight");
    page.until("document.querySelector('#image').src.endsWith('/node/1')");
    assert_eq!(page.eval("document.querySelectorAll('#strip .card').length >= 3"), true);
    assert_eq!(page.eval("document.querySelector('#strip .chosen .line').textContent.startsWith('z = 1')"), true);
    page.assert_quiet(&served.url);
}
