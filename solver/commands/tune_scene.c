/* tune_scene.c - see tune_scene.h.
 *
 * One reference for all solutions of a scene: its noise then hardly tells on which of two is
 * better. What it adds to the sum of errors is taken off by the engine (engine/face_error.c). It is
 * of particles alone: beside them, paths lower the noise of face means by some hundredths at the
 * price of a quarter more rays (`radiosity reference cornell.obj`: .198 and .193 %; maze_8 .196 and
 * .195 %).
 * SPDX-License-Identifier: MIT */
#include "commands/tune_scene.h"

#include <math.h>

#include "util/beside.h"
#include "util/device.h"
#include "util/report.h"

/* Particles traced first: of a scene of few faces, and of each face. */
enum { FIRST = 1 << 15, FIRST_OF_FACE = 16 };

/* By how much their number grows from look to look, at the least and at the most. */
static const double LEAST_MORE = 1.25, MOST_MORE = 8;

/* How well an error shall be known, as a share of it. */
static const double UNCERTAIN = 0.2;

int tune_scene_open(struct tune_scene *t, const char *path, const struct scene_options *options,
                    int threads)
{
    const char *name = path_name(path);
    *t = (struct tune_scene){.name = name, .name_length = (int)path_stem(name)};
    return open_scene(&t->scene, path, options, threads);
}

void tune_scene_close(struct tune_scene *t)
{
    radReleaseReference(t->reference);
    t->reference = NULL;
    close_scene(&t->scene);
}

/* Trace until the solution's error is known well enough. Returns 0, or -1 after an error of the
 * device's. */
static int trace(struct tune_scene *t, RadSolution solution, double target)
{
    double first = FIRST_OF_FACE * (double)t->scene.report.faces;
    double count = first > FIRST ? first : FIRST;
    t->reference = radNewReference(t->scene.scene);
    if (!t->reference)
        return -1;
    for (;;) {
        struct RadErrorReport e;
        if (radTraceReference(t->reference, RAD_METHOD_PARTICLES, (uint64_t)count) < 0
            || radMeasureErrorBy(solution, t->reference, &e) < 0)
            return -1;
        t->particles = e.particles;
        t->uncertain = (e.l1_faces.high - e.l1_faces.low) / 2;
        double ratio = t->uncertain / (UNCERTAIN * fmax(target, e.l1_faces.value));
        if (!(e.reflected > 0) || !(ratio > 1))
            return 0;
        count *= fmin(fmax(ratio * ratio, LEAST_MORE), MOST_MORE);
    }
}

int tune_scene_error(struct tune_scene *t, RadSolution solution, double target, double *error)
{
    struct RadErrorReport e;
    if ((!t->reference && trace(t, solution, target) < 0)
        || radMeasureErrorBy(solution, t->reference, &e) < 0)
        return report_unless_cancelled(t->scene.device, t->scene.path);
    *error = e.l1_faces.value;
    return e.reflected > 0 ? 0
                           : report_error(t->scene.path, 0,
                                          "none of %.3g particles was reflected, so that no error "
                                          "can be told; give a scene with a lamp and surfaces that "
                                          "reflect its light",
                                          (double)e.particles);
}
