#!/bin/bash
# check_resume.sh - `radiosity viewfactors --resume FILE`: runs that are stopped by signals, at whatever place, and go on, have
# the bytes of those that are not; states that are damaged or of other work are refused and stay. RADIOSITY names the command.
# Places that are chosen, and states that are damaged on purpose with their checks mended: tests/runtime/check_exchange_state.c.
# Once is enough: states are damaged in check_exchange_state.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
mkdir scratch
export TMPDIR=$tmp/scratch
quietly=into_files
scene=$scenes/maze_8.obj
left() { ls -A . scratch | grep -vxE '|\.:|scratch:|scratch|out|err|whole\..*|furnace.mtl|state|'"$1"; }

check "at one go" "$radiosity" viewfactors "$scene" -q -o whole.csv --json whole.json

# ---- stopped by signals, then to the end, on one to three threads
stops=0 status=130
for i in 1 2 3 4 5 6 7 8; do
    env --default-signal=INT "$radiosity" viewfactors "$scene" --threads $((1 + i % 3)) -o m.csv --json m.json --resume m.state >out 2>whole.said &
    pid=$!
    signal=$([ $((i % 2)) = 1 ] && echo INT || echo TERM)
    [ $i -gt 3 ] || { catches $pid; sleep 0.3; kill -$signal $pid 2>err.kill; rm -f err.kill; }
    wait $pid
    status=$?
    [ $stops = 0 ] || check "run $i says that it goes on" grep -q "^goes on from m.state: .*links" whole.said
    [ $status = 130 ] || break
    stops=$((stops + 1))
    check "it says so" grep -q "^stopped after .* s; the same command goes on from m.state$" whole.said
    check "it leaves a state" [ -s m.state ]
    check "run $i leaves nothing else" [ -z "$(left m.state)" ]
    cp m.state state
done
check "it was stopped at least once" [ $stops -gt 0 ]
check "and ended" [ $status = 0 ]
check "the same after being stopped" cmp whole.csv m.csv
for of in links pairs rays; do check "the same $of" alike "$(first_number $of whole.json)" "$(first_number $of m.json)"; done
check "the state is gone, and nothing is left" [ -z "$(left 'm.csv|m.json')" ]
rm -f m.csv m.json

# ---- twice in a row: at once, and nothing but a whole state is left
"$radiosity" viewfactors "$scene" -q -o m.csv --resume m.state >out 2>err &
pid=$!
catches $pid
sleep 0.3
kill -TERM $pid && kill -TERM $pid && kill -TERM $pid
wait $pid
check "two signals leave at most a state" [ -z "$(left m.state)" ]
rm -f m.state

# ---- whoever ignores SIGINT, as jobs of a script do, is not stopped by it
env --ignore-signal=INT "$radiosity" viewfactors "$scene" -q -o m.csv --resume m.state >out 2>err &
pid=$!
catches $pid
kill -INT $pid 2>/dev/null
wait $pid
check "SIGINT stays ignored" [ $? = 0 ]
check "the same, undisturbed" cmp whole.csv m.csv
rm -f m.csv

# ---- other closures, outputs and threads may go on with a state, silently if asked to
cp state m.state
"$radiosity" viewfactors "$scene" -q --closure rows -o m.csv --resume m.state --threads 1 >out 2>whole.said
check "it may end otherwise" [ $? = 0 ]
check "without a word" [ ! -s whole.said ]
check "closed from the start" "$radiosity" viewfactors "$scene" -q --closure rows -o whole.closed
check "the same matrix, closed" cmp whole.closed m.csv
rm -f m.csv

# ---- what is no state of this work is refused, and stays as it is
says() { # TEXT ARGUMENT...: the run with the state m.state ends with 1 and this line, and touches nothing
    count=$((count + 1))
    text=$1
    shift
    cp m.state whole.before
    timeout 20 "$radiosity" viewfactors "$@" -o m.csv --resume m.state >out 2>err
    if [ $? != 1 ] || ! grep -q "^m.state: error: $text; remove it to start anew, or give --resume another name$" err ||
        [ "$(wc -l <err)" != 1 ] || ! cmp -s whole.before m.state || [ -n "$(left m.state)" ]; then
        failed "$text"
    fi
}
cp state m.state
says "it is of another scene, or of this one with other sides or copies" "$scenes/cornell.obj" -q
says "it is of another scene, or of this one with other sides or copies" "$scene" --two-sided -q
says "it is of another scene, or of this one with other sides or copies" "$scene" --mirror x=-1 -q
says "it is of another tolerance" "$scene" --tolerance 1e-3
says "it is of another oracle, or of one with other parameters" "$scene" --set from_faces=20
yes 0 | head -n 146 >whole.x
says "it is of a matrix, not of a product" "$scene" --product whole.x
head -c 20000 state >m.state
says "it is cut short" "$scene"
{ head -c 1000 state; printf '\377'; tail -c +1002 state; } >m.state
says "it is damaged" "$scene"
{ cat state; echo; } >m.state
says "it is damaged" "$scene"
{ head -c 8 state; printf 'x'; tail -c +10 state; } >m.state
says "it is of another version of this program, or damaged" "$scene"
: >m.state
says "it is no state of view factors" "$scene"
cp "$scene" m.state
says "it is no state of view factors" "$scene"
rm m.state

refused() { # STATUS TEXT ARGUMENT...
    count=$((count + 1))
    wanted=$1 text=$2
    shift 2
    timeout 20 "$radiosity" viewfactors "$@" >out 2>err
    if [ $? != "$wanted" ] || [ "$(wc -l <err)" -gt 2 ] || ! grep -q -e "$text" err || [ -n "$(left x)" ]; then failed "$*"; fi
}
cp "$scenes/furnace.obj" "$scenes/furnace.mtl" . && mkdir folder
mv furnace.obj whole.obj && mv folder whole.folder
cp whole.obj whole.copy
refused 2 "this is the scene, which would be lost" whole.obj --resume whole.obj
refused 2 "two outputs would go there" whole.obj -o x --resume x
refused 1 "give the name of a file, not of a folder" whole.obj --resume whole.folder
refused 1 "make the folder first" whole.obj --resume none/x
refused 2 "does not go with --resume" whole.obj --sensor whole.x --resume x
refused 2 "a value is missing" whole.obj --resume
refused 1 "cannot be read: it is no file" whole.obj --resume /dev/null
check "the scene stays" cmp whole.copy whole.obj

finish resume
