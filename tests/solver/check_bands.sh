#!/bin/sh
# check_bands.sh - a band with so few of the watts that particles do not know it: `radiosity solve` says so, and only then.
# RADIOSITY names the command.
# Once is enough: it is about numbers.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# A room of 1 m with a red lamp and a blue one below its ceiling; BLUE: what the blue one emits (W/m2), the red one 1000
room() {
    printf 'newmtl wall\nKd .5 .5 .5\nnewmtl red\nKd 0 0 0\nKe 1000 0 0\nnewmtl blue\nKd 0 0 0\nKe 0 0 %s\n' "$1" >room.mtl
    cat >room.obj <<END
mtllib room.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
v .2 .4 .9
v .2 .6 .9
v .4 .6 .9
v .4 .4 .9
v .6 .4 .9
v .6 .6 .9
v .8 .6 .9
v .8 .4 .9
usemtl wall
f 1 2 3 4
f 8 7 6 5
f 5 6 2 1
f 6 7 3 2
f 7 8 4 3
f 8 5 1 4
usemtl red
f 9 10 11 12
usemtl blue
f 13 14 15 16
END
    "$radiosity" solve room.obj --json json >out 2>err || failed "solve with blue $1: $(tail -n 1 err)"
}
light() { tr -d '\n ' <json | sed 's/.*"correction"//; s/.*"bands":\[\([^]]*\)\].*/\1/' | grep -o '"light":[^,}]*' | cut -d : -f 2; }

count=$((count + 4))
room 1000
! grep -q '^bands' out || failed "two lamps alike: $(grep '^bands' out)"
light | awk '{ sum += $1 } END { exit !(NR == 3 && sum > 0.999 && sum < 1.001) }' || failed "bands of json: $(light)"
room 0.02
grep -q '^bands     of band 2, .* of the reflected light, particles know .*links say$' out || failed "a weak band: $(tail -n 3 out)"
grep -c '^bands' out | grep -qx 1 || failed "other bands: $(grep '^bands' out)"
finish bands
