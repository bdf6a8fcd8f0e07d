#!/bin/sh
# check_line_directives.sh - dagc --line-directives: what a compiler says of generated text it says of the .dag file or of the
# tool's file, and every line is where #line says that it is. DAGC names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
tests=$top/tests/dagc

warnings="-std=c11 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only"

cp -r "$tests/runtime" runtime
cp "$tests/test_catalog.dag" .
cat >small.dag <<'END'
oracle small {
  param most : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c;
                    neither -> drop; }
  node b = weigh(most = most, share = min(1, abs(size.fine)))
           { light -> c; heavy -> split; }
  node c = measure() { done -> keep; }
}
END
make_text() { "$dagc" -Wno-all --catalog test_catalog.dag -I runtime --line-directives -o "$1.c" --header "$1.h" "${2-small.dag}" $3; }
check "with headers beside" make_text small small.dag "--instrument --trace"
check "standalone" make_text alone small.dag "--standalone --prefix alone"
"$dagc" --emit=catalog-h -o catalog.h test_catalog.dag
check "it compiles" cc $warnings -I. -Iruntime -I"$top/runtime" small.c
check "so does that" cc $warnings alone.c
cp small.dag "new
line.dag"
check "a file with a newline in its name" make_text newline "new
line.dag" "--standalone --prefix newline"
check "compiles, too" cc $warnings newline.c

# Mistakes: in a call that the graph makes, in a tool.
sed 's/tool_weigh(&d/tool_wiegh(\&d/' small.c >wrong.c
check "a mistake in the graph's text" says '^small.dag:6:' cc $warnings -I. -Iruntime -I"$top/runtime" wrong.c
sed 's/goto node_b;/goto node_z;/' small.c >wrong.c
check "where an answer leads" says '^small.dag:4:' cc $warnings -I. -Iruntime -I"$top/runtime" wrong.c
sed 's/answer(d, 1, most, share, WEIGH_ANSWERS)/answer(d, 1, most, sharp, WEIGH_ANSWERS)/' "$tests/runtime/tools/weigh.h" >runtime/tools/weigh.h
line=$(grep -n sharp runtime/tools/weigh.h | cut -d: -f1)
make_text broken small.dag "--standalone --prefix alone"
check "a mistake in a tool" says "weigh.h:$line:" cc $warnings broken.c
cp "$tests/runtime/tools/weigh.h" runtime/tools/

# Each line against the file that #line names; a prefix was put before names.
cat >hold.awk <<'END'
function plain(s) { gsub(/alone_|ALONE_|bf_|BF_/, "", s); sub(/ *\*\/ *$/, "", s); gsub(/^[ \t]+|[ \t]+$/, "", s); return s }
/^#line / {
    n = $2; path = $0; sub(/^[^"]*"/, "", path); sub(/"$/, "", path); next
}
path == FILENAME { own++; if (n != FNR) { print FNR ": is said to be line " n; bad = 1 } }
path != FILENAME && path ~ /\.h$/ {
    if (!(path in read)) {
        read[path] = 1
        from = path
        if ((getline text < from) < 0) { from = folder "/" path; if ((getline text < from) < 0) { print "no " path; bad = 1; exit } }
        for (k = 1;; k++) { lines[path, k] = text; if ((getline text < from) <= 0) break }
    }
    held++
    if (plain($0) != "" && plain($0) != plain(lines[path, n])) { print FNR ": " $0 ", not " lines[path, n]; bad = 1 }
}
{ n++ }
END_PLACE
END
sed -i '/^END_PLACE$/d' hold.awk
echo 'END { if (bad || held < least || own < 5) { print held " lines held, " own " of its own"; exit 1 } }' >>hold.awk
check "each line of it" awk -v least=40 -v folder="$top/runtime" -f hold.awk alone.c
check "each line of its header" awk -v least=20 -v folder="$top/runtime" -f hold.awk alone.h
check "with the built-in headers" "$dagc" -Wno-all --line-directives --standalone -o bf.c --header bf.h "$top/examples/oracles/bf.dag"
check "each line of that" awk -v least=500 -v folder="$top/runtime" -f hold.awk bf.c
check "it compiles, too" cc $warnings bf.c
check "nothing without the option" sh -c "! '$dagc' -Wno-all --catalog test_catalog.dag small.dag | grep -q '^#line'"
check "to standard output" says '^#line [1-9][0-9]* "small.c"$' "$dagc" -Wno-all --catalog test_catalog.dag --line-directives small.dag
check "it belongs to C text" says 'belong to C text' "$dagc" --line-directives --emit=dot small.dag
finish "dagc --line-directives"
