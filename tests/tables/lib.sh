# lib.sh - what generators of tables share; they read it by `. "$(dirname "$0")/lib.sh"`.
# SPDX-License-Identifier: MIT
set -eu
tables=${TABLES_FOLDER:-$(dirname "$0")} build=${BUILD:-build} radiosity=${BUILD:-build}/bin/radiosity
: "$tables" "$radiosity"
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 130' INT TERM
say() {
    echo "  $*" >&2
}

# The scenes that are here, each once, examples before others: of the folders in SCENES, but for those named in WITHOUT.
scenes() {
    for folder in ${SCENES:-examples/scenes tests/runtime ../shared/scenes ../shared/scenes/third-party}; do
        [ ! -d "$folder" ] || find "$folder" -maxdepth 1 -name '*.obj' | sort
    done | awk -F / -v without="${WITHOUT-gridroom_10000}" '
        BEGIN { split(without, name, " "); for (i in name) seen[name[i] ".obj"] = 1 }
        !seen[$NF]++'
}

# The file of a scene by its name; nothing when it is not here.
scene() {
    WITHOUT='' scenes | grep "/$1.obj\$" || true
}

# What judge.sh says, behind the words LABEL, to $tmp/rows. (Not through a pipe: that would hide that it failed.)
judge() { # LABEL RADIOSITY SCENE OPTION...
    label=$1
    shift
    sh "$tables/judge.sh" "$@" >"$tmp/judged"
    sed "s/^/$label /" "$tmp/judged" >>"$tmp/rows"
}

# The name of a scene in rows: those of a folder third-party, which are not shipped, have @ behind it.
row_name() { # FILE
    case $1 in
    */third-party/*) echo "$(basename "$1" .obj)@" ;;
    *) basename "$1" .obj ;;
    esac
}

# A command and those lines of what it prints that tell of errors, as a block of code.
solve_lines() { # SCENE OPTION...
    echo "    \$ build/bin/radiosity solve $*"
    "$radiosity" solve "$@" >"$tmp/out" 2>&1
    grep -E '^(mended|error|accuracy) ' "$tmp/out" >"$tmp/lines"
    sed 's/^/    /' "$tmp/lines"
}

# Functions of the awk programs that print rows: 1234567 is "1.2 M"; .0123 is "1.2".
numbers='
function count(x) { return x == "" ? "-" : x >= 999500 ? sprintf("%.3g M", x / 1e6) : x >= 999.5 ? sprintf("%.3g k", x / 1e3) : sprintf("%d", x) }
function percent(x) { return x == "" ? "-" : sprintf(x < .00995 && x > -.00995 ? "%.2f" : "%.1f", 100 * x) }
# Of a scene without a face above a hundredth of its area there is no worst.
function worst(x, face, faces) { return face == faces ? "-" : percent(x) }
function signed(x) { return x == "" ? "-" : sprintf("%+.2f", 100 * x) }
function called(name) { return sub(/@$/, "", name) ? "`" name "` (third-party)" : "`" name "`" }
function time(x) { return x == "" ? "-" : sprintf(x < 9.95 ? "%.1f" : "%.0f", x) }
'
