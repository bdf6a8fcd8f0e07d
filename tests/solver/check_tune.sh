#!/bin/bash
# check_tune.sh - what `radiosity tune` says to oracles, parameters, scenes and files that it cannot work with, where it
# writes, and that what was found so far is kept when it is stopped. RADIOSITY names the command.
# Once is enough: fits are numbers, and check_tune reads what it reads.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export OMP_WAIT_POLICY=passive # many short solves beside other suites
# STATUS TEXT ARGUMENT...: ends with this status, says one line with this text, and writes nothing
says() {
    wanted=$1 text=$2
    shift 2
    count=$((count + 1))
    ls >before
    "$radiosity" tune "$@" >out 2>err
    status=$?
    rm -f out
    if [ $status != "$wanted" ] || [ "$(wc -l <err)" != 1 ] || ! grep -qF -- "$text" err || [ "$(ls | grep -v '^err$')" != "$(grep -v '^err$' before)" ]; then
        failed "radiosity tune $*: exit $status, not $wanted with: $text"
    fi
    rm -f err
}
room=$scenes/furnace.obj
sed -e 's/^oracle ff/oracle mine/' "$oracles/ff.dag" >mine.dag
cp "$oracles/common.dag" .

# ---- the command line
says 2 "an oracle and scenes are needed"
says 2 "no scene is given" ff
says 2 "the oracle's name is empty" ""
says 2 "a scene's name is empty" ff ""
says 2 "$room is named twice" ff "$room" "$room"
says 2 "/./furnace.obj is named twice" ff "$room" "${room%/*}/./${room##*/}"
for value in 0 0% 1 100% x -1; do says 2 "--error takes a share" ff "$room" --error $value; done
"$radiosity" tune ff "$room" --basis constant --error 20% --evaluations 1 --json b.json -q >out 2>err
check "--basis constant" grep -q '"basis": "constant"' b.json
rm -f b.json out err
says 2 "--basis takes constant or linear, not square" ff "$room" --basis square
for value in 0 65 x 1.5; do says 2 "--power takes a whole number from 1 to 64" ff "$room" --power $value; done
for value in 0 10001 x; do says 2 "--evaluations takes a whole number from 1" ff "$room" --evaluations $value; done
says 2 "--cost takes rays, links or time" ff "$room" --cost seconds
says 2 "-o takes a file named .dag" ff "$room" -o x.txt
says 2 "tune has no option --set; solve has" ff "$room" --set limit=1
says 2 "this is the scene, which would be lost" ff "$room" --json "$room"

# ---- oracles, parameters, scenes
says 1 "no such oracle" nix "$room"
says 1 "none.dag: error: cannot read the oracle" none.dag "$room"
says 1 "none.obj: error" ff none.obj
says 1 "ff has no parameter nix; it has limit, min_area, min_share, rays" ff "$room" --param nix
says 1 "rays is a whole number" ff "$room" --param rays
says 1 "min_area is 0" ff "$room" --param min_area
sed 's/param limit /fixed &/' mine.dag >fixed.dag
says 1 "limit is fixed by its author" fixed.dag "$room" --param limit
says 1 "say which to fit by --param NAME: min_share" fixed.dag "$room"
says 1 "limit is named twice" ff "$room" --param limit --param limit=1:2
for range in 1:0.5 0:1 1 :1 1: 1:2:3 x:y -1:1 nan:1 1:inf ''; do
    says 2 "--param takes NAME, or NAME=LOW:HIGH with numbers 0 < LOW <= HIGH, not limit=$range" ff "$room" --param limit=$range
done
says 1 "limit: no value between 0.061 and 0.062" ff "$room" --param limit=0.061:0.062
says 1 "say which to fit by --param NAME: threshold_1" tester "$room"
{ sed 's/Ke .*/Ke 0 0 0/' "$scenes/furnace.mtl" >dark.mtl; sed 's/furnace.mtl/dark.mtl/' "$room" >dark.obj; }
says 1 "particles was reflected, so that no error can be told" ff dark.obj

# ---- where it writes
mkdir away
says 1 "away/mine.dag: error: mine.dag does not compile in that folder" mine.dag "$room" -o away/mine.dag
says 1 "no/mine.dag: error" mine.dag "$room" -o no/mine.dag
how="$room --error 20% --evaluations 6 -q"
cp mine.dag was.dag
# shellcheck disable=SC2086
"$radiosity" tune mine.dag $how -o mine.dag >out 2>err
check "a file in its place" [ $? = 0 ]
check "-q is quiet" [ ! -s out ]
check "one line is another" [ "$(diff was.dag mine.dag | grep -c '^[<>]')" = 2 ]
check "by its number alone" [ "$(sed 's/\(param limit *: ratio = \)[0-9.]*/\10.05/' mine.dag | cksum)" = "$(cksum <was.dag)" ]
check "the new one solves" "$radiosity" solve "$room" --oracle mine.dag -q --no-errors --no-correct
# shellcheck disable=SC2086
"$radiosity" tune ff $how -o away/ff.dag >out 2>err
check "a built-in one stands alone" "$radiosity" solve "$room" --oracle away/ff.dag -q --no-errors --no-correct
check "both are fitted alike" alike "$(grep 'param limit' away/ff.dag)" "$(grep 'param limit' mine.dag)"
# shellcheck disable=SC2086
"$radiosity" tune ff $room --error 20% --evaluations 2 >out 2>err
check "one scene" grep -q "^not cross-validated: that takes two scenes or more" out
check "its table" grep -q "^  limit  *0.05 " out

# ---- a furnace asks for no link, a shadow for many: what is found does not carry over; said, and told by the status
"$radiosity" tune bf "$room" "$scenes/cornell.obj" --error 8% --power 2 --evaluations 7 --json t.json >out 2>err
check "status 3" [ $? = 3 ]
check "the verdict" grep -q "^cross-validation: FAILS: " out
check "in JSON" grep -q '"carries_over": false' t.json

# ---- stopped: the best so far
env --default-signal=INT "$radiosity" tune bf_guarded "$scenes/cornell.obj" "$room" --error 4% -o stopped.dag >out 2>err &
pid=$!
for i in $(seq 100); do
    sleep 0.2
    kill -0 $pid 2>/dev/null && [ "$i" -lt 5 ] && continue
    break
done
kill -INT $pid 2>/dev/null
wait $pid
status=$?
if [ $status = 130 ] && [ -s out ]; then
    check "stopped" grep -q "stopped, the best so far\|not finished" out
    check "and written" "$radiosity" solve "$room" --oracle stopped.dag -q --no-errors --no-correct
elif [ $status = 130 ]; then
    check "stopped before anything was fitted" grep -q "^stopped before anything was fitted" err
    check "nothing is written" [ ! -e stopped.dag ]
else
    check "ended before it could be stopped" [ $status = 0 -o $status = 3 ]
fi
if [ -n "${THOROUGH-}" ]; then
    "$radiosity" tune bf_guarded "$scenes/cornell.obj" "$room" --error 1% --evaluations 10000 --limit-seconds 1 >out 2>err
    check "stopped by time" grep -q "stopped, the best so far" out
fi

finish tune
