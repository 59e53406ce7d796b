#!/usr/bin/env bash
# The thesis' experiments on the simulated field: record, ingest, train, run X01 to X15, report, and hold the claims against them.
# Safe to run again: what is there is not done twice.
# usage: SCALE=ci|full scripts/thesis.sh path/to/furrow [folder]
#   ci    a few metres, three hours, small vocabularies: shows that all parts work together, in minutes; passes are too short
#         for intervals, so that most claims are not separable, and Lindenhof ends before its row begins
#   full  the routes of the thesis, seven hours, vocabularies up to 10000 words: not timed yet, expect a day or more on two cores
#   tiny  for the tests: one site, two hours, X10 alone
set -euo pipefail

furrow=$1
scale=${SCALE:-ci}
thesis=${2:-target/thesis-$scale}
matrices=$(cd "$(dirname "$0")/../runner/matrices" && pwd)

say() { printf '\n== %s\n' "$*" >&2; }

# Old Zoo hours, metres of main and vocabulary routes, experiments, whether vocabularies are cut down, generators as "SITE FROM TO NAME".
case $scale in
tiny)
    hours='"08:00", "10:00"' zoo_m=5 field_m=0 words_m=12 size=320x180
    experiments=(X10) small=1 generators=() ;;
ci)
    hours='"08:00", "10:00", "16:00"' zoo_m=8 field_m=12 words_m=16 size=480x270
    experiments=(X01 X02 X03 X04 X08 X09 X10 X13 X14) small=1
    generators=("old-zoo 10:00 16:00 otf:10:00>16:00") ;;
full)
    hours='"04:30", "06:00", "08:00", "10:00", "12:00", "14:00", "16:00"' zoo_m=210 field_m=160 words_m=300 size=640x360
    experiments=(X01 X02 X03 X04 X06 X07 X08 X09 X10 X11 X12 X13 X14 X15) small=
    generators=()
    for way in '04:30 10:00' '10:00 04:30' '10:00 16:00' '16:00 10:00' '04:30 16:00' '16:00 04:30' '06:00 10:00' '14:00 10:00'; do
        generators+=("old-zoo $way otf:${way/ />}")
    done
    generators+=("lindenhof 06:00 10:00 lindenhof:06:00>10:00" "lindenhof 10:00 06:00 lindenhof:10:00>06:00") ;;
*)
    printf 'thesis: SCALE=%s: expected ci or full (or tiny)\n' "$scale" >&2
    exit 2 ;;
esac

mkdir -p "$thesis/matrices" "$thesis/reports"
export FURROW_STORE=$thesis/field
"$furrow" init "$FURROW_STORE"

# Words of the generators' hours are learned elsewhere; the earlier day of X15 is a route of its own in the store.
vocabulary='"10:00"'
[ "$scale" = ci ] && vocabulary='"10:00", "16:00"'
[ "$scale" = full ] && vocabulary='"04:30", "06:00", "10:00", "14:00", "16:00"'
{
    printf 'folder = "recordings"\nsize = "%s"\n' "$size"
    printf '\n[[pass]]\nsite = "old-zoo"\nslots = [%s]\npurposes = ["experience", "evaluation"]\nlength_m = %s\n' "$hours" "$zoo_m"
    printf '\n[[pass]]\nsite = "old-zoo"\nroute = "vocabulary"\nslots = [%s]\npurposes = ["vocabulary"]\nlength_m = %s\n' "$vocabulary" "$words_m"
    if [ "$field_m" -gt 0 ]; then
        printf '\n[[pass]]\nsites = ["lindenhof", "backsburg"]\nslots = ["10:00"]\npurposes = ["experience", "evaluation"]\nlength_m = %s\n' "$field_m"
        printf '\n[[pass]]\nsites = ["lindenhof", "backsburg"]\nroute = "vocabulary"\nslots = ["10:00"]\npurposes = ["vocabulary"]\nlength_m = %s\n' "$words_m"
    fi
    if [ "$scale" = full ]; then
        printf '\n[[pass]]\nsite = "lindenhof"\nslots = ["06:00"]\npurposes = ["experience"]\nlength_m = %s\n' "$field_m"
        printf '\n[[pass]]\nsite = "lindenhof"\nroute = "vocabulary"\nslots = ["06:00"]\npurposes = ["vocabulary"]\nlength_m = %s\n' "$words_m"
    fi
} > "$thesis/campaign.toml"
campaigns=("$thesis/campaign.toml")
if [ "$scale" = full ]; then
    {
        printf 'folder = "lions"\nsize = "%s"\nsite = "old-zoo"\ndate = "2025-12-18"\nlength_m = 60\n' "$size"
        printf '\n[[pass]]\nslots = ["06:00", "10:00", "14:00"]\npurposes = ["experience"]\n\n[[pass]]\nslots = ["10:00"]\npurposes = ["evaluation"]\n'
    } > "$thesis/lions.toml"
    campaigns+=("$thesis/lions.toml")
fi

for campaign in "${campaigns[@]}"; do
    say "recording the outings of $campaign"
    ingests=$("$furrow" simulate --campaign "$campaign")
    [ "$campaign" = "$thesis/lions.toml" ] && ingests=${ingests//--route main/--route lions}
    while IFS= read -r ingest; do
        say "$ingest"
        # shellcheck disable=SC2294 # the line is quoted for a shell
        eval "\"\$furrow\" ${ingest#furrow }"
    done <<<"$ingests"
done

for generator in ${generators[@]+"${generators[@]}"}; do
    read -r site from to name <<<"$generator"
    say "training $name"
    "$furrow" generator train --site "$site" --from "$from" --to "$to" --name "$name"
done

for experiment in "${experiments[@]}"; do
    file=$matrices/$experiment.toml
    if [ ! -f "$file" ]; then
        say "$experiment: no such matrix in $matrices, left out"
        continue
    fi
    mine=$thesis/matrices/$experiment.toml
    if [ -n "$small" ]; then
        # The same questions with vocabularies that a few metres can fill.
        sed -E -e 's/words = [0-9]+/words = 600/' -e 's/^words = \[.*\]/words = [200, 400, 800]/' -e 's/^images = \[.*\]/images = [20, 40, 80]/' \
            -e 's/distance_m = 2.0/distance_m = 1.0/' "$file" > "$mine"
    else
        cp "$file" "$mine"
    fi
    say "$experiment"
    # 3 says that some cells are blocked or failed: the claims say what was not measured.
    "$furrow" run "$mine" --keep-going || [ $? -eq 3 ]
    "$furrow" report latest -o "$thesis/reports/$experiment.html"
done

say "the claims"
"$furrow" claims -o "$thesis/thesis.html" --reports reports
say "all is in $thesis/thesis.html, which links to the reports: open it in a browser"
