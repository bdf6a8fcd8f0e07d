#!/usr/bin/env bash
# accuracy.sh - speed against accuracy: every oracle with its thresholds swept, the default as it comes, mended by particles,
# asked for an error, and particles alone and paths alone, each held against the cells that references.sh traces.
#
# Seconds are of the processor, one thread, without reading and writing. An error is of faces or of cells of 1e-4 of the
# area, as cell_error says. Coarse runs come first, of all methods; BUDGET seconds (100, of the
# processor) go to a scene, LIMIT (60) to a run.
# SCENES_OF_STUDIES: names of scenes (those here of cornell room panels maze_8 td soda). ORACLES: those to run beside the
# default (all that ship).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
# viewfactors and tester are for other ends; importance cares for a view alone
oracles="$default ${ORACLES:-$("$radiosity" oracles | sed -n '/^[a-z]/s/^\([a-z_]*\).*/\1/p' | grep -vxE "$default|viewfactors|tester|importance" | tr '\n' ' ')}"
mended="$default bf_guarded"
COLUMNS=seconds,seconds_cells,rays,elements,links,memory_mb,l1_faces,l2_faces,worst,power,l1_cells,l2_cells,noise_faces,noise_l2_faces,noise_cells,noise_l2_cells
rows_open accuracy scene,method,run,binary $COLUMNS

# ---- one run: names and values

solve() { # SCENE FOLDER OPTION...
    local scene=$1 folder=$2
    shift 2
    timed "$radiosity" solve "$scene" -q --threads 1 --json "$tmp/json" --faces "$tmp/faces.csv" -o "$tmp/mesh.ply" "$@" || return
    "$build/bin/cell_error" compare "$scene" "$folder/cells.csv" "$tmp/faces.csv" "$tmp/mesh.ply"
    # Of the processor's time what is not of writing, by the clock's shares: the two go together with one thread.
    awk -f "$tables/json.awk" "$tmp/json" | awk -v cpu="$took" '
        { v[$1] = $2 }
        END {
            clock = "accuracy.seconds" in v ? v["accuracy.seconds"] \
                : v["seconds.build"] + v["seconds.refine"] + v["seconds.iterate"] + v["correction.seconds"] + v["error.seconds"]
            seconds = clock > 0 ? cpu * clock / (clock + v["seconds.output"]) : cpu
            print "seconds", seconds; print "seconds_cells", seconds
            print "rays", "accuracy.rays" in v ? v["accuracy.rays"] : v["rays"] + v["correction.rays"] + v["error.rays"]
            print "elements", v["elements"]; print "links", v["links"]; print "memory_mb", v["peak_memory_mb"]
        }'
}

# The scene turned in space, each face from its next corner on: the same light by other particles than those of the
# reference, which would else be among what they are judged by. To $tmp/turned.obj.
turn() { # SCENE
    cp "$(dirname "$1")/$(awk '$1 == "mtllib" { print $2; exit }' "$1")" "$tmp/turned.mtl"
    awk '$1 == "mtllib" { print "mtllib turned.mtl"; next }
        $1 == "v" { print "v", $3, $4, $2; next }
        $1 == "f" { printf "f"; for (i = 3; i <= NF; i++) printf " %s", $i; print " " $2; next }
        { print }' "$1" >"$tmp/turned.obj"
}

# Faces by a run on the scene, cells by one on its cells, each with its own time.
by_chance() { # SCENE FOLDER METHOD COUNT
    turn "$2/cut.obj"
    timed "$build/bin/by_chance" "$tmp/turned.obj" "$3" "$4" "$tmp/cells.csv" || return
    sed -n 's/^seconds /seconds_cells /p' "$tmp/timed.out"
    turn "$1"
    timed "$build/bin/by_chance" "$tmp/turned.obj" "$3" "$4" "$tmp/faces.csv" || return
    cat "$tmp/timed.out"
    "$build/bin/cell_error" compare "$1" "$2/cells.csv" "$tmp/faces.csv" "$tmp/cells.csv"
}

# ---- the sweep

# Left out: a method's run after one that was too long, or took so long that TIMES that is too long.
worth() { # KEY OF THE RUN BEFORE, TIMES
    have_row "$1" || return 0
    awk -v took="$(value_of "$1" seconds)" -v limit="$LIMIT" -v times="$2" 'BEGIN { exit !(took != "-" && times * took < limit) }'
}
declare -A before
run() { # NAME METHOD RUN COMMAND...
    local name=$1 method=$2 key=$1,$2,$3,$binary times=4
    case $method in particles | paths) times=16 ;; esac
    shift 3
    if [ -z "${before[$name,$method]:-}" ] || worth "${before[$name,$method]}" $times; then
        if have_row "$key" || in_budget "${BUDGET:-100}"; then
            measure "$key" "$@"
        else
            left=$((left + 1))
        fi
        before[$name,$method]=$key
    fi
}

# The whole range by every other step, then the steps between; errors asked for, in percent, are the same numbers.
steps=(16 8 4 2 1 .5 .25 .125)
for name in ${SCENES_OF_STUDIES:-cornell room panels maze_8 td soda}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    folder=$(sh "$tables/references.sh" "$file")
    budget_begin
    left=0
    run "$name" "$default chosen" "no options" solve "$file" "$folder" --no-errors
    for i in 0 2 4 6 1 3 5 7; do
        [ $i != 1 ] || before=()
        run "$name" particles "count $((2048 << (2 * i)))" by_chance "$file" "$folder" particles $((2048 << (2 * i)))
        run "$name" paths "count $((2048 << (2 * i)))" by_chance "$file" "$folder" paths $((2048 << (2 * i)))
        run "$name" "$default asked" "error ${steps[i]} %" solve "$file" "$folder" --oracle "$default" --accuracy "${steps[i]}%"
        for oracle in $oracles; do
            settings=$(awk -v SCALE="${steps[i]}" -f "$studies/thresholds.awk" "examples/oracles/$oracle.dag")
            # shellcheck disable=SC2086
            run "$name" "$oracle" "thresholds x ${steps[i]}" solve "$file" "$folder" --oracle "$oracle" $settings --no-correct --no-errors
            case " $mended " in *" $oracle "*)
                # shellcheck disable=SC2086
                run "$name" "$oracle mended" "thresholds x ${steps[i]}" solve "$file" "$folder" --oracle "$oracle" $settings --no-errors
                ;;
            esac
        done
    done
    say_left "$name" "${BUDGET:-100}" $left
done
find_optimum
rows_of_binary "$pages/accuracy.csv"
# From the lists of study greedy a row for each solve: what the oracle's links err by, greedy ones, the best constants.
{
    echo scene,basis,thresholds,links,l1,greedy_l1,floor_l1,l2,greedy_l2,floor_l2
    awk -f "$tables/json.awk" "$optimum.json" | awk '
        function floor(norm) { return v["basis"] == "constant" ? v["floor_" norm] / sqrt(v["links"]) : "-" }
        function known(name) { return name in v ? v[name] : "-" }
        {
            name = $1
            sub(/.*\./, "", name)
            v[name] = substr($0, length($1) + 2)
        }
        name == "basis" { delete v["greedy_l1"]; delete v["greedy_l2"] }
        name == "greedy_links_l2" {
            printf "%s,%s,x %g,%d,%s,%s,%s,%s,%s,%s\n", v["scene"], v["basis"], v["times"], v["links"], v["l1"], known("greedy_l1"), floor("l1"),
                v["l2"], known("greedy_l2"), floor("l2")
        }'
} >"$pages/accuracy_optimum.csv"
. "$studies/accuracy_page.sh"
