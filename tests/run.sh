#!/bin/sh
# run.sh BUILD TEST... - run the suites, as many at a time as there are processors, then say how many passed.
# What a suite prints comes in one piece when it ends.
# SPDX-License-Identifier: MIT
set -u
build=$1
shift
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
export DAGC="$build/bin/dagc" RADIOSITY="$build/bin/radiosity" RUN_TMP="$tmp"
printf '%s\n' "$@" | xargs -n 1 -P "$(nproc 2>/dev/null || echo 1)" sh -c '
    name=$(basename "$1")
    echo "== $name" >"$RUN_TMP/$name.log"
    if "$1" >>"$RUN_TMP/$name.log" 2>&1; then
        : >"$RUN_TMP/$name.passed"
    fi
    cat "$RUN_TMP/$name.log"' run
passed=$(find "$tmp" -name '*.passed' | wc -l)
failed=$(($# - passed))
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
