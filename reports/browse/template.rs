//! minijinja for the browser's pages: every value is escaped, and a name that does not exist is an error.

use crate::palette::Tone;
use minijinja::value::{Serde, merge_maps};
use minijinja::{AutoEscape, Environment, UndefinedBehavior, Value};
use serde::Serialize;

const TEMPLATES: [(&str, &str); 14] = [
    ("base.html", include_str!("templates/base.html")),
    ("cards.html", include_str!("templates/cards.html")),
    ("map.html", include_str!("templates/map.html")),
    ("start.html", include_str!("templates/start.html")),
    ("site.html", include_str!("templates/site.html")),
    ("slot.html", include_str!("templates/slot.html")),
    ("outing.html", include_str!("templates/outing.html")),
    ("experience.html", include_str!("templates/experience.html")),
    ("run.html", include_str!("templates/run.html")),
    ("runs.html", include_str!("templates/runs.html")),
    ("all_runs.html", include_str!("templates/all_runs.html")),
    ("failure.html", include_str!("templates/failure.html")),
    ("page.css", include_str!("../templates/page.css")),
    ("style.css", include_str!("templates/style.css")),
];

/// The browser's templates.
pub(crate) struct Templates(Environment<'static>);

impl Templates {
    pub fn new() -> Result<Self, minijinja::Error> {
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.set_undefined_behavior(UndefinedBehavior::Strict);
        for (name, source) in TEMPLATES {
            environment.add_template(name, source)?;
        }
        Ok(Self(environment))
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
