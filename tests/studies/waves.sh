#!/usr/bin/env bash
# waves.sh - what a graph that runs in waves costs: instructions per pair beside the other releases, what they are spent on, how
# full its lists are at each node, how long its text is and how long a compiler takes for it.
#
# Instructions are counted by valgrind, which knows vectors of four numbers, no wider ones; links alone, one thread, with
# thresholds SCALE times as large (table SCALED), since that is 50 times slower. Seconds of the compiler are the least of three.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
asked=${ORACLES:-bf bf_guarded $default}
command -v valgrind >/dev/null || fail "valgrind is missing, which counts instructions: apt-get install valgrind"
dagc=$BUILD/bin/dagc

scale_of() { # SCENE: so that a scene takes minutes under valgrind
    case $1 in cornell | room | maze_8) echo 4 ;; td) echo 16 ;; *) echo 64 ;; esac
}
settings() { # ORACLE SCALE
    awk -v SCALE="$2" -f "$studies/thresholds.awk" "examples/oracles/$1.dag"
}
solve() { # SCENE ORACLE RELEASE SCALE OPTION...
    local scene=$1 oracle=$2 release=$3 scale=$4
    shift 4
    # shellcheck disable=SC2046
    "$@" "$radiosity" solve "$scene" -q --threads 1 --oracle "$oracle" --release "$release" --basis constant --no-correct --no-errors \
        --json "$tmp/json" $(settings "$oracle" "$scale")
}

# Of functions that were made several times, and inlined pieces of them, the whole is what costs most.
count() { # SCENE ORACLE RELEASE SCALE
    solve "$@" timeout "$((30 * LIMIT))" valgrind --tool=callgrind --callgrind-out-file="$tmp/callgrind" \
        --toggle-collect=refinement_start --toggle-collect=refinement_again >"$tmp/valgrind" 2>&1 || return
    awk -f "$tables/json.awk" "$tmp/json" | awk '{ v[$1] = $2 } END { print "pairs", v["pairs"]; print "rays", v["rays"] }'
    callgrind_annotate --inclusive=yes --threshold=100 "$tmp/callgrind" 2>/dev/null | tr -d , | awk '
        /PROGRAM TOTALS/ { all = $1 }
        /^ *[0-9]/ && /[:?][A-Za-z_0-9.]+('"'"'[0-9]+)?( |$)/ {
            name = $0
            sub(/ \[.*/, "", name); sub(/.*:/, "", name); sub(/'"'"'[0-9]+$/, "", name)
            if ($1 > most[name]) most[name] = $1 + 0
        }
        END {
            for (name in most) if (name ~ /^polygon_factor(\.|$)/ && most[name] > factors) factors = most[name]
            casts = most["visibility_rays"] + most["light_visibility_rays"] + most["cluster_rays"]
            occluded = most["occluded"] > most["occluded.part.0"] ? most["occluded"] : most["occluded.part.0"]
            printf "all %.0f\nembree %.0f\npackets %.0f\n", all, most["rtcOccluded16"], occluded - most["rtcOccluded16"]
            printf "points %.0f\nshafts %.0f\nfactors %.0f\n", (casts > occluded ? casts - occluded : 0), most["blockers_find"], factors
        }'
}

# How full lists are: pairs at all nodes over lists asked, and the share of eight lanes that they fill.
filled() { # SCENE ORACLE SCALE
    # shellcheck disable=SC2046
    timed "$radiosity" solve "$1" -q --threads 1 --oracle "$2" --release dag --basis constant --no-correct --no-errors \
        --statistics "$tmp/statistics.json" $(settings "$2" "$3") || return
    "$dagc" -Wno-all --profile "$tmp/statistics.json" --dump=waves "examples/oracles/$2.dag" >"$tmp/waves"
    cp "$tmp/waves" "$results/waves_nodes_$(basename "$1" .obj)_$2.txt"
    awk '/ (one by one|as a list) .*%/ { pairs += $(NF - 5); lists += $(NF - 4) > 0 ? $(NF - 5) / $(NF - 4) : 0; full += $(NF - 5) / ($(NF - 2) / 100) }
        END { if (lists > 0) printf "per_list %.1f\nlanes_of_8 %.1f\n", pairs / lists, 100 * pairs / full }' FS='[ %]+' "$tmp/waves"
}

rows_open waves scene,oracle,what,scale,binary pairs,rays,all,embree,packets,points,shafts,factors,per_list,lanes_of_8
for name in ${SCENES_OF_STUDIES:-cornell room maze_8 td sejour soda}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    scale=$(scale_of "$name")
    for oracle in $asked; do
        measure "$name,$oracle,lists,$scale,$binary" filled "$file" "$oracle" "$scale"
        for release in hand flat wave; do
            measure "$name,$oracle,$release,$scale,$binary" count "$file" "$oracle" $release "$scale"
        done
    done
done
rows_of_binary "$pages/waves.csv"

# The text of an oracle without and with its waves, and the compiler's seconds for it.
make_text() { # ORACLE RELEASE
    "$dagc" -Wno-all "--release=$2" -o "$tmp/text.c" --header "$tmp/text.h" "examples/oracles/$1.dag"
    echo "lines $(wc -l <"$tmp/text.c")"
    echo "bytes $(wc -c <"$tmp/text.c")"
    local least='' turn
    for turn in 1 2 3; do
        timed ${CC:-cc} -std=c11 -O2 -ffp-contract=off -fno-math-errno -fno-trapping-math -fopenmp-simd -I"$BUILD/gen" -Iruntime \
            -Iruntime/oracle -Idagc -I"$tmp" -c -o "$tmp/text.o" "$tmp/text.c" || return
        least=$(awk -v a="$took" -v b="${least:-$took}" 'BEGIN { print a < b ? a : b }')
    done
    echo "seconds $least"
    echo "object $(size "$tmp/text.o" | awk 'END { print $1 }')"
}
rows_open waves_text oracle,release,binary lines,bytes,seconds,object
for oracle in $asked; do
    for release in flat wave; do measure "$oracle,$release,$binary" make_text "$oracle" $release; done
done
rows_of_binary "$tmp/text"

# ---- the page
{
    page_head "Waves" "What does it cost to treat 256 pairs at a time, node by node, in place of one pair after the other; what is it spent on; and how full
are the lists? Instructions of refinement, counted by valgrind, which knows vectors of four numbers at the most; one thread, links
alone, one value per element, thresholds as many times as large as the table says. All releases make the same decisions, to the bit.
Rays' own time is another matter: \`make bench-waves\`."
    echo "## Instructions per pair, Embree's left out"
    echo
    echo "| scene | oracle | thresholds | pairs | hand | flat | wave | flat / hand | wave / hand | wave / flat |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    awk -F , "$numbers"'
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["what"] != "lists" && $at["all"] != "-" {
            k = $1 SUBSEP $2
            if (!(k in pairs)) order[++n] = k
            pairs[k] = $at["pairs"]; scale[k] = $4
            each[k, $3] = ($at["all"] - $at["embree"]) / $at["pairs"]
        }
        function ratio(a, b) { return a > 0 && b > 0 ? sprintf("%.2f", a / b) : "-" }
        END { for (i = 1; i <= n; i++) { k = order[i]; split(k, name, SUBSEP); h = each[k, "hand"]; f = each[k, "flat"]; w = each[k, "wave"]; if (!w) continue
            printf "| %s | `%s` | %s | %s | %.0f | %.0f | %.0f | %s | %s | %s |\n", name[1], name[2], scale[k], count(pairs[k]), h, f, w, ratio(f, h), ratio(w, h), ratio(w, f) } }' "$pages/waves.csv"
    printf '\n## What the release in waves spends them on\n\n'
    echo "Shares of all instructions of refinement: Embree; packets for it; points that segments end at, and their weights; shafts between
elements; form factors of polygons; the rest, which is the graph, its other tools, lists and the engine's rounds."
    echo
    echo "| scene | oracle | rays per pair | Embree | packets | points | shafts | form factors | the rest | all, times Embree |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    awk -F , '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["what"] == "wave" && $at["all"] != "-" {
            a = $at["all"] / 100
            rest = 100 - ($at["embree"] + $at["packets"] + $at["points"] + $at["shafts"] + $at["factors"]) / a
            printf "| %s | `%s` | %.1f | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %.0f %% | %s |\n", $1, $2, $at["rays"] / $at["pairs"], $at["embree"] / a,
                $at["packets"] / a, $at["points"] / a, $at["shafts"] / a, $at["factors"] / a, rest, ($at["embree"] > 0 ? sprintf("%.1f", 100 * a / $at["embree"]) : "-")
        }' "$pages/waves.csv"
    printf '\n## How full the lists are\n\n'
    echo "Pairs in a list that is not empty, of at most 256, and the share of the lanes of vectors of eight that they fill; all nodes of a graph together."
    echo
    echo "| scene | oracle | pairs per list | lanes filled |"
    echo "|---|---|---|---|"
    awk -F , '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["what"] == "lists" && $at["per_list"] != "-" { printf "| %s | `%s` | %s | %s %% |\n", $1, $2, $at["per_list"], $at["lanes_of_8"] }' "$pages/waves.csv"
    nodes=$results/waves_nodes_room_$default.txt
    if [ -s "$nodes" ]; then
        printf '\nOf `%s` in room, node by node (`dagc --profile FILE --dump=waves`); nanoseconds are of the interpreter:\n\n' "$default"
        sed 's/^/    /' "$nodes"
    fi
    printf '\n## Text\n\n'
    echo "What \`dagc --release=flat\` and \`--release=wave\` (both functions) write, and what a compiler (\`${CC:-cc} -O2\`) takes for it and makes of it."
    echo
    echo "| oracle | release | lines | KB of text | seconds | KB of code |"
    echo "|---|---|---|---|---|---|"
    awk -F , 'NR > 1 { printf "| `%s` | %s | %s | %.0f | %.2f | %.0f |\n", $1, $2, $4, $5 / 1000, $6, $7 / 1000 }' "$tmp/text"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/waves.md"
say "$pages/waves.md"
