use crate::ending::{Ending, Failure};
use crate::output::print;
use clap_complete::{Shell, generate};

/// Print a completion script for a shell.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  source <(furrow completions bash)\n  \
furrow completions zsh > ~/.local/share/zsh/site-functions/_furrow\n  \
furrow completions fish > ~/.config/fish/completions/furrow.fish")]
pub struct Completions {
    /// The shell.
    shell: Shell,
}

impl Completions {
    pub fn run(self, mut furrow: clap::Command) -> Result<Ending, Failure> {
        let mut script = Vec::new();
        generate(self.shell, &mut furrow, "furrow", &mut script);
        print(&String::from_utf8_lossy(&script))?;
        Ok(Ending::Done)
    }
}
