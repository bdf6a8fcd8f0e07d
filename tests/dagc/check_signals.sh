#!/bin/sh
# check_signals.sh - runs of dagc that SIGINT, SIGTERM or SIGHUP ends, or SIGKILL: old outputs or new ones, whole, and nothing
# left behind, also of what the compiler makes. DAGC names the command. With THOROUGH 50 runs of -o are stopped, not 12.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

mkdir scratch o new old
export TMPDIR=$tmp/scratch
oracle=$top/examples/oracles/bf.dag

wrong() {
    bad=$((bad + 1))
    echo "failed: $*"
}

# Whether a process does anything still; one that nobody has asked about yet (Z) has ended.
runs() {
    [ -d "/proc/$1" ] && ! grep -q '^State:.*Z' "/proc/$1/status" 2>/dev/null
}

# ---- a compiler that takes its time
printf '#!/bin/sh\nsleep 0.6\nexec cc "$@"\n' >cc && chmod +x cc
export CC=$tmp/cc
for run in INT:130 TERM:143 HUP:129; do
    signal=${run%:*} status=${run#*:}
    count=$((count + 1))
    stopped_by "$signal" 0.2 "$dagc" -Wno-all --prove "$oracle" >said 2>&1
    got=$?
    [ $got = "$status" ] || wrong "--prove by $signal: exit $got"
    left=$(ls -A scratch)
    [ -z "$left" ] || wrong "--prove by $signal left $left"
    rm -rf scratch/*
done

# A signal that is ignored, as nohup has it, stays so.
count=$((count + 1))
(trap '' HUP && exec "$dagc" -Wno-all --prove "$oracle") >said 2>&1 &
job=$!
catches $job
sleep 0.2
kill -HUP $job
wait $job && grep -q "^bf: proved" said || wrong "--prove under nohup: $(tail -n 1 said)"
[ -z "$(ls -A scratch)" ] || wrong "--prove under nohup left $(ls -A scratch)"
unset CC

# ---- a Graphviz that takes its time ends with whoever asked for it, however that is ended
if [ "$(uname)" = Linux ]; then
    mkdir slow
    printf '#!/bin/sh\necho $$ >%s/dot.pid\nexec sleep 60\n' "$tmp" >slow/dot && chmod +x slow/dot
    count=$((count + 1))
    PATH=$tmp/slow:$PATH "$dagc" -Wno-all --emit=svg -o o/a.svg "$oracle" >said 2>&1 &
    job=$!
    for i in $(seq 150); do [ -s dot.pid ] || sleep 0.2; done
    kill -KILL $job
    dot=$(cat dot.pid)
    for i in $(seq 150); do ! runs "$dot" || sleep 0.2; done
    ! runs "$dot" || wrong "dot goes on when dagc is killed: $(head -n 3 "/proc/$dot/status" | tr '\n\t' '  ')"
    rm -f o/*
fi

# ---- -o, stopped at any moment
set -- -Wno-all --instrument -o o/a.c --header o/a.h "$top/examples/oracles/power.dag"
begin=$(date +%s.%N)
check "a run to compare with" "$dagc" "$@"
whole=$(echo "$begin $(date +%s.%N)" | awk '{ print $2 - $1 }')
cp o/* new
for file in a.c a.h; do echo "old $file" >old/$file; done
runs=$([ -n "${THOROUGH-}" ] && echo 50 || echo 12)
ended=0 run=0
for after in $(awk -v n="$runs" -v whole="$whole" 'BEGIN { srand(7); for (i = 0; i < n; i++) printf "%.4f ", 0.001 + whole * rand() }'); do
    count=$((count + 1)) run=$((run + 1))
    signal=$(echo "TERM INT HUP KILL" | cut -d ' ' -f $((run % 4 + 1)))
    cp old/* o
    # Of a shell's own, which tells the terminal who was killed.
    sh -c 'timeout -s "$@"; exit $?' sh "$signal" "$after" "$dagc" "$@" >said 2>&1 && ended=$((ended + 1))
    for file in a.c a.h; do
        cmp -s o/$file old/$file || cmp -s o/$file new/$file || wrong "$signal after $after s: $file is neither old nor new"
    done
    # Nobody can tidy up after SIGKILL.
    [ "$signal" != KILL ] || rm -f o/*.??????
    [ "$signal" = KILL ] || { cmp -s o/a.c old/a.c && cmp -s o/a.h old/a.h; } || { cmp -s o/a.c new/a.c && cmp -s o/a.h new/a.h; } ||
        wrong "$signal after $after s: one file is new"
    [ "$(ls -A o | wc -l)" = 2 ] || wrong "$signal after $after s left $(ls -A o)"
    rm -f o/*.??????
done
echo "stopped at random: $ended of $runs had ended before"
finish signals
