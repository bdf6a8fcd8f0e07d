#!/bin/sh
# references.sh SCENE - what light tracing says of each cell of a scene (1e-4 of its area). Prints the folder that has it:
# cut.obj, cells.csv, cells.json. Made once per content of the scene and ACCURACY, and kept in CACHE (BUILD/tables); a run
# that was stopped goes on where it was. ACCURACY: the standard error of a cell, mean by area, as a share of the reflected
# light (2%).
# SPDX-License-Identifier: MIT
set -eu
build=${BUILD:-build} cache=${CACHE:-${BUILD:-build}/tables} accuracy=${ACCURACY:-2%}
name=$(basename "$1" .obj)
mkdir -p "$cache"
cutting=$(mktemp -d "$cache/cut.XXXXXX")
trap 'rm -rf "$cutting"' EXIT
"$build/bin/cell_error" cut "$1" "$cutting/cut"
folder=$cache/$name-$(cat "$cutting/cut.obj" "$cutting/cut.mtl" | cksum | tr ' ' -)-$accuracy
mkdir -p "$folder"
if [ ! -s "$folder/cells.json" ]; then
    cp "$cutting/cut.obj" "$cutting/cut.mtl" "$folder"
    echo "$name: tracing a reference of $(grep -c '^f' "$folder/cut.obj") cells to $accuracy, once" >&2
    "$build/bin/radiosity" reference "$folder/cut.obj" -o "$folder/cells.csv" --accuracy "$accuracy" \
        --json "$folder/cells.json" >&2
fi
echo "$folder"
