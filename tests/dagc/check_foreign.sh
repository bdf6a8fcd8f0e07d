#!/bin/sh
# check_foreign.sh - dagc in programs that are not ours: a catalog with its own runtime, in every mode and with every
# compiler there is; headers with all that C allows; the program's own headers beside a standalone text.
# DAGC names the command; a compiler that is missing is reported as skipped.
# Once is enough: it compiles what dagc writes, by every compiler there is.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/lib.sh"

fails() { # STATUS TEXT COMMAND...
    wanted=$1 text=$2
    shift 2
    "$@" >said 2>&1
    got=$?
    [ $got = "$wanted" ] && grep -qF -e "$text" said || { echo "status $got:"; cat said; return 1; }
}

# ---- a packet filter: its catalog, its runtime, its tools
mkdir net net/tools
cat >net/net.dag <<'END'
runtime "net_runtime.h" abi 3;
verb filter;
type bytes = integer "";
type share = real "";
type time  = real "s";
term load : share in [0, inf] levels (guess < measured) header "load.h" "of the queue";
fact packet.size : bytes in [0, 65535] = "d->packet->size" "with its header";
tool kind() question answers (voice precise, bulk precise) "What is in it?";
tool longer(than : bytes in [0, 65535]) question answers (yes precise, no precise) "Is it a long one?";
tool crowded(most : share in [0, inf]) question answers (no approximate, yes approximate) writes (load >= guess) "Is there room?";
decision pass "Let it through.";
decision delay reads (load >= guess) "Later.";
decision drop "Away with it.";
END
# All that half a parser falls over: a type of functions, #undef, a helper called as a field and one as the verb, macros
# that are conditional, functions of the program's own, a file taken in twice.
cat >net/host.h <<'END'
#ifndef HOST_H
#define HOST_H
struct queue;
int queue_length(const struct queue *queue);
double queue_room(const struct queue *queue);
#endif
END
cat >net/net_runtime.h <<'END'
#ifndef NET_RUNTIME_H
#define NET_RUNTIME_H
#define NDEBUG
#include <assert.h>
#include "host.h"
#define RUNTIME_ABI 3
#include "catalog.h"
#define TOOL static inline
typedef int (*compare)(const void *, const void *);
typedef struct {
    int size, order[2];
    unsigned flags : 4;
    compare by;
    double (*weight)(int size);
} packet_type;
typedef enum colour { RED, GREEN = 4, BLUE } colour;
struct discussion {
    const packet_type *packet;
    struct queue *queue;
    int seen;
    struct terms terms;
};
static inline int size(const packet_type *p)
{
    int order = p->size;
    return order;
}
static inline int filter(const struct discussion *d)
{
    return d->seen + size(d->packet);
}
#endif
END
cat >net/load.h <<'END'
#pragma once
#include "net_runtime.h"
TOOL double term_load(struct discussion *d, enum load_level level)
{
    if (d->terms.load_level < level) {
        assert(!"NDEBUG is for assert.h, and keeps its name");
        d->terms.load = queue_length(d->queue) / 8.;
        d->terms.load_level = (unsigned char)level;
    }
    return d->terms.load;
}
END
cat >net/tools/limits.def <<'END'
LIMIT(small, 100)
LIMIT(large, 1000)
END
cat >net/tools/kind.h <<'END'
#ifndef KIND_H
#define KIND_H
#include "net_runtime.h"
#define LIMIT(name, value) LIMIT_NUMBER(value)
#define LIMIT_NUMBER(value) value,
static const int limits[] = {
#include "limits.def"
    -1};
#undef LIMIT
#define LIMIT(name, value) #name,
static const char *const limit_names[] = {
#include "limits.def"
    ""};
#undef LIMIT
#if defined KIND_WITHOUT_VOICE
#define KIND_SMALL 0
#else
#define KIND_SMALL limits[0]
#endif
static int by_size(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}
TOOL enum kind_answer tool_kind(struct discussion *d)
{
    compare how = d->packet->by ? d->packet->by : by_size;
    colour paint = RED;
    (void)limit_names;
    return how(&d->packet->size, &KIND_SMALL) < 0 && paint == RED && filter(d) >= 0 ? KIND_VOICE : KIND_BULK;
}
#endif
END
cat >net/tools/longer.h <<'END'
#ifndef LONGER_H
#define LONGER_H
#include "../net_runtime.h"
#define than_all(x) ((x) > than)
TOOL enum longer_answer tool_longer(struct discussion *d, int than)
{
    return than_all(d->packet->size) ? LONGER_YES : LONGER_NO;
}
#undef than_all
static inline int than_all(int than) { return than; }
#endif
END
cat >net/tools/crowded.h <<'END'
#ifndef CROWDED_H
#define CROWDED_H
#include "load.h"
double queue_room(const struct queue *queue); /* the program's */
TOOL enum crowded_answer tool_crowded(struct discussion *d, double most)
{
    return term_load(d, LOAD_GUESS) > most && queue_room(d->queue) < 1 ? CROWDED_YES : CROWDED_NO;
}
#endif
END
cat >gate.dag <<'END'
oracle gate "voice first" {
  param most : share = 0.5 in [0, inf] "how full it may be";
  start what;
  node what = kind() { voice -> pass; bulk -> long; }
  node long = longer(than = min(1400, packet.size * 2)) { yes -> drop; no -> room; }
  node room = crowded(most = most) { no -> pass; yes -> delay; }
}
END
cat >main.c <<'END'
#include <stdio.h>
#include HEADER
struct queue {
    int length;
};
#ifdef __cplusplus
#define EMPTY {}
#else
#define EMPTY {0}
#endif
int queue_length(const struct queue *queue) { return queue->length; }
double queue_room(const struct queue *queue) { return 1. / (1 + queue->length); }
int main(void)
{
    static const char *const names[] = {"pass", "delay", "drop"};
    static const int sizes[] = {40, 200, 9000};
    struct NAME(gate_parameters) parameters;
    NAME(gate_defaults)(&parameters);
    for (int i = 0; i < 3; i++)
        for (int length = 0; length < 10; length += 9) {
            struct queue queue = {length};
            NAME(packet_type) packet = EMPTY;
            struct NAME(discussion) d = EMPTY;
            packet.size = sizes[i];
            d.packet = &packet;
            d.queue = &queue;
            const char *name = names[NAME(gate_filter)(&parameters, &d)];
            printf("%s %d\n", name, d.terms.load_level == LEVEL);
        }
    return 0;
}
END
printf 'pass 0\npass 0\npass 0\ndelay 1\ndrop 0\ndrop 0\n' >wanted
mkdir made
run="$dagc -Werror --catalog net/net.dag"
check "catalog.h" "$dagc" --emit=catalog-h -o made/catalog.h net/net.dag
check "catalog.c" "$dagc" --emit=catalog-c -o made/catalog.c net/net.dag
check "with a header" $run --instrument --trace -o made/gate.c --header made/gate.h gate.dag
check "without a header" $run -o made/one.c gate.dag
check "standalone" $run --standalone --prefix p -I net -o made/p.c --header made/p.h gate.dag
check "standalone, nothing said of folders" $run --standalone --prefix q -o made/q.c --header made/q.h gate.dag
check "prove" $run --prove --instrument --trace gate.dag
check "two of one catalog" sh -c 'printf "#include \"p.h\"\n#include \"q.h\"\nint main(void) { return P_DECISIONS - Q_DECISIONS; }\n" >both.c'
cp "$top/runtime/oracle.h" "$top/runtime/oracle/tool_table.h" made
check "no word of radiosity" sh -c '! grep -wniE "radiosity|refine[a-z_]*|W/m2|element|emitter|receiver|shaft|pair|host\.area" made/gate.[ch] made/one.c made/[pq].[ch] made/catalog.[ch]'
check "no header of radiosity" sh -c '! gcc -Imade -Inet -M made/gate.c made/catalog.c | grep -E "discussion.h|geometry.h"'
check "a type of functions has the prefix" grep -qF 'typedef int (*p_compare)(const void *, const void *);' made/p.h
check "functions of the program keep their names" grep -q 'double queue_room(const struct queue' made/p.c
warnings="-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror"
[ -n "${THOROUGH-}" ] || set -- "gcc -std=c11" "clang++ -x c++ -std=c++17"
[ -z "${THOROUGH-}" ] || set -- "gcc -std=c11" "clang -std=c11" "tcc" "g++ -x c++ -std=c++17" "clang++ -x c++ -std=c++17"
for compiler; do
    command -v "${compiler%% *}" >/dev/null || { echo "skipped: ${compiler%% *} is not installed"; continue; }
    check "$compiler catalog.c" $compiler $warnings -Imade -Inet -c -o object.o made/catalog.c
    check "$compiler one" $compiler $warnings -Imade -Inet -c -o object.o made/one.c
    check "$compiler gate" $compiler $warnings -Imade -Inet -D'HEADER="gate.h"' -D'NAME(x)=x' -DLEVEL=LOAD_GUESS -o program main.c made/gate.c -lm
    check "$compiler gate runs" sh -c './program | cmp - wanted'
    check "$compiler p" $compiler $warnings -Imade -D'HEADER="p.h"' -D'NAME(x)=p_##x' -DLEVEL=P_LOAD_GUESS -o program main.c made/p.c -lm
    check "$compiler p runs" sh -c './program | cmp - wanted'
    check "$compiler two of one catalog" $compiler $warnings -Imade -o both both.c
done
# For C++ alone: its linkage, by option or by name.
check "--emit=c++" $run --emit=c++ --instrument -o made/cxx.text --header made/cxx.h gate.dag
check ".cpp" $run --standalone --prefix x -o made/x.cpp --header made/x.h gate.dag
check "no other linkage" sh -c '! grep -n "extern \"C\"" made/cxx.text made/cxx.h made/x.cpp made/x.h'
for compiler in "g++ -std=c++17" "clang++ -std=c++17"; do
    command -v "${compiler%% *}" >/dev/null || { echo "skipped: ${compiler%% *} is not installed"; continue; }
    check "$compiler c++" $compiler $warnings -Imade -Inet -x c++ -D'HEADER="cxx.h"' -D'NAME(x)=x' -DLEVEL=LOAD_GUESS -o program main.c made/cxx.text -lm
    check "$compiler c++ runs" sh -c './program | cmp - wanted'
    check "$compiler x" $compiler $warnings -Imade -x c++ -D'HEADER="x.h"' -D'NAME(x)=x_##x' -DLEVEL=X_LOAD_GUESS -o program main.c made/x.cpp -lm
    check "$compiler x runs" sh -c './program | cmp - wanted'
done
# The program's header may stay where it is: then its types are the program's.
sed -i 's/^struct queue;/struct queue { int length; };/' net/host.h
check "--host host.h" $run --standalone --prefix h --host host.h -o made/h.c --header made/h.h gate.dag
check "it is included" grep -q '^#include "host.h"' made/h.h
sed 's/^struct queue {/struct other {/; 1i#include "host.h"' main.c >with_host.c
check "--host compiles" gcc -std=c11 $warnings -Imade -Inet -D'HEADER="h.h"' -D'NAME(x)=h_##x' -DLEVEL=H_LOAD_GUESS -o program with_host.c made/h.c -lm
check "--host runs" sh -c './program | cmp - wanted'
check "--host alone" fails 2 "--host belongs to --standalone" $run --host host.h gate.dag
sed 's/LIMIT_NUMBER(value)$/LIMIT_##value/' net/tools/kind.h >kind.new && mv kind.new net/tools/kind.h
check "names that are joined" fails 1 "kind.h:4: '##' makes names" $run --standalone -o x.c --header x.h gate.dag
echo '#include "round.h"' >net/round.h && sed 's/#include "host.h"/#include "round.h"/' net/net_runtime.h >new.h && mv new.h net/net_runtime.h
check "a header that includes itself" fails 1 "round.h includes itself" $run --standalone -o x.c --header x.h gate.dag
rm net/tools/longer.h
check "no header of a tool" fails 1 'net.dag:9:6: error: no header "tools/longer.h"' $run --standalone -o x.c --header x.h gate.dag

# ---- a skeleton of the whole: it compiles, runs, and stays where somebody has written
for what in "stub c net/net.dag pass" "stub-c++ cpp net/net.dag pass" "stub c $top/tests/dagc/test_catalog.dag keep" "stub-c++ cpp $top/runtime/catalog.dag link"; do
    # shellcheck disable=SC2086
    set -- $what
    rm -rf skeleton
    check "$what: made" "$dagc" --emit="$1" -o skeleton/of "$3"
    check "$what: compiles" make -s -C skeleton/of DAGC="$dagc" CFLAGS="-O0 $warnings" CXXFLAGS="-O0 $warnings"
    check "$what: decides" sh -c "[ \"\$(skeleton/of/first)\" = $4 ]"
    check "$what: has its program" [ -f "skeleton/of/main.$2" ]
done
echo '/* mine */' >>skeleton/of/main.cpp
rm skeleton/of/tools/transfer.h
check "once more" "$dagc" --emit=stub-c++ -o skeleton/of "$top/runtime/catalog.dag"
check "what was there stays" grep -q mine skeleton/of/main.cpp
check "what was missing is made" [ -f skeleton/of/tools/transfer.h ]
check "no folder" fails 1 "cannot make the folder of" "$dagc" --emit=stub -o net/net.dag/x net/net.dag
printf 'decision stop;\nruntime "x.h" abi 1;\n' >empty.dag
check "a catalog without tools" fails 1 "declares no tool" "$dagc" --emit=stub -o none empty.dag
check "and nothing is made" [ ! -e none ]
check "not of a tool" fails 2 "takes a catalog, not" "$dagc" --emit=stub-c++ weigh

# ---- examples/poisson: an adaptive mesh, whose cells are 40 times as well placed as those of an even one
set -- "tcc" "g++ -x c++"
[ -z "${THOROUGH-}" ] || set -- "gcc -std=c11" "clang -std=c11" "tcc" "g++ -x c++" "clang++ -x c++"
for compiler; do
    command -v "${compiler%% *}" >/dev/null || { echo "skipped: ${compiler%% *} is not installed"; continue; }
    rm -rf poisson && mkdir poisson
    check "$compiler poisson" make -s -C "$top/examples/poisson" OUT="$tmp/poisson" DAGC="$dagc" CC="$compiler" CFLAGS="-O1 $warnings"
    check "$compiler poisson runs" sh -c 'poisson/poisson poisson/mesh.svg >poisson/said'
    check "$compiler poisson adapts" awk '/^adapted/ { cells = $2; error = $6 } /^even/ { exit !(cells < $2 && 20 * error < $6) }' poisson/said
    # Every node: answers are as many as calls, and what leaves one arrives at the next; the first is asked for every cell.
    check "$compiler poisson counts" awk '$1 == "node" { on = 1; next } on { calls[$1] = $2; for (i = 4; i < NF; i += 2) { told += $(i + 1); of[$1, $i] = $(i + 1) } sum += $2; nodes++ }
        END { exit !(nodes == 4 && sum == told && calls["large"] == of["small", "yes"] && calls["even"] == of["large", "no"] && calls["bent"] == of["even", "yes"] && of["bent", "yes"] > 0) }' poisson/said
    check "$compiler poisson draws" sh -c '[ "$(grep -c "<path" poisson/mesh.svg)" = "$(awk "/^adapted/ { print \$2 }" poisson/said)" ]'
done
check "nothing of radiosity" sh -c '! grep -wniE "radiosity|W/m2|element|emitter|receiver|shaft" poisson/refine.[ch]'
check "prove poisson" "$dagc" --prove "$top/examples/poisson/refine.dag"
grep -o 'M[^"]*' "$top/examples/poisson/mesh.svg" | sort >had
grep -o 'M[^"]*' poisson/mesh.svg | sort >have
check "the picture is of this mesh" cmp had have

# ---- the verb
verb() { sed "s/^verb .*/$1/" net/net.dag >verb.dag; }
verb 'verb while;' && check "a keyword may be a verb: gate_while" "$dagc" --catalog verb.dag --emit=none gate.dag
verb 'verb defaults;' && check "a verb that is taken" fails 1 "another NAME_defaults already" "$dagc" --catalog verb.dag --emit=none gate.dag
verb 'verb a; verb b;' && check "two verbs" fails 1 "a second verb" "$dagc" --catalog verb.dag --emit=none gate.dag
verb 'verb;' && check "no verb" fails 1 "a name such as 'decide'" "$dagc" --catalog verb.dag --emit=none gate.dag
verb '' && check "without: refine" sh -c "$dagc --catalog verb.dag gate.dag | grep -q gate_refine"

finish "foreign"
