#!/bin/sh
# make.sh BUILD [NAME...] - make the tables of README.md and its like anew (make tables; TABLES="NAME..." for some).
#
# A table stands between two lines of a Markdown file,
#
#     <!-- table NAME: begin (made by make tables) -->
#     <!-- table NAME: end -->
#
# and table_NAME.sh beside this file prints it: whatever is measured, sentences with figures included, and nothing else is
# touched. A generator that fails, or prints nothing, leaves the file as it was; so does one that exits with 77, which says
# what it lacks. Files are replaced whole, by a rename. Exit status: 1 when a generator failed.
#
# SCENES: folders of scenes, those that are there; WITHOUT: scenes to leave out; OLD: an older radiosity to compare with.
# TABLE_FILES, TABLE_MAKERS: other files and another folder of generators, for the test.
# SPDX-License-Identifier: MIT
set -u
here=$(cd "$(dirname "$0")" && pwd)
export BUILD="${1:-build}"
[ $# = 0 ] || shift
files=${TABLE_FILES:-README.md examples/measured_error.md examples/viewfactors.md examples/oracles/README.md examples/clustering.md} makers=${TABLE_MAKERS:-$here}
tmp=$(mktemp -d) || exit 2
new=
trap 'rm -rf "$tmp" "$new"' EXIT
trap 'exit 130' INT TERM
fail() {
    echo "make tables: error: $*" >&2
    failed=1
}

# NAME FILE of each pair of markers, in order; whatever is not a pair is an error.
for file in $files; do
    awk '/^<!-- table .*-->$/ {
             if ($0 ~ /^<!-- table [a-z_]+: begin \(made by make tables\) -->$/) {
                 if (name != "") bad(name " has no end")
                 name = substr($3, 1, length($3) - 1)
             } else if ($0 ~ /^<!-- table [a-z_]+: end -->$/) {
                 if (substr($3, 1, length($3) - 1) != name) bad("this ends no table that has begun")
                 else print name, FILENAME
                 name = ""
             } else bad("neither the begin nor the end of a table, as tests/tables/make.sh says")
         }
         END { if (name != "") bad(name " has no end"); exit wrong }
         function bad(what) { printf "%s:%d: error: %s\n", FILENAME, FNR, what >"/dev/stderr"; wrong = 1 }' "$file" \
        >>"$tmp/places" || exit 1
done
cut -d ' ' -f 1 "$tmp/places" | sort | uniq -d >"$tmp/twice"
[ ! -s "$tmp/twice" ] || { fail "two tables of one name: $(tr '\n' ' ' <"$tmp/twice")" && exit 1; }

failed=0 at=0
[ $# -gt 0 ] || set -- $(cut -d ' ' -f 1 "$tmp/places")
for name; do
    at=$((at + 1))
    file=$(awk -v name="$name" '$1 == name { print $2 }' "$tmp/places")
    if [ -z "$file" ]; then
        fail "no table is called $name; there are: $(cut -d ' ' -f 1 "$tmp/places" | tr '\n' ' ')"
        continue
    fi
    if [ ! -f "$makers/table_$name.sh" ]; then
        fail "$file has a table $name, but there is no $makers/table_$name.sh to make it"
        continue
    fi
    echo "table $name of $file ($at of $#)" >&2
    start=$(date +%s)
    sh "$makers/table_$name.sh" >"$tmp/table"
    status=$?
    if [ $status = 77 ]; then
        echo "table $name: left as it was" >&2
        continue
    fi
    if [ $status != 0 ] || [ ! -s "$tmp/table" ]; then
        fail "table $name was not made (exit status $status); $file is as it was"
        continue
    fi
    new=$(dirname "$file")/.$(basename "$file").$$
    cp -p "$file" "$new" && awk -v name="$name" -v table="$tmp/table" '
            $0 == "<!-- table " name ": end -->" { inside = 0 }
            !inside { print }
            $0 == "<!-- table " name ": begin (made by make tables) -->" {
                inside = 1
                print ""
                while ((getline line <table) > 0) print line
                print ""
            }' "$file" >"$new" && mv "$new" "$file" || { rm -f "$new"; fail "$file cannot be written"; }
    echo "table $name: $(($(date +%s) - start)) s" >&2
done
exit $failed
