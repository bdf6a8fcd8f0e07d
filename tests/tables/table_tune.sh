#!/bin/sh
# table_tune.sh - what radiosity tune finds for the default's parameters, and whether it carries over to scenes left out.
# TUNE_SECONDS: when to end (1500).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
default=$("$radiosity" oracles | sed -n 's/^\([a-z_]*\) (default).*/\1/p')
scenes="examples/scenes/cornell.obj examples/scenes/room.obj examples/scenes/maze_8.obj examples/scenes/maze_16.obj examples/scenes/td.obj tests/runtime/panels.obj"
parameters="energy bend shadow noise hidden spot product"
set -- --cost time --evaluations 40 --limit-seconds "${TUNE_SECONDS:-1500}"
for parameter in $parameters; do
    set -- "$@" --param "$parameter"
done
echo "    \$ build/bin/radiosity tune $default $scenes $*"
status=0
# shellcheck disable=SC2086
"$radiosity" tune "$default" $scenes "$@" >"$tmp/out" || status=$?
# 3: it does not carry over, which is a result, too
[ $status = 0 ] || [ $status = 3 ] || exit $status
grep -v '^fit [0-9]' "$tmp/out" | sed 's/^\(.\)/    \1/'
