#!/bin/sh
# table_tune.sh - what radiosity tune finds for the default's parameters, and whether it carries over to scenes left out.
# TUNE_SECONDS: when to end (1500).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
set -- examples/scenes/cornell.obj examples/scenes/room.obj examples/scenes/maze_8.obj tests/runtime/panels.obj
echo "    \$ build/bin/radiosity tune $default $*"
status=0
"$radiosity" tune "$default" "$@" --limit-seconds "${TUNE_SECONDS:-1500}" >"$tmp/out" || status=$?
# 3: it does not carry over, which is a result, too
[ $status = 0 ] || [ $status = 3 ] || exit $status
grep -v '^fit [0-9]' "$tmp/out" | sed 's/^\(.\)/    \1/'
