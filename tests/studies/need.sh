#!/usr/bin/env bash
# need.sh - no more than needed: rays that precise answers make needless, bands, elements and links against meshes of equal
# cells at equal error, bytes per link, and how much code an oracle becomes.
#
# A question of sight is answered without rays where support planes, the planes of clusters, or a shaft know: it counts as so
# many rays avoided as a question cast that had none of this. A mesh of equal cells is the scene as cell_error cuts it, each
# pair of faces linked, else solved the same way. Errors are of cells of 1e-4 of the area. LIMIT: seconds for one run (60).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
rows_open need scene,method,run,binary seconds,pairs,rays,asked,precise,bands,elements,links,memory_mb,l1_cells,noise_cells,code_bytes

solve() { # SCENE THE-SAME-OR-CUT FOLDER OPTION...
    local scene=$1 solved=$2 folder=$3
    shift 3
    timed "$radiosity" solve "$solved" -q --threads 1 --no-correct --no-errors --json "$tmp/json" --statistics "$tmp/answers.csv" \
        --faces "$tmp/faces.csv" -o "$tmp/mesh.ply" "$@" || return
    # of a cut scene there are no faces: any table of the scene's will do, for cells are judged by the mesh
    [ "$scene" = "$solved" ] || "$build/bin/by_chance" "$scene" particles 1000 "$tmp/faces.csv" >"$tmp/chance"
    "$build/bin/cell_error" compare "$scene" "$folder/cells.csv" "$tmp/faces.csv" "$tmp/mesh.ply"
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
        $1 == "answer" && $at["pass"] == 0 { # of all passes
            tool = $at["tool"]; answer = $at["answer"]
            if (tool ~ /visibility$/ && tool !~ /^(exact|presume)_/) asked += $at["count"]
            if (tool == "shaft" && answer ~ /^(in)?visible$/ || tool == "handed_down" && answer == "whole" \
                || tool == "support_planes" && answer == "away" || tool == "clusters" && answer == "apart") precise += $at["count"]
        } END { print "asked", asked + 0; print "precise", precise + 0 }' "$tmp/answers.csv"
    awk -f "$tables/json.awk" "$tmp/json" | awk -v cpu="$took" '
        { v[$1] = $2 }
        END {
            clock = v["seconds.build"] + v["seconds.refine"] + v["seconds.iterate"]
            print "seconds", cpu * clock / (clock + v["seconds.output"])
            print "pairs", v["pairs"]; print "rays", v["rays"]; print "bands", v["bands"]; print "elements", v["elements"]
            print "links", v["links"]; print "memory_mb", v["peak_memory_mb"]
        }'
}

for name in ${SCENES_OF_STUDIES:-cornell room panels maze_8 td}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    folder=$(sh "$tables/references.sh" "$file")
    budget_begin
    for step in 16 4 1 .25; do
        settings=$(awk -v SCALE=$step -f "$studies/thresholds.awk" "examples/oracles/$default.dag")
        # shellcheck disable=SC2086
        in_budget "${BUDGET:-100}" && measure "$name,$default,thresholds x $step,$binary" solve "$file" "$file" "$folder" --oracle "$default" $settings
    done
    in_budget "${BUDGET:-100}" && measure "$name,bf_guarded,thresholds x 1,$binary" solve "$file" "$file" "$folder" --oracle bf_guarded
    for share in .016 .004 .001; do
        in_budget "${BUDGET:-100}" || continue
        "$build/bin/cell_error" cut "$file" "$tmp/cut" $share
        measure "$name,equal cells,share $share,$binary" solve "$file" "$tmp/cut.obj" "$folder" --oracle ff --set limit=1e9
    done
done
if command -v size >/dev/null; then
    code_of() { # OBJECT...
        echo "code_bytes $(size "$@" | awk 'NR > 1 { sum += $1 } END { print sum }')"
    }
    for oracle in bf bf_guarded "$default"; do
        [ ! -f "$build/gen/oracles/$oracle.o" ] || measure "-,$oracle,flat,$binary" code_of "$build/gen/oracles/$oracle.o"
        hand=$build/tests/hand
        [ -f "$hand/$oracle.o" ] || continue
        geometry= # power takes that of the tools
        nm "$hand/$oracle.o" | grep -q 'U hand_form_factor' && geometry=$hand/factor.o
        # shellcheck disable=SC2086
        measure "-,$oracle,hand,$binary" code_of "$hand/$oracle.o" $geometry "$hand/clusters.o"
    done
fi
rows_of_binary "$pages/need.csv"
find_optimum

# ---- the page
names=$(awk -F , 'NR > 1 && $1 != "-" && !seen[$1]++ { print $1 }' "$pages/need.csv")
{
    echo "set multiplot layout 1,$(wc -w <<<"$names") margins .07,.99,.17,.78 spacing .035,.1"
    echo "set logscale xy; set grid lc rgb '#888888' dt 3; set format x '10^{%T}'; set format y '%g'; set yrange [1:100]; set xlabel 'links'"
    first=1
    for name in $names; do
        for method in "$default" "equal cells"; do
            awk -F , -v scene="$name" -v method="$method" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
                $1 == scene && $2 == method && $at["links"] != "-" { print $at["links"], 100 * $at["l1_cells"] }' "$pages/need.csv" | sort -g >"$tmp/need.$method.$name"
        done
        [ $first = 1 ] && echo "set key at screen .5,.99 center top maxrows 1 width 4; set ylabel 'error of cells, %' offset 1.5,0" || echo "unset key; unset ylabel; set format y ''"
        first=0
        echo "set title '$name' noenhanced offset 0,-.7"
        echo "plot '$tmp/need.$default.$name' with linespoints pt 7 ps .5 lw 2 lc rgb '#2f81f7' t '$default' noenhanced, '$tmp/need.equal cells.$name' with linespoints pt 5 ps .5 lw 2 lc rgb '#bf8700' t 'equal cells, all linked'"
    done
    echo "unset multiplot"
} | draw "$pages/need.svg" 1000,320
{
    page_head "No more than needed" "What is spared by asking before computing? Links alone, without particles."
    printf '## Rays\n\nA question of sight that support planes, planes of clusters or a shaft answer precisely casts no ray.\n\n'
    echo "| scene | bands | oracle | discussions | rays | questions to rays | answered precisely without | rays avoided, of all that would be |"
    echo "|---|---|---|---|---|---|---|---|"
    awk -F , "$numbers"'
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 != "-" && $3 == "thresholds x 1" && $at["pairs"] != "-" {
            asked = $at["asked"]; precise = $at["precise"]; share = asked + precise > 0 ? precise / (asked + precise) : 0
            printf "| %s | %d | `%s` | %s | %s | %s | %s | %s (%.0f %%) |\n", $1, $at["bands"], $2, count($at["pairs"]), count($at["rays"]), count(asked), count(precise),
                count(asked > 0 ? precise * $at["rays"] / asked : 0), 100 * share
            n[$2]++; if (!($2 in low) || share < low[$2]) low[$2] = share; if (share > high[$2]) high[$2] = share }
        END { print ""; for (o in n) printf "`%s`: precise answers make %.0f to %.0f %% of the rays needless. ", o, 100 * low[o], 100 * high[o]; print "Where all is grey one band is computed, not three." }' "$pages/need.csv"
    printf '\n## Elements and links\n\nThe default against meshes of equal cells in which each pair is linked. Of the default the coarsest run stands here that is at least as good.\n\n'
    printf '![Error of cells over links](need.svg)\n\n'
    echo "| scene | equal cells: error | elements | links | s | \`$default\`: error | elements | links | s | links, times fewer |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    awk -F , -v own="$default" "$numbers"'
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 != "-" && $at["links"] != "-" && ($2 == own || $2 == "equal cells") {
            n++; scene[n] = $1; method[n] = $2; e[n] = $at["l1_cells"]; links[n] = $at["links"]; elements[n] = $at["elements"]; s[n] = $at["seconds"] }
        END {
            for (i = 1; i <= n; i++) {
                if (method[i] != "equal cells") continue
                best = 0
                for (k = 1; k <= n; k++)
                    if (method[k] == own && scene[k] == scene[i] && e[k] <= e[i] && (!best || links[k] < links[best])) best = k
                printf "| %s | %s %% | %d | %s | %.2f |", scene[i], percent(e[i]), elements[i], count(links[i]), s[i]
                if (!best) { print " none as good | | | | |"; continue }
                times = links[i] / links[best]
                if (!least || times < least) { least = times; least_at = scene[i] " at " percent(e[i]) " %" }
                if (times > most) { most = times; most_at = scene[i] " at " percent(e[i]) " %" }
                printf " %s %% | %d | %s | %.2f | %.1f |\n", percent(e[best]), elements[best], count(links[best]), s[best], times
            }
            if (most) printf "\nAt no larger error the default has %.1f (%s) to %.1f (%s) times fewer links.\n", least, least_at, most, most_at
        }' "$pages/need.csv"
    if [ -s "$optimum.txt" ]; then
        printf '\n## The optimum\n\nWhere light is known exactly, links can be held against greedy ones, each split being the one that lowers the true error most:\n\n'
        printf '    $ build/bin/radiosity study greedy\n'
        sed 's/^\(.\)/    \1/' "$optimum.txt"
    fi
    printf '\n## Bytes\n\n'
    awk -F , -v own="$default" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == "-" && $at["code_bytes"] != "-" { code[$2, $3] = $at["code_bytes"]; if (!seen[$2]++) name[++n] = $2 }
        $2 == own && $1 != "-" && $at["links"] != "-" {
            if (!($1 in few) || $at["links"] < few[$1]) { few[$1] = $at["links"]; little[$1] = $at["memory_mb"] }
            if ($at["links"] > many[$1]) { many[$1] = $at["links"]; much[$1] = $at["memory_mb"] } }
        END {
            for (s in few) if (many[s] > few[s]) {
                b = (much[s] - little[s]) * 1048576 / (many[s] - few[s])
                if (!k++ || b < low) low = b
                if (b > high) high = b
            }
            if (k) printf "A link, with its share of elements and of all else that grows with them, takes %.0f to %.0f bytes at the peak (%d scenes, from thresholds 16 times as large to a quarter).\n", low, high, k
            if (n) print "\n| oracle | code of the compiled graph, for one pair and for many, bytes | written by hand, with what it calls |\n|---|---|---|"
            for (i = 1; i <= n; i++) printf "| `%s` | %s | %s |\n", name[i], code[name[i], "flat"], code[name[i], "hand"]
        }' "$pages/need.csv"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/need.md"
say "$pages/need.md"
