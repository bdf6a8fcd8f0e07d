/* heap.h - what becomes of memory that is freed.
 *
 * Arrays of a few megabytes come and go in each pass. Given back to the system, and got again, each
 * of their pages is cleared and mapped anew: a quarter of a solve of 13,000 faces where malloc
 * maps from 1 MB on. So those of less than 32 MB stay; larger ones, and what is free at the end of
 * the heap, above 64 MB, go back. Libraries that are loaded may have said otherwise: SuperLU_DIST,
 * which PETSc brings along, tells malloc to keep all, which was a third of what a process took.
 * SPDX-License-Identifier: MIT */
#ifndef HEAP_H
#define HEAP_H

/* First of all: before anything is allocated. */
void heap_settle(void);

#endif
