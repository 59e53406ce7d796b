#!/usr/bin/env bash
# The main job on the simulated field: simulate → ingest → run → report. Safe to run again: what is there is not done twice.
# usage: scripts/demo.sh path/to/furrow [folder]
set -euo pipefail

furrow=$1
demo=${2:-target/demo}
length_m=${FURROW_DEMO_LENGTH_M:-16}

say() { printf '\n== %s\n' "$*" >&2; }

mkdir -p "$demo"
export FURROW_STORE=$demo/field
# Another version of odometry makes other traversals of the same recordings, and a store of both would show each twice.
made_by=$(cksum < "$furrow")
if [ "$made_by" != "$(cat "$demo/made-by" 2>/dev/null)" ]; then
    rm -rf "$FURROW_STORE"
fi
"$furrow" init "$FURROW_STORE"
printf '%s\n' "$made_by" > "$demo/made-by"

cat > "$demo/campaign.toml" <<END
folder = "recordings"
site = "old-zoo"
length_m = $length_m

[[pass]]
slots = ["08:00", "10:00", "12:00"]
purposes = ["experience", "evaluation"]

[[pass]]
route = "vocabulary"
slots = ["10:00"]
purposes = ["vocabulary"]
length_m = $((length_m * 5 / 2))
END
say "recording the traversals of $demo/campaign.toml ($length_m m each)"
ingests=$("$furrow" simulate --campaign "$demo/campaign.toml")

# What a user would copy from the screen: one command per recording.
while IFS= read -r ingest; do
    say "$ingest"
    # shellcheck disable=SC2294 # the line is quoted for a shell
    eval "\"\$furrow\" ${ingest#furrow }"
done <<<"$ingests"

say "what the store holds"
"$furrow" ls

say "running the matrix: every live traversal against every experience"
"$furrow" run runner/matrices/demo.toml

"$furrow" report latest -o "$demo/report.html"
say "the report is at $demo/report.html: open it in a browser; \`$furrow browse --store $FURROW_STORE\` shows the rest"
