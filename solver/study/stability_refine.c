/* stability_refine.c - cases about refinement: what must not change it, what it must end on, what
 * it must see.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"
#include "study/stability_known.h"
#include "terms/form_factor_range.h"

/* A floor with a table on it, and a lamp above. */
static struct made_scene furnished(double exitance, double scale)
{
    struct made_scene s = {.count = 0};
    made_material(&s, 0.6, 0);
    made_material(&s, 0.2, exitance);
    made_quad(&s, 0, 0, 0, 0, 4, 0, 0, 0, 5, 0);
    made_quad(&s, 1, 1, 2, 2.5, 0, 1, 0, 1, 0, 0);
    made_quad(&s, 0, 1.3, 1, 1, 1, 0, 0, 0, 1.5, 0);
    made_quad(&s, 0, 1.3, 1, 1, 0, 1.5, 0, 1, 0, 0);
    made_scale(&s, scale);
    return s;
}

/* Solve the scene, and again with E and all lengths multiplied by powers of two. The error is 0
 * when the links are the same to the bit and B is multiplied exactly, else what the number of links
 * changes by, and 1 when only bits do. */
static int changed(struct stability_trial *trial, double brighter, double larger)
{
    const struct made_scene scene = furnished(8, 1), other = furnished(8 * brighter, larger);
    struct solved a, b;
    if (stability_solve(&a, &scene, trial, 0) < 0)
        return -1;
    if (stability_solve(&b, &other, trial, 0) < 0) {
        solved_close(&a);
        return -1;
    }
    double error = fabs((double)b.links.count / (double)a.links.count - 1);
    int same = stability_same_links(&a, &b);
    for (uint32_t i = 0; same && i < a.elements.count; i++)
        same = b.elements.radiosity[i] == brighter * a.elements.radiosity[i];
    trial->error = fmax(trial->error, same ? 0 : error > 0 ? error : 1);
    trial->count = (double)b.links.count;
    solved_close(&a);
    solved_close(&b);
    return 0;
}

int stability_brightness(struct stability_trial *trial)
{
    trial->error = 0;
    return changed(trial, 1024, 1);
}

/* From a model of 4 mm to one of 4,000 km. */
int stability_scale(struct stability_trial *trial)
{
    trial->error = 0;
    if (changed(trial, 1, 1 / 1024.0) < 0)
        return -1;
    /* With an absolute smallest area nothing would end the refinement of the large one. */
    return trial->method == &stability_methods[BF_NODES] ? 0 : changed(trial, 1, 1048576);
}

/* Mean over the unit square of what a point sees of a 10 x 10 square 1 above: Gauss's rule of 5
 * x 5 points. */
static double wide_source(void)
{
    static const double at[5] = {-0.90617984593866399280, -0.53846931010568309104, 0,
                                 0.53846931010568309104, 0.90617984593866399280};
    static const double weight[5] = {0.23692688505618908751, 0.47862867049936646804,
                                     0.56888888888888888889, 0.47862867049936646804,
                                     0.23692688505618908751};
    double sum = 0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) {
            double x = 0.5 * at[i], y = 0.5 * at[j];
            sum += 0.25 * weight[i] * weight[j] * known_point(-5 - x, 5 - x, -5 - y, 5 - y, 1);
        }
    return sum;
}

int stability_large_source(struct stability_trial *trial)
{
    struct made_scene scene = {.count = 0};
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0, 1);
    made_quad(&scene, 0, -0.5, -0.5, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 1, -5, -5, 1, 0, 10, 0, 10, 0, 0);
    struct solved s;
    if (stability_solve(&s, &scene, trial, 0) < 0)
        return -1;
    trial->error = fabs(stability_irradiance(&s, 0) / wide_source() - 1);
    trial->count = (double)s.links.count;
    solved_close(&s);
    return 0;
}

/* The range of F over what is left of r, as a share of its largest value. */
static double range_left(const struct element *r, const struct element *s)
{
    double range[2];
    form_factor_range_sample(r, s, range);
    return range[1] > 0 ? 1 - range[0] / range[1] : 0;
}

/* Split polygons 0 (receiver) and 1 six times by the trial's rule, going on with the quarter
 * nearest to the other element's centre; the error is the range of F over the receiver that is
 * left. */
static void split_six(struct stability_trial *trial, const struct made_scene *scene)
{
    struct element pair[2] = {made_element(scene, 0), made_element(scene, 1)};
    for (int i = 0; i < 6; i++) {
        const struct element *r = &pair[0], *s = &pair[1];
        int which = trial->method == &stability_methods[LARGER]   ? s->area > r->area
                    : trial->method == &stability_methods[LONGER] ? s->radius > r->radius
                                                                  : !(range_left(r, s) > 0.1);
        const struct element whole = pair[which];
        double best = INFINITY;
        for (int q = 0; q < 4; q++) {
            struct element quarter;
            surface_quarter(&whole, q, &quarter);
            double v[3];
            sub3(v, quarter.centre, pair[!which].centre);
            if (dot3(v, v) < best) {
                best = dot3(v, v);
                pair[which] = quarter;
            }
        }
    }
    trial->error = range_left(&pair[0], &pair[1]);
}

/* A skirting of 4 m by 1 mm, a lamp of .3 by .3 over one end. */
int stability_long_receiver(struct stability_trial *trial)
{
    struct made_scene scene = {.count = 0};
    made_quad(&scene, 0, 0, 0, 0, 4, 0, 0, 0, 1e-3, 0);
    made_quad(&scene, 0, 0, -0.15, 0.5, 0, 0.3, 0, 0.3, 0, 0);
    split_six(trial, &scene);
    return 0;
}

/* A unit square under the edge of a square of 10: F varies over the small one. */
int stability_large_source_split(struct stability_trial *trial)
{
    struct made_scene scene = {.count = 0};
    made_quad(&scene, 0, 4.5, 4.5, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, 5, 0, 1, 0, 10, 0, 10, 0, 0);
    split_six(trial, &scene);
    return 0;
}

/* The range of F(x) over a floor cell of width h by its edge, to a wall cell of width h on that
 * edge. */
static double touching_range(double h)
{
    enum { SIDE = 8 };
    const struct polygon wall = {4, {{0, 0, 0}, {0, 0, h}, {h, 0, h}, {h, 0, 0}}};
    const double up[3] = {0, 0, 1};
    double low = INFINITY, high = 0;
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            const double p[3] = {h * (i + 0.5) / SIDE, h * (j + 0.0625) / SIDE, 0};
            double f = lambert_sum(p, up, (const double(*)[3])wall.v, wall.n);
            low = fmin(low, f);
            high = fmax(high, f);
        }
    return high - low;
}

/* What is left of the measure after 4 halvings. */
int stability_touching_cells(struct stability_trial *trial)
{
    enum { HALVINGS = 4 };
    double h = 1 / (double)(1 << HALVINGS), left = touching_range(h) / touching_range(1);
    trial->error = trial->method == &stability_methods[AREA_GAP] ? left * h * h : left;
    return 0;
}

/* Of the links that carry more than the oracle allows, how many it does not own up to by a mark. */
int stability_touching_plates(struct stability_trial *trial)
{
    const double irradiance = 1 / (1 - 0.5);
    double over = 0, silent = 0;
    struct made_scene scene = {.count = 0};
    made_material(&scene, 0.5, 1);
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, 0, 0, 0, 0, 0, 1, 1, 0, 0);
    struct solved s;
    if (stability_solve(&s, &scene, trial, 0) < 0)
        return -1;
    for (size_t i = 0; i < s.links.count; i++) {
        const struct RadLink *l = &s.links.links[i];
        /* The oracle asks for the disc or better, so what is a little over need not have been. */
        int heavy = (double)l->form_factor * s.elements.elements[l->emitter].radiosity
                    > 1.5 * 0.05 * irradiance;
        over += heavy;
        silent += heavy && l->mark != 1;
    }
    trial->error = over > 0 ? silent / over : INFINITY;
    trial->count = over;
    solved_close(&s);
    return 0;
}

/* How much of the largest F(x) a range over the unit square misses; the source is .2 wide and .1
 * above (x, y). */
static int missed_range(struct stability_trial *trial, double x, double y)
{
    const double most = known_point(-0.1, 0.1, -0.1, 0.1, 0.1);
    double high = 0;
    struct made_scene scene = {.count = 0};
    made_quad(&scene, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0);
    made_quad(&scene, 0, x - 0.1, y - 0.1, 0.1, 0, 0.2, 0, 0.2, 0, 0);
    const struct element r = made_element(&scene, 0), s = made_element(&scene, 1);
    if (trial->method == &stability_methods[CORNERS]) {
        for (int k = 0; k < 4; k++) {
            double a = s.centre[0] - r.vertex[k][0], b = s.centre[1] - r.vertex[k][1];
            high = fmax(high, known_point(a - 0.1, a + 0.1, b - 0.1, b + 0.1, 0.1));
        }
    } else {
        double range[2];
        if (trial->method == &stability_methods[SAMPLED])
            form_factor_range_sample(&r, &s, range);
        else
            form_factor_range_bound(&r, &s, range);
        high = range[1];
    }
    trial->error = high >= most ? 0 : 1 - high / most;
    return 0;
}

int stability_range_centre(struct stability_trial *trial)
{
    return missed_range(trial, 0.5, 0.5);
}

int stability_range_quarter(struct stability_trial *trial)
{
    return missed_range(trial, 0.3, 0.27);
}

/* Four shadows on a floor of 2, from a source of .2 at height 2 and squares at height 1. */
static const double shadow_side[4] = {0.12, 0.2, 0.35, 0.6};
#define SHADOW_AT 0.05

static double shadowed(double side, double x, double y)
{
    const double source[4] = {-0.1 - x, 0.1 - x, -0.1 - y, 0.1 - y}, at = 0.5 * SHADOW_AT;
    const double blocker[4] = {at - 0.5 * side - x, at + 0.5 * side - x, at - 0.5 * side - y,
                               at + 0.5 * side - y};
    return known_penumbra(source, 2, blocker, 1);
}

/* How wrong the means over 8 x 8 cells are, by a norm. */
static double cells_error(const struct stability_method *method, double side)
{
    enum { CELLS = 8, PARTS = 8 };
    const double h = 2.0 / CELLS / PARTS, clear = known_point(-0.1, 0.1, -0.1, 0.1, 2);
    double square = 0, most = 0, core = 0;
    for (int i = 0; i < CELLS * CELLS; i++) {
        double value[PARTS * PARTS], mean = 0;
        for (int j = 0; j < PARTS * PARTS; j++) {
            double x = -1 + h * (i % CELLS * PARTS + j % PARTS + 0.5),
                   y = -1 + h * (i / CELLS * PARTS + j / PARTS + 0.5);
            value[j] = shadowed(side, x, y);
            mean += value[j] / (PARTS * PARTS);
        }
        for (int k = 0; k < PARTS * PARTS; k++) {
            square += h * h * (value[k] - mean) * (value[k] - mean);
            most = fmax(most, fabs(value[k] - mean));
        }
        if (i == (CELLS + 1) * (CELLS / 2)) /* the cell that the shadow's middle lies in */
            core = mean;
    }
    return method == &stability_methods[L2_NORM]     ? sqrt(square) / clear
           : method == &stability_methods[LINF_NORM] ? most / clear
                                                     : core / clear;
}

/* How far the centre of an element is from the shadow's middle, along the axes. */
static double off_middle(const struct element *e)
{
    return fmax(fabs(e->centre[0] - SHADOW_AT), fabs(e->centre[1] - SHADOW_AT));
}

/* B of the leaf in the middle of the shadow, against what is left of the light there. */
static int core_error(struct stability_trial *trial, double side, double *error)
{
    struct made_scene scene = {.count = 0};
    made_material(&scene, 0.5, 0);
    made_material(&scene, 0, 1);
    made_material(&scene, 0, 0);
    made_quad(&scene, 0, -1, -1, 0, 2, 0, 0, 0, 2, 0);
    made_quad(&scene, 1, -0.1, -0.1, 2, 0, 0.2, 0, 0.2, 0, 0);
    made_quad(&scene, 2, 0.5 * (SHADOW_AT - side), 0.5 * (SHADOW_AT - side), 1, side, 0, 0, 0, side,
              0);
    struct solved s;
    if (stability_solve(&s, &scene, trial, 0) < 0)
        return -1;
    const struct element *all = s.elements.elements;
    uint32_t e = s.elements.face_element[0];
    while (all[e].children) {
        uint32_t best = all[e].child;
        for (uint32_t c = 1; c < all[e].children; c++)
            if (off_middle(&all[all[e].child + c]) < off_middle(&all[best]))
                best = all[e].child + c;
        e = best;
    }
    *error =
        fabs(s.elements.radiosity[e] / 0.5 - shadowed(side, all[e].centre[0], all[e].centre[1]))
        / known_point(-0.1, 0.1, -0.1, 0.1, 2);
    trial->count = (double)s.links.count;
    solved_close(&s);
    return 0;
}

/* A norm: its value for the shadow it finds best, as a share of that for the worst; one that tells
 * shadows that are lost from those that are kept gives next to nothing. An oracle: its error in the
 * middle of the worst. */
int stability_four_shadows(struct stability_trial *trial)
{
    double low = INFINITY, high = 0;
    for (int i = 0; i < 4; i++) {
        double error;
        if (trial->method->kind == BY_RULE)
            error = cells_error(trial->method, shadow_side[i]);
        else if (core_error(trial, shadow_side[i], &error) < 0)
            return -1;
        low = fmin(low, error);
        high = fmax(high, error);
    }
    trial->error = trial->method->kind == BY_RULE ? low / high : high;
    return 0;
}
