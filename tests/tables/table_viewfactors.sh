#!/bin/sh
# table_viewfactors.sh - what matrices of view factors cost, and how far their rows are from 1.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
"$build/bin/factor_rays" make 32 8 30 "$tmp/turned.obj" >&2
"$build/bin/factor_rays" make 32 8 0 "$tmp/straight.obj" >&2
echo "| \`radiosity viewfactors\` | faces | links | s of one processor | row defect, mean | row defect, largest |"
echo "|---|---|---|---|---|---|"
row() { # SCENE NAME OPTION...
    file=$1 name=$2
    shift 2
    say "$name"
    "$build/bin/cost_of" "$tmp/cost" 3600 "$radiosity" viewfactors "$file" -q --threads 1 -o "$tmp/factors" --json "$tmp/json" "$@"
    awk -f "$tables/json.awk" "$tmp/json" | cat - "$tmp/cost" | awk -v name="$name" '
        { v[$1] = $2 }
        END { printf "| %s | %d | %d | %.1f | %.2g | %.2g |\n", name, v["faces"], v["links"], v["seconds"],
              v["row_defect_mean"], v["row_defect_largest"] }'
}
row examples/scenes/room.obj '`examples/scenes/room.obj`' --format csv
row examples/scenes/cornell.obj '`examples/scenes/cornell.obj`' --format csv
row "$tmp/turned.obj" 'room with a turned box, `--format coo`' --format coo
row "$tmp/straight.obj" 'room with a straight box, `--format coo`' --format coo
