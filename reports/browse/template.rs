//! The browser's templates.

use crate::chart::palette::Tone;
use crate::page::STYLE;
use crate::template::environment;
use minijinja::value::{Serde, merge_maps};
use minijinja::{Environment, Value};
use serde::Serialize;

const TEMPLATES: [(&str, &str); 14] = [
    ("base.html", include_str!("templates/base.html")),
    ("cards.html", include_str!("templates/cards.html")),
    ("map.html", include_str!("templates/map.html")),
    ("start.html", include_str!("templates/start.html")),
    ("site.html", include_str!("templates/site.html")),
    ("slot.html", include_str!("templates/slot.html")),
    ("traversal.html", include_str!("templates/traversal.html")),
    ("experience.html", include_str!("templates/experience.html")),
    ("run.html", include_str!("templates/run.html")),
    ("runs.html", include_str!("templates/runs.html")),
    ("all_runs.html", include_str!("templates/all_runs.html")),
    ("failure.html", include_str!("templates/failure.html")),
    STYLE,
    ("style.css", include_str!("templates/style.css")),
];

/// The browser's templates.
pub(super) struct Templates(Environment<'static>);

impl Templates {
    pub fn new() -> Result<Self, minijinja::Error> {
        Ok(Self(environment(&TEMPLATES)?))
    }

    /// A page of the store `name`.
    pub fn render(&self, template: &str, name: &str, view: impl Serialize) -> Result<String, minijinja::Error> {
        let frame = Frame { store: name, version: env!("CARGO_PKG_VERSION") };
        let context = merge_maps([Value::from(Serde(view)), Value::from(Serde(frame))]);
        self.0.get_template(template)?.render(context)
    }

    /// The reports' style sheet and the browser's own.
    pub fn style(&self, tones: Vec<Tone>) -> Result<String, minijinja::Error> {
        self.0.get_template("style.css")?.render(Serde(Style { tones }))
    }
}

#[derive(Serialize)]
struct Style {
    tones: Vec<Tone>,
}

/// What every page shows.
#[derive(Serialize)]
struct Frame<'a> {
    store: &'a str,
    version: &'a str,
}
