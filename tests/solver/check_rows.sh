#!/bin/sh
# check_rows.sh - rows of view factors tell the truth: where the light goes that they lack, which faces look turned, and the
# same numbers wherever the scene is and however large. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
factors() { # SCENE [OPTIONS]: the matrix to m.csv, what is said to out and err, figures to json
    count=$((count + 1))
    "$radiosity" viewfactors "$@" -o m.csv --json json >out 2>err || failed "viewfactors $*"
}
silent() { ! grep -q "$1" err || failed "told: $1"; }
figure() { # NAME WANTED OFF
    sed -n "s/.*\"$1\": \([0-9.e+-]*\)[,}]*.*/\1/p" json >figure
    awk -v wanted="$2" -v off="$3" '{ bad = ($1 - wanted) ^ 2 > off ^ 2 } END { exit NR != 1 || bad }' figure ||
        failed "$1: $(cat figure), not $2"
}
differ() { # A.csv B.csv MOST: no two entries by more than that
    paste -d, "$1" "$2" | awk -F, -v most="$3" '{ for (i = 1; i <= NF / 2; i++) {
            d = $i - $(i + NF / 2); if (d * d > most * most) exit bad = 1 } }
        END { exit bad || NR < 6 }' || failed "$1 and $2 differ by more than $3: $4"
}

cat >cube.obj <<'END'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
# faces
f 1 2 3 4
f 5 8 7 6
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 8 5 1 4
END
sed 's/^f 2 6 7 3/f 3 7 6 2/' cube.obj >turned.obj
factors cube.obj
silent 'looks turned'
figure to_backs_mean 0 0
cp m.csv cube.csv
{ echo "mtllib white.mtl"; sed "s/^# faces/usemtl white/" cube.obj; } >white.obj
printf 'newmtl white\nKd 1 1 1\n' >white.mtl
factors white.obj # what reflects all has view factors, though no solution
differ m.csv cube.csv 0 "what it reflects"
"$radiosity" solve white.obj -q >out 2>err
[ $? = 1 ] && grep -q "white.mtl:2: error: material 'white' has reflectance 1" err || failed "all is reflected"
sed 's/Kd 1 1 1/Kd 1 1 1.1/' white.mtl >more.mtl
sed 's/white.mtl/more.mtl/' white.obj >more.obj
"$radiosity" viewfactors more.obj -q >out 2>err
[ $? = 1 ] && grep -q "more.mtl:2: error: material 'white' has reflectance 1.1" err || failed "more than all is reflected"
{ sed "/^f/d" cube.obj; echo "v 2 0 0"; printf "f %s\n" "1 2 9" "1 2 3 4" "5 8 7 6"; } >flat.obj # no area, so no side
factors flat.obj
told '1 degenerate faces dropped'
silent 'looks turned'
factors turned.obj
told 'turned.obj:13: warning: looks turned, with its back to the light: face 3 (line 13) (of closed shells: --flip-closed'
grep -q '^to backs  16.67 % of what all faces send; up to 20.00 % of one of 5 rows' out || failed "backs are not told"
figure to_sky_mean .1666667 1e-6
figure to_backs_mean .1666667 1e-6
figure rows_to_sky 1 0
figure rows_to_backs 5 0
factors turned.obj --flip-closed
told 'turned by --flip-closed: face 3 (line 13)'
differ m.csv cube.csv 1e-12 "a cube turned back"
factors turned.obj -q --flip-closed
[ ! -s err ] || failed "not quiet"

# a room with a box in it, which hides much
sed '/^#/,$d' cube.obj | awk '{ print $1, 4 * $2, 5 * $3, 3 * $4; b[NR] = "v " 1.2 + 1.7 * $2 " " 1.1 + 1.2 * $3 " " .4 + 1.3 * $4 }
    END { for (i = 1; i <= NR; i++) print b[i] }' >room.obj
sed -n '/^#/,$p' cube.obj >>room.obj
awk '$1 == "f" { print "f", $5 + 8, $4 + 8, $3 + 8, $2 + 8 }' cube.obj >>room.obj
move() { # SCENE SCALE BY FORM: with numbers of that form
    awk -v m="$2" -v by="$3" -v form="$4" '$1 == "v" {
        printf "v " form " " form " " form "\n", $2 * m + by, $3 * m + by, $4 * m + by; next } { print }' "$1" >moved.obj
}
for scene in cube room; do
    factors "$scene.obj" -q
    cp m.csv "$scene.csv"
    for place in '1 1e7' '1e-6 0' '1e6 0' '1e6 1e7' '1 5e6'; do
        # shellcheck disable=SC2086
        move "$scene.obj" $place %.17g
        factors moved.obj -q
        differ m.csv "$scene.csv" 1e-6 "$scene x m + by: $place"
    done
done

# formats that keep floats, as a rule: a text may say more, and what has lost all is refused
as_ply() { # FILE.obj
    awk '$1 == "v" { v[n++] = $2 " " $3 " " $4 } $1 == "f" { f[m++] = "4 " $2 - 1 " " $3 - 1 " " $4 - 1 " " $5 - 1 }
        END { print "ply\nformat ascii 1.0\nelement vertex " n "\nproperty float x\nproperty float y\nproperty float z"
            print "element face " m "\nproperty list uchar int vertex_indices\nend_header"
            for (i = 0; i < n; i++) print v[i]
            for (i = 0; i < m; i++) print f[i] }' "$1"
}
as_stl() {
    echo solid x
    awk 'function corner(i) { print "vertex " v[$i] }
        $1 == "v" { v[++n] = $2 " " $3 " " $4 }
        $1 == "f" { for (k = 3; k < 5; k++) { print "facet normal 0 0 0\nouter loop"; corner(2); corner(k); corner(k + 1)
            print "endloop\nendfacet" } }' "$1"
    echo endsolid x
}
awk '{ print } END { for (i = 0; i < 40; i++) { x = .05 + i / 15
        print "v", x, 1, .1 "\nv", x + .05, 1, .1 "\nv", x + .05, 1.05, .1 "\nv", x, 1.05, .1
        k = 16 + 4 * i; print "f", k + 1, k + 2, k + 3, k + 4 } }' room.obj >small.obj
for format in ply stl; do
    off=1e-6
    [ $format = ply ] || off=2e-4 # the halves of a wall have a shadow each, which is but as exact
    as_$format room.obj >near.$format
    factors near.$format -q
    cp m.csv near.csv
    move room.obj 1 5000000 %.3f
    as_$format moved.obj >moved.$format
    factors moved.$format
    silent 'degenerate'
    silent 'coordinates are floats'
    differ m.csv near.csv "$off" "$format, moved"
    move small.obj 1 5000000 %.0f
    as_$format moved.obj >moved.$format
    count=$((count + 1))
    "$radiosity" viewfactors moved.$format -o lost.csv >out 2>err && failed "$format of which floats leave little is taken"
    [ ! -e lost.csv ] || failed "$format: a matrix of what is left"
    told 'error: [0-9]* of [0-9]* faces have no area left: coordinates are floats up to 5e+06 m, rounded to 0.6 m; move the scene'
done
# ---- columns: parted by commas from the first line on; a line too many is no line of names
yes '1,2' | head -n 6 >two
yes '1,2' | head -n 7 >seven
{ echo a,b && cat two; } >named
check "a product with columns parted by commas" "$radiosity" viewfactors cube.obj -q --product two -o y
check "each row of a cube sums to 1" awk -F '[, ]' '{ bad = bad || NF != 2 || ($1 - 1) ^ 2 + ($2 - 2) ^ 2 > 1e-12 } END { exit NR != 6 || bad }' y
check "a line of names" "$radiosity" viewfactors cube.obj -q --product named -o z
check "which is kept" sh -c '[ "$(head -n 1 z)" = a,b ] && tail -n 6 z | cmp - y'
count=$((count + 1))
"$radiosity" viewfactors cube.obj -q --product seven -o w >out 2>err
[ $? = 1 ] && grep -q "7 lines of numbers, but the scene has 6 faces" err && [ ! -e w ] || failed "a line too many"
for cells in 1,,2 1,2, ,1,2 '1, ,2' '1,2, # three' ,; do
    { head -n 3 two && echo "$cells" && head -n 2 two; } >holes
    count=$((count + 1))
    "$radiosity" viewfactors cube.obj -q --product holes -o w >out 2>err
    [ $? = 1 ] && grep -q "^holes:4: error: an empty cell; write a number" err && [ ! -e w ] || failed "cells '$cells'"
done
{ head -n 5 two && echo '1 , 2 # 1,,2'; } >spaced
check "blanks beside commas" "$radiosity" viewfactors cube.obj -q --product spaced -o w
check "the same product" cmp w y

# ---- columns and sensors are text: a name that says matrix is refused, and nothing is written
for name in y.npz y.mtx y.idf; do
    count=$((count + 1))
    "$radiosity" viewfactors cube.obj -q --product two -o $name >out 2>err
    [ $? = 2 ] && grep -q "error: --product writes a table as text, and the name $name says matrix" err && [ ! -e $name ] || failed "a product as $name"
done

# ---- what cannot be written is told before the work, not after it: nothing says what the scene lacks
count=$((count + 1))
"$radiosity" viewfactors none.obj -q --format npz -o /dev/null >out 2>err
[ $? = 1 ] && grep -q "^/dev/null: error: an archive cannot go to a pipe or a device" err || failed "an archive to a device"

finish rows
