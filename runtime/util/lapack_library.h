/* lapack_library.h - LAPACKE, which is loaded when somebody solves by LU.
 *
 * It and what it needs in turn take longer to load than a small scene's view factors to compute,
 * and few ask for it.
 * SPDX-License-Identifier: MIT */
#ifndef LAPACK_LIBRARY_H
#define LAPACK_LIBRARY_H

#include <lapacke.h>

struct lapack {
    __typeof__(LAPACKE_dgetrf) *factor;
    __typeof__(LAPACKE_dgetrs) *solve;
};

/* Its functions. Returns NULL, or why there are none: until the next call, of this thread. */
const char *lapack_load(struct lapack *lapack);

#endif
