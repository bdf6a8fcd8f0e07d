#!/bin/sh
# table_causes.sh - which light the default's links bring wrongly, and why: by cause and scene (radiosity study causes).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
for name in cornell room maze_8 panels td; do
    file=$(scene $name)
    [ -n "$file" ] || continue
    say "$name"
    "$radiosity" study causes "$file" -q --json "$tmp/json"
    awk -f "$tables/json.awk" "$tmp/json" | sed -n "s/^\.*causes\.\([a-z_]*\)\.\(after\|after_l1\)\.value /$name \1 \2 /p" >>"$tmp/rows"
done
awk "$numbers"'
    BEGIN {
        said["lost"] = "lost: no link"; said["open"] = "links seen whole"; said["half"] = "links in half shadow"; said["groups"] = "links of groups"
        said["bright"] = "bright spots"; said["kernel"] = "form factors"; said["visibility"] = "visibility"; said["spread"] = "spread over the receiver"
        said["rest"] = "form factors, visibility"; said["row_cap"] = "row sums, cap"; said["solver"] = "iteration"
    }
    function words(key, part) {
        if (key in said) return said[key]
        if (split(key, part, "_") == 2 && (part[1] in said) && (part[2] in said)) return said[part[1]] ": " said[part[2]]
        gsub(/_/, " ", key)
        return key
    }
    { if (!($1 in scenes)) scene[++n] = $1; scenes[$1]; if (!($2 in causes)) cause[++m] = $2; causes[$2]; v[$1, $2, $3] = $4 }
    END {
        head = "| cause |"; rule = "|---|"
        for (i = 1; i <= n; i++) { head = head " `" scene[i] "` |"; rule = rule "---|" }
        print head; print rule
        for (k = 1; k <= m; k++) {
            line = "| " words(cause[k]) " |"
            for (i = 1; i <= n; i++) line = line " " signed(v[scene[i], cause[k], "after"]) " / " percent(v[scene[i], cause[k], "after_l1"]) " |"
            print line
        }
    }' "$tmp/rows"
