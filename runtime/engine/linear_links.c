/* linear_links.c - see linear_links.h.
 *
 * Rows. The row of a leaf is linear, too: what a radiosity of 1 everywhere brings. Its mean is
 * capped or closed as that of constants is, slopes and mean of what is received by the same
 * factors; so power is kept within each face, for no slope changes a mean. Links of many sizes
 * leave rows that exceed 1 at corners. No point sees more than everything: of the row's slopes r_a
 * so large a share c is error as makes it 1 there, and c r_a H_0 / row is taken off H_a. In a
 * closed scene rows are nearly 1, c is nearly 1 and a constant radiosity stays what it is; in an
 * open one, where rows are below 1, slopes stay. Under closure of a closed scene c = 1.
 *
 * Both ways round: an emitter's slopes send b_a r_a more than its mean does, or less, by the same
 * sums, so c r_a b_a / row is taken off the mean that it sends, and A_r C_ab(r, s) = A_s C_ba(s, r)
 * stays. Else the bright side of a slope would light what stands before it and, visibility being
 * one number per link, take nothing from what that hides.
 *
 * Where a solid covers a part of a leaf the leaf is constant.
 *
 * Faint links. Most links of a crowded scene carry next to nothing, between slivers and the large
 * faces beside them, whose couplings cost the most. The weakest, together LINEAR_FAINT of all that
 * links carry, stay constant. With slopes such a link would bring the receiver light elsewhere, and
 * of the part of the emitter that it sees best, which is at most three times as bright as the mean,
 * for no linear function B >= 0 over a triangle or a parallelogram has more; so the irradiance is
 * off by at most 4 times what the link carries (W, sum A |dH|), that by all of them by at most 4
 * LINEAR_FAINT of it. What a link carries is taken of its receiver's radiosity and the mean beside
 * the emitter's: rows have slopes, too, half of them perhaps from dark emitters, and they take off
 * what the receiver has; and so a link is faint both ways round.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_links.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include "kernel/constants.h"
#include "util/thread_pool.h"

static int between_surfaces(const struct hierarchy *h, const struct link *l)
{
    return h->elements[l->receiver].vertices && h->elements[l->emitter].vertices
           && l->form_factor > 0 && l->visibility > 0;
}

static struct linear_side side_of(const struct linear_links *l, const struct hierarchy *h,
                                  uint32_t e)
{
    return (struct linear_side){&h->elements[e], &l->basis[e]};
}

static void store(float moment[LINEAR_MOMENTS], double c[3][3])
{
    for (int i = 1; i < 9; i++)
        moment[i - 1] = (float)c[i / 3][i % 3];
}

static void recall(const float moment[LINEAR_MOMENTS], double form_factor, double c[3][3])
{
    for (int i = 1; i < 9; i++)
        c[i / 3][i % 3] = (double)moment[i - 1];
    c[0][0] = form_factor;
}

static void make_bases(const void *links, size_t from, size_t to)
{
    const struct linear_links *l = links;
    const struct hierarchy *h = l->of->hierarchy;
    for (size_t i = from; i < to; i++)
        if (h->elements[i].vertices)
            linear_basis_of(&l->basis[i], &h->elements[i]);
}

/* What a link carries of the radiosities of both its ends and the mean (W). */
static double carried(const struct hierarchy *h, const struct link *l)
{
    const struct element *r = &h->elements[l->receiver], *s = &h->elements[l->emitter];
    return r->area * (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE))
           * (r->radiosity + s->radiosity + h->elements[0].radiosity);
}

/* What carries less (W) is LINEAR_FAINT of all at most, to the octave. */
static double faintest(const struct light_operator *op)
{
    enum { OCTAVES = 64 };
    const struct hierarchy *h = op->hierarchy;
    const struct refinement *r = op->refinement;
    double all = 0, octave[OCTAVES] = {0}, below = 0, least = 0;
    for (size_t i = 0; i < r->link_count; i++)
        all += between_surfaces(h, &r->links[i]) ? carried(h, &r->links[i]) : 0;
    ranks_add(op->shares.ranks, RANKS_VALUES, &all, 1);
    all = (double)(float)all; /* which last bit it has decides nothing */
    for (size_t i = 0; i < r->link_count && all > 0; i++)
        if (between_surfaces(h, &r->links[i])) {
            double share = carried(h, &r->links[i]) / all;
            int exponent = share > 0x1p-64 ? -ilogb(share) : OCTAVES;
            octave[exponent < OCTAVES ? exponent : OCTAVES - 1] += share;
        }
    ranks_add(op->shares.ranks, RANKS_VALUES, octave, OCTAVES);
    for (int i = OCTAVES - 1; i > 0 && (below += octave[i]) <= LINEAR_FAINT; i--)
        least = ldexp(all, 1 - i); /* octave[i]: shares from 2^-i on */
    return least;
}

static void make_couplings(const void *links, size_t begin, size_t end)
{
    const struct linear_links *l = links;
    const struct hierarchy *h = l->of->hierarchy;
    for (size_t i = begin; i < end; i++) {
        const struct link *link = &l->of->refinement->links[i];
        double c[3][3];
        if (!between_surfaces(h, link))
            continue;
        if (carried(h, link) < l->faint) {
            l->nonnegative[i] = 1;
            continue;
        }
        struct linear_side to = side_of(l, h, link->receiver), from = side_of(l, h, link->emitter);
        linear_coupling_integrate(c, to, from);
        linear_coupling_scale(c, (double)link->form_factor);
        if (link->visibility < LINK_VISIBLE)
            linear_coupling_limit(c, to, from);
        l->nonnegative[i] = link->visibility < LINK_VISIBLE;
        store(l->moment[i], c);
    }
}

int linear_links_open(struct linear_links *l, const struct light_operator *op)
{
    const struct hierarchy *h = op->hierarchy;
    const struct refinement *r = op->refinement;
    int threads = op->problem->options.threads;
    memset(l, 0, sizeof *l);
    l->of = op;
    l->basis = calloc(h->count, sizeof *l->basis);
    l->moment = calloc(r->link_count + 1, sizeof *l->moment);
    l->nonnegative = calloc(r->link_count + 1, sizeof *l->nonnegative);
    l->row = calloc(h->count, sizeof *l->row);
    if (ranks_any(op->shares.ranks, !l->basis || !l->moment || !l->nonnegative || !l->row)) {
        linear_links_close(l);
        return -1;
    }
    l->faint = faintest(op);
    thread_pool_run(threads, h->count, 256, make_bases, l);
    thread_pool_run(threads, r->link_count, 256, make_couplings, l);
    return 0;
}

struct limiting {
    const struct linear_links *links;
    const unsigned char *receivers; /* [element]; NULL: all */
    atomic_size_t *made;
};

static void limit_links(const void *limiting, size_t from, size_t to)
{
    const struct limiting *m = limiting;
    const struct linear_links *l = m->links;
    const struct hierarchy *h = l->of->hierarchy;
    size_t made = 0;
    for (size_t i = from; i < to; i++) {
        const struct link *link = &l->of->refinement->links[i];
        double c[3][3];
        if ((m->receivers && !m->receivers[link->receiver]) || l->nonnegative[i]
            || !between_surfaces(h, link))
            continue;
        recall(l->moment[i], (double)link->form_factor, c);
        linear_coupling_limit(c, side_of(l, h, link->receiver), side_of(l, h, link->emitter));
        store(l->moment[i], c);
        l->nonnegative[i] = 1;
        made++;
    }
    *m->made += made;
}

size_t linear_links_limit(struct linear_links *l, const unsigned char *receivers)
{
    atomic_size_t made = 0;
    const struct limiting m = {l, receivers, &made};
    l->limited |= !receivers;
    thread_pool_run(l->of->problem->options.threads, l->of->refinement->link_count, 256,
                    limit_links, &m);
    uint64_t all = made; /* by all ranks */
    ranks_add_counts(l->of->shares.ranks, RANKS_VALUES, &all, 1);
    return all;
}

void linear_links_gather(const struct linear_links *l, const struct light_operator *op,
                         uint32_t bands, uint32_t e, const double *sent, double h[3][3])
{
    const struct refinement *r = op->refinement;
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        const struct link *link = &r->links[i];
        const float *m = l->moment[i];
        double visible = link->visibility * (1.0 / LINK_VISIBLE);
        for (uint32_t k = 0; k < bands; k++) {
            const double *from = &sent[((size_t)link->emitter * bands + k) * 3];
            double b = visible * from[0], b1 = visible * from[1], b2 = visible * from[2];
            h[k][0] += (double)link->form_factor * b + (double)m[LINEAR_01] * b1
                       + (double)m[LINEAR_02] * b2;
            h[k][1] +=
                (double)m[LINEAR_10] * b + (double)m[LINEAR_11] * b1 + (double)m[LINEAR_12] * b2;
            h[k][2] +=
                (double)m[LINEAR_20] * b + (double)m[LINEAR_21] * b1 + (double)m[LINEAR_22] * b2;
        }
    }
}

void linear_links_restrict(const struct linear_links *l, const struct hierarchy *h, uint32_t e,
                           uint32_t child, const double b[3], double on_child[3])
{
    struct two_scale t;
    linear_two_scale(&t, &l->basis[e], &h->elements[e], &l->basis[child], &h->elements[child]);
    on_child[0] = b[0] + b[1] * t.mean[0] + b[2] * t.mean[1];
    on_child[1] = b[1] * t.from[0][0] + b[2] * t.from[1][0];
    on_child[2] = b[1] * t.from[0][1] + b[2] * t.from[1][1];
}

void linear_links_hand_down(const struct linear_links *l, const struct light_operator *op,
                            uint32_t e, uint32_t child, const double b[3], double on_child[3])
{
    double bare = operator_bare(op, child, e);
    linear_links_restrict(l, op->hierarchy, e, child, b, on_child);
    for (int a = 0; a < 3; a++)
        on_child[a] *= bare;
}

void linear_links_rows(const struct linear_links *l, const struct light_operator *op, uint32_t e,
                       const double above[3])
{
    const struct element *x = &op->hierarchy->elements[e];
    const struct refinement *r = op->refinement;
    double own[3] = {separable_links_row(&op->separable, e), 0, 0};
    for (size_t i = r->first_link[e]; i < r->first_link[e + 1]; i++) {
        double visible = r->links[i].visibility * (1.0 / LINK_VISIBLE);
        own[0] += visible * (double)r->links[i].form_factor;
        own[1] += visible * (double)l->moment[i][LINEAR_10];
        own[2] += visible * (double)l->moment[i][LINEAR_20];
    }
    if (!x->children) {
        op->row_above[e] = above[0];
        op->row_scale[e] = above[0] + own[0];
        for (int a = 0; a < 2; a++) {
            l->row[e].above[a] = above[a + 1];
            l->row[e].own[a] = own[a + 1];
        }
        return;
    }
    const double all[3] = {above[0] + own[0], above[1] + own[1], above[2] + own[2]};
    for (int c = 0; c < x->children; c++) {
        double on_child[3];
        linear_links_hand_down(l, op, e, x->child + (uint32_t)c, all, on_child);
        linear_links_rows(l, op, x->child + (uint32_t)c, on_child);
    }
}

/* How much of the row's slopes is error: all of them where rows are 1 all over, else what makes a
 * corner see more than everything. */
static double share_in_error(const struct linear_links *l, const struct light_operator *op,
                             uint32_t leaf, double most)
{
    double room = fmax(0, 1 - op->row[leaf]);
    if (l->limited)
        return 0;
    if (op->problem->options.closure == CLOSURE_ROWS && op->problem->closed > 0)
        return 1;
    return most > room ? 1 - room / most : 0;
}

struct scaling {
    const struct linear_links *links;
    const struct light_operator *op;
};

static void scale_leaves(const void *scaling, size_t from, size_t to)
{
    const struct linear_links *l = ((const struct scaling *)scaling)->links;
    const struct light_operator *op = ((const struct scaling *)scaling)->op;
    for (uint32_t i = (uint32_t)from; i < to; i++) {
        const struct element *e = &op->hierarchy->elements[i];
        struct linear_row *row = &l->row[i];
        double least, most, slopes[2];
        if (!e->vertices || e->children)
            continue;
        for (int a = 0; a < 2; a++)
            slopes[a] = row->above[a] * op->row_above[i] + row->own[a] * op->row_scale[i];
        linear_basis_range(&l->basis[i], e, slopes, &least, &most);
        double off = share_in_error(l, op, i, most);
        for (int a = 0; a < 2; a++)
            row->flat[a] = op->row[i] > 0 ? off * slopes[a] / op->row[i] : 0;
        double limit = 1 + (1 - op->problem->whitest[e->face]) * LINEAR_ROW_EXCESS,
               room = fmax(0, limit - op->row[i]);
        row->scale = op->uncovered[i] < 1 ? 0 : l->limited && most > room ? room / most : 1;
    }
}

void linear_links_scale(struct linear_links *l, const struct light_operator *op)
{
    const struct scaling s = {l, op};
    thread_pool_run(op->problem->options.threads, op->hierarchy->count, 256, scale_leaves, &s);
}

void linear_links_close(struct linear_links *l)
{
    free(l->basis);
    free(l->moment);
    free(l->nonnegative);
    free(l->row);
    memset(l, 0, sizeof *l);
}
