/* cut_faces.c - see cut_faces.h.
 *
 * A wall that stands in the middle of a floor divides it in two that share no light. Refinement halves faces at midpoints
 * and never quite comes to the wall: there are always parts on both sides of it, and light leaks along them.
 * So the floor is cut at the wall before anything is built on it, as discontinuity meshing does with the
 * discontinuities of degree 0 [Heckbert 1992; Lischinski, Tampieri and Greenberg 1992].
 *
 * A contact is the segment in which another face meets or crosses a face's plane. Contacts on one line are taken
 * together. A part of the face is cut along the whole of a line when contacts cover at least half of the line's chord
 * in it: so a wall with a door cuts, the leg of a table does not. The parts are looked at again, for their chords are
 * shorter; the longest covered chord is first, so that the limit on parts leaves out the shortest.
 *
 * Invariants: parts are convex, have 3 or 4 corners, the face's orientation, and its area in sum; contacts are those of the
 * faces as they were given, so neither the order of the faces decides anything nor who cuts which; all tolerances are relative to the face that is
 * cut, and lengths times 2^k give the same cuts; a far side is cut like its front and stays behind it.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/cut_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <omp.h>

#include "hierarchy/bvh.h"
#include "geometry.h"
#include "hierarchy/polygon.h"

enum { FEW = 2048 }; /* faces for which one thread does */
enum { PARTS = 256, CORNERS = 12 }; /* of one face at the most, before polygons become quads; of one part */

static const double TOUCH = 1e-4;     /* of the size: nearer than that to a plane is in it */
static const double ROUNDINGS = 4;    /* of the largest coordinate: what is no nearer than its precision can say */
static const double SAME_LINE = 1e-4; /* radians, and of the size: lines that near are one */
static const double SLIVER = 1e-4;    /* of the size: no cut leaves less than that on a side */
static const double CORNER = 1e-5;    /* of the size: a cut that near to a corner goes through it */
static const double FLAT = 0.01;      /* sine between planes below which there is no line to speak of */
static const double COVER = 0.5;

struct contact {
    double angle, offset; /* of its line: direction about the normal, distance from the centre */
    double from, to;      /* along the direction */
    uint32_t face;
};

struct line {
    double direction[3], across[3]; /* unit vectors in the face's plane */
    double offset;
    uint32_t first, count; /* its contacts, disjoint and in order */
};

struct part {
    double vertex[CORNERS][3];
    uint32_t n, line; /* the line it is best cut along */
    double covered;   /* length of contacts there; 0: it is not to be cut */
};

/* Of a part: what becomes a face. */
struct piece {
    uint32_t corner[4], n;
};

/* Where the parts of a face that was cut stand, in some cutter's list. */
struct cutting {
    uint32_t face;
    uint32_t first, count;
    const struct cutter *by;
};

/* One thread's. */
struct cutter {
    const struct scene *scene;
    const struct face *faces;
    const struct cluster_tree *tree;
    struct cutting *cuttings; /* [cutting_count] */
    uint32_t cutting_count, cutting_capacity;
    struct contact *contacts; /* of the face at hand */
    struct line *lines;
    uint32_t contact_count, contact_capacity, line_count, line_capacity;
    struct face *out; /* [out_count]: parts of faces that were cut */
    uint32_t out_count, out_capacity;
    /* The face at hand, with a frame in its plane. */
    uint32_t face;
    int two_sided;
    double size, touch, centre[3], normal[3], u[3], v[3], low[3], high[3];
};

/* Room for one more; 0 when there is none. */
static int room(void **array, uint32_t count, uint32_t *capacity, size_t size)
{
    uint32_t more = *capacity < 64 ? 64 : *capacity > UINT32_MAX / 2 ? UINT32_MAX : *capacity * 2;
    void *larger = *array;
    if (count < *capacity)
        return 1;
    if (count < more)
        larger = realloc(*array, more * size);
    if (count == more || !larger)
        return 0;
    *array = larger;
    *capacity = more;
    return 1;
}

static int is_pair(const struct scene *s, uint32_t front)
{
    const struct face *f = &s->faces[front];
    return !f->back && front + 1 < s->face_count && f[1].back && f[1].input == f->input && f[1].vertices == f->vertices;
}

/* Make face i the one at hand. Returns 0 when it is no area to cut. */
static int take(struct cutter *c, uint32_t i)
{
    struct face f = c->faces[i];
    double largest = 0, longest = 0;
    uint32_t j;
    int k;
    if (polygon_degenerate(f.vertex, f.vertices, c->scene->precision))
        return 0;
    c->face = i;
    c->two_sided = is_pair(c->scene, i);
    c->size = polygon_size(f.vertex, f.vertices);
    polygon_normal(f.vertex, f.vertices, c->normal);
    for (k = 0; k < 3; k++) {
        c->centre[k] = 0;
        c->low[k] = INFINITY;
        c->high[k] = -INFINITY;
        for (j = 0; j < f.vertices; j++) {
            c->centre[k] += f.vertex[j][k] / f.vertices;
            c->low[k] = fmin(c->low[k], f.vertex[j][k]);
            c->high[k] = fmax(c->high[k], f.vertex[j][k]);
            largest = fmax(largest, fabs(f.vertex[j][k]));
        }
    }
    c->touch = fmax(TOUCH * c->size, ROUNDINGS * c->scene->precision * largest);
    for (j = 0; j < f.vertices; j++) {
        double e[3], length;
        sub3(e, f.vertex[(j + 1) % f.vertices], f.vertex[j]);
        length = length3(e);
        if (length > longest + c->touch || !j) {
            longest = length;
            for (k = 0; k < 3; k++)
                c->u[k] = e[k] / length;
        }
    }
    cross3(c->v, c->normal, c->u);
    return longest > 0;
}

static double along(const struct cutter *c, const double p[3], const double direction[3])
{
    double d[3];
    sub3(d, p, c->centre);
    return dot3(d, direction);
}

/* Does a line leave more than a sliver of the polygon on both sides? */
static int inside(const struct cutter *c, const double (*v)[3], uint32_t n, const double across[3], double offset)
{
    double low = INFINITY, high = -INFINITY;
    uint32_t i;
    for (i = 0; i < n; i++) {
        double h = along(c, v[i], across) - offset;
        low = fmin(low, h);
        high = fmax(high, h);
    }
    return low < -SLIVER * c->size && high > SLIVER * c->size;
}

/* The contact of face `a` with the face at hand. Returns 1 when there is one, its line inside. */
static int touches(const struct cutter *c, uint32_t a, struct contact *found)
{
    const struct face *f = &c->faces[a], *b = &c->faces[c->face];
    double h[4], normal[3], direction[3], across[3], corner[4][3], point[8][3], sine, angle, low = INFINITY, high = -INFINITY;
    uint32_t i, points = 0;
    int k, from = 0, to = 0;
    for (i = 0; i < f->vertices; i++) {
        h[i] = along(c, f->vertex[i], c->normal);
        if (fabs(h[i]) <= c->touch)
            h[i] = 0;
        low = fmin(low, h[i]);
        high = fmax(high, h[i]);
    }
    /* What lies behind a face that has no far side takes no light from it. */
    if (low > 0 || high < 0 || !(high > 0 || (c->two_sided && low < 0)))
        return 0;
    memcpy(corner, f->vertex, sizeof corner);
    polygon_normal(corner, f->vertices, normal);
    cross3(direction, c->normal, normal);
    sine = length3(direction);
    if (!(sine > FLAT))
        return 0;
    for (i = 0; i < f->vertices; i++) {
        uint32_t j = (i + 1) % f->vertices;
        if (!(h[i] < 0 || h[i] > 0))
            memcpy(point[points++], f->vertex[i], sizeof point[0]);
        if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0)) {
            for (k = 0; k < 3; k++)
                point[points][k] = f->vertex[i][k] + h[i] / (h[i] - h[j]) * (f->vertex[j][k] - f->vertex[i][k]);
            points++;
        }
    }
    if (points < 2)
        return 0;
    angle = atan2(dot3(direction, c->v), dot3(direction, c->u));
    /* A line has two directions; keep the one in [0, pi), and lines about 0 together. */
    if (angle < -SAME_LINE || angle >= 3.14159265358979323846 - SAME_LINE) {
        angle += angle < 0 ? 3.14159265358979323846 : -3.14159265358979323846;
        sine = -sine;
    }
    for (k = 0; k < 3; k++)
        direction[k] /= sine;
    cross3(across, c->normal, direction);
    for (i = 1; i < points; i++) {
        double t = along(c, point[i], direction);
        if (t < along(c, point[from], direction))
            from = (int)i;
        if (t > along(c, point[to], direction))
            to = (int)i;
    }
    *found = (struct contact){ .angle = angle, .face = a, .from = along(c, point[from], direction), .to = along(c, point[to], direction),
                               .offset = 0.5 * (along(c, point[from], across) + along(c, point[to], across)) };
    return found->to - found->from > c->touch && inside(c, b->vertex, b->vertices, across, found->offset);
}

/* Could something in this box touch the face at hand? */
static int reaches(const struct cutter *c, const double low[3], const double high[3])
{
    double height = 0, half = c->touch;
    int k;
    for (k = 0; k < 3; k++) {
        if (low[k] > c->high[k] + c->touch || high[k] < c->low[k] - c->touch)
            return 0;
        height += c->normal[k] * (0.5 * (low[k] + high[k]) - c->centre[k]);
        half += fabs(c->normal[k]) * 0.5 * (high[k] - low[k]);
    }
    return fabs(height) <= half * (1 + 1e-9);
}

/* Collect the contacts of the faces below a node whose boxes reach the face at hand: no other's, wherever it stands in the tree.
 * Returns 0, or -1 when out of memory. */
static int collect(struct cutter *c, uint32_t node)
{
    const struct cluster_node *n = &c->tree->nodes[node];
    uint32_t i, face;
    if (!reaches(c, c->tree->boxes[node].low, c->tree->boxes[node].high))
        return 0;
    for (i = 0; i < n->children; i++)
        if (collect(c, n->child + i) < 0)
            return -1;
    if (n->children)
        return 0;
    face = c->tree->order[n->from];
    if (face == c->face || c->faces[face].back)
        return 0;
    if (!room((void **)&c->contacts, c->contact_count, &c->contact_capacity, sizeof *c->contacts))
        return -1;
    c->contact_count += (uint32_t)touches(c, face, &c->contacts[c->contact_count]);
    return 0;
}

static int order(double a, double b)
{
    return (a > b) - (a < b);
}

static int by_angle(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = order(x->angle, y->angle);
    return o ? o : order(x->face, y->face);
}

static int by_offset(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = order(x->offset, y->offset);
    return o ? o : order(x->face, y->face);
}

static int by_start(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = order(x->from, y->from);
    return o ? o : order(x->face, y->face);
}

/* Contacts [first, end) lie on one line: it is the longest one's. */
static int add_line(struct cutter *c, uint32_t first, uint32_t end)
{
    struct contact *x = c->contacts, best = {.face = UINT32_MAX};
    struct line *l;
    double longest = 0;
    uint32_t i;
    int k;
    if (!room((void **)&c->lines, c->line_count, &c->line_capacity, sizeof *c->lines))
        return -1;
    qsort(x + first, end - first, sizeof *x, by_start);
    for (i = first; i < end; i++)
        longest = fmax(longest, x[i].to - x[i].from);
    for (i = first; i < end; i++)
        if (x[i].to - x[i].from >= longest - c->touch && x[i].face < best.face)
            best = x[i];
    l = &c->lines[c->line_count++];
    *l = (struct line){ .offset = best.offset, .first = first, .count = 1 };
    for (k = 0; k < 3; k++)
        l->direction[k] = cos(best.angle) * c->u[k] + sin(best.angle) * c->v[k];
    cross3(l->across, c->normal, l->direction);
    for (i = first + 1; i < end; i++) {
        struct contact *last = &x[first + l->count - 1];
        if (x[i].from <= last->to)
            last->to = fmax(last->to, x[i].to);
        else
            x[first + l->count++] = x[i];
    }
    return 0;
}

/* Sort the contacts into lines. */
static int group(struct cutter *c)
{
    struct contact *x = c->contacts;
    uint32_t n = c->contact_count, i, j, a, b;
    c->line_count = 0;
    qsort(x, n, sizeof *x, by_angle);
    for (i = 0; i < n; i = j) {
        for (j = i + 1; j < n && x[j].angle - x[j - 1].angle <= SAME_LINE; j++)
            continue;
        qsort(x + i, j - i, sizeof *x, by_offset);
        for (a = i; a < j; a = b) {
            for (b = a + 1; b < j && x[b].offset - x[b - 1].offset <= SAME_LINE * c->size; b++)
                continue;
            if (add_line(c, a, b) < 0)
                return -1;
        }
    }
    return 0;
}

/* Heights of a part's corners over a line, and the length of contacts on the line's chord, 0 when they do not cover enough. */
static double cover(const struct cutter *c, const struct part *p, const struct line *l, double h[CORNERS])
{
    double from = INFINITY, to = -INFINITY, covered = 0;
    uint32_t i;
    if (!inside(c, p->vertex, p->n, l->across, l->offset))
        return 0;
    for (i = 0; i < p->n; i++) {
        h[i] = along(c, p->vertex[i], l->across) - l->offset;
        if (fabs(h[i]) <= CORNER * c->size)
            h[i] = 0;
    }
    for (i = 0; i < p->n; i++) {
        uint32_t j = (i + 1) % p->n;
        double a = along(c, p->vertex[i], l->direction), b = along(c, p->vertex[j], l->direction), t;
        if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0))
            t = a + h[i] / (h[i] - h[j]) * (b - a);
        else if (h[i] < 0 || h[i] > 0)
            continue;
        else
            t = a;
        from = fmin(from, t);
        to = fmax(to, t);
    }
    for (i = l->first; i < l->first + l->count; i++)
        covered += fmax(0, fmin(to, c->contacts[i].to) - fmax(from, c->contacts[i].from));
    return covered > c->touch && covered >= COVER * (to - from) - c->touch ? covered : 0;
}

/* A part becomes quads and at most one triangle, cut off where the cut is shortest. Returns how many. */
static uint32_t pieces(const struct part *p, double touch, struct piece *piece)
{
    uint32_t ring[CORNERS], rest[CORNERS], n = p->n, count = 0, i, j;
    for (i = 0; i < n; i++)
        ring[i] = i;
    for (; n > 4; n -= 2) {
        uint32_t best = 0;
        double shortest = INFINITY;
        for (i = 0; i < n; i++) {
            double d[3];
            sub3(d, p->vertex[ring[i]], p->vertex[ring[(i + 3) % n]]);
            if (length3(d) < shortest - touch) {
                shortest = length3(d);
                best = i;
            }
        }
        for (j = 0; j < 4; j++)
            piece[count].corner[j] = ring[(best + j) % n];
        piece[count++].n = 4;
        for (j = 3; j <= n; j++)
            rest[j - 3] = ring[(best + j) % n];
        memcpy(ring, rest, sizeof ring);
    }
    memcpy(piece[count].corner, ring, sizeof piece->corner);
    piece[count].n = n;
    return count + 1;
}

/* Do all of a part's pieces have an area to speak of? */
static int sound(const struct cutter *c, const struct part *p)
{
    struct piece piece[CORNERS / 2];
    uint32_t count, i, j;
    if (p->n < 3)
        return 0;
    count = pieces(p, c->touch, piece);
    for (i = 0; i < count; i++) {
        double v[4][3];
        for (j = 0; j < piece[i].n; j++)
            memcpy(v[j], p->vertex[piece[i].corner[j]], sizeof v[j]);
        if (polygon_degenerate(v, piece[i].n, c->scene->precision))
            return 0;
    }
    return 1;
}

/* Cut p along a line at heights h. Returns 0 when a side would not be sound. */
static int divide(const struct cutter *c, const struct part *p, const double h[CORNERS], struct part side[2])
{
    uint32_t i;
    int k, s;
    side[0].n = side[1].n = 0;
    for (i = 0; i < p->n; i++) {
        uint32_t j = (i + 1) % p->n;
        double cut[3];
        int crosses = (h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0);
        for (k = 0; k < 3; k++)
            cut[k] = crosses ? p->vertex[i][k] + h[i] / (h[i] - h[j]) * (p->vertex[j][k] - p->vertex[i][k]) : 0;
        for (s = 0; s < 2; s++) {
            if (side[s].n + 2 > CORNERS)
                return 0;
            if (s ? h[i] <= 0 : h[i] >= 0)
                memcpy(side[s].vertex[side[s].n++], p->vertex[i], sizeof cut);
            if (crosses)
                memcpy(side[s].vertex[side[s].n++], cut, sizeof cut);
        }
    }
    return sound(c, &side[0]) && sound(c, &side[1]);
}

/* Find where to cut a part: along the line with the most contact. */
static void look(const struct cutter *c, struct part *p)
{
    struct part side[2];
    double h[CORNERS];
    uint32_t i;
    p->covered = 0;
    for (i = 0; i < c->line_count; i++) {
        double covered = cover(c, p, &c->lines[i], h);
        if (covered > p->covered + c->touch && divide(c, p, h, side)) {
            p->covered = covered;
            p->line = i;
        }
    }
}

static int emit(struct cutter *c, const struct face *like, const struct part *p, const struct piece *piece)
{
    struct face f = *like;
    int back;
    memset(f.vertex, 0, sizeof f.vertex);
    f.vertices = piece->n;
    for (back = 0; back <= c->two_sided; back++) {
        uint32_t i;
        if (!room((void **)&c->out, c->out_count, &c->out_capacity, sizeof *c->out))
            return -1;
        for (i = 0; i < piece->n; i++)
            memcpy(f.vertex[i], p->vertex[piece->corner[back ? piece->n - 1 - i : i]], sizeof f.vertex[i]);
        f.back = (uint8_t)(like->back | back);
        c->out[c->out_count++] = f;
    }
    return 0;
}

/* Cut the face at hand along its lines. Returns the number of parts, 1 when it stays whole, or -1. */
static int cut(struct cutter *c)
{
    const struct face *f = &c->faces[c->face];
    struct part part[PARTS], side[2];
    double h[CORNERS];
    uint32_t count = 1, i, best;
    memcpy(part[0].vertex, f->vertex, sizeof f->vertex);
    part[0].n = f->vertices;
    look(c, &part[0]);
    for (; count < PARTS; count++) {
        for (i = best = 0; i < count; i++)
            if (part[i].covered > part[best].covered + c->touch)
                best = i;
        if (!(part[best].covered > 0))
            break;
        cover(c, &part[best], &c->lines[part[best].line], h);
        divide(c, &part[best], h, side);
        look(c, &side[0]);
        look(c, &side[1]);
        part[best] = side[0];
        part[count] = side[1];
    }
    for (i = 0; i < count && count > 1; i++) {
        struct piece piece[CORNERS / 2];
        uint32_t n = pieces(&part[i], c->touch, piece), j;
        for (j = 0; j < n; j++)
            if (emit(c, f, &part[i], &piece[j]) < 0)
                return -1;
    }
    return (int)count;
}

/* Cut face i and its far side, where there is something to cut. Returns 0 or -1. */
static int pass(struct cutter *c, uint32_t i)
{
    uint32_t before = c->out_count;
    c->contact_count = 0;
    if (!take(c, i))
        return 0;
    if (collect(c, 0) < 0)
        return -1;
    if (c->contact_count && (group(c) < 0 || cut(c) < 0))
        return -1;
    if (c->out_count == before)
        return 0;
    if (!room((void **)&c->cuttings, c->cutting_count, &c->cutting_capacity, sizeof *c->cuttings))
        return -1;
    c->cuttings[c->cutting_count++] = (struct cutting){ i, before, c->out_count - before, c };
    return 0;
}

static int by_face(const void *a, const void *b)
{
    const struct cutting *x = a, *y = b;
    return (x->face > y->face) - (x->face < y->face);
}

/* Put the parts in the places of the faces they were cut from. */
static int replace(struct scene *scene, const struct cutter *cutters, int threads)
{
    struct cutting *all;
    struct face *faces;
    size_t cut_faces = 0, room = scene->face_count;
    uint32_t i, n = 0, next = 0;
    int t;
    for (t = 0; t < threads; t++) {
        cut_faces += cutters[t].cutting_count;
        room += cutters[t].out_count;
    }
    if (!cut_faces)
        return 0;
    all = malloc(cut_faces * sizeof *all);
    faces = room <= UINT32_MAX ? malloc(room * sizeof *faces) : NULL;
    if (!all || !faces) {
        free(all);
        free(faces);
        return -1;
    }
    for (cut_faces = 0, t = 0; t < threads; t++)
        for (i = 0; i < cutters[t].cutting_count; i++)
            all[cut_faces++] = cutters[t].cuttings[i];
    qsort(all, cut_faces, sizeof *all, by_face);
    for (i = 0; i < scene->face_count; i++) {
        const struct cutting *x = &all[next];
        if (next == cut_faces || x->face != i) {
            faces[n++] = scene->faces[i];
            continue;
        }
        memcpy(&faces[n], &x->by->out[x->first], x->count * sizeof *faces);
        n += x->count;
        scene->cut++;
        scene->parts += x->count >> is_pair(scene, i);
        i += (uint32_t)is_pair(scene, i);
        next++;
    }
    free(all);
    free(scene->faces);
    scene->faces = faces;
    scene->face_count = n;
    return 0;
}

int scene_cut(struct scene *scene, int threads)
{
    struct cluster_tree tree;
    threads = scene->face_count < FEW ? 1 : threads > 0 ? threads : omp_get_max_threads();
    int status = 0, t;
    struct cutter *cutters = calloc((size_t)threads, sizeof *cutters);
    uint32_t i;
    if (!cutters || (scene->face_count && cluster_tree_build(&tree, scene->faces, scene->face_count, CLUSTERING_SAH, threads) < 0)) {
        free(cutters);
        return -1;
    }
    for (t = 0; t < threads; t++) {
        cutters[t].scene = scene;
        cutters[t].faces = scene->faces;
        cutters[t].tree = &tree;
    }
#pragma omp parallel for schedule(dynamic, 256) num_threads(threads) reduction(| : status)
    for (i = 0; i < scene->face_count; i++)
        if (!status && !(i > 0 && is_pair(scene, i - 1)))
            status |= pass(&cutters[omp_get_thread_num()], i) < 0;
    if (!status)
        status = replace(scene, cutters, threads) < 0;
    for (t = 0; t < threads; t++) {
        free(cutters[t].contacts);
        free(cutters[t].lines);
        free(cutters[t].out);
        free(cutters[t].cuttings);
    }
    free(cutters);
    if (scene->face_count)
        cluster_tree_free(&tree);
    return status ? -1 : 0;
}
