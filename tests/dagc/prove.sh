#!/bin/sh
# prove.sh DAGC COUNT - random graphs, compiled and walked beside their compiled function, on every path
# or on paths that cover all pairs of arcs; plain, counted, traced and over blocks. 100 graphs per call of the C compiler.
# SPDX-License-Identifier: MIT
set -u
dagc=$1 count=$2
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
proved=0 all=0 bad=0 seed=0
while [ $((seed * 100)) -lt "$count" ]; do
    seed=$((seed + 1))
    batch=$((count - (seed - 1) * 100))
    [ $batch -le 100 ] || batch=100
    awk -v seed=$seed -v count=$batch -f "$here/random_graphs.awk" >"$tmp/g.dag"
    if ! "$dagc" --catalog "$here/test_catalog.dag" -Wno-all --prove --instrument --trace --release=wave "$tmp/g.dag" >"$tmp/report"; then
        bad=1
        echo "seed $seed:"
        grep -v ': proved on' "$tmp/report"
    fi
    proved=$((proved + $(grep -c ': proved on' "$tmp/report")))
    all=$((all + $(grep -c ': proved on all' "$tmp/report")))
done
echo "prove: $proved of $count random graphs, $all of them on all their paths"
[ $bad = 0 ] && [ "$proved" = "$count" ]
