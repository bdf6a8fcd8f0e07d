/* picture_table.c - how far what pictures show is from the light at each pixel: picture_table solve
 * SCENE [options of solve], the picture's --size and --view, and --gather N, the rays of the truth.
 *
 * The truth is what each pixel's point gathers from the mended solution by N rays, in sets of which
 * no other gathering takes any. A row of a table: root mean squares over all pixels that show no
 * lamp, of the error of luminance, cut off where the picture is white, over the root mean square of
 * luminance, and of that of the sRGB value that the exposure makes of it, in 255 steps: of leaves
 * as constants, of means of leaves interpolated, of what corners gather for 1024 x 768 pixels,
 * interpolated, and of the truth's own noise.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "options/options.h"
#include "output/picture.h"
#include "output/raster.h"
#include "scene/open_scene.h"
#include "util/open_oracle.h"

enum { FLAT, MEANS, CORNERS, TRUTH, AGAIN, KINDS };

struct shown {
    size_t count;
    struct RadGatherPoint *point;
    double *light[KINDS]; /* [point * bands + band], W/m2 */
};

static void find_points(struct shown *s, const struct picture *p)
{
    size_t all = (size_t)p->width * (size_t)p->height;
    struct raster r;
    uint32_t *face = malloc(all * sizeof *face);
    double *nearness = malloc(all * sizeof *nearness);
    s->point = calloc(all, sizeof *s->point);
    raster_begin(&r, &p->solution->surfaces, &p->view, p->width, p->height, 0);
    raster_rows(&r, 0, p->height, face, nearness);
    for (size_t i = 0; i < all; i++) {
        double direction[3];
        if (face[i] == NO_FACE || is_lamp(&p->solution->surfaces, face[i]))
            continue;
        s->point[s->count] = (struct RadGatherPoint){.face = face[i], .set = (i + 1) << 32};
        raster_point(&r, p->solution, face[i], (double)(i % (size_t)p->width),
                     (double)(i / (size_t)p->width), direction, s->point[s->count++].position);
    }
    raster_end(&r);
    free(face);
    free(nearness);
}

static void look(struct shown *s, const struct picture *p, const struct vertex_values *values,
                 int kind)
{
    uint32_t bands = p->solution->tree.bands;
    for (size_t i = 0; i < s->count; i++) {
        double *here = &s->light[kind][i * bands];
        uint32_t leaf =
            vertex_values_at(values, p->solution, s->point[i].face, s->point[i].position, here);
        for (uint32_t k = 0; k < bands && kind == FLAT; k++)
            here[k] = radiosity_at(p->solution, leaf, k, s->point[i].position);
    }
}

static int gather(struct shown *s, RadSolution solution, uint32_t rays, int kind)
{
    for (size_t i = 0; i < s->count; i++) {
        s->point[i].rays = rays;
        s->point[i].set += kind == AGAIN;
    }
    return radGather(solution, s->point, s->count, s->light[kind]);
}

static double tone(const struct picture *p, const double *light)
{
    double colour[3];
    exposure_apply(&p->exposure, light, p->solution->tree.bands, colour);
    return srgb_byte(luminance(colour, 3));
}

static void print_errors(const struct shown *s, const struct picture *p, int kind, int truth)
{
    uint32_t bands = p->solution->tree.bands;
    double off = 0, all = 0, steps = 0, white = p->exposure.white / p->exposure.scale;
    for (size_t i = 0; i < s->count; i++) {
        const double *a = &s->light[kind][i * bands], *b = &s->light[truth][i * bands];
        double shown = fmin(luminance(a, bands), white), is = fmin(luminance(b, bands), white);
        off += (shown - is) * (shown - is);
        all += is * is;
        steps += pow(tone(p, a) - tone(p, b), 2);
    }
    printf(" %.1f %% (%.1f) |", 100 * sqrt(off / all), sqrt(steps / (double)s->count));
}

static int show(const struct options *o, const struct open_scene *scene, RadSolution solved)
{
    const struct surfaces surfaces = surfaces_of(scene->scene, NULL, NULL);
    const struct solution solution = solution_of(&surfaces, solved, o->threads);
    struct vertex_values values;
    struct picture p;
    struct shown s = {0};
    uint8_t *seen = malloc(solution.tree.count);
    if (!seen || vertex_values_build(&values, &solution) < 0
        || picture_open(&p, o->scene, &solution, &values, o->view_given ? &o->view : NULL, o->width,
                        o->height, 0)
               < 0)
        return -1;
    find_points(&s, &p);
    for (int kind = 0; kind < KINDS; kind++)
        s.light[kind] = malloc(s.count * solution.tree.bands * sizeof(double));
    look(&s, &p, &values, FLAT);
    look(&s, &p, &values, MEANS);
    struct gathering gathering = {o->scene, scene->device, solved, NULL, 0, 0};
    memset(seen, 1, solution.tree.count);
    if (gathering_corners(&gathering, &values, &solution, seen, 1024 * 768) < 0
        || gather(&s, solved, (uint32_t)o->gather, TRUTH) < 0
        || gather(&s, solved, (uint32_t)o->gather, AGAIN) < 0)
        return -1;
    look(&s, &p, &values, CORNERS);
    printf("| %s |", o->scene);
    for (int kind = 0; kind < TRUTH; kind++)
        print_errors(&s, &p, kind, TRUTH);
    print_errors(&s, &p, AGAIN, TRUTH);
    printf("\n");
    for (int kind = 0; kind < KINDS; kind++)
        free(s.light[kind]);
    free(s.point);
    free(seen);
    vertex_values_free(&values);
    return 0;
}

int main(int count, char **arguments)
{
    struct options o;
    struct open_scene scene;
    int status = options_parse(&o, count, arguments);
    if (status >= 0)
        return status;
    const struct scene_options how = {.two_sided = o.two_sided, .quiet = 1};
    if (open_scene(&scene, o.scene, &how, o.threads) < 0)
        return 1;
    RadOracle oracle = open_oracle(scene.device, o.oracle, o.release, o.settings, o.setting_count);
    RadSolution solved = oracle ? radNewSolution(scene.scene, oracle, NULL) : NULL;
    status = !solved || radSolve(solved) < 0 || radCorrect(solved, NULL, NULL) < 0
             || show(&o, &scene, solved) < 0;
    if (status)
        fprintf(stderr, "picture_table: %s\n", radGetDeviceErrorMessage(scene.device));
    radReleaseSolution(solved);
    radReleaseOracle(oracle);
    close_scene(&scene);
    options_free(&o);
    return status;
}
