#!/bin/sh
# table_clustering.sh - what ways of grouping faces cost and give, scene by scene, and what follows.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
for name in soda gridroom_1000 sejour; do
    file=$(scene $name)
    [ -n "$file" ] || continue
    say "$name"
    reference=$(sh "$tables/references.sh" "$file")
    "$build/bin/cell_error" faces "$file" "$reference/cells.csv" >"$tmp/ref.csv"
    "$radiosity" study clustering "$file" --reference "$tmp/ref.csv" -o "$tmp/table.csv" >&2 ||
        [ $? = 3 ] # a solve that did not converge has its row, and is marked
    echo "## $name.obj: $(grep -c '^f' "$file") faces"
    awk -F , -v name="$name" '
        NR == 1 {
            for (i = 1; i <= NF; i++) at[$i] = i
            print "\n| strategy | clusters | depth | crossed | build, s | cpu, s | clock, s | links | of groups | pairs | rays | MB | imbalance | error |"
            print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
            next
        }
        { printf "| %s%s | %d | %d | %.1f | %.2f | %.1f | %.1f | %d | %d | %d | %d | %.0f | %.2f %% | %.2f %% |\n", $1,
              $at["converged"] == 1 ? "" : ", not converged", $at["clusters"], $at["depth"],
              $at["crossed"], $at["build_s"], $at["cpu_s"], $at["clock_s"], $at["links"], $at["links_of_groups"], $at["pairs"], $at["rays"],
              $at["memory_mb"], 100 * $at["imbalance"], 100 * $at["error"] }
        END { print "" }' "$tmp/table.csv"
    awk -F , -v name="$name" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { print name, $1, $at["cpu_s"], $at["rays"], $at["error"], $at["build_s"] }' "$tmp/table.csv" >>"$tmp/all"
done
awk '
    { v[$1, $2, "time"] = $3; v[$1, $2, "rays"] = $4; v[$1, $2, "error"] = $5; scene[$1]; way[$2] }
    function ratio(w, what, lo, hi, s, r) {
        lo = 1e9; hi = 0
        for (s in scene) {
            r = v[s, "sah", what] > 0 ? v[s, w, what] / v[s, "sah", what] : 1
            if (r < lo) lo = r
            if (r > hi) hi = r
        }
        return sprintf("%.2f to %.2f", lo, hi)
    }
    END {
        print "## Beside sah, over these scenes\n\n| strategy | time | rays | error |\n|---|---|---|---|"
        n = split("halves embree octree kd", order, " ")
        for (i = 1; i <= n; i++)
            if (order[i] in way) printf "| %s | %s | %s | %s |\n", order[i], ratio(order[i], "time"), ratio(order[i], "rays"), ratio(order[i], "error")
    }' "$tmp/all"
