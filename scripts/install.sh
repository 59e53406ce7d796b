#!/usr/bin/env bash
# Builds the command and installs it: the stripped binary, shell completions and manual pages, below PREFIX; says what went where.
# usage: PREFIX=/usr/local scripts/install.sh      # PREFIX: ~/.local, for root /usr/local
set -euo pipefail
cd "$(dirname "$0")/.."

furrow=target/release/furrow
if [ "$(id -u)" -eq 0 ]; then usual=/usr/local; else usual=$HOME/.local; fi
prefix=${PREFIX:-$usual}

say() { printf 'install: %s\n' "$*" >&2; }

# rustc's own linker folds equal functions and packs relocations, which takes an eighth off the binary. Another linker may not know how, and
# a C library before glibc 2.36 cannot load it: then it is linked as usual.
small=(-C link-arg=-Wl,--icf=all -C link-arg=-Wl,-z,pack-relative-relocs)
say "building (a first build takes some minutes)"
if ! { cargo rustc --release --locked --bin furrow -- "${small[@]}" && "$furrow" --version >/dev/null; }; then
    say "linking as usual"
    cargo build --release --locked --bin furrow
fi

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
strip -o "$scratch/furrow" "$furrow"
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

say "$prefix/bin/furrow ($("$prefix/bin/furrow" --version), $(($(stat -c %s "$prefix/bin/furrow") / 1000000)) MB)"
say "$share/bash-completion/completions/furrow"
say "$share/zsh/site-functions/_furrow"
say "$share/fish/vendor_completions.d/furrow.fish"
pages=("$scratch"/man1/*.1)
say "$share/man/man1: man furrow, and ${#pages[@]} pages in all, as man furrow-ingest"
case :$PATH: in
*:$prefix/bin:*) ;;
*) say "$prefix/bin is not on PATH: add it, as in  export PATH=\"$prefix/bin:\$PATH\"" ;;
esac
if [ "$prefix" = "$HOME/.local" ]; then
    say "zsh looks for completions there after  fpath+=($share/zsh/site-functions)  in ~/.zshrc, before compinit"
fi
