#!/bin/sh
# table_groups.sh - what links between groups of faces are worth: the default against bf_guarded, which has none.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LINKS=no
echo "| scene | faces | seconds | links | rays | error |"
echo "|---|---|---|---|---|---|"
for name in room maze_16 gridroom_1000 td; do
    file=$(scene $name)
    [ -n "$file" ] || continue
    say "$name"
    : >"$tmp/rows"
    for oracle in clusters bf_guarded; do
        judge $oracle "$radiosity" "$file" --oracle $oracle --no-correct --no-errors
    done
    awk -v name="$name" "$numbers"'
        { v[$1, $2] = $3 }
        function both(x, y) { return x " / " y }
        END { c = "clusters"; b = "bf_guarded"
              printf "| `%s` | %d | %s | %s | %s | %s %% |\n", name, v[c, "faces"], both(time(v[c, "seconds"]), time(v[b, "seconds"])),
                  both(count(v[c, "links"]), count(v[b, "links"])), both(count(v[c, "rays"]), count(v[b, "rays"])),
                  both(percent(v[c, "l1_faces"]), percent(v[b, "l1_faces"])) }' "$tmp/rows"
done
