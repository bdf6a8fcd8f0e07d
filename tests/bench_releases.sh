#!/bin/sh
# bench_releases.sh RADIOSITY [SCENE.obj ...] - instructions of the refinement loop, rays excluded, per
# release and oracle, as ratios to the hand-written one. Needs valgrind. Coarse parameters keep it short;
# ORACLE_SETTINGS overrides them.
# SPDX-License-Identifier: MIT
set -eu
radiosity=$1
shift
[ $# -gt 0 ] || set -- examples/scenes/cornell.obj examples/scenes/room.obj examples/scenes/maze_8.obj examples/scenes/td.obj
out=$(mktemp)
trap 'rm -f "$out"' EXIT
count() { # scene oracle release: instructions of the loop less those of the ray caster
    valgrind --tool=callgrind --callgrind-out-file="$out" --toggle-collect=refinement_start \
        --toggle-collect=refinement_again "$radiosity" solve "$1" --threads 1 -q --oracle "$2" --release "$3" \
        ${ORACLE_SETTINGS:---set relative=0.3 --set rays=4} >/dev/null 2>&1
    callgrind_annotate --inclusive=yes "$out" 2>/dev/null | tr -d , | awk '
        /PROGRAM TOTALS/ { all = $1 }
        /rays.c:occluded/ && !rays { rays = $1 }
        END { printf "%d\n", all - rays }'
}
printf '%-12s %-11s %14s %8s %8s\n' scene oracle 'hand, instr.' dag flat
for scene; do
    for oracle in bf bf_guarded; do
        hand=$(count "$scene" $oracle hand)
        dag=$(count "$scene" $oracle dag)
        flat=$(count "$scene" $oracle flat)
        awk -v s="$(basename "$scene" .obj)" -v o=$oracle -v h="$hand" -v d="$dag" -v f="$flat" \
            'BEGIN { printf "%-12s %-11s %14d %8.3f %8.3f\n", s, o, h, d / h, f / h }'
    done
done
