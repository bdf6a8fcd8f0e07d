/* lanes.h - loops over doubles that run several at a time.
 *
 * A loop over LANES numbers, its length a constant, without a branch, from arrays of a structure
 * into others of it, is what compilers turn into vectors. Such a loop is compiled up to three
 * times: for AVX-512, for AVX2 and for the processor that the rest is compiled for. Which one runs
 * is asked of the processor (lanes_width); all give the same bits, as each lane does what a double
 * alone would, and nothing is fused. How many numbers there are is rounded up to whole lanes; what
 * is computed there is not read.
 *
 * LANES may be given as 1, 4 or 16 while compiling, LANES_WIDEST as the widest vector that may be
 * chosen (1, 4 or 8 doubles): no result depends on either.
 * SPDX-License-Identifier: MIT */
#ifndef KERNEL_LANES_H
#define KERNEL_LANES_H

#include "discussion.h"

#ifndef LANES
#define LANES 8
#endif
/* AVX-512 can fuse products and sums, AVX2 alone cannot. gcc does so in C++ and in its own C unless
 * told not to, which a header cannot see. */
#ifndef LANES_WIDEST
#if defined __GNUC__ && !defined __clang__ && (defined __cplusplus || !defined __STRICT_ANSI__)
#define LANES_WIDEST 4
#else
#define LANES_WIDEST 8
#endif
#endif
enum { LANES_MOST = 16 }; /* to what lengths of arrays are rounded up */

#if defined __GNUC__ && defined __x86_64__ && !defined __TINYC__ && LANES_WIDEST > 1
#define LANES_CHOSEN 1
#define LANES_AVX2 __attribute__((target("avx2"), noinline, unused)) static
#define LANES_AVX512 __attribute__((target("avx512f"), noinline, unused)) static
/* Calls the function for vectors of a width, each `arguments` in parentheses. */
#define LANES_RUN(width, wide, middle, narrow, arguments) \
    ((width) == 8 ? wide arguments : (width) == 4 ? middle arguments : narrow arguments)
#else
#define LANES_CHOSEN 0
#define LANES_RUN(width, wide, middle, narrow, arguments) ((void)(width), narrow arguments)
#endif

/* How many doubles a vector of this processor holds: 8, 4, or 1 for whatever the compiler was told
 * of it. */
static inline int lanes_width(void)
{
#if LANES_CHOSEN
    if (LANES_WIDEST >= 8 && __builtin_cpu_supports("avx512f"))
        return 8;
    if (__builtin_cpu_supports("avx2"))
        return 4;
#endif
    return 1;
}

#endif
