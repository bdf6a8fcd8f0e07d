/* view.c - see view.h.
 *
 * To guess a view we try a few dozen, look through each with a coarse picture, and keep the one
 * that sees the most: fronts rather than backs (an eye within a solid sees backs), far rather than
 * near (an eye against a wall sees little), many faces rather than one.
 * SPDX-License-Identifier: MIT */
#include "output/view.h"

#include <ctype.h>
#include <math.h>
#include <string.h>

#include "geometry.h"
#include "output/raster.h"
#include "util/decimal.h"

enum { COARSE_X = 40, COARSE_Y = 30, DEFAULT_FOV = 70 };

static int number(const char **text, double *value)
{
    if (isspace((unsigned char)**text))
        return -1;
    char *stop;
    *value = decimal(*text, &stop);
    if (stop == *text || !isfinite(*value))
        return -1;
    *text = stop;
    return 0;
}

static int character(const char **text, char c)
{
    return **text == c ? (++*text, 0) : -1;
}

static int triple(const char **text, double v[3])
{
    return number(text, &v[0]) || character(text, ',') || number(text, &v[1])
                   || character(text, ',') || number(text, &v[2])
               ? -1
               : 0;
}

int view_parse(const char *text, struct view *view)
{
    struct view v = {.fov = DEFAULT_FOV};
    if (triple(&text, v.eye) || character(&text, ':') || triple(&text, v.at))
        return -1;
    if (*text && (character(&text, ':') || number(&text, &v.fov)))
        return -1;
    double ahead[3];
    sub3(ahead, v.at, v.eye);
    double distance = length3(ahead);
    if (*text || !(distance > 0) || !isfinite(distance) || !(v.fov >= 1 && v.fov <= 170))
        return -1;
    *view = v;
    return 0;
}

int view_up_axis(const struct surfaces *surfaces)
{
    double square[3] = {0, 0, 0};
    for (uint32_t i = 0; i < surfaces->face_count; i++) {
        const struct RadFace *f = &surfaces->faces[i];
        for (uint32_t j = 2; j < f->vertices; j++) {
            double a[3], b[3], c[3];
            sub3(a, f->vertex[j - 1], f->vertex[0]);
            sub3(b, f->vertex[j], f->vertex[0]);
            cross3(c, a, b);
            double twice = length3(c);
            for (int k = 0; k < 3; k++)
                if (fabs(c[k]) > 0.999 * twice)
                    square[k] += twice;
        }
    }
    return square[1] > 1.02 * square[2] ? 1 : 2;
}

void view_frame(const struct view *view, const struct surfaces *surfaces, double right[3],
                double up[3], double ahead[3])
{
    double wish[3] = {view->up[0], view->up[1], view->up[2]};
    sub3(ahead, view->at, view->eye);
    double size = length3(ahead);
    for (int k = 0; k < 3; k++)
        ahead[k] /= size;
    if (!(length3(wish) > 0))
        wish[view_up_axis(surfaces)] = 1;
    cross3(right, ahead, wish);
    if (!(length3(right) > 1e-6 * length3(wish))) {
        /* Straight up or down: let y, or else z, point to the top of the picture. */
        int axis = fabs(ahead[1]) > 0.9 ? 2 : 1;
        memset(wish, 0, sizeof wish);
        wish[axis] = 1;
        cross3(right, ahead, wish);
    }
    size = length3(right);
    for (int k = 0; k < 3; k++)
        right[k] /= size;
    cross3(up, right, ahead);
}

double view_half_height(const struct view *view)
{
    return tan(view->fov / 360 * M_PI);
}

struct RadCamera view_camera(const struct view *view, const struct surfaces *surfaces,
                             double aspect)
{
    struct RadCamera c;
    memcpy(c.eye, view->eye, sizeof c.eye);
    view_frame(view, surfaces, c.right, c.up, c.ahead);
    c.high = view_half_height(view);
    c.wide = c.high * aspect;
    return c;
}

/* What the picture gains by a sample that sees face f at that distance; `again`: the sample
 * before it saw the same. */
static double gain(const struct view *view, const struct RadFace *f, double distance,
                   double diagonal, int again)
{
    double a[3], b[3], n[3], toward[3];
    sub3(a, f->vertex[1], f->vertex[0]);
    sub3(b, f->vertex[2], f->vertex[0]);
    cross3(n, a, b);
    sub3(toward, view->eye, f->vertex[0]);
    if (f->black)
        return -0.5; /* it will stay so */
    if (!(dot3(n, toward) > 0))
        return -2;
    double far = fmin(1, distance / (0.4 * diagonal)), obstructed = distance < 0.08 * diagonal;
    return far + (again ? 0 : 0.5) - obstructed;
}

/* The score of a view. With cut_away, backs are not seen at all. */
static int judge(const struct surfaces *surfaces, const struct view *view, double diagonal,
                 int cut_away, double *score)
{
    struct raster r;
    uint32_t face[COARSE_X * COARSE_Y], last = NO_FACE;
    double nearness[COARSE_X * COARSE_Y], sum = 0;
    if (raster_begin(&r, surfaces, view, COARSE_X, COARSE_Y, !cut_away))
        return -1;
    raster_rows(&r, 0, COARSE_Y, face, nearness);
    for (int i = 0; i < COARSE_X * COARSE_Y; i++) {
        if (face[i] == NO_FACE)
            continue;
        sum += gain(view, &surfaces->faces[face[i]], 1 / nearness[i], diagonal, face[i] == last);
        last = face[i];
    }
    raster_end(&r);
    *score = sum / (COARSE_X * COARSE_Y);
    return 0;
}

/* Move the eye along its line of sight until the box of size d around v->at fits into a 4:3
 * picture. */
static void step_back(const struct surfaces *surfaces, struct view *v, const double d[3])
{
    const double half = view_half_height(v);
    double right[3], up[3], ahead[3], distance = 0;
    view_frame(v, surfaces, right, up, ahead);
    for (int i = 0; i < 8; i++) {
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (i >> k & 1 ? 0.53 : -0.53) * d[k];
        distance = fmax(distance, fabs(dot3(p, up)) / half - dot3(p, ahead));
        distance = fmax(distance, fabs(dot3(p, right)) / (half * 4 / 3) - dot3(p, ahead));
    }
    for (int k = 0; k < 3; k++)
        v->eye[k] = v->at[k] - distance * ahead[k];
}

/* The views that are tried, and the best so far. */
struct search {
    const struct surfaces *surfaces;
    double low[3], high[3], size[3], diagonal; /* the scene's box */
    int x, y, up;                              /* axes */
    struct view *best;
    double score;
};

static void begin_search(struct search *s, const struct surfaces *surfaces, struct view *best)
{
    int up = view_up_axis(surfaces);
    *s = (struct search){surfaces,
                         {INFINITY, INFINITY, INFINITY},
                         {-INFINITY, -INFINITY, -INFINITY},
                         {0, 0, 0},
                         0,
                         up == 2 ? 0 : 2,
                         up == 2 ? 1 : 0,
                         up,
                         best,
                         -INFINITY};
    for (uint32_t i = 0; i < surfaces->face_count; i++)
        for (uint32_t j = 0; j < surfaces->faces[i].vertices; j++)
            for (int k = 0; k < 3; k++) {
                s->low[k] = fmin(s->low[k], surfaces->faces[i].vertex[j][k]);
                s->high[k] = fmax(s->high[k], surfaces->faces[i].vertex[j][k]);
            }
    sub3(s->size, s->high, s->low);
    s->diagonal = length3(s->size);
}

/* Keep the view when it is better than what there is. Returns 0, or -1 when out of memory. */
static int try_view(struct search *s, const struct view *v, int cut_away)
{
    double ahead[3];
    sub3(ahead, v->at, v->eye);
    if (!(length3(ahead) > 1e-3 * s->diagonal))
        return 0;
    double score;
    if (judge(s->surfaces, v, s->diagonal, cut_away, &score))
        return -1;
    if (score > s->score) {
        s->score = score;
        *s->best = *v;
    }
    return 0;
}

/* From within: per corner and inset, across to the other corner, along one wall, along the
 * other. */
static int search_inside(struct search *s)
{
    static const double insets[3] = {0.06, 0.12, 0.25};
    const double *low = s->low, *d = s->size;
    int x = s->x, y = s->y, up = s->up;
    struct view v = {.fov = DEFAULT_FOV};
    v.up[up] = 1;
    for (int i = 0; i < 4 * 3 * 3; i++) {
        int right = i & 1, top = i >> 1 & 1, way = i / 4 % 3;
        double t = insets[i / 12];
        v.eye[x] = low[x] + d[x] * (right ? 1 - t : t);
        v.eye[y] = low[y] + d[y] * (top ? 1 - t : t);
        v.eye[up] = low[up] + 0.64 * d[up];
        v.at[x] = way == 2 ? v.eye[x] : low[x] + d[x] * (right ? 0.4 : 0.6);
        v.at[y] = way == 1 ? v.eye[y] : low[y] + d[y] * (top ? 0.4 : 0.6);
        v.at[up] = low[up] + 0.36 * d[up];
        if (try_view(s, &v, 0))
            return -1;
    }
    return 0;
}

/* From without: round the scene at two heights. */
static int search_outside(struct search *s)
{
    static const double ways[8][2] = {{1, 0.6},   {0.6, 1},   {-0.6, 1}, {-1, 0.6},
                                      {-1, -0.6}, {-0.6, -1}, {0.6, -1}, {1, -0.6}};
    int x = s->x, y = s->y, up = s->up;
    struct view v = {.fov = 40};
    v.up[up] = 1;
    for (int k = 0; k < 3; k++)
        v.at[k] = 0.5 * (s->low[k] + s->high[k]);
    s->score = -INFINITY;
    for (int i = 0; i < 16; i++) {
        v.eye[x] = v.at[x] + 1.3 * s->diagonal * ways[i % 8][0];
        v.eye[y] = v.at[y] + 1.3 * s->diagonal * ways[i % 8][1];
        v.eye[up] = v.at[up] + (i < 8 ? 0.9 : 2) * s->diagonal;
        step_back(s->surfaces, &v, s->size);
        if (try_view(s, &v, 1))
            return -1;
    }
    return 0;
}

int view_guess(const struct surfaces *surfaces, struct view *view)
{
    static const double ENCLOSED = 0.4; /* a score that only a view within an enclosed space has */
    struct search s;
    begin_search(&s, surfaces, view);
    *view = (struct view){.eye = {0, 0, 1}, .fov = DEFAULT_FOV}; /* of a scene that is a point */
    if (search_inside(&s))
        return -1;
    return s.score > ENCLOSED ? 0 : search_outside(&s);
}
