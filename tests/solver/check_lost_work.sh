#!/bin/sh
# check_lost_work.sh - runs that are stopped, that find no memory, or whose names are odd: old outputs stay whole, nothing is
# left behind, and one line says what happened. RADIOSITY names the command. With THOROUGH 296 runs are stopped, not 28.
# Once is enough: it is about files and signals.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
mkdir scratch
export TMPDIR=$tmp/scratch
quietly=into_files

# ---- signals: it dies by them, says so, and leaves nothing
# SIGNAL STATUS SECONDS ARGUMENT...
stopped() {
    signal=$1 wanted=$2 after=$3
    shift 3
    count=$((count + 1))
    stopped_by "$signal" "$after" "$radiosity" "$@" >out 2>err
    got=$?
    [ $got = "$wanted" ] && [ "$(wc -l <err)" = 1 ] && grep -q "^radiosity: stopped by a signal; nothing was written$" err ||
        failed "$* by $signal: exit $got"
    left=$(ls -A scratch; ls -A | grep -vxE 'scratch|out|err|cc|.*\.dag')
    [ -z "$left" ] || { failed "$* by $signal left $left"; rm -rf scratch/* ./*.tmp; }
}
for signal in INT:130 TERM:143 HUP:129; do
    stopped ${signal%:*} ${signal#*:} 0.2 viewfactors "$scenes/sejour.obj" -q -o m.csv --names n
done
stopped INT 130 0.2 study stability -q -o t.csv
stopped TERM 143 0.2 study causes "$scenes/room.obj" -q --rays 1000000000 --json j
# A compiler that takes its time: what is compiled lies in a folder of its own, which goes in any case.
cp "$top/examples/oracles/bf.dag" "$top/examples/oracles/common.dag" .
printf '#!/bin/sh\nsleep 0.6\nexec cc "$@"\n' >cc && chmod +x cc
export CC="$tmp/cc"
stopped TERM 143 0.3 solve "$scenes/furnace.obj" -q --oracle bf.dag --faces f.csv
unset CC
check "an oracle that is compiled" "$radiosity" solve "$scenes/furnace.obj" -q --no-correct --oracle bf.dag
check "what was compiled is gone" [ -z "$(ls -A scratch)" ]

# ---- runs stopped at any moment: old outputs or new ones, whole, and nothing else
# RUNS "FILE..." "FILE TOGETHER..." ARGUMENT...: a command that writes these files to the folder o; those together are all new
# or none. JSON tells seconds, and tune what it has by then: any that is whole is new. A state file is there to go on from.
at_random() {
    runs=$1 files=$2 together=$3
    shift 3
    mkdir o new old
    begin=$(date +%s.%N)
    check "a run to compare with: $*" "$radiosity" "$@"
    whole=$(echo "$begin $(date +%s.%N)" | awk '{ print $2 - $1 }')
    cp o/* new
    for file in $files; do echo "old $file" >old/$file; done
    ended=0 run=0
    for after in $(awk -v n="$runs" -v whole="$whole" -v seed="$#" 'BEGIN { srand(seed); for (i = 0; i < n; i++) printf "%.3f ", 0.002 + 1.1 * whole * rand() }'); do
        count=$((count + 1)) run=$((run + 1))
        signal=$(echo "TERM INT HUP KILL" | cut -d ' ' -f $((run % 4 + 1)))
        cp old/* o
        # Of a shell's own, which tells the terminal who was killed.
        sh -c 'timeout -s "$@"; exit $?' sh "$signal" "$after" "$radiosity" "$@" >out 2>&1 && ended=$((ended + 1))
        rm -f o/*.state
        for file in $files; do
            cmp -s o/$file old/$file || cmp -s o/$file new/$file || is_whole o/$file ||
                failed "$1: $signal after $after s: $file is neither old nor new"
        done
        news=0
        for file in $together; do cmp -s o/$file old/$file || news=$((news + 1)); done
        [ "$signal" = KILL ] || [ $news = 0 ] || [ $news = "$(echo $together | wc -w)" ] ||
            failed "$1: $signal after $after s: of $together one is new"
        # Nobody can tidy up after SIGKILL.
        [ "$signal" != KILL ] || rm -rf o/*.tmp scratch/*
        [ "$(ls -A o | wc -l)" = "$(echo $files | wc -w)" ] && [ -z "$(ls -A scratch)" ] || failed "$1: $signal after $after s left $(ls -A o scratch)"
        rm -rf o/*.tmp scratch/*
    done
    echo "$1, stopped at random: $ended of $runs had ended before"
    rm -rf o new old
}
is_whole() { # FILE: does it begin and end as such a file does?
    case $1 in
    *.json) [ "$(head -n 1 "$1")" = "{" ] && [ "$(tail -n 1 "$1")" = "}" ] ;;
    *.dag) grep -q '^oracle' "$1" && [ "$(tail -n 1 "$1")" = "}" ] ;;
    *) false ;;
    esac
}
at_random $([ -n "${THOROUGH-}" ] && echo 200 || echo 12) "f.csv m.obj m.mtl p.png" "m.obj m.mtl" solve "$scenes/furnace_4.obj" -q --no-errors --no-correct --faces o/f.csv -o o/m.obj --image o/p.png --size 320x240
at_random ${THOROUGH:+2}4 "m.csv n.csv j.json" "" viewfactors "$scenes/furnace_4.obj" -q --tolerance 0.01 -o o/m.csv --names o/n.csv --json o/j.json
at_random ${THOROUGH:+2}4 "t.dag j.json" "" tune ff "$scenes/furnace.obj" -q --evaluations 8 --error 20% -o o/t.dag --json o/j.json
at_random ${THOROUGH:+2}4 "r.csv j.json" "" reference "$scenes/furnace_4.obj" -q --accuracy 2% -o o/r.csv --json o/j.json
at_random ${THOROUGH:+2}4 "j.json" "" compare "$scenes/furnace_4.obj" -q --repeats 1 --json o/j.json

# ---- names that are no UTF-8, and parameters without end: JSON all the same
check_json() { # FILE ARGUMENT...
    count=$((count + 1))
    file=$1
    shift
    "$radiosity" "$@" >out 2>err && [ -s "$file" ] && iconv -f UTF-8 -t UTF-8 "$file" >out 2>&1 &&
        ! grep -qiE '(inf|nan)(inity)?[,}]?$' "$file" || failed "JSON of $*"
    rm -f "$file"
}
odd=$(printf 'caf\351')
cp "$scenes/furnace.obj" "$odd.obj" && cp "$scenes/furnace.mtl" .
mv bf.dag "$odd.dag"
for value in 1 inf; do check_json j solve "$odd.obj" -q --no-correct --set energy=$value --json j; done
"$radiosity" solve "$odd.obj" -q --no-correct --set energy=inf --json j >out 2>err
check "an infinite parameter is none" grep -q '"energy": null' j
rm -f j
check_json j.json solve "$odd.obj" -q --no-correct --set energy=inf --statistics j.json
check_json j viewfactors "$odd.obj" -q --json j
check_json j explain "$odd.obj" -q --pair 0,1 --set energy=inf --json j
check_json j study causes "$odd.obj" -q --rays 100 --oracle "$odd.dag" --json j

# ---- what was not reached is told, with -q, too
count=$((count + 1))
"$radiosity" solve "$scenes/cornell.obj" -q --no-correct --no-errors --iterations 1 >out 2>err
[ $? = 3 ] && [ "$(wc -l <err)" = 1 ] && grep -q "warning: not converged after [0-9]* sweeps" err || failed "--iterations 1"

unfinished() { # ARGUMENT...
    count=$((count + 1))
    "$radiosity" "$@" -q --iterations 1 >out 2>err
    [ $? = 3 ] && [ "$(wc -l <err)" = 1 ] && grep -q "warning: not converged after [0-9]* sweeps" err || failed "$*"
}
unfinished compare "$scenes/furnace.obj" --repeats 1
unfinished study clustering "$scenes/furnace.obj" --only sah
unfinished study form-factors "$scenes/furnace.obj"
unfinished study causes "$scenes/furnace.obj" --rays 1000

# ---- the compiler's command may have words, its path blanks, and an oracle's name may look like an option
mv "$odd.dag" ./-o.dag
check "an oracle called -o.dag" "$radiosity" solve "$scenes/furnace.obj" -q --no-correct --oracle -o.dag
printf '#!/bin/sh\necho "$1 $2" >>ran\nexec "$@"\n' >wrapper && chmod +x wrapper
check "CC of several words" env CC="./wrapper cc -O1" "$radiosity" solve "$scenes/furnace.obj" -q --no-correct --oracle -o.dag
check "the wrapper ran" grep -qx "cc -O1" ran
mkdir "a folder" && printf '#!/bin/sh\necho blanks >>ran\nexec cc "$@"\n' >"a folder/cc" && chmod +x "a folder/cc"
check "CC whose path has a blank" env CC="./a folder/cc" "$radiosity" solve "$scenes/furnace.obj" -q --no-correct --oracle -o.dag
check "that compiler ran" grep -qx blanks ran
count=$((count + 1))
CC="no such-compiler" "$radiosity" solve "$scenes/furnace.obj" -q --oracle -o.dag >out 2>err
[ $? = 1 ] && grep -q "cannot run the C compiler 'no such-compiler'" err || failed "no compiler"

# ---- no memory: one line from every phase, whatever the limit. Sanitizers need more address space than any.
if (ulimit -v 4000000 && "$radiosity" --version) >out 2>&1; then
    limited() { # MB ARGUMENT...
        count=$((count + 1))
        limit=$1
        shift
        (ulimit -v $((limit * 1000)) && exec timeout 20 "$radiosity" "$@") >out 2>err
        got=$?
        [ $got = 0 ] && [ ! -s err ] && return
        # Below some limit the loader finds no room for the libraries.
        [ $got = 127 ] && grep -q "shared object" err && return
        [ $got = 1 ] && [ "$(wc -l <err)" = 1 ] && grep -qi "memory" err || failed "$* in $limit MB: exit $got"
    }
    for limit in 100 150 ${THOROUGH:+200 205 210} 215 221 224 227 230 ${THOROUGH:+233 240 250 260 270 280}; do
        limited $limit viewfactors "$scenes/cornell.obj" -q -o out
    done
    for limit in 120 210 ${THOROUGH:+215 220 225 227 235} 230 240 ${THOROUGH:+250 260 300 350 400}; do
        limited $limit solve "$scenes/furnace.obj" -q --image p.png --size 64x64
    done
    for limit in 215 ${THOROUGH:+220 225 230 235 240 245 250 255} 260; do limited $limit study visibility "$scenes/furnace.obj" -q --rays 4; done
fi

finish "lost work"
