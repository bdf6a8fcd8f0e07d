#!/bin/sh
# check_marks.sh - elements that an oracle marks: the same marks, links and light by both releases and any number of threads;
# a refused mark makes a difference; drawings, statistics and explanations show refusals. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
scene=$top/examples/scenes/cornell.obj

# NAME OPTION...: NAME.json and NAME.csv, by links alone
solve() {
    name=$1
    shift
    count=$((count + 1))
    "$radiosity" solve "$scene" -q --no-correct --no-errors --oracle masking --set relative=0.2 --set min_share=2e-4 --set bright=0.2 \
        --json "$name.json" --faces "$name.csv" "$@" 2>err || failed "solve $*"
}
value() { tr -d ' \n' <"$2.json" | sed -n "s/.*\"$1\":\\(\\[[^]]*\\]\\|[0-9]*\\).*/\\1/p"; }
same() {
    for key in links element_marks pairs; do
        alike "$(value $key "$1")" "$(value $key "$2")" || failed "$key of $1 and $2: $(value $key "$1") $(value $key "$2")"
    done
    cmp -s "$1.csv" "$2.csv" || failed "light of $1 and $2"
}

solve flat --threads 1
solve flat_2 --threads 2
solve dag --release dag --threads 1
solve dag_2 --release dag --threads 2 --statistics statistics.json
same flat flat_2
same flat dag
same flat dag_2
case $(value element_marks flat) in
\[*,0,0,0,0,0\]) ;;
*) failed "marks other than 1 and 2: $(value element_marks flat)" ;;
esac
for mark in 2 3; do
    [ "$(value element_marks flat | tr -d '[]' | cut -d, -f$mark)" -gt 20 ] || failed "mark $((mark - 1)): $(value element_marks flat)"
done

# ---- who may not refuse refines more
solve never --replace 'edge=done'
[ "$(value links never)" -gt "$(value links flat)" ] || failed "links $(value links flat), and $(value links never) where nothing is washed out"
solve always --replace 'edge=cannot'
[ "$(value links always)" -lt "$(value links flat)" ] || failed "links $(value links flat), and $(value links always) where all is"

# ---- the releases side by side, and what shows refusals
count=$((count + 4))
"$radiosity" compare "$scene" -q --oracle masking --set relative=0.2 --set min_share=2e-4 --repeats 1 2>err >out || failed compare
tr -d ' \n' <statistics.json | grep -q '"answer":"cannot","kind":"[a-z]*","count":[1-9]' || tr -d ' \n' <statistics.json | grep -q 'cannot' || failed "statistics"
"$radiosity" draw masking -o masking.svg 2>err && { grep -q 'cannot' masking.svg || failed "drawing"; } || grep -qi graphviz err || failed draw
"$radiosity" solve "$scene" --no-correct --no-errors --oracle masking --set relative=0.2 --set min_share=2e-4 >out 2>err
grep -q "^marks .* elements (.*) with mark 2" out || failed "summary"

finish marks
