#!/bin/sh
# tables.sh VERSION PAGE - the man page PAGE with @VERSION@ filled in and, for a line `.\" @NAME@`, the rows of
# NAME.def, the table that the command itself is made of.
# SPDX-License-Identifier: MIT
set -eu
here=$(dirname "$0")/..

# .It and text for each row NAME.def has: MACRO(NUMBER, "NAME", KIND, "TEXT") or without KIND.
rows() { # TABLE
    sed -n -e 's/^[A-Z]*([A-Z_]*, *"\([^"]*\)", *\([A-Z]*\),* *"\(.*\)")$/\1|\2|\3/' -e '/|/!d' \
        -e 's/|CATALOG|/|The source is a catalog: /' -e 's/|OFF|/|Off unless asked for: /' -e 's/|ERROR|/|An error by default: /' \
        -e 's/|[A-Z]*|/|/' -e 's/\\"/"/g' -e 's/-/\\-/g' -e 's/^\([^|]*\)|\([^|]*\)|*\(.*\)$/.It Cm \1\n\\\&\2\3./p' "$here"/*/"$1.def"
}

while IFS= read -r line; do
    case $line in
    '.\" @'*@) table=${line#*@}; rows "${table%@}" ;;
    *) printf '%s\n' "$line" ;;
    esac
done <"$2" | sed "s/@VERSION@/$1/"
