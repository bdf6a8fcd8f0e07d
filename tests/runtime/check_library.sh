#!/bin/sh
# check_library.sh - what libradiosity.a and .so show of themselves: the functions of radiosity.h and nothing else. They print
# nothing, ask no environment, end no process, and hold nothing of tests/.
# DAGC names the command, in the build folder that the libraries stand in.
# SPDX-License-Identifier: MIT
. "$(dirname "$0")/../dagc/lib.sh"
build=$(dirname "$(dirname "$dagc")")

none() { # FILE: has no line
    [ ! -s "$1" ] || { cat "$1"; return 1; }
}
symbols() { # NM-OPTION... FILE
    nm --defined-only "$@" | awk 'NF == 3 { print $3 }' | sort -u
}

# ---- exported: what the header declares
grep -o '\brad[A-Z][A-Za-z]* *(' "$top/runtime/radiosity.h" | tr -d ' (' | sort -u >spoken
grep '^RAD_API' "$top/runtime/radiosity.h" | grep -o '\brad[A-Z][A-Za-z]*(' | tr -d '(' | sort >declared
check "the header declares functions" [ "$(wc -l <declared)" -gt 40 ]
check "each function is declared once, with RAD_API" sh -c "comm -23 spoken declared | grep . && exit 1; uniq -d declared | grep . && exit 1; exit 0"
symbols -D "$build/libradiosity.so" >so
symbols -g "$build/libradiosity.a" >a
check "the shared library exports the header's functions alone" diff declared so
check "the archive shows the header's functions alone" diff declared a
check "the shared library has a name of its own version" \
    sh -c "objdump -p '$build/libradiosity.so' | grep -q 'SONAME *libradiosity\.so\.[0-9]*\.[0-9]*$'"

# ---- nothing printed, asked or ended. stdin is there for oracles from "-", environ for the C compiler, which has it as any child has.
nm -u "$build/libradiosity.a" | awk '{ print $NF }' | sed 's/@.*//' | sort -u >needed
check "something is needed" grep -qx malloc needed
grep -Ex 'stdout|stderr|getenv|secure_getenv|exit|_Exit|quick_exit|abort|__assert_fail|v?printf|puts|putchar|perror|psignal|system|setenv|signal|sigaction' \
    needed >forbidden
check "no stderr, getenv or exit" none forbidden
grep -E '^(ai[A-Z]|json_|png_)' needed >others
check "no reader of files or writer of pictures" none others

# ---- nothing of the tests
symbols "$build/libradiosity.a" >all
for object in "$build"/tests/hand/*.o; do
    [ -e "$object" ] && symbols -g "$object"
done | sort -u >hand
check "tests/hand has symbols" test -s hand
comm -12 all hand >shared
check "nothing of tests/hand is in the library" none shared

# ---- it meets no program's own names, and no program's own libdagc
cat >own.c <<'END2'
#include <radiosity.h>
#include <stdio.h>
#include <string.h>
#include "dag.h"

/* Names that the engine has, too. */
int solve_run(void);
int solve_run(void) { return 1; }
int hierarchy_build(void);
int hierarchy_build(void) { return 2; }

int main(void)
{
    RadDevice device = radNewDevice(NULL);
    RadOracle oracle = radNewOracle(device, "bf", RAD_RELEASE_DAG);
    const char *text = "oracle a { start t; node t = transfer(relative = 1) { otherwise -> stop; } }";
    struct dag *dag = dag_load_text("a", text, strlen(text), NULL, NULL, stderr);
    int failed = !device || !oracle || !dag || solve_run() + hierarchy_build() != 3;
    dag_free(dag);
    radReleaseOracle(oracle);
    radReleaseDevice(device);
    return failed;
}
END2
embree=$(objdump -p "$build/libradiosity.so" | sed -n 's/ *NEEDED *lib\(embree[0-9]*\)\.so.*/\1/p')
objdump -p "$build/libradiosity.so" | grep -E 'NEEDED *lib(g|i)?omp' >openmp
check "it needs no OpenMP" none openmp
objdump -p "$build/bin/radiosity" | grep -E 'NEEDED *lib(g|i)?omp' >openmp
check "the command needs no OpenMP" none openmp
flags="-std=c11 -Wall -Wextra -Werror ${SANITIZE-} -I$top/runtime -I$top/dagc -I$build/gen"
# shellcheck disable=SC2086
check "a program with names of the engine's, and its own libdagc" \
    cc $flags -o own own.c "$build/libradiosity.a" "$build/libdagc.a" -l"$embree" -lpthread -ldl -lm
check "it runs" ./own
# shellcheck disable=SC2086
check "the same by the shared library" cc $flags -o shared_own own.c "$build/libradiosity.so" "$build/libdagc.a" -ldl -lm
check "it runs" env LD_LIBRARY_PATH="$build" sh -c "ln -s '$build/libradiosity.so' \"\$(objdump -p '$build/libradiosity.so' | awk '/SONAME/ { print \$2 }')\"; LD_LIBRARY_PATH=. ./shared_own"

# ---- what it is linked with is what its headers are of, wherever these are
mkdir -p other/embree4
: >other/embree4/rtcore.h
check "Embree 4 is linked where the compiler finds its header" sh -c \
    "C_INCLUDE_PATH='$tmp/other' make -s --no-print-directory -C '$top' engine-libraries | grep -q -e '-lembree4 '"

# ---- the header by itself
printf '#include <radiosity.h>\n' >header.c
for compiler in cc clang; do
    command -v $compiler >/dev/null && check "the header as C11 by $compiler" \
        $compiler -std=c11 -Wall -Wextra -Wpedantic -Wconversion -Werror -fsyntax-only -I"$top/runtime" -I"$build/gen" header.c
done
for compiler in c++ clang++; do
    command -v $compiler >/dev/null && check "the header as C++11 by $compiler" \
        $compiler -std=c++11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -x c++ -I"$top/runtime" -I"$build/gen" header.c
done

# ---- dagc alone is made of dagc alone
check "make install-dagc" sh -c "make -n -B -C '$top' install-dagc BUILD='$tmp/none' PREFIX='$tmp/usr' >steps"
check "it compiles dagc" grep -q 'dagc/read/parse\.c' steps
# (What is installed as a text is not compiled.)
grep -v '^install' steps | grep -nE '(runtime|solver)/[a-z_/]*\.c( |$)|embree|lapacke|assimp|jansson|-lpng' >more
check "and nothing else" none more

finish library
