#!/bin/sh
# check_compare.sh - radiosity compare where releases differ: a C compiler that changes one arc of the flat release stands
# for an emitter that errs. It stops there, tells where, and times nothing. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

compare() { # CHANGE THREADS: of bf's flat release, on the room; the status is kept
    printf '#!/bin/sh\nfor f; do case $f in *oracles.c) sed -i "%s" $f;; esac; done\nexec cc "$@" -O0\n' "$1" >cc && chmod +x cc
    CC=$tmp/cc "$radiosity" compare "$top/examples/scenes/cornell.obj" --oracle "$top/examples/oracles/bf.dag" \
        --set min_share=1e-2 --repeats 1 --threads "$2" --json out.json >out 2>err
    status=$?
}

compare '/LARGER_RECEIVER:/,/LARGER_EMITTER:/s/RECEIVER;/BOTH;/' 2
check "the status" [ $status = 1 ]
check "it tells how many, and of which elements" grep -q '^different: [1-9][0-9]* of the first [0-9]* discussions; of receiver [0-9/b]*, emitter [0-9/b]*$' out
check "what the graph decides" grep -q '^  dag  subdivide_receiver$' out
check "what the other one does" grep -q '^  flat subdivide_both$' out
check "the node and its answer" grep -q '^  node split__side = larger: receiver -> subdivide_receiver$' out
check "the way there" grep -q '^  node energy = transfer: above -> split__guard$' out
check "nothing is timed" sh -c '! grep -q " s  " out && ! grep -q seconds out.json'
check "the same in JSON" sh -c 'grep -q "\"identical\": false" out.json && grep -q "\"node\": \"split__side\"" out.json && grep -q "\"flat\": \"subdivide_both\"" out.json'
check "no other error" [ ! -s err ]
cp out two
compare '/LARGER_RECEIVER:/,/LARGER_EMITTER:/s/RECEIVER;/BOTH;/' 1
check "the same by one thread" cmp out two
compare 's/discussion->terms.visibility = /&0.5 * /' 2
check "a link of other visibility" sh -c "[ $status = 1 ] && grep -q '^  dag  link, F = .*, V = 0[.]4131' out && grep -q '^  flat link, F = .*, V = 0[.]20655' out && grep -q 'node seen__form = form_factor: done -> link' out"
compare 's/decides\[\] = {DECISION_SUBDIVIDE_RECEIVER, DECISION_SUBDIVIDE_EMITTER}/decides[] = {DECISION_SUBDIVIDE_BOTH, DECISION_SUBDIVIDE_EMITTER}/' 2
check "waves that differ" sh -c "[ $status = 1 ] && grep -q '^  flat subdivide_receiver$' out && grep -q '^  wave subdivide_both$' out"
compare 's/nothing/to change/' 2
check "no difference" sh -c "[ $status = 0 ] && grep -q '^identical: ' out && grep -q '^  flat .* s  ' out && grep -q '^  wave .* s  ' out"
# What the oracle reads, all releases read: a white cube, where links whose bends make up for each other are not split
"$radiosity" compare "$scenes/furnace.obj" --oracle power --repeats 1 >out 2>err
check "power, which reads bends: exit status $?" grep -q '^identical: .* 30 links$' out
for release in flat dag hand wave; do
    "$radiosity" solve "$scenes/furnace.obj" --oracle power --release $release --no-correct -q --json one.json
    check "power by $release" [ "$(sed -n 's/^  "links": \([0-9]*\),/\1/p' one.json)" = 30 ]
done
finish compare
