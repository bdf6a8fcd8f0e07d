#!/bin/sh
# check_backs.sh - `radiosity solve`, a box turned inside out in a closed room: that its backs take light is told, and which faces
# stay dark. RADIOSITY names the command.
# Once is enough: it is about words.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# boxes.obj: a room, a box in it or two, a lamp; TURNED: the boxes are inside out.
printf 'newmtl wall\nKd .7 .7 .7\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n' >boxes.mtl
boxes() { # TURNED [TWO]
    echo 'BEGIN {
        print "mtllib boxes.mtl"; print "usemtl wall"
        box(0, 0, 0, 6, 6, 3, 1); box(1, 1, .2, 2, 3, 1.5, TURNED)
        if (TWO) box(3.5, 1, .2, 2, 3, 1.5, TURNED)
        print "usemtl lamp"
        box(2.9, 2.9, 2.8, .5, .5, .1)
    }' >three.awk
    awk -v TURNED="$1" -v TWO="${2:-0}" -f "$top/tests/solver/box.awk" -f three.awk >boxes.obj
}
said() {
    count=$((count + 1))
    grep -qF -- "$2" "$1" || failed "not said: $2"
}

boxes 1
"$radiosity" solve boxes.obj --json json >out 2>err || failed "a turned box is not solved"
said err "of the light ends on black backs"
said err "turn them, or take --two-sided"
said out "dim       6 of 12 large faces are too dim for their light to be known to 5 %: faces 6, 7, 8, 9, 10, 11"
count=$((count + 1))
tr -d ' \n' <json | grep -q '"backs":{"share":0.3[0-9]*,"face":7,' || failed "backs are not in the JSON"
count=$((count + 1))
tr -d ' \n' <json | grep -q '"first_unsure":\[6,7,8,9,10,11\]' || failed "dim faces are not in the JSON"
boxes 1 1
"$radiosity" solve boxes.obj --json json >out 2>err
said out "dim       12 of 18 large faces are too dim for their light to be known to 5 %: faces 6, 7, 8, 9, 10, 11, 12, 13, ... (--json has all)"
count=$((count + 1))
tr -d ' \n' <json | grep -q '"first_unsure":\[6,7,8,9,10,11,12,13,14,15,16,17\]' || failed "not all dim faces are in the JSON"
boxes 1
count=$((count + 1))
"$radiosity" solve boxes.obj --two-sided >out 2>err && ! grep -q back out err || failed "backs of two-sided faces are black"
boxes 0
"$radiosity" solve boxes.obj --json json >out 2>err
count=$((count + 1))
! grep -q back out err || failed "backs are met in a scene that shows none"
count=$((count + 1))
tr -d ' \n' <json | grep -q '"backs":null' || failed "backs in the JSON of a scene that shows none"

finish "backs"
