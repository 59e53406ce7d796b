#!/usr/bin/env bash
# Installs the command: the stripped binary, shell completions and manual pages, below PREFIX; says what goes where.
# usage: PREFIX=/usr/local scripts/install.sh path/to/furrow      # PREFIX: ~/.local, for root /usr/local
set -euo pipefail

furrow=$1
if [ "$(id -u)" -eq 0 ]; then usual=/usr/local; else usual=$HOME/.local; fi
prefix=${PREFIX:-$usual}
limit_mb=60

say() { printf 'install: %s\n' "$*" >&2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

strip -o "$scratch/furrow" "$furrow"
mb=$(($(stat -c %s "$scratch/furrow") / 1000000))
if [ "$mb" -ge "$limit_mb" ]; then
    say "the stripped binary has $mb MB, and $limit_mb are the limit"
    exit 1
fi
"$scratch/furrow" completions bash > "$scratch/furrow.bash"
"$scratch/furrow" completions zsh > "$scratch/_furrow"
"$scratch/furrow" completions fish > "$scratch/furrow.fish"
"$scratch/furrow" man --all "$scratch/man1"

share=$prefix/share
install -D -m 755 "$scratch/furrow" "$prefix/bin/furrow"
install -D -m 644 "$scratch/furrow.bash" "$share/bash-completion/completions/furrow"
install -D -m 644 "$scratch/_furrow" "$share/zsh/site-functions/_furrow"
install -D -m 644 "$scratch/furrow.fish" "$share/fish/vendor_completions.d/furrow.fish"
install -D -m 644 -t "$share/man/man1" "$scratch"/man1/*.1

say "$prefix/bin/furrow ($("$prefix/bin/furrow" --version), $mb MB)"
say "$share/bash-completion/completions/furrow"
say "$share/zsh/site-functions/_furrow"
say "$share/fish/vendor_completions.d/furrow.fish"
say "$share/man/man1/furrow.1 and $(($(ls "$scratch/man1" | wc -l) - 1)) pages of commands: man furrow, man furrow-ingest"
case :$PATH: in
*:$prefix/bin:*) ;;
*) say "$prefix/bin is not on PATH: add it, as in  export PATH=\"$prefix/bin:\$PATH\"" ;;
esac
if [ "$prefix" = "$HOME/.local" ]; then
    say "zsh looks for completions there after  fpath+=($share/zsh/site-functions)  in ~/.zshrc, before compinit"
fi
