#!/bin/sh
# run.sh BUILD TEST... - run the suites, then say how many passed.
# SPDX-License-Identifier: MIT
set -u
build=$1
shift
passed=0 failed=0
for t; do
    echo "== $(basename "$t")"
    if DAGC="$build/bin/dagc" RADIOSITY="$build/bin/radiosity" "$t"; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
    fi
done
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
