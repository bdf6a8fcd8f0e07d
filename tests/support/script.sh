# script.sh - what all scripts that check a command share: they find themselves in an empty folder, $tmp, that goes when they
# end; they count what they check and what failed, and end with `finish NAME`. Read by the lib.sh of their folders.
# SPDX-License-Identifier: MIT
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 2
count=0 bad=0

finish() { # NAME
    echo "$1: $count checks, $bad failed"
    [ "$bad" = 0 ]
}

# What is ended by a signal is ended when it can tell so, however long it takes to start here: under a sanitizer, on a busy machine.
# PID: until that command, one of ours, catches SIGTERM; a minute at most.
catches() {
    for _ in $(seq 600); do
        caught=$(sed -n 's/^SigCgt:[[:space:]]*/0x/p' "/proc/$1/status" 2>/dev/null)
        [ -n "$caught" ] || return 0 # it has ended
        [ $((caught >> 14 & 1)) = 0 ] || return 0
        sleep 0.05
    done
}
# SIGNAL SECONDS COMMAND...: it, and so many seconds after it catches signals the signal; returns its status. It is killed if
# that did not end it within a minute.
stopped_by() {
    signal_of=$1 after_of=$2
    shift 2
    env --default-signal=INT,HUP "$@" & # a shell's jobs ignore the first, and under nohup all the second
    job_of=$!
    catches $job_of
    sleep "$after_of"
    kill -s "$signal_of" $job_of 2>/dev/null
    for _ in $(seq 600); do
        kill -0 $job_of 2>/dev/null || break
        sleep 0.1
    done
    kill -KILL $job_of 2>/dev/null
    wait $job_of 2>/dev/null # a shell tells who was killed
}
