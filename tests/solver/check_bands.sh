#!/bin/sh
# check_bands.sh - a band with so few of the watts that particles do not know it: `radiosity solve` says so, and only then.
# RADIOSITY names the command.
# Once is enough: it is about numbers.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# A room of 1 m with a red lamp and a blue one below its ceiling; BLUE: what the blue one emits (W/m2), the red one 1000
room() {
    printf 'newmtl wall\nKd .5 .5 .5\nnewmtl red\nKd 0 0 0\nKe 1000 0 0\nnewmtl blue\nKd 0 0 0\nKe 0 0 %s\n' "$1" >room.mtl
    "$radiosity" solve room.obj --json json >out 2>err || failed "solve with blue $1: $(tail -n 1 err)"
}
cat >room.awk <<'END'
function lamp(material, x) {
    print "usemtl", material
    print "f", corner(x, .4, .9), corner(x, .6, .9), corner(x + .2, .6, .9), corner(x + .2, .4, .9)
}
BEGIN { print "mtllib room.mtl\nusemtl wall"; box(0, 0, 0, 1, 1, 1, 1); lamp("red", .2); lamp("blue", .6) }
END
awk -f "$top/tests/solver/box.awk" -f room.awk >room.obj
light() { awk -f "$top/tests/tables/json.awk" json | awk '$1 ~ /^correction\.bands.*light/ { print $2 }'; }

count=$((count + 4))
room 1000
! grep -q '^bands' out || failed "two lamps alike: $(grep '^bands' out)"
light | awk '{ sum += $1 } END { exit !(NR == 3 && sum > 0.999 && sum < 1.001) }' || failed "bands of json: $(light)"
room 0.02
grep -q '^bands     of band 2, .* of the reflected light, particles know .*links say$' out || failed "a weak band: $(tail -n 3 out)"
grep -c '^bands' out | grep -qx 1 || failed "other bands: $(grep '^bands' out)"
finish bands
