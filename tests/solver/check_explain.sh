#!/bin/bash
# check_explain.sh - watching an oracle: what `solve --trace` tells of a refinement against what the same solve counts by
# other means (statistics of the interpreter, rays of Embree's side), `explain` against the trace, --where against awk,
# --replace against files edited by hand, and what is said of mistakes. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
export OMP_WAIT_POLICY=passive LC_ALL=C
# STATUS TEXT ARGUMENT...: ends with this status, says this text, and leaves no file
says() {
    wanted=$1 text=$2
    shift 2
    count=$((count + 1))
    "$radiosity" "$@" >out 2>err
    status=$?
    if [ $status != "$wanted" ] || ! grep -qF -- "$text" err || [ -s out ] || [ -e x.csv ] || [ "$(wc -l <err)" -gt 12 ]; then
        failed "radiosity $*: exit $status, not $wanted with: $text"
        rm -f x.csv
    fi
}
solve() { "$radiosity" solve "$@" --no-errors --no-correct -q >out 2>err; }
field() { sed -n "s/^ *\"$1\": \"\{0,1\}\([^\",]*\)\"\{0,1\},\{0,1\}$/\1/p" "$2" | head -n 1; } # NAME FILE

room=$scenes/room.obj small=$scenes/furnace.obj
coarse=(--set energy=3e-3 --set bend=1e-3 --set shadow=3e-3 --set noise=1e-3 --set spot=3e-5 --set product=3e-3)

# ---- a trace has each discussion once, whatever the threads
solve "$room" "${coarse[@]}" --trace all.csv --json s.json --threads 2
solve "$room" "${coarse[@]}" --trace one.csv --threads 1
solve "$room" "${coarse[@]}" --statistics s.csv
check "a trace depends on threads" cmp -s all.csv one.csv
lines=$(($(wc -l <all.csv) - 1))
check "a trace of $lines lines is too short to judge by" [ $lines -gt 8000 ]
check "lines are not the discussions of the summary" [ $lines = "$(field pairs s.json)" ]
check "rays are not those of the summary" alike "$(awk -F, 'NR > 1 { s += $6 } END { print s }' all.csv)" "$(field rays s.json)"
check "pass 1 does not begin with the root" [ "$(sed -n 2p all.csv | cut -d, -f1-4)" = 1,1,root,root ]
# Answers by node, told by another walk: node,answer,count.
awk -F, '$1 == "answer" && $2 == 0 && $8 { print $3 "," $5 "," $8 }' s.csv | sort >counted
awk -F, 'NR > 1 { n = split($9, step, " "); for (i = 1; i <= n; i++) { sub(":", ",", step[i]); c[step[i]]++ } }
         END { for (k in c) print k "," c[k] }' all.csv | sort >traced
check "ways do not sum to the statistics" cmp -s counted traced
# Decisions are the targets that are no nodes.
awk -F, '$1 == "answer" && $2 == 0 { node[$3] = 1; c[$7] += $8 } END { for (k in c) if (!(k in node) && c[k]) print k, c[k] }' s.csv | sort >counted
awk -F, 'NR > 1 { c[$5]++ } END { for (k in c) print k, c[k] }' all.csv | sort >traced
check "decisions do not sum to the statistics" cmp -s counted traced

# ---- --where picks what awk picks
where() { # CONDITION AWK
    solve "$room" "${coarse[@]}" --trace some.csv --where "$1"
    { head -n 1 all.csv; awk -F, "NR > 1 && ($2)" all.csv; } >wanted
    check "--where $1: $(($(wc -l <some.csv) - 1)) lines, not $(($(wc -l <wanted) - 1))" cmp -s some.csv wanted
    check "--where $1 picks nothing" [ "$(wc -l <wanted)" -gt 1 ]
}
where 'decision == subdivide_receiver && rays > 4' '$5 == "subdivide_receiver" && $6 > 4'
where '(pass == 2 || round < 6) && !(decision != link)' '($1 == 2 || $2 < 6) && $5 == "link"'
where 'pair__four == partial || level == apart' '" " $9 " " ~ / (pair__four:partial|level:apart) /'
where 'visibility * 2 - 1 >= 0 && form_factor < 0.01 / 4' '$8 != "" && $7 != "" && $8 * 2 - 1 >= 0 && $7 < 0.0025'
where 'receiver == "0/2" || emitter.face == 3' '$3 == "0/2" || $4 ~ /^3(\/|$)/'
solve "$room" "${coarse[@]}" --trace some.jsonl --where 'rays > 16'
check "JSON lines" [ "$(grep -c '^{"pass": [0-9].*"way": \[\["level", "[a-z]*"\].*\]\]}$' some.jsonl)" = "$(awk -F, 'NR > 1 && $6 > 16' all.csv | wc -l)" ]

# ---- explain shows the discussion that the trace has
agree() { # PASS RECEIVER EMITTER: explained, it is the trace's last line of this pair in this pass
    line=$(awk -F, -v p="$1" -v r="$2" -v e="$3" '$1 == p && $3 == r && $4 == e' all.csv | tail -n 1)
    "$radiosity" explain "$room" "${coarse[@]}" --pair "$2,$3" --pass "$1" --json x.json -q >out 2>err
    shown=$(awk -F'"' '/"history"/ { past = 1 } /"discussion"/ { now = 1 }
        /^  "pass": / { pass = $3 } /^  "round": / { round = $3 }
        now && $2 == "node" { node = $4 } now && $2 == "answer" { way = way " " node ":" $4 }
        now && $2 == "decision" { decision = $4 } now && /^    "rays": / { rays = $3 }
        END { gsub(/[^0-9]/, "", pass); gsub(/[^0-9]/, "", round); gsub(/[^0-9]/, "", rays)
              print pass "," round "," decision "," rays "," substr(way, 2) }' x.json)
    wanted=$(echo "$line" | cut -d, -f1,2,5,6,9)
    check "explain $2,$3 in pass $1: $shown, not $wanted" [ -n "$line" -a "$shown" = "$wanted" ]
    if [ -n "$(echo "$line" | cut -d, -f8)" ]; then
        value=$(awk '/^    "terms"/ { now = 1 } now && /"term": "visibility"/ { getline; gsub(/.*: |,/, ""); print; exit }' x.json)
        check "explain $2,$3: visibility $value" awk -v a="$value" -v b="$(echo "$line" | cut -d, -f8)" 'BEGIN { exit !(a - b <= 1e-8 && b - a <= 1e-8) }'
    fi
    rm -f x.json
}
# The line with the most nodes of each decision, one of pass 2, one of groups.
for pick in '$5 == "link" && $6 == 0' '$5 == "subdivide_receiver"' '$5 == "subdivide_emitter" && $6 > 0' '$5 == "stop" && $6 > 0' '$5 == "link_clusters" && $6 > 0' '$1 == 2 && $6 > 0'; do
    # shellcheck disable=SC2046 # three words
    agree $(awk -F, "NR > 1 && ($pick) && length(\$9) > most { most = length(\$9); best = \$1 \" \" \$3 \" \" \$4 } END { print best }" all.csv)
done
# The second way round of a pair begins with what the first has found.
# shellcheck disable=SC2046 # three words
agree $(awk -F, 'NR > 1 { if (!best && $5 == "link" && was == "link" && $3 == from && $4 == to && $6 == 0 && rays > 0) best = $1 " " $3 " " $4
                          was = $5; from = $4; to = $3; rays = $6 } END { print best }' all.csv)

# By points at the centres of a linked pair of surfaces: the same pair.
pair=$(awk -F, '$5 == "link" && $3 ~ /^[0-9]+\// && $4 ~ /^[0-9]+\//' all.csv | tail -n 1 | cut -d, -f3,4)
"$radiosity" explain "$room" "${coarse[@]}" --pair "$pair" --json x.json -q
points=$(awk '/"centre": \[/ { for (k = 0; k < 3; k++) { getline; gsub(/[ ,]/, ""); c = c (k ? "," : "") $0 } c = c ":" } END { print substr(c, 1, length(c) - 1) }' x.json)
"$radiosity" explain "$room" "${coarse[@]}" --at "$points" --json y.json -q
names() { sed -n 's/^    "name": "\(.*\)",/\1/p' "$1" | paste -sd, -; }
check "--at $points: $(names y.json), not $pair" [ "$(names y.json)" = "$pair" ]
# A point that is on no face stands for the nearest, and how far that is is told.
"$radiosity" explain "$scenes/furnace.obj" --at .5,.5,-7:.5,.5,1 >out
check "how far points are" [ "$(grep -c '^  receiver .*, 7 m from the point$' out) $(grep -c '^  emitter .*, 0 m from the point$' out)" = "1 1" ]
check "a linked pair has one link" grep -q '"links": 1$' x.json

# A pair below a link was never discussed, and is discussed all the same.
"$radiosity" explain "$room" "${coarse[@]}" --pair 3,0/0 >out
check "never discussed" grep -q '^never discussed; as it would be now, after [0-9]* solves*:$' out
check "no decision" grep -q '^  => ' out

# ---- --replace does what an edit of the file does
sed 's/node four  *= visibility(rays = 4,/node four = visibility(rays = 64,/' "$oracles/power.dag" >edited.dag
cp "$oracles/common.dag" .
solve "$room" "${coarse[@]}" --oracle edited.dag --trace edited.csv
solve "$room" "${coarse[@]}" --replace 'pair__four = visibility(rays = 64, near = 64)' --trace replaced.csv
check "a tool replaced is not a tool edited" cmp -s edited.csv replaced.csv
check "a tool replaced changes nothing" [ "$(cmp all.csv replaced.csv 2>&1)" ]
solve "$room" "${coarse[@]}" --oracle power --replace 'pair__four = visibility(rays = 64, near = 64)' --replace 'pair__four = visibility(rays = 4, near = 64)' --trace replaced.csv
check "replaced back" cmp -s all.csv replaced.csv
# A fixed answer: `shaded` leads below, so nothing asks it.
sed 's/partial -> shaded;  all -> few_clear/partial -> few_halved;  all -> few_clear/' "$oracles/power.dag" >edited.dag
solve "$room" "${coarse[@]}" --oracle edited.dag --trace edited.csv
solve "$room" "${coarse[@]}" --replace pair__shaded=below --trace replaced.csv
check "an answer fixed is not an arc edited" cmp -s edited.csv replaced.csv
check "the node is asked still" [ "$(grep -c pair__shaded: replaced.csv)" = 0 -a "$(grep -c pair__shaded: all.csv)" -gt 0 ]
# The start, and rules of its own.
solve "$room" "${coarse[@]}" --replace 'many=self() { itself -> open; otherwise -> stop; }' --trace replaced.csv
check "rules of a replacement" [ "$(awk -F, 'NR > 1 && $9 ~ /many:other/ && $5 != "stop"' replaced.csv | wc -l)" = 0 ]
# The compiled release of the same replacement decides alike.
"$radiosity" compare "$scenes/furnace.obj" --oracle bf --repeats 1 --replace 'split__side = longer()' >out 2>err
check "compare --replace" grep -q '^identical:' out
check "a release by hand has no nodes to replace" [ "$(grep -c hand out)" = 0 ]

# ---- by hand
printf 'where\nnext\n\nterms\nset energy=1\nagain\nset energy=1e-3\nagain\nreplace pair__much=below\nall\nwhere\n' |
    "$radiosity" explain "$room" "${coarse[@]}" --pair 0,3 --pass 1 --step >out 2>err
check "--step says something else than no mistake" [ ! -s err ]
check "--step holds another discussion" [ "$(grep -c 'another way' out)" = 0 ]
check "--step asks two nodes" [ "$(grep -c '^  [12]  ' out)" -ge 2 ]
check "a parameter that changes nothing" [ "$(sed -n 's/^again: //p' out | sort -u | wc -l)" = 2 ]
check "a node that was replaced is asked" [ "$(grep -c 'pair__much asks' out)" = 0 ]
printf 'nix\nset nope=1\npair 7\npair 0,1\nreplace x=y\nwhere now\nq\nnext\n' | "$radiosity" explain "$room" "${coarse[@]}" --pair 0,3 --pass 1 --step >out 2>err
status=$?
check "mistakes by hand end with $status" [ $status = 1 ]
for text in "there is no command 'nix'" "no parameter 'nope'" "'7' is no pair" "polygon 1 became 4 faces; write 1.0 to 1.3" "there is no node 'x'" "takes nothing, not 'now'"; do
    check "by hand: $text" grep -qF "$text" err
done

# A parameter that its author fixed is as it was when a node is replaced, and a mistake that follows is told as what it is. Of
# arguments that may have any unit the one that they have is told.
cat >fixed.dag <<'END'
oracle fixed_one {
  param relative : ratio = 0.1 in [0, inf] role link_threshold;
  fixed param share : ratio = 1e-3 in [0, 1];
  start pair;
  node pair  = clusters() { apart -> stop; receiver -> subdivide_receiver; emitter -> subdivide_emitter; surfaces -> small; }
  node small = above(value = emitter.radius, limit = receiver.radius / 10) { yes -> guard; no -> seen; }
  node guard = can_split(min_share = share) { emitter | both -> bright; otherwise -> seen; }
  node bright = transfer(relative = relative) { above -> subdivide_emitter; otherwise -> seen; }
  node seen  = visibility(rays = 4) { none -> stop; otherwise -> form; }
  node form  = form_factor() { done -> link; }
}
END
printf 'all\nreplace bright=below\nreplace nope=below\n' | "$radiosity" explain "$small" --oracle fixed.dag --pair 0,3 --step >out 2>err
check "by hand: a node that is not there, behind a fixed parameter" grep -qF "there is no node 'nope'" err
check "by hand: the fixed parameter is no mistake" [ "$(grep -c 'fixed by' err)" = 0 ]
check "the unit of what may have any" grep -q '^ *limit = [0-9.]* m, computed' out
check "no unit is ?" [ "$(grep -c ' ?' out)" = 0 ]

# ---- mistakes
says 2 "which pair? --pair RECEIVER,EMITTER or --at X,Y,Z:X,Y,Z" explain "$small"
says 2 "give one" explain "$small" --pair 0,3 --at 0,0,0:1,1,1
for value in 0 , 0, ,3 0,1,2; do says 2 "write RECEIVER,EMITTER" explain "$small" --pair "$value"; done
for value in 0/x,3 3,0//1 0/,3; do says 2 "names no element" explain "$small" --pair "$value"; done
says 1 "'foo' names no element" explain "$small" --pair foo,3
says 1 "numbered from 0 to 184" explain "$room" --pair 0,185
says 1 "polygon 1 became 4 faces; write 1.0 to 1.3" explain "$room" --pair 0,1
says 1 "polygon 12 is one face" explain "$room" --pair 12.1,0
says 1 "polygon 12 is one face" explain "$room" --pair 12.4294967295,0
says 1 "polygon 0 has one side" explain "$room" --pair 0b,3
says 1 "the parts of 0 are numbered from 0 to 3" explain "$room" "${coarse[@]}" --pair 0/4,3
says 1 "has not been split" explain "$room" "${coarse[@]}" --pair 0/0/0/0/0/0/0/0/0,3
for value in 1,2,3 1,2,3:4,5 1,2,3:4,5,x 1,2,3:4,5,inf 1,2,3:4,5,6:; do says 2 "is not two points" explain "$small" --at "$value"; done
says 1 "nothing was said of this pair in pass 99" explain "$room" "${coarse[@]}" --pair 0,3 --pass 99
for value in 0 -1 1001 x; do says 2 "--pass takes a whole number" explain "$small" --pair 0,3 --pass "$value"; done
says 1 "there is no node 'nix'" explain "$small" --pair 0,1 --replace nix=stop
says 1 "its answers are: none, partial, all" explain "$small" --pair 0,1 --replace pair__four=nix
says 1 "unknown tool 'nix'" explain "$small" --pair 0,1 --replace 'pair__four=nix()'
says 1 "says nothing about the answers receiver | emitter" explain "$small" --pair 0,1 --replace 'pair__four=larger()'
says 1 "--replace:1:11: error: expected '='" explain "$small" --pair 0,1 --replace pair__four
says 1 "has no parameter 'ray'" explain "$small" --pair 0,1 --replace 'pair__four=visibility(ray=4)'
says 1 "a graph starts with a node" solve "$small" --replace pair__cut_receiver__guard=both
says 2 "--replace is of a graph" solve "$small" --oracle bf --release hand --replace a=b
says 2 "--where picks lines of a trace" solve "$small" --where 'rays > 1'
for option in --statistics=s.txt --accuracy=1%; do says 2 "it does not go with" solve "$small" --trace x.csv $option; done
says 2 "it takes no --release but dag" solve "$small" --trace x.csv --release flat
says 1 "make the folder first" solve none.obj --trace nowhere/x.csv
condition() { says 2 "--where: error: column $1" solve "$small" --trace x.csv --where "$2"; }
condition "13: decision is never 'stopp'; it is one of link, stop," 'decision == stopp'
condition "8: a value is missing at the end" 'depth >'
condition "7: '=' is no comparison; write ==" 'depth = 3'
condition "1: there is no 'foo'; there are pass, round" 'foo > 3'
condition "11: a ')' is missing" '(depth > 3'
condition "10: '>' compares numbers; words and texts" 'decision > link'
condition "1: a comparison is wanted here" 'depth'
condition "15: pair__four is never 'maybe'; it is one of none, partial, all" 'pair__four == maybe'
condition "11: 'depth' is not understood" 'depth > 3 depth'
condition "13: the text has no end" 'receiver == "12'
condition "8: '2x' is no number" 'rays > 2x'
condition "5: + takes numbers" '1 + "a" == 2'
deep=$(printf '%0100d' 0 | tr 0 '(')
says 2 "parentheses in each other" solve "$small" --trace x.csv --where "$deep"

finish explain
