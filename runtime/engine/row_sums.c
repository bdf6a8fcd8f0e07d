/* row_sums.c - no point sees more than everything: what is done about rows that say otherwise.
 *
 * The row of a leaf is the sum of F V over its own links and its ancestors'. It counts per
 * uncovered area, for what a solid covers sees nothing, and is at most 1; yet a leaf near an edge,
 * whose ancestors' links bring their mean, can exceed that, and then a bright enough scene gains
 * power in every reflection and the iteration diverges.
 *
 * The cap (CLOSURE_NONE). A leaf above 1 is brought down to 1: what comes over its ancestors'
 * links, which is their mean and not its own, is scaled, and its own links only where they alone
 * are above 1. (To scale both alike would take strong light, which has fine links, for what is
 * wrong with weak.) The power that takes away goes to the leaves of the same face between
 * ROW_SHADOW and 1, by the room they have. That moves power within a face and makes none; rows
 * below ROW_SHADOW are shadow, not error, and stay dark. Where the mean row of a whole face exceeds
 * 1, by the noise of its rays, the cap is that mean (cutting noise on one side would lose power),
 * but at most 1 + (1 - rho) / 2: so the iteration converges whatever the oracle does. Of what is
 * above that, links of groups pay first, all alike: they are many and dim, and one ray may have
 * decided each; strong light has links of surfaces. (In a lamp's reflector they are a fifth of what
 * arrives by row, and next to nothing of the light.)
 *
 * Closure (CLOSURE_ROWS). In a closed scene every row is 1, so every row is scaled to 1, up or
 * down; a leaf that has no link at all though it is uncovered takes the mean of its face. In an
 * open scene what is missing may be the environment: rows above 1 are scaled to 1 and others stay.
 * Every row is at most 1 then, so no light is made. A constant radiosity is reproduced exactly in a
 * closed scene (white furnace). What is lost is reciprocity: A_i F_ij and A_j F_ji are scaled by
 * different factors, so that power is balanced only as well as the unscaled rows agree.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/linear_links.h"
#include "engine/row_sums.h"
#include "kernel/constants.h"
#include "util/thread_pool.h"

enum { RUNS = 64 }; /* of faces, each measured by one thread */

/* What the rows of one face come to. Areas are uncovered ones (m2). */
struct face_rows {
    double cap, sum, area; /* sum: of A row */
    double seeing;         /* of A, leaves that have a row */
    double excess, room;   /* above the cap; between ROW_SHADOW of the cap and the cap */
    const struct light_operator *op;
    struct row_report *report;
};

/* The rows of a run of faces. */
struct run_rows {
    struct row_report report;
    double uncovered; /* m2 */
};

struct all_rows {
    const struct light_operator *op;
    size_t faces;          /* of a run */
    struct run_rows *runs; /* [RUNS] */
};

/* Leave the row of every leaf below e where its scale will stand, and what its ancestors have of
 * it where theirs will. */
static void sum_links(const struct light_operator *op, uint32_t e, double above)
{
    const struct element *x = &op->hierarchy->elements[e];
    const struct refinement *r = op->refinement;
    double row = above;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++)
        row += operator_weight(op, i);
    row += separable_links_row(&op->separable, e);
    for (int c = 0; c < x->children; c++)
        sum_links(op, x->child + (uint32_t)c, row * operator_bare(op, x->child + (uint32_t)c, e));
    if (!x->children) {
        op->row_scale[e] = row;
        op->row_above[e] = above;
    }
}

static void visit_leaves(struct face_rows *rows, uint32_t e,
                         void (*visit)(struct face_rows *rows, uint32_t leaf, double row,
                                       double area))
{
    const struct element *x = &rows->op->hierarchy->elements[e];
    double uncovered = rows->op->uncovered[e];
    for (int c = 0; c < x->children; c++)
        visit_leaves(rows, x->child + (uint32_t)c, visit);
    if (!x->children) /* per uncovered area; 0 where all is covered */
        visit(rows, e, uncovered > 0 ? rows->op->row_scale[e] / uncovered : 0, x->area * uncovered);
}

static void add_row(struct face_rows *rows, uint32_t leaf, double row, double area)
{
    (void)leaf;
    rows->sum += area * row;
    rows->area += area;
    rows->seeing += row > 0 ? area : 0;
}

static void report_row(struct face_rows *rows, uint32_t leaf, double row, double area)
{
    struct row_report *report = rows->report;
    double off = fabs(row - 1);
    add_row(rows, leaf, row, area);
    report->leaves++;
    if (!(area > 0))
        return;
    report->low = fmin(row, report->low);
    report->high = fmax(row, report->high);
    report->blind_area += row > 0 ? 0 : area;
    report->defect_mean += area * off;
    report->defect_most = fmax(off, report->defect_most);
}

static void weigh_row(struct face_rows *rows, uint32_t leaf, double row, double area)
{
    (void)leaf;
    if (row > rows->cap)
        rows->excess += area * (row - rows->cap);
    else if (row > ROW_SHADOW * rows->cap)
        rows->room += area * (rows->cap - row);
}

static void cap_row(struct face_rows *rows, uint32_t leaf, double row, double area)
{
    const struct light_operator *op = rows->op;
    double cap = rows->cap, most = fmax(rows->excess, rows->room), uncovered = op->uncovered[leaf];
    double above = uncovered > 0 ? op->row_above[leaf] / uncovered : 0, own = row - above;
    (void)area;
    op->row_scale[leaf] = own > cap ? cap / own : 1;
    op->row_above[leaf] = row <= cap ? 1 : own < cap ? (cap - own) / above : 0;
    op->row_share[leaf] = row > ROW_SHADOW * cap && row < cap ? uncovered * (cap - row) / most : 0;
    op->row[leaf] =
        op->row_share[leaf] > 0 ? row + (cap - row) / most * rows->excess : fmin(row, cap);
}

static void close_row(struct face_rows *rows, uint32_t leaf, double row, double area)
{
    const struct light_operator *op = rows->op;
    int closed = op->problem->closed > 0;
    rows->excess += row > 1 ? area * (row - 1) : 0;
    op->row_scale[leaf] = !(area > 0) ? 0 : closure_row_scale(row, 1, closed);
    op->row_above[leaf] = op->row_scale[leaf];
    op->row_share[leaf] = row > 0 || !closed || !(rows->seeing > 0)
                              ? 0
                              : (area > 0 ? op->uncovered[leaf] : 1) / rows->seeing;
    op->row[leaf] = row > 1 || op->row_share[leaf] > 0 || (row > 0 && closed) ? 1 : row;
}

/* Leave the rows of a face, whose element is e, where sum_links does. */
static void sum_face(const struct light_operator *op, uint32_t e)
{
    static const double nothing[3] = {0, 0, 0};
    if (op->linear)
        linear_links_rows(op->linear, op, e, nothing);
    else
        sum_links(op, e, 0);
}

static void sum_faces(const void *operator, size_t from, size_t to)
{
    const struct light_operator *op = operator;
    for (size_t i = from; i < to; i++)
        if (shares_mine(&op->shares, op->hierarchy->face_element[i]))
            sum_face(op, op->hierarchy->face_element[i]);
}

/* The mean row of a face whose element is e, times its uncovered area, when it takes this share of
 * what its groups' links bring. Its rows are left so. */
static double sum_with(const struct light_operator *op, uint32_t e, uint32_t face, double share)
{
    struct face_rows rows = {.op = op};
    separable_links_weaken(&op->separable, face, share);
    sum_face(op, e);
    visit_leaves(&rows, e, add_row);
    return rows.sum;
}

/* Have a face take so much less of what groups bring that its rows are `most` in the mean, and
 * nothing of it where links of surfaces bring that much without. Returns what that takes. */
static double weaken_groups(struct face_rows *rows, uint32_t e, uint32_t face, double most)
{
    const double sure = sum_with(rows->op, e, face, 0), all = rows->sum;
    rows->sum = sum_with(rows->op, e, face,
                         sure < all ? fmax(0, (most * rows->area - sure) / (all - sure)) : 1);
    return all - rows->sum;
}

static void scale_faces(const void *all_rows, size_t from, size_t to)
{
    const struct all_rows *all = all_rows;
    const struct light_operator *op = all->op;
    const struct problem *p = op->problem;
    struct run_rows *run = &all->runs[from / all->faces];
    for (size_t i = from; i < to; i++) {
        uint32_t e = op->hierarchy->face_element[i];
        double most = 1 + ROW_EXCESS * (1 - p->whitest[i]);
        struct face_rows rows = {.cap = 1, .op = op, .report = &run->report};
        if (!shares_mine(&op->shares, e))
            continue;
        visit_leaves(&rows, e, report_row);
        run->uncovered += rows.area;
        if (p->options.closure == CLOSURE_ROWS) {
            visit_leaves(&rows, e, close_row);
        } else {
            if (rows.sum > most * rows.area)
                run->report.moved +=
                    weaken_groups(&rows, e, (uint32_t)i, most) / rays_host(p->rays)->area;
            if (rows.sum > rows.area)
                rows.cap = rows.sum < most * rows.area ? rows.sum / rows.area : most;
            visit_leaves(&rows, e, weigh_row);
            visit_leaves(&rows, e, cap_row);
        }
        run->report.moved += rows.excess / rays_host(p->rays)->area;
    }
}

/* The report of all ranks' faces. */
static void add_up(struct ranks *ranks, struct row_report *r, double *uncovered)
{
    double sums[] = {r->defect_mean, r->blind_area, r->moved, *uncovered},
           most[] = {-r->low, r->high, r->defect_most};
    uint64_t leaves = r->leaves;
    ranks_add(ranks, RANKS_VALUES, sums, 4);
    ranks_most(ranks, RANKS_VALUES, most, 3);
    ranks_add_counts(ranks, RANKS_VALUES, &leaves, 1);
    r->defect_mean = sums[0];
    r->blind_area = sums[1];
    r->moved = sums[2];
    *uncovered = sums[3];
    r->low = -most[0];
    r->high = most[1];
    r->defect_most = most[2];
    r->leaves = (uint32_t)leaves;
}

static void scale_rows(const struct light_operator *op, struct row_report *report)
{
    size_t faces = op->hierarchy->face_count;
    int threads = op->problem->options.threads;
    double uncovered = 0;
    struct run_rows runs[RUNS];
    const struct all_rows all = {op, faces / RUNS + 1, runs};
    for (int i = 0; i < RUNS; i++)
        runs[i] = (struct run_rows){.report.low = INFINITY};
    thread_pool_run(threads, faces, 16, sum_faces, op);
    thread_pool_run(threads, faces, all.faces, scale_faces, &all);
    *report = (struct row_report){.low = INFINITY};
    for (int i = 0; i < RUNS; i++) {
        const struct row_report *run = &runs[i].report;
        uncovered += runs[i].uncovered;
        report->leaves += run->leaves;
        report->low = fmin(report->low, run->low);
        report->high = fmax(report->high, run->high);
        report->defect_mean += run->defect_mean;
        report->defect_most = fmax(report->defect_most, run->defect_most);
        report->blind_area += run->blind_area;
        report->moved += run->moved;
    }
    add_up(op->shares.ranks, report, &uncovered);
    report->defect_mean = uncovered > 0 ? report->defect_mean / uncovered : 0;
}

int row_sums_separate(struct light_operator *op)
{
    const struct problem *p = op->problem;
    separable_links_close(&op->separable);
    const int failed = separable_links_open(&op->separable, op->hierarchy, op->refinement,
                                            (int)p->bands, p->options.threads,
                                            p->options.projection == RAD_PROJECTION_COLLOCATION,
                                            shares_here(&op->shares))
                       < 0;
    return ranks_any(op->shares.ranks, failed) ? -1 : 0;
}

int row_sums_renew(struct light_operator *op, struct row_report *report)
{
    if (row_sums_separate(op) < 0)
        return -1;
    scale_rows(op, report);
    return 0;
}
