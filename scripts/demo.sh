#!/usr/bin/env bash
# The main job on the embedded field: simulate → ingest → matrix → report. Safe to run again: what is there is not done twice.
# usage: scripts/demo.sh path/to/furrow [folder]
set -euo pipefail

furrow=$1
demo=${2:-target/demo}
site=old-zoo
slots=(08:00 10:00)
length_m=${FURROW_DEMO_LENGTH_M:-24}

say() { printf '\n== %s\n' "$*" >&2; }

# A pass by the simulated robot, then into the store. Slot, purpose, route, pass number, metres.
outing() {
    local slot=$1 purpose=$2 route=$3 number=$4 metres=$5
    local file="$demo/recordings/$site-$route-${slot/:/}-$purpose.mcap"
    if [ ! -s "$file" ]; then
        say "recording the $purpose pass at $slot on the $route route ($metres m)"
        "$furrow" simulate --site "$site" --slot "$slot" --route "$route" --number "$number" --length "$metres" -o "$file"
    fi
    say "ingesting the $purpose pass at $slot"
    "$furrow" ingest "$file" --site "$site" --route "$route" --slot "$slot" --pass "$purpose"
}

mkdir -p "$demo/recordings"
export FURROW_STORE=$demo/field
"$furrow" init "$FURROW_STORE"

for slot in "${slots[@]}"; do
    outing "$slot" experience main 0 "$length_m"
    outing "$slot" evaluation main 1 "$length_m"
done
outing 10:00 vocabulary vocabulary 0 "$((length_m * 3 / 2))"

say "what the store holds"
"$furrow" ls

say "running the matrix: every live pass against every experience"
"$furrow" run runner/matrices/demo.toml

"$furrow" report latest -o "$demo/report.html"
say "the report is at $demo/report.html: open it in a browser"
