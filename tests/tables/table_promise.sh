#!/bin/sh
# table_promise.sh - the line that says whether thermal's promise was kept: a unit cube that reflects half, with one lit face.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
printf 'newmtl lit\nKd .5 .5 .5\nKe 1 1 1\nnewmtl grey\nKd .5 .5 .5\nKe 0 0 0\n' >"$tmp/cube.mtl"
{
    echo "mtllib cube.mtl"
    for z in 0 1; do printf 'v 0 0 %d\nv 1 0 %d\nv 1 1 %d\nv 0 1 %d\n' $z $z $z $z; done
    printf 'usemtl lit\nf 5 8 7 6\nusemtl grey\nf 1 2 3 4\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n'
} >"$tmp/cube.obj"
echo "    \$ build/bin/radiosity solve cube.obj --oracle thermal --set tolerance_watts=0.005 --set share=0"
"$radiosity" solve "$tmp/cube.obj" --oracle thermal --set tolerance_watts=0.005 --set share=0 >"$tmp/out"
grep '^promise ' "$tmp/out" >"$tmp/line"
sed 's/^/    /' "$tmp/line"
printf '\n(A unit cube that reflects half, with one face that emits 1 W/m2.)\n'
