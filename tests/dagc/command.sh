#!/bin/sh
# Tests of the command dagc as a process: what it writes, and above all what it leaves alone.
# Usage: command.sh DAGC. SPDX-License-Identifier: MIT
# shellcheck disable=SC2086 # $run and $warnings are words
dagc=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
tmp=$(mktemp -d) || exit 2
trap 'cd /; umount "$tmp/disk" 2>/dev/null; rm -rf "$tmp"' EXIT
cd "$tmp" || exit 2
bad=0 count=0

check() { # WHAT COMMAND...
    what=$1
    shift
    count=$((count + 1))
    "$@" >out 2>&1 || { bad=$((bad + 1)); echo "command.sh: $what"; head -c 2000 out; }
}
status() { # STATUS COMMAND...
    wanted=$1
    shift
    "$@" >stdout 2>stderr </dev/null
    got=$?
    [ $got = "$wanted" ] || { echo "exit $got, not $wanted"; cat stderr; return 1; }
}
says() { # TEXT: in the last standard error
    grep -qF -- "$1" stderr || { echo "not said: $1"; head -c 1000 stderr; return 1; }
}
fails_with() { # STATUS TEXT COMMAND...
    s=$1 t=$2
    shift 2
    status "$s" "$@" && says "$t"
}
untouched() { [ "$(cat old.c)" = old ] && [ "$(cat old.h)" = old ] && [ "$(find . -name '*.??????' | wc -l)" = 0 ]; }

cp "$here/test_catalog.dag" catalog.dag
cp "$here/emit_c.dag" good.dag
cp "$here/cycle.dag" wrong.dag
run="$dagc -Wno-all --catalog catalog.dag"
old() { echo old >old.c; echo old >old.h; }

# ---- wrong usage
for arguments in '' '--nonsense good.dag' '-o' 'good.dag more.dag' '--emit=pdf good.dag' '--catalog' \
    '-o x.c --header x.c good.dag' '-o x.c --header ./x.c good.dag' '-o good.dag good.dag' '-o ./good.dag good.dag' '-x good.dag' \
    '--catalog - -' '--emit=catalog-h --header x.h catalog.dag' '-o catalog.dag --catalog catalog.dag good.dag'; do
        check "usage: $arguments" status 2 "$dagc" $arguments
done
check "usage leaves files" cmp -s good.dag "$here/emit_c.dag"
check "--help" status 0 "$dagc" --help
check "--help teaches" grep -q 'oracle small' stdout
sed -n '/# small.dag/,/^    }/s/^    //p' stdout >small.dag
check "the example of --help compiles" status 0 "$dagc" --emit=none small.dag
check "--version" status 0 "$dagc" --version
check "--version says so" grep -q '^dagc [0-9]' stdout

# ---- what is imported is not lost either
cp "$here/../../examples/oracles/bf.dag" "$here/../../examples/oracles/common.dag" .
for name in common.dag ./common.dag ../"${tmp##*/}"/common.dag; do
    check "an import is no output" fails_with 1 'would replace common.dag, which was read' "$dagc" -Wno-all -o "$name" bf.dag
    check "an import is no header" fails_with 1 'would replace common.dag, which was read' "$dagc" -Wno-all -o x.c --header "$name" bf.dag
done
check "the import is whole" cmp -s common.dag "$here/../../examples/oracles/common.dag"
check "nothing is written beside" [ ! -e x.c ]

# ---- errors touch nothing
old
check "error" status 1 $run -o old.c --header old.h wrong.dag
check "error leaves files" untouched
check "missing file" fails_with 1 'cannot read none.dag: No such file' $run -o old.c none.dag
check "directory" fails_with 1 'Is a directory' $run -o old.c .
check "missing catalog" fails_with 1 'cannot read none' "$dagc" --catalog none -o old.c good.dag
check "missing output folder" fails_with 1 'cannot write no/x.c' $run -o no/x.c --header old.h good.dag
check "missing header folder" fails_with 1 'cannot write no/x.h' $run -o old.c --header no/x.h good.dag
mkdir folder
check "output is a folder" fails_with 1 'cannot write folder' $run -o old.c --header folder good.dag
check "all of this leaves files" untouched
# shellcheck disable=SC2016
check "a file that cannot grow" fails_with 1 'cannot write old.c' sh -c 'ulimit -f 1; trap "" XFSZ; exec "$@"' sh $run -o old.c --header old.h good.dag
# shellcheck disable=SC2016
check "a file that cannot grow, and a signal says so" fails_with 1 'cannot write old.c' sh -c 'ulimit -f 1; exec "$@"' sh $run -o old.c --header old.h good.dag
check "a file that cannot grow leaves files" untouched
check "full device" fails_with 1 'No space left' $run -o /dev/full good.dag
check "full device as standard output" fails_with 1 'cannot write standard output' sh -c "$run good.dag >/dev/full"
check "full device for the help" fails_with 1 'cannot write standard output' sh -c "$run --help >/dev/full"
check "full device and header" fails_with 1 'No space left' $run -o /dev/full --header old.h good.dag
check "full device leaves the header" untouched
mkdir disk
if mount -t tmpfs -o size=4k none disk 2>/dev/null; then
    echo old >disk/old.c
    check "full disk" fails_with 1 'No space left' $run -o disk/old.c --header old.h good.dag
    check "full disk leaves the file" [ "$(ls disk)$(cat disk/old.c)" = old.cold ]
    check "full disk leaves the header" untouched
    umount disk
fi

# ---- what is written
check "write" status 0 $run -o new.c --header new.h good.dag
check "nothing printed" [ ! -s stdout ]
check "the header is included" grep -q '^#include "new.h"$' new.c
check "mode by umask" [ "$(umask 027; $run -o mode.c good.dag; stat -c %a mode.c)" = 640 ]
check "mode by umask, open" [ "$(umask 0; $run -o mode2.c good.dag; stat -c %a mode2.c)" = 666 ]
check "standard output" status 0 $run --header=- -o one.c good.dag
check "standard output is the header" grep -q 'struct first_parameters' stdout
check "standard input" sh -c "$run - <good.dag | grep -q 'from standard input'"
check "a device is not replaced" sh -c "$run -o /dev/null good.dag && [ -c /dev/null ]"
ln -s target.c link.c && echo old >target.c
check "a link is followed" sh -c "$run -o link.c good.dag && [ -L link.c ] && grep -q dagc target.c"
check "--emit=none" status 0 $run --emit=none -o old.c good.dag
check "--emit=none writes nothing" untouched
mkdir -p a/b
check "same bytes from elsewhere" sh -c "cd a/b && $dagc -Wno-all --catalog=$tmp/catalog.dag -o new.c --header new.h ../../good.dag; cmp new.c ../../new.c && cmp new.h ../../new.h"
check "no path, no date" sh -c "! grep -E '$tmp|/tmp|20[0-9][0-9]-' new.c new.h"
check "a locale with a decimal comma" sh -c "LC_ALL=de_DE.UTF-8 $run good.dag >de.c && $run good.dag | cmp - de.c"

# ---- warnings: the table, its list, its cases
"$dagc" -W >list
names=$(awk '$2 == "on" || $2 == "off" || $2 == "error" { print $1 }' list)
check "-W lists the table" sh -c "[ $(echo "$names" | wc -l) = $(grep -c '^WARNING(' "$here/../../dagc/base/warnings.def") ]"

for name in $names; do
    check "a case of -W$name" grep -qE "^#\\| .*\[-W(error=)?$name\]" "$here"/*.dag
    check "a case without -W$name" status 0 "$dagc" -Wno-$name -Wno-error=missing-term --version
done
# The golden file that shows a warning, with the switch behind its own arguments.
switched() { # NAME SWITCHES STATUS PATTERN: the status ("": any), and what is said ("": not a word of NAME)
    file=$(cd "$here" && grep -lE "^#\| .*(warning|error): .*\[-W(error=)?$1\]" ./*.dag | head -n 1)
    arguments=$(sed -n 's/^# run: //p' "$here/$file" | sed "s|FILE|$file|")
    (cd "$here" && exec "$dagc" $arguments $2) >stdout 2>stderr
    got=$?
    [ -z "$3" ] || [ $got = "$3" ] || { echo "exit $got, not $3"; return 1; }
    if [ -n "$4" ]; then grep -qE "$4" stderr; else ! grep -qE "\[-W(error=)?$1\]" stderr; fi
}
for name in $names; do
    check "-Werror=$name" switched $name -Werror=$name 1 "error: .*\[-W(error=)?$name\]"
    check "-Wno-$name" switched $name -Wno-$name 0 ""
    check "-Wno-error=$name" switched $name "-Werror -W$name -Wno-error=$name" "" "warning: .*\[-W$name\]"
done
check "warnings leave status 0" status 0 "$dagc" --catalog "$here/analysis_catalog.dag" --emit=none "$here/warn_twin_answers.dag"
old
check "-Werror" fails_with 1 'error: no path' "$dagc" -Werror --catalog catalog.dag -o old.c --header old.h good.dag
check "-Werror leaves files" untouched
for word in Wunused Wno-unused-imports Werror=missing-terms Wno-error=x; do
    check "-$word" fails_with 2 'no warning is called' "$dagc" -$word good.dag
done
check "a warning's name nearly right" fails_with 2 "did you mean 'unused-import'?" "$dagc" -Wno-unused-imports good.dag
awk 'BEGIN { print "oracle t { start n0;"; for (i = 0; i < 200; i++) print "node n" i " = look() { left -> drop; otherwise -> n" i + 1 "; }"; print "node n200 = look() { otherwise -> drop; } }" }' >noisy.dag
check "many warnings" fails_with 0 'warnings, the first 50 found are shown' "$dagc" --catalog catalog.dag --emit=none noisy.dag

# ---- options with a name that is not quite right
check "--emit nearly right" fails_with 2 "did you mean 'json'?" "$dagc" --emit=jsn good.dag
check "--dump nearly right" fails_with 2 "did you mean 'resolve'?" "$dagc" --dump=resolv good.dag
check "an option nearly right" fails_with 2 "did you mean '--header'?" "$dagc" --heder=x good.dag
check "--prefix that begins no C name" fails_with 2 'can begin a C name, not 1x' $run --prefix=1x --standalone -o x.c --header x.h good.dag
check "-o twice" fails_with 2 'there can be only one -o' $run -o x.c -o y.c good.dag
check "--emit twice" fails_with 2 'there can be only one --emit' $run --emit=c --emit=dot good.dag
check "--emit and --dump" fails_with 2 'take one' $run --emit=c --dump=parse good.dag
check "the same twice" $run --emit=none --emit=none good.dag
cat >mixed.dag <<'END'
oracle t { param p : flux = 1; param q : flux = 1; start n0; node n0 = look() { left -> drop; otherwise -> drop; } node n1 = look() { left -> drop; otherwise -> drop; } }
END
check "an error among warnings is counted, too" fails_with 1 'dagc: 1 error' "$dagc" -Werror=unreachable-node --catalog catalog.dag --emit=none mixed.dag
for arguments in '--dump' '--dump=x good.dag' '--depfile x.d good.dag' '-o x --depfile x good.dag' \
    '-o x --depfile good.dag good.dag' '--emit=json --header x.h good.dag' \
    '--emit=catalog --dump=parse catalog.dag' '--emit=catalog --header x.h catalog.dag'; do
        check "usage: $arguments" status 2 "$dagc" $arguments
done

# ---- what else it emits
check "--emit=json" sh -c "$run --emit=json good.dag >good.json && grep -q '\"schema\": \"dagc/1\"' good.json"
cat >odd.dag <<'END'
oracle t "a \\ and \" and é & <b>" {
  param p : flux = 1e300 in [0, inf] "\\";
  start a; node a = weigh(most = inf, share = 0.5) { light -> b; heavy -> drop; }
  node b = weigh(most = p, share = 1e-9) { otherwise -> drop; }
}
END
if command -v python3 >/dev/null; then
    check "--emit=json is JSON" python3 -m json.tool good.json
    check "odd characters in JSON" sh -c "$run --emit=json odd.dag | python3 -m json.tool"
    check "the catalog's tools in JSON" sh -c "python3 -c 'import json; g = json.load(open(\"good.json\")); assert [t[\"name\"] for t in g[\"catalog\"][\"tools\"]] == [\"look\", \"weigh\", \"tally\", \"measure\"]; assert len(g[\"oracles\"][0][\"nodes\"]) == 5'"
else
    echo "skipped: python3 is not installed, which reads JSON"
fi
check "--lines" sh -c "$run --lines '$here/emit_branch.dag' | grep -qF '/* emit_branch.dag:5, used at emit_branch.dag:10, used at emit_branch.dag:17 */'"
check "no --lines" sh -c "! $run '$here/emit_branch.dag' | grep -qF 'emit_branch.dag:5'"
check "--lines belong to C" status 2 $run --lines --emit=dot good.dag
check "--emit=text is --dump=analyse" sh -c "$run --emit=text good.dag >a.txt && $run --dump=analyse good.dag | cmp - a.txt"
for pass in parse resolve check; do
    check "--dump=$pass" sh -c "$run --dump=$pass good.dag | grep -q 'node a = look()'"
done
check "--dump=parse of a graph that is wrong later" status 0 $run --dump=parse wrong.dag
check "--dump=check of a graph that is wrong" fails_with 1 'a cycle' $run --dump=check wrong.dag
check "--dump=parse is read again" sh -c "$run --dump=parse good.dag >again.dag && $run --dump=parse again.dag | cmp - again.dag"
check "--dump=parse of branches is read again" sh -c "$run --dump=parse '$here/dump_parse_branch.dag' >again.dag && $run --dump=parse again.dag | cmp - again.dag && $run again.dag | grep -q \"\$($run '$here/dump_parse_branch.dag' | grep -o 'graph .*')\""
check "--dump=resolve compiles to the same graph" sh -c "$run --dump=resolve -o again.dag good.dag && $run again.dag | grep -q \"\$($run good.dag | grep -o 'graph .*')\""
check "--emit=catalog" sh -c "$dagc --emit=catalog catalog.dag | grep -q '^### weigh(most, share)'"
check "Graphviz is there (apt-get install graphviz)" command -v dot
check "--emit=dot" sh -c "$run --emit=dot good.dag | dot -Tplain | grep -q ^edge"
check "--emit=dot, two oracles" sh -c "$run --emit=dot '$here/emit_header_name.dag' | dot -Tplain | grep -q ^edge"
check "--emit=dot, odd characters" sh -c "$run --emit=dot odd.dag | dot -Tplain | grep -q ^edge"
check "--emit=svg" sh -c "$run --emit=svg -o good.svg good.dag && grep -q '</svg>' good.svg"
check "--emit=svg frames branches" sh -c "$dagc --catalog '$here/analysis_catalog.dag' -Wno-all --emit=svg '$here/emit_dot_branch.dag' | grep -c 'class=\"cluster\"' | grep -qx 4"
check "--emit=svg to standard output" sh -c "$run --emit=svg good.dag | cmp - good.svg"
old
check "--emit=svg without Graphviz" fails_with 1 "cannot run 'dot'" env PATH=/nowhere $run --emit=svg -o old.c good.dag
check "--emit=svg without Graphviz leaves files" untouched
mkdir failing && printf '#!/bin/sh\necho half\nexit 3\n' >failing/dot && chmod +x failing/dot
check "--emit=svg when Graphviz fails" fails_with 1 "could not draw" env PATH="$tmp/failing:$PATH" $run --emit=svg -o old.c good.dag
check "--emit=svg when Graphviz fails leaves files" untouched

# ---- dependencies
check "--depfile" status 0 $run -o dep.c --header dep.h --depfile dep.d good.dag
check "--depfile says what it should" sh -c 'printf "dep.c dep.h: catalog.dag good.dag\ncatalog.dag:\n" | cmp - dep.d'
cp good.dag 'a b#$.dag'
check "--depfile, odd names" status 0 $run -o 'o $.c' --depfile dep.d 'a b#$.dag'
printf 'all: o\\ $$.c\ninclude dep.d\no\\ $$.c:\n\techo made\n' >dep.mk
check "make reads odd names" sh -c 'rm -f o\ *; make -s -f dep.mk | grep -q made && touch "o \$.c" && [ -z "$(make -s -f dep.mk | grep made)" ] && sleep 0.1 && touch "a b#\$.dag" && make -s -f dep.mk | grep -q made'
check "--depfile under the standard catalog" sh -c "$dagc -o dep.c --depfile dep.d small.dag && [ \"\$(cat dep.d)\" = 'dep.c: small.dag' ]"
check "--depfile with --emit=none" sh -c "rm -f dep.c; $dagc --emit=none -o dep.c --depfile dep.d small.dag && [ ! -e dep.c ] && [ -s dep.d ]"
check "--depfile with --standalone" status 0 $run --standalone -I none -I "$here/runtime" -o dep.c --header dep.h --depfile dep.d good.dag
check "--depfile lists the headers that -I found" sh -c "grep -q '^dep.c dep.h: catalog.dag good.dag .*$here/runtime/discussion.h.* $here/runtime/tools/look.h' dep.d && grep -q '^$here/runtime/tools/look.h:' dep.d"
check "--depfile names no header twice" [ "$(head -n 1 dep.d | tr ' ' '\n' | sort | uniq -d)" = "" ]
check "--depfile is not written after an error" sh -c "rm -f dep.d; ! $run -o dep.c --depfile dep.d wrong.dag && [ ! -e dep.d ]"

# ---- size: 10,000 nodes that share subgraphs and questions, with every analysis
awk 'BEGIN { n = 10000; print "oracle big { start n0;"; for (i = 0; i < n; i++) { a = i + 1; b = i + 1 + (i * 7919) % 37; c = i + 1 + (i * 104729) % 211;
    if (a >= n) x = "drop"; else x = "n" a; if (b >= n) y = "drop"; else y = "n" b; if (c >= n) z = "drop"; else z = "n" c;
    k = i % 4; if (k == 0) print "node n" i " = look(rays = " 1 + i % 90 ") { none -> " x "; some -> " y "; all -> " z "; }";
    if (k == 1) print "node n" i " = weigh(limit = " i % 3000 ") { light -> " y "; heavy -> " z "; }";
    if (k == 2) print "node n" i " = side() { left -> " x "; right -> " z "; }";
    if (k == 3) print "node n" i " = " (i % 400 == 3 ? "measure() { done -> " x "; }" : "weigh(limit = " i ") { light -> " x "; heavy -> " y "; }"); }
    print "}" }' >big.dag
# The times are told, and judged only where DAGC_BIG_LIMIT, in hundredths of a second, says by what.
seconds() { # COMMAND...: processor time, in hundredths; the machine may have other things to do
    ("$@" >stdout 2>stderr; times) | awk 'NR == 2 { split($1 $2, t, /[ms]/); print int((t[1] * 60 + t[2] + t[3] * 60 + t[4]) * 100) }'
}
taken=$(seconds "$dagc" -Wall --catalog "$here/analysis_catalog.dag" -o big.c big.dag)
check "10,000 nodes with all analyses in ${taken}0 ms" [ "$taken" -lt "${DAGC_BIG_LIMIT:-1000000}" ]
check "10,000 nodes compile" [ -s big.c ]
for what in --emit=dot --emit=json --emit=text --dump=parse --dump=availability "--lines --instrument --trace"; do
    rm -f big.out
    taken=$(seconds "$dagc" -Wno-all $what --catalog "$here/analysis_catalog.dag" -o big.out big.dag)
    check "10,000 nodes, $what, in ${taken}0 ms" [ -s big.out -a "$taken" -lt "${DAGC_BIG_LIMIT:-1000000}" ]
done
# ---- imports
mkdir -p library sub/library
cat >library/way.dag <<'END'
import "way.dag";
import "./../library/way.dag";
import "deep.dag";
graph way() exits (on precise) { start q; node q = deep() { here -> on; } }
oracle left_out { start q; node q = nothing() { } }
END
cat >library/deep.dag <<'END'
import "way.dag"; import "../sub/user.dag";
graph deep() exits (here) { start q; node q = look() { otherwise -> here; } }
END
cat >sub/user.dag <<'END'
import "way.dag"; import "./way.dag"; import standard;
oracle user { start q; node q = way() { on -> keep; } }
END
ln -s ../library/way.dag sub/other.dag
check "no import without -I" fails_with 1 'cannot import "way.dag"' $run --emit=none sub/user.dag
sed -i 's/import ".\/way.dag"; import standard;/import "other.dag";/' sub/user.dag
check "imports by -I, each file once" status 0 $run -I sub -Ilibrary -o user.c sub/user.dag
check "the branch is expanded" grep -q 'switch\|tool_look' user.c
check "an import's oracle is left out" sh -c '! grep -q left_out user.c'
check "-I without a folder" fails_with 2 'missing after -I' "$dagc" good.dag -I
printf 'oracle broken { start q; node q = way() { on -> kepp; } }\n' >>library/deep.dag
echo 'tool x() question answers (yes; ' >>library/deep.dag
check "an error in an import names the chain" fails_with 1 'way.dag:3:8: note: imported here' $run -I library sub/user.dag
check "and its end" says 'user.dag:1:8: note: imported here'

# ---- stubs
check "a stub" status 0 "$dagc" --emit=stub --catalog catalog.dag -o stub.h weigh
check "a stub has its signature" grep -q '^TOOL enum weigh_answer tool_weigh(struct discussion \*d, double most, double share)$' stub.h
check "a term's stub" status 0 "$dagc" --emit=stub --catalog catalog.dag -o size.h size
check "no such stub" fails_with 1 "no tool and no term 'wiegh'" "$dagc" --emit=stub --catalog catalog.dag wiegh
check "near it" says "did you mean 'weigh'?"
check "a stub has no header" status 2 "$dagc" --emit=stub --header=x.h weigh

# ---- hostile input
hostile() { # WHAT TEXT: hostile.dag must give this error, quickly and shortly
    check "$1" fails_with 1 "$2" timeout 20 $run -o old.c --header old.h hostile.dag
    check "$1 leaves files" untouched
    check "$1 says little" [ "$(wc -c <stderr)" -lt 40000 ]
}
: >hostile.dag
hostile "an empty file" 'no oracle in this file'
printf 'oracle t {\n start a; \000 }' >hostile.dag
hostile "a NUL byte" 'hostile.dag:2:11: error: a NUL byte'
printf 'oracle t { # \377\n}' >hostile.dag
hostile "invalid UTF-8" 'this byte (0xff) is not UTF-8'
printf 'oracle t { # \342\200\256 }' >hostile.dag
hostile "a bidirectional control" 'U+202E'
head -c 10000000 /dev/zero | tr '\0' 'a' >hostile.dag
hostile "a name of 10 MB" 'the most is 63'
{ printf 'oracle t "'; head -c 10000000 /dev/zero | tr '\0' 'a'; echo '" { }'; } >hostile.dag
hostile "a string of 10 MB" 'the most is 2000'
{ printf 'oracle t { start '; head -c 10000000 /dev/zero | tr '\0' ' '; echo 'a; b }'; } >hostile.dag
hostile "a line of 10 MB" "found 'b'"
{ printf 'oracle t { start a; node a = weigh(share = '; head -c 100000 /dev/zero | tr '\0' '('; echo '1'; } >hostile.dag
hostile "100,000 parentheses" 'nested more than 200 deep'
{ printf 'oracle t { start a; node a = weigh(share = '; head -c 100000 /dev/zero | tr '\0' '-'; echo '1'; } >hostile.dag
hostile "100,000 signs" 'nested more than 200 deep'
{ printf 'oracle t { start a; node a = weigh(share = 1'; yes ' + 1' | head -n 100000 | tr -d '\n'; echo ')'; } >hostile.dag
hostile "100,000 additions" 'too long: more than 1000 parts'
mkfifo pipe && echo 'import "pipe";' >hostile.dag
hostile "an import of a pipe" 'cannot import "pipe": it is a pipe or a device'
printf 'import "folder"; import "hostile.dag"; import "none.dag"; oracle t { }' >hostile.dag
hostile "an import of a folder" 'cannot import "folder": Is a directory'
awk 'BEGIN { print "oracle t { start a; node a = g0() { x -> drop; } }"; for (i = 0; i < 100; i++) print "graph g" i "() exits (x) { start a; node a = g" i + 1 "() { x -> x; } }"; print "graph g100() exits (x) { start a; node a = look() { otherwise -> x; } }" }' >hostile.dag
hostile "graphs 100 deep" 'nested more than 64 deep'
awk 'BEGIN { print "oracle t { start a; node a = g0() { x -> drop; } }"; for (i = 0; i < 40; i++) print "graph g" i "() exits (x) { start a; node a = g" i + 1 "() { x -> b; } node b = g" i + 1 "() { x -> x; } }"; print "graph g40() exits (x) { start a; node a = look() { otherwise -> x; } }" }' >hostile.dag
hostile "graphs that double 40 times" 'would have 65536 nodes or more'
awk 'BEGIN { print "oracle t { start a; node a = g0() { x -> drop; } }"; print "oracle u { start a; node a = g0() { x -> drop; } }"; for (i = 0; i < 15; i++) print "graph g" i "() exits (x) { start a; node a = g" i + 1 "() { x -> b; } node b = g" i + 1 "() { x -> x; } }"; print "graph g15() exits (x) { start a; node a = look() { otherwise -> x; } }" }' >hostile.dag
hostile "oracles too large together" 'those before it have 32768, and 65536 are the most'
awk 'BEGIN { print "oracle t { start a; node a = g0(v = 1) { x -> drop; } }"; for (i = 0; i < 40; i++) print "graph g" i "(v : flux in [0, inf]) exits (x) { start a; node a = g" i + 1 "(v = v + v) { x -> x; } }"; print "graph g40(v : flux in [0, inf]) exits (x) { start a; node a = weigh(share = 1, most = v) { otherwise -> x; } }" }' >hostile.dag
hostile "an expression that doubles 40 times" 'more than 1000 parts'
awk 'BEGIN { print "oracle t { start a; node a = g0() { x -> drop; } }"; for (i = 0; i < 50000; i++) print "graph g" i "() exits (x) { start a; node a = g" (i + 1) % 50000 "() { x -> x; } }" }' >hostile.dag
hostile "50,000 graphs in a circle" 'a graph that uses itself: g0 -> g1'
{ printf 'oracle t { start a; node a = look() '; head -c 100000 /dev/zero | tr '\0' '{'; } >hostile.dag
hostile "100,000 braces" "expected an answer"
head -c 300000 /dev/zero | tr '\0' '}' >hostile.dag
hostile "300,000 closing braces" "expected 'oracle'"
{ echo 'oracle t {'; yes '@ x' | head -n 200000; } >hostile.dag
hostile "200,000 errors" 'the first 50 found are shown'
awk 'BEGIN { print "oracle t { start n0;"; for (i = 0; i < 30000; i++) print "node n" i " = lok" i "() { left -> m" i "; }"; print "}" }' >hostile.dag
hostile "60,000 unknown names" 'the first 50 found are shown'
awk 'BEGIN { print "oracle t { start n0;"; for (i = 0; i < 100000; i++) print "node n" i " = look() { left -> n" (i + 1) % 100000 "; otherwise -> drop; }"; print "}" }' >hostile.dag
hostile "a cycle of 100,000 nodes" 'a cycle: n0 -> n1'
head -c 70000000 /dev/zero >hostile.dag
hostile "70 MB" 'more than 64 MB'
rm hostile.dag
catalog_of() { # KIND: a catalog with 300 levels or 300 answers
    awk -v kind="$1" 'BEGIN { print "runtime \"r.h\" abi 1; type r = real \"\"; decision d; term x : r levels (l0";
        for (i = 1; kind == "levels" && i < 300; i++) print " < l" i; print "); tool t() question answers (a0";
        for (i = 1; kind == "answers" && i < 300; i++) print ", a" i; print ");" }' >many.dag
}
catalog_of levels
check "300 levels" fails_with 1 'a term has at most' "$dagc" --emit=catalog-h many.dag
catalog_of answers
check "300 answers" fails_with 1 'a tool has at most' "$dagc" --emit=catalog-h many.dag
check "a chain of 10,000 nodes" sh -c "awk 'BEGIN { print \"oracle t { start n0;\"; for (i = 0; i < 9999; i++) print \"node n\" i \" = look() { left -> n\" i + 1 \"; right -> n9999; neither -> drop; }\"; print \"node n9999 = look() { otherwise -> keep; } }\" }' | timeout 5 $run -o chain.c -"

# ---- the text compiles, in C and in C++
mkdir gen gen/tools gen/terms
cp "$here"/runtime/*.h gen
cp "$here"/runtime/tools/*.h gen/tools
cp "$here"/runtime/terms/*.h gen/terms
cp "$here"/../../runtime/oracle.h gen
cp "$here/../../runtime/oracle/tool_table.h" gen
check "catalog.h" status 0 "$dagc" --emit=catalog-h -o gen/catalog.h catalog.dag
check "catalog.c" status 0 "$dagc" --emit=catalog-c -o gen/catalog.c catalog.dag
check "with a header" status 0 $run -o gen/with.c --header gen/with.h good.dag
check "without a header" status 0 $run -o gen/without.c good.dag
check "two oracles" status 0 $run -o gen/two.c --header gen/two.h "$here/emit_header_name.dag"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -Igen -c -o object.o"
# Both compilers and both languages, once; all of it only when THOROUGH.
set -- "gcc -std=c99 -O1" "clang++ -x c++ -std=c++17 -O0"
[ -z "${THOROUGH-}" ] || set -- "gcc -std=c11 -O1" "gcc -std=c11 -O0" "gcc -std=c99 -O2" "clang -std=c11 -O2" \
    "g++ -x c++ -std=c++17 -O2" "clang++ -x c++ -std=c++17 -O2"
for compiler; do
    if ! command -v "${compiler%% *}" >/dev/null; then
        echo "skipped: ${compiler%% *} is not installed"
        continue
    fi
    for text in gen/*.c; do
                check "$compiler $text" $compiler $warnings $text
    done
done
for tool in look tally weigh measure; do
    "$dagc" --emit=stub --catalog catalog.dag -o gen/tools/$tool.h $tool
done
for term in where size times; do
    "$dagc" --emit=stub --catalog catalog.dag -o gen/terms/$term.h $term
done
check "stubs compile" gcc -std=c11 $warnings gen/catalog.c
check "stubs compile as C++" g++ -x c++ -std=c++17 $warnings gen/catalog.c
cp "$here"/runtime/tools/*.h gen/tools
cp "$here"/runtime/terms/*.h gen/terms
check "a newer runtime" sh -c "gcc $warnings -DRUNTIME_ABI=8 gen/with.c 2>&1 | grep -q 'run dagc again'"
check "an older runtime" sh -c "gcc $warnings -DRUNTIME_ABI=6 gen/with.c 2>&1 | grep -q 'renew the runtime'"
sed -i 's/TOOL enum weigh_answer tool_weigh(struct discussion \*d, double most/TOOL enum weigh_answer tool_weigh(struct discussion *d, float most/' gen/tools/weigh.h
check "a tool that drifts from its declaration" sh -c "! gcc -std=c11 $warnings gen/catalog.c"
sed -i 's/tally() *question answers (few, some, many)/&/; s/(few, some, many)/(few, some, many, all)/' catalog.dag
"$dagc" --emit=catalog-h -o gen/catalog.h catalog.dag
check "a tool with a new answer" sh -c "gcc -std=c11 $warnings gen/two.c 2>&1 | grep -q 'other answers'"

echo "dagc: $count checks of the command, $bad failed"
[ "$bad" = 0 ]
