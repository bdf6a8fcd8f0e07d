/* exchange.h - the view factors of a scene: F_ij, the share of what leaves input face i evenly that
 * meets input face j.
 * SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_H
#define EXCHANGE_H

#include "engine/closure.h"
#include "engine/exchange_areas.h"
#include "engine/exchange_state.h"

struct exchange;

struct exchange_options {
    /* error to work for, > 0 (EXCHANGE_TOLERANCE): of a row's sum, and of entries in half shadow,
     * as shares of themselves */
    double tolerance;
    enum closure closure;
    int threads;
    /* Told from the calling thread after each round of refinement ("refine"), and before values are
     * computed and while they are ("factors", exchange.share of them done; "again", those of rows
     * that were off); once instead ("resumed") where the work of a run before stands. Anything but
     * 0 cancels. NULL: nobody is. */
    int (*progress)(void *context, const struct exchange *exchange, const char *phase);
    void *context; /* of progress */
    uint32_t rows; /* of the first so many inputs, which alone are accounted for; 0: all */
    /* 1: values are not kept, but computed anew for each product (exchange_product.h): there are no
     * rows, and closure is none or rows */
    int stream;
    size_t keep; /* bytes of values of groups in clear view, at the most; 0: 512 MiB */
    const struct RadExchangeState *state; /* borrowed; NULL: none; of several ranks, rank 0's */
    /* who works on it together, each of whom then has all of it; borrowed, NULL: one process */
    struct ranks *ranks;
};

struct exchange_report {
    uint64_t links, pairs, rays;
    double low, high; /* of all rows' sums, before closure */
    /* that ought to sum to 1; see the environment; a black back (some both); of the others those
     * that are covered in part */
    uint32_t rows_closed, rows_open, rows_backs, rows_covered;
    double defect_most, defect_mean; /* |1 - sum| of the closed ones, before closure */
    double worst;                    /* the same, and what others have above 1; of which row */
    uint32_t worst_row;
    /* what goes to the environment and to backs: the most of a row, and the mean over all area */
    double environment_most, environment_mean, backs_most, backs_mean;
    /* largest |factor - 1| that a view factor took; largest |1 - sum| left */
    double closure_change, closure_left;
    double entry_error; /* the largest estimated of any F_ij, before closure */
    struct {
        double refine, fill;
    } seconds;
};

/* What a row sends that meets no front, shares: out of the scene, to black backs, and from where
 * something stands on the face. 0 of rows that lack less than the tolerance and were not asked. */
struct exchange_loss {
    double leaves, backs, covered;
};

struct exchange {
    struct exchange_tree tree;
    struct refinement refinement; /* until the areas are computed; of a stream to the end */
    struct exchange_areas areas;
    struct exchange_closure closure;
    struct exchange_loss *losses; /* [areas.inputs], after closure */
    struct exchange_report report;
    struct exchange_state state; /* while it is computed */
    const char *phase;           /* while values are computed */
    double share;                /* done of the phase; 0: not known */
    int cancelled, threads;
    struct ranks *ranks; /* borrowed */
    uint64_t rays;       /* that this rank has cast */
    int resumed;         /* a run before this one has begun, and nobody has been told */
    int refused;         /* the state is no good, as *cause says */
    const char *no_rays; /* why there are none, though rows ask for them */
};

/* Parameters of the oracle viewfactors whose defaults are made for EXCHANGE_TOLERANCE become what
 * this tolerance asks for. Before any parameter is set by hand. */
void exchange_set_tolerance(struct refiner *refiner, double tolerance);

/* Compute everything. The scene is borrowed and must outlive the exchange, the refiner need not.
 * Returns 0; on failure -1 with *cause set (a constant string) and nothing to free; *cause is NULL
 * when the progress function has cancelled, or the state was put down. Which of these, and whether
 * the state to go on from was refused, `cancelled` and `refused` say. */
int exchange_open(struct exchange *x, const struct scene *scene, const struct refiner *refiner,
                  const struct exchange_options *options, const char **cause);
void exchange_close(struct exchange *x);

/* Row i of F_ij, after closure, as exchange_multiply takes it: row[areas.inputs]. What closure has
 * left above 1 stays so. Returns its sum; 0 of a face that was dropped. Safe from many threads at
 * once. */
double exchange_row(const struct exchange *x, uint32_t i, double *row);

/* y[rows][columns] = F x, x[inputs][columns], after closure. Returns 0, or -1 when out of memory.
 */
int exchange_multiply(const struct exchange *x, uint32_t columns, const double *in, double *out);

#endif
