# script.sh - what all scripts that check a command share: they find themselves in an empty folder, $tmp, that goes when they
# end; they count what they check and what failed, and end with `finish NAME`. Read by the lib.sh of their folders.
# SPDX-License-Identifier: MIT
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 2
count=0 bad=0

finish() { # NAME
    echo "$1: $count checks, $bad failed"
    [ "$bad" = 0 ]
}
