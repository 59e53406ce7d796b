//! minijinja, set up in one place: every value is escaped, and a name that does not exist is an error.

use minijinja::{AutoEscape, Environment, UndefinedBehavior};

/// An environment with these templates, by name and source.
pub(crate) fn environment(
    templates: &[(&'static str, &'static str)],
) -> Result<Environment<'static>, minijinja::Error> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    for (name, source) in templates {
        environment.add_template(name, source)?;
    }
    Ok(environment)
}
