#!/bin/sh
# check_overlap.sh - faces that overlap in a plane make power: that is told even with -q; the box alone is quiet.
# RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
solve() { count=$((count + 1)) && "$radiosity" solve "$1" -q --no-correct --no-errors --oracle ff --set limit=0.1 2>err; }

printf 'newmtl w\nKd .3\nnewmtl l\nKd .3\nKe 10\n' >box.mtl
cat >box.obj <<'END'
mtllib box.mtl
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 1
v 2 0 1
v 2 2 1
v 0 2 1
v 0.2 0.1 0
v 1.9 0.1 0
v 1.9 1.8 0
v 0.2 1.8 0
usemtl w
f 1 2 3 4
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
usemtl l
f 5 8 7 6
END
solve box.obj && [ ! -s err ] || failed "the box alone"
cp box.obj over.obj
printf 'usemtl w\nf 9 10 11 12\n' >>over.obj
solve over.obj && grep -q 'over.obj: warning: .*more is absorbed than emitted' err || failed "the floor covered again"
finish overlap
