#!/bin/sh
# check_skeleton.sh - dagc --emit=stub: what it makes of every form that a catalog's declarations have compiles as it is made,
# runs, and goes on to do so with a graph that asks every tool, reads every term and fact, and has every answer given.
# DAGC names the command; a compiler that is missing is reported as skipped.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
refused() { # TEXT COMMAND...
    text=$1
    shift
    if "$@" >said 2>&1; then
        echo "it was not refused"
        return 1
    fi
    grep -qF -e "$text" said || { cat said; return 1; }
}

cat >all.dag <<'END_OF_CATALOG'
runtime "own/world.h" abi 12;
verb weigh_up;

unit ms   = 1e-3 s;
unit item = 1;

type number  = real "";
type whole   = integer "";
type items   = integer "item";
type delay   = real "ms";
type force   = real "kg m s-2";
type length  = real "m";
type place   = real[3] "m";
type pair_of = real[2] "";

role tolerance : delay "how late is too late";
role budget    : items;

term plain   : number;
term bounded : delay in [0, inf] "with a range";
term graded  : force levels (guess < bound < exact) "with levels";
term both    : number in [-1, 1] levels (low < high) header "terms/shared.h" "with both, in a header of several";
term twin    : whole in [0, 9] header "terms/shared.h";
term counted : items levels (some < all) wave;
term where   : place "a vector";
term two     : pair_of levels (rough < fine) header "tools/in_one.h" "a vector with levels, in a tool's header";

tool bare() question answers (yes, no);
tool kinds() question answers (sure precise, about approximate, what other, unsaid) "Every kind of answer.";
tool given(int : number, count : whole, at : delay, d : items) question answers (yes precise, no precise) reads (plain, both) writes (both >= high) wave "No range, no default; names that C or a stub has taken.";
tool ranged(a : number in [0, 1], b : whole = 3, c : force = 2.5 in [-inf, 9], d_ : items = 4 in [1, 100] "told") question
     answers (under approximate, over approximate) reads (plain, graded >= bound) "Ranges, defaults, words.";
tool limits(least : number = 0.5 in [0, 1], most : delay = 1 in [0, inf]) question
     answers (left precise, right precise, both precise, neither precise)
     guards (left | both -> cut_left, right | both -> cut_right) by (least, most) "Guards by two limits.";
tool later(least : number = 0.5 in [0.1, 1]) question answers (left, right)
     guards (left -> cut_left, right -> cut_right) by (least) after kinds(about | sure) header "tools/in_one.h" "Guards behind another.";
tool always() question answers (go, stay) guards (go -> cut_both) header "tools/in_one.h" "Guards by nothing.";
tool make() command answers (done) writes (plain, bounded, where);
tool make_exact() command answers (done) reads (plain) writes (graded >= exact, both >= high, two >= fine, twin, counted >= all) "All levels.";
tool tell(n : whole = 3) command answers (done) counts wave "Counts.";
tool note(value : number = 1, slot : whole = 0 in [0, 9]) command answers (done) records header "deep/er/note.h" "Records.";

decision stop;
decision keep reads (plain, graded >= exact, both >= high, where, two >= rough, counted, twin) "Reads of every form.";
decision cut_left subdivides "Cut.";
decision cut_right reads (bounded) subdivides;
decision cut_both subdivides;

fact alone      : number = "d->alone";
fact left.size  : length in [0, inf] = "d->left->size" "through a pointer";
fact left.many  : items in [0, 9] = "(int)d->left->many[2]";
fact right.size : length = "d->right.size";
fact d.size     : length in [0, inf] = "d->d->size" "called as the program's own";
fact list       : delay in [0, inf] = "d->list[1]";
fact total      : force in [0, inf] fixed = "d->sum->force" "the same for all";
fact made       : number = "d->left->size + d->right.size";
END_OF_CATALOG
cat >whole.dag <<'END_OF_GRAPH'
catalog "../all.dag";
extern own(plain, graded >= bound, where) : number in [0, 1] "the program's";
oracle whole "asks every tool" {
  param late  : delay = 2 in [0, inf] role tolerance "one with a role";
  param most  : items = 7 in [1, 9] role budget;
  param share : number = 0.5 in [0.1, 1];
  fixed param set : force = 1.5 in [0, 2];
  start n1;
  node n1  = bare() { yes | no -> n2; }
  node n2  = make() { done -> n3; }
  node n3  = make_exact() { done -> n4; }
  node n4  = kinds() { sure -> n5; about -> n6; what -> stop; unsaid -> n13; }
  node n5  = given(int = own, count = twin, at = list, d = left.many) { yes -> n6; no -> keep; }
  node n6  = ranged(a = share, c = min(9, min(total + set, graded.exact))) { under -> n7; over -> stop; }
  node n7  = ranged(a = min(1, abs(plain * both.high * alone)), b = twin, d_ = most) { under -> n8; over -> keep; }
  node n8  = tell(n = min(3, twin)) { done -> n9; }
  node n9  = note(value = left.size / right.size, slot = 2) { done -> n10; }
  node n10 = limits(least = share, most = late) { left -> n11; right -> cut_right; both -> n12; neither -> keep; }
  node n11 = later(least = share) { left -> n12; right -> cut_left; }
  node n12 = always() { go -> n13; stay -> keep; }
  node n13 = given(int = made, count = 3, at = bounded, d = min(9, max(1, counted.all))) { yes -> n14; no -> keep; }
  node n14 = always() { go -> cut_both; stay -> stop; }
}
END_OF_GRAPH
cat >whole_main.c <<'END_OF_PROGRAM'
#include <stdio.h>
#include <string.h>
#include "whole.h"
double whole_own(const struct whole_discussion *d) { return d->right.size / 2; }
int main(void)
{
    static const char *const names[] = {"stop", "keep", "cut_left", "cut_right", "cut_both"};
    struct whole_parameters parameters;
    struct whole_discussion d;
    struct whole_left left;
    struct whole_sum sum;
    memset(&d, 0, sizeof d);
    memset(&left, 0, sizeof left);
    memset(&sum, 0, sizeof sum);
    d.left = &left;
    d.sum = &sum;
    d.right.size = 1;
    whole_defaults(&parameters);
    const char *name = names[whole_weigh_up(&parameters, &d)];
    printf("%s %d\n", name, d.terms.graded_level);
    return 0;
}
END_OF_PROGRAM
decides() { # WANTED COMPILER...: the graph that asks all, as the skeleton's files answer now
    wanted=$1
    shift
    "$dagc" -Wno-all --standalone -I made --instrument --trace --release=wave -o whole.c --header whole.h made/whole.dag &&
        $* $warnings -o whole whole_main.c whole.c -lm && ./whole >said && grep -q "^$wanted " said || { cat said; return 1; }
}

check "stub" "$dagc" --emit=stub -o made all.dag
check "stub-c++" "$dagc" --emit=stub-c++ -o made_cxx all.dag
check "C and C++ have the same files but for the program's" sh -c 'for at in made made_cxx; do (cd $at; find . -type f | sed "s/main.cpp/main.c/" | sort) >$at.files; done; cmp made.files made_cxx.files'
check "no header is included twice" sh -c '! for file in $(find made -name "*.h"); do grep "^#include .terms/" $file | sort | uniq -d; done | grep .'
cp whole.dag made
set -- "gcc -std=c11" tcc "g++ -x c++"
[ -z "${THOROUGH-}" ] || set -- "$@" "clang -std=c11" "clang++ -x c++"
for compiler; do
    have ${compiler%% *} || continue
    check "$compiler: first.dag, without a warning" make -s -B -C made DAGC="$dagc -Werror" CC="$compiler" CFLAGS="-O0 $warnings"
    check "$compiler: it decides" sh -c '[ "$(made/first)" = stop ]'
    check "$compiler: every tool, term and fact" decides cut_both "$compiler"
done
if have g++; then
    check "g++: stub-c++" make -s -C made_cxx DAGC="$dagc -Werror" CXXFLAGS="-O0 $warnings"
    check "g++: stub-c++ decides" sh -c '[ "$(made_cxx/first)" = stop ]'
fi
# The interpreter's tables call each tool and term by its declaration, too.
check "catalog.h" "$dagc" --emit=catalog-h -o made/catalog.h all.dag
check "catalog.c" "$dagc" --emit=catalog-c -o made/catalog.c all.dag
check "catalog.c compiles" gcc -std=c11 $warnings -include made/own/world.h -Imade -I"$top/runtime/oracle" -I"$top/runtime" -c -o catalog.o made/catalog.c
# Each answer, given by its tool's file.
cc=$(command -v tcc || echo gcc)
while read -r file first answer wanted; do
    sed -i "s/return $first;/return $answer;/" made/$file
    check "$answer leads to $wanted" decides "$wanted" "$cc"
    sed -i "s/return $answer;/return $first;/" made/$file
done <<'END_OF_ANSWERS'
tools/bare.h BARE_YES BARE_NO cut_both
tools/kinds.h KINDS_SURE KINDS_ABOUT cut_both
tools/kinds.h KINDS_SURE KINDS_WHAT stop
tools/kinds.h KINDS_SURE KINDS_UNSAID cut_both
tools/given.h GIVEN_YES GIVEN_NO keep
tools/ranged.h RANGED_UNDER RANGED_OVER stop
tools/limits.h LIMITS_LEFT LIMITS_RIGHT cut_right
tools/limits.h LIMITS_LEFT LIMITS_BOTH cut_both
tools/limits.h LIMITS_LEFT LIMITS_NEITHER keep
tools/in_one.h LATER_LEFT LATER_RIGHT cut_left
tools/in_one.h ALWAYS_GO ALWAYS_STAY keep
tools/make.h MAKE_DONE MAKE_DONE cut_both
tools/make_exact.h MAKE_EXACT_DONE MAKE_EXACT_DONE cut_both
tools/tell.h TELL_DONE TELL_DONE cut_both
deep/er/note.h NOTE_DONE NOTE_DONE cut_both
END_OF_ANSWERS

# ---- what a graph must ask before it may decide
first() { # DECISION CATALOG-TEXT: of a skeleton, made without a warning
    rm -rf chain && echo "$2" >chain.dag && "$dagc" --emit=stub -o chain chain.dag &&
        make -s -C chain DAGC="$dagc -Werror" CC="$cc" CFLAGS= && [ "$(chain/first)" = "$1" ] || { cat chain/first.dag; return 1; }
}
head='runtime "x.h" abi 1; type n = real "";'
check "terms that other tools write, in turn" first keep "$head
term a : n levels (low < high); term b : n levels (low < high); term c : n;
tool last() command answers (done) reads (b >= high) writes (c);
tool middle() command answers (done) reads (a >= low) writes (b >= high);
tool coarse() command answers (done) writes (b >= low);
tool begin() command answers (done) writes (a >= low);
tool which() question answers (yes, no) reads (a >= low, c);
decision keep reads (c); decision drop;"
check "two that wait for each other are left out" first drop "$head
term a : n levels (low < high); term b : n levels (low < high);
tool one() question answers (yes, no) reads (b >= low) writes (a >= low);
tool two() question answers (yes, no) reads (a >= low) writes (b >= low);
tool ask() question answers (yes, no);
decision keep reads (a); decision drop; decision other;"
check "a tool that reads what it writes" first keep "$head
term a : n; tool tally() question answers (few, many) reads (a) writes (a); decision keep reads (a); decision drop;"
check "commands alone" first keep "$head
term a : n; tool make() command answers (done) writes (a); decision keep reads (a);"
check "what splits is not the first thing to do" first stop "$head
tool g() question answers (yes, no) guards (yes -> split); decision split subdivides; decision stop; decision leave;"
skeleton_of() {
    echo "$1" >chain.dag
    "$dagc" --emit=stub -o none chain.dag
}
check "a question with precise answers, over a block too" first stop "$head
tool g(than : n in [0, 9]) question answers (no precise, yes precise, maybe precise) wave; decision stop; decision go;"
check "nothing ends it" refused "lead to a decision that does not subdivide" skeleton_of "$head
tool g() question answers (yes, no) guards (yes -> split); decision split subdivides;"
check "nothing can be asked first" refused "every tool of this catalog reads what another must write" skeleton_of "$head
term a : n levels (low < high); term b : n levels (low < high);
tool one() command answers (done) reads (b >= low) writes (a >= low); tool two() command answers (done) reads (a >= low) writes (b >= low);
decision keep;"
check "where: a decision" refused "chain.dag:2:81: error: no tools of this catalog" skeleton_of "$head
tool g() question answers (yes, no) guards (yes -> split); term t : n; decision split subdivides;"
check "where: a tool" refused "chain.dag:3:6: error: every tool" skeleton_of "$head
term a : n levels (low < high); decision keep;
tool one() command answers (done) reads (a >= low) writes (a >= high);"
check "where: the catalog" refused "chain.dag:1:1: error: this catalog declares no tool" skeleton_of "$head decision keep;"
check "and nothing is made" [ ! -e none ]
finish "dagc --emit=stub"
