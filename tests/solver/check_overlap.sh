#!/bin/sh
# check_overlap.sh - faces that overlap in a plane would make power: it is told what lies on what, each place counts once, and
# a lamp on a ceiling shines. A gain that is left is told even with -q. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
solve() { # SCENE [OPTIONS]: power emitted and absorbed to the file `out`
    count=$((count + 1)) scene=$1
    shift
    "$radiosity" solve "$scene" --no-correct --no-errors --oracle ff --set limit=0.02 --json json "$@" >/dev/null 2>err || return 1
    sed -n 's/.*"power_\(emitted\|absorbed\)": \([0-9.e+-]*\),.*/\2/p' json | tr '\n' ' ' >out
}

printf 'newmtl w\nKd .3\nnewmtl w_2s\nKd .3\nnewmtl l\nKd .3\nKe 10\n' >box.mtl
cat >room.obj <<'END'
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
v 0.5 0.7 1
v 1.5 0.7 1
v 1.5 1.4 1
v 0.5 1.4 1
usemtl w
f 1 2 3 4
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
END
cp room.obj box.obj
printf 'usemtl l\nf 5 8 7 6\n' >>box.obj
solve box.obj -q && [ ! -s err ] || failed "the box alone"
read -r emitted absorbed <out

# the floor covered again, by the same material, two-sided, and laid twice
for what in 'w\nf 9 10 11 12' 'w_2s\nf 12 11 10 9' 'w\nf 2 3 4 1' 'w\nf 1 2 3\nf 3 4 1\nf 9 10 11 12'; do
    cp box.obj over.obj
    # shellcheck disable=SC2059
    printf "usemtl $what\n" >>over.obj
    solve over.obj || failed "floor $what"
    read -r e a <out
    within "$emitted" "$e" 1e-9 && within "$absorbed" "$a" .001 || failed "floor $what: emitted $e, absorbed $a of $absorbed"
    told 'over.obj:27: warning: face 6 (line 27) lies on face 0 (line 19) in one plane'
    solve over.obj -q && [ ! -s err ] || failed "floor $what: not quiet"
done
"$radiosity" viewfactors over.obj -q -o factors.csv 2>err || failed "view factors"
check "view factors: faces keep their numbers, rows of the box sum to 1, those of covered faces to 0" \
    awk -F, '{ for (i = sum = 0; i < NF; i++) sum += $(i + 1); if (NF != 9 || (sum - (NR <= 6)) ^ 2 > 1e-6) exit bad = 1 }
        END { exit bad || NR != 9 }' factors.csv

# a lamp in the ceiling's plane, before and behind it in the file, and one in two
for what in 'usemtl w\nf 5 8 7 6\nusemtl l\nf 16 15 14 13' 'usemtl l\nf 16 15 14 13\nusemtl w\nf 5 8 7 6' \
    'usemtl w\nf 5 8 7 6\nusemtl l\nf 16 15 14\nf 16 14 13\nf 16 15 14 13'; do
    cp room.obj lamp.obj
    # shellcheck disable=SC2059
    printf "$what\n" >>lamp.obj
    solve lamp.obj || failed "lamp $what"
    read -r e a <out
    within 7 "$e" 1e-6 && within 7 "$a" .02 || failed "lamp $what: emitted $e, absorbed $a"
    told 'lies on face'
done

# what is no overlap: a wall of two faces in the middle, lamps on both sides; also one that is cut otherwise behind than before,
# and one with two sides and a picture on it. A ray meets either face first, by rounding: it must meet the one it comes to
cat >middle.obj <<'END'
mtllib box.mtl
v 0 0 0
v 4 0 0
v 4 2 0
v 0 2 0
v 0 0 1
v 4 0 1
v 4 2 1
v 0 2 1
v 2 0 0
v 2 .7 0
v 2 2 0
v 2 2 1
v 2 .7 1
v 2 0 1
v 2 .3 .2
v 2 .3 .8
v 2 1.7 .8
v 2 1.7 .2
usemtl w
f 1 2 3 4
f 5 8 7 6
f 1 5 6 2
f 4 3 7 8
usemtl l
f 1 4 8 5
f 2 6 7 3
END
for what in 'w\nf 9 14 12 11\nf 9 11 12 14' 'w\nf 9 14 12 11\nf 9 10 13 14\nf 10 11 12 13' \
    'w\nf 15 16 17 18\nusemtl w_2s\nf 9 14 12 11'; do
    cp middle.obj wall.obj
    # shellcheck disable=SC2059
    printf "usemtl $what\n" >>wall.obj
    count=$((count + 1))
    "$radiosity" solve wall.obj -q --no-errors --json json 2>err && [ ! -s err ] || failed "a thin wall, $what"
    sed -n 's/.*"power_absorbed": \([0-9.e+-]*\),.*/\1/p' json >out
    read -r a <out
    within 40 "$a" .001 || failed "a thin wall, $what: absorbed $a of 40"
done

count=$((count + 1))
"$radiosity" solve "$scenes/td.obj" -q --no-correct --no-errors --oracle ff --set limit=100 2>err
told 'td.obj: warning: .*more is absorbed than emitted'
finish overlap
