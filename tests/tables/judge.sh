#!/bin/sh
# judge.sh RADIOSITY SCENE [OPTION...] - what `RADIOSITY solve SCENE OPTION...` costs, and how far it is from the truth.
# Prints names and values, line by line: those of cell_error compare, and
#
#     links, rays_links, rays_mending, rays_errors, rays (all of these), seconds (without reading and writing)
#     particles_cells    what l1_cells would be of particles alone, from as many rays: the noise that the reference's
#                        particles had on cells, brought to that number, and the reference's own noise
#     links_l1_faces, links_l1_cells, links_power    of the links alone, unless LINKS=no
#
# The command may be an older one: all is taken from its files.
# SPDX-License-Identifier: MIT
set -eu
here=$(dirname "$0") build=${BUILD:-build}
radiosity=$1 scene=$2
shift 2
reference=$(sh "$here/references.sh" "$scene")
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
"$radiosity" solve "$scene" -q --json "$tmp/json" --faces "$tmp/faces.csv" -o "$tmp/mesh.ply" "$@" >&2
"$build/bin/cell_error" compare "$scene" "$reference/cells.csv" "$tmp/faces.csv" "$tmp/mesh.ply"
for file in "$tmp/json" "$reference/cells.json"; do
    awk -f "$here/json.awk" "$file" | sed "s,^,$(basename "$file") ,"
done | awk '
    { value[$1 "." $2] = $3 }
    END {
        mending = value["json.correction.rays"] + 0; errors = value["json.error.rays"] + 0
        links = value["json.rays"] + value["json.scale.rays"]; all = links + mending + errors
        print "links", value["json.links"]; print "rays_links", links; print "rays_mending", mending
        print "rays_errors", errors; print "rays", all
        print "seconds", value["json.seconds.build"] + value["json.seconds.refine"] + value["json.seconds.iterate"] \
            + value["json.scale.seconds"] + value["json.correction.seconds"] + value["json.error.seconds"]
        if (all > 0)
            print "particles_cells", sqrt(2 / 3.14159265 * (value["cells.json.standard_error.both"] ^ 2 \
                + value["cells.json.standard_error.particles"] ^ 2 * value["cells.json.rays.particles"] / all))
    }'
[ "${LINKS:-yes}" = yes ] || exit 0
"$radiosity" solve "$scene" -q --no-correct --no-errors --faces "$tmp/faces.csv" -o "$tmp/mesh.ply" "$@" >&2
"$build/bin/cell_error" compare "$scene" "$reference/cells.csv" "$tmp/faces.csv" "$tmp/mesh.ply" >"$tmp/alone"
awk '$1 ~ /^(l1_faces|l1_cells|power)$/ { print "links_" $1, $2 }' "$tmp/alone"
