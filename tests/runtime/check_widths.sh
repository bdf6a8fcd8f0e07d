#!/bin/sh
# check_widths.sh - decisions and links do not depend on the width of vectors: oracles compiled for loops and vectors of 1, 4, 8
# and 16 numbers refine random rooms as the library's do, pair by pair and in waves, on 1 to 3 threads: two of the oracles in 6
# rooms, with THOROUGH all in 300, which takes half an hour of a processor; ROOMS: in as many. Made with SANITIZE they are
# compiled so, too.
# Once is enough: it is about bits.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../dagc/lib.sh"
build=$(dirname "$(dirname "$dagc")")
flags="-std=c11 -D_XOPEN_SOURCE=700 -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp-simd"
folders="-I$build/gen -I$top/runtime -I$top/runtime/oracle -I$top/dagc"

compile() { # ORACLE WIDTH OPTION...
    oracle=$1 width=$2
    shift 2
    ${CC:-cc} $flags ${SANITIZE-} $folders "$@" -fPIC -shared -o "$tmp/${oracle}_$width.so" "$build/gen/oracles/$oracle.c" -lm || return
    WIDTHS="$WIDTHS $oracle $width $tmp/${oracle}_$width.so"
}
oracles="power bf_guarded" rooms=6
if [ -n "${THOROUGH-}" ]; then
    rooms=300
    oracles=$(cd "$build/gen/oracles" && ls ./*.c | sed 's/^\.\///; s/\.c$//')
fi
WIDTHS=
for one in $oracles; do
    # AVX-512 where the processor has it, and loops twice its width; AVX2; no vector that the compiler was not told of
    check "$one, 16" compile "$one" 16 -O2 -DLANES=16 -DLANES_WIDEST=8
    check "$one, 8" compile "$one" 8 -O2 -DLANES=8 -DLANES_WIDEST=8
    check "$one, 4" compile "$one" 4 -O2 -DLANES=4 -DLANES_WIDEST=4
    check "$one, 1" compile "$one" 1 -O1 -DLANES=1 -DLANES_WIDEST=1
done
export WIDTHS ROOMS=${ROOMS:-$rooms}
check "the same in rooms" "$build/tests/runtime/width_rooms"
cat "$tmp/out"
# two widths of one text would have the same bits if the second were not another
check "and are compiled otherwise" sh -c '! cmp -s power_1.so power_4.so && ! cmp -s power_4.so power_8.so && ! cmp -s power_8.so power_16.so'
finish widths
