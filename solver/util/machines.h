/* machines.h - a run of several processes, on one machine or on many (mpirun): who speaks, and how
 * it ends.
 *
 * All ranks do the same work on the same arguments; rank 0 alone writes files and speaks. What the
 * others have to say is kept, and said at the end if rank 0 knows nothing of it. Built without MPI,
 * or not started by mpirun, there is one rank, and nothing here does anything.
 * SPDX-License-Identifier: MIT */
#ifndef MACHINES_H
#define MACHINES_H

#include "radiosity.h"

enum { MACHINES_MOST = 4096 }; /* of whom a summary tells */

/* First of all. Returns 0, or 2 after a message. */
int machines_begin(int *count, char ***arguments);

int machines_count(void);
int machines_number(void);

/* A device over all of them. */
RadDevice machines_device(const struct RadDeviceOptions *options);

/* The worst of all ranks' exit statuses, which all then have. Waits for all. */
int machines_agree(int status);

/* Each rank has so many of something: where its own begin, and how many all have. Waits for all. */
void machines_place(uint64_t count, uint64_t *first, uint64_t *all);

/* Have all ranks the same number? Waits for all. */
int machines_alike(uint64_t number);

/* A message, of an error or not: is it another rank's, kept here and not to be said? */
int machines_keep(const char *line, int error);

/* Something is open that could not be written, and that a library would close when MPI ends, and
 * fail: then the run ends without that. */
void machines_leave_open(void);

/* Last of all: returns the exit status of the run. Where one rank fails and others go on the whole
 * run is ended, with that rank's message. */
int machines_end(int status);

#endif
