#!/bin/sh
# table_factors.sh - what a run prints that makes a matrix of view factors, of a room with a turned box.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
"$build/bin/factor_rays" make 32 8 30 "$tmp/room.obj" >&2
echo "    \$ build/bin/radiosity viewfactors room.obj --format coo -o room.coo"
"$radiosity" viewfactors "$tmp/room.obj" --format coo -o "$tmp/room.coo" >"$tmp/out"
sed 's/^/    /' "$tmp/out"
