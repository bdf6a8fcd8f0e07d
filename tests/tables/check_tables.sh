#!/bin/sh
# check_tables.sh - make tables: each marker has a generator and each generator a marker; a generator that fails leaves the
# file as it was; nothing but what stands between the markers changes. And cell_error against light that is known.
# Once is enough: it is about scripts, and arithmetic on their rows.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../solver/lib.sh"
build=$(dirname "$(dirname "$radiosity")")
quietly=into_files

# ---- the files and the generators beside this one
for file in README.md examples/measured_error.md examples/viewfactors.md examples/oracles/README.md examples/clustering.md; do
    sed -n 's/^<!-- table \([a-z_]*\): begin.*/\1/p' "$top/$file"
done | sort >marked
find "$top/tests/tables" -name 'table_*.sh' | sed 's,.*/table_\(.*\)\.sh,\1,' | sort >made
check "there are tables" sh -c '[ "$(wc -l <marked)" -gt 8 ]'
check "each marker has a generator, and each generator one marker" diff marked made

# ---- what a page links to is there
(cd "$top" && find README.md ARCHITECTURE.md examples -name '*.md' | while read -r page; do
    grep -o '](\([^)#]*\)' "$page" | sed 's/^](//; /^$/d; /^http/d' | while read -r to; do
        [ -e "$(dirname "$page")/$to" ] || echo "$page: $to"
    done
done) >dangling
check "links lead to files" sh -c '! grep . dangling'
# A heading's anchor: small letters, blanks as hyphens, of other signs hyphens alone.
(cd "$top" && find README.md ARCHITECTURE.md examples -name '*.md' | while read -r page; do
    grep -o '](\([^):]*\)#[^)]*' "$page" | sed 's/^](//' | while IFS='#' read -r to anchor; do
        if [ -n "$to" ]; then to=$(dirname "$page")/$to; else to=$page; fi
        sed -n 's/^##* //p' "$to" | tr A-Z a-z | sed 's/[^a-z0-9 _-]//g; s/ /-/g' | grep -qx -- "$anchor" || echo "$page: $to#$anchor"
    done
done) >dangling
check "and to headings" sh -c '! grep . dangling'

# ---- the machine, on files of its own
mkdir makers
export TABLE_FILES="a.md b.md" TABLE_MAKERS="$tmp/makers"
make_tables() { sh "$top/tests/tables/make.sh" "$build" "$@"; }
says() { # STATUS TEXT NAME...
    wanted=$1 text=$2
    shift 2
    make_tables "$@" >said 2>&1
    [ $? = "$wanted" ] && grep -qF -- "$text" said || { cat said && false; }
}
begin='<!-- table one: begin (made by make tables) -->' end='<!-- table one: end -->'
two='<!-- table two: begin (made by make tables) -->' two_end='<!-- table two: end -->'
printf 'before \\1 & $x\n%s\nold\n%s\nbetween\n%s\nold\n%s\nafter' "$begin" "$end" "$two" "$two_end" >a.md
printf 'nothing\n' >b.md
cp a.md a.old && cp b.md b.old
printf 'echo "| 1 & \\\\\\\\1 |"\n' >makers/table_one.sh
printf 'echo half; exit 1\n' >makers/table_two.sh
check "a table is made, another fails: exit 1" says 1 "table two was not made (exit status 1)"
printf 'before \\1 & $x\n%s\n\n| 1 & \\1 |\n\n%s\nbetween\n%s\nold\n%s\nafter\n' "$begin" "$end" "$two" "$two_end" >wanted
check "what stands between its markers changed, and nothing else" diff wanted a.md
check "a file without tables stays" diff b.old b.md
cp a.md a.old
for fault in 'exit 1' 'exit 3' 'echo half; exit 1' 'echo half; kill -9 $$' ':' 'echo half; nosuchcommand || exit'; do
    echo "$fault" >makers/table_two.sh
    check "a generator that does '$fault' fails" says 1 "a.md is as it was" two
    check "a generator that does '$fault' leaves the file" diff a.old a.md
done
echo 'echo half; exit 77' >makers/table_two.sh
check "a generator that lacks something is no failure" says 0 "left as it was" two
check "and leaves the file" diff a.old a.md
check "a second run makes the same" says 0 "table one" one
check "the same to the byte" diff a.old a.md
check "a name that no table has" says 1 "no table is called three; there are: one two" three
rm makers/table_two.sh
check "a marker without a generator" says 1 "there is no $tmp/makers/table_two.sh"
for line in "$two_end" "$begin" '<!-- table Two: begin (made by make tables) -->'; do
    { cat a.old && echo "$line"; } >a.md
    cp a.md a.bad
    check "markers in disorder: $line" says 1 "error: " one
    check "markers in disorder leave the file" diff a.bad a.md
done
check "no file of its own is left" sh -c '[ -z "$(find . -name ".?*" -type f)" ]'

# ---- cell_error, where the light is known: in the furnace B is 2 everywhere, 1 of it reflected
furnace=$top/examples/scenes/furnace.obj cell_error=$build/bin/cell_error
value() { awk -v name="$1" '$1 == name { print $2 }' errors; }
near() { # NAME VALUE WITHIN
    awk -v a="$(value "$1")" -v b="$2" -v within="$3" 'BEGIN { d = a - b; exit !(a != "" && d < within && -d < within) }' || {
        echo "$1 is $(value "$1"), not $2" && false
    }
}
check "furnace is cut" "$cell_error" cut "$furnace" cut 1e-3
cells=$(grep -c '^f' cut.obj)
check "into cells of the size asked for" sh -c "[ $cells = \$((6 * 13 * 13)) ]"
check "furnace is solved" "$radiosity" solve "$furnace" --no-correct --no-errors -q --faces faces.csv -o mesh.ply
# Of face 0 the reference has 2.2, of one cell in two of face 1 2.2 and of the others 1.8.
awk -v cells="$cells" 'BEGIN {
    n = cells / 6
    print "face,area,B_0,se_0"
    for (i = 0; i < cells; i++) {
        b = i < n ? 2.2 : i < 2 * n - 1 ? (i % 2 ? 2.2 : 1.8) : 2
        printf "%d,%.12g,%g,%g\n", i, 6 / cells, b, 0.01
    }
}' >ref.csv
check "compared" sh -c "'$cell_error' compare '$furnace' ref.csv faces.csv mesh.ply 1e-3 >errors"
# reflected: 6.2 W; links alone are good to a thousandth here
check "faces" near l1_faces "$(echo 0.2 6.2 | awk '{ print $1 / $2 }')" 3e-3
check "cells" near l1_cells "$(echo 0.4 6.2 | awk '{ print $1 / $2 }')" 3e-3
check "power" near power "$(echo -0.2 6.2 | awk '{ print $1 / $2 }')" 3e-3
check "worst" near worst "$(echo 0.2 1.2 | awk '{ print $1 / $2 }')" 3e-3
check "worst face" near worst_face 0 .5
check "noise of cells" near noise_cells "$(awk 'BEGIN { print 6 * .01 * sqrt(2 / 3.14159265) / 6.2 }')" 1e-4
check "noise of faces" near noise_faces "$(awk 'BEGIN { print 6 * .01 / 13 * sqrt(2 / 3.14159265) / 6.2 }')" 1e-4
check "no place without a leaf" near missed 0 1e-9
check "the reference, by faces" sh -c "'$cell_error' faces '$furnace' ref.csv 1e-3 >by_face && [ \$(wc -l <by_face) = 7 ] && grep -q '^0,1,2.2,' by_face"

# A face that is one cell has the light that the table of faces says, whatever points of the mesh do.
awk 'BEGIN { print "face,area,B_0,se_0"; for (i = 0; i < 6; i++) print i ",1,2,0.01" }' >ref_whole.csv
awk -F , -v OFS=, 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "B_0") at = i } NR == 2 { $at += 0.2 } { print }' faces.csv >whole.csv
check "compared, by whole faces" sh -c "'$cell_error' compare '$furnace' ref_whole.csv whole.csv mesh.ply 1 >errors"
check "cells of whole faces" near l1_cells "$(echo 0.2 6 | awk '{ print $1 / $2 }')" 3e-3

# Cells of quads and triangles tile them.
check "cornell is cut" "$cell_error" cut "$top/examples/scenes/cornell.obj" cornell 1e-3
area() { # of an OBJ file, by the diagonals of quads and the edges of triangles
    awk '/^v/ { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
         /^f/ {
             for (i = 2; i <= NF; i++) k[i] = $i < 0 ? n + 1 + $i : $i
             if (NF < 5) k[5] = k[2]
             a = x[k[4]] - x[k[2]]; b = y[k[4]] - y[k[2]]; c = z[k[4]] - z[k[2]]
             d = x[k[5]] - x[k[3]]; e = y[k[5]] - y[k[3]]; f = z[k[5]] - z[k[3]]
             sum += sqrt((b * f - c * e) ^ 2 + (c * d - a * f) ^ 2 + (a * e - b * d) ^ 2) / 2
         } END { printf "%.6f\n", sum }' "$1"
}
check "cornell's cells have its area" [ "$(area "$top/examples/scenes/cornell.obj")" = "$(area cornell.obj)" ]

# A window's wall is four trapezoids, whose boxes overlap: each leaf keeps to its own place all the same.
check "room is cut" "$cell_error" cut "$top/examples/scenes/room.obj" room 1e-3
awk 'BEGIN { print "face,area,B_0,B_1,B_2,se_0,se_1,se_2" } /^f/ { print n++ ",1,1,1,1,0,0,0" }' room.obj >room_ref.csv
room() { # ORACLE
    "$radiosity" solve "$top/examples/scenes/room.obj" --oracle "$1" --no-correct --no-errors -q --faces room.csv -o room.ply &&
        "$cell_error" compare "$top/examples/scenes/room.obj" room_ref.csv room.csv room.ply 1e-3 >errors && near missed 0 1e-9
}
check "no place of room is without a leaf" room ff
refuses() { ! "$cell_error" "$@" 2>err && [ "$(wc -l <err)" = 1 ] && grep -q error: err; }
check "a reference of other cells is refused" refuses compare "$furnace" ref.csv faces.csv mesh.ply 1e-4
head -c $(($(wc -c <mesh.ply) / 2)) mesh.ply >short.ply
check "a mesh that was cut short is refused" refuses compare "$furnace" ref.csv faces.csv short.ply 1e-3
check "a table for a mesh is refused" refuses compare "$furnace" ref.csv faces.csv faces.csv 1e-3
finish tables
