#!/bin/sh
# table_against_old.sh - the default against that of an older radiosity (OLD=its path), scene by scene in turns.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
if [ -z "${OLD:-}" ]; then
    say "there is no older command to compare with: make tables TABLES=against_old OLD=path/of/radiosity"
    exit 77
fi
[ -x "$OLD" ] || { say "error: $OLD is no command that can be run; OLD takes the path of a radiosity" && exit 1; }
export LINKS=no
for file in $(scenes); do
    name=$(row_name "$file")
    say "$name"
    judge "$name old" "$OLD" "$file"
    judge "$name new" "$radiosity" "$file"
done
awk "$numbers"'
    { if (!($1 in known)) order[++n] = $1; known[$1] = 1; v[$1, $2 "_" $3] = $4 }
    function share(s, what) { return v[s, "old_" what] > 0 ? sprintf("%.2f", v[s, "new_" what] / v[s, "old_" what]) : "-" }
    END {
        print "| scene | rays of links: old | new | share | all rays: old | new | share | s: old | new | share | faces: old | new | worst large face: old | new | cells: old | new | particles alone: as many rays as new |"
        print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++) {
            s = order[i]
            printf "| %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", called(s),
                count(v[s, "old_rays_links"]), count(v[s, "new_rays_links"]), share(s, "rays_links"), count(v[s, "old_rays"]),
                count(v[s, "new_rays"]), share(s, "rays"), time(v[s, "old_seconds"]), time(v[s, "new_seconds"]), share(s, "seconds"),
                percent(v[s, "old_l1_faces"]), percent(v[s, "new_l1_faces"]), worst(v[s, "old_worst"], v[s, "old_worst_face"], v[s, "new_faces"]),
                worst(v[s, "new_worst"], v[s, "new_worst_face"], v[s, "new_faces"]),
                percent(v[s, "old_l1_cells"]), percent(v[s, "new_l1_cells"]), percent(v[s, "new_particles_cells"])
        }
    }' "$tmp/rows"
