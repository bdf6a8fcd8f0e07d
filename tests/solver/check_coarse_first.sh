#!/bin/sh
# check_coarse_first.sh - `radiosity solve`, links as coarse as they pay for: what is chosen, and when nothing is; --scale.
# RADIOSITY names the command.
# Once is enough: it is about numbers.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

solve() { "$radiosity" solve "$@" -q --no-errors --json json --faces faces 2>err; }
value() { tr -d '\n' <json | sed -n "s/.*\"$1\": *\([^,} ]*\).*/\1/p"; }
# SCENE TIMES CHOSEN [OPTION...]: thresholds so many times what is set, chosen or not
scaled() {
    scene=$1 times=$2 chosen=$3
    shift 3
    count=$((count + 1))
    solve "$scene" "$@" && [ "$(value chosen)" = "$chosen" ] && [ "$(value thresholds_times | sed 's/\.0$//')" = "$times" ] \
        || failed "$(basename "$scene") $*: $(value thresholds_times) $(value chosen), not $times $chosen"
}
# TEXT OPTIONS...: wrong usage that says this
wrong() {
    text=$1
    shift
    count=$((count + 1))
    solve "$scenes/furnace.obj" "$@"
    [ $? = 2 ] && grep -qF -- "$text" err || failed "$*: not said: $text"
}

# In a room links pay; among boxes that hide each other in part they do not.
printf 'newmtl wall\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n' >boxes.mtl
awk -v N=3 -f "$top/tests/solver/box.awk" -f "$top/tests/solver/hanging_boxes.awk" >boxes.obj
scaled boxes.obj 16 true
awk -v N=7 -f "$top/tests/solver/box.awk" -f "$top/tests/solver/hanging_boxes.awk" >boxes.obj
scaled boxes.obj null true
cp faces once
count=$((count + 1))
[ "$(value links)" = 0 ] || failed "links, though there should be none"
count=$((count + 1))
solve boxes.obj --threads 1 && cmp -s faces once || failed "without links, another number of threads, another answer"
# Coarse links know nothing of the gap between lamps and ceiling; fine ones cost less than particles for all of it.
scaled "$top/tests/runtime/panels.obj" 1 true
# A limit that somebody has set is no price, and ends the run.
for limit in depth=1 links=100 pairs=1000; do
    count=$((count + 1))
    solve boxes.obj --limit "$limit"
    [ $? = 1 ] && grep -q "did not end within $limit" err || failed "--limit $limit"
done
# Links that are asked for, or how they are solved, are made.
scaled boxes.obj 16 true --solver jacobi
scaled boxes.obj 16 true --closure rows
scaled "$scenes/room.obj" 1 true
cp faces once
scaled "$scenes/room.obj" 1 true --threads 1
count=$((count + 1))
cmp -s faces once || failed "another number of threads, another answer"
scaled "$scenes/room.obj" 1 false --set bend=5e-6
scaled "$scenes/room.obj" 1 false --oracle bf_guarded
scaled "$scenes/room.obj" 1 false --no-correct
scaled "$scenes/room.obj" 1 false --basis constant
scaled "$scenes/room.obj" 1 false --statistics out
scaled "$scenes/room.obj" 4 false --scale 4 --no-correct
count=$((count + 1))
cp faces by_scale
solve "$scenes/room.obj" --no-correct --set energy=8e-5 --set bend=2e-5 --set shadow=1.2e-4 --set noise=3.2e-5 --set spot=1.2e-6 \
    --set product=2e-7 && cmp -s faces by_scale || failed "--scale 4 is not all thresholds times 4"
scaled "$scenes/room.obj" null false --scale none
wrong "--scale" --scale 0
wrong "--errors=all accounts for links" --scale none --errors=all
# What is about links is not passed over where there are none.
for option in "--closure rows" "--tolerance 1e-6" "--solver jacobi" "--projection collocation" "--oracle bf" "--set bend=1" \
    "--params x" "--replace x=y" "--trace x" "--statistics x"; do
    # shellcheck disable=SC2086
    wrong "${option%% *} " --scale none $option
    grep -q "does not go with --scale none" err || failed "--scale none $option"
done
wrong "--scale" --scale 1e9
wrong "--scale" --scale x
count=$((count + 1))
"$radiosity" solve "$scenes/furnace.obj" --scale 2 --accuracy 1% 2>err
[ $? = 2 ] && grep -qF -- "--accuracy chooses the scale" err || failed "--scale goes with --accuracy"
count=$((count + 1))
"$radiosity" solve "$scenes/furnace.obj" --scale none --accuracy 1% 2>err
[ $? = 2 ] && grep -qF -- "--accuracy chooses the scale" err || failed "--scale none goes with --accuracy"

finish "coarse first"
