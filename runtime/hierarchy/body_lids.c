/* body_lids.c - see body_lids.h.
 *
 * Free edges go around what is missing. That may be one side, as of a leg that stands on a floor;
 * or two, of a box against a wall; or three, of a box in a corner. Then two edges that follow each
 * other lie in a plane that all of the shell is behind where they are of one side, and in none
 * where the loop goes on to another. Two sides meet along a line between corners, three in a corner
 * that no face has. Invariant: each free edge is of one lid; lids and faces close the shell.
 * [derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "hierarchy/body_lids.h"
#include "hierarchy/polygon.h"
#include "hierarchy/reach.h"
#include "kernel/constants.h"

int body_lids_supports(const struct shell *s, const double (*v)[3], int n, const double normal[3])
{
    double high = 0, low = 0, deepest = 0;
    polygon_reach(v, (uint32_t)n, v[0], normal, &high, &low);
    for (int i = 0; i < s->faces; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        polygon_reach((const double(*)[3])e->vertex, e->vertices, v[0], normal, &high, &deepest);
    }
    return high <= s->h->flat && low >= -s->h->flat && deepest < -8 * s->h->flat;
}

/* The one free edge that begins where another ends, but for rounding; NULL: none does, or more
 * than one. */
static struct free_edge *next_edge(struct shell *s, const struct free_edge *edge)
{
    struct free_edge *next = NULL;
    for (int i = 0; i < s->edges; i++) {
        double apart[3];
        sub3(apart, s->edge[i].from, edge->to);
        if (dot3(apart, apart) > s->h->flat * s->h->flat)
            continue;
        if (next)
            return NULL;
        next = &s->edge[i];
    }
    return next;
}

/* The free edges that follow each other from one on until they come back to it. Returns how many, 0
 * when they do not. */
static int go_around(struct shell *s, struct free_edge *first, struct free_edge **loop)
{
    struct free_edge *edge = first;
    int count = 0;
    do {
        if (edge->lid >= 0)
            return 0;
        edge->lid = s->lids;
        loop[count++] = edge;
        edge = next_edge(s, edge);
    } while (edge && edge != first);
    return edge ? count : 0;
}

/* One more lid: along these edges, as seen from outside, which is the other way round than their
 * faces go; then by `more` corners back. Returns 0 when that is no polygon. */
static int add_lid(struct shell *s, struct free_edge *const *along, int count,
                   const double (*corner)[3], int more)
{
    struct shell_lid *lid = &s->lid[s->lids];
    lid->n = 0;
    for (int i = count; i-- > 0; along[i]->lid = s->lids)
        memcpy(lid->corner[lid->n++], along[i]->to, sizeof lid->corner[0]);
    for (int i = 0; i < more; i++)
        memcpy(lid->corner[lid->n++], corner[i], sizeof lid->corner[0]);
    lid->around = 0;
    for (int i = 0, j = lid->n - 1; i < lid->n; j = i++) {
        double side[3];
        sub3(side, lid->corner[i], lid->corner[j]);
        lid->around += length3(side);
    }
    lid->area = polygon_normal(lid->corner, (uint32_t)lid->n, lid->normal);
    s->lids++;
    return lid->area > 0;
}

/* Do an edge and the next one lie in a plane that the shell is behind? n: its normal, outwards; not
 * said where one goes straight on. */
static int in_plane(const struct shell *s, const struct free_edge *a, const struct free_edge *b,
                    double n[3])
{
    double p[3][3], u[3], v[3], normal[3];
    sub3(u, a->to, a->from);
    sub3(v, b->to, b->from);
    cross3(normal, v, u);
    const double size = length3(normal);
    if (!(size > s->h->flat * length3(u)))
        return dot3(u, v) > 0;
    for (int k = 0; k < 3; k++)
        normal[k] /= size;
    memcpy(p[0], a->from, sizeof p[0]);
    memcpy(p[1], a->to, sizeof p[0]);
    memcpy(p[2], b->to, sizeof p[0]);
    if (!body_lids_supports(s, (const double(*)[3])p, 3, normal))
        return 0;
    memcpy(n, normal, sizeof normal);
    return 1;
}

/* Where three planes meet. Returns 0 when that is nowhere, or not behind all faces. */
static int meet(const struct shell *s, double n[3][3], const double *const at[3], double p[3])
{
    double c[3][3];
    for (int i = 0; i < 3; i++)
        cross3(c[i], n[(i + 1) % 3], n[(i + 2) % 3]);
    const double all = dot3(n[0], c[0]);
    if (!(fabs(all) > 1 - GROUP_COSINE))
        return 0;
    for (int k = 0; k < 3; k++) {
        p[k] = 0;
        for (int i = 0; i < 3; i++)
            p[k] += dot3(n[i], at[i]) * c[i][k] / all;
    }
    for (int i = 0; i < s->faces; i++) {
        const struct element *e = &s->h->elements[s->face[i]];
        if (height3(p, e->vertex[0], e->normal) > s->h->flat)
            return 0;
    }
    return 1;
}

/* Two or three lids along a loop that is not in one plane. Returns 0 when it is of no such. */
static int add_joined(struct shell *s, struct free_edge **loop, int count)
{
    struct free_edge *edge[BODY_CORNERS];
    double n[3][3] = {{0}}, any[3];
    const double *at[3];
    int from[4], lids = 0, start = 0;
    while (start < count && in_plane(s, loop[(start + count - 1) % count], loop[start], any))
        start++;
    for (int i = 0; i < count; i++)
        edge[i] = loop[(start + i) % count];
    for (int i = 0; i < count; i++) {
        if (i && in_plane(s, edge[i - 1], edge[i], n[lids - 1]))
            continue;
        if (lids == 3)
            return 0;
        at[lids] = edge[i]->from;
        from[lids++] = i;
    }
    from[lids] = count;
    if (lids < 2 || s->lids + lids > BODY_LIDS || s->joints + lids > BODY_LIDS)
        return 0;
    for (int i = 0; i < lids; i++)
        if (!(dot3(n[i], n[i]) > 0)) /* of one line */
            return 0;
    double corner[2][3];
    if (lids == 3 && !meet(s, n, at, corner[1]))
        return 0;
    const int first = s->lids;
    for (int i = 0; i < lids; i++) {
        memcpy(corner[0], edge[from[i]]->from, sizeof corner[0]);
        if (!add_lid(s, &edge[from[i]], from[i + 1] - from[i], (const double(*)[3])corner,
                     lids - 1))
            return 0;
    }
    for (int i = 0; i < (lids == 2 ? 1 : 3); i++) {
        const struct shell_lid *lid = &s->lid[first + i];
        struct lid_joint *joint = &s->joint[s->joints++];
        memcpy(joint->from, lid->corner[lid->n - 1], sizeof joint->from);
        memcpy(joint->to, lid->corner[0], sizeof joint->to);
        joint->left = first + i;
        joint->right = first + (i + 1) % lids;
    }
    return 1;
}

int body_lids_find(struct shell *s)
{
    struct free_edge *loop[BODY_CORNERS];
    s->lids = s->joints = 0;
    for (int i = 0; i < s->edges; i++) {
        if (s->edge[i].lid >= 0)
            continue;
        if (s->lids == BODY_LIDS)
            return 0;
        const int count = go_around(s, &s->edge[i], loop);
        if (count == 0 || !add_lid(s, loop, count, NULL, 0))
            return 0;
        const struct shell_lid *lid = &s->lid[s->lids - 1];
        double high = 0, low = 0;
        polygon_reach((const double(*)[3])lid->corner, (uint32_t)lid->n, lid->corner[0],
                      lid->normal, &high, &low);
        if (high <= s->h->flat && low >= -s->h->flat)
            continue;
        s->lids--;
        if (!add_joined(s, loop, count))
            return 0;
    }
    return 1;
}
