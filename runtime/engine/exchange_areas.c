/* factor_matrix.c - from links to the exchange areas of all pairs of faces.
 *
 * A link of two groups stands for a block of pairs. Each gets its own exchange area, by the kernel and its second derivatives at
 * the centroids, weighted with both faces' second moments:
 *     pi E_ij / A_i A_j = k + Q : grad grad k / 2,   k = (n.r)(m.r) / s^2,   s = r.r,   Q = M_i + M_j,
 *     = ab/s^2 + ab (12 r.Qr / s^4 - 2 tr Q / s^3) - 4 (a m.M_i r + b n.M_j r) / s^3,   a = n.r, b = m.r,
 * n the normal of i, m that of j turned round, r from i to j; n M_i = 0 and m M_j = 0 because faces are flat. What it leaves
 * out is of fourth order. Pairs nearer than so many radii, by the tolerance, have the contour integral (kernel/polygon_factor.h).
 *
 * In half shadow each pair is seen from points of its one face, past the blockers of the whole group: their shadows
 * on the other group's plane are cast once per point and taken from all its faces (kernel/outline.h). Where more stand between than
 * a list holds, and where a part of a face is linked to a group, each pair is looked into by itself.
 *
 * Invariant: one value per pair serves both rows, so A_i F_ij = A_j F_ji to rounding; no value is above the smaller area.
 * [moments: Taylor's formula for Lambert's kernel, derived here; shadows: kernel/outline.h]
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "engine/exchange_areas.h"
#include "kernel/outline_visibility.h"
#include "kernel/polygon_factor.h"
#include "terms/blockers.h"
#include "terms/visibility.h"
#include "tools/group_level.h"

enum { MOMENTS = 6 }; /* xx yy zz xy xz yz */

/* Blocks are no larger, so that a column's values are in the cache while its neighbours' rows are written. */
enum { TILE = 64 };

/* The faces, as the kernel wants them: [faces] each, in the tree's order. */
struct points {
    double *c[3], *area, *radius, *moment[MOMENTS];
    double *all;
};

/* One thread's room for the shadows on a group: [most]. */
struct cell {
    struct outline_sum whole;
    double middle[2], half[2], p[4][2];
    int n;
};

/* How often a face was found wholly hidden and wholly seen, and what of it was seen. */
struct sight {
    int hidden, clear;
    double part[OUTLINE_FEW], at[OUTLINE_FEW][2]; /* of its area; the centroid */
};

struct room {
    struct cell *cells;
    struct sight *sights;
    double *shift[3]; /* M_j n for the faces j of a row */
};

static const struct element *face_at(const struct factor_tree *t, uint32_t place)
{
    return &t->h.elements[t->h.face_element[t->h.order[place]]];
}

static int points_open(struct points *p, const struct factor_tree *t)
{
    uint32_t n = t->h.face_count, i;
    int k, v;
    p->all = malloc((5 + MOMENTS) * (size_t)n * sizeof *p->all);
    if (!p->all)
        return -1;
    for (k = 0; k < 3; k++)
        p->c[k] = p->all + (size_t)k * n;
    p->area = p->all + 3 * (size_t)n;
    p->radius = p->all + 4 * (size_t)n;
    for (k = 0; k < MOMENTS; k++)
        p->moment[k] = p->all + (size_t)(5 + k) * n;
    for (i = 0; i < n; i++) {
        const struct element *e = face_at(t, i);
        double moment[MOMENTS] = { 0 };
        for (v = 2; v < e->vertices; v++) { /* triangle by triangle: (1/12) sum d d over its corners, and its own centroid's */
            const double *corner[3] = { e->vertex[0], e->vertex[v - 1], e->vertex[v] };
            double a[3], b[3], c[3], middle[3], share;
            int j;
            sub3(a, corner[1], corner[0]);
            sub3(b, corner[2], corner[0]);
            cross3(c, a, b);
            share = 0.5 * dot3(c, e->normal) / e->area;
            for (k = 0; k < 3; k++)
                middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) * (1 / 3.0);
            for (j = 0; j < 4; j++) {
                double d[3], w = share * (j < 3 ? 1 / 12.0 : 1);
                if (j < 3)
                    sub3(d, corner[j], middle);
                else
                    sub3(d, middle, e->centre);
                for (k = 0; k < 3; k++)
                    moment[k] += w * d[k] * d[k];
                moment[3] += w * d[0] * d[1];
                moment[4] += w * d[0] * d[2];
                moment[5] += w * d[1] * d[2];
            }
        }
        for (k = 0; k < 3; k++)
            p->c[k][i] = e->centre[k];
        p->area[i] = e->area;
        p->radius[i] = e->radius;
        for (k = 0; k < MOMENTS; k++)
            p->moment[k][i] = moment[k];
    }
    return 0;
}

static void times(const struct points *p, uint32_t i, const double v[3], double out[3])
{
    out[0] = p->moment[0][i] * v[0] + p->moment[3][i] * v[1] + p->moment[4][i] * v[2];
    out[1] = p->moment[3][i] * v[0] + p->moment[1][i] * v[1] + p->moment[5][i] * v[2];
    out[2] = p->moment[4][i] * v[0] + p->moment[5][i] * v[1] + p->moment[2][i] * v[2];
}

/* M_j n for every face of a range. */
static void shifts(const struct points *p, struct face_range range, const double n[3], struct room *room)
{
    uint32_t j;
    int k;
    for (j = range.from; j < range.to; j++) {
        double shift[3];
        times(p, j, n, shift);
        for (k = 0; k < 3; k++)
            room->shift[k][j - range.from] = shift[k];
    }
}

/* The exchange areas of face i, normal n, with the faces of a range, normal -m. */
static void exchange_row(const struct points *p, uint32_t i, const double n[3], struct face_range range, const double m[3],
                         const struct room *room, double *restrict out)
{
    const double *restrict x = p->c[0] + range.from, *restrict y = p->c[1] + range.from, *restrict z = p->c[2] + range.from;
    const double *restrict area = p->area + range.from, *restrict xx = p->moment[0] + range.from, *restrict yy = p->moment[1] + range.from,
                 *restrict zz = p->moment[2] + range.from, *restrict xy = p->moment[3] + range.from, *restrict xz = p->moment[4] + range.from,
                 *restrict yz = p->moment[5] + range.from;
    const double *restrict sx = room->shift[0], *restrict sy = room->shift[1], *restrict sz = room->shift[2];
    const double cx = p->c[0][i], cy = p->c[1][i], cz = p->c[2][i], ai = p->area[i] * (1 / POLYGON_FACTOR_PI);
    const double ixx = p->moment[0][i], iyy = p->moment[1][i], izz = p->moment[2][i], ixy = p->moment[3][i], ixz = p->moment[4][i],
                 iyz = p->moment[5][i], n0 = n[0], n1 = n[1], n2 = n[2], m0 = m[0], m1 = m[1], m2 = m[2];
    double own[3];
    int count = (int)(range.to - range.from), j;
    times(p, i, m, own);
#pragma omp simd
    for (j = 0; j < count; j++) {
        double r0 = x[j] - cx, r1 = y[j] - cy, r2 = z[j] - cz;
        double qxx = xx[j] + ixx, qyy = yy[j] + iyy, qzz = zz[j] + izz, qxy = xy[j] + ixy, qxz = xz[j] + ixz, qyz = yz[j] + iyz;
        double a = n0 * r0 + n1 * r1 + n2 * r2, b = m0 * r0 + m1 * r1 + m2 * r2;
        double t = 1 / (r0 * r0 + r1 * r1 + r2 * r2);
        double quad = qxx * r0 * r0 + qyy * r1 * r1 + qzz * r2 * r2 + 2 * (qxy * r0 * r1 + qxz * r0 * r2 + qyz * r1 * r2);
        double skew = a * (own[0] * r0 + own[1] * r1 + own[2] * r2) + b * (sx[j] * r0 + sy[j] * r1 + sz[j] * r2);
        double k = t * t * (a * b * (1 + t * (12 * t * quad - 2 * (qxx + qyy + qzz))) - 4 * t * skew);
        double e = ai * area[j] * k, least = p->area[i] < area[j] ? p->area[i] : area[j];
        out[j] = e > 0 ? e < least ? e : least : 0;
    }
}

static void turned(const double n[3], double m[3])
{
    int k;
    for (k = 0; k < 3; k++)
        m[k] = -n[k];
}

/* A block as if all of its pairs saw each other. */
static void clear_block(const struct factor_matrix *f, const struct points *p, const struct element *r, const struct element *s,
                        struct face_range rows, struct face_range columns, struct room *room, double *out)
{
    double m[3], away[3], square;
    uint32_t i, j;
    int near;
    turned(s->normal, m);
    shifts(p, columns, r->normal, room);
    sub3(away, s->centre, r->centre);
    square = length3(away) - r->radius - s->radius; /* a group's radius is above its faces' */
    near = square < f->near * 2 * (r->radius > s->radius ? r->radius : s->radius);
    for (i = rows.from; i < rows.to; i++, out += columns.to - columns.from) {
        exchange_row(p, i, r->normal, columns, m, room, out);
        for (j = columns.from; near && j < columns.to; j++) {
            double v[3] = { p->c[0][j] - p->c[0][i], p->c[1][j] - p->c[1][i], p->c[2][j] - p->c[2][i] };
            double reach = f->near * (p->radius[i] + p->radius[j]);
            if (dot3(v, v) < reach * reach) {
                double e = p->area[i] * polygon_factor(face_at(f->tree, i), face_at(f->tree, j), 1);
                out[j - columns.from] = e < p->area[j] ? e : p->area[j];
            }
        }
    }
}

static void make_cells(const struct factor_tree *t, struct face_range range, const struct outline_frame *frame, struct room *room)
{
    uint32_t i;
    int v, k;
    for (i = range.from; i < range.to; i++) {
        const struct element *e = face_at(t, i);
        struct cell *c = &room->cells[i - range.from];
        double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
        struct outline_cell cell;
        cell.n = c->n = e->vertices;
        for (v = 0; v < c->n; v++) {
            outline_in(frame, e->vertex[v], c->p[v]);
            for (k = 0; k < 2; k++) {
                cell.p[v][k] = c->p[v][k];
                low[k] = c->p[v][k] < low[k] ? c->p[v][k] : low[k];
                high[k] = c->p[v][k] > high[k] ? c->p[v][k] : high[k];
            }
        }
        memset(&c->whole, 0, sizeof c->whole);
        outline_add(&c->whole, &cell);
        for (k = 0; k < 2; k++) {
            c->middle[k] = 0.5 * (low[k] + high[k]);
            c->half[k] = 0.5 * (high[k] - low[k]);
        }
    }
}

/* What point k of a face sees of the cells past the shadows that touch their group's box. */
static void look(const struct outline *shadows, int count, int k, const struct cell *cells, uint32_t n, struct sight *sights)
{
    uint32_t j;
    int s;
    for (j = 0; j < n; j++) {
        const struct cell *c = &cells[j];
        struct sight *to = &sights[j];
        struct outline_cell cell;
        struct outline_sum seen;
        int touched = 0, side = -1, v;
        for (s = 0; s < count && side < 1; s++) {
            side = outline_box(&shadows[s], c->middle, c->half);
            touched |= side == 0;
        }
        to->part[k] = side == 1 ? 0 : c->whole.area;
        side = side == 1 ? 0 : touched ? 1 : 2;
        if (side == 1) {
            cell.n = c->n;
            for (v = 0; v < c->n; v++) {
                cell.p[v][0] = c->p[v][0];
                cell.p[v][1] = c->p[v][1];
            }
            side = outline_seen(shadows, count, &cell, &c->whole, &seen);
            to->part[k] = seen.area;
            if (side == 1) {
                to->at[k][0] = seen.at[0] / seen.area;
                to->at[k][1] = seen.at[1] / seen.area;
                continue;
            }
        }
        to->hidden += side == 0;
        to->clear += side == 2;
        to->at[k][0] = c->whole.at[0] / c->whole.area;
        to->at[k][1] = c->whole.at[1] / c->whole.area;
    }
}

/* The seen share of what the points exchange with a cell. */
static double seen_share(const struct sight *sight, const struct cell *c, const double (*x)[3], const double *weight, const double n[3],
                         const struct outline_frame *frame)
{
    double seen = 0, all = 0, uv[2], y[3];
    int k;
    for (k = 0; k < OUTLINE_FEW; k++) {
        uv[0] = c->whole.at[0] / c->whole.area;
        uv[1] = c->whole.at[1] / c->whole.area;
        outline_out(frame, uv, y);
        all += weight[k] * c->whole.area * outline_kernel(x[k], n, y, frame->n, 0);
        outline_out(frame, sight->at[k], y);
        seen += weight[k] * sight->part[k] * outline_kernel(x[k], n, y, frame->n, 0);
    }
    return !(seen > 0) ? 0 : seen < all ? seen / all : 1;
}

/* How large a face of the group looks from the nearest blocker: seen from another point of it, shadows move by so much. */
static double seen_from(const struct element *e, struct face_range range, const struct factor_tree *t, const struct blockers *list)
{
    double least = INFINITY;
    int b;
    for (b = 0; b < list->count; b++) {
        const struct element *blocker = &t->h.elements[list->face[b]];
        least = fmin(least, polygon_distance(e->centre, (const double (*)[3])blocker->vertex, blocker->vertices, blocker->normal));
    }
    return sqrt(e->area / (range.to - range.from)) / (least + e->radius);
}

/* A block whose pairs stand in each other's half shadow: first as if clear, then each value times what its pair sees. The
 * points are on the side where a face's size matters less. */
static void shaded_block(const struct factor_matrix *f, const struct points *p, const struct element *r, const struct element *s,
                         struct face_range rows, struct face_range columns, const struct blockers *list, struct room *room, double *out)
{
    const struct factor_tree *t = f->tree;
    uint32_t across = columns.to - columns.from, n, i, j;
    int swap = seen_from(s, columns, t, list) < seen_from(r, rows, t, list);
    const struct element *from = swap ? s : r, *to = swap ? r : s;
    struct face_range points_at = swap ? columns : rows, cells_at = swap ? rows : columns;
    size_t step_i = swap ? 1 : across, step_j = swap ? across : 1;
    struct outline_frame frame;
    struct polygon blocker[BLOCKERS_MAX];
    double group[2][2] = { { INFINITY, INFINITY }, { -INFINITY, -INFINITY } }, middle[2], half[2];
    int k, b;
    clear_block(f, p, r, s, rows, columns, room, out);
    outline_frame_of(&frame, to, t->host.ray_offset);
    make_cells(t, cells_at, &frame, room);
    n = cells_at.to - cells_at.from;
    for (j = 0; j < n; j++)
        for (k = 0; k < 2; k++) {
            const struct cell *c = &room->cells[j];
            group[0][k] = fmin(group[0][k], c->middle[k] - c->half[k]);
            group[1][k] = fmax(group[1][k], c->middle[k] + c->half[k]);
        }
    for (k = 0; k < 2; k++) {
        middle[k] = 0.5 * (group[0][k] + group[1][k]);
        half[k] = 0.5 * (group[1][k] - group[0][k]);
    }
    for (b = 0; b < list->count; b++)
        t->host.corners(&t->host, list->face[b], &blocker[b]);
    for (i = points_at.from; i < points_at.to; i++) {
        const struct element *e = face_at(t, i);
        double x[OUTLINE_FEW][3], weight[OUTLINE_FEW];
        int clear = 0;
        outline_points(e, t->host.ray_offset, OUTLINE_FEW, x, weight);
        for (j = 0; j < n; j++)
            room->sights[j].hidden = room->sights[j].clear = 0;
        for (k = 0; k < OUTLINE_FEW; k++) {
            struct outline shadows[BLOCKERS_MAX];
            double height = height3(x[k], frame.origin, frame.n);
            int count = 0, all = 0;
            for (b = 0; b < list->count && !all; b++)
                if (outline_cast(&shadows[count], &frame, x[k], height, (const double (*)[3])blocker[b].v, blocker[b].n)) {
                    int side = outline_box(&shadows[count], middle, half);
                    all = side == 1;
                    count += side == 0;
                }
            if (all) {
                for (j = 0; j < n; j++) {
                    room->sights[j].hidden++;
                    room->sights[j].part[k] = room->sights[j].at[k][0] = room->sights[j].at[k][1] = 0;
                }
            } else {
                clear += count == 0;
                look(shadows, count, k, room->cells, n, room->sights);
            }
        }
        if (clear == OUTLINE_FEW)
            continue;
        for (j = 0; j < n; j++) {
            const struct sight *sight = &room->sights[j];
            double *value = &out[(i - points_at.from) * step_i + j * step_j];
            if (sight->hidden == OUTLINE_FEW)
                *value = 0;
            else if (sight->clear != OUTLINE_FEW)
                *value *= seen_share(sight, &room->cells[j], (const double (*)[3])x, weight, from->normal, &frame);
        }
    }
}

/* The exchange area of two faces or parts, looked into by itself. Rays where too many stand between, as the graphs do. */
static double pair_exchange(const struct element *r, const struct element *s, const struct host *host)
{
    double e = r->area * polygon_factor(r, s, 1), least = r->area < s->area ? r->area : s->area;
    struct blockers list = { .known = BLOCKERS_UNKNOWN };
    if (!(e > 0))
        return 0;
    blockers_find(r, s, host, &list);
    if (list.covered)
        return 0;
    if (list.count > BLOCKERS_MAX)
        e *= visibility_rays(r, s, host, visibility_rays_of(VISIBILITY_RAYS_64));
    else if (list.count > 0)
        e *= outline_visibility(r, s, host, &list);
    return e < least ? e : least;
}

/* A block of which no more is known than what it links. */
static void pair_block(const struct factor_matrix *f, const struct element *r, const struct element *s, struct face_range rows,
                       struct face_range columns, double *out)
{
    uint32_t i, j;
    for (i = rows.from; i < rows.to; i++)
        for (j = columns.from; j < columns.to; j++)
            *out++ = pair_exchange(group_level_group(r) ? face_at(f->tree, i) : r, group_level_group(s) ? face_at(f->tree, j) : s, &f->tree->host);
}

/* What the link says of its pairs. */
static void fill_block(const struct factor_matrix *m, const struct points *p, const struct link *link, const struct factor_block *block,
                       struct room *room)
{
    const struct factor_tree *t = m->tree;
    const struct element *r = &t->h.elements[link->receiver], *s = &t->h.elements[link->emitter];
    struct face_range rows = { block->row, block->row + block->rows }, columns = { block->column, block->column + block->columns };
    double *out = m->values + block->at;
    struct blockers list;
    if (!group_level_group(r) && !group_level_group(s)) {
        double e = r->area * (double)link->form_factor * (link->visibility * (1.0 / LINK_VISIBLE)), least = r->area < s->area ? r->area : s->area;
        *out = e < least ? e : least;
        return;
    }
    if (r->depth || s->depth) { /* a part of a face against a group */
        pair_block(m, r, s, rows, columns, out);
        return;
    }
    if (link->levels >> 4 == VISIBILITY_EXACT && link->visibility == LINK_VISIBLE) {
        clear_block(m, p, r, s, rows, columns, room, out);
        return;
    }
    list.known = BLOCKERS_UNKNOWN;
    blockers_find(r, s, &t->host, &list);
    if (list.count > BLOCKERS_MAX)
        pair_block(m, r, s, rows, columns, out);
    else
        shaded_block(m, p, r, s, rows, columns, &list, room, out);
}

/* ---- */

static int room_open(struct room *room, uint32_t most)
{
    room->cells = malloc(most * sizeof *room->cells);
    room->sights = malloc(most * sizeof *room->sights);
    room->shift[0] = malloc(3 * (size_t)most * sizeof **room->shift);
    if (!room->cells || !room->sights || !room->shift[0])
        return -1;
    room->shift[1] = room->shift[0] + most;
    room->shift[2] = room->shift[1] + most;
    return 0;
}

static void room_close(struct room *room)
{
    free(room->cells);
    free(room->sights);
    free(room->shift[0]);
}

/* One of the two links between the same two elements: the one whose receiver stands later in the tree's order. */
static int counts(const struct factor_tree *t, const struct link *link)
{
    return factor_tree_range(t, link->receiver).from > factor_tree_range(t, link->emitter).from;
}

/* The blocks of a link, with the link that each is of; NULL: count them only. */
static void add_tiles(struct factor_matrix *m, const struct link *link, const struct link **links)
{
    struct face_range r = factor_tree_range(m->tree, link->receiver), s = factor_tree_range(m->tree, link->emitter);
    uint32_t i, j;
    for (i = r.from; i < r.to; i += TILE)
        for (j = s.from; j < s.to; j += TILE) {
            struct factor_block b = { i, r.to - i < TILE ? r.to - i : TILE, j, s.to - j < TILE ? s.to - j : TILE, m->value_count };
            if (links) {
                m->blocks[m->block_count] = b;
                links[m->block_count] = link;
            }
            m->block_count++;
            m->value_count += (size_t)b.rows * b.columns;
        }
}

static int fill(struct factor_matrix *m, const struct link **links, uint32_t most, int threads)
{
    struct points p;
    int failed = 0;
    if (points_open(&p, m->tree) < 0)
        return -1;
#pragma omp parallel num_threads(threads) reduction(| : failed)
    {
        struct room room = { NULL, NULL, { NULL, NULL, NULL } };
        size_t i;
        failed |= room_open(&room, most) < 0;
#pragma omp for schedule(dynamic, 32)
        for (i = 0; i < m->block_count; i++)
            if (!failed)
                fill_block(m, &p, links[i], &m->blocks[i], &room);
        room_close(&room);
    }
    free(p.all);
    return failed ? -1 : 0;
}

/* Which blocks hold a place. */
static int make_index(struct factor_matrix *m)
{
    size_t i;
    uint32_t k;
    m->entry = calloc(m->faces + 2, sizeof *m->entry);
    if (!m->entry)
        return -1;
    for (i = 0; i < m->block_count; i++) {
        const struct factor_block *b = &m->blocks[i];
        for (k = 0; k < b->rows; k++)
            m->entry[b->row + k + 2]++;
        for (k = 0; k < b->columns; k++)
            m->entry[b->column + k + 2]++;
    }
    for (k = 2; k < m->faces + 2; k++)
        m->entry[k] += m->entry[k - 1];
    m->index = malloc((m->entry[m->faces + 1] + 1) * sizeof *m->index);
    if (!m->index)
        return -1;
    for (i = 0; i < m->block_count; i++) {
        const struct factor_block *b = &m->blocks[i];
        for (k = 0; k < b->rows; k++)
            m->index[m->entry[b->row + k + 1]++] = (uint32_t)(2 * i);
        for (k = 0; k < b->columns; k++)
            m->index[m->entry[b->column + k + 1]++] = (uint32_t)(2 * i + 1);
    }
    return 0;
}

static int name_rows(struct factor_matrix *m, const struct scene *scene)
{
    uint32_t p;
    m->input = malloc(m->faces * sizeof *m->input);
    m->area = calloc(m->inputs + 1, sizeof *m->area);
    m->first = malloc((m->inputs + 1) * sizeof *m->first);
    m->next = malloc(m->faces * sizeof *m->next);
    if (!m->input || !m->area || !m->first || !m->next)
        return -1;
    memset(m->first, 0xff, (m->inputs + 1) * sizeof *m->first);
    for (p = m->faces; p-- > 0;) {
        uint32_t face = m->tree->h.order[p], i = scene->faces[face].input;
        m->input[p] = i;
        m->next[p] = m->first[i];
        m->distinct &= m->first[i] == UINT32_MAX;
        m->first[i] = p;
        m->area[i] += m->tree->h.elements[m->tree->h.face_element[face]].area;
    }
    return 0;
}

int factor_matrix_open(struct factor_matrix *m, const struct factor_tree *tree, const struct scene *scene,
                       const struct refinement *refinement, double near, int threads)
{
    const struct link **links;
    size_t i;
    memset(m, 0, sizeof *m);
    m->tree = tree;
    m->near = near;
    m->faces = tree->h.face_count;
    m->inputs = scene->input_count;
    m->distinct = 1;
    for (i = 0; i < refinement->link_count; i++)
        if (counts(tree, &refinement->links[i]))
            add_tiles(m, &refinement->links[i], NULL);
    links = malloc((m->block_count + 1) * sizeof *links);
    m->blocks = malloc((m->block_count + 1) * sizeof *m->blocks);
    if (!links || !m->blocks || m->block_count > UINT32_MAX / 2 || name_rows(m, scene) < 0)
        goto fail;
    m->block_count = m->value_count = 0;
    for (i = 0; i < refinement->link_count; i++)
        if (counts(tree, &refinement->links[i])) {
            m->link_count++;
            add_tiles(m, &refinement->links[i], links);
            m->distinct &= refinement->links[i].receiver < tree->h.built && refinement->links[i].emitter < tree->h.built;
        }
    m->values = malloc((m->value_count + 1) * sizeof *m->values);
    if (!m->values || make_index(m) < 0 || fill(m, links, TILE, threads) < 0)
        goto fail;
    free(links);
    return 0;
fail:
    free(links);
    factor_matrix_close(m);
    return -1;
}

void factor_matrix_close(struct factor_matrix *m)
{
    free(m->input);
    free(m->area);
    free(m->first);
    free(m->next);
    free(m->blocks);
    free(m->values);
    free(m->entry);
    free(m->index);
    memset(m, 0, sizeof *m);
}

double factor_matrix_row(const struct factor_matrix *m, uint32_t i, const double *scale, double *row)
{
    double sum = 0, own = scale ? scale[i] : 1;
    uint32_t p, k;
    size_t at;
    for (p = m->first[i]; p != UINT32_MAX; p = m->next[p])
        for (at = m->entry[p]; at < m->entry[p + 1]; at++) {
            const struct factor_block *b = &m->blocks[m->index[at] / 2];
            int column = m->index[at] & 1;
            const double *v = m->values + b->at + (column ? p - b->column : (size_t)(p - b->row) * b->columns);
            uint32_t n = column ? b->rows : b->columns, step = column ? b->columns : 1;
            const uint32_t *input = m->input + (column ? b->row : b->column);
            for (k = 0; k < n; k++, v += step) {
                double e = scale ? *v * (own * scale[input[k]]) : *v;
                row[input[k]] += e;
                sum += e;
            }
        }
    return sum;
}

void factor_matrix_sums(const struct factor_matrix *m, const double *scale, double *sums)
{
    double column[TILE], times_row[TILE], times_column[TILE];
    size_t b;
    uint32_t i, j;
    memset(sums, 0, m->inputs * sizeof *sums);
    for (b = 0; b < m->block_count; b++) {
        const struct factor_block *block = &m->blocks[b];
        const double *v = m->values + block->at;
        for (i = 0; i < block->rows; i++)
            times_row[i] = scale ? scale[m->input[block->row + i]] : 1;
        for (j = 0; j < block->columns; j++) {
            times_column[j] = scale ? scale[m->input[block->column + j]] : 1;
            column[j] = 0;
        }
        for (i = 0; i < block->rows; i++, v += block->columns) {
            double sum = 0, own = times_row[i];
#pragma omp simd reduction(+ : sum)
            for (j = 0; j < block->columns; j++) {
                sum += v[j] * times_column[j];
                column[j] += v[j] * own;
            }
            sums[m->input[block->row + i]] += sum;
        }
        for (j = 0; j < block->columns; j++)
            sums[m->input[block->column + j]] += column[j];
    }
}
