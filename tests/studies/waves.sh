#!/usr/bin/env bash
# waves.sh - what a graph that runs in waves costs: instructions per pair beside the other releases, what they are spent on, how
# full its lists are at each node, how long its text is and how long a compiler takes for it.
#
# Instructions are counted by valgrind, which knows vectors of four numbers, no wider ones; links alone, one thread, with
# thresholds SCALE times as large, since that is 50 times slower; of large scenes the first PAIRS discussions. Seconds are of
# releases that hold the same pairs in turns (wave_times.c). Seconds of the compiler are the least of three.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
asked=${ORACLES:-bf bf_guarded $default}
command -v valgrind >/dev/null || fail "valgrind is missing, which counts instructions: apt-get install valgrind"
dagc=$BUILD/bin/dagc pairs_most=${PAIRS:-300000}
[ -x "$BUILD/bin/wave_times" ] || fail "$BUILD/bin/wave_times is missing: make $BUILD/bin/wave_times"

scale_of() { # SCENE: so that a scene takes minutes under valgrind
    case $1 in cornell | room | maze_8) echo 4 ;; td) echo 16 ;; *) echo 64 ;; esac
}
settings() { # ORACLE SCALE
    awk -v SCALE="$2" -f "$studies/thresholds.awk" "examples/oracles/$1.dag"
}
# Scenes of which the first pairs are counted: all would take hours.
is_cut() { # SCENE
    case $(basename "$1" .obj) in td | sejour | soda) ;; *) return 1 ;; esac
}

solve() { # SCENE ORACLE RELEASE SCALE OPTION...
    local scene=$1 oracle=$2 release=$3 scale=$4
    shift 4
    # shellcheck disable=SC2046
    "$@" "$radiosity" solve "$scene" -q --threads 1 --oracle "$oracle" --release "$release" --basis constant --no-correct --no-errors \
        --json "$tmp/json" $(! is_cut "$scene" || echo "--limit pairs=$pairs_most") $(settings "$oracle" "$scale")
}

# How many pairs were discussed: of a whole solve, or of one that met its limit.
pairs_of() {
    sed -n 's/.*did not end within pairs=.* has discussed \([0-9]*\) pairs.*/\1/p' "$tmp/valgrind" | grep . ||
        awk -f "$tables/json.awk" "$tmp/json" | awk '$1 == "pairs" { print $2 }'
}

# Of functions that were made several times, and inlined pieces of them, the whole is what costs most.
count() { # SCENE ORACLE RELEASE SCALE
    local status=0
    rm -f "$tmp/json"
    solve "$@" timeout "$((30 * LIMIT))" valgrind --tool=callgrind --callgrind-out-file="$tmp/callgrind" \
        --toggle-collect=refinement_start --toggle-collect=refinement_again >"$tmp/valgrind" 2>&1 || status=$?
    [ $status = 0 ] || grep -q "did not end within pairs=" "$tmp/valgrind" || return $status
    echo "pairs $(pairs_of)"
    # names stand where a function comes first, later only their numbers
    awk '/^c?fn=/ { id = $1; sub(/^c?fn=/, "", id); if (NF > 1) name[id] = $2; called = /^c/ ? id : "" }
        /^calls=/ && name[called] == "rtcOccluded16" { sub(/calls=/, "", $1); calls += $1 }
        END { printf "packets_cast %.0f\n", calls }' "$tmp/callgrind"
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

rows_open waves scene,oracle,what,scale,binary pairs,packets_cast,all,embree,packets,points,shafts,factors,per_list,lanes_of_8
for name in ${SCENES_OF_STUDIES:-cornell room maze_8 td sejour soda}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    scale=$(scale_of "$name")
    for oracle in $asked; do
        measure "$name,$oracle,lists,$scale,$binary" filled "$file" "$oracle" "$scale"
        for release in hand dag flat wave; do
            measure "$name,$oracle,$release,$scale,$binary" count "$file" "$oracle" $release "$scale"
        done
    done
done
rows_of_binary "$tmp/waves.csv"
{ head -n 1 "$tmp/waves.csv" && tail -n +2 "$tmp/waves.csv" | sort -t , -k 1,2 -s; } >"$pages/waves.csv"

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

# What releases take of the same pairs in turns, in nanoseconds of each and as medians of ratios with their ends.
take_turns() { # SCENE ORACLE
    PAIRS=$pairs_most LIMIT=$((10 * LIMIT)) timed "$BUILD/bin/wave_times" "$2" "$1" || return
    sed 's/bare Embree/bare/g; s/ all pairs / all /; s/ no ray cast / free /; s/[()]//g' "$tmp/timed.out" | awk '
        $2 == "all" || $2 == "free" {
            what = $2 "_" $4
            print $2 "_pairs", $3
            print what, $5
            print what "_ratio", $8
            print what "_low", $11
            print what "_high", $13
            if ($4 != "bare" && $2 == "all" && NF > 14) {
                print what "_bare", $14
                print what "_bare_low", $17
                print what "_bare_high", $19
            }
        }'
}
of_all=all_pairs,all_hand,all_flat_ratio,all_flat_low,all_flat_high,all_wave_ratio,all_wave_low,all_wave_high
of_bare=all_bare,all_flat_bare,all_flat_bare_low,all_flat_bare_high,all_wave_bare,all_wave_bare_low,all_wave_bare_high
rows_open waves_times scene,oracle,most,binary "$of_all,$of_bare,${of_all//all_/free_}"
for name in ${SCENES_OF_STUDIES:-cornell room maze_8 td sejour soda}; do
    file=$(scene "$name")
    for oracle in $asked; do
        [ -z "$file" ] || measure "$name,$oracle,$pairs_most,$binary" take_turns "$file" "$oracle"
    done
done
rows_of_binary "$pages/waves_times.csv"

# ---- the page
columns_of='NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next } function of(name) { return $at[name] }
    function three(name) { return of(name "_ratio") == "-" ? "-" : sprintf("%.2f (%.2f to %.2f)", of(name "_ratio"), of(name "_low"), of(name "_high")) }
    function over_bare(name) { return of(name "_bare") == "-" ? "-" : sprintf("%.2f (%.2f to %.2f)", of(name "_bare"), of(name "_bare_low"), of(name "_bare_high")) }'
{
    page_head "Waves" "What does it cost to treat 256 pairs at a time, node by node, in place of one pair after the other; what is it spent on; and how full
are the lists? One thread, links alone. All releases make the same decisions, to the bit."
    echo "## Time of the same pairs"
    echo
    echo "Every block of discussions that a solve hands out is held by each release in turns (\`make bench-waves\`); of each solve, by the oracle
as it is, the first $pairs_most pairs. Ratios are medians of three solves, with the least and the largest; time is that of the refiner, without
the engine's rounds. Bare Embree: the same rays cast in the same order by nothing but Embree's calls. Wanted of waves: at most .5 of
hand without rays, .65 over all, and 1.5 times bare Embree."
    echo
    echo "| scene | oracle | pairs | hand, ns | flat / hand | wave / hand | flat / bare Embree | wave / bare Embree | without rays | hand, ns | flat / hand | wave / hand |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    awk -F , "$columns_of"'
        of("all_pairs") != "-" {
            printf "| %s | `%s` | %.0f | %.0f | %s | %s | %s | %s | %.0f | %.0f | %s | %s |\n", $1, $2, of("all_pairs"), of("all_hand"), three("all_flat"), three("all_wave"),
                over_bare("all_flat"), over_bare("all_wave"), of("free_pairs"), of("free_hand"), three("free_flat"), three("free_wave")
        }' "$pages/waves_times.csv"
    awk -F , "$columns_of"'
        function count_one(name, most) {
            if (of(name) == "-") return
            n[name]++
            met[name] += of(name) <= most
            if (!(name in low) || of(name) < low[name]) low[name] = of(name)
            if (!(name in high) || of(name) > high[name]) high[name] = of(name)
        }
        function tell(what, name, over, most) {
            printf "- %s: wave takes %.2f to %.2f of %s, at most %.2f in %d of %d.\n", what, low[name], high[name], over, most, met[name], n[name]
        }
        { count_one("free_wave_ratio", .5); count_one("all_wave_ratio", .65); count_one("all_wave_bare", 1.5) }
        of("all_wave_ratio") != "-" { against("all"); against("free") }
        function against(what,  r) {
            r = of(what "_wave_ratio") / of(what "_flat_ratio")
            rows[what]++
            less[what] += r < .9
            more[what] += r > 1.1
        }
        END {
            print ""
            tell("Pairs that cast no ray", "free_wave_ratio", "hand", .5)
            tell("All pairs", "all_wave_ratio", "hand", .65)
            tell("All pairs", "all_wave_bare", "bare Embree", 1.5)
            printf "- Against flat, wave takes over a tenth less in %d and over a tenth more in %d of %d; of pairs that cast no ray, in %d and %d.\n", less["all"], more["all"], rows["all"], less["free"], more["free"]
        }' "$pages/waves_times.csv"
    printf '\n## Instructions per pair, Embree'"'"'s left out\n\n'
    echo "Of refinement as a whole, counted by valgrind, which knows vectors of four numbers at the most; one value per element, thresholds as
many times as large as the table says; of td, sejour and soda the first $pairs_most pairs."
    echo
    echo "| scene | oracle | thresholds | pairs | hand | dag | flat | wave | dag / hand | flat / hand | wave / hand | wave / flat |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    awk -F , "$columns_of"'
        of("what") != "lists" && of("all") != "-" {
            k = $1 SUBSEP $2
            if (!(k in pairs)) order[++n] = k
            pairs[k] = of("pairs"); scale[k] = $4
            each[k, $3] = (of("all") - of("embree")) / of("pairs")
        }
        function ratio(a, b) { return a > 0 && b > 0 ? sprintf("%.2f", a / b) : "-" }
        END { for (i = 1; i <= n; i++) { k = order[i]; split(k, name, SUBSEP); h = each[k, "hand"]; d = each[k, "dag"]; f = each[k, "flat"]; w = each[k, "wave"]
            printf "| %s | `%s` | %s | %s | %.0f | %.0f | %.0f | %.0f | %s | %s | %s | %s |\n", name[1], name[2], scale[k], pairs[k], h, d, f, w, ratio(d, h), ratio(f, h), ratio(w, h), ratio(w, f) } }' "$pages/waves.csv"
    printf '\n## What they are spent on\n\n'
    echo "Instructions per pair: Embree; packets for it; points that segments end at, and their weights; shafts between elements; form factors
of polygons; the rest, which is the graph, its other tools, lists and the engine's rounds."
    echo
    echo "| scene | oracle | release | packets per 100 pairs | Embree | packets | points | shafts | form factors | the rest | all, times Embree |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|"
    awk -F , "$columns_of"'
        (of("what") == "wave" || of("what") == "flat") && of("all") != "-" {
            p = of("pairs")
            rest = of("all") - (of("embree") + of("packets") + of("points") + of("shafts") + of("factors"))
            printf "| %s | `%s` | %s | %.1f | %.0f | %.0f | %.0f | %.0f | %.0f | %.0f | %s |\n", $1, $2, $3, 100 * of("packets_cast") / p, of("embree") / p,
                of("packets") / p, of("points") / p, of("shafts") / p, of("factors") / p, rest / p, (of("embree") > 0 ? sprintf("%.1f", of("all") / of("embree")) : "-")
        }' "$pages/waves.csv"
    printf '\n## How full the lists are\n\n'
    echo "Pairs in a list that is not empty, of at most 256, and the share of the lanes of vectors of eight that they fill; all nodes of a graph
together. A whole solve, by thresholds as above; where that takes over $LIMIT s there is no row."
    echo
    echo "| scene | oracle | pairs per list | lanes filled |"
    echo "|---|---|---|---|"
    awk -F , "$columns_of"'
        of("what") == "lists" && of("per_list") != "-" { printf "| %s | `%s` | %s | %s %% |\n", $1, $2, of("per_list"), of("lanes_of_8") }' "$pages/waves.csv"
    for oracle in $asked; do
        nodes=$results/waves_nodes_room_$oracle.txt
        [ -s "$nodes" ] || continue
        printf '\nOf `%s` in room, node by node (`dagc --profile FILE --dump=waves`), those that one pair in 256 comes to; nanoseconds are of\nthe interpreter:\n\n' "$oracle"
        echo "| node | tool | asked | pairs of 256 | per list | lanes of 8 filled | ns |"
        echo "|---|---|---|---|---|---|---|"
        sed 's/one by one/one_by_one/; s/as a list/as_a_list/; s/ %//g' "$nodes" | awk '
            ($3 == "one_by_one" || $3 == "as_a_list") && $5 >= 1 { gsub(/_/, " ", $3); printf "| %s | %s | %s | %s | %s | %s %% | %s |\n", $1, $2, $3, $5, $6, $8, $10 }
            / nodes are asked / { asked = $0 }
            END { sub(/^ */, "", asked); gsub(/_/, " ", asked); printf "\n%s.\n", asked }'
    done
    printf '\n## Text\n\n'
    echo "What \`dagc --release=flat\` and \`--release=wave\` (both functions) write, and what a compiler (\`${CC:-cc} -O2\`) takes for it and makes of it."
    echo
    echo "| oracle | release | lines | KB of text | seconds | KB of code |"
    echo "|---|---|---|---|---|---|"
    awk -F , 'NR > 1 { printf "| `%s` | %s | %s | %.0f | %.2f | %.0f |\n", $1, $2, $4, $5 / 1000, $6, $7 / 1000 }' "$tmp/text"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/waves.md"
say "$pages/waves.md"
