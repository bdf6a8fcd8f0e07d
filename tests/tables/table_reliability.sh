#!/bin/sh
# table_reliability.sh - rays and error of links alone: by_reliability, and bf with as many rays for all pairs as it takes at most.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LINKS=no
for name in cornell room maze_8; do
    file=examples/scenes/$name.obj
    judge "$name bf" "$radiosity" "$file" --oracle bf --no-correct --no-errors
    judge "$name bf64" "$radiosity" "$file" --oracle bf --set rays=64 --no-correct --no-errors
    judge "$name marks" "$radiosity" "$file" --oracle by_reliability --no-correct --no-errors
done
awk "$numbers"'
    { if (!($1 in known)) order[++n] = $1; known[$1] = 1; v[$1, $2, $3] = $4 }
    function two(s, oracle) { return count(v[s, oracle, "rays_links"]) " | " percent(v[s, oracle, "l1_faces"]) " %" }
    END {
        print "| scene | `bf`: rays | error | `bf --set rays=64`: rays | error | `by_reliability`: rays | error |"
        print "|---|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++)
            printf "| `%s` | %s | %s | %s |\n", order[i], two(order[i], "bf"), two(order[i], "bf64"), two(order[i], "marks")
    }' "$tmp/rows"
