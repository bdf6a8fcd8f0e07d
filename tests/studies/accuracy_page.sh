# accuracy_page.sh - charts and page of accuracy.sh, from $pages/accuracy.csv and accuracy_optimum.csv alone; read by it.
# SPDX-License-Identifier: MIT
floor=$pages/accuracy_optimum.csv
csv=$pages/accuracy.csv
names=$(awk -F , 'NR > 1 && !seen[$1]++ { print $1 }' "$csv")

# Lines "x y method run" of a scene, where both were measured. An error below the noise of the reference is known to be no
# larger than that, and counts as that.
points() { # SCENE X Y NOISE
    awk -F , -v scene="$1" -v x="$2" -v y="$3" -v noise="$4" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == scene && $at[x] != "-" && $at[y] != "-" {
            e = $at[y] + 0
            floor = $at[noise] + 0
            gsub(/ /, "_", $2)
            gsub(/ /, "_", $3)
            print ($at[x] + 0 > 0 ? $at[x] : 1e-4), 100 * (e > floor ? e : floor), $2, $3
        }' "$csv" | LC_ALL=C sort -k 3,3 -k 1,1g
}

# A chart of all scenes, a panel each.
chart() { # FILE X Y NOISE X-LABEL Y-LABEL
    local count columns height
    count=$(wc -w <<<"$names") columns=$((count < 3 ? count : 3))
    height=$((90 + 300 * ((count + columns - 1) / columns)))
    local width=$((columns < 2 ? 720 : 80 + 320 * columns))
    {
        echo "set multiplot layout $(((count + columns - 1) / columns)),$columns margins $((75000 / width))e-3,.985,$((50000 / height))e-3,$((1000 - 80000 / height))e-3 spacing .05,$((62000 / height))e-3"
        echo "set logscale xy; set grid lc rgb '#888888' dt 3; set format y '%g'; set format x '%g'"
        local i=0
        for name in $names; do
            points "$name" "$2" "$3" "$4" >"$tmp/points.$name"
            awk -f "$studies/front.awk" "$tmp/points.$name" >"$tmp/front.$name"
            i=$((i + 1))
            echo "set title '$name' noenhanced offset 0,-.8"
            [ $i -le $((count - columns)) ] && echo "unset xlabel" || echo "set xlabel '$5' offset 0,.6"
            [ $((i % columns)) = 1 ] || [ "$columns" = 1 ] && echo "set ylabel '$6' offset 1.5,0" || echo "unset ylabel"
            # of every other oracle a line of its own: blank lines between methods
            awk -v own="$default" '$3 != own && $3 != own "_mended" && $3 != own "_asked" && $3 != own "_chosen" && $3 != "particles" && $3 != "paths" {
                if (last != "" && $3 != last) print ""
                last = $3; print }' "$tmp/points.$name" >"$tmp/others.$name"
            for method in "$default" "${default}_mended" "${default}_asked" "${default}_chosen" particles paths; do
                awk -v method="$method" '$3 == method' "$tmp/points.$name" >"$tmp/one.$method.$name"
            done
            [ $i = 1 ] && echo "set key at screen .02,.995 left top maxrows 2 samplen 2" || echo "unset key"
            echo "plot \\"
            echo " '$tmp/front.$name' with lines lw 7 lc rgb '#88f0c040' t 'Pareto front', \\"
            echo " '$tmp/others.$name' with linespoints pt 7 ps .3 lw 1 lc rgb '#9a9a9a' t 'other oracles', \\"
            echo " '$tmp/one.$default.$name' with linespoints pt 7 ps .5 lw 2 lc rgb '#2f81f7' t '$default, links alone', \\"
            echo " '$tmp/one.${default}_mended.$name' with linespoints pt 5 ps .5 lw 2 lc rgb '#d1453b' t 'mended', \\"
            echo " '$tmp/one.${default}_asked.$name' with linespoints pt 9 ps .6 lw 2 lc rgb '#a371f7' t '--accuracy', \\"
            echo " '$tmp/one.particles.$name' with linespoints pt 13 ps .6 lw 2 lc rgb '#2da44e' t 'particles alone', \\"
            echo " '$tmp/one.paths.$name' with linespoints pt 11 ps .5 lw 2 lc rgb '#bf8700' t 'paths alone', \\"
            echo " '$tmp/one.${default}_chosen.$name' with points pt 3 ps 1.2 lw 2 lc rgb '#d1453b' t 'the default'"
        done
        echo "unset multiplot"
    } | draw "$1" "$width,$height"
}

# Two sentences of a scene: which is the fastest to which error; and what the default's error takes of the others.
sentences() { # SCENE X Y NOISE WHAT
    points "$1" "$2" "$3" "$4" >"$tmp/points"
    awk -f "$studies/front.awk" "$tmp/points" >"$tmp/front"
    awk -v what="$5" -v own="$default" -f "$studies/accuracy_sentences.awk" "$tmp/front" "$tmp/points"
}

front_table() { # SCENE X Y NOISE
    echo "| s | error | method | run |"
    echo "|---|---|---|---|"
    points "$1" "$2" "$3" "$4" | awk -f "$studies/front.awk" |
        awk '{ gsub(/_asked/, " --accuracy", $3); gsub(/_mended/, " mended", $3); gsub(/_chosen/, ", the default", $3); gsub(/_/, " ", $4); printf "| %.3g | %.2g %% | %s | %s |\n", $1, $2, $3, $4 }'
}

# Links, error, error of greedy links, floor, in percent, of a scene and a basis, by growing links. Where greedy links leave
# nothing but rounding there is nothing to tell.
floor_points() { # SCENE BASIS
    awk -F , -v scene="$1" -v basis="$2" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == scene && $2 == basis && $at["greedy_l1"] != "-" && $at["greedy_l1"] > 1e-6 {
            print $at["links"], 100 * $at["l1"], 100 * $at["greedy_l1"], ($at["floor_l1"] == "-" ? "-" : 100 * $at["floor_l1"]), $3 }' "$floor" | sort -g
}
floor_chart() {
    local scene i=0
    {
        echo "set multiplot layout 1,3 margins .075,.985,.17,.76 spacing .05,.1"
        echo "set logscale xy; set grid lc rgb '#888888' dt 3; set format y '%g'; set format x '10^{%T}'; set xlabel 'links' offset 0,.5"
        while read -r scene; do
            i=$((i + 1))
            for basis in constant linear; do floor_points "$scene" $basis >"$tmp/floor.$i.$basis"; done
            awk '$4 != "-"' "$tmp/floor.$i.constant" >"$tmp/floor.$i"
            echo "set title '$scene' noenhanced offset 0,-.8"
            [ $i = 1 ] && echo "set key at screen .02,.99 left top maxrows 2 samplen 2; set ylabel 'L1 error, %' offset 1.5,0" || echo "unset key; unset ylabel"
            echo "plot '$tmp/floor.$i.constant' using 1:2 with linespoints pt 7 ps .5 lw 2 lc rgb '#2f81f7' t '$default, constants' noenhanced, \\"
            echo " '$tmp/floor.$i.constant' using 1:3 with linespoints pt 6 ps .6 lw 2 dt 2 lc rgb '#2f81f7' t 'greedy links, constants', \\"
            echo " '$tmp/floor.$i' using 1:4 with lines lw 2 lc rgb '#9a9a9a' t 'best constants, by formula', \\"
            echo " '$tmp/floor.$i.linear' using 1:2 with linespoints pt 5 ps .5 lw 2 lc rgb '#d1453b' t '$default, linear' noenhanced, \\"
            echo " '$tmp/floor.$i.linear' using 1:3 with linespoints pt 4 ps .6 lw 2 dt 2 lc rgb '#d1453b' t 'greedy links, linear'"
        done <"$tmp/floor.scenes"
        echo "unset multiplot"
    } | draw "$pages/accuracy_optimum.svg" 1000,360
}
# The section: what follows for each scene, and how far the default is from the optimum at its worst.
floor_section() {
    printf '## The floor\n\n'
    printf 'How few links would do? Where nothing is in the way and light is known exactly, links can be held against greedy ones, each split being the\none that lowers the true error most, and against the best that constants on squares of any size can do, by formula:\n\n'
    printf '    build/bin/radiosity study greedy\n\n![L1 error over links, a panel per scene, and what is least](accuracy_optimum.svg)\n\n'
    while read -r scene; do
        for basis in constant linear; do floor_points "$scene" $basis | sed "s/^/$basis /"; done | awk -v scene="$scene" -v own="$default" '
            function add(text) { told = told (told == "" ? "" : "; ") text }
            $4 > 0 { times = $3 / $4; if (times > most[$1]) { most[$1] = times; links[$1] = $2 } if (!least[$1] || times < least[$1]) least[$1] = times }
            $1 == "constant" && $5 != "-" { far = $4 / $5; if (!near || far < near) near = far; if (far > wide) wide = far }
            END {
                if ("constant" in most) add(sprintf("constants err by %.2f to %.2f times what as many greedy links do (most with %d links)", least["constant"], most["constant"], links["constant"]))
                if ("linear" in most) add(sprintf("linear elements by %.2f to %.2f times (most with %d)", least["linear"], most["linear"], links["linear"]))
                if (near) add(sprintf("greedy constants by %.2f to %.2f times what the formula allows of many", near, wide))
                if (told != "") printf "- %s: of `%s` %s.\n", scene, own, told
            }'
    done <"$tmp/floor.scenes"
    awk -F , 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $at["greedy_l1"] != "-" && $at["greedy_l1"] <= 1e-6 { if (!($1 in most) || 100 * $at["l1"] > most[$1]) most[$1] = 100 * $at["l1"] }
        END { for (s in most) printf "- %s: greedy links are exact; the default errs by at most %.2g %%.\n", s, most[s] }' "$floor"
    echo
}

chart "$pages/accuracy.svg" seconds l1_faces noise_faces 's of one processor' 'error of faces, %'
chart "$pages/accuracy_cells.svg" seconds_cells l1_cells noise_cells 's of one processor' 'error of cells, %'
chart "$pages/accuracy_l2.svg" seconds_cells l2_cells noise_l2_cells 's of one processor' 'L2 error of cells, %'
chart "$pages/accuracy_rays.svg" rays l1_faces noise_faces 'rays' 'error of faces, %'
chart "$pages/accuracy_worst.svg" seconds worst noise_faces 's of one processor' 'worst large face, %'
chart "$pages/accuracy_links.svg" links l1_cells noise_cells 'links' 'error of cells, %'
chart "$pages/accuracy_memory.svg" memory_mb l1_faces noise_faces 'MB at the peak' 'error of faces, %'
if [ -s "$floor" ]; then
    awk -F , 'NR > 1 && $6 != "-" && $6 > 1e-6 && !seen[$1]++ { print $1 }' "$floor" >"$tmp/floor.scenes"
    floor_chart
fi
{
    page_head "Speed against accuracy" "What does an error cost, and would particles alone, or path tracing alone, be the better choice? Every built-in oracle
has its thresholds swept (those that \`--accuracy\` scales), from 16 times as coarse as they are set to finer; \`$default\` also mended by
particles (\`mended\`), asked for an error by \`--accuracy\`, and as it comes, with links or none as it finds out (*the default*). Particles and paths alone have a number of particles or
of paths instead. Errors are against traced references, as shares of the reflected light: L1 of the means of faces, and
of cells of 1e-4 of the area, which show shadows. Seconds are what a run took of one processor, user and system, without reading and writing: not the
clock's, so that what else the machine does counts for little."
    printf '![Error of faces over seconds, a panel per scene](accuracy.svg)\n\n![Error of cells over seconds, a panel per scene](accuracy_cells.svg)\n\n'
    for name in $names; do
        printf '## %s\n\n' "$name"
        sentences "$name" seconds l1_faces noise_faces faces
        echo
        sentences "$name" seconds_cells l1_cells noise_cells cells
        awk -F , -v scene="$name" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
            $1 == scene && $at["noise_faces"] != "-" { runs++; f = $at["noise_faces"]; c = $at["noise_cells"] } $1 == scene && $at["seconds"] == "-" { late++ }
            END { printf "\n%d runs%s. The noise of the reference, below which no error is told: %.2g %% of faces, %.2g %% of cells.\n\n", runs,
                late ? ", and " late " that took too long" : "", 100 * f, 100 * c }' "$csv"
        printf 'The Pareto front of faces:\n\n'
        front_table "$name" seconds l1_faces noise_faces
        printf '\nOf cells:\n\n'
        front_table "$name" seconds_cells l1_cells noise_cells
        echo
    done
    [ ! -s "$floor" ] || floor_section
    printf '## In other measures\n\n![L2 error of cells over seconds](accuracy_l2.svg)\n\n![The face above a hundredth of the area that is off most, over seconds](accuracy_worst.svg)\n\n![Error of faces over rays](accuracy_rays.svg)\n\n![Error of cells over links](accuracy_links.svg)\n\n![Error of faces over memory](accuracy_memory.svg)\n'
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/accuracy.md"
say "$pages/accuracy.md"
