#!/bin/sh
# table_releases.sh - what the releases of one oracle cost, against the one written by hand.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
echo "| \`radiosity compare examples/scenes/...\` (\`bf_guarded\`) | decisions | links | dag / hand, time | flat / hand, time |"
echo "|---|---|---|---|---|"
for name in room cornell maze_8; do
    say "$name"
    "$radiosity" compare "examples/scenes/$name.obj" >"$tmp/out"
    awk -v name="$name" '
        /^identical: / { decisions = $2; links = $4 }
        $1 == "dag" || $1 == "flat" { ratio[$1] = $4 }
        END { printf "| `%s.obj` | %s | %s | %.2f | %.2f |\n", name, decisions, links, ratio["dag"], ratio["flat"] }' "$tmp/out"
done
