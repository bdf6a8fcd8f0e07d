#!/bin/sh
# check_copies.sh - dagc --copies: the same decisions, terms and calls from every start as without, no
# check of the data manager in a first discussion, and one in those that begin with what a decision left. DAGC names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

# Paths that know the size, or where, or neither, meet at d, e and g.
cat >meet.dag <<'END'
oracle meet {
  param most : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c; neither -> d; }
  node b = measure() { done -> d; }
  node c = weigh(most = most, share = min(1, abs(size.rough))) { light -> d; heavy -> e; }
  node d = weigh(most = most, share = min(1, abs(size.fine))) { light -> e; heavy -> drop; }
  node e = look() { left -> f; right -> g; neither -> h; }
  node f = tally(upto = 3, scale = 2) { few -> g; some | many -> h; }
  node g = weigh(most = 2, share = min(1, abs(size.rough))) { light -> h; heavy -> split; }
  node h = measure() { done -> i; }
  node i = weigh(share = min(1, abs(size.fine))) { light -> keep; heavy -> split; }
}
END
cat >host.c <<'END'
#include "meet.h"
#include "random_script.h"

int main(int argc, char **argv)
{
    (void)argv;
    struct meet_parameters p;
    unsigned long long checks = 0, again = 0;
    unsigned random = 1;
    meet_defaults(&p);
    for (int run = 0; run < 20000; run++) {
        static struct record record;
        struct discussion d, c;
        unsigned char script[64];
        random_script(&d, &record, script, &random);
        int start = run % 4; /* nothing known; some; all */
        d.terms.size = start > 0 ? 7 : 0;
        d.terms.size_level = (unsigned char)(start > 2 ? SIZE_FINE : start);
        d.terms.where[0] = start > 1 ? 5 : 0;
        d.terms.where_level = start > 1;
        d.terms.times_level = start == 3;
        c = d;
        enum decision decision =
#ifdef COPIED
            start == 0 ? meet_refine_first(&p, &d) :
#endif
            meet_refine(&p, &d);
        print_calls(run, (int)decision, &record);
        if (decision == DECISION_KEEP)
            printf(" %g %d %g %d %d %d", d.terms.size, d.terms.size_level, d.terms.where[0],
                   d.terms.where_level, d.terms.times, d.terms.times_level);
        printf("\n");
        struct meet_counters counters;
        memset(&counters, 0, sizeof counters);
        record.calls = 0;
        if (meet_refine_counted(&p, &c, &counters) != decision)
            printf("counted: another decision\n");
        checks += start == 0 ? counters.checks : 0;
        again += start == 3 ? counters.checks : 0;
    }
    fprintf(stderr, "%s %llu\n", checks == 0 ? "none" : "some", again);
    return argc > 1 && checks > 0;
}
END
sources="-I$top/tests/dagc/runtime -I$top/runtime"
"$dagc" --catalog "$catalog" --emit=catalog-h -o catalog.h "$catalog" 2>/dev/null || "$dagc" --emit=catalog-h -o catalog.h "$catalog"
make_one() { # FOLDER COPIES COMPILER...
    folder=$1 copies=$2
    shift 2
    mkdir -p "$folder"
    "$dagc" -Wno-all --catalog "$catalog" --instrument --copies="$copies" -o "$folder/meet.c" --header "$folder/meet.h" meet.dag &&
        "$@" -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -Wno-unused-label -I"$folder" -I. $sources \
            -ffp-contract=off $([ "$copies" = 1 ] || echo -DCOPIED) -o "$folder/host" "$folder/meet.c" host.c -lm
}
check "one of each" make_one one 1 cc -O1
check "copies" make_one more 8 cc -O2
check "two of each" make_one two 2 cc -O1
one/host >one.txt 2>one.checks
cut -d" " -f2 one.checks >one.again
for which in two more; do
    check "$which: it runs" sh -c "$which/host >$which.txt 2>$which.checks"
    check "$which: the same from every start" cmp one.txt $which.txt
done
check "without copies, a first discussion looks" grep -q some one.checks
check "with them it does not" grep -q none more.checks
check "one that knows what keep left looks less than half as often" \
    sh -c '[ $((2 * $(cut -d" " -f2 more.checks))) -lt "$(cut -d" " -f2 one.checks)" ]'
check "too few copies to know anything cost no look" sh -c 'cut -d" " -f2 two.checks | cmp -s - one.again'
check "a copy stands under a name of its own" grep -q '^copy2_d:' more/meet.c
# Where decisions read nothing, all discussions begin with nothing, by whichever entry.
sed 's/^decision keep reads ([^)]*)/decision keep/' "$catalog" >forgets.dag
check "nothing is kept: one entry's copies serve both" sh -c "'$dagc' -Wno-all --catalog forgets.dag --copies=8 meet.dag -o - >forgets.c && grep -q 'copy2_d:' forgets.c && ! grep -q 'copy2_a:' forgets.c"
check "without the option the text has no second entry" sh -c '! grep -q refine_first one/meet.c'
check "all are proved" sh -c "'$dagc' -Wno-all --catalog '$catalog' --prove --copies=8 --instrument meet.dag | grep -q 'proved on'"
for change in 's/goto copy2_d;/goto copy2_e;/' 's/goto node_a;/goto node_e;/'; do
    break_c "$change"
    check "a fault: $change" sh -c "CC='$tmp/broken' '$dagc' -Wno-all --catalog '$catalog' --prove --copies=8 meet.dag | grep -q 'differs in'"
done
for wrong in 0 65 x ""; do
    check "--copies=$wrong" sh -c "'$dagc' --copies=$wrong meet.dag 2>&1 | grep -q 'takes a number from 1 to 64'"
done
if [ -n "${THOROUGH-}" ]; then
    for oracle in "$top"/examples/oracles/*.dag; do
        [ "${oracle##*/}" = common.dag ] && continue
        check "prove ${oracle##*/}" sh -c "'$dagc' -Wno-all --prove --copies=8 --instrument '$oracle' | grep -q 'proved on'"
    done
fi
finish "dagc --copies"
