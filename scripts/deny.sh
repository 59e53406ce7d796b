#!/usr/bin/env bash
# Checks the dependencies' licences, sources and bans with cargo-deny, which is built once into target/tools,
# unoptimised: that is done sooner than its work would pay back.
set -euo pipefail
version=0.20.2
deny=target/tools/bin/cargo-deny
if [ ! -x "$deny" ]; then
    printf 'deny: building cargo-deny %s, once\n' "$version" >&2
    cargo install --quiet --locked --profile dev --root target/tools --version "$version" cargo-deny
fi
"$deny" --log-level error check bans licenses sources
