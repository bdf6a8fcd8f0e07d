#!/bin/sh
# fuzz.sh BUILD SECONDS - build/fuzz_dagc on mutated oracles, golden files and regressions, for so long.
# The corpus stays in BUILD/corpus and grows from run to run; an input that crashes, leaks or takes more
# than FUZZ_TIMEOUT (2) seconds is left in BUILD/found. Run by `make fuzz`, from the top folder.
# SPDX-License-Identifier: MIT
set -u
build=$1 seconds=$2
seeds=$build/seeds corpus=$build/corpus found=$build/found
rm -rf "$seeds" "$found"
mkdir -p "$seeds" "$corpus" "$found"

# Seeds: what a golden file prints is no part of its input.
for file in examples/oracles/*.dag examples/user_tool/*.dag runtime/catalog.dag tests/dagc/*.dag tests/dagc/*/*.dag; do
    sed '/^# \(exit\|stderr\|stdout\):/,$d' "$file" >"$seeds/$(echo "$file" | tr / _)"
done
echo '# run: --emit=catalog FILE' >>"$seeds/runtime_catalog.dag"

# C headers, behind a graph that reaches every tool of a small catalog.
for file in runtime/tools/*.h runtime/kernel/*.h runtime/discussion.h examples/poisson/*.h tests/dagc/runtime/*.h tests/dagc/runtime/*/*.h; do
    { sed '/^# \(exit\|stderr\|stdout\):/,$d' tests/dagc/emit_standalone.dag; printf '\n// header:\n'; cat "$file"; } >"$seeds/$(echo "$file" | tr / _)"
done

# The words: those the parser asks for, those the catalog declares, and the marks.
{
    grep -oh '"[a-z_]\{2,\}"' dagc/read/parse*.c
    grep -ohE '[a-z_]{3,}' runtime/catalog.dag tests/dagc/test_catalog.dag | sed 's/.*/"&"/'
    printf '"%s"\n' '->' '>=' '\x22' '{' '}' '(' ')' ' = ' ';' '|' 'in [0, inf]' 'otherwise -> stop; ' 'start a; ' \
        'node a = ' ') exits (a, b) ' 'import \x22library/branches.dag\x22;' '# run: --catalog test_catalog.dag' \
        '#include \x22catalog.h\x22' '#define ' '#undef ' '#pragma once' '#if ' '#ifdef ' '#endif' 'typedef ' 'static inline ' \
        'struct ' 'enum ' '/*' '*/' '\x5c\x0a' '##'
} | sort -u >"$build/words"

ASAN_OPTIONS=detect_leaks=1:detect_stack_use_after_return=1 UBSAN_OPTIONS=print_stacktrace=1 \
    "$build/fuzz_dagc" -max_total_time="$seconds" -timeout="${FUZZ_TIMEOUT:-2}" -rss_limit_mb=1024 -max_len=16384 \
    -dict="$build/words" -artifact_prefix="$found/" -print_final_stats=1 "$corpus" "$seeds" >"$build/log" 2>&1
status=$?
seconds=$(sed -n "s/^Done .* in \([0-9]*\) second.*/\1/p" "$build/log")
executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$build/log")
echo "fuzz_dagc: ${executions:-no} executions in ${seconds:-?} s, $(ls "$seeds" | wc -l) seeds, $(ls "$corpus" | wc -l) inputs kept"
[ $status = 0 ] && [ "${executions:-0}" -gt 0 ] && exit 0
grep -v '^#[0-9]' "$build/log" | tail -n 60
echo "the input is in $found; dagc on it, or $build/fuzz_dagc $found/..., shows it again"
exit 1
