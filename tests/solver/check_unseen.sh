#!/bin/sh
# check_unseen.sh - a lamp before a pinhole: `radiosity solve` says that nothing is known of what is reflected, never that nothing is.
# RADIOSITY names the command.
# Once is enough: it is about what is said.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# A room of 2 m with a hole of .1 mm in a wall, and 3.9 m before that a lamp of .04 m2. (At some distances, as at 4 m, one of 1.2e7
# particles gets in after all, where two faces meet in an edge. Which, is chance.)
printf 'newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1000 1000 1000\n' >room.mtl
cat >room.awk <<'END2'
function wall(x0, x1, z0, z1) { print "f", corner(x0, 0, z0), corner(x0, 0, z1), corner(x1, 0, z1), corner(x1, 0, z0) }
BEGIN {
    print "mtllib room.mtl\nusemtl lamp"
    print "f", corner(.9, -3.9, .9), corner(.9, -3.9, 1.1), corner(1.1, -3.9, 1.1), corner(1.1, -3.9, .9)
    print "usemtl wall"
    print "f", corner(0, 0, 0), corner(2, 0, 0), corner(2, 2, 0), corner(0, 2, 0)
    print "f", corner(0, 0, 2), corner(0, 2, 2), corner(2, 2, 2), corner(2, 0, 2)
    print "f", corner(0, 0, 0), corner(0, 2, 0), corner(0, 2, 2), corner(0, 0, 2)
    print "f", corner(2, 0, 0), corner(2, 0, 2), corner(2, 2, 2), corner(2, 2, 0)
    print "f", corner(0, 2, 0), corner(2, 2, 0), corner(2, 2, 2), corner(0, 2, 2)
    wall(0, .99995, 0, 2); wall(1.00005, 2, 0, 2); wall(.99995, 1.00005, 0, .99995); wall(.99995, 1.00005, 1.00005, 2)
}
END2
awk -f "$top/tests/solver/box.awk" -f room.awk >room.obj

count=$((count + 14))
"$radiosity" solve room.obj --json json >out 2>err || failed "solve: $(tail -n 1 err)"
grep -q '^error     not known: none of .* particles was reflected; less than about .* W is$' out || failed "summary: $(grep '^error' out)"
grep -q 'warning: none of .* nothing is known but that' err || failed "warning: $(cat err)"
grep -q '^dim .* too dim for their light to be known to 5 %: faces 1, 2, 3, 4, 5, 6, 7$' out || failed "dim: $(tail -n 3 out)"
[ "$(sed -n '/"error": {/,/}/p' json | grep -c '"\(l1_faces\|power\)": null')" = 2 ] || failed "json: $(grep '"l1_faces"' json)"
"$radiosity" solve room.obj --accuracy 1% >out 2>err
status=$?
{ [ $status = 3 ] && grep -q '^accuracy .*NOT kept' out; } || failed "accuracy: $status, $(tail -n 2 out)"
"$radiosity" solve room.obj --accuracy l2:1% >out 2>err
status=$?
{ [ $status = 3 ] && grep -q '^accuracy .*NOT kept' out; } || failed "accuracy over the surfaces: $status, $(tail -n 2 out)"
"$radiosity" reference room.obj --accuracy 1% -o r.csv --json json >out 2>err
status=$?
{ [ $status = 3 ] && grep -q '^none of .* particles and .* paths tells of light' out; } || failed "reference: $status, $(tail -n 1 out)"
{ [ "$(grep -c '"\(particles\|paths\|both\)": null' json)" = 3 ] && grep -q '"unseen": [0-9.]*e-' json; } || failed "reference, json: $(grep unseen json)"
{ [ -s r.csv ] && [ -s r.csv.state ]; } || failed "reference: what it took is lost"
# a lamp that looks away is not what chance has hidden
sed 's/^f 1 2 3 4$/f 4 3 2 1/' room.obj >away.obj
"$radiosity" solve away.obj >out 2>err
grep -q '^error     none: no light is reflected, as no lamp and no face that reflects its light look at each other$' out || failed "a lamp turned away: $(grep '^error' out)"
grep -q 'warning: no light meets the front of a face: if faces are turned the wrong way, turn them' err || failed "a lamp turned away, warning: $(cat err)"
# nor are walls of another colour than the lamp
sed '/^Kd [.]5/s/.*/Kd 0 .5 .5/; /^Ke/s/.*/Ke 1000 0 0/' room.mtl >other.mtl
sed 's/room[.]mtl/other.mtl/' room.obj >other.obj
"$radiosity" solve other.obj >out 2>err
grep -q '^error     none: no light is reflected' out || failed "walls of another colour: $(grep '^error' out)"
! grep -q 'no light meets' err || failed "walls of another colour, warning: $(cat err)"
finish unseen
