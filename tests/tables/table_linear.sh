#!/bin/sh
# table_linear.sh - a sentence: what linear elements take off the error of links alone.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export LINKS=no
for basis in constant linear; do
    judge $basis "$radiosity" examples/scenes/cornell.obj --basis $basis --no-correct --no-errors
done
awk "$numbers"'
    { v[$1, $2] = $3 }
    END { printf "In `cornell` links alone are off by %s %% per face with linear elements, by %s %% with constant ones; on cells of 1e-4 of the area by %s and %s %%.\n",
              percent(v["linear", "l1_faces"]), percent(v["constant", "l1_faces"]), percent(v["linear", "l1_cells"]), percent(v["constant", "l1_cells"]) }' "$tmp/rows"
