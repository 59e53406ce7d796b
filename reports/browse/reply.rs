//! What goes back to the browser.

use axum::http::{HeaderValue, StatusCode, header};
use axum::response::{IntoResponse, Response};

/// A page of the browser itself: its own style sheet, scripts and images, and nothing else.
const OWN: &str = "default-src 'none'; img-src 'self'; style-src 'self'; script-src 'self'; connect-src 'self'; \
    base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
/// A report: one file with all in it. It may run its own script, but sandboxed, from where it reaches no other page.
const REPORT: &str = "sandbox allow-scripts allow-downloads allow-modals; default-src 'none'; img-src data: blob:; \
    style-src 'unsafe-inline'; script-src 'unsafe-inline'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A body and what it is.
pub(crate) struct Reply {
    status: StatusCode,
    kind: &'static str,
    policy: &'static str,
    /// Whether the same address always gives the same bytes: it names what it shows by digests.
    lasting: bool,
    body: Vec<u8>,
}

impl Reply {
    fn new(kind: &'static str, body: impl Into<Vec<u8>>) -> Self {
        Self { status: StatusCode::OK, kind, policy: OWN, lasting: false, body: body.into() }
    }

    pub fn page(html: String) -> Self {
        Self::new("text/html; charset=utf-8", html)
    }

    pub fn report(html: impl Into<Vec<u8>>) -> Self {
        Self { policy: REPORT, ..Self::new("text/html; charset=utf-8", html) }
    }

    pub fn style(css: String) -> Self {
        Self::new("text/css; charset=utf-8", css)
    }

    pub fn script(text: &'static str) -> Self {
        Self::new("text/javascript; charset=utf-8", text)
    }

    pub fn icon(svg: &'static str) -> Self {
        Self::new("image/svg+xml", svg)
    }

    pub fn jpeg(bytes: &[u8]) -> Self {
        Self { lasting: true, ..Self::new("image/jpeg", bytes) }
    }

    pub fn json(value: &serde_json::Value) -> Self {
        Self::new("application/json", value.to_string())
    }

    pub fn text(status: StatusCode, text: impl Into<String>) -> Self {
        Self { status, ..Self::new("text/plain; charset=utf-8", text.into()) }
    }

    pub fn with_status(self, status: StatusCode) -> Self {
        Self { status, ..self }
    }
}

impl IntoResponse for Reply {
    fn into_response(self) -> Response {
        let keep = if self.lasting { "private, max-age=86400, immutable" } else { "no-store" };
        let headers = [
            (header::CONTENT_TYPE, HeaderValue::from_static(self.kind)),
            (header::CONTENT_SECURITY_POLICY, HeaderValue::from_static(self.policy)),
            (header::CACHE_CONTROL, HeaderValue::from_static(keep)),
            (header::X_CONTENT_TYPE_OPTIONS, HeaderValue::from_static("nosniff")),
            (header::REFERRER_POLICY, HeaderValue::from_static("no-referrer")),
        ];
        (self.status, headers, self.body).into_response()
    }
}
