#!/usr/bin/env bash
# check_architecture.sh - the include graph against ARCHITECTURE.md: no circle among files or folders, no arrow back, no
# folder above a third of the lines, headers that compile alone, files that name themselves and end their first comment
# with the licence, lines to 100 columns, threads of the pool alone. With THOROUGH headers must compile alone, names of old
# are gone (they are listed in build/architecture.txt), and clang-format 14 finds nothing to change.
# Once is enough: it reads our text.
# SPDX-License-Identifier: MIT
set -u
cd "$(dirname "$0")/.." || exit 2
build=$(dirname "$(dirname "${DAGC:-build/bin/dagc}")")
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
count=0 bad=0
judge() { # WHAT FILE: nothing may be in the file
    count=$((count + 1))
    [ -s "$2" ] || return 0
    bad=$((bad + 1))
    echo "failed: $1:"
    sed 's/^/  /' "$2" | head -n 20
}

# ---- files, their folders, and what includes what
find dagc runtime solver -name '*.[ch]' -not -path '*/editors/*' -not -path '*/package/*' | sort >"$tmp/files"
awk 'FNR == NR { files[$0] = 1; n = split($0, part, "/"); base[part[n]] = base[part[n]] " " $0; next }
     { file = $0; dir = file; sub("/[^/]*$", "", dir)
       while ((getline line < file) > 0)
           if (match(line, /^#[ \t]*include[ \t]*"[^"]*"/)) {
               name = line; sub(/^[^"]*"/, "", name); sub(/".*/, "", name)
               if (name ~ /\.\.\//) { print "up", file, name; continue }
               split(dir "/ runtime/ solver/ dagc/ dagc/include/ ", where, " "); found = ""
               for (i = 1; i in where && found == ""; i++)
                   if ((where[i] name) in files) found = where[i] name
               if (found != "") print "arrow", file, found
           }
       close(file) }' "$tmp/files" "$tmp/files" >"$tmp/graph"
sed -n 's/^up //p' "$tmp/graph" >"$tmp/up"
judge 'an include that goes up ("../")' "$tmp/up"

circles() { # lines "FROM TO": nodes that stay when what has no arrow in or out is taken away, again and again
    awk '{ if ($1 != $2 && !(($1, $2) in seen)) { seen[$1, $2] = 1; from[++n] = $1; to[n] = $2 } }
         END { do { gone = 0; split("", into); split("", out)
                    for (i = 1; i <= n; i++) if (from[i] != "") { out[from[i]] = 1; into[to[i]] = 1 }
                    for (i = 1; i <= n; i++)
                        if (from[i] != "" && (!(from[i] in into) || !(to[i] in out))) { from[i] = to[i] = ""; gone = 1 }
               } while (gone)
               for (i = 1; i <= n; i++) if (from[i] != "") print from[i], "->", to[i] }'
}
sed -n 's/^arrow //p' "$tmp/graph" >"$tmp/arrows"
count=$((count + 1)) # of a graph that was not read, nothing can be said
[ "$(wc -l <"$tmp/arrows")" -gt 300 ] || { bad=$((bad + 1)); echo "failed: only $(wc -l <"$tmp/arrows") includes found"; }
circles <"$tmp/arrows" >"$tmp/circle"
judge "a circle among files" "$tmp/circle"
sed 's:/[^/ ]* : :; s:/[^/]*$::' "$tmp/arrows" | sort | uniq -c | awk '$2 != $3 { print $2, $3, $1 }' >"$tmp/folders"
circles <"$tmp/folders" >"$tmp/circle"
judge "a circle among folders" "$tmp/circle"

# ---- the arrows of the page: in its indented lines, "a <- b, c <- d" says that b and c use a, d uses b and c.
# A line begins with the folder whose parts it orders, or goes on with the last; what a part may use, those
# that use it may, too, and so the public headers and util for all.
awk '/^Inside, an arrow/ { on = 1; next } on && /^    / {
         sub(/^    /, ""); if ($1 ~ /\/$/) { top = $1; sub(/^[^ ]+ */, "") } else sub(/^ +/, "")
         pieces = split($0, piece, ";")
         for (p = 1; p <= pieces; p++) {
             steps = split(piece[p], step, "<-")
             for (i = 1; i <= steps; i++) {
                 n = split(step[i], name, /[ ,]+/)
                 for (k = 1; k <= n; k++) if (name[k] != "") {
                     print "part", top name[k]
                     if (i > 1) { m = split(step[i - 1], use, /[ ,]+/); for (j = 1; j <= m; j++) if (use[j] != "") print "use", top name[k], top use[j] }
                 }
             }
         }
         next }
     on && NF { exit }' ARCHITECTURE.md >"$tmp/page"
awk 'FNR == NR { if ($1 == "part") part[$2] = 1; else may[$2, $3] = 1; next }
     FNR == 1 { do { more = 0; for (a in part) for (b in part) if ((a, b) in may) for (c in part) if (((b, c) in may) && !((a, c) in may)) { may[a, c] = 1; more = 1 } } while (more) }
     function top(folder) { sub("/.*", "", folder); return folder }
     function rank(folder) { return top(folder) == "dagc" ? 1 : top(folder) == "runtime" ? 2 : 3 }
     { a = $1; b = $2
       if (rank(b) > rank(a)) { print a, "->", b, $3; next }
       if (top(a) != top(b) || b == "dagc" || b == "runtime" || b == "runtime/util" || b == "solver/util" || a == "solver") next
       if (a == "runtime" && b == "runtime/kernel") next # geometry.h
       if (!((a, b) in may)) print a, "->", b, $3, "includes" }' "$tmp/page" "$tmp/folders" >"$tmp/back"
judge "an arrow that ARCHITECTURE.md does not draw" "$tmp/back"
sed 's:/[^/]*$::' "$tmp/files" | sort -u | grep -v -e '^dagc$' -e '^runtime$' -e '^solver$' >"$tmp/there"
sed -n 's/^| `\([a-z/]*\)` .*/\1/p' ARCHITECTURE.md | sed 's:/$::' | grep -e '^dagc/' -e '^runtime/' -e '^solver/' | sort -u >"$tmp/told"
comm -3 "$tmp/there" "$tmp/told" >"$tmp/table"
judge "folders that are only in the tree, or only (second column) in the table of ARCHITECTURE.md" "$tmp/table"

# ---- sizes
xargs wc -l <"$tmp/files" | awk '$2 != "total" { d = $2; sub("/[^/]*$", "", d); lines[d] += $1; all += $1 }
    END { for (d in lines) { printf "%6d %5.1f %% %s\n", lines[d], 100 * lines[d] / all, d }; print all, "lines" }' | sort -rn >"$tmp/sizes"
cat "$tmp/sizes"
awk '$3 == "%" && $2 > 100 / 3' "$tmp/sizes" >"$tmp/large"
judge "a folder above a third of the lines" "$tmp/large"

if [ -n "${THOROUGH-}" ]; then
# ---- headers alone
: >"$tmp/alone"
for header in $(grep '\.h$' "$tmp/files"); do
    echo "#include \"$(basename "$header")\"" >"$tmp/alone.c"
    ${CC:-cc} -std=c11 -D_XOPEN_SOURCE=700 -Werror=implicit-function-declaration -fsyntax-only -I"$(dirname "$header")" -I"$build/gen" -Iruntime -Isolver -Idagc -Itests/hand "$tmp/alone.c" >"$tmp/said" 2>&1 ||
        grep -m 1 'error' "$tmp/said" >>"$tmp/alone"
done
judge "a header that does not compile alone" "$tmp/alone"
fi

# ---- first comments
for file in $(cat "$tmp/files"); do
    awk -v name="$(basename "$file")" -v file="$file" '
        NR == 1 && $0 !~ "^/\\* " name " " { print file ": the first comment does not name the file"; }
        /SPDX-License-Identifier: MIT *\*\// { licence = 1; exit } /\*\// { exit }
        END { if (!licence) print file ": the first comment does not end with the licence" }' "$file"
done >"$tmp/first"
judge "first comments" "$tmp/first"

# ---- width and names
awk 'length($0) > 100 { print FILENAME ":" FNR ": " length($0) " columns" }' $(cat "$tmp/files") >"$tmp/wide"
judge "lines above 100 columns" "$tmp/wide"

# ---- code that mutations.sh breaks is where it says
bash tests/mutations.sh --made >"$tmp/made" 2>&1
judge "mutations" "$tmp/made"

# ---- files and folders that ARCHITECTURE.md names are there
find . -path './build*' -prune -o -print | sed 's,.*/,,; s/\.[a-z]*$//' | sort -u >"$tmp/stems"
grep -o '`[a-z][a-z_]*`' ARCHITECTURE.md | tr -d '`' | sort -u | comm -23 - "$tmp/stems" >"$tmp/unnamed"
judge "names that ARCHITECTURE.md has of nothing" "$tmp/unnamed"

# ---- generated text is compiled by the Makefile's flags of arithmetic, wherever a user does it
flags=$(sed -n 's/^CFLAGS .*-std=c11/&/p' Makefile | grep -oE -- '-f[a-z-]+(=[a-z]+)?')
[ "$(echo "$flags" | wc -l)" -ge 3 ] || echo "Makefile: no CFLAGS with flags of arithmetic" >"$tmp/flags"
for file in dagc/prove/compile.c dagc/package/dagc.mk dagc/package/dagcConfig.cmake dagc/emit/emit_skeleton.c dagc/man/dagc.1 \
    $(git ls-files 'examples/*/Makefile' | grep -v engine) examples/plugin/desk.c; do # engine compiles no graph
    wanted=1
    [ $file != dagc/man/dagc.1 ] || wanted=2 # for cc and for Meson
    for flag in $flags; do
        [ "$(grep -c -- "$flag" $file)" -ge $wanted ] || echo "$file: $flag"
    done
done >>"$tmp/flags"
judge "flags of the Makefile that are missing where a graph is compiled" "$tmp/flags"

# ---- threads: all but tests is compiled without OpenMP, which would leave such loops to one thread and say nothing
grep -nE '^ *#pragma omp (parallel|for|atomic|critical|barrier|single)|omp_[a-z]+_|<omp\.h>' $(cat "$tmp/files") >"$tmp/openmp"
judge "OpenMP where loops are thread_pool_run's" "$tmp/openmp"
if [ -n "${THOROUGH-}" ]; then
: >"$tmp/list"
# shellcheck disable=SC2046
grep -nE '^static .*\b(take|go|look|show|settle|pass)\(' $(cat "$tmp/files") >>"$tmp/list"
# Identifiers of old, outside of comments and strings.
for file in $(grep -e '^runtime' -e '^solver' "$tmp/files"); do
    ${CC:-cc} -fpreprocessed -dD -E -P "$file" 2>/dev/null | sed 's/"[^"]*"//g' |
        grep -oE '\b(balance|gift|publish|beams?|allowance|buried|hold|let_go|factor_matrix)(_[a-z_]+)?\b|\bSTALE\b|\bcluster_tree[a-z_]*\b|\b[a-z]+_(beams?|gift|allowance)\b' |
        sort | uniq -c | awk -v file="$file" '{ print file ": name " $2 ", " $1 " times" }'
done >>"$tmp/list"
[ -d "$build" ] && cp "$tmp/list" "$build/architecture.txt"
count=$((count + 1))
if [ -s "$tmp/list" ]; then
    echo "failed: $(wc -l <"$tmp/list") names of old: see $build/architecture.txt"
    bad=$((bad + 1))
fi

# ---- the format; other versions of clang-format differ in small things
if clang-format --version 2>/dev/null | grep -q 'version 14\.'; then
    # shellcheck disable=SC2046
    git ls-files '*.[ch]' | grep -v -e '^examples/embed/refiner' -e '^tests/dagc/runtime/' |
        xargs clang-format --dry-run -Werror 2>&1 | grep 'warning\|error' >"$tmp/format"
    judge "what clang-format would change" "$tmp/format"
else
    echo "skipped: clang-format 14 is not installed"
fi
fi
echo "architecture: $count checks, $bad failed"
[ "$bad" = 0 ]
