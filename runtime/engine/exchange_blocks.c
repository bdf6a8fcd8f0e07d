/* exchange_blocks.c - the exchange areas of a block of pairs.
 *
 * Each pair has its own, by Lambert's kernel and its second derivatives at the centroids
 * (kernel/lambert.h). What that leaves out is of fourth order in size over distance, for triangles,
 * which are lopsided, of third; pairs nearer than so many radii, by the tolerance and their shape,
 * have the contour integral (kernel/polygon_factor.h). In half shadow of groups each value is
 * multiplied by what its pair sees (exchange_shadow.h). Single faces that are not proved to see
 * each other, groups with more between than a list holds, and parts of faces linked to groups are
 * looked into pair by pair (exchange_sight.h).
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "engine/exchange_blocks.h"
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/polygon_factor.h"
#include "terms/blockers.h"

int exchange_faces_open(struct exchange_faces *p, const struct exchange_tree *t)
{
    uint32_t n = t->h.face_count;
    p->all = malloc((5 + MOMENTS) * (size_t)n * sizeof *p->all);
    if (!p->all)
        return -1;
    for (int k = 0; k < 3; k++)
        p->c[k] = p->all + (size_t)k * n;
    p->area = p->all + 3 * (size_t)n;
    p->radius = p->all + 4 * (size_t)n;
    for (int k = 0; k < MOMENTS; k++)
        p->moment[k] = p->all + (size_t)(5 + k) * n;
    for (uint32_t i = 0; i < n; i++) {
        const struct element *e = exchange_tree_face(t, i);
        double moment[MOMENTS] = {0};
        /* triangle by triangle: (1/12) sum d d over its corners, and its own centroid's */
        for (int v = 2; v < e->vertices; v++) {
            const double *corner[3] = {e->vertex[0], e->vertex[v - 1], e->vertex[v]};
            double a[3], b[3], c[3], middle[3];
            sub3(a, corner[1], corner[0]);
            sub3(b, corner[2], corner[0]);
            cross3(c, a, b);
            double share = 0.5 * dot3(c, e->normal) / e->area;
            for (int k = 0; k < 3; k++)
                middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) * (1 / 3.0);
            for (int j = 0; j < 4; j++) {
                double d[3], w = share * (j < 3 ? 1 / 12.0 : 1);
                if (j < 3)
                    sub3(d, corner[j], middle);
                else
                    sub3(d, middle, e->centre);
                for (int k = 0; k < 3; k++)
                    moment[k] += w * d[k] * d[k];
                moment[3] += w * d[0] * d[1];
                moment[4] += w * d[0] * d[2];
                moment[5] += w * d[1] * d[2];
            }
        }
        for (int k = 0; k < 3; k++)
            p->c[k][i] = e->centre[k];
        p->area[i] = e->area;
        p->radius[i] = e->radius;
        for (int k = 0; k < MOMENTS; k++)
            p->moment[k][i] = moment[k];
    }
    return 0;
}

void exchange_faces_close(struct exchange_faces *p)
{
    free(p->all);
}

int exchange_scratch_open(struct exchange_scratch *s, uint32_t most,
                          const struct sight_limits *limits)
{
    s->shift[0] = malloc(3 * (size_t)most * sizeof **s->shift);
    if (!s->shift[0])
        return -1;
    s->shift[1] = s->shift[0] + most;
    s->shift[2] = s->shift[1] + most;
    if (sight_scratch_open(&s->sight, limits) < 0)
        return -1;
    return shadow_scratch_open(&s->shadow, most);
}

void exchange_scratch_close(struct exchange_scratch *s)
{
    free(s->shift[0]);
    sight_scratch_close(&s->sight);
    shadow_scratch_close(&s->shadow);
}

/* M_i v. */
static void moment_times(const struct exchange_faces *p, uint32_t i, const double v[3],
                         double out[3])
{
    out[0] = p->moment[0][i] * v[0] + p->moment[3][i] * v[1] + p->moment[4][i] * v[2];
    out[1] = p->moment[3][i] * v[0] + p->moment[1][i] * v[1] + p->moment[5][i] * v[2];
    out[2] = p->moment[4][i] * v[0] + p->moment[5][i] * v[1] + p->moment[2][i] * v[2];
}

/* M_j n for every face of a range. */
static void moments_times(const struct exchange_faces *p, struct face_range range,
                          const double n[3], struct exchange_scratch *scratch)
{
    for (uint32_t j = range.from; j < range.to; j++) {
        double shift[3];
        moment_times(p, j, n, shift);
        for (int k = 0; k < 3; k++)
            scratch->shift[k][j - range.from] = shift[k];
    }
}

/* The exchange areas of face i, normal n, with the faces of a range, normal -m. */
static void second_order_row(const struct exchange_faces *p, uint32_t i, const double n[3],
                             struct face_range range, const double m[3],
                             const struct exchange_scratch *scratch, double *restrict out)
{
    const double *restrict x = p->c[0] + range.from, *restrict y = p->c[1] + range.from,
                           *restrict z = p->c[2] + range.from;
    const double *restrict area = p->area + range.from, *restrict xx = p->moment[0] + range.from,
                           *restrict yy = p->moment[1] + range.from,
                           *restrict zz = p->moment[2] + range.from,
                           *restrict xy = p->moment[3] + range.from,
                           *restrict xz = p->moment[4] + range.from,
                           *restrict yz = p->moment[5] + range.from;
    const double *restrict sx = scratch->shift[0], *restrict sy = scratch->shift[1],
                           *restrict sz = scratch->shift[2];
    const double cx = p->c[0][i], cy = p->c[1][i], cz = p->c[2][i],
                 ai = p->area[i] * (1 / LAMBERT_PI);
    const double ixx = p->moment[0][i], iyy = p->moment[1][i], izz = p->moment[2][i],
                 ixy = p->moment[3][i], ixz = p->moment[4][i], iyz = p->moment[5][i], n0 = n[0],
                 n1 = n[1], n2 = n[2], m0 = m[0], m1 = m[1], m2 = m[2];
    double own[3];
    int count = (int)(range.to - range.from);
    moment_times(p, i, m, own);
#pragma omp simd
    for (int j = 0; j < count; j++) {
        double r0 = x[j] - cx, r1 = y[j] - cy, r2 = z[j] - cz;
        double qxx = xx[j] + ixx, qyy = yy[j] + iyy, qzz = zz[j] + izz, qxy = xy[j] + ixy,
               qxz = xz[j] + ixz, qyz = yz[j] + iyz;
        double a = n0 * r0 + n1 * r1 + n2 * r2, b = m0 * r0 + m1 * r1 + m2 * r2;
        double t = 1 / (r0 * r0 + r1 * r1 + r2 * r2);
        double quad = qxx * r0 * r0 + qyy * r1 * r1 + qzz * r2 * r2
                      + 2 * (qxy * r0 * r1 + qxz * r0 * r2 + qyz * r1 * r2);
        double skew = a * (own[0] * r0 + own[1] * r1 + own[2] * r2)
                      + b * (sx[j] * r0 + sy[j] * r1 + sz[j] * r2);
        double e = ai * area[j] * lambert_second_order(a, b, t, quad, qxx + qyy + qzz, skew),
               least = p->area[i] < area[j] ? p->area[i] : area[j];
        out[j] = e > 0 ? e < least ? e : least : 0;
    }
}

/* A block as if all of its pairs saw each other. */
static void clear_block(const struct exchange_faces *p, const struct exchange_pair *pair,
                        struct exchange_scratch *scratch, double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    const double m[3] = {-s->normal[0], -s->normal[1], -s->normal[2]};
    double away[3];
    moments_times(p, pair->columns, r->normal, scratch);
    sub3(away, s->centre, r->centre);
    double gap = length3(away) - r->radius - s->radius; /* a group's radius is above its faces' */
    int near =
        gap < EXCHANGE_LOPSIDED * pair->near * 2 * (r->radius > s->radius ? r->radius : s->radius);
    for (uint32_t i = pair->rows.from; i < pair->rows.to;
         i++, out += pair->columns.to - pair->columns.from) {
        second_order_row(p, i, r->normal, pair->columns, m, scratch, out);
        for (uint32_t j = pair->columns.from; near && j < pair->columns.to; j++) {
            double v[3] = {p->c[0][j] - p->c[0][i], p->c[1][j] - p->c[1][i],
                           p->c[2][j] - p->c[2][i]};
            const struct element *a = exchange_tree_face(pair->tree, i),
                                 *b = exchange_tree_face(pair->tree, j);
            double reach = (p->radius[i] + p->radius[j]) * pair->near
                           * (a->vertices == 3 || b->vertices == 3 ? EXCHANGE_LOPSIDED : 1);
            if (dot3(v, v) < reach * reach) {
                double e = p->area[i] * polygon_factor(a, b, 1);
                out[j - pair->columns.from] = e < p->area[j] ? e : p->area[j];
            }
        }
    }
}

/* A block of which no more is known than what it links. */
static double block_by_pairs(const struct exchange_pair *pair, struct exchange_scratch *scratch,
                             double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    double error, most = 0;
    for (uint32_t i = pair->rows.from; i < pair->rows.to; i++)
        for (uint32_t j = pair->columns.from; j < pair->columns.to; j++) {
            *out++ = sight_pair(r->group ? exchange_tree_face(pair->tree, i) : r,
                                s->group ? exchange_tree_face(pair->tree, j) : s, &pair->tree->host,
                                &scratch->sight, &error);
            most = fmax(most, error);
        }
    return most;
}

/* The form factor of a link. Of whole faces that see all of each other in all its digits, since the
 * link keeps those of a float; near ones have the contour integral. Else what the link holds is as
 * good as what is known of half shadow. None is made anew that the oracle had by other means. */
static double link_factor(const struct exchange_pair *pair, const struct link *link)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    int level = link->levels & 15;
    if (r->depth || s->depth || link->levels >> 4 != VISIBILITY_EXACT
        || link->visibility != LINK_VISIBLE
        || (level != FORM_FACTOR_POLYGON && level != FORM_FACTOR_CONTOUR))
        return (double)link->form_factor;
    double away[3], reach = pair->near * (r->radius + s->radius);
    sub3(away, s->centre, r->centre);
    return polygon_factor(r, s, level == FORM_FACTOR_CONTOUR || dot3(away, away) < reach * reach);
}

double exchange_block_fill(const struct exchange_faces *p, const struct exchange_pair *pair,
                           const struct link *link, struct exchange_scratch *scratch, double *out)
{
    const struct element *r = pair->receiver, *s = pair->emitter;
    struct blockers list = {.known = BLOCKERS_UNKNOWN};
    int proved = link->levels >> 4 == VISIBILITY_EXACT && link->visibility == LINK_VISIBLE;
    if (proved && !r->group && !s->group) {
        double e = r->area * link_factor(pair, link), least = fmin(r->area, s->area);
        *out = e < least ? e : least;
        return 0;
    }
    if (r->depth || s->depth || (!r->group && !s->group)) /* or a part of a face against a group */
        return block_by_pairs(pair, scratch, out);
    if (proved) {
        clear_block(p, pair, scratch, out);
        return 0;
    }
    blockers_find(r, s, &pair->tree->host, &list);
    if (list.count > BLOCKERS_MAX)
        return block_by_pairs(pair, scratch, out);
    clear_block(p, pair, scratch, out);
    shadow_block(pair, &list, &scratch->shadow, out);
    return 0;
}
