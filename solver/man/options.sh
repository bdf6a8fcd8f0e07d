#!/bin/sh
# options.sh RADIOSITY PAGE - the man page PAGE with the version filled in and, for the lines `.\" @options COMMAND@`
# and `.\" @oracles@`, what the command itself says of them.
# SPDX-License-Identifier: MIT
set -eu
radiosity=$1

escape='s/\\/\\e/g; s/-/\\-/g'

# "  --name ARGUMENT   text" becomes an item of a list.
options() { # COMMAND...
    "$radiosity" "$@" --help=all | sed -n -e "/^  -/{$escape" -e 'p;}' | sed \
        -e 's/^  \\\(-[^ ]*\) \([^ ][^ ]*\)  *\(.*\)$/.It Fl \1 Ar \2\n\\\&\3/' -e t \
        -e 's/^  \\\(-[^ ]*\)  *\(.*\)$/.It Fl \1\n\\\&\2/' | sed 's/^\.It Fl -/.It Fl /'
}

# "name: text" or "name (default): text", its parameters in lines that are indented.
oracles() {
    "$radiosity" oracles | sed -e "$escape" -n -e 's/^\([a-z_]*\)\( (default)\)*: \(.*\)$/.It Cm \1\2\n\\\&\3./p'
}

version=$("$radiosity" --version)
while IFS= read -r line; do
    case $line in
    '.\" @options '*)
        words=${line#*@options }
        # shellcheck disable=SC2086 # a command may be two words
        options ${words%@}
        ;;
    '.\" @oracles@') oracles ;;
    *) printf '%s\n' "$line" ;;
    esac
done <"$2" | sed "s/@VERSION@/${version#* }/"
