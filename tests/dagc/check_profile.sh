#!/bin/sh
# check_profile.sh - dagc --profile: what is measured is shown, questions that commute change places where it pays and decide as
# before, others stay; a file of another graph is refused by line and cause. DAGC names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"


# A row of filters and what follows; only `cheap` may be asked of all pairs.
cat >rows.dag <<'END2'
tool dear(share : ratio = 0 in [0, 1]) question answers (no precise, yes precise) anywhere "Cost much.";
tool cheap() question answers (no precise, yes precise) anywhere "Cost little.";
tool some() question answers (no precise, yes precise) "Of some pairs only.";
tool notes() question answers (no precise, yes precise) writes (mark) anywhere "Leaves something.";
tool looks() question answers (no precise, yes precise) reads (visibility) anywhere "May leave something.";
oracle rows {
  param share : ratio = 0.5 in [0, 1];
  start first;
  node first  = dear(share = share) { no -> stop; yes -> second; }
  node second = cheap()             { no -> stop; yes -> third; }
  node third  = some()              { no -> stop; yes -> fourth; }
  node fourth = notes()             { no -> stop; yes -> fifth; }
  node fifth  = looks()             { no -> stop; yes -> last; }
  node last   = can_split(min_share = share) { both -> subdivide_both; receiver -> subdivide_receiver;
                                               emitter -> subdivide_emitter; neither -> stop; }
}
END2
profile() { # NANOSECONDS_OF_FIRST: 1000 pairs, half of them end at `second` if they get there, a tenth anywhere else
    awk -v first="$1" 'BEGIN {
        split("first second third fourth fifth last", n); split("dear cheap some notes looks can_split", t)
        printf "{\"oracle\": \"rows\",\n \"nodes\": ["
        for (i = 1; i <= 6; i++) {
            calls = i == 1 ? 1000 : yes; yes = int(calls * (i == 2 ? .5 : .9))
            printf "%s\n  {\"node\": \"%s\", \"tool\": \"%s\", \"calls\": %d, \"mean_seconds\": %g, \"lists\": 8,\n", (i > 1 ? "," : ""),
                n[i], t[i], calls, (i == 1 ? first : 10) * 1e-9
            printf "   \"vectors\": {\"4\": %d, \"8\": %d, \"16\": %d},\n", calls / 4 + 8, calls / 8 + 8, calls / 16 + 8
            printf "   \"answers\": ["
            if (i == 6)
                printf "{\"answer\": \"both\", \"count\": 0}, {\"answer\": \"receiver\", \"count\": 0}, {\"answer\": \"emitter\", \"count\": 0}, {\"answer\": \"neither\", \"count\": %d}]}", calls
            else
                printf "{\"answer\": \"no\", \"count\": %d}, {\"answer\": \"yes\", \"count\": %d}]}", calls - yes, yes
        }
        print "\n ]\n}" }'
}
profile 100 >dear.json
profile 1 >fast.json

shown() { # PATTERN FILE.json
    "$dagc" -Wno-all --dump=waves --profile "$2" rows.dag >told && grep -qE -- "$1" told || { cat told; return 1; }
}
check "what was measured" shown '^  second +cheap +one by one +128\.0 +230\.4 +112\.5 +96\.6 % +93\.8 % +87\.9 % +10$' dear.json
check "the dearer one, second" shown '^  second \(10 ns, 50\.0 % end there\) now before first \(100 ns, 10\.0 % end there\): they commute' dear.json
check "it stays where it is cheap" shown '^  first \(1 ns, 10\.0 % end there\) before second .*: as it is; they commute' fast.json
check "not where it may have no answer" shown '^  (first|second) .* before third .*: as it is; some may have no answer' dear.json
check "nor where it leaves a mark" shown '^  third .* before fourth .*: as it is; notes does more than answer' dear.json
check "nor a term" shown '^  fourth .* before fifth .*: as it is; (notes does more|looks may leave visibility finer)' dear.json

same() { # A.dag B.dag: all ways decide the same
    "$dagc" diff "$1" "$2" | grep -q '^0 ways to decide differ'
}
ordered() { # FILE.json: the graph as it is asked then
    "$dagc" -Wno-all --emit=text --profile "$1" rows.dag >text && { sed '/^oracle/,$d' rows.dag; cat text; } >ordered.dag
}
moved() { ordered dear.json && grep -q 'start second' ordered.dag && same rows.dag ordered.dag; }
stayed() { ordered fast.json && grep -q 'start first' ordered.dag && same rows.dag ordered.dag; }
check "another order, the same decisions" moved
check "no other order, the same decisions" stayed

refused() { # WHERE_AND_WHAT FILE.json
    ! "$dagc" -Wno-all --emit=none --profile "$2" rows.dag >told 2>&1 && grep -qF -- "$1" told || { cat told; return 1; }
}
sed 's/"rows"/"other"/' dear.json >other.json
sed 's/"node": "third"/"node": "thirst"/' dear.json >node.json
sed 's/"tool": "cheap"/"tool": "dear"/' dear.json >tool.json
sed '0,/"answer": "yes"/s//"answer": "maybe"/' dear.json >answer.json
sed '/"fourth"/,/answers/d' dear.json >fewer.json
sed 's/"calls": 1000/"calls": "many"/' dear.json >many.json
sed 's/"count": 100}/"count": -1}/' dear.json >negative.json
head -n 5 dear.json >cut.json
sed 's/"third"/"second"/' dear.json >twice.json
sed '2s/.*/ "node": 12e,/' dear.json >number.json
sed 's/"calls": 1000/"calls": 1001/' dear.json >sum.json
sed 's/"4": 258/"4": 249/' dear.json >full.json
sed 's/"lists": 8/"lists": 3/' dear.json >lists.json
sed 's/"mean_seconds": 1e-07/"mean_seconds": 1e999/' dear.json >large.json
awk 'BEGIN { for (i = 0; i < 100000; i++) printf "[" }' >deep.json
printf '"\\u00e9\\q"' >escape.json
check "of another oracle" refused 'other.json:1:12: error: this is a profile of oracle other, not of rows' other.json
check "of another graph" refused 'node.json:9:12: error: oracle rows has no node thirst' node.json
check "with another tool" refused 'tool.json:6:30: error: node second of oracle rows asks cheap, here it asked dear' tool.json
check "with another answer" refused 'answer.json:5:59: error: answer yes of node first is not there' answer.json
check "with a node fewer" refused 'error: ' fewer.json
check "with words for numbers" refused 'many.json:3:46: error: "calls" should be a number' many.json
check "with negative counts" refused 'negative.json:5:42: error: "count" should not be negative' negative.json
check "with a node twice" refused 'twice.json:9:12: error: node second a second time' twice.json
check "cut off" refused "cut.json:6:1: error: the file ends where a value" cut.json
check "no number" refused 'number.json:2:10: error: a number should be here' number.json
check "more calls than answers" refused 'sum.json:3:3: error: node first was called 1001 times and answered 1000 times' sum.json
check "more pairs than fit in vectors" refused 'full.json:3:3: error: node first was called 1000 times, and its lists or vectors hold 996 pairs' full.json
check "more pairs than fit in lists" refused 'lists.json:3:3: error: node first was called 1000 times, and its lists or vectors hold 768 pairs' lists.json
check "an infinite number" refused 'large.json:3:68: error: a number below 1.8e308 should be here' large.json
check "too deep" refused 'deep.json:1:65: error: more than 64 lists and objects in each other' deep.json
check "a wrong escape" refused 'escape.json:1:8: error: an escape of JSON should be here' escape.json
check "that is not there" refused 'cannot read none.json' none.json
check "that the output would replace" says 'would replace an input' "$dagc" --profile dear.json -o dear.json rows.dag
check "nor for a proof of what is written" says 'have it written by --emit=text' "$dagc" --prove --profile dear.json rows.dag

# Random graphs of such questions and random profiles: whatever is exchanged, decisions are the same.
cat >random.awk <<'END2'
function pick(n) { return int(rand() * n) }
function target(i) { return pick(3) == 0 ? "d" pick(2) : i + 1 < nodes && pick(4) ? "n" i + 1 : i + 2 < nodes ? "n" i + 1 + pick(nodes - i - 1) : "d0" }
BEGIN {
    srand(seed); nodes = 4 + pick(9)
    print "{\"oracle\": \"r\", \"nodes\": [" >json
    print "oracle r { start n0;" >dag
    for (i = 0; i < nodes; i++) {
        tool = pick(4); share = pick(2) / 4; low = target(i); high = target(i)
        end = pick(2)
        printf "  node n%d = q%d(share = %g) { no -> %s; yes -> %s; }\n", i, tool, share, low, high >dag
        yes = pick(1000); no = pick(1000)
        printf "%s{\"node\": \"n%d\", \"tool\": \"q%d\", \"calls\": %d, \"mean_seconds\": %g, \"answers\": [{\"answer\": \"no\", \"count\": %d}, {\"answer\": \"yes\", \"count\": %d}]}\n", i ? "," : "", i, tool, yes + no, (1 + pick(100)) * 1e-9, no, yes >json
    }
    print "]}" >json; print "}" >dag
}
END2
for i in 0 1 2 3; do
    echo "tool q$i(share : ratio = 0 in [0, 1]) question answers (no precise, yes precise) anywhere \"?\";"
done >questions.dag
printf '%s\n' 'decision d0 "a";' 'decision d1 "b";' >decisions.dag
cat - questions.dag decisions.dag >own.dag <<'END2'
runtime "discussion.h" abi 7;
type ratio = real "";
END2
random_graphs() { # COUNT
    seed=0 exchanged=0
    while [ $seed -lt "$1" ]; do
        seed=$((seed + 1))
        awk -v seed=$seed -v dag=r.dag -v json=r0.json -f random.awk
        # nodes that nothing leads to are in no profile
        "$dagc" -Wno-all --catalog own.dag --dump=check r.dag | sed -n 's/^  node \([^ ]*\) .*/"\1"/p' >reached
        awk 'NR == FNR { at[$1] = 1; next } /"node"/ { split($0, f, "\""); if (!at["\"" f[4] "\""]) next; sub(/^,/, ""); if (any++) $0 = "," $0 } { print }' reached r0.json >r.json
        "$dagc" -Wno-all --catalog own.dag --emit=text --profile r.json r.dag >ordered.dag || { echo "seed $seed"; return 1; }
        "$dagc" diff --catalog own.dag r.dag ordered.dag >differs || { echo "seed $seed"; cat r.dag ordered.dag differs; return 1; }
        "$dagc" -Wno-all --catalog own.dag --dump=waves --profile r.json r.dag >told
        exchanged=$((exchanged + $(grep -c 'now before' told)))
    done
    echo "$exchanged exchanges"
    [ $exchanged -gt $(($1 / 10)) ]
}
graphs=60
[ -z "${SANITIZE-}" ] || graphs=20
[ -z "${THOROUGH-}" ] || graphs=500
check "random graphs decide as before" random_graphs $graphs
sed -n 's/ exchanges/ exchanges in random graphs/p' "$tmp/out"

# Two questions that commute behind 24 others that are asked again further on: what they answered tells 2^24 ways apart.
awk 'function node(name, tool, share, low, high) {
    printf "  node %s = %s(share = %g) { no -> %s; yes -> %s; }\n", name, tool, share, low, high >"many.dag"
    printf "%s{\"node\": \"%s\", \"tool\": \"%s\", \"calls\": 2, \"mean_seconds\": %g, \"answers\": [{\"answer\": \"no\", \"count\": 1}, {\"answer\": \"yes\", \"count\": 1}]}\n",
        any++ ? "," : "", name, tool, name == "dear" ? 1e-6 : 1e-9, "no", "yes" >"many.json"
}
BEGIN {
    print "oracle many { start a0;" >"many.dag"; print "{\"oracle\": \"many\", \"nodes\": [" >"many.json"
    for (i = 0; i < 24; i++)
        node("a" i, "q0", i / 32, i < 23 ? "a" i + 1 : "dear", i < 23 ? "a" i + 1 : "dear")
    node("dear", "q1", 0, "d0", "cheap"); node("cheap", "q2", 0, "d0", "b0")
    for (i = 0; i < 24; i++)
        node("b" i, "q0", i / 32, i < 23 ? "b" i + 1 : "d0", "d1")
    print "}" >"many.dag"; print "]}" >"many.json"
}'
many() { "$dagc" -Wno-all --catalog own.dag "$@" --profile many.json many.dag; }
check "too many ways to compare: no error, it stays, and why" says 'all questions stay as they are: some commute' many --dump=waves
kept() { many --emit=text >ordered.dag && "$dagc" -Wno-all --catalog own.dag --emit=text many.dag | cmp - ordered.dag; }
check "its graph is the one that was measured" kept

# Readers of a term without levels commute, also where one reads it in an argument.
cat >far.dag <<'END2'
runtime "discussion.h" abi 7;
type ratio = real "";
term far : ratio in [0, inf];
tool above(value : ratio, limit : ratio) question answers (no precise, yes precise) anywhere "Above?";
tool away(limit : ratio) question answers (near precise, far precise) reads (far) anywhere "Far?";
decision keep "";
decision drop "";
END2
cat >reads.dag <<'END2'
catalog "far.dag";
oracle reads {
  start above;
  node above = above(value = far, limit = 4) { no -> away; yes -> drop; }
  node away  = away(limit = 3)               { near -> keep; far -> drop; }
}
END2
cat >reads.json <<'END2'
{"oracle": "reads", "nodes": [
 {"node": "above", "tool": "above", "calls": 9, "mean_seconds": 1e-6, "answers": [{"answer": "no", "count": 9}, {"answer": "yes", "count": 0}]},
 {"node": "away", "tool": "away", "calls": 9, "mean_seconds": 1e-9, "answers": [{"answer": "near", "count": 1}, {"answer": "far", "count": 8}]}]}
END2
check "readers of a term without levels" says 'now before above' "$dagc" -Wno-all --dump=waves --profile reads.json reads.dag

# What allows a subdivision stays before it, also where all answers allow it.
cat >guard.dag <<'END2'
runtime "discussion.h" abi 7;
type count = integer "";
tool guard(least : count = 1 in [1, 9]) question answers (one precise, both precise) guards (one | both -> split) by (least) anywhere "Which?";
tool cheap() question answers (no precise, yes precise) anywhere "Costs little.";
decision keep "";
decision split subdivides "";
END2
cat >guarded.dag <<'END2'
catalog "guard.dag";
oracle guarded {
  start a;
  node a = guard() { one -> split; both -> b; }
  node b = cheap() { yes -> split; no -> keep; }
}
END2
cat >guarded.json <<'END2'
{"oracle": "guarded", "nodes": [
 {"node": "a", "tool": "guard", "calls": 9, "mean_seconds": 1e-6, "answers": [{"answer": "one", "count": 1}, {"answer": "both", "count": 8}]},
 {"node": "b", "tool": "cheap", "calls": 8, "mean_seconds": 1e-9, "answers": [{"answer": "no", "count": 1}, {"answer": "yes", "count": 7}]}]}
END2
check "what allows a subdivision stays before it" says 'as it is; subdivisions that guard allows would come behind b alone' \
    "$dagc" --dump=waves --profile guarded.json guarded.dag
sed 's/one -> split; both/one -> keep; both/; s/yes -> split; no -> keep/yes -> keep; no -> split/' guarded.dag >passes.dag
check "but not where only those who pass are split" says 'now before a' "$dagc" --dump=waves --profile guarded.json passes.dag

finish profile
