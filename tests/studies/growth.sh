#!/usr/bin/env bash
# growth.sh - how time and memory grow with the faces of a scene: room_of_boxes.awk, from 1,000 faces by half powers of ten to
# LARGEST (100000), as `radiosity solve` does it without options: links, mended by particles, its error measured.
#
# Beside the default: its links alone, and those of bf_guarded, which knows no groups of faces. Exponents are fitted to the
# rows by least squares on logarithms. LIMIT: seconds for one run (600); what takes longer is not tried larger.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-600}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
rows_open growth scene,method,run,binary faces,seconds,seconds_refine,memory_mb,elements,links,pairs,rays,l1_low,l1_high

solve() { # FACES OPTION...
    local faces=$1
    shift
    [ -s "$tmp/$faces.obj" ] || awk -v FACES="$faces" -v MATERIALS="$tmp/$faces.mtl" -f "$studies/room_of_boxes.awk" >"$tmp/$faces.obj"
    timed "$radiosity" solve "$tmp/$faces.obj" -q --threads 1 --json "$tmp/json" "$@" || return
    awk -f "$tables/json.awk" "$tmp/json" | awk -v cpu="$took" '
        { v[$1] = $2 }
        END {
            clock = v["seconds.build"] + v["seconds.refine"] + v["seconds.iterate"] + v["correction.seconds"] + v["error.seconds"] + v["seconds.output"]
            print "faces", v["faces"]; print "seconds", cpu; print "seconds_refine", cpu * v["seconds.refine"] / clock
            print "memory_mb", v["peak_memory_mb"]; print "elements", v["elements"]; print "links", v["links"]; print "pairs", v["pairs"]
            print "rays", v["rays"] + v["correction.rays"] + v["error.rays"]
            print "l1_low", v["error.l1_faces.low"]; print "l1_high", v["error.l1_faces.high"]
        }'
}

declare -A late
run() { # METHOD FACES OPTION...
    local method=$1 faces=$2 key="boxes_$2,$1,as it is set,$binary"
    shift
    [ -z "${late[$method]:-}" ] || return 0
    measure "$key" solve "$@"
    [ "$(value_of "$key" seconds)" != - ] || late[$method]=yes
}
for faces in 1000 3162 10000 31623 100000 316228 1000000; do
    [ $faces -le "${LARGEST:-100000}" ] || continue
    run "$default" $faces
    run "$default links" $faces --no-correct --no-errors
    run "bf_guarded links" $faces --oracle bf_guarded --no-correct --no-errors
    rm -f "$tmp/$faces.obj" "$tmp/$faces.mtl"
done
rows_of_binary "$pages/growth.csv"

# ---- the page

# Exponent of Y over faces of a method, and what it goes by: "exponent Y at the last, its faces".
exponent() { # METHOD COLUMN
    awk -F , -v method="$1" -v column="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $2 == method && $at[column] + 0 > 0 { n++; x = log($at["faces"]); y = log($at[column]); sx += x; sy += y; sxx += x * x; sxy += x * y }
        END { if (n > 1) printf "%.2f", (n * sxy - sx * sy) / (n * sxx - sx * sx); else printf "-" }' "$pages/growth.csv"
}
methods=("$default" "$default links" "bf_guarded links")
colours=('#d1453b' '#2f81f7' '#9a9a9a')
{
    echo "set multiplot layout 1,3 margins .07,.99,.16,.8 spacing .08,.1"
    echo "set logscale xy; set grid lc rgb '#888888' dt 3; set format x '10^{%T}'; set format y '%g'; set xlabel 'faces'; set datafile separator ','"
    first=1
    for column in seconds memory_mb links; do
        case $column in
        seconds) echo "set ylabel 's of one processor' offset 1.5,0; set key at screen .5,.99 center top maxrows 1 width 6" ;;
        memory_mb) echo "unset key; set ylabel 'MB at the peak' offset 1.5,0" ;;
        links) echo "unset key; set ylabel 'links' offset 1.5,0; set format y '10^{%T}'" ;;
        esac
        echo "plot \\"
        for i in 0 1 2; do
            awk -F , -v method="${methods[i]}" -v column="$column" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
                $2 == method && $at[column] != "-" { print $at["faces"] "," $at[column] }' "$pages/growth.csv" >"$tmp/growth.$i.$column"
            [ -s "$tmp/growth.$i.$column" ] || continue
            [ "$i" = 0 ] || printf ', '
            printf "'%s' with linespoints pt 7 ps .5 lw 2 lc rgb '%s' t '%s' noenhanced" "$tmp/growth.$i.$column" "${colours[i]}" \
                "$(sed 's/ links/, links alone/' <<<"${methods[i]}")"
        done
        echo
    done
    echo "unset multiplot"
} | draw "$pages/growth.svg" 1000,340
{
    page_head "Growth" "How do time and memory grow with the faces of a scene? The scenes are one room, half of the faces in its walls and half in boxes
(\`tests/studies/room_of_boxes.awk\`). \`$default\` is \`radiosity solve\` without options: linked where links pay, mended, and its error measured.
\`LARGEST=1000000\` goes on to a million faces."
    printf '![Seconds, memory and links over faces](growth.svg)\n\n'
    echo "| faces | method | s | of it refining | MB | links | links per face | rays | error, by its own measure |"
    echo "|---|---|---|---|---|---|---|---|---|"
    awk -F , "$numbers"'
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["seconds"] == "-" { printf "| %s | %s | too long | | | | | | |\n", substr($1, 7), $2; next }
        { printf "| %d | %s | %s | %.0f %% | %.0f | %s | %.0f | %s | %s |\n", $at["faces"], $2, time($at["seconds"]), 100 * $at["seconds_refine"] / $at["seconds"],
              $at["memory_mb"], count($at["links"]), $at["links"] / $at["faces"], count($at["rays"]),
              $at["l1_high"] == "-" ? "" : percent($at["l1_low"]) " to " percent($at["l1_high"]) " %" }' "$pages/growth.csv"
    echo
    for method in "${methods[@]}"; do
        range=$(awk -F , -v method="$method" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
            $2 == method && $at["seconds"] != "-" { if (low == "") low = $at["faces"]; high = $at["faces"] } END { if (low != "") print low " to " high }' "$pages/growth.csv")
        [ -n "$range" ] || continue
        echo "\`${method% links}\`$([ "${method% links}" = "$method" ] || echo ', links alone'): from $range faces time grows as faces to the power $(exponent "$method" seconds), memory to $(exponent "$method" memory_mb), links to $(exponent "$method" links), rays to $(exponent "$method" rays)."
        echo
    done
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/growth.md"
say "$pages/growth.md"
