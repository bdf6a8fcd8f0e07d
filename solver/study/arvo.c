/* arvo.c - see arvo.h. Closed forms and Gauss rules, no sampling.
 *
 * From a point under a corner of an a x b rectangle F is a sum of arc tangents [Howell, B-4], odd
 * in a and b, so that four corners make any place. Its integrals over a, and over a and b, are
 * elementary too (strip, block below; differentiate them to see it). F falls away from both axes:
 * it is the source's square blurred by a kernel that falls with distance. Hence in a quarter
 * of the receiver
 *
 *  - the range over an element lies between two of its corners: Linf needs no search;
 *  - on a line of constant y, F is above c up to one place X(y), found by bracketing, and the
 *    integral of F up to it is closed. Along y there remains a Gauss rule, between the places where
 *    X reaches the element's sides. Near the upper of them X may go like a square root (where the
 *    side is an axis), so y = top - length t^2, of which X is smooth. The median is the c
 *    that is exceeded on half of the area.
 *
 * Galerkin's mean is the closed block; the best constant in L2 comes from the Gauss moments of F
 * instead, so that the two check each other. The receiver is symmetric: a
 * quarter, and of it the half with x <= y, stands for all. An element on an axis is halved by it,
 * which changes neither its constants nor its share of the norms.
 * SPDX-License-Identifier: MIT */
#include "study/arvo.h"

#include <math.h>
#include <stdlib.h>

#include "study/closed_forms.h"
#include "util/array.h"

#define SOURCE 0.5   /* m, half its side */
#define RECEIVER 5.0 /* m, half its side */
#define PANEL 0.625  /* m, the longest stretch that one Gauss rule covers: F has poles 1 m away */

/* Of the bracket, what a root may be off. Both the place where F = c and the median are where the
 * integral of |F - c| is stationary: it is off by the square of this. */
#define ROOT 1e-8

enum { POINTS = 16 }; /* of a Gauss rule */

struct rule {
    double at[POINTS], weight[POINTS]; /* on [0, 1] */
};

/* Part of an element, in the quarter x, y >= 0, cut off at the axes. */
struct cell {
    const struct rule *rule;
    double x0, x1, y0, y1, area, centre[2]; /* centre: of the whole element */
    double whole;                           /* integral of F, W */
};

/* ---- F and its integrals */

/* Sum over the source's corners, seen from (x, y), of a function odd in both: its mixed
 * difference. */
static double corners(double (*g)(double a, double b), double x, double y)
{
    return g(x + SOURCE, y + SOURCE) - g(x + SOURCE, y - SOURCE) - g(x - SOURCE, y + SOURCE)
           + g(x - SOURCE, y - SOURCE);
}

static double point(double a, double b)
{
    return closed_corner(a, b, 1);
}

/* Its integral over a, but for a function of b alone. */
static double strip(double a, double b)
{
    double s = sqrt(1 + a * a), t = sqrt(1 + b * b);
    return (s * atan(b / s) + a * b / t * atan(a / t)) / (2 * M_PI);
}

/* The integral of that over b, but for functions of a or of b alone. */
static double block(double a, double b)
{
    double s = sqrt(1 + a * a), t = sqrt(1 + b * b);
    return (b * s * atan(b / s) + a * t * atan(a / t) - 0.5 * log(1 + a * a + b * b)) / (2 * M_PI);
}

static double factor(double x, double y)
{
    return corners(point, x, y);
}

static double integral(const struct cell *c)
{
    return corners(block, c->x1, c->y1) - corners(block, c->x0, c->y1)
           - corners(block, c->x1, c->y0) + corners(block, c->x0, c->y0);
}

/* ---- rules and roots */

/* Gauss and Legendre's points on [0, 1], by Newton's method from their asymptotic places. */
static void make_rule(struct rule *r)
{
    for (int i = 0; i < POINTS; i++) {
        double x = cos(M_PI * (i + 0.75) / (POINTS + 0.5)), slope = 1;
        for (int step = 0; step < 8; step++) {
            double p = x, before = 1;
            for (int k = 2; k <= POINTS; k++) {
                double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
                before = p;
                p = next;
            }
            slope = POINTS * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        r->at[i] = 0.5 * (1 - x);
        r->weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

/* Where the falling f passes zero between low and high; the end where it does not. The false
 * position with Illinois' halving [Dowell and Jarratt 1971]. */
static double root(double (*f)(const void *context, double x), const void *context, double low,
                   double high)
{
    double above = f(context, low), below = f(context, high), tolerance = ROOT * (high - low);
    if (above <= 0)
        return low;
    if (below >= 0)
        return high;
    for (int last = 0; high - low > tolerance;) {
        double x = low + (high - low) * above / (above - below);
        double value = f(context, x);
        if (x <= low || x >= high || value == 0)
            return x;
        if (value > 0) {
            if (fabs(x - low) <= tolerance)
                return x;
            low = x;
            above = value;
            below *= last > 0 ? 0.5 : 1;
        } else {
            if (fabs(high - x) <= tolerance)
                return x;
            high = x;
            below = value;
            above *= last < 0 ? 0.5 : 1;
        }
        last = value > 0 ? 1 : -1;
    }
    return 0.5 * (low + high);
}

/* ---- the part of an element above a constant */

struct level {
    double c, other; /* the constant, and the coordinate that is held */
};

static double over(const void *context, double x)
{
    const struct level *l = context;
    return factor(x, l->other) - l->c;
}

struct above {
    double area, excess; /* m2 where F > c, W of F - c there */
};

/* One line of constant y, from x0 to where F falls to c. */
static void add_line(struct above *a, const struct cell *e, double c, double y, double weight)
{
    const struct level l = {c, y};
    double x = root(over, &l, e->x0, e->x1);
    a->area += weight * (x - e->x0);
    a->excess += weight * (corners(strip, x, y) - corners(strip, e->x0, y) - c * (x - e->x0));
}

static struct above above(const struct cell *e, double c)
{
    struct above a = {0, 0};
    /* F is symmetric, so y on a side x takes the function of x. */
    const struct level far = {c, e->x1}, near = {c, e->x0};
    double full = root(over, &far, e->y0, e->y1), top = root(over, &near, e->y0, e->y1);
    const double ends[3] = {e->y0, full, top};
    for (int part = 0; part < 2; part++) {
        double length = ends[part + 1] - ends[part];
        int panels = (int)ceil(length / PANEL);
        for (int p = 0; p < panels; p++)
            for (int i = 0; i < POINTS; i++) {
                double t = (p + e->rule->at[i]) / panels;
                add_line(&a, e, c, ends[part + 1] - length * t * t,
                         2 * t * length * e->rule->weight[i] / panels);
            }
    }
    return a;
}

static double past_half(const void *context, double c)
{
    const struct cell *e = context;
    return above(e, c).area - 0.5 * e->area;
}

/* ---- norms over one element */

/* Integral of |F - c|, W. */
static double absolute(const struct cell *e, double c)
{
    return 2 * above(e, c).excess - (e->whole - c * e->area);
}

/* Integrals of F and F^2 by Gauss. */
static void moments(const struct cell *e, double moment[2])
{
    int panels = (int)ceil((e->x1 - e->x0) / PANEL);
    double wide = (e->x1 - e->x0) / panels, high = (e->y1 - e->y0) / panels;
    moment[0] = moment[1] = 0;
    for (int p = 0; p < panels * panels; p++)
        for (int i = 0; i < POINTS * POINTS; i++) {
            double x = e->x0 + wide * (p % panels + e->rule->at[i % POINTS]);
            double y = e->y0 + high * (p / panels + e->rule->at[i / POINTS]);
            double w = wide * high * e->rule->weight[i % POINTS] * e->rule->weight[i / POINTS];
            double f = factor(x, y);
            moment[0] += w * f;
            moment[1] += w * f * f;
        }
}

/* One element that stands for `times`: its share of L1, of the square of L2, and Linf. */
static void add_cell(struct arvo_errors *all, const struct cell *e, double times)
{
    double high = factor(e->x0, e->y0), low = factor(e->x1, e->y1), moment[2];
    moments(e, moment);
    double constant[ARVO_NORMS][ARVO_PROJECTIONS];
    constant[ARVO_L1][ARVO_BEST] = root(past_half, e, low, high);
    constant[ARVO_L2][ARVO_BEST] = moment[0] / e->area;
    constant[ARVO_LINF][ARVO_BEST] = 0.5 * (low + high);
    for (int k = 0; k < ARVO_NORMS; k++) {
        constant[k][ARVO_GALERKIN] = e->whole / e->area;
        constant[k][ARVO_COLLOCATION] = factor(e->centre[0], e->centre[1]);
    }
    all->norm[ARVO_L1] += times * e->whole;
    all->norm[ARVO_L2] += times * moment[1];
    all->norm[ARVO_LINF] = fmax(all->norm[ARVO_LINF], high);
    for (int k = 0; k < ARVO_PROJECTIONS; k++) {
        double c = constant[ARVO_L2][k];
        all->of[ARVO_L1][k] += times * absolute(e, constant[ARVO_L1][k]);
        all->of[ARVO_L2][k] += times * (moment[1] - 2 * c * moment[0] + c * c * e->area);
        c = constant[ARVO_LINF][k];
        all->of[ARVO_LINF][k] = fmax(all->of[ARVO_LINF][k], fmax(high - c, c - low));
    }
}

/* The stretch of the i-th of n elements that is not beyond the axis, and the element's middle. */
static double stretch(int i, int n, double *from, double *to)
{
    double side = 2 * RECEIVER / n, middle = side * (i + 0.5 - 0.5 * n);
    *from = fmax(0, middle - 0.5 * side);
    *to = middle + 0.5 * side;
    return 2 * i + 1 == n ? 0 : middle;
}

static void take_roots(struct arvo_errors *errors)
{
    errors->norm[ARVO_L2] = sqrt(errors->norm[ARVO_L2]);
    for (int k = 0; k < ARVO_PROJECTIONS; k++)
        errors->of[ARVO_L2][k] = sqrt(fmax(0, errors->of[ARVO_L2][k]));
}

void arvo_measure(struct arvo_errors *errors, int n)
{
    struct rule rule;
    make_rule(&rule);
    *errors = (struct arvo_errors){0};
    for (int i = n / 2; i < n; i++)
        for (int j = i; j < n; j++) {
            struct cell e = {.rule = &rule};
            e.centre[0] = stretch(i, n, &e.x0, &e.x1);
            e.centre[1] = stretch(j, n, &e.y0, &e.y1);
            e.area = (e.x1 - e.x0) * (e.y1 - e.y0);
            e.whole = integral(&e);
            add_cell(errors, &e, i == j ? 4 : 8);
        }
    take_roots(errors);
}

/* ---- the same by samples */

/* One whole element by m x m midpoints, which stands for `times`; f has room for them. */
static void add_samples(struct arvo_errors *all, double *f, int m, const double centre[2],
                        double side, double times)
{
    size_t count = (size_t)m * (size_t)m;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double x = centre[0] + side * (((double)(i % (size_t)m) + 0.5) / m - 0.5);
        double y = centre[1] + side * (((double)(i / (size_t)m) + 0.5) / m - 0.5);
        sum += f[i] = factor(x, y);
    }
    qsort(f, count, sizeof *f, compare_numbers);
    double mean = sum / (double)count, here = factor(centre[0], centre[1]);
    const double constant[2][ARVO_PROJECTIONS] = {{f[count / 2], mean, here}, {mean, mean, here}};
    double share = times * side * side / (double)count;
    for (size_t i = 0; i < count; i++) {
        all->norm[ARVO_L1] += share * f[i];
        all->norm[ARVO_L2] += share * f[i] * f[i];
        for (int k = 0; k < ARVO_PROJECTIONS; k++) {
            double off = f[i] - constant[ARVO_L2][k];
            all->of[ARVO_L1][k] += share * fabs(f[i] - constant[ARVO_L1][k]);
            all->of[ARVO_L2][k] += share * off * off;
        }
    }
}

int arvo_sample(struct arvo_errors *errors, int n, int samples)
{
    struct arvo_errors exact;
    arvo_measure(&exact, n);
    *errors = (struct arvo_errors){0};
    int m = (samples + n - 1) / n;
    double *f = malloc((size_t)m * (size_t)m * sizeof *f);
    if (!f)
        return -1;
    for (int i = n / 2; i < n; i++)
        for (int j = i; j < n; j++) {
            double from, to;
            const double centre[2] = {stretch(i, n, &from, &to), stretch(j, n, &from, &to)};
            add_samples(errors, f, m, centre, 2 * RECEIVER / n,
                        (centre[0] > 0 ? 2 : 1) * (centre[1] > 0 ? 2 : 1) * (i == j ? 1 : 2));
        }
    free(f);
    take_roots(errors);
    errors->norm[ARVO_LINF] = exact.norm[ARVO_LINF];
    for (int k = 0; k < ARVO_PROJECTIONS; k++)
        errors->of[ARVO_LINF][k] = exact.of[ARVO_LINF][k];
    return 0;
}
