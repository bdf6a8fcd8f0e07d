#!/bin/sh
# bench_flat.sh RADIOSITY [SCENE...] - instructions per release inside discussions, counted by callgrind, so
# that neither load nor clock plays a part. Fails when the flat release needs more than 1.05 of the hand-written.
# SPDX-License-Identifier: MIT
set -u
radiosity=$1
shift
scenes=$(cd "$(dirname "$0")/../examples/scenes" && pwd)
[ $# -gt 0 ] || set -- "$scenes/cornell.obj" "$scenes/room.obj"
command -v valgrind >/dev/null || { echo "skipped: valgrind is not installed"; exit 0; }
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
bad=0

instructions() { # ORACLE RELEASE SCENE
    valgrind --tool=callgrind --callgrind-out-file="$tmp/out" --toggle-collect=discuss "$radiosity" solve "$3" \
        --oracle "$1" --release "$2" --threads 1 --set min_share=2e-3 --tolerance 0.5 >/dev/null 2>&1
    sed -n 's/^\(totals\|summary\): //p' "$tmp/out" | head -n 1
}

for scene; do
    for oracle in bf bf_guarded; do
        hand=$(instructions $oracle hand "$scene")
        flat=$(instructions $oracle flat "$scene")
        dag=$(instructions $oracle dag "$scene")
        echo "${scene##*/} $oracle $hand $flat $dag" |
            awk '{ printf "%s %s: hand %s, flat %.3f, dag %.3f\n", $1, $2, $3, $4 / $3, $5 / $3; exit !($4 <= 1.05 * $3) }' || bad=1
    done
done
[ $bad = 0 ]
