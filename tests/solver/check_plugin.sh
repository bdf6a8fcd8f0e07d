#!/bin/sh
# check_plugin.sh - `--plugin`: C functions behind an oracle's externs, from a C file or a shared object. Both releases
# decide the same with them, and what is wrong with one is said. RADIOSITY names the command.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"
headers="-I$top/runtime -I$(dirname "$radiosity")/../gen"
scene=$top/examples/scenes/cornell.obj
cp "$top"/examples/plugin/desk.* .
sed -i "s|import \"../oracles|import \"$top/examples/oracles|" desk.dag

# NAME OPTION...: NAME.json and NAME.csv, by links alone
solve() {
    name=$1
    shift
    count=$((count + 1))
    "$radiosity" solve "$scene" -q --no-correct --no-errors --oracle desk.dag --set relative=0.3 --json "$name.json" --faces "$name.csv" "$@" \
        2>err || failed "solve $*"
}
links() { sed -n 's/.*"links": *\([0-9]*\).*/\1/p' "$1.json"; }
same() { [ -n "$(links "$1")" ] && [ "$(links "$1")" = "$(links "$2")" ] && cmp -s "$1.csv" "$2.csv" || failed "$1 and $2 differ"; }
# STATUS TEXT COMMAND...: ends with this status, and says this text on standard error
says() {
    wanted=$1 text=$2
    shift 2
    count=$((count + 1))
    "$@" >out 2>err
    status=$?
    [ $status = "$wanted" ] && grep -qF -- "$text" err || failed "$*: exit $status, not $wanted with: $text"
}

# ---- a C file and a shared object, interpreted and compiled, one thread and two
# shellcheck disable=SC2086 # words
cc -shared -fPIC -O2 -ffp-contract=off $headers -o desk.so desk.c || failed "desk.so"
solve flat --plugin desk.c
solve dag --plugin desk.c --release dag
solve object --plugin desk.so --threads 1
solve object_dag --plugin ./desk.so --release dag --threads 2
same flat dag
same flat object
same flat object_dag
count=$((count + 1))
"$radiosity" compare "$scene" -q --oracle desk.dag --set relative=0.3 --plugin desk.c --repeats 1 --json compare.json >out 2>err || failed "compare"

# ---- the function is what decides: another one makes other links, and of two the last one counts
printf '#include "discussion.h"\ndouble remoteness(const struct discussion *d) { (void)d; return 1; }\n' >near.c
solve near --plugin near.c
[ "$(links near)" -gt "$(links flat)" ] || failed "as many links near the desk as far from it"
solve near_last --plugin desk.c --plugin near.c --release dag
same near near_last

# ---- what an extern reads is there when it is called
cat >reads.dag <<END
import "$top/examples/oracles/common.dag";
extern carried(form_factor >= disc, visibility >= rays_4) : ratio in [0, 1] "of what leaves the emitter";
oracle reads {
  start pair;
  node pair  = surfaces() { toward | receiver_crosses | emitter_crosses -> much; }
  node much  = above(value = carried, limit = 0.02) { no -> last;  yes -> split; }
  node split = either(min_area = 0, min_share = 0.001) { whole -> last; }
  node last  = seen_and_linked(rays = 16) { hidden -> stop; }
}
END
cat >reads.c <<'END'
#include "discussion.h"
double carried(const struct discussion *d)
{
    if (d->terms.form_factor_level < FORM_FACTOR_DISC || d->terms.visibility_level < VISIBILITY_RAYS_4)
        return -1; /* the run ends with an error */
    double share = d->terms.form_factor * d->terms.visibility;
    return share < 1 ? share : 1;
}
END
for release in flat dag; do
    count=$((count + 1))
    "$radiosity" solve "$scene" -q --no-correct --no-errors --oracle reads.dag --plugin reads.c --release $release --json $release.json \
        --faces $release.csv 2>err || failed "reads.dag, $release"
done
same flat dag

# ---- what is no number, or out of the range that its declaration gives
echo '#include "discussion.h"' >nan.c
echo 'double remoteness(const struct discussion *d) { return d->receiver->area > 0.3 ? 2 : 0 * INFINITY; }' >>nan.c
for release in flat dag; do
    says 1 "'relative' of node 'energy' is no number from 0 to inf: relative * extern remoteness" \
        "$radiosity" solve "$scene" -q --no-correct --no-errors --oracle desk.dag --plugin nan.c --release $release
done

# ---- every command that asks an oracle
"$radiosity" explain "$scene" --oracle desk.dag --plugin desk.c --at 0.1,0.1,0:0.27,0.5,0.27 -q >out 2>err || failed explain
for command in draw panel; do
    count=$((count + 1))
    "$radiosity" $command desk.dag --plugin desk.c -o $command.$([ $command = draw ] && echo svg || echo html) 2>err || grep -qi graphviz err || failed $command
done
for command in solve compare explain tune draw panel "study clustering" "study form-factors" "study causes" "study greedy"; do
    count=$((count + 1))
    # shellcheck disable=SC2086
    "$radiosity" $command --help=all | grep -q -- "--plugin FILE.c|FILE.so" || failed "$command --help"
done

# ---- what is wrong
for release in flat dag; do
    says 1 "desk.dag:8:8: error: nothing defines the extern 'remoteness', which the oracle reads" \
        "$radiosity" solve "$scene" -q --oracle desk.dag --release $release
    grep -qF "note: define in C: double remoteness(const struct discussion *d); radiosity takes the file by --plugin" err || failed "no signature"
done
echo 'int other;' >other.c
says 1 "nothing defines the extern 'remoteness'" "$radiosity" solve "$scene" -q --oracle desk.dag --plugin other.c
says 1 "none.so: error: cannot read the plugin: No such file" "$radiosity" solve "$scene" -q --plugin none.so
says 1 ".: error: cannot read the plugin: Is a directory" "$radiosity" solve "$scene" -q --plugin .
says 1 "desk.dag: error: no shared object that can be loaded" "$radiosity" solve "$scene" -q --plugin desk.dag
echo 'int x = ;' >wrong.c
says 1 "wrong.c: error: the C compiler '${CC:-cc}' failed; mend what it names" "$radiosity" solve "$scene" -q --plugin wrong.c
grep -q "wrong.c:1:9: error" err || failed "the compiler's own words"
cc -shared -fPIC -o other.so other.c
says 1 "other.so: error: the plugin does not say which headers it was compiled against; write \`const int radiosity_plugin_abi" \
    "$radiosity" solve "$scene" -q --plugin other.so
echo 'const int radiosity_plugin_abi = 3;' >stale.c
cc -shared -fPIC -o stale.so stale.c
says 1 "stale.so: error: the plugin was compiled against ABI 3, not" "$radiosity" solve "$scene" -q --plugin stale.so
echo 'int nowhere(void); int f(void) { return nowhere(); }' >undefined.c
cc -shared -fPIC -o undefined.so undefined.c
says 1 "undefined symbol: nowhere" "$radiosity" solve "$scene" -q --plugin undefined.so
says 2 "--plugin takes" "$radiosity" solve "$scene" --plugin ""

finish plugin
