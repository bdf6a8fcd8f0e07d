#!/bin/sh
# check_prove.sh - dagc --prove notices each thing that could be wrong in what runs: a C compiler that changes one place
# of what it is given stands for an emitter or an interpreter that errs there. DAGC names the command.
# Once is enough: it is about programs that dagc writes, broken on purpose and compiled.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

fail() {
    bad=$((bad + 1))
    echo "failed: $1"
    head -n 5 said
}

cat >small.dag <<'END_OF_GRAPH'
extern glow(size >= rough, where) : flux in [0, inf] "it shines";
oracle small "text" {
  param most : flux = 1.5 in [0.5, inf] "how much";
  fixed param less : flux = 0.25 in [0, 3];
  param upto : count = 8 in [1, 100];
  start a;
  node a = look() { left -> b; right -> c; neither -> drop; }
  node b = weigh(most = max(most - less, glow), share = 0.5) { light -> c; heavy -> d; }
  node c = measure() { done -> e; }
  node d = tally(upto = upto) { few -> h; some -> split; many -> h; }
  node e = weigh(most = max(most * size.rough, 0), share = min(1, right.area / left.area)) { light -> keep; heavy -> f; }
  node f = look() { left -> g; right -> g; neither -> split; }
  node h = weigh(most = 2, share = 0.25) { light -> c; heavy -> drop; }
  node g = weigh(share = 1) { light -> keep; heavy -> drop; }
}
END_OF_GRAPH
prove="$dagc -Wno-all --catalog $top/tests/dagc/test_catalog.dag --prove --instrument --trace --release=wave small.dag"

count=$((count + 1))
CC=$tmp/cc0 && printf '#!/bin/sh\nexec cc "$@" -O0\n' >cc0 && chmod +x cc0 && export CC
$prove >said 2>&1 && grep -q '^small: proved on all [0-9]* paths from 12 beginnings, by [0-9]* states: refine, refine_counted, refine_traced, refine_wave, the interpreter$' said ||
    fail "the graph as it is"

# file | what sed does to it | what the proof says then; with a * a change that is made in every run, the others in thorough ones
while IFS='|' read -r file change says; do
    case $file in \**) file=${file#\*} ;; *) [ -n "${THOROUGH-}" ] || continue ;; esac
    count=$((count + 1))
    file=$(echo $file) says=$(echo $says)
    printf '#!/bin/sh\nfor f; do case $f in */%s) cp $f %s/kept; sed -i %s $f; cmp -s $f %s/kept && echo "nothing is like it" >&2 && exit 1;; esac; done\nexec cc "$@" -O0\n' \
        "$file" "$tmp" "'$change'" "$tmp" >broken
    chmod +x broken
    CC=$tmp/broken $prove >said 2>&1
    [ $? = 1 ] && grep -q -e "small: .*$says" said || fail "$file: $change"
done <<'END_OF_FAULTS'
*oracles.c|s/return DECISION_DROP/return DECISION_SPLIT/|small_refine differs in the decision
oracles.c|s/goto node_d;/goto node_c;/|small_refine differs in the calls
oracles.c|s/= 0.5/= 0.25/; s/, 0\.5)/, 0.25)/|small_refine differs in an argument
oracles.c|s/parameters->most - parameters->less/parameters->less - parameters->most/|small_refine differs in an argument
*oracles.c|s/value_max(double a, double b)/value_max(double b, double a)/; s/return a > b/return a < b/|small_refine differs in an argument
oracles.c|s/SIZE_ROUGH)/SIZE_FINE)/|small_refine differs in an argument
*oracles.c|s/(void)term_where(&d);//|small_refine differs in the calls
oracles.c|s/d.terms.times_level = TIMES_ABSENT/d.terms.times_level = 1/; s/struct discussion d = \*discussion;/&d.terms.size_level = 0;/|small_refine differs in what is known when a tool is asked
oracles.c|s/discussion->terms.where\[2\] = d.terms.where\[2\];//|small_refine differs in a term that the decision reads
oracles.c|s/discussion->terms.size_level = d.terms.size_level;//|small_refine differs in a term that the decision reads
oracles.c|s/size_level >= SIZE_FINE/size_level > SIZE_FINE/|differs in what it takes for known
oracles.c|s/counters->calls\[node\]++/counters->calls[0]++/|small_refine_counted differs in what was counted
oracles.c|/refine_traced(/,$s/trace(context, &d, 0,/(void)(context, \&d, 0,/|small_refine_traced differs in what was counted
*oracles.c|s/uint16_t pair = at\[\([0-9]*\)\]\[k\];/uint16_t pair = at[\1][0];/|small_refine_wave differs in
oracles.c|s/decides\[answer\];/decides[0];/|small_refine_wave differs in
oracles.c|s/\(leads_[0-9]*\)\[answer\];/\1[0];/|small_refine_wave differs in
oracles.c|s/waiting\[[0-9]*\] = 0;//|small_refine_wave differs in
oracles.c|s/tool_weigh(d, given/tool_weigh(\&block[k], given/|small_refine_wave differs in
*oracles.c|s/discussion \*d = \&block\[pair\];/discussion *d = \&block[k];/|small_refine_wave differs in the calls
oracles.c|s/at\[1\]\[k\] = (uint16_t)k;/& block[k].terms.size_level = 0;/|small_refine_wave differs in what is known
*oracles.c|s/parameters->most = 1.5/parameters->most = 7.0/|the compiled oracle differs in the default that is filled in of parameter most
*oracles.c|s/^     1.5, 0.5, INFINITY/     7.0, 0.5, INFINITY/|the compiled oracle differs in the default of parameter most
oracles.c|s/^     1.5, 0.5, INFINITY/     1.5, 0.25, INFINITY/|the compiled oracle differs in the least value of parameter most
oracles.c|s/^     0.25, 0.0, 3.0/     0.25, 0.0, 4.0/|the compiled oracle differs in the largest value of parameter less
*oracles.c|s/offsetof(struct small_parameters, most), ROLE/offsetof(struct small_parameters, less), ROLE/|the compiled oracle differs in the offset of parameter most
oracles.c|s/sizeof(struct small_parameters),$/1 + &/|the compiled oracle differs in the size of its parameters
oracles.c|s/{"upto", ""/{"upto", "m"/|the compiled oracle differs in the unit of parameter upto
oracles.c|s/"how much"/"how many"/|the compiled oracle differs in the text of parameter most
oracles.c|s/ROLE_NONE, 1},/ROLE_NONE, 0},/|the compiled oracle differs in being fixed of parameter less
*oracles.c|s/    "\([0-9a-f]\{15\}\)[0-9a-f]",/    "\1g",/|the compiled oracle differs in its fingerprint
*oracles.c|s/^    RUNTIME_ABI,/    RUNTIME_ABI + 1,/|the compiled oracle says another RUNTIME_ABI
oracles.c|s/^    FACT_RIGHT_AREA,/    FACT_LEFT_AREA,/|the compiled oracle differs in the facts that it reads
*oracle/interpreter.c|s/return (enum decision) ~next;/return (enum decision)(~next == 1 ? 2 : ~next);/|the interpreter differs in the decision
oracle/interpreter.c|s/\~t->index : /(t->index == 1 ? ~2 : ~t->index) : /|the interpreter differs in the decision
*oracle/interpreter.c|s/: dag->nodes\[t->index\].order;/: dag->nodes[t->index].order + (k == 0 \&\& i == 0);/|the interpreter differs in the calls
oracle/interpreter.c|s/o->low = q->low/o->low = 0/|the interpreter differs in the least value of parameter most
oracle/interpreter.c|s/o->fixed = q->fixed/o->fixed = 0/|the interpreter differs in being fixed of parameter less
oracle/interpreter.c|s/o->value = q->value/o->value = i == 1 ? 7 : q->value/|the interpreter differs in the default of parameter less
*oracle/arguments.c|s/return a > b/return a < b/|the interpreter differs in an argument
oracle/arguments.c|s/p->arguments\[i\] = dag_is_fixed/p->arguments[i] = i != 3 \&\& dag_is_fixed/|the interpreter differs in an argument
oracle/arguments.c|s/top\[-1\] = operate(i->kind, top\[-1\], top\[0\])/top[-1] = operate(i->kind, top[0], top[-1])/|the interpreter differs in an argument
oracle/refiner.c|s/value <= p->high/value < INFINITY/|differs in setting of parameter upto
catalog.c|s/tool_tally(d, (int)arguments\[0\], /tool_tally(d, (int)arguments[1], /|the interpreter differs in an argument
END_OF_FAULTS

# With nodes copied where paths know different terms: the same, and a copy that takes for known what is not.
count=$((count + 1))
copied="$prove --copies=4"
$copied >said 2>&1 && grep -q ' states: refine, refine_first, refine_counted, refine_traced, refine_wave, the interpreter$' said || fail "copies"
count=$((count + 1))
printf '#!/bin/sh\nfor f; do case $f in */oracles.c) sed -i "s/if (d.terms.size_level >= SIZE_FINE)/if (d.terms.size_level >= SIZE_ROUGH)/" $f;; esac; done\nexec cc "$@" -O0\n' >broken
CC=$tmp/broken $copied >said 2>&1
[ $? = 1 ] && grep -q 'differs in what it takes for known' said || fail "copies that take too much for known"
# More paths than a number can hold.
awk 'BEGIN {
    print "oracle many { param p : flux = 1 in [0, inf]; start n0;"
    for (i = 0; i < 1500; i++)
        printf "node n%d = weigh(most = p * %d, share = 0.5) { light -> %s; heavy -> %s; }\n", i, i + 1,
            i < 1499 ? "n" i + 1 : "drop", i < 1498 ? "n" i + 2 : "drop"
    print "}" }' >many.dag
count=$((count + 1))
$dagc -Wno-all --catalog "$top/tests/dagc/test_catalog.dag" --prove many.dag >said 2>&1
grep -q '^many: proved on all 1e308 or more paths from ' said || fail "more paths than a number can hold"
# Arguments that are no number at the ends of ranges: the first of a path is told of, also among those of one call.
cat >doubts.dag <<'END_OF_GRAPH'
oracle doubts {
  param p : flux = 0 in [0, inf];
  param q : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c; neither -> drop; }
  node b = weigh(most = p / q * p, share = min(1, p / q)) { light -> c; heavy -> drop; }
  node c = weigh(most = max(p * (p / q), 1), share = min(1, right.area / left.area)) { light -> drop; heavy -> drop; }
}
END_OF_GRAPH
doubts="$dagc -Wno-all --catalog $top/tests/dagc/test_catalog.dag --prove doubts.dag"
count=$((count + 1))
$doubts >said 2>&1 && grep -q '^doubts: proved on all 6 paths' said || fail "arguments that are no number"
for change in 'oracles.c|s/no_number == NULL/no_number != what/' 'oracle/arguments.c|s/if (!d->terms.no_number)/if (d)/'; do
    count=$((count + 1))
    printf '#!/bin/sh\nfor f; do case $f in */%s) sed -i %s $f;; esac; done\nexec cc "$@" -O0\n' "${change%%|*}" "'${change#*|}'" >broken
    CC=$tmp/broken $doubts >said 2>&1
    [ $? = 1 ] && grep -q 'differs in which argument is no number' said || fail "$change"
done
# A catalog of other words.
count=$((count + 1))
sed 's/^runtime "discussion.h"/verb judge; runtime "judge.h"/' "$top/tests/dagc/test_catalog.dag" >judge.dag
"$dagc" -Wno-all --catalog judge.dag --prove small.dag >said 2>&1 && grep -q ' states: judge, the interpreter$' said || fail "another verb"
finish "prove"
