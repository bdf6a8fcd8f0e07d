#!/bin/sh
# check_round_trip.sh - meshes that `solve -o` writes are scenes: read back and solved again, the materials, their areas, what they
# reflect and emit are those of the first scene. THOROUGH=1 (a minute): so is what they receive, to 3 % of finer meshes.
# RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
limit=0.3
[ "${THOROUGH:-}" ] && limit=0.02

# A box with a lamp below its ceiling and a screen, two materials with one colour.
cat >box.mtl <<'END'
newmtl floor wall
Kd 0.25 0.5 0.125
newmtl lamp
Kd 0.3
Ke 40 20 10
newmtl screen_2s
Kd 0.7 0.6 0.5
newmtl other
Kd 0.25 0.5 0.125
END
cat >box.obj <<'END'
mtllib box.mtl
v 0 0 0
v 2 0 0
v 2 2 0
v 0 2 0
v 0 0 2
v 2 0 2
v 2 2 2
v 0 2 2
v 0.5 0.5 1.9
v 1.5 0.5 1.9
v 1.5 1.5 1.9
v 0.5 1.5 1.9
v 1.2 0.3 0.2
v 1.2 1.7 0.2
v 1.2 1.7 1.1
v 1.2 0.3 1.1
usemtl floor wall
f 1 2 3 4
usemtl other
f 5 8 7 6
f 1 5 6 2
f 2 6 7 3
usemtl floor wall
f 3 7 8 4
f 4 8 5 1
usemtl lamp
f 9 12 11 10
usemtl screen_2s
f 13 14 15 16
END

# FILE: by material without what stands behind its name: area, and means by area of E, rho and H
sums() {
    awk -F, 'NR > 1 { name = $1 == "" ? "" : $2; sub(/ side$/, "", name); area = $3 * (name ~ /_2s$/ && two ? 2 : 1)
                      a[name] += area; for (k = 4; k <= 12; k++) sum[name, k] += area * $k }
             END { for (name in a) { printf "%s,%.9g", name, a[name]; for (k = 4; k <= 12; k++) printf ",%.9g", sum[name, k] / a[name]; print "" } }' \
        "two=$2" "$1" | sort
}
# FILE FILE: of sums, to seven digits; H, if it is compared, to 3 %
compare() {
    paste -d, "$1" "$2" | awk -F, -v "last=${THOROUGH:+11}" '
        function off(x, y) { return x > y ? x - y : y - x }
        $1 != $12 { print "materials " $1 " and " $12; bad = 1 }
        { for (k = 2; k <= (last ? last : 8); k++) if (off($k, $(k + 11)) > (k <= 8 ? 2e-7 : 0.03) * ($k + $(k + 11)) / 2)
              { print $1 ": column " k " is " $k " and " $(k + 11); bad = 1 } }
        END { exit bad || NR != 4 }'
}

solve() { "$radiosity" solve "$@" -q --no-correct --no-errors --oracle ff --set "limit=$limit" 2>err; }
for name in again.obj again.glb again.gltf; do
    count=$((count + 1))
    if solve box.obj -o "$name" --faces first.csv && solve "$name" --faces second.csv && ! grep -v "more is absorbed" err; then
        sums first.csv 1 >first
        sums second.csv 0 >second
        compare first second || failed "$name is not box.obj"
    else
        failed "$name is not solved"
    fi
done
finish "round trips"
