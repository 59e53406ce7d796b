//! Names that come from users and recordings.

/// A name fit for display: characters that would change how the text around it reads (controls, bidirectional
/// overrides) become U+FFFD. Markup is left alone: who writes a page escapes it.
pub fn shown(name: &str) -> String {
    let unsafe_here = |c: char| {
        c.is_control()
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{061c}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    name.chars().map(|c| if unsafe_here(c) { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overrides_are_made_visible_and_letters_kept() {
        assert_eq!(shown("a\u{202e}b\nשלום<b>"), "a\u{fffd}b\u{fffd}שלום<b>");
    }
}
