# lib.sh - what the scripts that check dagc share; they read it by `. "$(dirname "$0")/lib.sh"` and end with `finish NAME`.
#
# They find themselves in an empty folder, $tmp, that goes when they end; $top is the project's folder, $dagc the command that
# DAGC names, $catalog the one of dagc's own tests.
# SPDX-License-Identifier: MIT
set -u
top=$(cd "$(dirname "$0")" && pwd)
while [ ! -f "$top/install.mk" ]; do top=$(dirname "$top"); done
dagc=$(realpath -e "${DAGC:-$top/build/bin/dagc}") || exit 2
catalog=$top/tests/dagc/test_catalog.dag
: "$catalog"
# shellcheck source=tests/support/script.sh
. "$top/tests/support/script.sh"

check() { # NAME COMMAND...
    name=$1
    shift
    count=$((count + 1))
    if ! "$@" >"$tmp/out" 2>&1; then
        bad=$((bad + 1))
        echo "failed: $name"
        head -n 20 "$tmp/out"
    fi
}
says() { # TEXT COMMAND...
    text=$1
    shift
    "$@" 2>&1 | tee said | grep -q -- "$text" || { cat said; return 1; }
}
break_c() { # CHANGE: makes `broken`, a C compiler that changes so by sed what dagc --prove has it compile
    printf '#!/bin/sh\nfor f; do case $f in *oracles.c) sed -i "%s" "$f";; esac; done\nexec cc "$@" -O0\n' "$1" >broken
    chmod +x broken
}
have() { # PROGRAM
    command -v "$1" >/dev/null && return
    echo "skipped: $1 is not installed"
    return 1
}
