#!/bin/bash
# check_reference.sh - `radiosity reference`: its table, the accuracy that it promises, runs that are stopped and go on, and
# states that are damaged or of another scene. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }

# ---- a furnace: B = E / (1 - rho) = 2 on all faces, within what the table says of itself
"$radiosity" reference "$scenes/furnace.obj" -o f.csv --accuracy 0.4% --json f.json >out 2>err
check "a furnace" [ $? = 0 ]
check "no word on standard error" [ ! -s err ]
check "columns" [ "$(head -n 1 f.csv)" = "face,area,B_0,se_0" ]
check "rows" [ "$(wc -l <f.csv)" = 7 ]
check "B of a furnace" awk -F, 'NR > 1 && !($2 == 1 && $4 > 0 && ($3 - 2) ^ 2 < 25 * $4 ^ 2) { bad = 1 } END { exit bad }' f.csv
check "the promised error" less "$(first_number both f.json)" 0.004
check "reflected" less 5.9 "$(first_number reflected f.json)"
check "they agree" grep -q '"agree": true' f.json
check "no state is left" [ ! -e f.csv.state ]
cat >exact.csv <<END
face,area,E_0,B_0
0,1,1,2
1,1,1,2
2,1,1,2
3,1,1,2
4,1,1,2
5,1,1,2
END
"$radiosity" error exact.csv f.csv --json e.json >out 2>err
check "error reads it" less "$(first_number l1_faces e.json)" 0.008
check "two-sided area" sh -c "'$radiosity' reference '$scenes/furnace.obj' --two-sided -q -o t.csv --accuracy 2% && sed -n 2p t.csv | grep -q '^0,2,'"

# ---- three bands, any number of threads, in one go or in two: the same bytes
how="$scenes/cornell.obj --accuracy 0.6% -q"
check "one thread" "$radiosity" reference $how -o one.csv --threads 1
check "three threads" "$radiosity" reference $how -o three.csv --threads 3
check "the same on any threads" cmp one.csv three.csv
check "bands" [ "$(head -n 1 one.csv)" = "face,area,B_0,B_1,B_2,se_0,se_1,se_2" ]
check "coarse first" "$radiosity" reference "$scenes/cornell.obj" --accuracy 3% -q --keep -o two.csv
check "its state is kept" [ -s two.csv.state ]
check "not yet the same" sh -c '! cmp -s one.csv two.csv'
cp two.csv.state state
"$radiosity" reference "$scenes/cornell.obj" --accuracy 0.6% -o two.csv >out 2>err
check "it goes on" grep -q "^goes on from two.csv.state: .* particles" out
check "the same in two runs" cmp one.csv two.csv
check "the state is gone" [ ! -e two.csv.state ]

# ---- a small lamp over the floor of a hall: paths miss the bright spot, and are sure of the rest. What is emitted is absorbed
cat >hall.mtl <<'END'
newmtl wall
Kd .5 .5 .5
newmtl lamp
Kd .99 .99 .99
Ke 1000 1000 1000
END
cat >hall.obj <<'END'
mtllib hall.mtl
v 0 0 0
v 200 0 0
v 200 200 0
v 0 200 0
v 0 0 4
v 200 0 4
v 200 200 4
v 0 200 4
v 100 100 .05
v 100 100.05 .05
v 100.05 100.05 .05
v 100.05 100 .05
usemtl wall
f 1 2 3 4
f 8 7 6 5
f 1 5 6 2
f 3 7 8 4
f 4 8 5 1
f 2 6 7 3
usemtl lamp
f 9 10 11 12
END
check "a hall" "$radiosity" reference hall.obj --accuracy 0.5% -q -o hall.csv
# walls absorb as much as they reflect; the lamp takes a thousandth
reflected=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next } $at["face"] < 6 { sum += $at["area"] * $at["B_0"] } END { print sum }' hall.csv)
check "of 2.5 W, $reflected W are absorbed" within 2.5 "$reflected" 0.02

# ---- stopped by a signal, three times, at whatever place; also when its table is there already
check "at one go" "$radiosity" reference "$scenes/cornell.obj" --accuracy 0.2% -q -o whole.csv
: >long.csv.log
kept= # 1: a run has left a state
for i in 1 2 3 4 5 6 7 8; do
    env --default-signal=INT "$radiosity" reference "$scenes/cornell.obj" --accuracy 0.2% --threads 1 -o long.csv >out 2>err &
    pid=$!
    [ $i -lt 4 ] && { catches $pid; sleep 0.2; kill -INT $pid 2>/dev/null || kill -TERM $pid 2>/dev/null; }
    wait $pid
    status=$?
    echo $status >>long.csv.log
    [ $status = 130 ] || break
    if grep -q "stopped by a signal; of its files 1 was written before" err; then
        status=0
        break
    fi
    check "a stopped run has no table" [ ! -e long.csv ]
    # else it was stopped before it traced anything, and says that or, before it could, nothing
    if [ -s err ] && ! grep -q "^radiosity: stopped by a signal; nothing was written$" err; then
        check "it says so" grep -q "^stopped after .*goes on from long.csv.state" err
        kept=1
    fi
    [ -z "$kept" ] || check "it leaves a state" [ -s long.csv.state ]
done
check "it was stopped at least once" grep -q 130 long.csv.log
check "and ended" [ $status = 0 ]
check "the same after being stopped" cmp whole.csv long.csv

# ---- states that are none of this scene's
says() { # TEXT: the run with the state x.csv.state ends with 1 and this line, and touches nothing
    count=$((count + 1))
    cp x.csv.state before
    "$radiosity" reference "$scenes/cornell.obj" --accuracy 3% -o x.csv >out 2>err
    if [ $? != 1 ] || ! grep -q "^x.csv.state: error: $1.*; remove it to start anew" err || [ "$(wc -l <err)" != 1 ] ||
        [ -e x.csv ] || ! cmp -s before x.csv.state; then
        failed "$1"
    fi
}
"$radiosity" reference "$scenes/furnace.obj" --accuracy 3% -q --keep -o x.csv && rm x.csv
says "it is of another scene"
head -c 1000 state >x.csv.state
says "it is damaged"
{ head -c 1000 state; echo; tail -c +1002 state; } >x.csv.state
says "it is damaged"
: >x.csv.state
says "it is no state of a reference"
echo "this is a text, and longer than what stands before a state, which is some hundred bytes long, as far as one can see, or more" >x.csv.state
says "it is no state of a reference"

# ---- nothing is reflected, as planes tell, or of black: a plate beside a lamp that looks up, a millimetre higher. What nobody
# has seen: check_unseen.sh
printf 'mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1.2 .2 .001\nv 1.2 .8 .001\nv 1.8 .8 .001\nv 1.8 .2 .001\nusemtl grey_1s\nf 1 2 3 4\nusemtl lamp_1s\nf 8 7 6 5\n' >two.obj
for grey in 0.5 0; do
    printf 'newmtl grey_1s\nKd %s %s %s\nnewmtl lamp_1s\nKd 0 0 0\nKe 1 1 1\n' $grey $grey $grey >two.mtl
    "$radiosity" reference two.obj -o two.csv >out 2>err || failed "two plates"
    grep -q '^nothing is reflected: B is E, exactly$' out || failed "two plates of $grey"
done
count=$((count + 4))

finish reference
