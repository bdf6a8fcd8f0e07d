#!/bin/sh
# table_oracles.sh - every oracle that ships, links alone, on five scenes: links, rays and error, and how many of them are
# both cheaper and better than the default. PATIENCE: seconds a solve may take (60).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LINKS=no
for name in cornell room maze_8 panels td; do
    file=$(scene $name)
    [ -n "$file" ] || continue
    say "$name"
    echo "scene $name" >>"$tmp/rows"
    # viewfactors is for matrices: every face has radiosity 1
    for oracle in $("$radiosity" oracles | sed -n '/^[a-z]/{s/^\([a-z_]*\).*/\1/p;}' | grep -v -x viewfactors); do
        timeout "${PATIENCE:-60}" sh "$tables/judge.sh" "$radiosity" "$file" --oracle "$oracle" --no-correct --no-errors >"$tmp/one" || {
            status=$?
            [ $status = 124 ] || exit $status
            say "$name: $oracle takes more than ${PATIENCE:-60} s"
            : >"$tmp/one"
        }
        sed "s/^/value $name $oracle /" "$tmp/one" >>"$tmp/rows"
        echo "oracle $oracle" >>"$tmp/rows"
    done
done
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
awk -v default="$default" "$numbers"'
    $1 == "scene" { scene[++scenes] = $2 }
    $1 == "oracle" && !seen[$2]++ { oracle[++oracles] = $2 }
    $1 == "value" { v[$2, $3, $4] = $5 }
    END {
        head = "| oracle |"; rule = "|---|"
        for (i = 1; i <= scenes; i++) { head = head " `" scene[i] "`: links | rays | error |"; rule = rule "---|---|---|" }
        print head; print rule
        for (k = 1; k <= oracles; k++) {
            o = oracle[k]; line = "| `" o "` |"; wins = 0; where = ""
            for (i = 1; i <= scenes; i++) {
                s = scene[i]; known = (s, o, "rays") in v
                better = known && o != default && v[s, o, "rays"] < v[s, default, "rays"] && v[s, o, "l1_faces"] < v[s, default, "l1_faces"]
                if (better) { wins++; where = where (where == "" ? "" : ", ") "`" s "`" }
                line = line (!known ? " - | - | - |" : sprintf(" %s | %s | %s |", count(v[s, o, "links"]), count(v[s, o, "rays"]),
                    (better ? "**" : "") percent(v[s, o, "l1_faces"]) " %" (better ? "**" : "")))
            }
            print line
            if (wins > 1) { many = many (many == "" ? "" : ", ") "`" o "` on " wins " (" where ")" }
            if (wins == 1) { one = one (one == "" ? "" : ", ") "`" o "` (" where ")" }
        }
        print ""
        for (i = 1; i <= scenes; i++) { x = v[scene[i], default, "noise_faces"]; if (x > noise) noise = x }
        print "The noise of these references is " percent(noise) " % or less. Both cheaper in rays and better than the default (bold) on more than one scene: " (many == "" ? "none" : many) "; on one: " (one == "" ? "none" : one) "."
    }' "$tmp/rows"
