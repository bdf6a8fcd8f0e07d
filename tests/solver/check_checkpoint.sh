#!/usr/bin/env bash
# check_checkpoint.sh - solve --checkpoint and --restart: the same bits after being killed at any time, on any number of threads,
# whatever number of processes wrote the file; radiosities of several to 1e-12 of those of one; a file that is damaged, cut short or of other work is refused and stays; a disk
# that is full leaves the last good file, and so does a network that is cut between two processes (as root: in two namespaces).
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/support/mpi.sh
. "$top/tests/support/mpi.sh"
quietly=into_files
scene=$scenes/room.obj
if "$radiosity" solve "$scene" --restart none.h5 2>&1 | grep -q "built without HDF5"; then
    check "without HDF5 it says how to have it" [ "$("$radiosity" solve "$scene" -q --checkpoint c.h5 2>&1 | grep -c "make HDF5=1, package libhdf5-dev")" = 1 ]
    "$radiosity" solve "$scene" -q --checkpoint c.h5 >out 2>err
    check "and ends with 2" [ $? = 2 ]
    echo "checkpoint: skipped: built without HDF5 (make HDF5=1)"
    finish checkpoint
    exit
fi
value() { sed -n "s/.*\"$1\": \\([^,]*\\),*$/\\1/p" "$2" | tail -n 1; }
same_of() { # NAME FILE.json OTHER.json OF...
    local name=$1 file=$2 other=$3 of
    shift 3
    for of in "$@"; do
        check "$name: the same $of" alike "$(value "$of" "$other")" "$(value "$of" "$file")"
    done
}
same() { # NAME FILE.json: the answer is that of whole.json
    same_of "$1" "$2" whole.json link_fingerprint particle_fingerprint power_absorbed passes
}
# NAME FILE.json N: of N processes. Sums of several are rounded otherwise: to 1e-12 the answer is that of whole.json, to the bit that
# of as many which nobody has stopped, N.json.
same_on() {
    same_of "$1" "$2" whole.json link_fingerprint particle_fingerprint passes
    same_of "$1" "$2" "$3.json" power_absorbed
    check "$1: power_absorbed to 1e-12" within "$(value power_absorbed whole.json)" "$(value power_absorbed "$2")" 1e-12
}

check "at one go" "$radiosity" solve "$scene" -q --json whole.json
check "with a checkpoint" "$radiosity" solve "$scene" -q --threads 1 --checkpoint c.h5 --json a.json
same "with a checkpoint" a.json
# Another run of the same checkpoint writes a file of its own.
"$radiosity" solve "$scene" -q --checkpoint two.h5 --json b.json >said 2>&1 &
other=$!
check "two at a time" "$radiosity" solve "$scene" -q --checkpoint two.h5 --json a.json
wait $other
check "two at a time: the other" [ $? = 0 ]
same "two at a time" a.json
same "two at a time: the other" b.json
check "two at a time: it goes on" "$radiosity" solve "$scene" -q --restart two.h5 --json a.json
same "two at a time, gone on with" a.json
check "two at a time: nothing else is left" [ -z "$(ls two.h5.*.tmp 2>/dev/null)" ]
check "it leaves nothing else" [ -z "$(ls c.h5.*.tmp 2>/dev/null)" ]
for threads in 1 3; do
    check "it goes on" "$radiosity" solve "$scene" -q --threads $threads --restart c.h5 --json a.json
    same "$threads threads" a.json
done

check "its clusters by name" "$radiosity" solve "$scene" -q --clusters halves --restart c.h5 --json a.json
same "clusters by name" a.json

# ---- killed at any time
kills=0
for wait in .1 .2 .3 .45 .6 .8 1.1; do
    rm -f k.h5 k.h5.*.tmp
    "$radiosity" solve "$scene" -q --checkpoint k.h5 >out 2>err &
    pid=$!
    sleep $wait
    kill -9 $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ -e k.h5 ] || continue
    kills=$((kills + 1))
    check "killed after $wait s: it goes on" "$radiosity" solve "$scene" -q --restart k.h5 --checkpoint k.h5 --json a.json
    same "killed after $wait s" a.json
done
check "some were killed after a checkpoint" [ $kills -gt 0 ]

# ---- several processes
if command -v mpirun >/dev/null && ldd "$radiosity" | grep -q libmpi; then
    for n in 2 4; do
        check "$n processes at one go" mpirun --oversubscribe -n $n "$radiosity" solve "$scene" -q --threads 1 --json $n.json
    done
    for n in 2 3; do
        check "$n processes" mpirun --oversubscribe -n $n "$radiosity" solve "$scene" -q --threads 1 --checkpoint m$n.h5 --json a.json
        [ -e $n.json ] || cp a.json $n.json
        same_on "$n processes" a.json $n
        check "one goes on from $n" "$radiosity" solve "$scene" -q --restart m$n.h5 --json a.json
        same "one from $n" a.json
    done
    check "2 go on from 3" mpirun --oversubscribe -n 2 "$radiosity" solve "$scene" -q --threads 1 --restart m3.h5 --json a.json
    same_on "2 from 3" a.json 2
    check "4 go on from 1" mpirun --oversubscribe -n 4 "$radiosity" solve "$scene" -q --threads 1 --restart c.h5 --json a.json
    same_on "4 from 1" a.json 4
else
    echo "checkpoint: skipped: several processes (make MPI=1, mpirun)"
fi

# ---- what is no checkpoint of this work is refused, and stays as it is
refused() { # TEXT ARGUMENT...: the run from the file x.h5 ends with 1 and this line
    count=$((count + 1))
    local text=$1
    shift
    cp x.h5 before
    timeout 60 "$radiosity" solve "$@" -q --no-errors --restart x.h5 >out 2>err
    local status=$?
    if [ $status != 1 ] || [ "$(wc -l <err)" != 1 ] || ! cmp -s before x.h5 ||
        ! grep -qE "^x.h5: error: cannot go on from it: ($text); leave --restart out to start anew$" err; then
        failed "$text (status $status)"
    fi
}
cp c.h5 x.h5
refused "it is of another scene, .*" "$scenes/cornell.obj"
refused "it is of another scene, .*" "$scene" --two-sided
refused "it is of thresholds times .*" "$scene" --oracle bf
refused "it is of thresholds times .*" "$scene" --scale 3
refused "it is of a solve with other options" "$scene" --closure rows
refused "it is of a solve with other options" "$scene" --solver jacobi
size=$(stat -c %s c.h5)
for part in 0 100 2000 $((size / 2)) $((size - 1)); do
    head -c "$part" c.h5 >x.h5
    refused "it is (no file of HDF5|damaged.*)" "$scene"
done
# one byte in each of many places; what is not read may be anything, and then the answer is the same
at=0
while [ $at -lt "$size" ]; do
    cp c.h5 x.h5
    old=$(od -An -tu1 -j $at -N 1 c.h5)
    printf "%b" "\\$(printf %03o $((old ^ 65)))" | dd of=x.h5 bs=1 seek=$at conv=notrunc 2>/dev/null
    timeout 60 "$radiosity" solve "$scene" -q --no-errors --restart x.h5 --json a.json >out 2>err
    status=$?
    count=$((count + 1))
    if [ $status = 0 ]; then
        alike "$(value link_fingerprint whole.json)" "$(value link_fingerprint a.json)" || failed "byte $at changes the answer"
    elif [ $status != 1 ] || ! grep -q "^x.h5: error: cannot go on from it" err; then
        failed "byte $at: status $status"
    fi
    if [ $at -lt 64 ]; then at=$((at + 7)); else at=$((at + size / 23)); fi
done
cp "$scene" x.h5
refused "it is no file of HDF5" "$scene"
"$radiosity" solve "$scene" -q --restart none.h5 >out 2>said
check "a file that is not there" [ $? = 1 ]
check "it says so" grep -q "^none.h5: error: cannot go on from it: No such file" said
"$radiosity" solve "$scene" -q --accuracy 1% --restart c.h5 >out 2>err
check "with --accuracy: 2" [ $? = 2 ]

# ---- a disk that is full: the last good file stays, the run ends with a message
cp c.h5 full.h5
(ulimit -f 200; trap '' XFSZ; exec timeout 60 "$radiosity" solve "$scene" -q --checkpoint full.h5 >out 2>said)
check "a full disk: 1" [ $? = 1 ]
check "it says so" grep -q "^full.h5: error: cannot write: " said
check "the last good file stays" cmp c.h5 full.h5
check "and nothing else" [ -z "$(ls full.h5.*.tmp 2>/dev/null)" ]

# ---- the same of several processes
command -v mpirun >/dev/null && ldd "$radiosity" | grep -q libmpi || { finish checkpoint; exit; }
ends() { # WHAT: within 30 s of $since, with something else than 0, in $status
    check "$1: status $status" [ "$status" != 0 ]
    check "$1: it took $((SECONDS - since)) s" [ $((SECONDS - since)) -lt 30 ]
}
full_disk() { # WHAT BLOCKS OPTIONS...: of 1 KB, on which a solve writes full.h5
    rm -f full.h5
    since=$SECONDS
    # without memory that they share, whose files would be as large
    mpirun --oversubscribe -n 3 --mca btl tcp,self sh -c "ulimit -f $2; trap '' XFSZ; exec timeout 60 $radiosity solve $scene -q --threads 1 ${*:3}" >out 2>said
    status=$?
    ends "$1, $2"
    check "$1: one message: $(grep error: said)" [ "$(grep -c "^full.h5: error: cannot write: " said)" = 1 ]
}
for blocks in 100 800; do # before the first pass is written, and behind it
    full_disk "a full disk" $blocks --checkpoint full.h5 --json a.json
    check "a full disk: nothing else fails: $(grep -i -m 1 'signal' said)" [ "$(grep -ci 'signal' said)" = 0 ]
    [ -e full.h5 ] || continue
    check "a full disk: it goes on" mpirun --oversubscribe -n 2 "$radiosity" solve "$scene" -q --threads 1 --restart full.h5 --json a.json
    same_on "behind a full disk" a.json 2
done
check "a full disk left the last good file" [ -e full.h5 ]
# one of them writes this file alone, and the others end with it
full_disk "a full disk for a mesh" 100 -o full.xdmf
check "a full disk for a mesh: nothing is left" [ -z "$(ls full.* 2>/dev/null)" ]

# a folder that one of three has for itself: the others would wait for it to find the file
mkdir own
since=$SECONDS
mpirun --oversubscribe -n 3 sh -c '[ "$OMPI_COMM_WORLD_RANK" != 1 ] || cd own; exec timeout 60 "$@"' sh "$radiosity" solve "$scene" -q --threads 1 --checkpoint own.h5 --json own.json >out 2>said
status=$?
ends "no folder in common"
check "no folder in common: one message: $(grep error: said)" [ "$(grep -c "^own.h5: error: cannot write: not all processes find it" said)" = 1 -a "$(grep -c error: said)" = 1 ]
check "no folder in common: nothing is left" [ -z "$(ls own.* own/* 2>/dev/null)" ]

near=rad$$n far=rad$$f
if [ "$(id -u)" = 0 ] && ip netns add $near 2>/dev/null; then
    trap 'for n in $near $far; do ip netns del $n 2>/dev/null; done; rm -rf "$tmp"' EXIT
    # two machines: each its network and its name; ssh from one to the other is ip netns exec
    ip netns add $far && ip link add v$$n netns $near type veth peer name v$$f netns $far
    ip -n $near addr add 10.199.0.1/24 dev v$$n && ip -n $far addr add 10.199.0.2/24 dev v$$f
    for n in $near $far; do ip -n $n link set lo up && ip -n $n link set v${n#rad} up; done
    printf '%s\n' '#!/bin/sh' 'shift' "exec ip netns exec $far unshare --uts sh -c 'hostname far; eval \"\$*\"' sh \"\$*\"" >agent
    chmod +x agent
    rm -f k.h5 a.json
    watched="--mca oob_tcp_keepalive_time 5 --mca oob_tcp_keepalive_intvl 2 --mca oob_tcp_keepalive_probes 3"
    # shellcheck disable=SC2086 # words
    ip netns exec $near unshare --uts sh -c 'hostname near; exec "$@"' sh timeout 120 mpirun --host 10.199.0.1:1,10.199.0.2:1 -n 2 \
        --mca plm_rsh_agent "$tmp/agent" --mca btl tcp,self $watched "$radiosity" solve "$scene" -q --threads 1 --checkpoint k.h5 --json a.json >out 2>said &
    pid=$!
    for _ in $(seq 600); do [ -e k.h5 ] || kill -0 $pid 2>/dev/null && sleep .05; [ ! -e k.h5 ] || break; done
    ip -n $far link set v$$f down
    since=$SECONDS
    wait $pid
    status=$?
    ends "a cut network"
    check "a cut network: it says so: $(head -n 3 said)" grep -q 'lost communication' said
    check "a cut network: nothing is written" [ ! -e a.json ]
    for _ in $(seq 100); do [ -n "$(ip netns pids $far)" ] && sleep .1; done
    check "a cut network: nobody is left beyond it" [ -z "$(ip netns pids $far)" ]
    check "a cut network: it goes on" "$radiosity" solve "$scene" -q --restart k.h5 --json a.json
    same "behind a cut network" a.json
else
    echo "checkpoint: skipped: a network that is cut (root, ip netns)"
fi

finish checkpoint
