#!/usr/bin/env bash
# viewfactors.sh - a matrix of view factors: seconds of the processor, memory and error against the number of faces, on four kinds
# of closed scenes (walls.awk, room_of_boxes.awk); View3D and OpenFOAM's viewFactorsGen beside `radiosity viewfactors`
# where they are installed.
#
# VIEW3D, VIEW_FACTORS_GEN: those programs, by default as PATH finds them; what is not there is passed over and said so. Each
# program writes its own format, in binary where it has one, and runs with its own tolerances, on one thread. Without them being
# asked to, none scales rows to 1. How long one takes from start to end on all threads is measured besides. "as View3D" is
# `radiosity` with the largest tolerance of EXCHANGE_TOLERANCE times a power of the root of two at which its mean error is no larger
# than View3D's: of entries, or where nobody knows these, of rows. LIMIT: seconds of the processor for one run (120); what takes longer is not tried larger.
# LARGEST: faces (13000). ENTRIES: faces up to which each entry is held against a finer matrix (400); against closed forms it is up
# to four times as many. PROGRAMS: of radiosity, View3D, as_View3D and OpenFOAM those that run now; all rows that are there are told of.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
LIMIT=${LIMIT:-120}
rows_open viewfactors scene,program,run,binary faces,tolerance,seconds,elapsed,memory_mb,row_mean,row_largest,entry_mean,entry_largest
of_program() { { command -v "$1" || true; } | xargs -r realpath; }
cost_of=$(realpath "$BUILD/bin/cost_of")
view3d=$(of_program "${VIEW3D:-View3D}")
foam=$(of_program "${VIEW_FACTORS_GEN:-viewFactorsGen}")
[ -n "$view3d" ] || say "View3D is not here (VIEW3D=FILE names it): it does not run"
[ -n "$foam" ] || say "viewFactorsGen is not here (VIEW_FACTORS_GEN=FILE names it): it does not run"
[ -z "$foam" ] || [ -n "${WM_PROJECT_DIR:-}" ] ||
    { foam='' && say "viewFactorsGen cannot run without OpenFOAM's environment (. etc/bashrc): its rows are left out"; }
checksum() { cksum <"$1" | cut -d ' ' -f 1; }

# ---- scenes

make_scene() { # SCENE SIZE: $tmp/scene.obj
    if [ "$1" = room_of_boxes ]; then
        awk -v FACES="$2" -v MATERIALS="$tmp/scene.mtl" -f "$studies/room_of_boxes.awk"
    else
        awk -v SCENE="$1" -v N="$2" -f "$studies/walls.awk"
    fi >"$tmp/scene.obj"
    faces=$(grep -c '^f' "$tmp/scene.obj")
    reference='' group=1
}
# What entries are held against: closed forms of squares, else a matrix of a hundredth of the tolerance.
find_reference() { # SCENE SIZE
    case $1 in
    cube_*)
        [ "$faces" -le $((4 * ${ENTRIES:-400})) ] || return 0
        reference=$results/cube_$2.coo
        [ "$1" = cube_quads ] || group=2
        [ -s "$reference" ] || awk -v N="$2" -f "$studies/cube_factors.awk" >"$tmp/reference"
        ;;
    *)
        [ "$faces" -le "${ENTRIES:-400}" ] || return 0
        reference=$results/$1_${2}_$binary.coo
        measure "$1,reference,$2,$binary" run_reference
        ;;
    esac
    [ -s "$reference" ] || mv "$tmp/reference" "$reference" 2>/dev/null || reference=''
}
run_reference() {
    cost "$radiosity" viewfactors "$tmp/scene.obj" -q --threads 1 --tolerance 3e-6 --format coo -o "$tmp/reference" || return
    echo "tolerance 3e-6"
    reference='' judge_matrix <"$tmp/reference"
}

# ---- programs

# Seconds and memory of a command, under the LIMIT.
cost() { # COMMAND...
    local status=0
    "$cost_of" "$tmp/cost" "$LIMIT" "$@" >"$tmp/cost.out" 2>&1 || status=$?
    [ $status = 0 ] || [ $status = 124 ] || tail -n 5 "$tmp/cost.out" >&2
    [ $status != 0 ] || { cat "$tmp/cost" && echo "faces $faces"; }
    return $status
}
judge_matrix() { # <MATRIX.coo
    awk -v ROWS="$faces" -v REFERENCE="$reference" -v GROUP=$group -f "$studies/factor_error.awk"
}

# The matrix that is measured is an archive; one as text, which tells the same, is read here.
run_radiosity() { # [TOLERANCE]
    local tolerance=${1:-$default_tolerance}
    cost "$radiosity" viewfactors "$tmp/scene.obj" -q --tolerance "$tolerance" -o "$tmp/factors.npz" >"$tmp/threads" || return
    cost "$radiosity" viewfactors "$tmp/scene.obj" -q --tolerance "$tolerance" --threads 1 --json "$tmp/json" -o "$tmp/factors.npz" >"$tmp/thread" || return
    cat "$tmp/thread" # of names that are told twice, the last counts
    grep '^elapsed' "$tmp/threads"
    echo "tolerance $tolerance"
    rm "$tmp/factors.npz"
    if [ -n "$reference" ]; then
        "$radiosity" viewfactors "$tmp/scene.obj" -q --tolerance "$tolerance" --format coo -o "$tmp/factors.coo"
        judge_matrix <"$tmp/factors.coo"
    else
        awk -f "$tables/json.awk" "$tmp/json" |
            awk '{ v[$1] = $2 } END { printf "row_mean %.3g\nrow_largest %.3g\n", v["row_defect_mean"], v["row_defect_largest"] }'
    fi
}
error_of() { # NAME VALUE lines: the mean error of entries, else of rows
    awk '{ v[$1] = $2 } END { print "entry_mean" in v && v["entry_mean"] != "-" ? v["entry_mean"] : v["row_mean"] }'
}
run_as_view3d() { # with what run() knows of View3D's row
    local aim times
    aim=$(for name in entry_mean row_mean; do echo "$name $(value_of "$view3d_key" $name)"; done | error_of)
    for times in 16 11.3 8 5.66 4 2.83 2 1.41 1 .707 .5 .354 .25 .177 .125; do
        run_radiosity "$(awk -v t="$times" -v default="$default_tolerance" 'BEGIN { printf "%g", t * default }')" >"$tmp/as_view3d" || return
        ! awk -v e="$(error_of <"$tmp/as_view3d")" -v aim="$aim" 'BEGIN { exit !(e <= aim) }' || break
    done
    cat "$tmp/as_view3d"
}
# 32 bytes, then floats: areas, rows, emissivities.
run_view3d() {
    awk -v AS=view3d -f "$studies/other_input.awk" "$tmp/scene.obj" >"$tmp/scene.vs3"
    (cd "$tmp" && cost "$view3d" scene.vs3 factors.bin) || return
    od -An -v -t f4 -w4 -j $((32 + 4 * faces)) -N $((4 * faces * faces)) "$tmp/factors.bin" |
        awk -v n="$faces" '$1 != 0 { printf "%d,%d,%s\n", int((NR - 1) / n), (NR - 1) % n, $1 }' | judge_matrix
}
run_openfoam() {
    mkdir -p "$tmp/case/0" "$tmp/case/system" "$tmp/case/constant/polyMesh"
    awk -v AS=openfoam -v CASE="$tmp/case" -f "$studies/other_input.awk" "$tmp/scene.obj"
    cost "$foam" -case "$tmp/case" || return
    for list in F globalFaceFaces; do awk -f "$studies/foam_lists.awk" "$tmp/case/constant/$list" >"$tmp/$list"; done
    paste -d '|' "$tmp/globalFaceFaces" "$tmp/F" | awk -F '|' '{
        n = split($1, at, " ")
        split($2, value, " ")
        for (k = 1; k <= n; k++) print NR - 1 "," at[k] "," value[k] }' | judge_matrix
    rm -r "$tmp/case"
}

default_tolerance=$(sed -n 's/^#define EXCHANGE_TOLERANCE //p' runtime/kernel/constants.h)
declare -A late
run() { # SCENE SIZE PROGRAM CHECKSUM FUNCTION
    local key="$1,$3,$2,$4"
    [ -z "${late[$1,$3]:-}" ] || return 0
    have_row "$key" || find_reference "$1" "$2"
    measure "$key" "$5"
    [ "$(value_of "$key" seconds)" != - ] || late[$1,$3]=yes
}
for scene in ${SCENES_OF_STUDIES:-cube_quads cube_triangles sphere_in_box room_of_boxes}; do
    case $scene in
    room_of_boxes) sizes='100 316 1000 3162 10000 31623' ;;
    cube_quads) sizes='2 4 8 16 32 64' ;;
    cube_triangles) sizes='1 2 4 8 16 32 64' ;;
    *) sizes='2 4 8 16 32' ;;
    esac
    for size in $sizes; do
        make_scene "$scene" "$size"
        [ "$faces" -le "${LARGEST:-13000}" ] || continue
        for program in ${PROGRAMS:-radiosity View3D as_View3D OpenFOAM}; do
            case $program in
            radiosity) run "$scene" "$size" radiosity "$binary" run_radiosity ;;
            View3D) [ -z "$view3d" ] || run "$scene" "$size" View3D "$(checksum "$view3d")" run_view3d ;;
            as_View3D)
                view3d_key="$scene,View3D,$size,$([ -z "$view3d" ] || checksum "$view3d")"
                ! have_row "$view3d_key" || [ "$(value_of "$view3d_key" seconds)" = - ] || run "$scene" "$size" as_View3D "$binary" run_as_view3d
                ;;
            OpenFOAM) [ -z "$foam" ] || run "$scene" "$size" OpenFOAM "$(checksum "$foam")" run_openfoam ;;
            *) fail "there is no program '$program' in PROGRAMS: radiosity, View3D, as_View3D, OpenFOAM" ;;
            esac
        done
    done
done
# rows of this command, and of the others as they are here; of one that is not, those of before
others=$({ [ -z "$view3d" ] || checksum "$view3d"; [ -z "$foam" ] || checksum "$foam"; } | tr '\n' ' ')
{
    head -n 1 "$rows"
    awk -F , -v known=" $binary $others" -v view3d="$view3d" -v foam="$foam" '
        index(known, " " $4 " ") || (!view3d && $2 == "View3D") || (!foam && $2 == "OpenFOAM")' "$rows" | sort -t , -k 1,1 -k 3,3g -k 2,2r -s
} >"$pages/viewfactors.csv"

# ---- the page

{
    echo "set multiplot layout 3,4 margins .068,.995,.1,.9 spacing .055,.03"
    echo "set logscale xy; set mxtics 1; set mytics 1; set grid lc rgb '#888888' dt 3; set format x ''; set datafile separator ','; set xrange [10:20000]"
    for column in seconds memory_mb row_mean; do
        case $column in
        seconds) echo "set ylabel 's of one processor' offset 1.5,0; set format y '%g'; set yrange [.001:200]" ;;
        memory_mb) echo "set ylabel 'MB at the peak' offset 1.5,0; set yrange [1:10000]" ;;
        row_mean) echo "set ylabel 'mean of |1 - row sum|' offset .3,0; set format y '10^{%T}'; set format x '10^{%T}'; set xlabel 'faces'; set yrange [1e-8:1]" ;;
        esac
        first=1
        for scene in cube_quads cube_triangles sphere_in_box room_of_boxes; do
            [ $column = seconds ] && echo "set title '${scene//_/ }'" || echo "unset title"
            [ $column,$scene = seconds,cube_quads ] && echo "set key at screen .5,.995 center top maxrows 1 width 4" || echo "unset key"
            i=0 between=''
            printf 'plot '
            for program in radiosity as_View3D View3D OpenFOAM; do
                i=$((i + 1))
                awk -F , -v scene="$scene" -v program="$program" -v column="$column" '
                    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
                    $1 == scene && $2 == program && $at[column] != "-" { print $at["faces"] "," ($at[column] > 1e-8 ? $at[column] : 1e-8) }' \
                    "$pages/viewfactors.csv" >"$tmp/$scene.$program.$column"
                [ -s "$tmp/$scene.$program.$column" ] || continue
                printf "%s'%s' with linespoints pt 7 ps .4 lw 2 lc rgb '%s' t '%s'" "$between" "$tmp/$scene.$program.$column" \
                    "$(cut -d ' ' -f $i <<<'#2f81f7 #1a3f7a #d1453b #9a9a9a')" "${program/as_View3D/radiosity, as View3D}"
                between=', '
            done
            [ -n "$between" ] || printf '1/0 notitle'
            echo
            [ -z "$first" ] || echo "unset ylabel"
            first=''
        done
    done
    echo "unset multiplot"
} | draw "$pages/viewfactors.svg" 1000,720
{
    page_head "View factors" "What does a matrix of view factors cost, and how far is it off, as faces grow? \`radiosity viewfactors\` beside View3D (Walton 2002) and OpenFOAM's
\`viewFactorsGen\`, each with its own tolerances and on one thread; none scales its rows to 1. Seconds are of the processor, from the
start of the program to its end, reading and writing included: \`radiosity\` writes \`.npz\`, View3D binary floats, OpenFOAM text.
*elapsed*: from start to end, \`radiosity\` on all threads; the others have one. *as View3D*: \`radiosity\` with the largest tolerance
of $default_tolerance times a power of the root of two at which its mean error is no larger than View3D's."
    printf '![Seconds, memory and mean row defect over faces, of four scenes](viewfactors.svg)\n\n'
    echo "All scenes are closed, so rows sum to 1. \`cube_quads\` and \`cube_triangles\` are a bare cube (\`tests/studies/walls.awk\`), whose entries have closed"
    echo "forms; \`sphere_in_box\` is a sphere of triangles in it, \`room_of_boxes\` half of its faces in walls, half in boxes. There entries are"
    echo "held against \`radiosity --tolerance 3e-6\` (*reference*: what its own rows are off). Errors of entries: the sum of |F - R| in parts of the"
    echo "sum of R, and the largest; where there are few enough faces. What took more than $LIMIT s was given up, and nothing larger tried."
    echo
    awk -F , '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $2 == "reference" { next }
        { s[$1, $3, $2] = $at["seconds"]; e[$1, $3, $2] = $at["elapsed"]; if ($at["faces"] != "-") faces[$1, $3] = $at["faces"] }
        !seen[$1]++ { scene[++scenes] = $1 }
        !size_seen[$1, $3]++ { size[$1, ++sizes[$1]] = $3 }
        function says(t, mine, other, how, w, i, k, a, b, wins, loses) {
            for (w = 1; w <= scenes; w++) {
                wins = loses = ""
                for (i = 1; i <= sizes[scene[w]]; i++) {
                    k = scene[w] SUBSEP size[scene[w], i]
                    a = t == "s" ? s[k, mine] : e[k, mine]
                    b = t == "s" ? s[k, other] : e[k, other]
                    if (a == "" || b == "" || a == "-" && b == "-") continue
                    if (a != "-" && (b == "-" || a + 0 <= b + 0)) wins = wins (wins == "" ? "" : ", ") faces[k] (b == "-" ? " (the other did not end)" : sprintf(" (%.2g times)", b / a))
                    else loses = loses (loses == "" ? "" : ", ") faces[k] (a == "-" ? " (did not end)" : sprintf(" (%.2g times)", a / b))
                }
                if (wins loses != "") printf "- `%s` against %s%s: %s%s%s.\n", scene[w], other, how, (wins == "" ? "" : "faster at " wins), (wins != "" && loses != "" ? "; " : ""), (loses == "" ? "" : "slower at " loses)
            }
        }
        END {
            says("s", "as_View3D", "View3D", " at its error")
            says("s", "radiosity", "View3D", "")
            says("e", "radiosity", "View3D", ", elapsed")
            says("s", "radiosity", "OpenFOAM", "")
        }' "$pages/viewfactors.csv"
    echo
    echo "| scene | faces | program | tolerance | s | elapsed | MB | row defect, mean | row defect, largest | entries, of their sum | entry, largest |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|"
    awk -F , '
        function number(x, form) { return x == "-" ? "" : sprintf(form, x) }
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["seconds"] == "-" { printf "| %s %s | | %s | | too long | | | | | | |\n", $1, $3, $2; next }
        { sub(/^as_View3D$/, "radiosity, as View3D", $2) }
        { printf "| %s | %d | %s | %s | %.3g | %.3g | %.0f | %s | %s | %s | %s |\n", $1, $at["faces"], $2, number($at["tolerance"], "%g"), $at["seconds"], $at["elapsed"], $at["memory_mb"], number($at["row_mean"], "%.1e"),
              number($at["row_largest"], "%.1e"), number($at["entry_mean"], "%.1e"), number($at["entry_largest"], "%.1e") }' "$pages/viewfactors.csv"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/viewfactors.md"
say "$pages/viewfactors.md"
