#!/bin/sh
# bench_size.sh DAGC [CC...] - seconds that dagc and C compilers take for graphs of 100, 1,000 and 10,000 nodes.
# The test's runtime stands in for the tools. Fails when dagc needs 1 s, or when ten times the nodes
# take a compiler more than twelve times as long (from 1,000 to 10,000; below, its start counts most).
# SPDX-License-Identifier: MIT
set -u
dagc=$(realpath "$1")
shift
[ $# -gt 0 ] || set -- gcc clang
here=$(cd "$(dirname "$0")" && pwd)
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 2
cp -r "$here"/runtime/* "$here/../../runtime/oracle.h" .
"$dagc" --emit=catalog-h -o catalog.h "$here/test_catalog.dag" || exit 2
bad=0

seconds() { # COMMAND...: its seconds go to the file `took`
    began=$(date +%s.%N)
    "$@" >/dev/null || exit 2
    echo "$began $(date +%s.%N)" | awk '{ printf "%.2f\n", $2 - $1 }' >took
}

for nodes in 100 1000 10000; do
    awk -v seed=1 -v exactly=$nodes -f "$here/random_graphs.awk" >g.dag
    seconds "$dagc" -Wno-all --catalog "$here/test_catalog.dag" -o g.c g.dag
    printf '%6d nodes: %8d lines of C, dagc %s s' $nodes "$(wc -l <g.c)" "$(cat took)"
    awk '{ exit $1 >= 1 }' took || bad=1
    for cc; do
        command -v "$cc" >/dev/null || continue
        seconds "$cc" -std=c11 -O2 -I. -c -o g.o g.c
        printf ', %s -O2 %s s' "$cc" "$(cat took)"
        [ ! -f "$cc.before" ] || [ $nodes != 10000 ] || awk -v before="$(cat "$cc.before")" '{ exit $1 > 12 * before }' took || bad=1
        cp took "$cc.before"
    done
    echo
done
[ $bad = 0 ]
