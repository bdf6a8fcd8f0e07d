#!/bin/sh
# table_growth.sh - how cost grows with the faces: rooms full of boxes (make_scenes.py gridroom), at the defaults. GROWTH:
# more scenes, larger ones say.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
for file in $(scene gridroom_1000) $(scene gridroom_10000) ${GROWTH:-}; do
    name=$(row_name "$file")
    say "$name"
    "$radiosity" solve "$file" -q --json "$tmp/json"
    awk -f "$tables/json.awk" "$tmp/json" >"$tmp/items"
    sed "s/^/$name /" "$tmp/items" >>"$tmp/rows"
done
[ -s "$tmp/rows" ] || { say "no gridroom is here" && exit 77; }
awk "$numbers"'
    { if (!($1 in known)) order[++n] = $1; known[$1] = 1; v[$1, $2] = $3 }
    END {
        print "| scene | faces | links | rays | s | MB | error, by its own measure |"
        print "|---|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++) {
            s = order[i]
            printf "| %s | %d | %s | %s | %s | %d | %s to %s %% |\n", called(s), v[s, "faces"], count(v[s, "links"]),
                count(v[s, "rays"] + v[s, "correction.rays"] + v[s, "error.rays"]),
                time(v[s, "seconds.build"] + v[s, "seconds.refine"] + v[s, "seconds.iterate"] + v[s, "correction.seconds"] + v[s, "error.seconds"]),
                v[s, "peak_memory_mb"], percent(v[s, "error.l1_faces.low"]), percent(v[s, "error.l1_faces.high"])
        }
    }' "$tmp/rows"
