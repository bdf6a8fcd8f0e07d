# lib.sh - what the scripts that check radiosity share; they read it by `. "$(dirname "$0")/lib.sh"` and end with
# `finish NAME`.
#
# They find themselves in an empty folder, $tmp, that goes when they end; $top is the project's folder, $radiosity the command
# that RADIOSITY names, $scenes and $oracles the examples.
# SPDX-License-Identifier: MIT
set -u
top=$(cd "$(dirname "$0")/../.." && pwd)
radiosity=$(realpath "${RADIOSITY:-$top/build/bin/radiosity}")
scenes=$top/examples/scenes oracles=$top/examples/oracles
: "$radiosity" "$scenes" "$oracles"
# shellcheck source=tests/support/script.sh
. "$top/tests/support/script.sh"

# TEXT...: this, and what the command wrote to the file err or else to out
failed() {
    bad=$((bad + 1))
    echo "failed: $*"
    if [ -s err ]; then head -n 12 err; elif [ -s out ]; then head -n 12 out; fi
}
check() { # WHAT COMMAND...: the command must succeed
    what=$1
    shift
    count=$((count + 1))
    ${quietly:-} "$@" || failed "$what"
}
alike() { # A B: the same words, and some?
    [ -n "$1" ] && [ "$1" = "$2" ]
}
within() { # A B SHARE: is B no farther from A than this share of it? What is no number, as a value that is missing, is not.
    awk -v a="$1" -v b="$2" -v share="$3" 'BEGIN {
        d = a - b; if (d < 0) d = -d; exit !(a == a + 0 && b == b + 0 && d <= share * (a < 0 ? -a : a)) }'
}
first_number() { # KEY FILE.json
    sed -n "s/.*\"$1\": \\([-0-9.e+]*\\),*$/\\1/p" "$2" | head -n 1
}
told() { grep -q "$1" err || failed "not told: $1"; }
into_files() { # COMMAND...; a script whose checks write too much says quietly=into_files
    "$@" >out 2>err
}
