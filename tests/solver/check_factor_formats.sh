#!/bin/sh
# check_factor_formats.sh - a matrix of view factors is the same in every format, read by the rules of the format
# (factor_formats.py); rows of groups, objects and materials are sums over faces, with the names of the file. RADIOSITY
# names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
python=
for p in /usr/bin/python3 python3; do # one that has SciPy, where there is one
    command -v $p >/dev/null || continue
    python=${python:-$p}
    $p -c 'import scipy.sparse' 2>/dev/null && python=$p && break
done
[ -n "$python" ] || echo "skipped: python3 is not installed, formats of view factors are not read"
agrees() { # WHAT ARGUMENTS...: of factor_formats.py
    what=$1
    shift
    [ -n "$python" ] || return 0
    count=$((count + 1))
    "$python" "$top/tests/solver/factor_formats.py" "$@" >out 2>err && [ ! -s out ] || failed "$what"
}
factors() { # FILE OPTIONS...: of the scene
    count=$((count + 1))
    file=$1
    shift
    "$radiosity" viewfactors "$scene" -q -o "$file" "$@" >out 2>err || failed "viewfactors $scene $file $*"
}
refuses() { # WORDS ARGUMENTS...: exit status 1, these words, nothing written
    count=$((count + 1)) words=$1
    shift
    "$radiosity" viewfactors "$@" -o never >out 2>err
    [ $? = 1 ] && grep -q -e "$words" err && [ ! -e never ] || failed "no '$words' of $*"
}
with_room() { # f.csv OPTIONS...: the formats that have room for more columns
    factors "$@" --names f.names
    shift
    factors f.coo --format coo --names f.names.csv "$@"
    factors f.mtx "$@"
    factors f.npz "$@"
}
written() { # OPTIONS...: the scene's matrix in all formats
    mkdir -p foam
    with_room f.csv "$@"
    factors f.idf "$@"
    factors f.view3d --format view3d "$@"
    factors foam/F --format openfoam "$@"
}

# A room of 2 x 2 x 1 with a two-sided screen in it, which hides nothing from itself.
printf 'newmtl a wall\nKd .3 .3 .3\nnewmtl floor\nKd .6 .5 .4\nnewmtl screen_2s\nKd .5 .5 .5\nnewmtl unused\n' >room.mtl
cat >room.obj <<'END'
mtllib room.mtl
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 1
v 2 0 1
v 2 2 1
v 0 2 1
v 1 0.5 0.2
v 1 1.5 0.2
v 1 1.5 0.8
v 1 0.5 0.8
usemtl a wall
f 1 5 6 2
o the shell
g north, east
f 2 6 7 3
usemtl floor
f 1 2 3 4
usemtl a wall
g "rest"
f 3 7 8 4
f 4 8 5 1
g north, east
f 5 8 7 6
o screen
usemtl screen_2s
g none
g a;screen!
f 9 10 11 12
END
scene=room.obj
written
agrees "formats of faces" equal
cat >group.parts <<'END'
default
north, east
north, east
"rest"
"rest"
north, east
a;screen!
END
sed 's/"rest"\|north, east/the shell/; s/a;screen!/screen/' group.parts >object.parts
printf 'a wall\na wall\nfloor\na wall\na wall\na wall\nscreen_2s\n' >material.parts
for what in group object material; do
    factors $what.csv --by $what --names $what.names.csv
    agrees "sums by $what" sums $what
done
count=$((count + 1))
printf 'row,name,area_m2\n0,default,2\n1,"north, east",10\n2,"""rest""",4\n3,a;screen!,1.2\n' | cmp -s - group.names.csv || failed "$(cat group.names.csv)"
written --by group
agrees "formats of groups" equal
count=$((count + 1))
grep -q '^  a_screen_,north_ east,' f.idf || failed "names in f.idf"
# A_G F_GH = A_H F_HG, with both sides of the screen, to rounding.
count=$((count + 1))
awk -F, 'FNR == NR { if (FNR > 1) area[FNR - 1] = $NF; next } { for (j = 1; j <= NF; j++) f[FNR, j] = area[FNR] * $j; n = NF }
         END { for (i = 1; i <= n; i++) for (j = 1; j < i; j++) { d = f[i, j] - f[j, i]; if (d > 1e-10 || d < -1e-10) exit 1 } exit n != 4 }' \
    group.names.csv group.csv || failed "groups' exchange areas differ both ways"
# Rows of parts do not depend on threads, nor do archives.
for threads in 1 5; do
    factors $threads.npz --by group --threads $threads
    factors $threads.idf --by object --threads $threads
done
count=$((count + 1))
cmp -s 1.npz 5.npz && cmp -s 1.idf 5.idf || failed "more threads, other bytes"

# ---- without the ceiling and with a screen that has a black back: what goes to the sky, and what to that
sed '/^f 5 8 7 6/d; s/_2s/_1s/; s/mtllib.*/mtllib open.mtl/' room.obj >open.obj
sed 's/_2s/_1s/' room.mtl >open.mtl
scene=open.obj
for by in face object; do
    with_room f.csv --sky --by $by
    agrees "sky and backs by $by" sky
done
for format in view3d energyplus openfoam; do
    count=$((count + 1))
    "$radiosity" viewfactors $scene -q --sky --format $format -o never 2>err
    [ $? = 2 ] && grep -q 'sky adds columns' err && [ ! -e never ] || failed "--sky of $format"
done
# View3D's header says whether all rows close: not where they end on a black back, nor under the sky.
sed 's/_2s/_1s/; s/mtllib.*/mtllib open.mtl/' room.obj >screen.obj
for name in room screen open; do
    scene=$name.obj
    factors $name.view3d --format view3d
    count=$((count + 1))
    closed=$(awk 'NR == 1 { print $4 }' $name.view3d)
    [ "$closed" = $([ $name = room ] && echo 1 || echo 0) ] || failed "closed is $closed of $name.obj"
done

# ---- what other formats of scenes call parts
cat >two.stl <<'END'
solid lower plate
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 1 0 0
vertex 1 1 0
vertex 0 1 0
endloop
endfacet
endsolid
solid upper
facet normal 0 0 -1
outer loop
vertex 0 0 1
vertex 0 1 1
vertex 1 0 1
endloop
endfacet
facet normal 0 0 -1
outer loop
vertex 1 0 1
vertex 0 1 1
vertex 1 1 1
endloop
endfacet
endsolid upper
END
scene=two.stl
written
printf 'lower plate\nlower plate\nupper\nupper\n' >object.parts
factors object.csv --by object --names object.names.csv
agrees "sums of solids" sums object
count=$((count + 1)) # two unit squares at a distance of 1: .1998248957
awk -F, 'NR == 1 { good = $1 == 0 && $2 > 0.19982 && $2 < 0.19983 } END { exit !good }' object.csv || failed "$(cat object.csv)"
cat >nodes.gltf <<'END'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"name": "below", "mesh": 0}, {"name": "above, turned", "mesh": 0, "rotation": [1, 0, 0, 0], "translation": [0, 1, 1]}],
 "meshes": [{"name": "plate", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
  {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}],
 "buffers": [{"byteLength": 60, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAABAAIAAAACAAMA"}]}
END
scene=nodes.gltf
factors nodes.csv --by object --names nodes.names
factors mesh.csv --by group --names mesh.names
count=$((count + 1))
printf 'below\nabove, turned\n' | cmp -s - nodes.names || failed "$(cat nodes.names)"
count=$((count + 1))
[ "$(cat mesh.names)" = plate ] || failed "$(cat mesh.names)"
count=$((count + 1))
awk -F, 'NR == 2 { good = $2 == 0 && $1 > 0.19982 && $1 < 0.19983 } END { exit !good }' nodes.csv || failed "$(cat nodes.csv)"

# ---- what cannot be done
refuses "names no groups; give --by material" "$top/tests/solver/formats/text.ply" --by group
sed '/^g /d' room.obj >objects.obj
refuses "names no groups; give --by object" objects.obj --by group
sed 's/^o screen/o The Shell/' room.obj >capitals.obj
refuses "two rows would be called 'The Shell'\|two rows would be called 'the shell'" capitals.obj --by object --format energyplus
count=$((count + 1))
"$radiosity" viewfactors room.obj -q -o never --names never --format openfoam 2>err
[ $? = 2 ] || failed "openfoam: -o and --names are one file"
mkdir -p foam2
echo mine >foam2/globalFaceFaces
count=$((count + 1))
"$radiosity" viewfactors room.obj -q -o foam2/F --format openfoam 2>err
[ $? = 2 ] && [ "$(cat foam2/globalFaceFaces)" = mine ] && [ ! -e foam2/F ] || failed "foam2/globalFaceFaces is lost"
rm foam2/globalFaceFaces
echo mine >foam2/mapDist
count=$((count + 1))
"$radiosity" viewfactors room.obj -q -o foam2/F --format openfoam 2>err
[ $? = 2 ] && [ "$(cat foam2/mapDist)" = mine ] && [ ! -e foam2/F ] && [ ! -e foam2/globalFaceFaces ] || failed "foam2/mapDist is lost"
count=$((count + 1))
"$radiosity" viewfactors room.obj -q -o /dev/null --format npz 2>err
[ $? = 1 ] && grep -q 'cannot go to a pipe or a device' err || failed "an archive to a device"

finish check_factor_formats
