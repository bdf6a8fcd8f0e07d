#!/usr/bin/env bash
# bench_threads.sh RADIOSITY [SCENE.obj ...] - what threads bring, and cost beside other work: seconds of the clock and of
# processors that a solve takes with 1 and 2 threads, alone and beside 8 busy loops. `efficiency` is the clock's with 1
# thread over twice that with 2, and means something on an idle machine of 2 processors; `cost` is processor time beside
# the loops with 2 threads over that alone with 1 (at most 1.2). SETTINGS: options of solve. BUSY: how many loops.
# SPDX-License-Identifier: MIT
set -u
radiosity=$1
shift
[ $# -gt 0 ] || set -- examples/scenes/maze_8.obj examples/scenes/td.obj
errors=$(mktemp) || exit 2
TIMEFORMAT='%R %U %S'
loops=
end_loops() {
    # shellcheck disable=SC2086
    [ -z "$loops" ] || { kill $loops && wait $loops; } 2>/dev/null
    loops=
}
trap 'end_loops; rm -f "$errors"' EXIT
trap 'exit 130' INT TERM
took() { # SCENE THREADS: seconds of the clock, of processors
    # shellcheck disable=SC2086
    { time "$radiosity" solve "$1" --threads "$2" -q ${SETTINGS-} >/dev/null 2>"$errors"; } 2>&1 | awk '{ print $1, $2 + $3 }'
    [ ! -s "$errors" ] || cat "$errors" >&2
}
echo "load before: $(cut -d ' ' -f 1 /proc/loadavg 2>/dev/null)"
printf '%-14s %9s %9s %10s | %9s %9s | %9s %9s %6s\n' scene '1 thread' '2 threads' efficiency 'cpu 1' 'cpu 2' 'busy 2' 'cpu' cost
for scene; do
    one=$(took "$scene" 1)
    two=$(took "$scene" 2)
    for _ in $(seq "${BUSY:-8}"); do
        sh -c 'while :; do :; done' &
        loops="$loops $!"
    done
    busy=$(took "$scene" 2)
    end_loops
    echo "$one $two $busy" | awk -v s="$(basename "$scene" .obj)" \
        '{ printf "%-14s %9.2f %9.2f %10.2f | %9.2f %9.2f | %9.2f %9.2f %6.2f\n", s, $1, $3, $1 / (2 * $3), $2, $4, $5, $6, $6 / $2 }'
done
