//! One tab: look, point, press, ask; and what it may not do.

use super::pipe::Pipe;
use serde_json::{Value, json};
use std::path::Path;
use std::time::{Duration, Instant};

const AXE: &str = include_str!("axe.min.js");

/// How a page is looked at.
#[derive(Debug, Clone, Copy)]
pub struct View {
    /// CSS pixels; under 500 it is shown as on a phone.
    pub width: u32,
    /// `prefers-color-scheme`.
    pub dark: bool,
}

/// A tab with a page in it.
pub struct Page<'b> {
    pipe: &'b mut Pipe,
    session: String,
    url: String,
}

impl<'b> Page<'b> {
    pub(super) fn open(pipe: &'b mut Pipe, url: &str, view: View) -> Self {
        let target = pipe.call("", "Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = pipe.call("", "Target.attachToTarget", attach)["sessionId"].as_str().unwrap().to_owned();
        let mut page = Self { pipe, session, url: url.to_owned() };
        for domain in ["Page", "Runtime", "Log", "Network"] {
            page.call(&format!("{domain}.enable"), json!({}));
        }
        let phone = view.width < 500;
        let metrics = json!({ "width": view.width, "height": 900, "deviceScaleFactor": 1, "mobile": phone });
        page.call("Emulation.setDeviceMetricsOverride", metrics);
        let scheme = if view.dark { "dark" } else { "light" };
        let feature = json!({ "name": "prefers-color-scheme", "value": scheme });
        page.call("Emulation.setEmulatedMedia", json!({ "features": [feature] }));
        let navigated = page.call("Page.navigate", json!({ "url": url }));
        assert!(navigated["errorText"].is_null(), "{url}: {}", navigated["errorText"]);
        page.pipe.wait(&page.session, "Page.loadEventFired");
        page
    }

    /// Evaluates an expression (a promise is awaited); what it throws fails the test.
    pub fn eval(&mut self, expression: &str) -> Value {
        let params = json!({ "expression": expression, "returnByValue": true, "awaitPromise": true });
        let mut answer = self.call("Runtime.evaluate", params);
        let start: String = expression.chars().take(200).collect();
        assert!(answer["exceptionDetails"].is_null(), "{start}: {}", answer["exceptionDetails"]);
        answer["result"]["value"].take()
    }

    /// Waits until an expression is true.
    pub fn until(&mut self, expression: &str) {
        let started = Instant::now();
        while self.eval(&format!("Boolean({expression})")) != Value::Bool(true) {
            assert!(started.elapsed() < Duration::from_secs(20), "{} never came true on {}", expression, self.url);
            std::thread::sleep(Duration::from_millis(30));
        }
    }

    /// Moves the mouse onto the middle of the first element of a selector.
    pub fn hover(&mut self, selector: &str) -> (f64, f64) {
        let find = format!(
            "(() => {{ const e = document.querySelector({}); if (!e) return null; \
             e.scrollIntoView({{ block: 'center', behavior: 'instant' }}); const r = e.getBoundingClientRect(); \
             return [r.x + r.width / 2, r.y + r.height / 2]; }})()",
            Value::from(selector)
        );
        let middle = self.eval(&find);
        let (x, y) = (middle[0].as_f64(), middle[1].as_f64());
        let (x, y) = x.zip(y).unwrap_or_else(|| panic!("no element {selector} on {}", self.url));
        self.mouse("mouseMoved", x, y, "none");
        (x, y)
    }

    /// Clicks the middle of the first element of a selector.
    pub fn click(&mut self, selector: &str) {
        let (x, y) = self.hover(selector);
        self.mouse("mousePressed", x, y, "left");
        self.mouse("mouseReleased", x, y, "left");
    }

    /// Chooses an option of a `<select>` by its value.
    pub fn choose(&mut self, selector: &str, value: &str) {
        self.eval(&format!(
            "(() => {{ const s = document.querySelector({}); s.value = {}; s.dispatchEvent(new Event('change')); }})()",
            Value::from(selector),
            Value::from(value)
        ));
    }

    /// Presses and releases a key by its DOM name: `Enter`, `Escape`, `Tab`, `ArrowRight`, `a` …
    pub fn press(&mut self, key: &str) {
        let code = match key {
            "Enter" => 13,
            "Escape" => 27,
            "Tab" => 9,
            " " => 32,
            "ArrowLeft" => 37,
            "ArrowUp" => 38,
            "ArrowRight" => 39,
            "ArrowDown" => 40,
            "Home" => 36,
            "End" => 35,
            other => other.to_ascii_uppercase().bytes().next().unwrap_or_default(),
        };
        let text = match key {
            "Enter" => "\r",
            one if one.chars().count() == 1 => one,
            _ => "",
        };
        let kind = if text.is_empty() { "rawKeyDown" } else { "keyDown" };
        let mut down = json!({ "type": kind, "key": key, "windowsVirtualKeyCode": code });
        if !text.is_empty() {
            down["text"] = text.into();
        }
        self.call("Input.dispatchKeyEvent", down);
        self.call("Input.dispatchKeyEvent", json!({ "type": "keyUp", "key": key, "windowsVirtualKeyCode": code }));
    }

    /// Writes what is seen, the whole page or the window, as a PNG file.
    pub fn screenshot(&mut self, file: &Path, whole: bool) {
        use base64::Engine;
        let shot = self.call("Page.captureScreenshot", json!({ "format": "png", "captureBeyondViewport": whole }));
        let bytes = base64::engine::general_purpose::STANDARD.decode(shot["data"].as_str().unwrap()).unwrap();
        std::fs::write(file, bytes).unwrap();
    }

    /// Every URL asked for so far, the page's own first; data in the page itself (`data:`, `blob:`) is not asked for.
    pub fn requests(&mut self) -> Vec<String> {
        let inside = |url: &&str| url.starts_with("data:") || url.starts_with("blob:");
        let asked = |event: &Value| {
            let url = event["params"]["request"]["url"].as_str()?;
            (event["method"] == "Network.requestWillBeSent" && !inside(&url)).then(|| url.to_owned())
        };
        self.pipe.events(&self.session).filter_map(asked).collect()
    }

    /// What went wrong so far: errors and warnings of the console, what scripts threw, and dialogs, which no page of
    /// ours opens.
    pub fn complaints(&mut self) -> Vec<String> {
        // A round trip: what the page said before it is in by now.
        self.eval("0");
        let complaint = |event: &Value| {
            let params = &event["params"];
            match event["method"].as_str()? {
                "Runtime.exceptionThrown" => Some(params["exceptionDetails"].to_string()),
                "Runtime.consoleAPICalled" => ["error", "warning", "assert"]
                    .contains(&params["type"].as_str()?)
                    .then(|| params["args"].to_string()),
                "Log.entryAdded" => ["error", "warning"]
                    .contains(&params["entry"]["level"].as_str()?)
                    .then(|| params["entry"].to_string()),
                "Page.javascriptDialogOpening" => Some(format!("a dialog: {}", params["message"])),
                _ => None,
            }
        };
        self.pipe.events(&self.session).filter_map(complaint).collect()
    }

    /// Fails on any complaint, and on any request that does not begin with `allowed`.
    pub fn assert_quiet(&mut self, allowed: &str) {
        let complaints = self.complaints();
        assert!(complaints.is_empty(), "{}: {complaints:#?}", self.url);
        let strangers: Vec<String> = self.requests().into_iter().filter(|url| !url.starts_with(allowed)).collect();
        assert!(strangers.is_empty(), "{} asks for {strangers:?}", self.url);
    }

    /// The serious and critical findings of axe-core, one line each.
    pub fn barriers(&mut self) -> Vec<String> {
        self.eval(&format!("{AXE}; 0"));
        let found = self.eval(
            "axe.run(document, { resultTypes: ['violations'] }).then(r => r.violations.filter(v => ['serious', \
             'critical'].includes(v.impact)).map(v => v.id + ': ' + v.help + ' at ' + v.nodes.slice(0, 4).map(n => \
             n.target.join(' ') + ' ' + n.any.concat(n.all, n.none).map(c => c.message).join('; ')).join(' | ')))",
        );
        found.as_array().unwrap().iter().map(|line| line.as_str().unwrap_or_default().to_owned()).collect()
    }

    /// Fails on a serious or critical finding of axe-core.
    pub fn assert_accessible(&mut self) {
        let barriers = self.barriers();
        assert!(barriers.is_empty(), "{}: {barriers:#?}", self.url);
    }

    /// Fails where the page is wider than the window, so that a phone would scroll it sideways.
    pub fn assert_fits(&mut self) {
        let [page, window] =
            ["document.documentElement.scrollWidth", "window.innerWidth"].map(|e| self.eval(e).as_f64());
        assert!(page <= window, "{} is {page:?} wide in a window of {window:?}", self.url);
    }

    fn mouse(&mut self, kind: &str, x: f64, y: f64, button: &str) {
        let clicks = u8::from(button != "none");
        let event = json!({ "type": kind, "x": x, "y": y, "button": button, "clickCount": clicks });
        self.call("Input.dispatchMouseEvent", event);
    }

    fn call(&mut self, method: &str, params: Value) -> Value {
        self.pipe.call(&self.session, method, params)
    }
}

impl Drop for Page<'_> {
    fn drop(&mut self) {
        // A failed test unwinds through here: another panic would hide why.
        if !std::thread::panicking() {
            self.call("Page.close", json!({}));
        }
    }
}
