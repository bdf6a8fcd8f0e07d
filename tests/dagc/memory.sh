#!/bin/sh
# memory.sh DAGC - memory that runs out, at every place where dagc asks for some, in every mode: the first
# allocation fails, then only the second, and so on until there is none left to fail. Each time dagc
# must say so in one line, exit with its status for trouble, and leave the old output files as they were;
# or, where it can do without that memory, write exactly what it writes otherwise.
# SPDX-License-Identifier: MIT
# shellcheck disable=SC2086 # $mode is words
dagc=$(realpath "$1")
here=$(realpath "$(dirname "$0")")
tmp=$(mktemp -d) || exit 2
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 2
export TMPDIR="$tmp/work"
mkdir work bin lib

# Only dagc itself is short of memory, not the programs that it runs.
cat >malloc.c <<'END_OF_C'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
static void *(*real_malloc)(size_t), *(*real_calloc)(size_t, size_t), *(*real_realloc)(void *, size_t);
static long left = -1;
__attribute__((constructor)) static void begin(void)
{
    const char *at = getenv("FAIL_AT");
    *(void **)&real_malloc = dlsym(RTLD_NEXT, "malloc");
    *(void **)&real_realloc = dlsym(RTLD_NEXT, "realloc");
    *(void **)&real_calloc = dlsym(RTLD_NEXT, "calloc");
    if (at != NULL && strcmp(program_invocation_short_name, "dagc") == 0)
        left = atol(at);
}
static int fails(void)
{
    if (left < 0 || left-- != 0)
        return 0;
    int mark = open(getenv("FAIL_MARK"), O_WRONLY);
    if (write(mark, "x", 1) != 1)
        abort();
    close(mark);
    errno = ENOMEM;
    return 1;
}
void *malloc(size_t size)
{
    if (real_malloc == NULL)
        begin();
    return fails() ? NULL : real_malloc(size);
}
void *realloc(void *old, size_t size)
{
    if (real_realloc == NULL)
        begin();
    return fails() ? NULL : real_realloc(old, size);
}
void *calloc(size_t count, size_t size)
{
    if (real_calloc == NULL) /* dlsym asks before there is an answer: it can do without */
        return NULL;
    return fails() ? NULL : real_calloc(count, size);
}
END_OF_C
if ! cc -shared -fPIC -o malloc.so malloc.c || [ "$(LD_PRELOAD=$tmp/malloc.so "$dagc" --version 2>&1)" != "$("$dagc" --version)" ]; then
    echo "memory: skipped, this dagc cannot be given another malloc"
    exit 0
fi

cp "$here"/analysis_catalog.dag "$here"/test_catalog.dag "$here"/emit_branch.dag "$here"/emit_c.dag "$here"/warn_twin_answers.dag "$here"/cycle.dag .
cp -r "$here/runtime" "$here/library" .
printf 'import "library/branches.dag"; import "idle.dag";\n' >imports.dag
sed 's/^import.*//; /^# exit/,$d' "$here/warn_unused_import.dag" >>imports.dag
cat >one.dag <<'END'
oracle one {
  param most : flux = 1 in [0, inf];
  start a;
  node a = look() { left -> b; right -> c; neither -> drop; }
  node b = weigh(most = most, share = 0.5) { light -> c; heavy -> split; }
  node c = measure() { done -> keep; }
}
END
sed 's/heavy -> split/heavy -> drop/' one.dag >two.dag
cat >row.dag <<'END'
tool dear() question answers (no, yes) anywhere "";
tool cheap() question answers (no, yes) anywhere "";
oracle row {
  start a;
  node a = dear() { no -> drop; yes -> b; }
  node b = cheap() { no -> drop; yes -> c; }
  node c = measure() { done -> keep; }
}
END
cat >row.json <<'END'
{"oracle": "row", "nodes": [
 {"node": "a", "tool": "dear", "calls": 9, "mean_seconds": 2, "answers": [{"answer": "no", "count": 1}, {"answer": "yes", "count": 8}]},
 {"node": "b", "tool": "cheap", "calls": 8, "mean_seconds": 1, "answers": [{"answer": "no", "count": 4}, {"answer": "yes", "count": 4}]},
 {"node": "c", "tool": "measure", "calls": 4, "answers": [{"answer": "done", "count": 4}]}]}
END

# Stand-ins for the programs that dagc runs: what matters here is dagc.
printf '#!/bin/sh\nexec cat\n' >bin/dot
printf '#!/bin/sh\nwhile [ $# -gt 1 ]; do case $1 in -o) out=$2;; esac; shift; done\nexec cp "$KEPT" "$out"\n' >bin/copy
printf '#!/bin/sh\nfor f; do case $f in *.so) out=$f;; esac; done\ncc "$@" && cp "$out" "$KEPT"\n' >bin/compile
chmod +x bin/*
PATH=$tmp/bin:$PATH
export KEPT="$tmp/kept.so" FAIL_MARK="$tmp/mark"

count=0 bad=0 failures=0
few=4 step=7 # what is alike fails alike: every one only when THOROUGH
[ -z "${THOROUGH-}" ] || few=12 step=1
complain() {
    bad=$((bad + 1))
    echo "memory.sh: dagc $mode: allocation $at: $1"
    head -n 5 stderr
}
untouched() {
    for file in old.c old.h old.d; do
        read -r line <$file && [ "$line" = old ] || return 1
    done
    set -- old.?.?????? work/*
    [ ! -e "$1" ] && [ ! -e "$2" ]
}
same() { # as without a failure
    cmp -s stdout whole.out && cmp -s old.c whole.c && cmp -s old.h whole.h && cmp -s old.d whole.d && cmp -s stderr whole.err
}
old() {
    for file in old.c old.h old.d; do echo old >$file; done
}
survives() { # STATUS-FOR-TROUBLE ARGUMENT...
    trouble=$1
    shift
    mode=$*
    count=$((count + 1))
    old
    CC=compile "$dagc" "$@" >whole.out 2>whole.err </dev/null
    usual=$?
    for kind in c h d; do cp old.$kind whole.$kind; done
    at=0
    while [ $at -lt 1000 ]; do
        old
        : >mark
        CC=copy FAIL_AT=$at LD_PRELOAD=$tmp/malloc.so "$dagc" "$@" >stdout 2>stderr </dev/null
        got=$?
        [ -s mark ] || break
        failures=$((failures + 1))
        if [ $got = $usual ] && same; then
            :
        elif [ $got != "$trouble" ]; then
            complain "exit $got"
        elif [ "$(grep -c 'error: ' stderr)" != 1 ] || ! grep -q 'error: .*\(memory\|shared object\)' stderr; then # dlopen has its own words
            complain "not one error, of memory"
        elif ! untouched; then
            complain "files were touched"
        elif [ -s stdout ] && case $mode in diff*|*--prove*) false ;; esac then
            complain "half an output"
        fi
        [ $bad -lt 20 ] || return 1
        at=$((at + (at < few ? 1 : step)))
    done
    [ $got = $usual ] && same || complain "not what it writes with memory"
    [ $at -gt 2 ] || complain "only $at allocations: does the failing malloc work?"
}

c="-Wno-all --catalog test_catalog.dag -o old.c"
survives 1 $c --header old.h --depfile old.d emit_c.dag
survives 1 $c --header old.h --instrument --trace emit_branch.dag
survives 1 $c --header old.h --standalone --prefix p -I library -I runtime --depfile old.d emit_c.dag
for emit in none dot svg json text; do
    survives 1 $c --emit=$emit emit_branch.dag
done
survives 1 -Wno-all --catalog test_catalog.dag --emit=json emit_c.dag
for pass in parse resolve check analyse; do
    survives 1 $c --dump=$pass emit_branch.dag
done
for emit in catalog catalog-h catalog-c; do
    survives 1 --emit=$emit -o old.c test_catalog.dag
done
survives 1 --emit=stub --catalog test_catalog.dag -o old.c weigh
survives 1 --emit=stub --catalog test_catalog.dag -o old.c size
survives 1 --emit=stub --catalog test_catalog.dag -o old.c wiegh
survives 1 --catalog analysis_catalog.dag -Wall -I library -o old.c --depfile old.d imports.dag
survives 1 --catalog analysis_catalog.dag -Wall -o old.c warn_twin_answers.dag
survives 1 --catalog analysis_catalog.dag -Werror -o old.c warn_twin_answers.dag
survives 1 --catalog test_catalog.dag -o old.c cycle.dag
survives 1 $c none.dag
survives 2 diff --catalog test_catalog.dag one.dag one.dag
survives 2 diff --catalog test_catalog.dag one.dag two.dag
survives 1 $c --dump=waves --profile row.json row.dag
survives 1 $c --header old.h --depfile old.d --profile row.json row.dag
survives 1 -Wno-all --catalog test_catalog.dag --prove --instrument --trace one.dag

echo "memory: $failures failed allocations in $count modes, $bad wrong"
[ $bad = 0 ]
