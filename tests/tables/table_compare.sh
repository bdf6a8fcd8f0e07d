#!/bin/sh
# table_compare.sh - what radiosity compare says of a scene.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
echo "    \$ build/bin/radiosity compare examples/scenes/room.obj        # bf_guarded"
"$radiosity" compare examples/scenes/room.obj >"$tmp/out"
sed 's/^/    /' "$tmp/out"
