#!/bin/sh
# check_lanes.sh - form factors have the same bits whatever the width of the loops they are made of and of the vectors that the
# compiler and the processor make of them: by gcc, with THOROUGH by clang, and without optimisation, too.
# Once is enough: it compiles its program itself, by every compiler.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../dagc/lib.sh"
build=$(dirname "$(dirname "$dagc")")
flags="-std=c11 -D_XOPEN_SOURCE=700 -ffp-contract=off -fno-math-errno -fno-trapping-math -I$top/runtime -I$build/gen"

made() { # NAME COMPILER FLAG...: what it prints goes to NAME
    name=$1
    shift
    "$@" $flags -o "program_$name" "$top/tests/runtime/lanes_pairs.c" -lm && "./program_$name" >"$name"
}
check "eight lanes" made wanted gcc -O2
for lanes in 1 4 16; do
    check "$lanes lanes" made "lanes_$lanes" gcc -O2 -DLANES=$lanes
    check "$lanes lanes: the same bits" cmp "lanes_$lanes" wanted
done
for widest in 1 4; do
    check "vectors of $widest" made "widest_$widest" gcc -O2 -DLANES_WIDEST=$widest
    check "vectors of $widest: the same bits" cmp "widest_$widest" wanted
done
if [ -n "${THOROUGH-}" ]; then
    check "clang" made clang clang -O2
    check "clang: the same bits" cmp clang wanted
    check "clang, native" made native clang -O3 -march=native
    check "clang, native: the same bits" cmp native wanted
    check "gcc, native" made plain gcc -O3 -march=native -DLANES_WIDEST=1
    check "gcc, native: the same bits" cmp plain wanted
    check "not optimised" made slow gcc -O0
    check "not optimised: the same bits" cmp slow wanted
fi
finish lanes
