#!/usr/bin/env bash
# releases.sh - what a graph costs that is interpreted (dag) or compiled (flat), against the same oracle written by hand.
#
# Releases take turns, REPEATS times (5), links alone, one thread; a ratio is of two runs of one turn, so that what slows the
# machine down slows both. Refinement's seconds are of the processor, by the share that the clock gives it. Where valgrind
# is there, the instructions of refinement are counted, too, with thresholds 4 times as large; rays are not among them.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
rows_open releases scene,oracle,release,run,binary faces,pairs,links,rays,seconds,seconds_in_rays,instructions

settings() { # ORACLE SCALE
    awk -v SCALE="$2" -f "$studies/thresholds.awk" "examples/oracles/$1.dag"
}
# Is there such a release? A hand-written one is not there for every oracle.
has_release() { # ORACLE RELEASE
    [ "$2" != hand ] || [ -f "tests/hand/$1.c" ]
}

solve() { # SCENE ORACLE RELEASE
    timed "$radiosity" solve "$1" -q --threads 1 --oracle "$2" --release "$3" --basis constant --no-correct --no-errors \
        --json "$tmp/json" || return
    awk -f "$tables/json.awk" "$tmp/json" | awk -v cpu="$took" '
        { v[$1] = $2 }
        END {
            clock = v["seconds.build"] + v["seconds.refine"] + v["seconds.iterate"] + v["seconds.output"]
            print "faces", v["faces"]; print "pairs", v["pairs"]; print "links", v["links"]; print "rays", v["rays"]
            print "seconds", cpu * v["seconds.refine"] / clock; print "seconds_in_rays", cpu * v["seconds.in_rays"] / clock
        }'
}

count_instructions() { # SCENE ORACLE RELEASE
    # shellcheck disable=SC2046
    timeout "$((20 * LIMIT))" valgrind --tool=callgrind --callgrind-out-file="$tmp/callgrind" --toggle-collect=refinement_start \
        --toggle-collect=refinement_again "$radiosity" solve "$1" -q --threads 1 --oracle "$2" --release "$3" --basis constant \
        --no-correct --no-errors $(settings "$2" 4) >"$tmp/valgrind" 2>&1 || return
    callgrind_annotate --inclusive=yes "$tmp/callgrind" 2>/dev/null | tr -d , | awk '
        /PROGRAM TOTALS/ { all = $1 }
        /rays.c:occluded/ && !rays { rays = $1 }
        END { printf "instructions %.0f\n", all - rays }'
}

for name in ${SCENES_OF_STUDIES:-cornell room maze_8 td soda sejour}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    budget_begin
    left=0
    for ((turn = 1; turn <= ${REPEATS:-5}; turn++)); do
        for oracle in bf bf_guarded "$default"; do
            for release in hand dag flat; do
                has_release "$oracle" $release || continue
                key=$name,$oracle,$release,turn\ $turn,$binary
                have_row "$key" || in_budget "${BUDGET:-120}" || { left=$((left + 1)) && continue; }
                measure "$key" solve "$file" "$oracle" $release
            done
        done
    done
    say_left "$name" "${BUDGET:-120}" $left
    case " ${COUNTED:-cornell room} " in *" $name "*) ;; *) continue ;; esac
    command -v valgrind >/dev/null || { say "valgrind is not here: no instructions are counted" && continue; }
    for oracle in bf bf_guarded "$default"; do
        for release in hand dag flat; do
            has_release "$oracle" $release || continue
            measure "$name,$oracle,$release,thresholds x 4,$binary" count_instructions "$file" "$oracle" $release
        done
    done
done
rows_of_binary "$pages/releases.csv"

# ---- the page

# A line per scene and oracle: scene faces pairs oracle base, then of dag and of flat over base: median least most of
# seconds, ratio of instructions; share of rays. The base is hand, or flat where nobody wrote that.
awk -F , '
    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    !(($1, $2) in known) { known[$1, $2]; scene[++n] = $1; oracle[n] = $2 }
    $at["instructions"] != "-" { count[$1, $2, $3] = $at["instructions"] }
    $at["seconds"] != "-" {
        seconds[$1, $2, $3, $4] = $at["seconds"]; turn[$4]
        rays[$1, $2, $3] += $at["seconds_in_rays"]; sum[$1, $2, $3] += $at["seconds"]
        faces[$1] = $at["faces"]; pairs[$1, $2] = $at["pairs"]
    }
    function ratios(s, o, release, base, t, k, i, r, x) { # median least most, or dashes
        k = 0
        for (t in turn)
            if (seconds[s, o, release, t] > 0 && seconds[s, o, base, t] > 0) r[++k] = seconds[s, o, release, t] / seconds[s, o, base, t]
        if (!k || release == base) return "- - -"
        for (i = 2; i <= k; i++)
            for (t = i; t > 1 && r[t - 1] > r[t]; t--) { x = r[t]; r[t] = r[t - 1]; r[t - 1] = x }
        x = k % 2 ? r[(k + 1) / 2] : (r[k / 2] + r[k / 2 + 1]) / 2
        return sprintf("%.4f %.4f %.4f", x, r[1], r[k])
    }
    function instructions(s, o, release, base) {
        return release != base && count[s, o, base] > 0 && count[s, o, release] > 0 ? sprintf("%.4f", count[s, o, release] / count[s, o, base]) : "-"
    }
    END {
        for (i = 1; i <= n; i++) {
            s = scene[i]; o = oracle[i]
            if (!((s, o) in pairs)) continue
            base = (s, o, "hand") in sum ? "hand" : "flat"
            print s, faces[s], pairs[s, o], o, base, ratios(s, o, "dag", base), ratios(s, o, "flat", base), \
                instructions(s, o, "dag", base), instructions(s, o, "flat", base), (sum[s, o, base] > 0 ? rays[s, o, base] / sum[s, o, base] : 0)
        }
    }' "$pages/releases.csv" | sort -k 2,2n -s >"$tmp/ratios"
{
    echo "set multiplot layout 1,3 margins .07,.99,.2,.86 spacing .07,.1"
    echo "set grid ytics lc rgb '#888888' dt 3; set xtics rotate by 35 right noenhanced; set yrange [.8:1.25]; set format y '%.2f'"
    first=1
    for oracle in bf bf_guarded "$default"; do
        grep " $oracle " "$tmp/ratios" >"$tmp/ratios.$oracle" || continue
        base=$(awk '{ print $5; exit }' "$tmp/ratios.$oracle")
        awk '{ $1 = $1 "," $2; print }' "$tmp/ratios.$oracle" >"$tmp/named.$oracle"
        [ $first = 1 ] && echo "set ylabel 'seconds of refinement over hand' offset 1.5,0; set key at screen .99,.995 right top maxrows 1" ||
            echo "unset key; set ylabel 'over $base' offset 1.5,0"
        first=0
        echo "set title '$oracle' noenhanced offset 0,-.7; set xrange [-.6:$(wc -l <"$tmp/ratios.$oracle") - .4]"
        echo "plot 1 lw 1.5 lc rgb '#888888' notitle, 1.1 lw 1.5 dt 2 lc rgb '#888888' notitle, \\"
        echo " '$tmp/named.$oracle' using (\$0-.08):6:7:8:xtic(1) with yerrorbars pt 5 ps .7 lw 2 lc rgb '#d1453b' t 'DAG, interpreted', \\"
        echo " '$tmp/named.$oracle' using (\$0+.08):9:10:11 with yerrorbars pt 7 ps .7 lw 2 lc rgb '#2f81f7' t 'flat, compiled'"
    done
    echo "unset multiplot"
} | draw "$pages/releases.svg" 1000,360
{
    page_head "Releases" "What does it cost that an oracle is a graph? Each oracle is solved by in up to three releases: written by hand (\`hand\`), the graph
interpreted (\`dag\`), the graph compiled to C (\`flat\`). All make the same decisions and links, to the bit. Ratios are of the
processor's seconds in refinement, medians of ${REPEATS:-5} turns with the least and the largest, over \`hand\`."
    printf '![Ratios of the seconds of refinement, an oracle per panel, scenes by their faces](releases.svg)\n\n'
    for oracle in bf bf_guarded "$default"; do
        has_release "$oracle" hand || printf 'Nobody has written `%s` by hand: its ratios are over `flat`, and its column of that is empty.\n\n' "$oracle"
    done
    echo "| scene | faces | oracle | over | discussions | dag | flat | dag, instructions | flat, instructions | of refinement in rays |"
    echo "|---|---|---|---|---|---|---|---|---|---|"
    awk 'function spread(m, a, b) { return m == "-" ? "" : sprintf("%.2f (%.2f to %.2f)", m, a, b) }
        function one(x) { return x == "-" ? "" : sprintf("%.3f", x) }
        { printf "| %s | %d | `%s` | %s | %d | %s | %s | %s | %s | %.0f %% |\n", $1, $2, $4, $5, $3, spread($6, $7, $8), spread($9, $10, $11), one($12), one($13), 100 * $14 }' "$tmp/ratios"
    awk '
        $5 == "hand" && $6 != "-" {
            n++; name = "`" $4 "` on " $1
            if ($6 > dag) { dag = $6; dag_at = name }
            if ($9 > flat) { flat = $9; flat_at = name }
            above += $6 > 1.1
            slower += $9 > 1 && $10 > 1; faster += $9 < 1 && $11 < 1
            x = log($2); y = $6 - 1; sx += x; sy += y; sxx += x * x; sxy += x * y
        }
        $12 != "-" && $5 == "hand" { if ($12 > most) most = $12; if ($13 > least) least = $13 }
        END {
            if (!n) exit
            printf "\nCompiled, the graph takes at most %.2f times the time of the hand-written code (%s); it is slower in every turn in %d of the %d rows, faster in every turn in %d.\n", flat, flat_at, slower, n, faster
            printf "Interpreted it takes at most %.2f (%s), more than 1.10 in %d of the %d rows", dag, dag_at, above, n
            if (n > 2 && n * sxx > sx * sx) {
                slope = (n * sxy - sx * sy) / (n * sxx - sx * sx)
                printf "; with ten times the faces its overhead of %.1f %% in the mean %s by %.1f points", 100 * sy / n, slope < 0 ? "falls" : "grows", 100 * (slope < 0 ? -slope : slope) * log(10)
            }
            print "."
            if (most > 0) printf "In instructions, where no noise is, it is at most %.3f interpreted and %.3f compiled.\n", most, least
        }' "$tmp/ratios"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/releases.md"
say "$pages/releases.md"
