#!/bin/sh
# table_run.sh - what a run prints.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
echo "    \$ build/bin/radiosity solve examples/scenes/room.obj --image room.png"
"$radiosity" solve examples/scenes/room.obj --image "$tmp/room.png" >"$tmp/out"
sed 's/^/    /' "$tmp/out"
