#!/usr/bin/env bash
# The thesis' experiments on the simulated field: record, ingest, train, run X01 to X15, report, and check the claims.
# Killed at any moment, the same command continues: a traversal that the store holds is neither recorded nor ingested again.
# usage: SCALE=ci|full [SIZE=COLUMNSxROWS] [RATE_HZ=N] scripts/thesis.sh path/to/furrow [folder]
#   ci    a few metres, three hours, small images and vocabularies: shows that all parts work together, in about a minute; traversals are
#         too short for intervals, so that most claims are not separable, and Lindenhof ends before its row begins
#   full  the routes of the thesis, seven hours, vocabularies up to 10000 words: 39 minutes on two cores, 18 GB of disk. Three pairs
#         a second, the slowest at which the thesis localised, and eight at 04:30; recordings are deleted once their images are in the store
set -euo pipefail

# The shell reads all of this before it starts: editing the file meanwhile does not disturb hours of work.
{
furrow=$1
scale=${SCALE:-ci}
thesis=${2:-target/thesis-$scale}
matrices=$(cd "$(dirname "$0")/../runner/matrices" && pwd)

say() { printf '\n== %s %s\n' "$(date +%H:%M:%S)" "$*" >&2; }

# Traversals as "SITE ROUTE SLOTS PURPOSES METRES [HZ]", slots and purposes joined by commas; experiments; generators as "SITE FROM TO NAME".
case $scale in
ci)
    size=${SIZE:-320x180} rate=${RATE_HZ:-4} bytes=()
    traversals=("old-zoo main 08:00,10:00,16:00 experience,evaluation 8"
        "old-zoo vocabulary 10:00,16:00 vocabulary 16"
        "lindenhof main 10:00 experience,evaluation 8"
        "backsburg main 10:00 experience,evaluation 8"
        "lindenhof vocabulary 10:00 vocabulary 14"
        "backsburg vocabulary 10:00 vocabulary 14")
    experiments=(X01 X02 X03 X04 X08 X09 X10 X13 X14)
    generators=("old-zoo 10:00 16:00 otf:10:00>16:00") ;;
full)
    size=${SIZE:-480x270} rate=${RATE_HZ:-3} bytes=(--no-recording)
    # Backsburg's vocabulary route is recorded more densely: X01 asks for 2500 images. The lions' cage is a route of an earlier day.
    traversals=("old-zoo main 04:30,06:00,08:00,10:00,12:00,14:00,16:00 experience,evaluation 210"
        "old-zoo vocabulary 04:30,06:00,10:00,14:00,16:00 vocabulary 80"
        "old-zoo lions 06:00,10:00,14:00 experience 60"
        "old-zoo lions 10:00 evaluation 60"
        "lindenhof main 10:00 experience,evaluation 158"
        "lindenhof main 06:00 experience 158"
        "backsburg main 10:00 experience,evaluation 105"
        "lindenhof vocabulary 10:00 vocabulary 240"
        "lindenhof vocabulary 06:00 vocabulary 80"
        "backsburg vocabulary 10:00 vocabulary 240 8")
    experiments=(X01 X02 X03 X04 X06 X07 X08 X09 X10 X11 X12 X13 X14 X15)
    generators=()
    for way in '04:30 10:00' '10:00 04:30' '10:00 16:00' '16:00 10:00' '04:30 16:00' '16:00 04:30' '06:00 10:00' '14:00 10:00'; do
        generators+=("old-zoo $way otf:${way/ />}")
    done
    generators+=("lindenhof 06:00 10:00 lindenhof:06:00>10:00" "lindenhof 10:00 06:00 lindenhof:10:00>06:00") ;;
*)
    printf 'thesis: SCALE=%s: expected ci or full\n' "$scale" >&2
    exit 2 ;;
esac

mkdir -p "$thesis/recordings" "$thesis/matrices" "$thesis/reports"
export FURROW_STORE=$thesis/field
"$furrow" init "$FURROW_STORE"
# What a killed simulation left.
rm -f "$thesis"/recordings/.*.part

# The store knows a recording by its name, and the name says all that it depends on.
held=$("$furrow" ls --json)
disk_gb() { df -Pk "$thesis" | awk 'NR == 2 { print int($4 / 1048576) }'; }

# record_and_ingest SITE ROUTE SLOT PURPOSE METRES HZ NUMBER: one traversal into the store.
record_and_ingest() {
    local site=$1 route=$2 slot=$3 purpose=$4 metres=$5 hz=$6 number=$7
    local stem=$site-$route-${slot/:/}-$purpose-${metres}m-$size-${hz}hz drive=(--route "$route") file
    file=$thesis/recordings/$stem.mcap
    if [ "$route" = lions ]; then
        drive=(--route main --date 2025-12-18)
    fi
    if grep -qF "\"$stem.mcap\"" <<<"$held"; then
        say "$stem is in the store already"
    else
        if [ "$(disk_gb)" -lt 3 ]; then
            printf 'thesis: less than 3 GB are free for %s: free some, or name another folder, and run this again\n' "$thesis" >&2
            exit 1
        fi
        say "recording $stem"
        # A recording gets its name when it is whole.
        [ -f "$file" ] || "$furrow" simulate --site "$site" "${drive[@]}" --slot "$slot" --number "$number" --length "$metres" \
            --size "$size" --rate "$hz" -o "$file"
        "$furrow" ingest "$file" --site "$site" --route "$route" --slot "$slot" --purpose "$purpose" ${bytes[@]+"${bytes[@]}"}
    fi
    if [ ${#bytes[@]} -gt 0 ]; then
        rm -f "${file%.mcap}".{mcap,frames.csv,groundtruth.tum,pass.json}
    fi
}

for traversal in "${traversals[@]}"; do
    read -r site route slots purposes metres hz <<<"$traversal"
    for slot in ${slots//,/ }; do
        # Traversals of one slot differ: each has a number of its own.
        for purpose in ${purposes//,/ }; do
            number=0
            [ "$purpose" = evaluation ] && number=1
            # By head-light alone odometry fails where frames are farther apart: at 4 pairs a second on two steps of three, at 8 on none.
            [ "$slot" = 04:30 ] && night=8 || night=
            record_and_ingest "$site" "$route" "$slot" "$purpose" "$metres" "${night:-${hz:-$rate}}" "$number"
        done
    done
done

for generator in "${generators[@]}"; do
    read -r site from to name <<<"$generator"
    say "training $name"
    "$furrow" generator train --site "$site" --from "$from" --to "$to" --name "$name"
done

# One experiment that fails does not stop the others.
failed=()
for experiment in "${experiments[@]}"; do
    file=$matrices/$experiment.toml
    mine=$thesis/matrices/$experiment.toml
    if [ "$scale" = ci ]; then
        # The same questions with vocabularies that a few metres can fill.
        sed -E -e 's/words = [0-9]+/words = 600/' -e 's/^words = \[.*\]/words = [200, 400, 800]/' -e 's/^images = \[.*\]/images = [20, 40, 80]/' \
            -e 's/distance_m = 2.0/distance_m = 1.0/' "$file" > "$mine"
    else
        cp "$file" "$mine"
    fi
    say "$experiment"
    # 3 says that some cells are blocked or failed: the claims say what was not measured.
    if "$furrow" run "$mine" --keep-going || [ $? -eq 3 ]; then
        "$furrow" report latest -o "$thesis/reports/$experiment.html"
    else
        failed+=("$experiment")
    fi
done

say "the claims"
"$furrow" claims -o "$thesis/thesis.html" --reports reports
say "all is in $thesis/thesis.html, which links to the reports: open it in a browser"
if [ ${#failed[@]} -gt 0 ]; then
    printf 'thesis: these ended with a failure, told above: %s; run this again once it is mended\n' "${failed[*]}" >&2
    exit 1
fi
exit 0
}
