#!/bin/sh
# check_params.sh - `radiosity solve --params FILE`: what a parameter file does, that --set goes before, and what is said
# of a file that is wrong: file, line, cause. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
scene=$top/examples/scenes/furnace.obj

solve() { "$radiosity" solve "$scene" -q --no-correct --no-errors "$@" 2>err; }
# LINE TEXT FILE [OPTION...]: file f with this text (of printf) is refused in that line with this text, in one line
refused() {
    line=$1 text=$2
    # shellcheck disable=SC2059 # the text has its own \n
    printf "$3" >f
    shift 3
    count=$((count + 1))
    solve --params f "$@" >out && failed "taken: $text"
    [ "$(wc -l <err)" = 1 ] && grep -qF "f:$line: error: $text" err && [ ! -s out ] || failed "not said in line $line: $text"
}
# FILE OPTIONS BESIDE: a solve with file f is that with BESIDE
same() {
    # shellcheck disable=SC2059
    printf "$1" >f
    count=$((count + 1))
    # shellcheck disable=SC2086 # words
    solve --oracle ff --params f $2 --faces a.csv --json a.json && solve --oracle ff $3 --faces b.csv --json b.json || failed "solve: $1"
    links() { sed -n 's/.*"links": *\([0-9]*\).*/\1/p' "$1"; }
    alike "$(links a.json)" "$(links b.json)" && cmp -s a.csv b.csv || failed "not the same: $1 $2 and $3"
}

same 'oracle ff\n' "" ""
same '# mine\n\n  oracle\tff \nlimit = 0.5 # rough\n\trays=4\n' "" "--set limit=0.5 --set rays=4"
same '\357\273\277oracle ff\nlimit = 0.5' "" "--set limit=0.5"
same 'oracle ff\r\nlimit = 5e-1\r\n' "" "--set limit=0.5"
same 'oracle ff\nlimit = 0.01' "--set limit=0.5" "--set limit=0.5"
same 'oracle ff\nlimit = inf\nmin_share = 0.1' "" "--set limit=inf --set min_share=0.1"
# Values do something, or all of this would be the same.
count=$((count + 1))
solve --oracle ff --set limit=0.01 --json b.json && [ "$(links a.json)" != "$(links b.json)" ] || failed "limit does nothing"

refused 2 "oracle ff has no parameter limits; did you mean limit?" 'oracle ff\nlimits = 1\n' --oracle ff
refused 3 "oracle ff has no parameter minshare; did you mean min_share?" 'oracle ff\n\nminshare=1' --oracle ff
refused 2 "oracle ff has no parameter nonsense; it has limit, min_area, min_share, rays" 'oracle ff\nnonsense = 1' --oracle ff
refused 2 "min_share = 2: out of range; min_share takes 0 to 1" 'oracle ff\nmin_share = 2' --oracle ff
refused 2 "rays = 4.5: not a whole number" 'oracle ff\nrays = 4.5' --oracle ff
refused 4 "limit is set twice, first in line 2; keep one of them" 'oracle ff\nlimit = 1\nrays = 4\nlimit = 1' --oracle ff
refused 1 "these are parameters of oracle bf, but --oracle is ff; give bf, or its file, by --oracle" 'oracle bf\n' --oracle ff
refused 1 "these are parameters of oracle ff, but --oracle is power" 'oracle ff\n'
refused 2 "the first line says whose parameters these are; write oracle ff" '\nlimit = 1\n' --oracle ff
refused 1 "the first line says whose parameters these are" 'oracle' --oracle ff
refused 1 "the first line says whose parameters these are" 'oracle a b' --oracle ff
refused 1 "the first line says whose parameters these are" 'ora ff' --oracle ff
refused 2 "limit has no value; write limit = NUMBER" 'oracle ff\nlimit =' --oracle ff
refused 2 "'0.1 W' is not a number; write limit = NUMBER" 'oracle ff\nlimit = 0.1 W' --oracle ff
refused 2 "'nan' is not a number" 'oracle ff\nlimit = nan' --oracle ff
refused 2 "limit = 1e999: too large to be a number here; inf is one" 'oracle ff\nlimit = 1e999' --oracle ff
refused 2 "'limit' sets nothing; write NAME = VALUE" 'oracle ff\nlimit' --oracle ff
refused 2 "'= 1' sets nothing" 'oracle ff\n= 1' --oracle ff
refused 2 "'$(printf '%065d' 0)' is too long for a name" "oracle ff\n$(printf '%065d' 0) = 1" --oracle ff
sed 's/param rays/fixed &/; s/oracle ff/oracle mine/' "$top/examples/oracles/ff.dag" >mine.dag
cp "$top/examples/oracles/common.dag" .
refused 2 "rays is fixed by the author of oracle mine, at 16: only its file can change that" 'oracle mine\nrays = 4' --oracle mine.dag --release dag

# A file that is none.
said() { # TEXT FILE
    count=$((count + 1))
    solve --oracle ff --params "$2" >out && failed "taken: $2"
    [ "$(wc -l <err)" = 1 ] && grep -qF "$1" err || failed "not said: $1"
}
said "none: error: cannot read: No such file or directory; check the name" none
said "error: cannot read: Is a directory; check the name" /
: >empty
said "empty: error: no line says whose parameters these are; write oracle ff" empty
printf 'oracle ff\nlimit\0 = 1' >zero
said "zero: error: not a text" zero
count=$((count + 1))
solve --oracle ff --set "rays=4" --set "limit=x" --params f >out && failed "--set is read, too"
solve --oracle mine.dag --release dag --set rays=4 >out && failed "--set of what is fixed"
grep -q -- "--set: error: rays is fixed by the author of oracle mine, at 16" err || failed "not said by --set: fixed"

finish params
