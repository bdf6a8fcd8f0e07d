#!/bin/sh
# Runs dagc on every file here that says how: `# run: ARGUMENTS` (FILE stands for the file),
# `# exit: STATUS`, and after `# stderr:` and `# stdout:` what it must print, line by line behind
# `#|`. Usage: run.sh DAGC [-u]; -u writes what dagc prints now into the files: look at the diff.
# SPDX-License-Identifier: MIT
dagc=$(realpath "$1") update=$2
cd "$(dirname "$0")" || exit 2
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
count=0 bad=0

expected() { # FILE SECTION
    awk -v section="# $2:" '/^# (stderr|stdout):$/ { on = ($0 == section); next }
                            on && /^#\|/ { sub(/^#\| ?/, ""); print; next } { on = 0 }' "$1"
}

for file in *.dag; do
    arguments=$(sed -n 's/^# run: //p' "$file")
    [ -n "$arguments" ] || continue
    count=$((count + 1))
    arguments=$(echo "$arguments" | sed "s/FILE/$file/g")
    # shellcheck disable=SC2086 # the arguments are words
    "$dagc" $arguments >"$tmp/stdout" 2>"$tmp/stderr" </dev/null
    status=$?
    if [ "$update" = -u ]; then
        sed '/^# exit: /,$d' "$file" >"$tmp/new"
        {
            echo "# exit: $status"
            for stream in stderr stdout; do
                [ -s "$tmp/$stream" ] && echo "# $stream:" && sed 's/^/#| /; s/^#| $/#|/' "$tmp/$stream"
            done
        } >>"$tmp/new"
        cmp -s "$tmp/new" "$file" || cp "$tmp/new" "$file"
        continue
    fi
    wanted=$(sed -n 's/^# exit: //p' "$file")
    ok=1
    [ "$status" = "${wanted:-0}" ] || { ok=0; echo "$file: exit $status, not ${wanted:-0}"; }
    for stream in stderr stdout; do
        expected "$file" $stream >"$tmp/expected"
        diff -u "$tmp/expected" "$tmp/$stream" >"$tmp/diff" || { ok=0; echo "$file: $stream"; cat "$tmp/diff"; }
    done
    [ $ok = 1 ] || bad=$((bad + 1))
done
echo "dagc: $count files, $bad failed"
[ "$count" -gt 0 ] && [ "$bad" = 0 ]
