/* linear_coupling.c - see linear_coupling.h.
 * SPDX-License-Identifier: MIT */
#include "engine/linear_coupling.h"

#include <math.h>
#include <string.h>
#include "kernel/constants.h"
#include "kernel/lambert.h"
#include "kernel/lanes.h"
#include "kernel/surface.h"

/* Points of a rule, whole vectors of them. */
enum { POINTS = 9, ROOM = 12, FEW = 4 };

/* The nodes of a rule over a cell, coordinate by coordinate, weights in m2, and what the element's
 * basis is there; the rest of the last vector is 0. */
struct nodes {
    int count;
    double at[3][ROOM], weight[ROOM], phi[3][ROOM];
};

/* A part of an element, and what has been made of it: it meets many of the other's. */
struct cell {
    struct element e;
    const struct linear_side *side;
    struct nodes nodes[2]; /* [order - 1]; count 0: not yet */
    struct cell *part;     /* [parts]; NULL: not yet */
    int parts;             /* 4 quarters, or 2 halves of what is long */
};

/* radius^2 over area. Above it a cell is halved: rectangles from 1 : 7.9 on, and triangles whose
 * height is 4.5 times their base. It is .5 of a square and at most 1.7 of triangles of 30 degrees
 * and more. Chosen: squares beside a strip have a few times as many cells then, no more */
static const double LONG = 2;

enum { CELLS = 64 }; /* that are kept, of both elements; of cells beyond them all is made anew */

/* The integral so far: sum[a][b] (m2). */
struct integral {
    double least; /* m: cells of no larger a radius are not quartered */
    int width;    /* of vectors */
    double sum[3][3];
    int cells;
    long pairs; /* of cells so far */
    struct cell cell[CELLS];
};

static void add_node(struct nodes *n, const struct linear_side *side, const double x[3],
                     double weight)
{
    const int i = n->count++;
    double phi[2];
    linear_basis_at(side->basis, side->element->centre, x, phi);
    for (int k = 0; k < 3; k++)
        n->at[k][i] = x[k];
    n->weight[i] = weight;
    n->phi[0][i] = 1;
    n->phi[1][i] = phi[0];
    n->phi[2][i] = phi[1];
}

/* Gauss's rule of (order + 1)^2 points in the bilinear map of a quad. */
static void place_in_quad(struct nodes *n, const struct linear_side *side, const struct element *e,
                          int order)
{
    static const double node[2][3] = {{0.21132486540518711775, 0.78867513459481288225, 0},
                                      {0.11270166537925831148, 0.5, 0.88729833462074168852}};
    static const double weight[2][3] = {{0.5, 0.5, 0}, {5 / 18.0, 8 / 18.0, 5 / 18.0}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    for (int i = 0; i < order + 1; i++) {
        double s = node[order - 1][i], low[3], dt[3];
        for (int k = 0; k < 3; k++) {
            low[k] = v[0][k] + s * (v[1][k] - v[0][k]);
            dt[k] = v[3][k] + s * (v[2][k] - v[3][k]) - low[k];
        }
        for (int j = 0; j < order + 1; j++) {
            double t = node[order - 1][j], p[3], ds[3], c[3];
            for (int k = 0; k < 3; k++) {
                p[k] = low[k] + t * dt[k];
                ds[k] = (1 - t) * (v[1][k] - v[0][k]) + t * (v[2][k] - v[3][k]);
            }
            cross3(c, ds, dt);
            add_node(n, side, p, weight[order - 1][i] * weight[order - 1][j] * dot3(c, e->normal));
        }
    }
}

/* Three points, exact to degree 2, or six, to degree 4 [Strang and Fix 1973; Dunavant 1985]. */
static void place_in_triangle(struct nodes *n, const struct linear_side *side,
                              const struct element *e, int order)
{
    static const double corner[2][2] = {{2 / 3.0, 0},
                                        {0.81684757298045851308, 0.10810301816807022736}};
    static const double weight[2][2] = {{1 / 3.0, 0},
                                        {0.10995174365532186764, 0.22338158967801146570}};
    const double(*v)[3] = (const double(*)[3])e->vertex;
    for (int group = 0; group < order; group++)
        for (int i = 0; i < 3; i++) {
            double own = corner[order - 1][group], other = 0.5 * (1 - own), p[3];
            for (int k = 0; k < 3; k++)
                p[k] = own * v[i][k] + other * (v[(i + 1) % 3][k] + v[(i + 2) % 3][k]);
            add_node(n, side, p, weight[order - 1][group] * e->area);
        }
}

static const struct nodes *nodes_of(struct cell *c, int order)
{
    struct nodes *n = &c->nodes[order - 1];
    if (n->count > 0)
        return n;
    if (c->e.vertices == 4)
        place_in_quad(n, c->side, &c->e, order);
    else
        place_in_triangle(n, c->side, &c->e, order);
    for (int i = n->count; i % FEW; i++)
        for (int k = 0; k < 3; k++)
            n->at[k][i] = 0;
    return n;
}

/* What nodes of a cell with normal m send to each of `at`, whose normal is n: for each function of
 * theirs, the sum over them in their order, of several points of `at` at a time (lanes.h). */
TOOL void reach_body(const struct nodes *at, const double n[3], const struct nodes *from,
                     const double m[3], double (*reached)[ROOM])
{
    const double n0 = n[0], n1 = n[1], n2 = n[2], m0 = m[0], m1 = m[1], m2 = m[2];
    for (int i = 0; i < at->count; i += FEW) {
        const double *x = at->at[0] + i, *y = at->at[1] + i, *z = at->at[2] + i;
        double sum_0[FEW] = {0}, sum_1[FEW] = {0}, sum_2[FEW] = {0};
        for (int j = 0; j < from->count; j++) {
            const double to_x = from->at[0][j], to_y = from->at[1][j], to_z = from->at[2][j],
                         weight = from->weight[j], phi_1 = from->phi[1][j], phi_2 = from->phi[2][j];
            for (int k = 0; k < FEW; k++) {
                const double a = to_x - x[k], b = to_y - y[k], c = to_z - z[k],
                             sent = weight
                                    * lambert_kernel(n0 * a + n1 * b + n2 * c,
                                                     -(m0 * a + m1 * b + m2 * c),
                                                     a * a + b * b + c * c, 0);
                sum_0[k] += sent;
                sum_1[k] += sent * phi_1;
                sum_2[k] += sent * phi_2;
            }
        }
        for (int k = 0; k < FEW; k++) {
            reached[0][i + k] = sum_0[k];
            reached[1][i + k] = sum_1[k];
            reached[2][i + k] = sum_2[k];
        }
    }
}

#if LANES_CHOSEN
LANES_AVX2 void reach_4(const struct nodes *at, const double n[3], const struct nodes *from,
                        const double m[3], double (*reached)[ROOM])
{
    reach_body(at, n, from, m, reached);
}
#endif

/* Cells that are apart: all points with all points. */
static void add_apart(struct integral *c, struct cell *r, struct cell *s, int order)
{
    const struct nodes *at = nodes_of(r, order), *from = nodes_of(s, order);
    double reached[3][ROOM];
    LANES_RUN(c->width, reach_4, reach_4, reach_body,
              (at, r->e.normal, from, s->e.normal, reached));
    for (int i = 0; i < at->count; i++)
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                c->sum[a][b] += at->weight[i] * at->phi[a][i] * reached[b][i];
}

/* int over `to` of phi_a(x) F(x, from). */
static void exact_from_points(struct cell *to, const struct cell *from, double marginal[3])
{
    const struct nodes *n = nodes_of(to, 1);
    double x[POINTS][3], f[POINTS];
    for (int i = 0; i < n->count; i++)
        for (int k = 0; k < 3; k++)
            x[i][k] = n->at[k][i];
    lambert_sums(n->count, (const double(*)[3])x, to->e.normal, (const double(*)[3])from->e.vertex,
                 from->e.vertices, f);
    for (int i = 0; i < n->count; i++)
        for (int a = 0; a < 3 && f[i] > 0; a++)
            marginal[a] += n->weight[i] * n->phi[a][i] * f[i];
}

/* Cells that touch: the marginals from exact factors, else their product. */
static void add_touching(struct integral *c, struct cell *r, struct cell *s)
{
    double of_r[3] = {0, 0, 0}, of_s[3] = {0, 0, 0};
    exact_from_points(r, s, of_r);
    exact_from_points(s, r, of_s);
    if (!(of_r[0] > 0 && of_s[0] > 0))
        return;
    double whole = 0.5 * (of_r[0] + of_s[0]);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            c->sum[a][b] += whole * (of_r[a] / of_r[0]) * (of_s[b] / of_s[0]);
}

/* Quarters of what is long are as long for their width, and as small as is wanted only once there
 * are as many side by side as one behind the other: of a strip of 1 m by 1 mm, beside squares of
 * 2 mm, 250,000. Halves are not so long. */
static int is_long(const struct element *e)
{
    return e->radius * e->radius > LONG * e->area;
}

static void begin_cell(struct cell *c, const struct linear_side *side)
{
    c->side = side;
    c->nodes[0].count = c->nodes[1].count = 0;
    c->part = NULL;
    c->parts = is_long(&c->e) ? 2 : 4;
}

/* Half of e, 0 or 1, cut across its longest edge, of a quad across the longer two. */
static void half_of(const struct element *e, int i, struct element *half)
{
    const int n = e->vertices;
    double edge[4] = {0, 0, 0, 0};
    for (int j = 0; j < n; j++) {
        double along[3];
        sub3(along, e->vertex[(j + 1) % n], e->vertex[j]);
        edge[n == 4 ? j % 2 : j] += length3(along);
    }
    const int a = edge[2] > fmax(edge[0], edge[1]) ? 2 : edge[1] > edge[0], b = (a + 1) % n,
              c = (a + 2) % n, d = n == 4 ? (a + 3) % n : c;
    *half = *e;
    for (int k = 0; k < 3; k++) {
        const double middle = 0.5 * (e->vertex[a][k] + e->vertex[b][k]),
                     across = 0.5 * (e->vertex[c][k] + e->vertex[d][k]);
        half->vertex[i == 0 ? b : a][k] = middle;
        if (n == 4)
            half->vertex[i == 0 ? c : d][k] = across;
    }
    surface_measure(half);
    memcpy(half->normal, e->normal, sizeof half->normal);
}

/* Kept, where there is room; else in `own`. */
static struct cell *parts_of(struct integral *c, struct cell *whole, struct cell own[4])
{
    if (whole->part)
        return whole->part;
    struct cell *part = own;
    if (c->cells + whole->parts <= CELLS) {
        whole->part = part = &c->cell[c->cells];
        c->cells += whole->parts;
    }
    for (int i = 0; i < whole->parts; i++) {
        if (whole->parts == 2)
            half_of(&whole->e, i, &part[i].e);
        else
            surface_quarter(&whole->e, i, &part[i].e);
        begin_cell(&part[i], whole->side);
    }
    return part;
}

static void add_cells(struct integral *c, struct cell *r, struct cell *s)
{
    double away[3], sizes = r->e.radius + s->e.radius;
    sub3(away, s->e.centre, r->e.centre);
    double distance = length3(away);
    if (distance > LINEAR_NEAR * sizes) {
        add_apart(c, r, s, distance > LINEAR_FAR * sizes ? 1 : 2);
        c->pairs++;
        return;
    }
    struct cell *larger = r->e.radius > s->e.radius ? r : s, own[4];
    if (!(larger->e.radius > c->least)) {
        add_touching(c, r, s);
        c->pairs++;
        return;
    }
    struct cell *part = parts_of(c, larger, own);
    for (int i = 0; i < larger->parts; i++)
        add_cells(c, larger == r ? &part[i] : r, larger == r ? s : &part[i]);
}

/* The part of a side in front of the other's plane, as one or two cells. Returns how many. */
static int cut_at_plane(const struct linear_side *side, const struct element *other,
                        struct cell cell[2])
{
    const struct element *e = side->element;
    struct polygon p;
    polygon_clip(&p, (const double(*)[3])e->vertex, e->vertices, other->centre, other->normal);
    int cells = p.n == 0 ? 0 : p.n == 5 ? 2 : 1;
    for (int i = 0; i < cells; i++) {
        struct element *part = &cell[i].e;
        memset(part, 0, sizeof *part);
        part->vertices = (uint8_t)(i == 1 || p.n == 3 ? 3 : 4);
        for (int j = 0; j < part->vertices; j++)
            memcpy(part->vertex[j], p.v[i == 0 || j == 0 ? j : j + 2], sizeof p.v[0]);
        surface_measure(part);
        memcpy(part->normal, e->normal, sizeof e->normal);
        begin_cell(&cell[i], side);
    }
    return cells;
}

void linear_coupling_integrate(double c[3][3], struct linear_side r, struct linear_side s)
{
    (void)linear_coupling_at(lanes_width(), c, r, s);
}

long linear_coupling_at(int width, double c[3][3], struct linear_side r, struct linear_side s)
{
    struct integral sum; /* without its cells' 100 kB, which are set where they are made */
    struct cell of_r[2], of_s[2];
    const int cells_of_r = cut_at_plane(&r, s.element, of_r),
              cells_of_s = cut_at_plane(&s, r.element, of_s);
    sum.least = LINEAR_CELL * fmin(r.element->radius, s.element->radius);
    sum.width = width;
    sum.cells = 0;
    sum.pairs = 0;
    memset(sum.sum, 0, sizeof sum.sum);
    for (int i = 0; i < cells_of_r; i++)
        for (int j = 0; j < cells_of_s; j++)
            add_cells(&sum, &of_r[i], &of_s[j]);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            c[a][b] = r.element->area > 0 ? sum.sum[a][b] / r.element->area : 0;
    return sum.pairs;
}

/* The factor in [0, 1] that makes F + b1 phi_1 + b2 phi_2 nonnegative over the element. */
static double keep_positive(const struct linear_side *side, const double b[2], double form_factor)
{
    double least, most;
    linear_basis_range(side->basis, side->element, b, &least, &most);
    return form_factor + least < 0 ? form_factor / -least : 1;
}

void linear_coupling_scale(double c[3][3], double form_factor)
{
    double scale = c[0][0] > 0 && form_factor > 0 ? form_factor / c[0][0] : 0;
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++)
            c[a][b] *= scale;
    c[0][0] = form_factor;
}

void linear_coupling_limit(double c[3][3], struct linear_side r, struct linear_side s)
{
    double form_factor = c[0][0];
    if (!(form_factor > 0))
        return;
    double at_r = keep_positive(&r, (const double[2]){c[1][0], c[2][0]}, form_factor),
           at_s = keep_positive(&s, &c[0][1], form_factor), joint = 1, beside[2][2];
    for (int a = 1; a < 3; a++) {
        c[a][0] *= at_r;
        c[0][a] *= at_s;
    }
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            beside[a][b] = c[a + 1][b + 1] - c[a + 1][0] * c[0][b + 1] / form_factor;
    for (int i = 0; i < r.element->vertices; i++)
        for (int j = 0; j < s.element->vertices; j++) {
            double x[2], y[2], here = 0;
            linear_basis_at(r.basis, r.element->centre, r.element->vertex[i], x);
            linear_basis_at(s.basis, s.element->centre, s.element->vertex[j], y);
            double product = fmax(0, form_factor + c[1][0] * x[0] + c[2][0] * x[1])
                             * fmax(0, form_factor + c[0][1] * y[0] + c[0][2] * y[1]) / form_factor;
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < 2; b++)
                    here += x[a] * beside[a][b] * y[b];
            if (product + joint * here < 0)
                joint = product / -here;
        }
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            c[a + 1][b + 1] = c[a + 1][0] * c[0][b + 1] / form_factor + joint * beside[a][b];
}
