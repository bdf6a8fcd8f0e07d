#!/usr/bin/env bash
# check_ranks.sh - several processes against one: the same links, decisions, rays and particles to the bit, radiosities to
# 1e-12, on any number of ranks and threads; references and view factors to the byte; what several ranks cannot do is refused; a
# rank that is killed, or that cannot go on, ends the run with a message and leaves no half of a file; no rank has or tells more than
# its share. Needs a command built by `make MPI=1` and mpirun; else it says that it is skipped. THOROUGH: more scenes and more ranks.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
# shellcheck source=tests/support/mpi.sh
. "$top/tests/support/mpi.sh"
command -v mpirun >/dev/null || { echo "skipped: no mpirun"; exit 0; }
several() { # N COMMAND...
    timeout 300 mpirun -n "$@"
}
several 2 "$radiosity" --version >version 2>&1
if grep -q 'built without MPI: build it by' version; then
    check "a command without MPI said: $(cat version)" grep -q 'started as one of 2 processes' version
    echo "skipped: the command was built without MPI (make MPI=1 builds it)"
    [ "$bad" = 0 ]
    exit
fi

rank_of() { # COMMAND RANK: wait for the process, one of this script's, then $found is its number
    local p
    for _ in $(seq 300); do
        for p in $(pgrep -f "^$radiosity $1 "); do
            [ "$(readlink "/proc/$p/cwd")" = "$PWD" ] || continue
            [ "$(tr '\0' '\n' <"/proc/$p/environ" 2>/dev/null | sed -n 's/^OMPI_COMM_WORLD_RANK=//p')" = "$2" ] && found=$p && return
        done
        sleep .1
    done
    return 1
}

# ---- the same answer
near() { within "$1" "$2" 1e-12; }
how= # options
compare_ranks() { # SCENE RANKS...: against one process
    local scene=$1 name n
    name=$(basename "$scene" .obj)
    shift
    # shellcheck disable=SC2086
    "$radiosity" solve "$scene" $how -q --threads 2 --json one.json --faces one.csv || { check "$name alone" false; return; }
    for n; do
        # shellcheck disable=SC2086
        several "$n" "$radiosity" solve "$scene" $how -q --threads $((n % 2 + 1)) --json several.json --faces several.csv >said 2>&1
        check "$name on $n ranks: exit status $?: $(head -n 3 said)" [ -s several.json ]
        for key in link_fingerprint particle_fingerprint links pairs rays elements passes iterations; do
            check "$name on $n ranks: $key $(value several.json $key), alone $(value one.json $key)" \
                alike "$(value several.json $key)" "$(value one.json $key)"
        done
        check "$name on $n ranks: other decisions" diff <(sed -n '/"decisions"/,/}/p' one.json) <(sed -n '/"decisions"/,/}/p' several.json)
        check "$name on $n ranks: other marks of elements" diff <(sed -n '/"element_marks"/,/]/p' one.json) <(sed -n '/"element_marks"/,/]/p' several.json)
        check "$name on $n ranks: other faces that are not known" diff <(grep _unsure one.json) <(grep _unsure several.json)
        check "$name on $n ranks: $(value several.json power_absorbed) W absorbed, alone $(value one.json power_absorbed)" \
            near "$(value several.json power_absorbed)" "$(value one.json power_absorbed)"
        check "$name on $n ranks: other light on faces" same_faces one.csv several.csv
        check "$name: ranks are not told of" [ "$(grep -c '"ghosts"' several.json)" = "$((n > 1 ? n : 0))" ]
        rm -f several.json several.csv
    done
}
compare_ranks "$scenes/cornell.obj" 1 2 3 4
compare_ranks "$scenes/room.obj" 2
how="--scale none" compare_ranks "$scenes/room.obj" 3
compare_ranks "$top/tests/runtime/sky_room.obj" 3 # by paths
how="--no-correct --oracle importance --view .28,.27,-.5:.28,.27,.3" compare_ranks "$scenes/cornell.obj" 3
# an empty room with a dark wall, in which elements are split for what all links bring together
sed 's/^f 1 2 3 4$/usemtl dark\n&\nusemtl wall_1s/' "$scenes/furnace.obj" >dim.obj
cp "$scenes/furnace.mtl" . && printf 'newmtl dark\nKd .5 .5 .5\n' >>furnace.mtl
how="--no-correct" compare_ranks dim.obj 2 3
# a hundred boxes whose lids stop short by a slit: that light comes in is told by edges, of which each rank looks at a part
cat >boxes.awk <<'END'
BEGIN {
    print "mtllib boxes.mtl\nusemtl wall"
    box(-1, -1, 0, 12, 12, 3, 1)
    k = corners; corner(4, 6, 2.9); corner(6, 6, 2.9); corner(6, 4, 2.9); corner(4, 4, 2.9)
    printf "usemtl lamp\nf %d %d %d %d\nusemtl wall_2s\n", k + 4, k + 3, k + 2, k + 1
    split("1 3 4 2 1 2 6 5 3 7 8 4 1 5 7 3 2 4 8 6 9 10 12 11", at, " ") # as box() has them; the lid has corners of its own
    for (i = 0; i < 100; i++) {
        k = corners
        for (j = 0; j < 12; j++)
            corner(i % 10 + (j % 2 ? (j < 8 ? .5 : .5 - 5e-5) : 0), int(i / 10) + .5 * (int(j / 2) % 2), j < 4 ? .1 : .4)
        for (j = 1; j < 24; j += 4) print "f", k + at[j], k + at[j + 1], k + at[j + 2], k + at[j + 3]
    }
}
END
awk -f "$top/tests/solver/box.awk" -f boxes.awk >boxes.obj
printf 'newmtl wall\nKd .5 .5 .5\nnewmtl wall_2s\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 9 9 9\n' >boxes.mtl
how="--scale 16 --no-correct" compare_ranks boxes.obj 3
if [ -n "${THOROUGH:-}" ]; then
    compare_ranks "$scenes/room.obj" 3 4 7
    compare_ranks "$scenes/td.obj" 2 3 4
    compare_ranks "$scenes/maze_16.obj" 3 7
    compare_ranks "$scenes/sejour.obj" 2
    grid=$top/../shared/scenes/gridroom_10000.obj
    if [ -f "$grid" ]; then compare_ranks "$grid" 2 4; else echo "skipped: no gridroom"; fi
fi
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a > 0 && a <= b) }'; }
# ---- a limit on pairs is one of all ranks together: three quarters of the pairs are more than a rank of two discusses
"$radiosity" solve "$scenes/cornell.obj" -q --scale 1 --no-correct --json one.json
pairs=$(value one.json pairs)
several 2 "$radiosity" solve "$scenes/cornell.obj" -q --scale 1 --no-correct --limit pairs=$((pairs * 3 / 4)) >said 2>&1
status=$?
check "a limit on pairs that two ranks meet together: exit status $status: $(head -n 3 said)" \
    [ $status = 1 -a "$(grep -c "did not end within pairs=$((pairs * 3 / 4))" said)" = 1 ]
several 2 "$radiosity" solve "$scenes/cornell.obj" -q --scale 1 --no-correct --limit pairs=$((pairs / 4)) >said 2>&1
discussed=$(sed -n 's/.*has discussed \([0-9]*\) pairs.*/\1/p' said) # while one refines it does not go beyond what both may
check "a limit of $((pairs / 4)) pairs, of which one of two ranks has discussed $discussed" below "$discussed" $((pairs / 4))
several 2 "$radiosity" solve "$scenes/cornell.obj" -q --scale 1 --no-correct --limit pairs="$pairs" --json several.json >said 2>&1
check "a limit on pairs that nobody meets: exit status $?: $(head -n 3 said)" [ "$(value several.json pairs)" = "$pairs" ]
rm -f several.json
# ---- what each has and tells: no rank has the quarters that particles are counted on of all faces, and a sweep tells of what
# groups alone take as little as they read. Meshes, which all quarters are needed for, have the bytes of one process.
ranks_most() { sed -n "s/^ *\"$1\": \([0-9.]*\),*$/\1/p" several.json | sort -g | tail -n 1; } # KEY: of the ranks' values
boxes() { # FACES
    awk -v FACES="$1" -v MATERIALS=boxes.mtl -f "$top/tests/studies/room_of_boxes.awk" >boxes.obj
    "$radiosity" solve boxes.obj --scale 16 -q --threads 1 --json one.json -o one.ply
    several 4 "$radiosity" solve boxes.obj --scale 16 -q --threads 1 --json several.json --faces several.csv >said 2>&1
    sed '/"ranks"/,$!d' several.json >ranks.json
    check "$1 boxes: $(head -n 3 said)" alike "$(value several.json particle_fingerprint)" "$(value one.json particle_fingerprint)"
    mv several.json all.json && mv ranks.json several.json
    held=$(ranks_most elements) told=$(ranks_most sweeps) ghosts=$(ranks_most ghosts) memory=$(ranks_most memory_mb)
    check "$1 boxes: one of 4 ranks has $held of $(value one.json elements) elements" below "$held" "$(awk "BEGIN { print .45 * $(value one.json elements) }")"
    several 4 "$radiosity" solve boxes.obj --scale 16 -q --threads 1 -o several.ply >said 2>&1
    check "$1 boxes: another mesh on 4 ranks: $(head -n 3 said)" cmp one.ply several.ply
}
boxes 300
# Links are dealt out evenly once there are any: the fullest of 8 ranks had 1.5 times the mean here while a link that a cluster
# receives was taken for as many as there are faces below.
awk -v FACES=600 -v MATERIALS=boxes.mtl -f "$top/tests/studies/room_of_boxes.awk" >boxes.obj
several 8 "$radiosity" solve boxes.obj --scale 16 --no-correct -q --threads 1 --json several.json >said 2>&1
sed -i '/"ranks"/,$!d' several.json
most=$(sed -n 's/^      "links": \([0-9]*\),*$/\1/p' several.json | awk '{ sum += $1; most = $1 > most ? $1 : most } END { print (NR == 8 ? most * NR / sum : 99) }')
check "600 boxes: of 8 ranks the fullest has $most times the mean of links: $(head -n 3 said)" below "$most" 1.15
if [ -n "${THOROUGH:-}" ]; then
    boxes 2000 # most of its links are of groups
    check "2000 boxes: one of 4 ranks takes $memory MB, one process $(value one.json peak_memory_mb)" \
        below "$memory" "$(awk "BEGIN { print .55 * $(value one.json peak_memory_mb) }")"
    check "2000 boxes: $told bytes told in sweeps of $ghosts elements" \
        below "$told" "$(awk "BEGIN { print 8 * $ghosts * $(value one.json iterations) }")"
fi
# Paths of dim polygons end in all quarters; but of others' they take the light, and not the quarters. Where the scale is chosen there are none.
several 3 "$radiosity" solve "$scenes/room.obj" --scale 1 -q --json several.json >said 2>&1
held=$(sed -n 's/^      "elements": \([0-9]*\),*$/\1/p' several.json | sort -n | tr '\n' ' ')
check "room: 3 ranks have had $held elements, as if each had all: $(head -n 3 said)" below "${held%% *}" "$(ranks_most elements | awk '{ print .7 * $1 }')"
"$radiosity" solve "$scenes/cornell.obj" -q -o one.ply
several 3 "$radiosity" solve "$scenes/cornell.obj" -q -o several.ply >said 2>&1
check "cornell: another mesh on 3 ranks: $(head -n 3 said)" cmp one.ply several.ply
rm -f one.* several.* all.json
# Other oracles, elements and solvers.
for how in "--oracle bf_guarded" "--oracle ff --basis constant" "--oracle clusters" "--solver jacobi" "--closure rows" "--oracle relative --release dag" "--oracle power --release wave"; do
    # shellcheck disable=SC2086 # words
    "$radiosity" solve "$scenes/cornell.obj" $how -q --json one.json
    # shellcheck disable=SC2086
    several 3 "$radiosity" solve "$scenes/cornell.obj" $how -q --json several.json >said 2>&1
    check "cornell, $how: $(value several.json link_fingerprint), alone $(value one.json link_fingerprint); $(head -n 3 said)" \
        alike "$(value several.json link_fingerprint)" "$(value one.json link_fingerprint)"
    check "cornell, $how: other light" near "$(value several.json power_absorbed)" "$(value one.json power_absorbed)"
done
"$radiosity" reference "$scenes/cornell.obj" -o one.csv --accuracy 2% -q
several 3 "$radiosity" reference "$scenes/cornell.obj" -o several.csv --accuracy 2% -q
check "another reference" cmp one.csv several.csv

# ---- view factors: all that is written has the bytes of one process
same_factors() { # RANKS SCENE OUTPUT ARGUMENTS...
    local n=$1 scene=$2 out=$3
    shift 3
    rm -f "one.$out" "several.$out"
    "$radiosity" viewfactors "$scene" "$@" -q -o "one.$out" --json one.json || check "alone: $*" false
    several "$n" "$radiosity" viewfactors "$scene" "$@" -q --threads $((n % 2 + 1)) -o "several.$out" --json several.json >said 2>&1
    check "viewfactors, $out $* on $n ranks: exit status $?: $(head -n 3 said)" cmp "one.$out" "several.$out"
    same_report "$n" "$*"
}
same_report() { # all that is said but times, and what each rank had
    check "viewfactors $2 on $1 ranks: another report" diff \
        <(grep -v '"seconds' one.json | sed '/"ranks"/,$d') <(grep -v '"seconds' several.json | sed '/"ranks"/,$d')
    check "viewfactors: ranks are not told of" [ "$(grep -c '"ghosts"' several.json)" = "$(($1 > 1 ? $1 : 0))" ]
}
maze=$scenes/maze_8.obj
for n in 1 2 4 7; do same_factors $n "$maze" csv --tolerance 3e-3 --closure reciprocal; done
same_factors 3 "$scenes/cornell.obj" npz --by material --closure rows
same_factors 2 "$scenes/furnace.obj" mtx --repeat x=9:1
same_factors 3 "$scenes/cornell.obj" csv --sky
for i in $(seq 21); do echo "$i,$((i * i % 7))"; done >columns.csv
same_factors 3 "$scenes/cornell.obj" csv --product columns.csv
for i in $(seq 9); do echo ".$i 1.2 .9 0 0 -1 point $i"; done >points.txt
several 3 "$radiosity" viewfactors "$scenes/cornell.obj" --sensor points.txt -q -o several.csv >said 2>&1
"$radiosity" viewfactors "$scenes/cornell.obj" --sensor points.txt -q -o one.csv
check "sensors on 3 ranks: $(head -n 3 said)" cmp one.csv several.csv
# Groups in a clear view, more than is kept; and faces in half shadow with them.
if [ -n "${THOROUGH:-}" ]; then
    for n in 2 3; do same_factors $n "$scenes/room.obj" csv; done
    grid=$top/../shared/scenes/gridroom_1000.obj
    if [ -f "$grid" ]; then same_factors 4 "$grid" csv --format coo; else echo "skipped: no gridroom"; fi
fi
# Put down by one number of ranks, gone on with by another.
"$radiosity" viewfactors "$maze" -q -o one.csv --json one.json
rm -f several.csv several.json
stops=0 later=.7
for n in 3 2 4 2 3 2 3 2; do
    mpirun -n $n "$radiosity" viewfactors "$maze" --threads 1 -o several.csv --json several.json --resume state >said 2>&1 &
    run=$!
    [ $stops -gt 1 ] || { rank_of viewfactors 0 && sleep $later && kill -TERM "$found"; }
    wait $run
    status=$?
    stopped=$(grep -c 'the same command goes on from state' said)
    if [ "$stopped" = 0 ] && [ ! -s several.csv ]; then # they had not begun
        later=$(awk "BEGIN { print 2 * $later }")
        continue
    fi
    [ $stops = 0 ] || check "$n ranks go on: $(head -n 3 said)" grep -q 'goes on from state: ' said
    if [ "$stopped" = 1 ]; then
        check "$n ranks were stopped: status $status" [ $status = 130 ]
        stops=$((stops + 1))
    elif [ $stops -gt 0 ]; then
        break
    else # they had ended
        later=$(awk "BEGIN { print $later / 3 }")
        rm -f several.csv several.json
    fi
done
check "view factors were stopped, and ended: $stops times, status $status, $(head -n 3 said)" [ $stops -gt 0 -a $status = 0 ]
check "view factors that were stopped" cmp one.csv several.csv
check "the state is gone" [ ! -e state ]
for of in links pairs rays; do check "the same $of" alike "$(value one.json $of)" "$(value several.json $of)"; done
head -c 5000 /dev/zero >state

# ---- what is refused, by one message
refused() { # STATUS TEXT ARGUMENTS...
    local status=$1 text=$2 found
    shift 2
    several 3 "$radiosity" "$@" >said 2>&1
    found=$?
    check "$*: status $found, not $status" [ "$found" = "$status" ]
    check "$*: $(grep error said | head -n 3)" [ "$(grep -c -e "$text" said)" = 1 ]
}
cube=$scenes/furnace.obj
refused 2 "only solve, reference and viewfactors run as several" error one.csv several.csv
refused 1 "it is no state of view factors" viewfactors "$cube" -q -o f.csv --resume state
refused 1 "no_such.csv: error: cannot read" viewfactors "$cube" -o f.csv --product no_such.csv
refused 1 "points.csv: error: cannot read" viewfactors "$cube" -o f.csv --sensor points.csv
refused 1 "LU needs all links" solve "$cube" --solver lu --basis constant
refused 1 "a trace needs all links" solve "$cube" --trace t.csv
refused 1 "counting an oracle's discussions needs all links" solve "$cube" --statistics t.csv
refused 1 "ranking links, which this oracle asks for, needs all links" solve "$cube" --oracle ranked
refused 1 "an enclosing solution, which this oracle asks for, needs all links" solve "$cube" --oracle bracket
refused 1 "it marks elements" solve "$scenes/room.obj" --oracle masking
refused 2 "limit-seconds" solve "$cube" --accuracy 1% --limit-seconds 3
refused 1 "no_such.obj" solve no_such.obj
refused 1 "cannot" solve "$cube" -o no/such/folder.ply
check "something was written" [ -z "$(find . -name '*.ply*' -o -name 't.csv*')" ]

# ---- one rank of three, on a machine of its own, finds no scene there, or another one: one message says so
mkdir elsewhere
cp "$scenes/cornell.obj" "$scenes/cornell.mtl" .
apart() { # TEXT COMMAND...
    several 3 sh -c '[ "$OMPI_COMM_WORLD_RANK" != 1 ] || cd elsewhere; exec "$@"' sh "$radiosity" "${@:2}" -q >said 2>&1
    status=$?
    check "ranks apart, ${*:2}: status $status: $(head -n 3 said)" [ $status = 1 -a "$(grep -c "$1" said)" = 1 -a "$(grep -c error: said)" = 1 ]
    check "ranks apart, ${*:2}: something was written" [ -z "$(ls apart* elsewhere/apart* 2>/dev/null)" ]
}
apart "cornell.obj: error: cannot read" solve cornell.obj --faces apart.csv
apart "cornell.obj: error: cannot read" viewfactors cornell.obj -o apart.csv
sed '0,/^v 0.343/s/^v 0.343/v 0.353/' cornell.obj >elsewhere/cornell.obj
cp cornell.mtl elsewhere
apart "have read different files" viewfactors cornell.obj -o apart.csv # that ended well, with other factors
cp cornell.obj elsewhere
sed 's/^Ke [1-9].*/Ke 1 2 3/' cornell.mtl >elsewhere/cornell.mtl
apart "have read different files" solve cornell.obj --faces apart.csv
cp cornell.mtl elsewhere
cp "$oracles/bf.dag" "$oracles/common.dag" .
cp common.dag elsewhere && sed 's/relative  : ratio = 0.05/relative  : ratio = 0.3/' bf.dag >elsewhere/bf.dag
apart "have different oracles" solve cornell.obj --oracle bf.dag --no-correct --faces apart.csv
for i in $(seq 21); do echo "$i,1"; done >columns && sed 's/,1/,2/' columns >elsewhere/columns
apart "columns: error: the processes have read different files" viewfactors cornell.obj --product columns -o apart.csv
echo ".3 .3 .3 0 0 1" >points && echo ".4 .3 .3 0 0 1" >elsewhere/points
apart "points: error: the processes have read different files" viewfactors cornell.obj --sensor points -o apart.csv
"$radiosity" reference cornell.obj -o kept.csv --accuracy 10% --keep -q
apart "kept.csv.state: error: the processes have read different files" reference cornell.obj -o kept.csv --accuracy 5%
rm -rf elsewhere cornell.obj cornell.mtl bf.dag common.dag columns points kept.csv*

# ---- a rank that waits for one that is held up sleeps. Not while MPI itself starts, or beside other work has not let it come to
# where it waits: then the other one goes on for a while, and is held up later.
used() { awk '{ sub(/.*[)] /, ""); print $12 + $13 }' "/proc/$1/stat"; } # PID: hundredths of a second, by user and system
several 2 "$radiosity" solve "$scenes/td.obj" --scale .1 -q >said 2>&1 &
run=$!
rank_of solve 1 && held=$found && rank_of solve 0 && waits=$found
took=200
for try in 1 2 3 4 5 6 7 8 9 10; do
    sleep .3
    kill -STOP "$held" && sleep 1 && before=$(used "$waits") && sleep 2 && took=$(($(used "$waits") - before))
    kill -CONT "$held"
    [ "$took" -lt 50 ] && break
done
check "a rank that waits took $took hundredths of a second in 2 s, $try times" [ "$took" -lt 50 ]
wait $run
check "a run that was held up: status $?: $(head -n 3 said)" [ ! -s said ]

# ---- a rank that is killed
several 3 "$radiosity" solve "$scenes/td.obj" --scale .1 -q -o td.ply --json td.json >said 2>&1 &
run=$!
rank_of solve 1 && sleep .5 && kill -KILL "$found"
killed=$SECONDS
wait $run
status=$?
check "a rank was killed: status $status" [ "$status" != 0 ]
check "a rank was killed: the run went on for $((SECONDS - killed)) s" [ $((SECONDS - killed)) -lt 30 ]
check "a rank was killed, and nobody said so: $(head -n 3 said)" grep -q -i 'signal 9\|killed' said
check "a rank was killed: $(ls)" [ ! -e td.ply -a ! -e td.json -a -z "$(find . -name 'td.*')" ]

# ---- a rank that finds no memory: the others do not wait for it, and one message says so. What is refused is the first that a
# function of the command's asks for, known by its name, or the one of a number.
cat >refuse.c <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
static uintptr_t from, to; /* where the caller stands */
static int left;
__attribute__((constructor)) static void begin(void)
{
    const char *rank = getenv("OMPI_COMM_WORLD_RANK"), *first = getenv("REFUSE_FROM"), *size = getenv("REFUSE_SIZE");
    if (!rank || strcmp(rank, "1") || !first || !size)
        return;
    from = (uintptr_t)strtoull(first, NULL, 16);
    to = from + (uintptr_t)strtoull(size, NULL, 16);
    left = atoi(getenv("REFUSE_AT"));
}
static int refused(void *caller)
{
    Dl_info of;
    if (!left || !dladdr(caller, &of))
        return 0;
    uintptr_t at = (uintptr_t)caller - (uintptr_t)of.dli_fbase;
    if (at < from || at >= to || strstr(of.dli_fname, "radiosity") == NULL)
        return 0;
    return --left == 0 && unlink(getenv("REFUSE_MARK")) == 0;
}
void *malloc(size_t n) { return refused(__builtin_return_address(0)) ? NULL : __libc_malloc(n); }
void *calloc(size_t n, size_t size) { return refused(__builtin_return_address(0)) ? NULL : __libc_calloc(n, size); }
void *realloc(void *p, size_t n) { return refused(__builtin_return_address(0)) ? NULL : __libc_realloc(p, n); }
END
if ! cc -O1 -shared -fPIC -o refuse.so refuse.c || [ "$(LD_PRELOAD=$tmp/refuse.so "$radiosity" --version 2>&1)" != "$("$radiosity" --version)" ]; then
    echo "skipped: no memory on one rank: this command cannot be given another malloc"
else
    nm -S "$radiosity" >names
fi

lacks() { # FUNCTION[:NUMBER] ARGUMENTS...: the second rank has no memory there
    local name=${1%:*} at=${1#*:} status
    [ "$at" != "$name" ] || at=1
    shift
    [ -s names ] || return
    # shellcheck disable=SC2046
    set -- $(awk -v name="$name" '$4 == name { print $1, $2; exit }' names) "$@"
    case $1 in
        [0-9a-f]*) ;;
        *) echo "skipped: $name, which the compiler has put into others" && return ;;
    esac
    touch mark
    timeout -k 5 30 mpirun -n 2 -x LD_PRELOAD="$tmp/refuse.so" -x REFUSE_FROM="$1" -x REFUSE_SIZE="$2" -x REFUSE_AT="$at" \
        -x REFUSE_MARK="$tmp/mark" "$radiosity" "${@:3}" -q --threads 1 >out 2>err
    status=$?
    check "$name is not asked by $3" [ ! -e mark ]
    check "no memory in $name: status $status" [ $status = 1 ]
    check "no memory in $name, which nobody says" grep -qi memory out err
}
for i in 1 2 3 4 5 6; do echo "$i,1"; done >columns
lacks exchange_open viewfactors "$cube" -o f.csv
lacks exchange_sums viewfactors "$cube" -o f.csv
lacks exchange_product viewfactors "$cube" -o f.csv
lacks exchange_closure_make viewfactors "$cube" -o f.csv --closure reciprocal
lacks exchange_multiply viewfactors "$cube" --product columns -o f.csv
lacks lit_faces_find solve "$cube" --two-sided
lacks reserve_importance solve "$cube" --oracle importance --view .5,.5,.5:.9,.5,.4
lacks refinement_open solve "$cube"
lacks linear_solution_solve:5 solve "$cube"
lacks face_paths_trace solve "$top/tests/runtime/sky_room.obj"
lacks dim_paths_trace solve "$scenes/room.obj"
lacks measure_stage solve "$cube" --errors
lacks surface_error_measure solve "$cube" --errors
lacks tracer_open reference "$cube" -o r.csv --accuracy 5%
lacks face_paths_open reference "$cube" -o r.csv --accuracy 5%

# ---- ranks that have less memory than they ask for: all have the limits of the one with least, meet them together, and end or go
# on as one process does; and one that cannot write what all have made
cat >less.c <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

int getrlimit(__rlimit_resource_t what, struct rlimit *is)
{
    int (*asked)(__rlimit_resource_t, struct rlimit *) = (int (*)(__rlimit_resource_t, struct rlimit *))dlsym(RTLD_NEXT, "getrlimit");
    const char *rank = getenv("OMPI_COMM_WORLD_RANK"), *only = getenv("LESS_RANK"), *bytes = getenv("LESS_BYTES");
    int status = asked(what, is);
    if (what == RLIMIT_AS && bytes && !(only && *only && rank && strcmp(rank, only)))
        is->rlim_cur = strtoul(bytes, NULL, 10);
    return status;
}
END
if ! cc -O1 -shared -fPIC -o less.so less.c -ldl || [ "$(LD_PRELOAD=$tmp/less.so "$radiosity" --version 2>&1)" != "$("$radiosity" --version)" ]; then
    echo "skipped: ranks with less memory: this command cannot be given another getrlimit"
else
    less() { # RANKS BYTES RANK ARGUMENTS...: that rank has so little, or all when "" is given
        timeout -k 5 60 mpirun -n "$1" -x LD_PRELOAD="$tmp/less.so" -x LESS_BYTES="$2" -x LESS_RANK="$3" "$radiosity" "${@:4}" \
            --threads 1 >out 2>err
    }
    for ranks in 1 2; do
        less $ranks 500000 "" solve "$scenes/cornell.obj"
        status=$?
        check "$ranks ranks with little memory: status $status, $(head -n 3 err)" [ $status = 0 ]
        check "$ranks ranks with little memory have links" grep -q '^links *none' out err
    done
    began=$SECONDS
    less 2 5000 1 viewfactors "$scenes/maze_8.obj" -q -o f.csv
    status=$?
    check "a rank with less memory than the other: status $status, $(head -n 3 err)" [ $status = 1 ]
    check "a rank with less memory: the other waited for $((SECONDS - began)) s" [ $((SECONDS - began)) -lt 8 ]
    check "a rank with less memory: $(cat err)" [ "$(grep -c 'refinement for view factors does not end' err)" = 1 ]
fi
began=$SECONDS
several 2 "$radiosity" viewfactors "$scenes/cornell.obj" -q -o /dev/full >said 2>&1
status=$?
check "a matrix that cannot be written: status $status, $(cat said)" [ $status = 1 -a "$(grep -c 'error:' said)" = 1 ]
check "a matrix that cannot be written: the others waited for $((SECONDS - began)) s" [ $((SECONDS - began)) -lt 8 ]

finish ranks
