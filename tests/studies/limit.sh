#!/usr/bin/env bash
# limit.sh - close to the limit: refinement against the time that Embree itself takes for its rays, in their order, within the
# same run; and what a second thread brings.
#
# Seconds of the clock, the least of REPEATS runs (3) that take turns, links alone: what else the machine does only adds to
# them. The efficiency of two threads means something on a machine that is idle but for it; the load is a column.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
rows_open limit scene,oracle,threads,run,binary faces,pairs,rays,refine,in_rays,load

solve() { # SCENE ORACLE THREADS
    local load
    load=$(cut -d ' ' -f 1 /proc/loadavg 2>/dev/null || true)
    timed "$radiosity" solve "$1" -q --threads "$3" --oracle "$2" --basis constant --no-correct --no-errors --json "$tmp/json" || return
    echo "load ${load:--}"
    awk -f "$tables/json.awk" "$tmp/json" | awk '{ v[$1] = $2 }
        END { print "faces", v["faces"]; print "pairs", v["pairs"]; print "rays", v["rays"]; print "refine", v["seconds.refine"]; print "in_rays", v["seconds.in_rays"] }'
}
for name in ${SCENES_OF_STUDIES:-cornell room panels maze_8 td soda}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    budget_begin
    left=0
    for ((turn = 1; turn <= ${REPEATS:-3}; turn++)); do
        for oracle in bf_guarded "$default"; do
            for threads in 1 2; do
                key="$name,$oracle,$threads,turn $turn,$binary"
                have_row "$key" || in_budget "${BUDGET:-100}" || { left=$((left + 1)) && continue; }
                measure "$key" solve "$file" "$oracle" $threads
            done
        done
    done
    say_left "$name" "${BUDGET:-100}" $left
done
rows_of_binary "$pages/limit.csv"

# ---- the page

# scene faces oracle pairs rays, then of one thread the least seconds of refinement, Embree's in that run, its load; of two the
# least seconds and load
awk -F , '
    NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    $at["refine"] == "-" { next }
    { k = $1 SUBSEP $2
      if (!(k in faces)) { order[++n] = k; scene[k] = $1; oracle[k] = $2 }
      faces[k] = $at["faces"]; pairs[k] = $at["pairs"]; rays[k] = $at["rays"]
      if (!((k, $3) in least) || $at["refine"] + 0 < least[k, $3]) { least[k, $3] = $at["refine"] + 0; embree[k, $3] = $at["in_rays"]; load[k, $3] = $at["load"] } }
    END { for (i = 1; i <= n; i++) { k = order[i]
        if ((k, 1) in least && (k, 2) in least && embree[k, 1] > 0)
            print scene[k], faces[k], oracle[k], pairs[k], rays[k], least[k, 1], embree[k, 1], load[k, 1], least[k, 2], load[k, 2] } }' "$pages/limit.csv" |
    sort -k 2,2n -s >"$tmp/limits"
{
    echo "set style data histograms; set style histogram rowstacked; set style fill solid .8; set boxwidth .6; set key at screen .99,.99 right top maxrows 1"
    echo "set grid ytics lc rgb '#888888' dt 3; set tmargin 3; set ylabel 'share of the seconds of refinement, %'; set yrange [0:100]; set xtics rotate by 30 right noenhanced"
    echo "plot '$tmp/limits' using (100*\$7/\$6):xtic(stringcolumn(1).' '.stringcolumn(3)) lc rgb '#2f81f7' t 'Embree', '' using (100-100*\$7/\$6) lc rgb '#d1a13b' t 'all else: asking, deciding, form factors, links'"
} | draw "$pages/limit.svg" 900,380
{
    page_head "Close to the limit" "No refinement can be faster than its rays. How much of it is not Embree's, and what does a second thread bring? Links alone, one value per
element; seconds of the clock, the least of ${REPEATS:-3} turns."
    printf '![Share of Embree in refinement](limit.svg)\n\n'
    echo "| scene | faces | oracle | discussions | rays | refinement, s | of it Embree | times Embree | ns per discussion beside rays | 2 threads, s | times faster | load, 1 and 2 threads |"
    echo "|---|---|---|---|---|---|---|---|---|---|---|---|"
    awk "$numbers"'
        { printf "| %s | %d | `%s` | %s | %s | %.3f | %.3f | %.1f | %.0f | %.3f | %.2f | %s, %s |\n", $1, $2, $3, count($4), count($5), $6, $7, $6 / $7, 1e9 * ($6 - $7) / $4, $9, $6 / $9, $8, $10
          if (!($3 in low) || $6 / $7 < low[$3]) low[$3] = $6 / $7
          if ($6 / $7 > high[$3]) high[$3] = $6 / $7
          if ($8 > busiest) busiest = $8
          if ($10 > busiest) busiest = $10
          sum += log($6 / $9); n++ }
        END {
            if (!n) exit
            print ""
            for (o in low) printf "Refinement with `%s` takes %.1f to %.1f times as long as Embree for its rays. ", o, low[o], high[o]
            printf "Two threads are %.2f times as fast as one, in the geometric mean", exp(sum / n)
            print (busiest > 0.5 ? sprintf(", on a machine that did other work as well (a load of up to %.1f), which says little of an idle one.", busiest) : ".")
        }' "$tmp/limits"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/limit.md"
say "$pages/limit.md"
