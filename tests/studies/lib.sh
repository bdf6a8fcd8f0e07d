# lib.sh - what studies share; they read it by `. "$(dirname "$0")/lib.sh"`.
#
# A study is a script: it runs what has no row yet in RESULTS/NAME.csv, then makes a page, its charts and a copy of the rows
# it tells of in PAGES: NAME.md, NAME.svg, NAME.csv. A row is one run. Its first fields are its key (what was run, with which
# options, and the checksum of the command), the others what was measured, or `-`; a run that took longer than LIMIT has
# nothing but `-`. A row is written whole when its run has ended, so a study that was stopped goes on where it was.
#
# BUILD: where the commands are (build); RESULTS: BUILD/studies; PAGES: examples/studies; SCENES_OF_STUDIES: names of scenes
# instead of the study's own; BUDGET: processor seconds that a study may take for each scene; LIMIT:
# seconds for one run.
# SPDX-License-Identifier: MIT
set -euo pipefail
export LC_ALL=C TABLES_FOLDER=${TABLES_FOLDER:-$(dirname "$0")/../tables} BUILD=${BUILD:-build}
studies=$(dirname "$0") results=${RESULTS:-$BUILD/studies} pages=${PAGES:-examples/studies}
study=$(basename "$0" .sh)
. "$TABLES_FOLDER/lib.sh"
radiosity=${RADIOSITY:-$BUILD/bin/radiosity}
binary=$(cksum <"$radiosity" | cut -d ' ' -f 1)
mkdir -p "$results" "$pages"
fail() {
    echo "study $study: error: $*" >&2
    exit 1
}
command -v gnuplot >/dev/null || fail "gnuplot is missing, which draws the charts: apt-get install gnuplot-nox"

# ---- rows

# Take up RESULTS/NAME.csv, or begin it. The columns KEYS are the key; a line that no row can be is told and nothing is run.
rows_open() { # NAME KEYS COLUMNS, each list with commas
    rows=$results/$1.csv keys=$2 columns=$3
    [ -s "$rows" ] || echo "$keys,$columns" >"$rows"
    awk -F , -v header="$keys,$columns" -v keys="$(awk -F , '{ print NF }' <<<"$keys")" '
        BEGIN { fields = split(header, name, ",") }
        function bad(what) { printf "%s:%d: error: %s\n", FILENAME, FNR, what >"/dev/stderr"; wrong = 1; exit }
        FNR == 1 { if ($0 != header) bad("these are not the columns of this study; move the file away"); next }
        NF != fields { bad(NF " fields, not " fields ": a row that was cut short; remove the line, its run is then made again") }
        {
            for (i = keys + 1; i <= NF; i++)
                if ($i !~ /^(-|[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?)$/)
                    bad(name[i] " is \"" $i "\", neither a number nor -; remove the line, its run is then made again")
            key = $1
            for (i = 2; i <= keys; i++) key = key FS $i
            if (seen[key]++) bad("a second row of " key "; remove one of them")
        }
        END { exit wrong }' "$rows" || exit 1
    # a last line without its end is a whole row: append to the next
    [ -z "$(tail -c 1 "$rows")" ] || echo >>"$rows"
}

have_row() { # KEY: fields with commas
    awk -v key="$1," 'index($0, key) == 1 { found = 1; exit } END { exit !found }' "$rows"
}

# A column of a row; nothing when there is no such row.
value_of() { # KEY COLUMN
    awk -F , -v key="$1," -v column="$2" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
        NR > 1 && index($0, key) == 1 { print $at[column]; exit }' "$rows"
}

# Run a command that prints names and values, line by line, and keep what has a column; nothing when the row is there.
measure() { # KEY COMMAND...
    local key=$1 status=0
    shift
    ! have_row "$key" || return 0
    say "${key%,*}"
    "$@" >"$tmp/measured" || status=$?
    [ $status = 124 ] || [ $status = 0 ] || fail "$key: '$*' ended with exit status $status"
    [ $status = 0 ] || echo "  more than ${LIMIT:-} s: no finer run of it" >&2
    awk -v key="$key" -v columns="$columns" '
        { value[$1] = $2 }
        END {
            n = split(columns, name, ",")
            line = key
            for (i = 1; i <= n; i++) line = line "," (name[i] in value && value[name[i]] != "" ? value[name[i]] : "-")
            print line
        }' "$tmp/measured" >"$tmp/row"
    cat "$tmp/row" >>"$rows"
}

# The rows of this command alone, with their header, to a file.
rows_of_binary() { # FILE
    awk -F , -v binary="$binary" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == "binary") at = i; print; next }
        $at == binary' "$rows" >"$1"
    [ "$(wc -l <"$1")" -gt 1 ] || fail "no row of $radiosity is in $rows"
}

# ---- time

# Run a command under the LIMIT, its processor time (s) to `took`. Exit status: its own, or 124.
timed() { # COMMAND...
    local TIMEFORMAT='%U %S' status=0
    { time timeout "${LIMIT:-60}" "$@" >"$tmp/timed.out" 2>"$tmp/timed.err"; } 2>"$tmp/timed" || status=$?
    [ $status = 0 ] || [ $status = 124 ] || cat "$tmp/timed.err" >&2
    took=$(awk 'END { print $1 + $2 }' "$tmp/timed")
    return $status
}

# Processor seconds of all that has been run so far.
spent() {
    times >"$tmp/times"
    awk 'END { gsub(/m/, " "); gsub(/s/, ""); print int(60 * ($1 + $3) + $2 + $4) }' "$tmp/times"
}
budget_start=0
budget_begin() {
    spent >"$tmp/spent"
    budget_start=$(cat "$tmp/spent")
}
# Is there something left of a scene's budget (s)?
in_budget() { # BUDGET
    spent >"$tmp/spent"
    [ $(($(cat "$tmp/spent") - budget_start)) -lt "$1" ]
}
# Say how many runs of a scene its budget left out, if any.
say_left() { # SCENE BUDGET RUNS
    [ "$3" = 0 ] || say "$1: the budget of $2 s is spent, $3 runs are left for another time"
}

# ---- pages

# What gnuplot draws of a script at standard input, with ink and paper that follow the reader's light or dark. Ink is
# #111111, paper #fefefe.
draw() { # FILE.svg WIDTH,HEIGHT
    {
        echo "set terminal svg size $2 dynamic font 'sans-serif,13' background '#fefefe'"
        echo "set border lc rgb '#111111'"
        echo "set key textcolor rgb '#111111'"
        for what in title xlabel ylabel; do echo "set $what textcolor rgb '#111111'"; done
        cat
    } >"$tmp/script.gp"
    gnuplot "$tmp/script.gp" >"$tmp/chart.svg" 2>"$tmp/gnuplot.err" || { cat "$tmp/gnuplot.err" >&2 && fail "gnuplot cannot draw $1"; }
    sed -e 's,^<title>.*</title>,<style>@media (prefers-color-scheme: dark) { [fill="#fefefe"] { fill: #0d1117 } [fill="rgb(17\,17\,17)"]\, [fill="black"] { fill: #e6edf3 } [stroke="rgb( 17\,  17\,  17)"]\, [stroke="black"] { stroke: #e6edf3 } [color="black"] { color: #e6edf3 } }</style>,' \
        -e '/^<desc>/d' -e '/^$/d' "$tmp/chart.svg" >"$tmp/chart.new.svg"
    mv "$tmp/chart.new.svg" "$1"
}

machine() {
    echo "$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2>/dev/null | head -n 1), $(nproc) processors"
}

# The head of a page: its title and what is asked; and how it is made again.
page_head() { # TITLE QUESTION
    printf '# %s\n\n%s\n\n    make bench STUDIES=%s\n\n' "$1" "$2" "$study"
    printf 'Made by `tests/studies/%s.sh`, sentences and figures included, from the rows in [%s.csv](%s.csv) (%s).\n\n' \
        "$study" "$study" "$study" "$(machine)"
}
