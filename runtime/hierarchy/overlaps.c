/* overlaps.c - see overlaps.h.
 *
 * Near is what rays cannot tell: they start RAY_OFFSET of the scene's size off their surface, so of
 * two sheets that stand nearer, the hinder sees past the one before it, and both are lit. To that
 * comes what coordinates lose in rounding, and by how much quads are bent. Edges that overlap by
 * less are one edge, and so are faces of which less than OVERLAP_LEAST is covered: the corners of
 * neighbours, which rounding has moved.
 *
 * What covers a face is found among the faces as they were given, and the rank of polygons is an
 * order; so what becomes of one depends neither on the others nor on threads, and wherever
 * something lay, the first of it still does. [derived here]
 * SPDX-License-Identifier: MIT */
#include "hierarchy/overlaps.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "hierarchy/bvh.h"
#include "hierarchy/lids.h"
#include "hierarchy/replace_faces.h"
#include "kernel/constants.h"
#include "util/array.h"
#include "util/thread_pool.h"

static const uint32_t MIXED = UINT32_MAX; /* no polygon */

/* A face and its plane. */
struct sheet {
    struct face face;
    uint32_t index;
    unsigned sides; /* that it has */
    double normal[3], area, size, largest /* of its coordinates */, bent /* off its plane; m */;
};

/* What becomes of a face that is covered. */
struct loss {
    uint32_t face; /* first: losses are sorted by it */
    uint32_t on;   /* what it lies on; of several that cover a part each the first by rank */
    double area;   /* m2, of both sides */
    size_t first, count;
    const struct finder *by;
};

/* One thread's. */
struct finder {
    const struct scene *scene;
    const struct bvh *tree;
    const uint32_t *parts_of; /* [node]: parts_of_polygons */
    double extent;            /* of the scene (m) */
    double near;              /* at most, of flat faces (m) */
    struct sheet sheet;       /* the face at hand */
    struct bounds reach;      /* its box, and what is near */
    struct lid *lids;         /* [lid_count]: on the sheet */
    size_t lid_count, lid_capacity;
    struct loss *losses; /* [loss_count] */
    size_t loss_count, loss_capacity;
    struct face *out; /* [out_count]: what is left of the faces */
    size_t out_count, out_capacity;
};

static int emits(const struct scene *s, uint32_t face)
{
    const double *e = s->materials[s->faces[face].material].exitance;
    return e[0] > 0 || e[1] > 0 || e[2] > 0;
}

/* Does face a stay where it lies on b? */
static int ranks_before(const struct scene *s, uint32_t a, uint32_t b)
{
    int x = emits(s, a), y = emits(s, b);
    return x != y ? x : a < b;
}

static void sheet_of(struct sheet *sheet, const struct scene *s, uint32_t index)
{
    struct face *f = &sheet->face;
    *sheet = (struct sheet){.face = s->faces[index],
                            .index = index,
                            .sides = scene_is_pair(s, index) ? FRONT | BACK : FRONT};
    sheet->area = polygon_normal(f->vertex, f->vertices, sheet->normal);
    sheet->size = polygon_size(f->vertex, f->vertices);
    double centre[3] = {0};
    for (uint32_t i = 0; i < f->vertices; i++)
        for (int k = 0; k < 3; k++) {
            centre[k] += f->vertex[i][k] / f->vertices;
            sheet->largest = fmax(sheet->largest, fabs(f->vertex[i][k]));
        }
    for (uint32_t i = 0; i < f->vertices && f->vertices > 3; i++)
        sheet->bent = fmax(sheet->bent, fabs(height3(f->vertex[i], centre, sheet->normal)));
}

/* Coordinates are no better known than that (m). */
static double rounding(const struct finder *f, double largest)
{
    return CUT_TOUCH_ROUNDINGS * f->scene->precision * largest;
}

static int lies_in(const struct sheet *a, const struct sheet *plane, double near)
{
    for (uint32_t i = 0; i < a->face.vertices; i++)
        if (!(fabs(height3(a->face.vertex[i], plane->face.vertex[0], plane->normal)) <= near))
            return 0;
    return 1;
}

/* The sides of the sheet that another one covers, if it does; then the lid. */
static unsigned covers(const struct finder *f, const struct sheet *over, struct lid *lid)
{
    const struct sheet *s = &f->sheet;
    double largest = fmax(s->largest, over->largest), cosine = dot3(s->normal, over->normal),
           near = fmax(RAY_OFFSET * f->extent, rounding(f, largest)) + s->bent + over->bent;
    unsigned sides = over->sides == FRONT ? cosine > 0 ? FRONT : BACK : over->sides;
    if (!(sides & s->sides) || !(fabs(cosine) > GROUP_COSINE) || !lies_in(over, s, near)
        || !lies_in(s, over, near))
        return 0;
    double touch = fmax(fmin(RAY_OFFSET * f->extent, OVERLAP_LEAST * fmin(s->size, over->size)),
                        rounding(f, largest));
    const double(*v)[3] = (const double(*)[3])s->face.vertex,
          (*w)[3] = (const double(*)[3])over->face.vertex;
    struct lid under;
    lid_of(lid, w, over->face.vertices, s->normal, touch);
    lid_of(&under, v, s->face.vertices, s->normal, touch);
    lid->sides = sides;
    lid->face = over->index;
    return lid_place(lid, v, s->face.vertices) != BESIDE
                   && lid_place(&under, w, over->face.vertices) != BESIDE
                   && lid_area(lid, v, s->face.vertices, s->normal)
                          > OVERLAP_LEAST * fmin(s->area, over->area)
               ? sides & s->sides
               : 0;
}

/* May a face with this box lie in the sheet's plane? Most neighbours stand off it. */
static int may_lie_in(const struct finder *f, const struct face *face, const struct bounds *box)
{
    double diagonal[3];
    sub3(diagonal, box->high, box->low);
    double near = f->near + f->sheet.bent + SCENE_FLAT_QUAD * length3(diagonal);
    for (uint32_t i = 0; i < face->vertices; i++)
        if (!(fabs(height3(face->vertex[i], f->sheet.face.vertex[0], f->sheet.normal)) <= near))
            return 0;
    return 1;
}

/* Gather what lies on the sheet, below a node. Returns 0, 1 when the whole sheet is covered, so
 * that nothing more counts, or -1. */
static int gather(struct finder *f, uint32_t node)
{
    const struct bvh_node *n = &f->tree->nodes[node];
    const struct bounds *box = &f->tree->boxes[node];
    int result = 0;
    if (f->parts_of[node] == f->sheet.face.input)
        return 0;
    for (int k = 0; k < 3; k++)
        if (box->low[k] > f->reach.high[k] || box->high[k] < f->reach.low[k])
            return 0;
    for (uint32_t i = 0; i < n->children && !result; i++)
        result = gather(f, n->child + i);
    if (n->children)
        return result;
    uint32_t i = f->tree->order[n->from];
    const struct face *face = &f->scene->faces[i];
    if (i == f->sheet.index || face->back || !ranks_before(f->scene, i, f->sheet.index)
        || !may_lie_in(f, face, box))
        return 0;
    struct sheet over;
    sheet_of(&over, f->scene, i);
    if (array_reserve(&f->lids, f->lid_count + 1, &f->lid_capacity, sizeof *f->lids) < 0)
        return -1;
    struct lid *lid = &f->lids[f->lid_count];
    if (!covers(f, &over, lid))
        return 0;
    f->lid_count++;
    if ((lid->sides & f->sheet.sides) != f->sheet.sides
        || lid_place(lid, (const double(*)[3])f->sheet.face.vertex, f->sheet.face.vertices)
               != UNDER)
        return 0;
    f->lids[0] = *lid;
    f->lid_count = 1;
    return 1;
}

/* ---- what is left */

static int put_face(struct finder *f, const struct bare_part *p, const struct piece *piece,
                    int turned, int back)
{
    if (array_reserve(&f->out, f->out_count + 1, &f->out_capacity, sizeof *f->out) < 0)
        return -1;
    struct face *to = &f->out[f->out_count++];
    *to = f->sheet.face;
    memset(to->vertex, 0, sizeof to->vertex);
    to->vertices = piece->n;
    to->back = (uint8_t)back;
    for (uint32_t i = 0; i < piece->n; i++)
        memcpy(to->vertex[i], p->vertex[piece->corner[turned ? piece->n - 1 - i : i]],
               sizeof to->vertex[i]);
    return 0;
}

/* A part becomes faces, each followed by its far side where both are bare; where the far side alone
 * is, it is a face of its own. Adds to the area of both sides. Returns 0 or -1. */
static int put_part(struct finder *f, struct bare_part *p, double *area)
{
    double corner[4][3], normal[3];
    struct piece piece[POLYGON_CORNERS / 2];
    uint32_t count = polygon_pieces(p->vertex, p->n, 0, piece);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t j = 0; j < piece[i].n; j++)
            memcpy(corner[j], p->vertex[piece[i].corner[j]], sizeof corner[j]);
        if (polygon_degenerate(corner, piece[i].n, f->scene->precision))
            continue;
        *area += polygon_normal(corner, piece[i].n, normal) * (p->sides == (FRONT | BACK) ? 2 : 1);
        if (((p->sides & FRONT) && put_face(f, p, &piece[i], 0, 0))
            || ((p->sides & BACK) && put_face(f, p, &piece[i], 1, p->sides != BACK)))
            return -1;
    }
    return 0;
}

/* Find what covers face i and take it off. Returns 0 or -1. */
static int take_face(struct finder *f, struct bare_parts *bare, uint32_t i)
{
    const struct face *face = &f->scene->faces[i];
    struct sheet *s = &f->sheet;
    sheet_of(s, f->scene, i);
    bounds_empty(&f->reach);
    for (int k = 0; k < 3; k++) {
        for (uint32_t j = 0; j < face->vertices; j++) {
            f->reach.low[k] = fmin(f->reach.low[k], face->vertex[j][k]);
            f->reach.high[k] = fmax(f->reach.high[k], face->vertex[j][k]);
        }
        double near = fabs(s->normal[k]) * (f->near + s->bent + SCENE_FLAT_QUAD * f->extent);
        f->reach.low[k] -= near;
        f->reach.high[k] += near;
    }
    f->lid_count = 0;
    if (gather(f, 0) < 0)
        return -1;
    if (!f->lid_count)
        return 0;
    struct loss loss = {.face = i,
                        .on = f->lids[0].face,
                        .area = s->area * (s->sides == FRONT ? 1 : 2),
                        .first = f->out_count,
                        .by = f};
    for (size_t k = 1; k < f->lid_count; k++)
        if (ranks_before(f->scene, f->lids[k].face, loss.on))
            loss.on = f->lids[k].face;
    double left = 0;
    bare->count = 0;
    if (lids_take(bare, face, s->sides, f->lids, (uint32_t)f->lid_count) < 0)
        return -1;
    for (size_t k = 0; k < bare->count; k++)
        if (put_part(f, &bare->parts[k], &left))
            return -1;
    loss.area -= left;
    loss.count = f->out_count - loss.first;
    if (array_reserve(&f->losses, f->loss_count + 1, &f->loss_capacity, sizeof *f->losses) < 0)
        return -1;
    f->losses[f->loss_count++] = loss;
    return 0;
}

/* ---- all faces */

/* The face that a loss is told to lie on. One that covers it wholly may be covered wholly itself;
 * what covers that ranks before it, so the way ends, and covers this as well. */
static uint32_t stays_on(const struct loss *losses, size_t count, const struct loss *x)
{
    for (const struct loss *on = x; on && !on->count;) {
        const struct loss key = {.face = x->on};
        on = bsearch(&key, losses, count, sizeof *losses, compare_words);
        x = on && !on->count ? on : x;
    }
    return x->on;
}

enum { LOST = 1, LOST_ROUND = 2 };

/* Tell of the losses. lost[]: of polygons that have any which have been told of them. One that lies
 * on itself has an outline that goes round a place more than once. */
static void tell(struct scene *s, const struct loss *losses, size_t count, uint8_t *lost)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t polygon = s->faces[losses[i].face].input,
                       on = s->faces[stays_on(losses, count, &losses[i])].input;
        const uint8_t told = lost[polygon];
        if (on == polygon) {
            if (!(told & LOST_ROUND) && (!s->crossing++ || polygon < s->crossing_first))
                s->crossing_first = polygon;
            lost[polygon] |= LOST_ROUND;
            continue;
        }
        if (!(told & LOST) && s->overlaps < RAD_OVERLAPS_NAMED)
            s->overlap[s->overlaps] = (struct RadOverlap){polygon, on};
        s->overlaps += !(told & LOST);
        s->overlap_area += losses[i].area;
        lost[polygon] |= LOST;
    }
}

/* Areas of polygons are those of their faces: of two sides that are no longer equal the mean. */
static void measure(struct scene *s, const uint8_t *lost)
{
    for (uint32_t polygon = 0; polygon < s->input_count; polygon++)
        if (lost[polygon])
            s->areas[polygon] = 0;
    for (uint32_t i = 0; i < s->face_count; i++) {
        struct face *f = &s->faces[i];
        double normal[3];
        if (lost[f->input])
            s->areas[f->input] += polygon_normal(f->vertex, f->vertices, normal)
                                  / (s->materials[f->material].two_sided ? 2 : 1);
    }
}

/* Put what is left in the places of the faces. losses[count], in the order of faces. */
static int put_rests(struct scene *s, const struct loss *losses, size_t count)
{
    uint8_t *lost = calloc((size_t)s->input_count + 1, 1);
    struct replacement *list = malloc(count * sizeof *list);
    int failed = !lost || !list;
    for (size_t i = 0; i < count && !failed; i++) {
        const struct loss *x = &losses[i];
        list[i] = (struct replacement){x->face, x->count, x->count ? &x->by->out[x->first] : NULL};
    }
    if (!failed) {
        tell(s, losses, count, lost);
        failed = replace_faces(s, list, count) < 0;
    }
    if (!failed)
        measure(s, lost);
    free(list);
    free(lost);
    return failed ? -1 : 0;
}

/* The losses of all threads in the order of faces. Returns 0 or -1. */
static int replace_all(struct scene *scene, const struct finder *finders, int threads,
                       size_t *count)
{
    size_t n = 0;
    *count = 0;
    for (int t = 0; t < threads; t++)
        *count += finders[t].loss_count;
    if (!*count)
        return 0;
    struct loss *all = malloc(*count * sizeof *all);
    if (!all)
        return -1;
    for (int t = 0; t < threads; t++)
        for (size_t i = 0; i < finders[t].loss_count; i++)
            all[n++] = finders[t].losses[i];
    qsort(all, n, sizeof *all, compare_words);
    const int result = put_rests(scene, all, n);
    free(all);
    return result;
}

/* Below each node, [tree->count]: the polygon whose parts, which lie on none of its others, are all
 * that is there, or MIXED. So of a polygon of many corners each part need not ask all others. To be
 * freed; NULL when out of memory. */
static uint32_t *parts_of_polygons(const struct scene *s, const struct bvh *tree)
{
    uint32_t *of = malloc(tree->count * sizeof *of);
    for (uint32_t i = of ? tree->count : 0; i-- > 0;) { /* children stand behind parents */
        const struct bvh_node *n = &tree->nodes[i];
        const struct face *f = &s->faces[tree->order[n->from]];
        of[i] = n->children ? of[n->child] : f->apart ? f->input : MIXED;
        for (uint32_t k = 1; k < n->children; k++)
            of[i] = of[n->child + k] == of[i] ? of[i] : MIXED;
    }
    return of;
}

struct all_finders {
    struct finder *finders;  /* [thread] */
    struct bare_parts *bare; /* [thread] */
    atomic_int *failed;
};

static void take_some(const void *all, size_t from, size_t to)
{
    const struct all_finders *a = all;
    int t = thread_pool_number();
    for (uint32_t i = (uint32_t)from; i < to && !*a->failed; i++)
        if (!a->finders[t].scene->faces[i].back && take_face(&a->finders[t], &a->bare[t], i))
            *a->failed = 1;
}

long overlaps_take(struct scene *scene, const struct bvh *tree, int threads)
{
    struct finder *finders = calloc((size_t)threads, sizeof *finders);
    struct bare_parts *bare = calloc((size_t)threads, sizeof *bare);
    uint32_t *parts_of = parts_of_polygons(scene, tree);
    atomic_int failed = !finders || !bare || !parts_of;
    double extent = 0, largest = 0;
    for (int k = 0; k < 3; k++) {
        const struct bounds *box = &tree->boxes[0];
        extent = fmax(extent, box->high[k] - box->low[k]);
        largest = fmax(largest, fmax(fabs(box->low[k]), fabs(box->high[k])));
    }
    for (int t = 0; t < threads && !failed; t++) {
        finders[t] =
            (struct finder){.scene = scene, .tree = tree, .parts_of = parts_of, .extent = extent};
        finders[t].near = fmax(RAY_OFFSET * extent, rounding(&finders[t], largest));
    }
    size_t count = 0;
    if (!failed)
        thread_pool_run(threads, scene->face_count, 256, take_some,
                        &(struct all_finders){finders, bare, &failed});
    if (!failed)
        failed = replace_all(scene, finders, threads, &count) < 0;
    for (int t = 0; t < threads; t++) {
        if (bare)
            free(bare[t].parts);
        if (!finders)
            continue;
        free(finders[t].lids);
        free(finders[t].losses);
        free(finders[t].out);
    }
    free(finders);
    free(bare);
    free(parts_of);
    return failed ? -1 : (long)count;
}
