#!/bin/sh
# check_emit.sh - what dagc emits beyond the plain function: proofs, differences, standalone text and the
# program that ships it. DAGC names the command; a compiler that is missing is reported as skipped.
# Once is enough: it compiles what dagc writes, by every compiler there is; what dagc writes is held to its bytes elsewhere.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
engine=$(dirname "$dagc")/../tests/runtime/embed_engine

status() { # WANTED COMMAND...
    wanted=$1
    shift
    "$@"
    got=$?
    [ $got = "$wanted" ] || { echo "exit $got, not $wanted"; return 1; }
}

# What optimises finds no other errors here, and takes ten times as long.
optimise=-O0
printf '#!/bin/sh\nexec cc "$@" -O0\n' >cc0 && chmod +x cc0
graphs=10
set -- "gcc -std=c99" "clang++ -x c++ -std=c++17" # both compilers and both languages, once
if [ -n "${THOROUGH-}" ]; then
    optimise=-O2 graphs=200
    set -- "gcc -std=c99" "clang -std=c99" "tcc" "g++ -x c++ -std=c++17" "clang++ -x c++ -std=c++17"
else
    export CC="$tmp/cc0"
fi

# ---- proofs
# All oracles as one file, for one call of the C compiler; common.dag has branches alone.
{
    echo 'import "common.dag";'
    for oracle in "$top"/examples/oracles/*.dag; do
        [ "${oracle##*/}" = common.dag ] || grep -v '^import "common.dag";' "$oracle"
    done
} >all.dag
cp "$top/examples/oracles/common.dag" .
check "prove the oracles" says "proved on" "$dagc" -Wno-all --prove --instrument --trace all.dag
check "prove each of them" sh -c '[ "$(grep -c ": proved on" said)" = "$(grep -c "^oracle " all.dag)" ]'
check "prove a user's tool and term" "$dagc" --prove --instrument --trace "$top/examples/user_tool/near_first.dag"
check "prove branches and externs" says 'proved on all' "$dagc" -Wno-all --catalog "$catalog" --prove --instrument --trace "$top/tests/dagc/emit_branch.dag"
check "$graphs random graphs" sh "$top/tests/dagc/prove.sh" "$dagc" $graphs
# All of them for C++, against the runtime's headers and beside none: g++ says most about what is C alone.
if have g++; then
    "$dagc" --emit=catalog-h -o catalog.h "$top/runtime/catalog.dag"
    check "C++ of the oracles" "$dagc" -Wno-all --emit=c++ --release=wave -o all.cpp --header all.h all.dag
    check "C++ of the oracles alone" "$dagc" -Wno-all --emit=c++ --release=wave --standalone --prefix all -o alone.cpp --header alone.h all.dag
    for standard in c++11 c++17; do
        check "g++ -std=$standard" g++ -std=$standard -fsyntax-only -I. -I"$top/runtime" all.cpp
        check "g++ -std=$standard: alone" g++ -std=$standard -Wall -Wextra -Wpedantic -fsyntax-only alone.cpp
    done
fi
cat >small.dag <<'END'
oracle small {
  param most : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c; neither -> drop; }
  node b = weigh(most = most, share = 0.5) { light -> c; heavy -> split; }
  node c = measure() { done -> keep; }
}
END
# The proof must notice.
for change in 's/return DECISION_DROP/return DECISION_SPLIT/' 's/parameters->most, 0.5/1.5, 0.5/' 's/goto node_b/goto node_c/' \
              's/discussion->terms.size = d.terms.size/(void)d.terms.size/'; do
    break_c "$change"
    check "a fault: $change" says 'small: small_refine differs in' status 1 env CC="$tmp/broken" "$dagc" -Wno-all --catalog "$catalog" --prove small.dag
    check "its status: $change" sh -c '! grep -q "^exit " said'
done
check "no compiler" status 1 env CC=no-such-compiler "$dagc" -Wno-all --catalog "$catalog" --prove small.dag
check "nothing stays behind" sh -c "TMPDIR=$tmp $dagc -Wno-all --catalog $catalog --prove small.dag && ! ls -d $tmp/dagc.* 2>/dev/null"

# ---- differences
bf=$top/examples/oracles/bf.dag
cp "$bf" other.dag # beside another common.dag
sed 's/none -> hidden;  partial | all -> form/none -> hidden; partial -> subdivide_receiver; all -> form/' "$top/examples/oracles/common.dag" >common.dag
check "diff: the same" status 0 "$dagc" diff "$bf" "$bf"
check "diff: different" status 1 "$dagc" diff "$bf" other.dag
check "diff: the witness" says 'visibility(rays = rays, near = 0): partial' "$dagc" diff "$bf" other.dag
check "diff: the decision" says '^+ other.dag decides subdivide_receiver after seen' "$dagc" diff "$bf" other.dag
check "diff: trouble" status 2 "$dagc" diff "$bf" no-such-file.dag
check "diff: usage" status 2 "$dagc" diff "$bf"
check "diff: one of them from standard input" status 0 sh -c "'$dagc' diff - other.dag <other.dag"
check "diff: both" status 2 sh -c "'$dagc' diff - - <'$bf'"
check "diff: both, and why" says 'only one of the two files can be standard input' "$dagc" diff - -
check "diff: a catalog" says 'only one of the two files can be standard input' "$dagc" diff --catalog - "$bf" "$bf"
cat >twice.dag <<'END'
oracle small {
  param most : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c; neither -> drop; }
  node b = weigh(most = most, share = 0.5) { light -> again; heavy -> split; }
  node again = look() { left -> c; otherwise -> drop; }
  node c = measure() { done -> keep; }
}
END
check "diff: a question asked again has its answer" status 0 "$dagc" diff --catalog "$catalog" small.dag twice.dag
sed 's/most = most/most = 1/' small.dag >number.dag
check "diff: a number is not a parameter" status 1 "$dagc" diff --catalog "$catalog" small.dag number.dag
sed 's/flux = 1 /flux = 2 /' small.dag >default.dag
check "diff: a default" says '^+ parameter most = 2' "$dagc" diff --catalog "$catalog" small.dag default.dag
# weigh may leave size finer, which has levels: the next one answers by that. Behind measure it is as fine as can be.
row() { # FIRST SECOND MORE: light by both is drop, all else is split
    printf 'oracle row { start %s node a = weigh(share = %s) { light -> b; heavy -> split; }\n' "$3" "$1"
    printf 'node b = weigh(share = %s) { light -> drop; heavy -> split; } }\n' "$2"
}
row 0.25 0.5 'a;' >first.dag
row 0.5 0.25 'a;' >second.dag
check "diff: readers of a term with levels, in another order" status 1 "$dagc" diff --catalog "$catalog" first.dag second.dag
check "diff: how they differ" says '^  weigh(most = 1, share = 0.5): heavy' "$dagc" diff --catalog "$catalog" first.dag second.dag
row 0.25 0.5 'm; node m = measure() { done -> a; }' >first.dag
row 0.5 0.25 'm; node m = measure() { done -> a; }' >second.dag
check "diff: readers of a term at its last level" status 0 "$dagc" diff --catalog "$catalog" first.dag second.dag
cat >once.dag <<'END'
oracle row { start a; node a = weigh(share = 0.5) { light -> b; heavy -> split; } node b = look() { left -> drop; otherwise -> split; } }
END
cat >again.dag <<'END'
oracle row { start a; node a = weigh(share = 0.5) { light -> b; heavy -> split; }
  node b = look() { left -> c; otherwise -> split; } node c = weigh(share = 0.5) { light -> drop; heavy -> split; } }
END
check "diff: a reader finds what it left" status 0 "$dagc" diff --catalog "$catalog" once.dag again.dag
cat >wrote.dag <<'END'
oracle row { start a; node a = tally(upto = 2) { otherwise -> b; } node b = tally(upto = 9) { few -> drop; otherwise -> split; } }
END
sed 's/upto = 2/upto = 3/' wrote.dag >other.dag
check "diff: what a tool writes is its own" status 1 "$dagc" diff --catalog "$catalog" wrote.dag other.dag
# A term without levels is the same whoever reads it first: an argument, or a tool.
cat >plain.dag <<'END'
runtime "discussion.h" abi 7;
type ratio = real "";
term far : ratio in [0, inf];
tool above(value : ratio, limit : ratio) question answers (no precise, yes precise) "Above?";
tool away(limit : ratio) question answers (near precise, far precise) reads (far) "Far?";
decision keep "";
decision drop "";
END
plain() { # START NEXT_OF_ABOVE NEXT_OF_AWAY
    printf 'catalog "plain.dag"; oracle plain { start %s;\n' "$1"
    printf 'node above = above(value = far, limit = 4) { no -> %s; yes -> drop; }\n' "$2"
    printf 'node away = away(limit = 3) { near -> %s; far -> drop; } }\n' "$3"
}
plain above away keep >first.dag
plain away keep above >second.dag
check "diff: readers of a term without levels, in another order" says '^0 ways to decide differ' "$dagc" diff first.dag second.dag
for place in 's/share = 0.5/share = ZERO/' 's/flux = 1 /flux = ZERO /'; do
    sed "$place; s/ZERO/0/" small.dag >zero.dag
    sed "$place; s/ZERO/-0/" small.dag >below.dag
    check "diff: -0 is less than 0: $place" status 1 "$dagc" diff --catalog "$catalog" zero.dag below.dag
done
cat >minus.dag <<'END'
graph falls(by : ratio) exits (few, more) { start a; node a = tally(scale = -by) { few -> few; otherwise -> more; } }
oracle minus { start a; node a = falls(by = 2.5) { few -> drop; more -> split; } }
END
for pair in '-(2.5) -2.5' '--2.5 2.5' '-pi -3.141592653589793' '-by -2.5'; do
    for value in $pair; do
        echo "oracle minus { start a; node a = tally(scale = $value) { few -> drop; otherwise -> split; } }" >"$value.dag"
    done
    cp minus.dag ./-by.dag
    check "diff: $pair" status 0 "$dagc" diff --catalog "$catalog" "./${pair% *}.dag" "./${pair#* }.dag"
done
cat >computed.dag <<'END'
extern glow(size >= rough) : flux in [0, inf] "it shines";
oracle computed {
  param most : flux = 1 in [0, inf];
  start a;
  node a = weigh(most = max(lamp, glow) * 2, share = min(1, abs(size.fine))) { light -> b; heavy -> split; }
  node b = weigh(most = most + lamp, share = 0.5) { light -> drop; heavy -> split; }
}
END
check "diff: computed arguments" status 0 "$dagc" diff --catalog "$catalog" computed.dag computed.dag
for change in 's/max(lamp/min(lamp/' 's/\* 2/* 3/' 's/most + lamp/lamp/' 's/size\.fine/size.rough/' 's/glow(size/glow(where, size/'; do
    sed "$change" computed.dag >changed.dag
    check "diff: $change" status 1 "$dagc" diff --catalog "$catalog" computed.dag changed.dag
done
check "diff: an expression as a witness" says 'weigh(most = max(lamp, extern glow) \* 2, share = min(1, abs(size.fine))): light' \
    "$dagc" diff --catalog "$catalog" computed.dag changed.dag
{ grep '^extern' computed.dag; "$dagc" -Wno-all --catalog "$catalog" --emit=text computed.dag; } >back.dag
check "what --emit=text writes is read back" status 0 "$dagc" diff --catalog "$catalog" computed.dag back.dag
{ echo 'tool more() question answers (yes, no) "More?";'; cat computed.dag; } >more.dag
while IFS='|' read -r change what; do # both say which catalog they are for
    sed "$change" "$catalog" >other_catalog.dag
    { echo 'catalog "one.dag";'; cat small.dag; } >left.dag
    { echo 'catalog "other_catalog.dag";'; cat small.dag; } >right.dag
    cp "$catalog" one.dag
    check "diff: $change" status 2 "$dagc" diff left.dag right.dag
    check "diff: $what" says "the two files declare the $what differently" "$dagc" diff left.dag right.dag
done <<'END'
s/abi 7/abi 8/|runtime
s/"discussion.h"/"discussion2.h"/|runtime
s/many -> split) "How/many -> split) header "tools\/two.h" "How/|tool tally
s/upto : count/most : count/|tool tally
s/scale : ratio/scale : flux/|tool tally
s/reads (times) writes (times)/writes (times)/|tool tally
s/writes (size >= fine, where)/writes (size >= rough, where)/|tool measure
s/rough < fine/rough < good < fine/|term size
s/term times : count/term times : ratio/|term times
END
sed 's/"Is it light?"/"Light?"/; s/heavy approximate/heavy precise/' "$catalog" >other_catalog.dag
check "diff: another documentation" status 0 "$dagc" diff left.dag right.dag
sed 's/facts\[3\]/facts[4]/' "$catalog" >other_catalog.dag
check "diff: a fact that is not read is another" status 0 "$dagc" diff left.dag right.dag
sed -i 's/most = most/most = lamp/' left.dag right.dag
check "diff: a fact that is read is another" status 1 "$dagc" diff left.dag right.dag
check "diff: which" says '^+ fact lamp = "d->record->facts\[4\]"' "$dagc" diff left.dag right.dag
check "diff: other tools" status 2 "$dagc" diff --catalog "$catalog" computed.dag more.dag

# Graphs may be as deep as dagc takes them, and many.
chain() { # LAST: 10,000 questions in a row
    awk -v last="$1" 'BEGIN { print "oracle deep { start n0;"
        for (i = 0; i < 9999; i++) print "node n" i " = weigh(most = " i ", share = 0.5) { light -> n" i + 1 "; heavy -> drop; }"
        print "node n9999 = look() { left -> " last "; otherwise -> drop; } }" }'
}
chain split >deep.dag
chain drop >shallow.dag
check "diff: a chain of 10,000" status 1 sh -c "ulimit -s 1024; '$dagc' diff --catalog '$catalog' deep.dag shallow.dag >said"
check "diff: and its one way" grep -q '^1 ways to decide differ' said
awk 'BEGIN { for (i = 0; i < 200; i++) print "oracle o" i " { start a; node a = look() { left -> split; otherwise -> drop; } }" }' >many.dag
sed 's/left -> split/right -> split/' many.dag >others.dag
[ -n "${SANITIZE-}" ] || check "diff: 200 oracles in 1 GB" status 1 sh -c "ulimit -v 1000000; '$dagc' diff --catalog '$catalog' many.dag others.dag"

# ---- the catalog's documentation
sed 's/"Which way?"/"Is a \&lt; b, or \&copy;, or a < b?"/' "$catalog" >signs.dag
check "Markdown shows & and <" says '^Is a \\&lt; b, or \\&copy;, or a \\< b?$' "$dagc" --emit=catalog signs.dag

# ---- standalone, and the program that ships it
embed=$top/examples/embed
mkdir made
check "made anew" sh -c "cd made && $dagc --standalone --prefix refiner -o refiner.c --header refiner.h $top/examples/oracles/bf_guarded.dag"
check "refiner.c is what dagc makes" cmp made/refiner.c "$embed/refiner.c"
check "refiner.h is what dagc makes" cmp made/refiner.h "$embed/refiner.h"
check "a host finds levels in the header" grep -q REFINER_FORM_FACTOR_CONTOUR "$embed/refiner.h"
check "a host finds what lists are" grep -q REFINER_BLOCKERS_INHERITED "$embed/refiner.h"
[ -x "$engine" ] && check "the engine's decisions" sh -c "$engine $top/examples/oracles/bf_guarded.dag >wanted"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
# Without a term, with one: struct terms has no more than that.
echo 'oracle cluster { start a; node a = clusters() { receiver -> subdivide_receiver; emitter -> subdivide_emitter; otherwise -> stop; } }' >cluster.dag
echo 'oracle dark { start a; node a = transfer(relative = 1) { otherwise -> stop; } }' >dark.dag
for oracle in cluster dark; do
    check "standalone $oracle" "$dagc" -Wno-all --standalone --instrument --trace -o $oracle.c --header $oracle.h $oracle.dag
done
check "no term" says '^    char none; ' cat cluster.h
check "one term is there" grep -q '^    double form_factor;' dark.h
check "another is not" sh -c "! grep -q 'visibility_level;' dark.h"
for oracle in bf bf_guarded viewfactors; do
    check "standalone $oracle" "$dagc" --standalone --instrument --trace -o $oracle.c --header $oracle.h "$top/examples/oracles/$oracle.dag"
done
check "standalone near_first" "$dagc" --standalone --instrument --prefix near_first -I "$top/examples/user_tool" -o near_first.c --header near_first.h "$top/examples/user_tool/near_first.dag"
for compiler; do
    if ! command -v "${compiler%% *}" >/dev/null; then
        echo "skipped: ${compiler%% *} is not installed"
        continue
    fi
    for oracle in bf bf_guarded viewfactors near_first cluster dark; do
        check "$compiler $oracle" $compiler $warnings $optimise -c -o $oracle.o $oracle.c
        # shellcheck disable=SC2016
        [ "$compiler" = tcc ] || check "symbols of $oracle" sh -c "! nm -g --defined-only $oracle.o | grep -v -e ' ${oracle}_' -e ' W _ZSt'"
    done
    check "$compiler embed" $compiler $warnings $optimise -o embed "$embed/main.c" "$embed/mesh.c" "$embed/refiner.c" -lm
    check "$compiler runs" sh -c './embed >got'
    [ -x "$engine" ] && check "$compiler decides as the engine does" cmp wanted got
done
[ -x "$engine" ] || echo "skipped: no $engine to compare with"
# A name that begins with the prefix keeps itself, and so what would become the same must become another; nor may the header's guard
# be that of a file in it or of a header that it includes.
for prefix in light cluster outline tool discussion catalog geometry kernel_cut; do
    check "standalone, prefix $prefix" "$dagc" --standalone --prefix $prefix -o same.c --header same.h "$top/examples/oracles/power.dag"
    # shellcheck disable=SC2086
    check "prefix $prefix compiles" gcc -std=c99 $warnings -fsyntax-only same.c
    [ $prefix = light ] && check "a name for each" grep -q '^enum light_light_visibility_answer {' same.h
done
check "the program's header has the guard" "$dagc" -Wno-all --standalone --prefix net --host sub/net.h -o same.c --header same.h "$bf"
check "so this has another" grep -q '^#ifndef NET_NET_H' same.h

check "--prefix" status 2 "$dagc" --standalone --prefix 9x -o x.c --header x.h "$bf"
check "no --standalone" status 2 "$dagc" --prefix x "$bf"
check "a proof writes nothing" status 2 "$dagc" --prove -o x.c "$bf"
check "no header with a proof" status 2 "$dagc" --prove --header x.h "$bf"
check "a proof of a drawing" status 2 "$dagc" --prove --emit=dot "$bf"
check "no --header" status 2 "$dagc" --standalone -o x.c "$bf"

finish "emit"
