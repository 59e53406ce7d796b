#!/usr/bin/env bash
# Fails if a comment line of a Rust file is longer than 120 columns; lists them as FILE:LINE. rustfmt does not wrap comments.
set -euo pipefail
cd "$(dirname "$0")/.."

columns=120
# grep counts characters, not bytes, in a UTF-8 locale.
long=$(find . \( -path ./target -o -path ./.git \) -prune -o -name '*.rs' -print0 |
    LC_ALL=C.UTF-8 xargs -0 grep -nP "^(?=.{$((columns + 1))})\s*//" | cut -d: -f1,2 | sort -t: -k1,1 -k2,2n || true)
if [ -n "$long" ]; then
    printf '%s\n' "$long"
    printf 'comments: %s comment lines are longer than %s columns\n' "$(wc -l <<<"$long")" "$columns" >&2
    exit 1
fi
