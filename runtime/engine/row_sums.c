/* rows.c - no point sees more than everything: what is done about rows that say otherwise.
 *
 * The row of a leaf is the sum of F V over its own links and its ancestors'. It counts per exposed area, for what is
 * buried sees nothing, and is at most 1; yet a leaf near an edge, whose ancestors' links bring their mean, can
 * exceed that, and then a bright enough scene gains power in every reflection and the iteration diverges.
 *
 * The cap (CLOSURE_NONE). A leaf above 1 is brought down to 1: what comes over its ancestors' links, which is their mean and not
 * its own, is scaled, and its own links only where they alone are above 1. (To scale both alike would take strong light, which has
 * fine links, for what is wrong with weak.) The power that takes away is given to the leaves
 * of the same face between 1/2 and 1, by the room they have. That moves power within a face and makes none; rows
 * below 1/2 are shadow, not error, and stay dark. Where the mean row of a whole face exceeds 1, by the noise of its
 * rays, the cap is that mean (cutting noise on one side would lose power), but at most 1 + (1 - rho) / 2: so
 * the iteration converges whatever the oracle does.
 *
 * Closure (CLOSURE_ROWS). In a closed scene every row is 1, so every row is scaled to 1, up or down; a leaf that has
 * no link at all though it is exposed takes the mean of its face. In an open scene what is missing may be sky:
 * rows above 1 are scaled to 1 and others stay. Every row is at most 1 then, so no light is made. A constant radiosity is
 * reproduced exactly in a closed scene (white furnace). What is lost is reciprocity: A_i F_ij and A_j F_ji are
 * scaled by different factors, so that power is balanced only as well as the unscaled rows agree.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/row_sums.h"

/* What the rows of one face come to. */
struct rows {
    double cap, sum, area; /* sum: of A exposed row (m2); area: of A exposed (m2) */
    double seeing;         /* of A exposed, leaves that have a row (m2) */
    double excess, room;   /* above the cap; between SHADOW of the cap and the cap (m2) */
    struct solve *s;
};
#define SHADOW 0.5

/* Leave the row of every leaf below e where its scale will stand, and what its ancestors have of it where theirs will. */
static void sum_links(struct solve *s, uint32_t e, double above)
{
    const struct element *x = &s->hierarchy.elements[e];
    const struct refinement *r = &s->refinement;
    double row = above;
    size_t i;
    int c;
    for (i = r->first_link[e]; i < r->first_link[e + 1]; i++)
        row += (double)r->links[i].form_factor * (r->links[i].visibility * (1.0 / LINK_VISIBLE));
    row += cluster_light_row(&s->cluster_light, e);
    for (c = 0; c < x->children; c++)
        sum_links(s, x->child + (uint32_t)c, row);
    if (!x->children) {
        s->row_scale[e] = row;
        s->row_above[e] = above;
    }
}

static void visit_leaves(struct rows *rows, uint32_t e, void (*visit)(struct rows *rows, uint32_t leaf, double row))
{
    const struct element *x = &rows->s->hierarchy.elements[e];
    int c;
    for (c = 0; c < x->children; c++)
        visit_leaves(rows, x->child + (uint32_t)c, visit);
    if (!x->children)
        visit(rows, e, rows->s->row_scale[e]);
}

/* The row of a leaf per exposed area, and that area (m2); 0 when all of it is buried. */
static double exposed_row(const struct solve *s, uint32_t leaf, double row, double *area)
{
    *area = s->hierarchy.elements[leaf].area * s->exposed[leaf];
    return s->exposed[leaf] > 0 ? row / s->exposed[leaf] : 0;
}

static void sum_row(struct rows *rows, uint32_t leaf, double row)
{
    struct solve *s = rows->s;
    double area, off;
    row = exposed_row(s, leaf, row, &area);
    s->leaves++;
    if (!(area > 0))
        return;
    off = fabs(row - 1);
    rows->sum += area * row;
    rows->area += area;
    rows->seeing += row > 0 ? area : 0;
    s->row_low = row < s->row_low ? row : s->row_low;
    s->row_high = row > s->row_high ? row : s->row_high;
    s->row_blind += row > 0 ? 0 : area;
    s->row_defect += area * off;
    s->row_defect_most = off > s->row_defect_most ? off : s->row_defect_most;
}

static void weigh_row(struct rows *rows, uint32_t leaf, double row)
{
    double area;
    row = exposed_row(rows->s, leaf, row, &area);
    if (row > rows->cap)
        rows->excess += area * (row - rows->cap);
    else if (row > SHADOW * rows->cap)
        rows->room += area * (rows->cap - row);
}

static void cap_row(struct rows *rows, uint32_t leaf, double row)
{
    struct solve *s = rows->s;
    double area, above, own, most = rows->excess > rows->room ? rows->excess : rows->room;
    above = exposed_row(s, leaf, s->row_above[leaf], &area);
    row = exposed_row(s, leaf, row, &area);
    own = row - above;
    s->row_scale[leaf] = own > rows->cap ? rows->cap / own : 1;
    s->row_above[leaf] = row <= rows->cap ? 1 : own < rows->cap ? (rows->cap - own) / above : 0;
    s->row_gift[leaf] = row > SHADOW * rows->cap && row < rows->cap ? s->exposed[leaf] * (rows->cap - row) / most : 0;
}

static void close_row(struct rows *rows, uint32_t leaf, double row)
{
    struct solve *s = rows->s;
    double area;
    row = exposed_row(s, leaf, row, &area);
    rows->excess += row > 1 ? area * (row - 1) : 0;
    s->row_scale[leaf] = !(area > 0) ? 0 : closure_row_scale(row, 1, s->closed > 0);
    s->row_above[leaf] = s->row_scale[leaf];
    s->row_gift[leaf] = row > 0 || s->closed <= 0 || !(rows->seeing > 0) ? 0
                              : (area > 0 ? s->exposed[leaf] : 1) / rows->seeing;
}

void rows_scale(struct solve *s)
{
    double exposed = 0;
    uint32_t i;
#pragma omp parallel for schedule(dynamic, 16) num_threads(s->options.threads)
    for (i = 0; i < s->scene->face_count; i++)
        sum_links(s, s->hierarchy.face_element[i], 0);
    s->leaves = 0;
    s->row_low = INFINITY;
    s->row_high = s->row_excess = s->row_blind = s->row_defect = s->row_defect_most = 0;
    for (i = 0; i < s->scene->face_count; i++) {
        uint32_t e = s->hierarchy.face_element[i];
        double most = 1 + 0.5 * (1 - s->whitest[i]);
        struct rows rows = { .cap = 1, .s = s };
        visit_leaves(&rows, e, sum_row);
        exposed += rows.area;
        if (s->options.closure == CLOSURE_ROWS) {
            visit_leaves(&rows, e, close_row);
        } else {
            if (rows.sum > rows.area)
                rows.cap = rows.sum < most * rows.area ? rows.sum / rows.area : most;
            visit_leaves(&rows, e, weigh_row);
            visit_leaves(&rows, e, cap_row);
        }
        s->row_excess += rows.excess / rays_host(s->rays)->area;
    }
    s->row_defect = exposed > 0 ? s->row_defect / exposed : 0;
}
