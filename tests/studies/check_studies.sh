#!/usr/bin/env bash
# check_studies.sh - studies: a run that was stopped goes on, and nothing runs twice; rows that are damaged are told; the
# Pareto front, the sentences that follow from it and thresholds are right; what is missing is named. by_chance in the furnace.
# cost_of ends what takes too long; closed forms of a cube sum to 1, and errors of matrices are those that were made.
# Once is enough: it is about scripts, and arithmetic on their rows.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../solver/lib.sh"
export BUILD RESULTS=$tmp/results PAGES=$tmp/pages RADIOSITY=$radiosity
BUILD=$(dirname "$(dirname "$radiosity")")
unset BUDGET LIMIT SCENES_OF_STUDIES
quietly=into_files
says() { # TEXT COMMAND...: fails, and says it
    text=$1
    shift
    "$@" >said 2>&1 && return 1
    grep -qF -- "$text" said || { cat said && false; }
}

# ---- rows: a study of three runs, of which `three` may kill it
mkdir study && cp "$top"/tests/studies/*.awk study
cat >study/mini.sh <<'END'
. "$LIB"
rows_open mini scene,run,binary seconds,rays
work() { echo "$1" >>log; [ "$1" != "${KILL:-}" ] || kill -9 $$; echo "seconds $2"; echo "rays 17"; echo "other 3"; }
for run in one two three; do measure "room,$run,$binary" work $run .5; done
measure "room,late,$binary" sh -c 'exit 124'
END
export LIB=$top/tests/studies/lib.sh TABLES_FOLDER=$top/tests/tables
mini() { bash study/mini.sh; }
KILL=three mini >out 2>err
check "what was done before the kill is kept" sh -c '[ "$(wc -l <results/mini.csv)" = 3 ] && [ "$(tr "\n" " " <log)" = "one two three " ]'
cp results/mini.csv before.csv
check "it goes on" mini
check "and runs nothing twice" [ "$(tr '\n' ' ' <log)" = "one two three three " ]
check "rows before it are as they were" sh -c 'head -n 3 results/mini.csv | cmp - before.csv'
check "a row has what has a column" grep -q '^room,three,[0-9]*,\.5,17$' results/mini.csv
check "a run that was too long has dashes" grep -q '^room,late,[0-9]*,-,-$' results/mini.csv
check "all that is there: nothing runs" sh -c 'cp log log.old && bash study/mini.sh && cmp log log.old'
cp results/mini.csv whole.csv
check "another command has rows of its own" sh -c 'printf x >other && RADIOSITY=$PWD/other bash study/mini.sh && [ "$(wc -l <results/mini.csv)" = 9 ]'
damaged() { # LINE TEXT SED-SCRIPT
    sed "$3" whole.csv >results/mini.csv
    rm -f log
    says "results/mini.csv:$1: error: $2" mini && [ ! -e log ]
}
check "a row that was cut short is told" damaged 3 "4 fields, not 5" '3s/,[^,]*$//'
check "a word for a number is told" damaged 3 'rays is "x"' '3s/[^,]*$/x/'
check "nan is told" damaged 4 'seconds is "nan"' '4s/,\.5,/,nan,/'
check "two rows of one run are told" damaged 6 "a second row of room,late" '$p'
check "other columns are told" damaged 1 "these are not the columns" '1s/rays/links/'
cp whole.csv results/mini.csv
check "a run that fails ends the study" says "ended with exit status 7" bash -c '. "$LIB"; rows_open mini scene,run,binary seconds,rays; measure a,b,c sh -c "exit 7"' study/mini.sh
check "and leaves the rows" cmp whole.csv results/mini.csv
mkdir bin
for tool in bash sh awk sed cksum cut dirname basename mkdir mktemp rm cat; do ln -s "$(command -v $tool)" bin; done
check "gnuplot is named when it is missing" says "apt-get install gnuplot-nox" env PATH="$tmp/bin" bash study/mini.sh

# ---- the front: of equals the first; what is worse in one and equal in the other is beaten
printf '%s\n' '4 1 d' '1 8 a' '2 7 beaten' '2 4 b' '2 4 second' '3 5 beaten' '2 6 beaten' '8 .5 e' '9 .5 beaten' '0 1 none' '3 3 c' '1e1 7 beaten' |
    awk -f "$top/tests/studies/front.awk" | cut -d ' ' -f 3 | tr '\n' ' ' >front
check "the front" [ "$(cat front)" = "a b c d e " ]

# ---- the page of accuracy, from rows by hand
header=scene,method,run,binary,seconds,seconds_cells,rays,elements,links,memory_mb,l1_faces,l2_faces,worst,power,l1_cells,l2_cells,noise_faces,noise_l2_faces,noise_cells,noise_l2_cells
row() { echo "box,$1,$2,1,$3,$3,9,9,9,9,$4,.1,.1,0,$4,.1,.001,.001,.001,.001"; }
mkdir -p pages
{
    echo $header
    row particles "count 100" .01 .08
    row particles "count 400" .04 .04
    row particles "count 1600" .16 .02
    row paths "count 100" .02 .1
    row power "thresholds x 1" .02 .04
    row "power chosen" "no options" .1 .01
    row "power mended" "thresholds x .5" .2 .0001
    row "power asked" "error 1 %" .4 .005
    row ff "thresholds x 1" .015 .05
} >pages/accuracy.csv
page() { bash -c '. "$(dirname "$0")/lib.sh"; default=power; . "$studies/accuracy_page.sh"' "$top/tests/studies/accuracy.sh"; }
check "a page is made" page
# 1 % takes power --accuracy .4 s: its only run is better; particles are at 2 %, paths at 10 %; below its noise of .1 % nothing is told
check "which is the fastest" grep -qF 'of faces: down to 10 % particles alone (0.01 s), down to 5 % links of `ff` alone (0.015 s), down to 1 % the default (0.1 s), down to 0.1 % `power` mended (0.2 s); the least of all, 0.1 %, is by `power` mended in 0.2 s.' pages/accuracy.md
check "what the default's error takes" grep -qF 'The 1 % that the default reaches in 0.1 s take, by others: particles alone 2 % at best (0.16 s), paths alone 10 % at best (0.02 s), `power --accuracy` 0.4 s.' pages/accuracy.md
sed -i 's/^box,particles,count 1600,1,.16,.16,9,9,9,9,.02/box,particles,count 1600,1,.64,.64,9,9,9,9,.0025/' pages/accuracy.csv
check "a page is made again" page
# from 4 % at .04 s to .25 % at .64 s: 1 % halfway, .16 s
check "what the default's error takes between two runs" grep -qF 'particles alone 0.16 s' pages/accuracy.md
printf '%s\n' 'box,particles,count 100,1,.01,.08,9,9,9,9,.4,.1,.1,0,.4,.1,.001,.001,.001,.001' 'box,paths,count 100,1,-,-,-,-,-,-,-,-,-,-,-,-,-,-,-,-' |
    sed "1i $header" >partial.csv
check "a page of two runs" sh -c 'cp pages/accuracy.csv all.csv && cp partial.csv pages/accuracy.csv'
check "is made" page
check "it says that little is known" grep -qF 'Nothing has an error of faces of 20 % or less yet: the least, 40 %, is by particles alone in 0.01 s.' pages/accuracy.md
check "and that the default is missing" grep -qF 'The default has no run here that ended' pages/accuracy.md
printf '%s\n' 'box,power chosen,no options,1,.1,.1,9,9,9,9,.01,.1,.1,0,.01,.1,.001,.001,.001,.001' >>pages/accuracy.csv
check "with the default alone" page
check "it says what has no run" grep -qF 'particles alone 40 % at best (0.01 s), paths alone has no run that ended' pages/accuracy.md
check "all rows again" sh -c 'cp all.csv pages/accuracy.csv'
check "and their page" page
check "without an optimum no word of it" sh -c '! grep -q "The floor" pages/accuracy.md'
{
    echo scene,basis,thresholds,links,l1,greedy_l1,floor_l1,l2,greedy_l2,floor_l2
    echo white,constant,x 1,50,2e-5,1e-9,1e-9,2e-5,1e-9,1e-9
    echo plates,constant,x 4,100,.06,.05,.04,.06,.05,.04
    echo plates,constant,x 1,400,.03,.02,.02,.03,.02,.02
    echo plates,linear,x 1,400,.006,.004,-,.006,.004,-
} >pages/accuracy_optimum.csv
check "a page is made with the optimum" page
check "what follows from the optimum" grep -qF 'plates: of `power` constants err by 1.20 to 1.50 times what as many greedy links do (most with 400 links); linear elements by 1.50 to 1.50 times (most with 400); greedy constants by 1.00 to 1.25 times' pages/accuracy.md
check "where greedy links are exact" grep -qF 'white: greedy links are exact; the default errs by at most 0.002 %.' pages/accuracy.md
check "its charts are drawn, for light and dark" sh -c 'for f in accuracy accuracy_cells; do grep -q prefers-color-scheme pages/$f.svg && tail -n 3 pages/$f.svg | grep -q "</svg>" || exit 1; done'

# ---- charts are made small: each point, text and line is still there, once; ink and paper follow light and dark
awk 'BEGIN { for (i = 1; i <= 200; i++) print i, i * i % 37 }' >dots
cat >study/chart.sh <<'END'
. "$LIB"
echo "set multiplot layout 1,2; set logscale x; set title 'one < two'; set xlabel '10^{-3} m'; plot 'dots' with linespoints pt 7 lc rgb '#d1453b' t 'many', 5 t 'five'
set title 'three'; plot '-' with points pt 9 t 'single'
20 3
e
unset multiplot" | draw chart.svg 800,400
END
check "a chart" bash study/chart.sh
corners() { grep -o '<path class="m[0-9]*" d="M[^"]*"' chart.svg | sed 's/.*"M//; s/"$//' | tr ' ' '\n' | grep -c ,; }
check "has all its points, the keys' too" [ "$(corners)" = 203 ]
check "and its texts" sh -c 'for t in "one &lt; two" three many five single; do grep -qF ">$t<" chart.svg || exit 1; done'
check "its elements are closed" [ "$(grep -o '<g[ >]' chart.svg | wc -l)" = "$(grep -o '</g>' chart.svg | wc -l)" ]
check "it follows the reader's dark" grep -q '#0d1117' chart.svg
check "and is small" [ "$(wc -c <chart.svg)" -lt 13000 ]
check "what is no chart is told" says "unknown element <image>" awk -f "$top/tests/studies/small_svg.awk" <<<'<?xml version="1.0"?><svg><image></svg>'

# ---- thresholds: those that --accuracy scales, within their ranges; the smallest part only falls
printf '%s\n' '  param a : ratio = 0.5 in [0, 1] role link_threshold "x"' '  param b : ratio = 3' '  param c_2 : ratio = 2e-5 in [0, 1] role smallest_part "x"' \
    '  param d : ratio = 0.25 in (0, inf] role link_threshold "x"' >g.dag
check "thresholds, coarser" [ "$(awk -v SCALE=4 -f "$top/tests/studies/thresholds.awk" g.dag)" = "--set a=1 --set c_2=2e-05 --set d=1 " ]
check "thresholds, finer" [ "$(awk -v SCALE=.5 -f "$top/tests/studies/thresholds.awk" g.dag)" = "--set a=0.25 --set c_2=1e-05 --set d=0.125 " ]

# ---- by_chance: in the furnace B is 2 everywhere, and a table of cells held against itself is right
furnace=$top/examples/scenes/furnace.obj
near_two() { awk -F , 'NR > 1 && ($4 < 1.9 || $4 > 2.1) { wrong = 1 } END { exit wrong || NR != 7 }' faces.csv; }
for method in particles paths; do
    check "$method in the furnace" sh -c '"$BUILD/bin/by_chance" "$1" $2 20000 faces.csv >told' - "$furnace" $method
    check "$method tell seconds and rays" sh -c 'grep -q "^seconds [0-9.e-]*$" told && grep -q "^rays [0-9]*$" told'
    check "$method: B" near_two
done
check "an unknown method" says usage: "$BUILD/bin/by_chance" "$furnace" photons 10 x.csv
check "cells" "$BUILD/bin/cell_error" cut "$furnace" cut 1e-2
check "particles on cells" "$BUILD/bin/by_chance" cut.obj particles 20000 cells.csv
check "cells against themselves" sh -c '"$BUILD/bin/cell_error" compare "$1" cells.csv faces.csv cells.csv 1e-2 >errors && grep -qx "l1_cells 0" errors && grep -qx "l2_cells 0" errors' - "$furnace"
awk -F , 'NR > 1 { $4 += NR % 2 ? .1 : -.1 } { OFS = ","; print }' cells.csv >off.csv
check "cells off by a tenth" sh -c '"$BUILD/bin/cell_error" compare "$1" cells.csv faces.csv off.csv 1e-2 >errors' - "$furnace"
check "L2 of cells" awk '$1 == "l2_cells" { found = $2 > .09 && $2 < .101 } END { exit !found }' errors

# ---- cost_of: of the processor, not of the clock
cost_of=$BUILD/bin/cost_of
check "a command that waits is not ended" "$cost_of" took 1 sleep 1.2
check "and takes nothing" awk '$1 == "seconds" && $2 < .5 { found++ } $1 == "memory_mb" && $2 > .1 { found++ } END { exit found != 2 }' took
status_of() { "$@" >out 2>err; [ $? = "$expected" ]; }
expected=124
check "one that works on and on is ended" status_of "$cost_of" took 1 sh -c 'while :; do :; done'
expected=7
check "its exit status is kept" status_of "$cost_of" took 1 sh -c 'exit 7'
expected=127
check "a command that is not there" status_of "$cost_of" took 1 ./no_such_command
expected=2
check "a limit that is no number" status_of "$cost_of" took 1s true

# ---- viewfactors: a cube by closed forms, what other programs read and write, errors
view=$top/tests/studies
awk -v N=2 -f "$view/cube_factors.awk" >cube.coo
errors() { awk -v ROWS=24 "$@" -f "$view/factor_error.awk"; }
check "entries of a cube sum to 1" sh -c 'awk -v ROWS=24 -f "$1" <cube.coo | awk "{ wrong += \$2 > 1e-11 } END { exit wrong || NR != 2 }"' - "$view/factor_error.awk"
check "walls.awk and the closed forms are one cube" sh -c 'awk -v SCENE=cube_quads -v N=2 -f "$1/walls.awk" >cube.obj && "$2" viewfactors cube.obj -q --format coo -o ours.coo && awk -v ROWS=24 -v REFERENCE=cube.coo -f "$1/factor_error.awk" <ours.coo | awk "{ wrong += \$2 > 1e-8 } END { exit wrong || !NR }"' - "$view" "$radiosity"
check "two triangles are a square" sh -c 'awk -v SCENE=cube_triangles -v N=2 -f "$1/walls.awk" >cube_3.obj && "$2" viewfactors cube_3.obj -q --format coo -o three.coo && awk -v ROWS=48 -v GROUP=2 -v REFERENCE=cube.coo -f "$1/factor_error.awk" <three.coo | awk "{ wrong += \$2 > 1e-8 } END { exit wrong || !NR }"' - "$view" "$radiosity"
check "a sphere in a box is closed" sh -c 'awk -v SCENE=sphere_in_box -v N=2 -f "$1/walls.awk" >sphere.obj && "$2" viewfactors sphere.obj -q --format coo -o sphere.coo && awk -v ROWS=80 -f "$1/factor_error.awk" <sphere.coo | awk "{ wrong += \$2 > 1e-3 } END { exit wrong || !NR }"' - "$view" "$radiosity"
awk -F , -v OFS=, '$1 == 3 && $2 == 20 { $3 += .01 } $1 == 4 && $2 == 9 { next } { print }' cube.coo >off.coo
errors -v REFERENCE=cube.coo <off.coo >told
gone=$(awk -F , '$1 == 4 && $2 == 9 { print $3 }' cube.coo)
check "errors are what was done" awk -v gone="$gone" '
    function near(x, y) { return x > .99 * y && x < 1.01 * y }
    { v[$1] = $2 }
    END { exit !(near(v["row_largest"], gone) && near(v["row_mean"], (.01 + gone) / 24) && near(v["entry_largest"], gone) && near(v["entry_mean"], (.01 + gone) / 24)) }' told
check "rows that are not in order" sh -c '! tac cube.coo | awk -v ROWS=24 -f "$1" 2>/dev/null' - "$view/factor_error.awk"
printf 'FoamFile\n{\n}\n\n4\n(\n2\n(\n.1\n.2\n)\n3{.5}\n0()\n1(7)\n)\n' | awk -f "$view/foam_lists.awk" >lists
check "OpenFOAM's lists" [ "$(tr '\n' '|' <lists)" = ".1 .2|.5 .5 .5||7|" ]
awk -v AS=view3d -f "$view/other_input.awk" cube.obj >cube.vs3
check "View3D's input is the same cube" sh -c '"$1" viewfactors cube.vs3 -q --format coo -o vs3.coo && cmp vs3.coo ours.coo' - "$radiosity"
check "the study goes on without the other programs" sh -c 'cd "$1" && VIEW3D=no_such_command VIEW_FACTORS_GEN=no_such_command LARGEST=24 SCENES_OF_STUDIES=cube_quads bash tests/studies/viewfactors.sh' - "$top"
check "and tells of ours alone" grep -q '^| cube_quads | 24 | radiosity |' "$PAGES/viewfactors.md"
mkdir -p case/0 case/system case/constant/polyMesh
check "OpenFOAM's case is written" awk -v AS=openfoam -v CASE=case -f "$view/other_input.awk" cube.obj
check "its faces look the other way" grep -qx '4(3 2 1 0)' case/constant/polyMesh/faces
finish studies
