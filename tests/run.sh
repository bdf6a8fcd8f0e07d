#!/usr/bin/env bash
# run.sh BUILD TEST... - run the suites, as many at a time as there are processors, then say how long each took and how
# many passed. What a suite prints comes in one piece when it ends. BUILD/times keeps the seconds, so that the next run
# starts with the longest, and no processor is idle at the end.
# SPDX-License-Identifier: MIT
set -u
build=$1
shift
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
export DAGC="$build/bin/dagc" RADIOSITY="$build/bin/radiosity" RUN_TMP="$tmp"
export CK_TIMEOUT_MULTIPLIER="${CK_TIMEOUT_MULTIPLIER:-10}" # suites end by themselves: what hangs is found, what waits is not
export OMP_WAIT_POLICY=passive # threads that wait would keep the suite beside them from the processor
# Oracles and plugins that suites have compiled decide the same unoptimised, to the bit, and are compiled several times as soon.
if [ -z "${THOROUGH-}" ]; then
    printf '#!/bin/sh\nexec %s "$@" -O0\n' "${CC:-cc}" >"$tmp/cc" && chmod +x "$tmp/cc" && export CC="$tmp/cc"
fi
times=$build/times${THOROUGH:+-thorough}
[ -f "$times" ] || cp "$(dirname "$0")/times" "$times" # of a first run: what took longest elsewhere
for suite; do
    echo "$(awk -v suite="$(basename "$suite")" '$3 == suite { seconds = $1 } END { print seconds + 0 ? seconds : 1000 }' "$times") $suite"
done | sort -rn | cut -d ' ' -f 2- | xargs -n 1 -P "$(nproc 2>/dev/null || echo 1)" bash -c '
    name=$(basename "$1") TIMEFORMAT="%R %U %S"
    echo "== $name" >"$RUN_TMP/$name.log"
    { time if "$1" >>"$RUN_TMP/$name.log" 2>&1; then
        : >"$RUN_TMP/$name.passed"
    fi; } 2>"$RUN_TMP/$name.time"
    cat "$RUN_TMP/$name.log"' run
for file in "$tmp"/*.time; do
    name=$(basename "$file" .time)
    awk -v name="$name" '{ printf "%6.1f %6.1f %s\n", $1, $2 + $3, name }' "$file"
done | sort -rn >"$times.new" && mv "$times.new" "$times"
echo "seconds of the clock and of a processor per suite:"
cat "$times"
awk '{ sum += $2 } END { printf "%.0f s of a processor in all\n", sum }' "$times"
grep -h '^accuracy ' "$tmp"/*.log
skipped=$(grep -h 'skipped[:,]' "$tmp"/*.log | sort -u)
[ -z "$skipped" ] || echo "$skipped"
passed=$(find "$tmp" -name '*.passed' | wc -l)
failed=$(($# - passed))
for log in "$tmp"/*.log; do
    [ -e "${log%.log}.passed" ] || echo "failed: $(basename "$log" .log)"
done
echo "$passed passed, $failed failed, $(printf '%s' "$skipped" | grep -c '') skipped in part"
[ "$failed" = 0 ]
