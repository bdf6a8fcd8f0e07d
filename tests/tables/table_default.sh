#!/bin/sh
# table_default.sh - the default on every scene: what it costs, and how far from the truth it is.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
for file in $(scenes); do
    name=$(row_name "$file")
    say "$name"
    judge "$name" "$radiosity" "$file"
done
awk "$numbers"'
    { if (!($1 in known)) order[++n] = $1; known[$1] = 1; v[$1, $2] = $3 }
    function low(what, i, x) { x = v[order[1], what]; for (i in order) if (v[order[i], what] < x) x = v[order[i], what]; return x }
    function high(what, i, x) { x = 0; for (i in order) if (v[order[i], what] > x) x = v[order[i], what]; return x }
    END {
        print "| scene | faces | links | rays of links | of mending | of measuring | s | links alone, faces | mended, faces | power | worst large face | cells | particles alone, cells |"
        print "|---|---|---|---|---|---|---|---|---|---|---|---|---|"
        for (i = 1; i <= n; i++) {
            s = order[i]
            printf "| %s | %d | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s | %s |\n", called(s), v[s, "faces"], count(v[s, "links"]),
                count(v[s, "rays_links"]), count(v[s, "rays_mending"]), count(v[s, "rays_errors"]), time(v[s, "seconds"]),
                percent(v[s, "links_l1_faces"]), percent(v[s, "l1_faces"]), signed(v[s, "power"]), \
                worst(v[s, "worst"], v[s, "worst_face"], v[s, "faces"]) (v[s, "worst"] < 2 * v[s, "worst_noise"] ? " (noise " percent(v[s, "worst_noise"]) ")" : ""),
                percent(v[s, "l1_cells"]), percent(v[s, "particles_cells"])
        }
        printf "\nErrors in %% of the reflected light, against traced references whose own noise is a part of them: %s to %s %% of faces, %s to %s %% of cells.\n",
            percent(low("noise_faces")), percent(high("noise_faces")), percent(low("noise_cells")), percent(high("noise_cells"))
    }' "$tmp/rows"
