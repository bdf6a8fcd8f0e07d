#!/bin/sh
# check_asked.sh - `radiosity solve --accuracy`: the error that is asked for is kept, as particles say that nothing of the
# solution comes from; by few steps; and what ends it before. RADIOSITY names the command.
# Once is enough: it is about numbers.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

value() { awk -f "$top/tests/tables/json.awk" json | awk -v name="$1" '$1 == name { print $2 }'; }
asked() { # SCENE OPTION...: solve
    "$radiosity" solve "$@" --faces faces.csv --json json >out 2>err
    result=$?
}
# NAME COLUMN LIMIT: of the errors of faces that `error` finds (%), the modulus; the reference's noise is a part of them
errs_by() {
    count=$((count + 1))
    "$radiosity" error faces.csv ref.csv 2>&1 | awk -v column="$2" -v limit="$3" '
        $1 == "all" { e = $column < 0 ? -$column : $column; found = 1 }
        END { if (!found || e > limit) { print "off by", e; exit 1 } }' >said || failed "$1: $(cat said), $3 % asked for"
}

panels=$top/tests/runtime/panels.obj
for file in "$scenes/cornell.obj" "$panels"; do
    name=$(basename "$file")
    check "reference of $name" "$radiosity" reference "$file" -o ref.csv --accuracy 0.1% -q
    for norm in l1:0.4 power:0.5; do
        asked "$file" --accuracy $norm%
        check "$name $norm: kept" sh -c "[ $result = 0 ] && grep -q '^accuracy .* kept: ' out"
        case $norm in
            l1:*) column=3 told=l1_faces ;;
            *) column=2 told=power ;;
        esac
        errs_by "$name $norm" $column "${norm#*:}"
        # What is told is kept by the interval's end.
        check "$name $norm: the interval" awk -v low="$(value error.$told.low)" -v high="$(value error.$told.high)" -v wanted="${norm#*:}" '
            BEGIN { exit !(high != "" && high <= wanted / 100 && low >= -wanted / 100) }'
        # Each step that did not do is followed by one of half as many rays again; looks are a small part.
        check "$name $norm: few steps" awk -v all="$(value accuracy.rays)" -v mended="$(value correction.rays)" '
            BEGIN { exit !(all > 0 && mended > 0 && all < 6 * mended) }'
    done
done

# Dark faces are asked by paths once, not at each look: in panels they take a million rays.
asked "$panels" --accuracy l1:1%
check "dim faces are asked once" awk -v all="$(value accuracy.rays)" -v mended="$(value correction.rays)" 'BEGIN { exit !(mended > 1e6 && all < 1.5 * mended) }'

# Leaves are measured where they are shown, and faces come out the same.
asked "$scenes/cornell.obj" --accuracy l1:1%
cp faces.csv alone.csv
asked "$scenes/cornell.obj" --accuracy l1:1% --image-error error.png --size 64x48
check "leaves and faces" sh -c "[ $result = 0 ] && [ -s error.png ] && cmp faces.csv alone.csv"

# So fine a light is made of no more leaves than places need, however many particles come.
asked "$scenes/cornell.obj" --accuracy l1:0.2%
check "leaves" awk -v mb="$(value peak_memory_mb)" 'BEGIN { exit !(mb > 0 && mb < 300) }'

# What ends it before.
asked "$scenes/room.obj" --accuracy l1:0.01% --limit-seconds 2
check "stopped by time" sh -c "[ $result = 3 ] && grep -q 'NOT kept, stopped by time' out"
finish asked
