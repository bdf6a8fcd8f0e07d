/* stability_sphere.c - cases that many flat faces tend to: spheres, and plates without end.
 *
 * As faces get half as wide, or plates twice as wide, the error falls to a quarter; so two levels
 * give what many would tend to. Sources: closed forms of spheres and of infinite parallel plates.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"

/* Triangles of a sphere seen from inside, or from outside: an octahedron's faces in quarters
 * `level` times. material(context, centre) names each. */
struct sphere {
    double radius;
    int outward;
    uint32_t (*material)(const double centre[3]);
};

static void add_sphere(struct made_scene *s, const struct sphere *sphere, const double a[3],
                       const double b[3], const double c[3], int level)
{
    double p[3][3], centre[3];
    if (level > 0) {
        double middle[3][3];
        for (int i = 0; i < 3; i++) {
            const double *u = i == 0 ? a : i == 1 ? b : c, *v = i == 0 ? b : i == 1 ? c : a;
            for (int k = 0; k < 3; k++)
                middle[i][k] = u[k] + v[k];
            double size = length3(middle[i]);
            for (int k = 0; k < 3; k++)
                middle[i][k] /= size;
        }
        add_sphere(s, sphere, a, middle[0], middle[2], level - 1);
        add_sphere(s, sphere, b, middle[1], middle[0], level - 1);
        add_sphere(s, sphere, c, middle[2], middle[1], level - 1);
        add_sphere(s, sphere, middle[0], middle[1], middle[2], level - 1);
        return;
    }
    for (int k = 0; k < 3; k++) {
        p[0][k] = sphere->radius * a[k];
        p[1][k] = sphere->radius * (sphere->outward ? b : c)[k];
        p[2][k] = sphere->radius * (sphere->outward ? c : b)[k];
        centre[k] = a[k] + b[k] + c[k];
    }
    made_face(s, sphere->material(centre), 3, (const double(*)[3])p);
}

static void made_sphere(struct made_scene *s, const struct sphere *sphere, int level)
{
    for (int i = 0; i < 8; i++) {
        const double x[3] = {i & 1 ? -1 : 1, 0, 0}, y[3] = {0, i & 2 ? -1 : 1, 0},
                     z[3] = {0, 0, i & 4 ? -1 : 1};
        int even = !(((i & 1) + (i >> 1 & 1) + (i >> 2 & 1)) & 1);
        add_sphere(s, sphere, x, even ? y : z, even ? z : y, level);
    }
}

/* Area mean of B (or of H) over faces from..to of a solution, of one material or, with
 * UINT32_MAX, of any. */
static double mean(const struct solved *s, uint32_t from, uint32_t to, uint32_t material,
                   int irradiance)
{
    const struct RadFace *faces = radGetSceneFaces(s->scene);
    double sum = 0, area = 0;
    for (uint32_t f = from; f < to; f++) {
        double a = stability_face(s, f)->area;
        if (material != UINT32_MAX && faces[f].material != material)
            continue;
        sum += a * (irradiance ? stability_irradiance : stability_radiosity)(s, f);
        area += a;
    }
    return sum / area;
}

static uint32_t face_count(const struct solved *s)
{
    struct RadSceneReport report;
    return radGetSceneReport(s->scene, &report) < 0 ? 0 : report.faces;
}

static uint32_t by_octant(const double centre[3])
{
    return (centre[2] > 0) + (centre[0] > 0 ? 2u : 0);
}

static uint32_t first_material(const double centre[3])
{
    (void)centre;
    return 0;
}

static uint32_t second_material(const double centre[3])
{
    (void)centre;
    return 1;
}

/* |value / known - 1| of what the numbers of levels 1 and 2 tend to. */
static int extrapolated(struct stability_trial *trial, const struct stability_scene *scene,
                        double known)
{
    double low, high;
    if (stability_measured(trial, scene, 1, &low) < 0
        || stability_measured(trial, scene, 2, &high) < 0)
        return -1;
    trial->error = fabs((high + (high - low) / 3) / known - 1);
    return 0;
}

/* E = 1 above, rho = .8 on one side and .2 on the other: H = <E> / (1 - <rho>) = 1 in the dark
 * half. */
static void make_sphere(struct made_scene *s, double level)
{
    const struct sphere sphere = {1, 0, by_octant};
    made_material(s, 0.2, 0);
    made_material(s, 0.2, 1);
    made_material(s, 0.8, 0);
    made_material(s, 0.8, 1);
    made_sphere(s, &sphere, (int)level);
}

static double dark_irradiance(const struct solved *s, double level)
{
    (void)level;
    return 0.5 * (mean(s, 0, face_count(s), 0, 1) + mean(s, 0, face_count(s), 2, 1));
}

int stability_sphere(struct stability_trial *trial)
{
    static const struct stability_scene sphere = {make_sphere, dark_irradiance};
    return extrapolated(trial, &sphere, 1);
}

/* Half of a sphere open: walls of emissivity .1 seem to have .1 / (.1 + .5 * .9). */
static void make_hollow(struct made_scene *s, double level)
{
    const struct sphere sphere = {1, 0, by_octant};
    made_material(s, 0, 0);
    made_material(s, 0.9, 0.1);
    made_material(s, 0, 0);
    made_material(s, 0.9, 0.1);
    made_sphere(s, &sphere, (int)level);
}

static double wall_radiosity(const struct solved *s, double level)
{
    (void)level;
    return 0.5 * (mean(s, 0, face_count(s), 1, 0) + mean(s, 0, face_count(s), 3, 0));
}

int stability_hollow_sphere(struct stability_trial *trial)
{
    static const struct stability_scene hollow = {make_hollow, wall_radiosity};
    return extrapolated(trial, &hollow, 0.1 / (0.1 + 0.5 * 0.9));
}

/* Radii 1/2 and 1, E = 1 within, rho = .5: B = 10/9 and 2/9. */
static void make_concentric(struct made_scene *s, double level)
{
    const struct sphere inner = {0.5, 1, first_material}, outer = {1, 0, second_material};
    made_material(s, 0.5, 1);
    made_material(s, 0.5, 0);
    made_sphere(s, &inner, (int)level);
    made_sphere(s, &outer, (int)level);
}

static double outer_radiosity(const struct solved *s, double level)
{
    (void)level;
    return mean(s, face_count(s) / 2, face_count(s), UINT32_MAX, 0);
}

int stability_concentric(struct stability_trial *trial)
{
    static const struct stability_scene concentric = {make_concentric, outer_radiosity};
    return extrapolated(trial, &concentric, 2 / 9.0);
}

/* Plates of `wide` x `wide` unit squares, so wide that the middle ones see little else, E = 1 and
 * 0, rho = .5 and .8; what those lack of infinite ones falls as 1/wide2. */
static int wide_at(double level)
{
    return 3 << (int)level;
}

static void make_wide(struct made_scene *s, double level)
{
    int wide = wide_at(level);
    made_material(s, 0.5, 1);
    made_material(s, 0.8, 0);
    for (int i = 0; i < wide * wide; i++) {
        made_quad(s, 0, i % wide, i / wide, 0, 1, 0, 0, 0, 1, 0);
        made_quad(s, 1, i % wide, i / wide, 1, 0, 1, 0, 1, 0, 0);
    }
}

static double middle_radiosity(const struct solved *s, double level)
{
    int wide = wide_at(level);
    return stability_radiosity(s, (uint32_t)(wide / 2 * wide + wide / 2) * 2);
}

int stability_wide_plates(struct stability_trial *trial)
{
    static const struct stability_scene wide = {make_wide, middle_radiosity};
    return extrapolated(trial, &wide, (1 + 0.5 * 0) / (1 - 0.5 * 0.8));
}
