#!/usr/bin/env bash
# bounds.sh - what is promised of errors against what they are: constants on n x n elements against the best constants, in
# three norms [Arvo, Torrance, Smits 1994, figure 4]; and what a wrong reflectance does to the light, as the account of error
# has it (likely, at the most) and as it is when all reflectances of the file are made so much larger, or smaller.
#
# A wrong reflectance is a perturbed matrix: the account has its effect from norms of the operator. Coarse links will do, for
# both sides of a comparison have the same. LIMIT: seconds for one run (60).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LIMIT=${LIMIT:-60}
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
rows_open bounds scene,method,run,binary n,best,galerkin,collocation,likely,most,measured,norm,inverse_most,inverse_found

# ---- projections

"$radiosity" study arvo -q --csv "$tmp/arvo.csv"
projection() { # N NORM
    awk -F , -v n="$1" -v norm="$2" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == n { print "n", n; print "best", $at[norm "_best"]; print "galerkin", $at[norm "_galerkin"]; print "collocation", $at[norm "_collocation"] }' "$tmp/arvo.csv"
}
for norm in l1 l2 linf; do
    for n in 1 2 3 4 5 6 7 8 10 12 14 16 20 24 32 40 48 56 64; do
        measure "lamp and wall,$norm,n = $n,$binary" projection $n $norm
    done
done

# ---- reflectances

# The scene with each Kd more by X, within [0, .99].
perturbed() { # SCENE X: to $tmp/other.obj
    local materials
    materials=$(dirname "$1")/$(awk '$1 == "mtllib" { print $2; exit }' "$1")
    awk -v x="$2" '$1 == "Kd" { for (i = 2; i <= NF; i++) { $i += x; $i = $i < 0 ? 0 : $i > .99 ? .99 : $i } } { print }' "$materials" >"$tmp/other.mtl"
    awk '$1 == "mtllib" { print "mtllib other.mtl"; next } { print }' "$1" >"$tmp/other.obj"
}
# Sum of area times |difference of B| of two tables of faces, over what the first reflects.
difference() { # FACES.csv FACES.csv
    awk -F , 'FNR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { for (k = 0; ("B_" k) in at; k++)
              if (FNR == NR) { b[$1, k] = $at["B_" k]; light += $at["area"] * ($at["B_" k] - $at["E_" k]) }
              else { d = $at["B_" k] - b[$1, k]; sum += $at["area"] * (d < 0 ? -d : d) } }
        END { printf "%.6g\n", sum / light }' "$1" "$2"
}
input() { # SCENE X
    local how sign
    # shellcheck disable=SC2046
    how="--threads 1 -q --oracle $default $(awk -v SCALE=16 -f "$studies/thresholds.awk" "examples/oracles/$default.dag") --no-correct --basis constant"
    # shellcheck disable=SC2086
    timed "$radiosity" solve "$1" $how --errors=all --reflectance-error "$2" --json "$tmp/json" --faces "$tmp/faces.csv" || return
    : >"$tmp/differences"
    for sign in '' -; do
        perturbed "$1" "$sign$2"
        # shellcheck disable=SC2086
        timed "$radiosity" solve "$tmp/other.obj" $how --no-errors --faces "$tmp/other.csv" || return
        difference "$tmp/faces.csv" "$tmp/other.csv" >>"$tmp/differences"
    done
    echo "measured $(sort -g "$tmp/differences" | tail -n 1)"
    awk -f "$tables/json.awk" "$tmp/json" | awk '
        { v[$1] = $2 }
        END {
            a = "error.account."; light = v[a "reflected.l1"]
            print "likely", v[a "boundary.estimate.l1"] / light; print "most", v[a "boundary.bound.l1"] / light
            print "norm", v[a "operator.norm_rows"]; print "inverse_most", v[a "operator.inverse_bound"]; print "inverse_found", v[a "operator.inverse_found"]
        }'
}
for name in ${SCENES_OF_STUDIES:-cornell furnace}; do
    file=$(scene "$name")
    [ -n "$file" ] || { say "$name is not here" && continue; }
    for x in .002 .005 .01 .02 .05; do
        measure "$name,reflectance,off by $x,$binary" input "$file" $x
    done
done
rows_of_binary "$pages/bounds.csv"

# ---- the page
names=$(awk -F , 'NR > 1 && $2 == "reflectance" && !seen[$1]++ { print $1 }' "$pages/bounds.csv")
points() { # FIRST SECOND X Y: "x y" of rows with these first two fields
    awk -F , -v scene="$1" -v method="$2" -v x="$3" -v y="$4" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { off = $3; sub(/^off by /, "", off) }
        $1 == scene && $2 == method && $at[y] != "-" { print (x == "off" ? off : $at[x]), $at[y] * (x == "off" ? 100 : 1) }' "$pages/bounds.csv" | sort -g
}
{
    echo "set multiplot layout 1,4 margins .055,.99,.16,.8 spacing .045,.1"
    echo "set logscale xy; set grid lc rgb '#888888' dt 3; set format '%g'; set xlabel 'n'; set xrange [1:64]; set xtics (1, 4, 16, 64)"
    for norm in l1 l2 linf; do
        for column in best galerkin collocation; do points "lamp and wall" $norm n $column >"$tmp/$norm.$column"; done
        [ $norm = l1 ] && echo "set key at screen .02,.99 left top maxrows 1 width 1 samplen 2; set ylabel 'error' offset 1,0" || echo "unset key; unset ylabel"
        echo "set title '${norm^}' offset 0,-.7"
        echo "plot '$tmp/$norm.best' with lines lw 2 lc rgb '#2da44e' t 'best constants', '' using 1:(2*\$2) with lines lw 1.5 dt 2 lc rgb '#2da44e' t 'twice that', \\"
        echo "  '$tmp/$norm.galerkin' with linespoints pt 7 ps .4 lw 2 lc rgb '#2f81f7' t 'Galerkin', '$tmp/$norm.collocation' with linespoints pt 5 ps .4 lw 1.5 lc rgb '#bf8700' t 'collocation'"
    done
    echo "set title 'reflectances off, ${names//$'\n'/, }' noenhanced offset 0,-.7; set xlabel 'by'; set xrange [.0018:.055]; set xtics (.002, .005, .01, .02, .05)"
    echo "set key inside right bottom maxrows 4 width -2 samplen 2 opaque fc rgb '#fefefe'; set ylabel 'light per face off, %' offset 1.5,0"
    printf 'plot '
    comma=
    title=t
    for name in $names; do
        for column in likely most measured; do points "$name" reflectance off $column >"$tmp/$name.$column"; done
        printf "%s '%s' with lines lw 2 lc rgb '#d1453b' %s, '%s' with lines lw 1.5 dt 2 lc rgb '#a371f7' %s, '%s' with points pt 7 ps .6 lc rgb '#9a9a9a' %s" \
            "$comma" "$tmp/$name.most" "$title 'at the most'" "$tmp/$name.likely" "$title 'likely'" "$tmp/$name.measured" "$title 'measured'"
        comma=, title='notitle #'
    done
    echo
    echo "unset multiplot"
} | sed "s/ notitle # '[a-z ]*'/ notitle/g" | draw "$pages/bounds.svg" 1100,320
{
    page_head "Bounds" "Are errors within what theory allows them, and how near to it? Left, in three norms: what constants over n x n elements leave of the light
of a square lamp on a wall (\`radiosity study arvo\`). Right: how far the light is off when reflectances are, as \`--errors=all\` says
it and as it is."
    printf '![Errors of projections in three norms, and light over wrong reflectances](bounds.svg)\n\n'
    awk -F , '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $1 == "lamp and wall" && $at["best"] > 0 {
            g = $at["galerkin"] / $at["best"]; c = $at["collocation"] / $at["best"]
            if (g > galerkin[$2]) galerkin[$2] = g
            if (c > collocation[$2]) collocation[$2] = c }
        END {
            printf "Galerkin'"'"'s projection is at most %.3f (L1), %.3f (L2), %.3f (Linf) times as far off as the best constants, where theory allows 2, 1 and 2. ", galerkin["l1"], galerkin["l2"], galerkin["linf"]
            printf "Collocation, of which nothing is promised in L1 and L2, is up to %.1f, %.1f and %.1f times as far off.\n\n", collocation["l1"], collocation["l2"], collocation["linf"]
        }' "$pages/bounds.csv"
    echo "| scene | each reflectance off by | measured | likely | at the most | measured over the bound |"
    echo "|---|---|---|---|---|---|"
    awk -F , '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        $2 == "reflectance" && $at["most"] != "-" {
            x = $3; sub(/^off by /, "", x); r = $at["measured"] / $at["most"]
            printf "| %s | %g | %.3g %% | %.3g %% | %.3g %% | %.2f |\n", $1, x, 100 * $at["measured"], 100 * $at["likely"], 100 * $at["most"], r
            n++; above += r > 1.0001; if (low == "" || r < low) low = r; if (r > high) high = r
            if (!($1 in norm)) scene[++k] = $1
            norm[$1] = $at["norm"]; most[$1] = $at["inverse_most"]; found[$1] = $at["inverse_found"] }
        END {
            if (!n) exit
            printf "\nOf %d runs %s above the bound; what was measured is %.2f to %.2f of it.\n\n", n, above ? above " are" : "none is", low, high
            for (i = 1; i <= k; i++) printf "`%s`: the operator'"'"'s norm by rows is %.3f, that of 1/(1-K) at the most %.3f, found %.3f.\n", scene[i], norm[scene[i]], most[scene[i]], found[scene[i]]
        }' "$pages/bounds.csv"
} >"$tmp/page.md"
mv "$tmp/page.md" "$pages/bounds.md"
say "$pages/bounds.md"
