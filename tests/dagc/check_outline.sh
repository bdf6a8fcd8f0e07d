#!/bin/sh
# check_outline.sh - dagc --outline: a graph used more than once is one function where that makes the text shorter, and nothing
# else changes: the same decisions, terms and calls from every start. DAGC names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# Four uses with other arguments, exits and places to go on; inside, a graph that is used twice.
cat >often.dag <<'END'
graph half(share : ratio in [0, 1]) exits (light, heavy) {
  start w;
  node w = weigh(most = 2, share = share) { light -> r; heavy -> heavy; }
  node r = weigh(share = min(1, abs(size.fine))) { light -> t; heavy -> heavy; }
  node t = tally(upto = 3, scale = 2) { few -> light; some | many -> heavy; }
}
graph whole(share : ratio in [0, 1], upto : count in [1, 100]) exits (small, large) {
  start l;
  node l = look() { left -> one; right -> two; neither -> drop; }
  node one = half(share = share) { light -> m; heavy -> large; }
  node two = half(share = 0.25) { light -> small; heavy -> m; }
  node m = measure() { done -> n; }
  node n = tally(upto = upto, scale = 1) { few -> small; some -> keep; many -> large; }
}
oracle often {
  param most : ratio = 0.5 in [0, 1];
  param times : count = 4 in [1, 9];
  start a;
  node a = whole(share = most, upto = 2) { small -> b; large -> c; }
  node b = whole(share = 0.125, upto = times) { small -> c; large -> m; }
  node c = whole(share = left.area / right.area, upto = 2) { small -> d; large -> split; }
  node d = whole(share = most * 2, upto = times) { small -> m; large -> drop; }
  node m = measure() { done -> keep; }
}
END
sed -i 's/left.area \/ right.area/min(1, left.area \/ right.area)/; s/most \* 2/min(1, most * 2)/' often.dag
cat >host.c <<'END'
#include "often.h"
#include "random_script.h"

int main(void)
{
    struct often_parameters p;
    unsigned random = 1;
    often_defaults(&p);
    for (int run = 0; run < 20000; run++) {
        static struct record record;
        struct discussion d;
        unsigned char script[64];
        random_script(&d, &record, script, &random);
        record.facts[0] = run % 5;
        record.facts[1] = 2;
        d.terms.size_level = (unsigned char)(run % 3);
        d.terms.times_level = (unsigned char)(run % 2);
        d.terms.times = d.terms.times_level;
        p.times = 1 + run % 9;
        enum decision decision = often_refine(&p, &d);
        print_calls(run, (int)decision, &record);
        if (decision == DECISION_KEEP)
            printf(" %g %d %d %d", d.terms.size, d.terms.size_level, d.terms.times, d.terms.times_level);
        printf("\n");
    }
    return 0;
}
END
"$dagc" --emit=catalog-h -o catalog.h "$catalog"
make_one() { # FOLDER OPTION COMPILER...
    folder=$1 option=$2
    shift 2
    mkdir -p "$folder"
    "$dagc" -Wno-all --catalog "$catalog" $option -o "$folder/often.c" --header "$folder/often.h" often.dag &&
        "$@" -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -I"$folder" -I. -I"$top/tests/dagc/runtime" -I"$top/runtime" \
            -ffp-contract=off -o "$folder/host" "$folder/often.c" host.c -lm
}
size() { wc -c <"$1"; }
check "whole" make_one whole "" cc -std=c11 -O1
check "outlined" make_one outlined --outline cc -std=c11 -O1
if command -v g++ >/dev/null; then check "in C++" make_one cxx --outline g++ -x c++ -std=c++17 -O0; fi
whole/host >whole.txt
check "it runs" sh -c 'outlined/host >out.txt'
check "the same" cmp whole.txt out.txt
check "many ways through it" sh -c '[ "$(cut -d" " -f2- whole.txt | sort -u | wc -l)" -gt 1000 ]'
check "shorter" [ "$(size outlined/often.c)" -lt $(($(size whole/often.c) * 3 / 4)) ]
check "one function, four calls" sh -c '[ "$(grep -c often_branch_whole outlined/often.c)" = 5 ]'
check "proved" sh -c "'$dagc' -Wno-all --catalog '$catalog' --prove --outline --instrument --trace often.dag | grep -q 'often: proved on'"
# The proof must notice.
for change in 's/return 1;/return 0;/' 's/(discussion, argument_1,/(discussion, 0.5,/' 's/is no number/is none/' 's/(parameters, &d, 0.125/(parameters, \&d, 0.25/'; do
    break_c "$change"
    check "a fault: $change" sh -c "CC='$tmp/broken' '$dagc' -Wno-all --catalog '$catalog' --prove --outline often.dag | grep -q 'differs in'"
done

# The first use sends both exits to one place, in one switch and behind one question; the others do not.
cat >apart.dag <<'END'
graph two() exits (u, v) {
  start a;
  node a = weigh(most = 1, share = 0.5) { light -> b; heavy -> u; }
  node b = weigh(most = 2, share = 0.5) { light -> c; heavy -> u; }
  node c = weigh(most = 3, share = 0.5) { light -> d; heavy -> u; }
  node d = tally(upto = 2, scale = 1) { few -> e; some -> u; many -> v; }
  node e = weigh(most = 4, share = 0.5) { light -> u; heavy -> v; }
}
oracle apart {
  start s;
  node s = look() { left -> p; right -> q; neither -> r; }
  node p = two() { u | v -> drop; }
  node q = two() { u -> drop; v -> split; }
  node r = two() { u -> split; v -> drop; }
}
END
check "exits apart: one function" sh -c "[ \"\$('$dagc' -Wno-all --catalog '$catalog' --outline apart.dag | grep -c apart_branch_two)\" = 4 ]"
check "exits that one use joins" sh -c "'$dagc' -Wno-all --catalog '$catalog' --prove --outline apart.dag | grep -q 'apart: proved on'"

# What cannot be, or would not be shorter, stays: an argument that computes a term; three nodes.
sed 's/share = 0.125/share = min(1, abs(size.rough))/' often.dag >reads.dag
check "terms are read where they were" sh -c "! '$dagc' -Wno-all --catalog '$catalog' --outline reads.dag | grep -q branch_whole"
"$dagc" -Wno-all "$top/examples/oracles/bf_guarded.dag" >plain.c
"$dagc" -Wno-all --outline "$top/examples/oracles/bf_guarded.dag" >outlined.c
check "nothing to gain, nothing changed" cmp plain.c outlined.c
for oracle in thermal tester; do
    "$dagc" -Wno-all "$top/examples/oracles/$oracle.dag" >plain.c
    "$dagc" -Wno-all --outline "$top/examples/oracles/$oracle.dag" >outlined.c
    check "$oracle is shorter" [ "$(size outlined.c)" -lt $(($(size plain.c) * 9 / 10)) ]
done
check "what was too large is one function" sh -c '! grep -q tester_part_ outlined.c'
check "not with copies" sh -c "'$dagc' --outline --copies=2 often.dag 2>&1 | grep -q 'take one'"
if [ -n "${THOROUGH-}" ]; then
    for oracle in "$top"/examples/oracles/*.dag; do
        [ "${oracle##*/}" = common.dag ] && continue
        check "prove ${oracle##*/}" sh -c "'$dagc' -Wno-all --prove --outline '$oracle' | grep -q 'proved on'"
    done
fi
finish "dagc --outline"
