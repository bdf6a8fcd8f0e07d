/* desk.c - the C function behind `extern remoteness` of desk.dag: links may be coarser the farther
 * what they light is from the desk.
 *
 *   radiosity solve room.obj --oracle desk.dag --plugin desk.c
 *
 * Or as a shared object, compiled with the headers that `make install` leaves in include/dagc:
 *
 *   cc -shared -fPIC -O2 -ffp-contract=off -fno-math-errno -fno-trapping-math \
 *      -I/usr/local/include/dagc -o desk.so desk.c
 *
 * It is asked from many threads at once, and must answer the same for the same pair.
 * SPDX-License-Identifier: MIT */
#include "discussion.h"

const int radiosity_plugin_abi = RUNTIME_ABI; /* so that a stale shared object is told, not run */

double remoteness(const struct discussion *d)
{
    static const double desk[3] = {1.9, 2.4, 0.75}; /* the middle of the table in room.obj (m) */
    const struct element *e = d->receiver;
    double square = 0;
    for (int i = 0; i < 3; i++)
        square += (e->centre[i] - desk[i]) * (e->centre[i] - desk[i]);
    double nearest = sqrt(square) - e->radius; /* no point of it is nearer */
    return nearest > 1 ? nearest * nearest : 1;
}
