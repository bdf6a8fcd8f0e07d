/* cut_faces.c - see cut_faces.h.
 *
 * A wall that stands in the middle of a floor divides it in two that share no light. Refinement
 * halves faces at midpoints and never quite comes to the wall: there are always parts on both sides
 * of it, and light leaks along them. So the floor is cut at the wall before anything is built on
 * it, as discontinuity meshing does with the discontinuities of degree 0 [Heckbert 1992;
 * Lischinski, Tampieri and Greenberg 1992].
 *
 * A contact is the segment in which another face meets or crosses a face's plane (cut_contacts.h).
 * Contacts on one line are taken together (cut_lines.h). A part of the face is cut along the whole
 * of a line when contacts cover at least half of the line's chord in it: so a wall with a door
 * cuts, the leg of a table does not. The parts are looked at again, for their chords are shorter;
 * the longest covered chord is first, so that the limit on parts leaves out the shortest.
 *
 * Invariants: parts are convex, have 3 or 4 corners, the face's orientation, and its area in sum;
 * contacts are those of the faces as they were given, so neither the order of the faces decides
 * anything nor who cuts which; all tolerances are relative to the face that is cut, and lengths
 * times 2^k give the same cuts; what is equal within the tolerance of contacts counts as equal, so
 * that the last bits of coordinates decide nothing; a far side is cut like its front and stays
 * behind it.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/cut_faces.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/bvh.h"
#include "hierarchy/cut_lines.h"
#include "hierarchy/polygon.h"
#include "hierarchy/replace_faces.h"
#include "kernel/constants.h"
#include "util/array.h"
#include "util/thread_pool.h"

/* of one face at the most, before polygons become quads (the floor of a house has some for each of
 * its rooms; each part looks for the longest in all lines); of one part */
enum { PARTS = 4096, CORNERS = POLYGON_CORNERS };

struct part {
    double vertex[CORNERS][3];
    uint32_t n;
    size_t line;    /* the line it is best cut along */
    double covered; /* length of contacts there (m); 0: it is not to be cut */
};

/* Where the parts of a face that was cut stand in its cutter's list. */
struct cutting {
    uint32_t face;
    size_t first, count;
};

/* One thread's. */
struct cutter {
    const struct scene *scene;
    const struct bvh *tree;
    const struct bounds *normals; /* of its nodes */
    struct cut_frame frame;       /* of the face at hand */
    struct contact_list contacts; /* its */
    struct line_list lines;
    struct part *parts; /* its */
    size_t part_capacity;
    struct cutting *cuttings; /* [cutting_count] */
    size_t cutting_count, cutting_capacity;
    struct face *out; /* [out_count]: parts of faces that were cut */
    size_t out_count, out_capacity;
};

/* Heights of a part's corners over a line (m); corners that near to it are on it. */
static void heights_over(const struct cut_frame *c, const struct part *p, const struct cut_line *l,
                         double h[CORNERS])
{
    for (uint32_t i = 0; i < p->n; i++) {
        h[i] = cut_distance(c, p->vertex[i], l->across) - l->offset;
        if (fabs(h[i]) <= CUT_CORNER * c->size)
            h[i] = 0;
    }
}

static int crosses(double a, double b)
{
    return (a < 0 && b > 0) || (a > 0 && b < 0);
}

/* The length of contacts on the line's chord in a part whose corners have these heights over it
 * (m); 0 when they do not cover enough. */
static double covered_length(const struct cutter *c, const struct part *p, const struct cut_line *l,
                             const double h[CORNERS])
{
    double from = INFINITY, to = -INFINITY, covered = 0;
    for (uint32_t i = 0; i < p->n; i++) {
        uint32_t j = (i + 1) % p->n;
        double a = cut_distance(&c->frame, p->vertex[i], l->direction), t = a;
        if (crosses(h[i], h[j]))
            t = a
                + h[i] / (h[i] - h[j]) * (cut_distance(&c->frame, p->vertex[j], l->direction) - a);
        else if (h[i] < 0 || h[i] > 0)
            continue;
        from = fmin(from, t);
        to = fmax(to, t);
    }
    for (size_t i = l->first; i < l->first + l->count; i++)
        covered += fmax(0, fmin(to, c->contacts.contacts[i].to)
                               - fmax(from, c->contacts.contacts[i].from));
    return covered > c->frame.touch && covered >= CUT_COVER * (to - from) - c->frame.touch ? covered
                                                                                           : 0;
}

/* Do all of a part's pieces have an area to speak of? */
static int has_sound_pieces(const struct cutter *c, struct part *p)
{
    if (p->n < 3)
        return 0;
    struct piece piece[CORNERS / 2];
    uint32_t count = polygon_pieces(p->vertex, p->n, c->frame.touch, piece);
    for (uint32_t i = 0; i < count; i++) {
        double v[4][3];
        for (uint32_t j = 0; j < piece[i].n; j++)
            memcpy(v[j], p->vertex[piece[i].corner[j]], sizeof v[j]);
        if (polygon_degenerate(v, piece[i].n, c->scene->precision))
            return 0;
    }
    return 1;
}

/* Cut p along a line at heights h. Returns 0 when a side would not be sound. */
static int divide(const struct cutter *c, const struct part *p, const double h[CORNERS],
                  struct part side[2])
{
    if (p->n + 1 > CORNERS)
        return 0;
    int below;
    side[0].n = (uint32_t)polygon_divide(&p->vertex[0][0], (int)p->n, 3, h, CORNERS,
                                         &side[0].vertex[0][0], &side[1].vertex[0][0], &below);
    side[1].n = (uint32_t)below;
    /* Sides begin with the first corner of p that they have, not with the crossing before it. */
    for (int q = 0; q < 2 && crosses(h[p->n - 1], h[0]); q++) {
        double first[3];
        memcpy(first, side[q].vertex[0], sizeof first);
        memmove(side[q].vertex[0], side[q].vertex[1], (side[q].n - 1) * sizeof first);
        memcpy(side[q].vertex[side[q].n - 1], first, sizeof first);
    }
    return has_sound_pieces(c, &side[0]) && has_sound_pieces(c, &side[1]);
}

/* Find where to cut a part: along the line with the most contact. */
static void find_cut(const struct cutter *c, struct part *p)
{
    p->covered = 0;
    for (size_t i = 0; i < c->lines.count; i++) {
        const struct cut_line *l = &c->lines.lines[i];
        if (!cut_parts_polygon(&c->frame, (const double(*)[3])p->vertex, p->n, l->across,
                               l->offset))
            continue;
        double h[CORNERS];
        heights_over(&c->frame, p, l, h);
        double covered = covered_length(c, p, l, h);
        struct part side[2];
        if (covered > p->covered + c->frame.touch && divide(c, p, h, side)) {
            p->covered = covered;
            p->line = i;
        }
    }
}

static int emit_piece(struct cutter *c, const struct part *p, const struct piece *piece)
{
    struct face f = *c->frame.face;
    memset(f.vertex, 0, sizeof f.vertex);
    f.vertices = piece->n;
    for (int back = 0; back <= c->frame.two_sided; back++) {
        if (array_reserve(&c->out, c->out_count + 1, &c->out_capacity, sizeof *c->out) < 0)
            return -1;
        for (uint32_t i = 0; i < piece->n; i++)
            memcpy(f.vertex[i], p->vertex[piece->corner[back ? piece->n - 1 - i : i]],
                   sizeof f.vertex[i]);
        f.back = (uint8_t)(c->frame.face->back | back);
        c->out[c->out_count++] = f;
    }
    return 0;
}

/* Cut the face at hand along its lines; when it stays whole nothing is put out. Returns 0 or -1. */
static int cut_along_lines(struct cutter *c)
{
    const struct face *f = c->frame.face;
    struct part side[2];
    uint32_t count = 1;
    if (array_reserve(&c->parts, 1, &c->part_capacity, sizeof *c->parts) < 0)
        return -1;
    struct part *part = c->parts;
    memcpy(part[0].vertex, f->vertex, sizeof f->vertex);
    part[0].n = f->vertices;
    find_cut(c, &part[0]);
    for (; count < PARTS; count++) {
        uint32_t best = 0;
        for (uint32_t i = 0; i < count; i++)
            if (part[i].covered > part[best].covered + c->frame.touch)
                best = i;
        if (!(part[best].covered > 0))
            break;
        double h[CORNERS];
        heights_over(&c->frame, &part[best], &c->lines.lines[part[best].line], h);
        divide(c, &part[best], h, side);
        find_cut(c, &side[0]);
        find_cut(c, &side[1]);
        if (array_reserve(&c->parts, count + 1, &c->part_capacity, sizeof *c->parts) < 0)
            return -1;
        part = c->parts;
        part[best] = side[0];
        part[count] = side[1];
    }
    for (uint32_t i = 0; i < count && count > 1; i++) {
        struct piece piece[CORNERS / 2];
        uint32_t n = polygon_pieces(part[i].vertex, part[i].n, c->frame.touch, piece);
        for (uint32_t j = 0; j < n; j++)
            if (emit_piece(c, &part[i], &piece[j]) < 0)
                return -1;
    }
    return 0;
}

/* Cut face i and its far side, where there is something to cut. Returns 0 or -1. */
static int cut_face(struct cutter *c, uint32_t i)
{
    const struct scene *s = c->scene;
    size_t before = c->out_count;
    if (!cut_frame_of(&c->frame, s->faces, i, scene_is_pair(s, i), s->precision))
        return 0;
    if (contacts_collect(&c->contacts, &c->frame, s->faces, c->tree, c->normals) < 0)
        return -1;
    if (c->contacts.count
        && (lines_of_contacts(&c->lines, &c->frame, &c->contacts) < 0 || cut_along_lines(c) < 0))
        return -1;
    if (c->out_count == before)
        return 0;
    if (array_reserve(&c->cuttings, c->cutting_count + 1, &c->cutting_capacity, sizeof *c->cuttings)
        < 0)
        return -1;
    c->cuttings[c->cutting_count++] = (struct cutting){i, before, c->out_count - before};
    return 0;
}

/* Put the parts in the places of the faces they were cut from. */
static int put_parts(struct scene *scene, const struct cutter *cutters, int threads)
{
    size_t count = 0;
    for (int t = 0; t < threads; t++)
        count += cutters[t].cutting_count;
    if (!count)
        return 0;
    struct replacement *all = malloc(count * sizeof *all);
    if (!all)
        return -1;
    count = 0;
    for (int t = 0; t < threads; t++)
        for (size_t i = 0; i < cutters[t].cutting_count; i++) {
            const struct cutting *x = &cutters[t].cuttings[i];
            all[count++] = (struct replacement){x->face, x->count, &cutters[t].out[x->first]};
            scene->cut++;
            scene->parts += (uint32_t)(x->count >> scene_is_pair(scene, x->face));
        }
    const int status = replace_faces(scene, all, count);
    free(all);
    return status;
}

struct all_cutters {
    const struct scene *scene;
    struct cutter *cutters; /* [thread] */
    atomic_int *failed;
};

static void cut_some(const void *all, size_t from, size_t to)
{
    const struct all_cutters *c = all;
    for (uint32_t i = (uint32_t)from; i < to; i++)
        if (!*c->failed && !(i > 0 && scene_is_pair(c->scene, i - 1))
            && cut_face(&c->cutters[thread_pool_number()], i) < 0)
            *c->failed = 1;
}

int scene_cut(struct scene *scene, const struct bvh *tree, int threads)
{
    if (!scene->face_count)
        return 0;
    struct cutter *cutters = calloc((size_t)threads, sizeof *cutters);
    struct bounds *normals = contacts_normals(scene->faces, tree);
    if (!cutters || !normals) {
        free(cutters);
        free(normals);
        return -1;
    }
    for (int t = 0; t < threads; t++) {
        cutters[t].scene = scene;
        cutters[t].tree = tree;
        cutters[t].normals = normals;
    }
    atomic_int failed = 0;
    const struct all_cutters all = {scene, cutters, &failed};
    thread_pool_run(threads, scene->face_count, 256, cut_some, &all);
    int status = failed;
    if (!status)
        status = put_parts(scene, cutters, threads) < 0;
    for (int t = 0; t < threads; t++) {
        free(cutters[t].contacts.contacts);
        free(cutters[t].lines.lines);
        free(cutters[t].parts);
        free(cutters[t].out);
        free(cutters[t].cuttings);
    }
    free(cutters);
    free(normals);
    return status ? -1 : 0;
}
