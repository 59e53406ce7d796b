//! The templates of pages.

use crate::error::ReportError;
use crate::template::environment;
use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

/// The style sheet that all pages share, those of the catalogue browser too.
pub(crate) const STYLE: (&str, &str) = ("page.css", include_str!("templates/page.css"));

const TEMPLATES: [(&str, &str); 6] = [
    ("claims.html", include_str!("templates/claims.html")),
    ("page.html", include_str!("templates/page.html")),
    ("summary.html", include_str!("templates/summary.html")),
    ("lineage.html", include_str!("templates/lineage.html")),
    ("tile.svg", include_str!("templates/tile.svg")),
    STYLE,
];

/// The templates of this folder.
pub(super) struct Templates(Environment<'static>);

impl Templates {
    pub fn new() -> Result<Self, ReportError> {
        Ok(Self(environment(&TEMPLATES)?))
    }

    /// The report.
    pub fn report(&self, view: impl Serialize) -> Result<String, ReportError> {
        self.render("page.html", view)
    }

    /// The page of claims.
    pub fn claims(&self, view: impl Serialize) -> Result<String, ReportError> {
        self.render("claims.html", view)
    }

    fn render(&self, name: &str, context: impl Serialize) -> Result<String, ReportError> {
        Ok(self.0.get_template(name)?.render(Serde(context))?)
    }
}
