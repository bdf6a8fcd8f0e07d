#!/bin/sh
# demo.sh BUILD - the main job on real scenes: compile an oracle, solve two scenes, leave solutions and pictures.
# Run by `make demo`; everything it makes is in BUILD/demo.
# SPDX-License-Identifier: MIT
set -eu
cd "$(dirname "$0")/.."
build=${1:-build}
out=$build/demo
oracle=bf_guarded
source=examples/oracles/$oracle.dag
mkdir -p "$out"

echo "1. Compile the oracle"
"$build/bin/dagc" --release=wave -o "$out/$oracle.c" --header "$out/$oracle.h" "$source"
text_lines=$(grep -c '[^[:space:]]' "$source")
c_lines=$(grep -c '[^[:space:]]' "$out/$oracle.c")
nodes=$("$build/bin/dagc" --emit=text "$source" | grep -c '^ *node ')
echo "   $source, $text_lines lines, became $out/$oracle.c, $c_lines lines of C"
# The command was built from the same graph, so what follows runs this very text.
cmp -s "$out/$oracle.c" "$build/gen/oracles/$oracle.c" || { echo "demo: radiosity was built with another $oracle" >&2; exit 1; }

solve() { # NAME VIEW SIZE
    scene=examples/scenes/$1.obj
    "$build/bin/radiosity" solve "$scene" --oracle $oracle -q -o "$out/$1.ply" --faces "$out/$1.csv" \
        --json "$out/$1.json" --image "$out/$1.png" --image-error "$out/$1-error.png" --view "$2" --size "$3"
    "$build/bin/radiosity" solve "$scene" --oracle $oracle -q --mesh --image "$out/$1-mesh.png" --view "$2" --size "$3"
    echo "   $scene:"
    echo "     solution      $out/$1.ply  (the pieces, coloured; for any mesh viewer)"
    echo "     picture       $out/$1.png"
    echo "     mesh picture  $out/$1-mesh.png"
    echo "     error         $out/$1-error.png  (where it is too bright or too dark, as measured)"
    echo "     faces         $out/$1.csv  (mean light of each face)"
    echo "     counts        $out/$1.json"
}
echo "2. Solve two scenes"
solve room 0.4,0.3,1.9:2.4,3.4,0.7 1024x768
solve cornell 0.278,0.273,-0.8:0.278,0.273,1:39 768x768

number() { # SCENE KEY: the number behind "KEY" in the scene's JSON, the first that stands least deep
    value=$(sed -n "s/^\( *\)\"$2\": \([-+.0-9eE]*\),*$/\1|\2/p" "$out/$1.json" | LC_ALL=C sort -s -t '|' -k 1,1 | head -n 1)
    value=${value#*|}
    [ -n "$value" ] || { echo "demo: no \"$2\" in $out/$1.json" >&2; exit 1; }
    echo "$value"
}
say() { # SCENE: three lines of the summary
    awk -v name="$1" -v faces="$(number "$1" faces)" -v leaves="$(number "$1" leaves)" -v links="$(number "$1" links)" \
        -v pairs="$(number "$1" pairs)" -v rays="$(number "$1" rays)" -v emitted="$(number "$1" power_emitted)" \
        -v absorbed="$(number "$1" power_absorbed)" -v lost="$(number "$1" power_imbalance)" \
        -v off="$(sed -n '/"l1_faces"/,/}/s/^ *"high": \([^,]*\).*/\1/p' "$out/$1.json" | head -n 1)" \
        -v threads="$(number "$1" threads)" -v refine="$(number "$1" refine)" -v iterate="$(number "$1" iterate)" 'BEGIN {
        printf "   %s: %d faces became %d pieces; %d decisions left %d links instead of %.0f million pairs.\n",
            name, faces, leaves, pairs, links, leaves * leaves / 1e6
        printf "   %s: the emitters send %.4g W, the surfaces absorb %.4g W; %.1f %% of it is lost or gained.\n",
            name, emitted, absorbed, 100 * (lost < 0 ? -lost : lost)
        printf "   %s: measured by particles, the light of its faces is off by at most %.2g %%.\n", name, 100 * off
        printf "   %s: solved in %.1f s on %d thread%s, with %.1f million shadow rays.\n",
            name, refine + iterate, threads, threads == 1 ? "" : "s", rays / 1e6
    }'
}
echo "3. In short"
echo "   An oracle decides for two surface pieces: link them, split one, or drop the pair. This one has $nodes nodes."
echo "   A link carries light from one piece to another; the fewer links, the faster the solution."
say room
say cornell
echo "   Look at $out/room.png: soft shadows under table and chairs, light from the window only."
echo "   Look at $out/cornell.png: the red and the green wall tint the blocks beside them."
