#!/bin/sh
# table_factors.sh - what a run prints that makes a matrix of view factors, of a room with a turned box; its seconds are replaced by
# those of the processor, which say the same on a busy machine.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
"$build/bin/factor_rays" make 32 8 30 "$tmp/room.obj" >&2
echo "    \$ build/bin/radiosity viewfactors room.obj --format coo -o room.coo"
"$build/bin/cost_of" "$tmp/cost" 3600 "$radiosity" viewfactors "$tmp/room.obj" --threads 1 --format coo -o "$tmp/room.coo" >"$tmp/out"
sed 's/; refine .*//; s/^/    /' "$tmp/out"
awk '{ v[$1] = $2 } END { printf "    (%.1f s of one processor, writing included, and %.0f MB)\n", v["seconds"], v["memory_mb"] }' "$tmp/cost"
