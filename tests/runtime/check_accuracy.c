/* check_accuracy.c - whole solutions at the defaults against traced particles: make check-accuracy.
 *
 * What `radiosity solve --faces` writes is compared with what path_reference.h finds, which knows
 * nothing of form factors, links and elements. Judged are the light reflected per face of the file,
 * as the relative L1 error over faces and bands (sum of |rho A (H - H_ref)| over the sum of rho A
 * H_ref), and the same sums with their sign. Noise of the reference can only raise the first in the
 * mean; its part is told, and may be a third of the bound. Standard errors come from the
 * independent batches of the reference, by the jackknife. ACCURACY_ONLY=SCENE leaves out the
 * others.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "hierarchy/scene.h"
#include "scene/read_scene.h"
#include "runtime/path_reference.h"
#include "command.h"
#include "suite.h"

/* Particles mend to a noise of half a percent (RAD_CORRECT_NOISE), two thirds more is left for what
 * stays below it; where a quarter of the links' rays ends them before that, more is left. */
#define BOUND 0.0085

static const struct accuracy {
    const char *scene, *path;
    int particles;
    double l1, power; /* bounds, relative */
    int known_failure;
} accuracies[] = {
    {"cornell", "examples/scenes/cornell.obj", 1 << 22, BOUND, BOUND, 0},
    {"room", "examples/scenes/room.obj", 1 << 24, BOUND, BOUND, 0},
    {"maze_8", "examples/scenes/maze_8.obj", 1 << 24, BOUND, BOUND, 0},
    {"sejour", "examples/scenes/sejour.obj", 1 << 24, 0.012, BOUND, 0},
    {"panels", "tests/runtime/panels.obj", 1 << 22, BOUND, BOUND, 0},
};

enum { SCENES = sizeof accuracies / sizeof *accuracies };

/* rho A H (W) of every face of the file and band, as the command's table has it. */
static double *solved_powers(const char *path, uint32_t faces, uint32_t bands)
{
    char table[] = "/tmp/accuracy-XXXXXX", line[4096];
    double *power = calloc((size_t)faces * bands, sizeof *power);
    int column[7], columns = 0, file = mkstemp(table);
    ck_assert_int_ge(file, 0);
    FILE *in = fdopen(file, "r");
    ck_assert_int_eq(shell("$RADIOSITY solve %s -q --faces %s", path, table), 0);
    in = freopen(table, "r", in); /* the command has put another file there */
    ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
    memset(column, -1, sizeof column);
    for (char *word = strtok(line, ",\n"); word; word = strtok(NULL, ",\n"), columns++)
        for (uint32_t k = 0; k < bands; k++) {
            char rho[16], h[16];
            snprintf(rho, sizeof rho, "rho_%u", k);
            snprintf(h, sizeof h, "H_%u", k);
            if (strcmp(word, "area") == 0)
                column[6] = columns;
            if (strcmp(word, rho) == 0)
                column[k] = columns;
            if (strcmp(word, h) == 0)
                column[3 + k] = columns;
        }
    ck_assert(column[0] >= 0 && column[3] >= 0 && column[6] >= 0);
    for (uint32_t f = 0; f < faces; f++) {
        double value[64] = {0};
        ck_assert_ptr_nonnull(fgets(line, sizeof line, in));
        int i = 0;
        for (char *at = line; at && i < 64; at = strchr(at, ','), at += at != NULL, i++)
            value[i] = strtod(at, NULL);
        ck_assert_int_eq(i, columns);
        for (uint32_t k = 0; k < bands; k++)
            power[(size_t)f * bands + k] =
                value[column[k]] * value[column[6]] * value[column[3 + k]];
    }
    fclose(in);
    unlink(table);
    return power;
}

struct errors {
    double l1, power;
};

/* Against the mean of all batches but `without`; -1: of all. */
static struct errors errors(const double *solved, const double *sum, const double *batch,
                            int without, size_t values)
{
    double count = without < 0 ? BATCHES : BATCHES - 1, wrong = 0, more = 0, all = 0;
    for (size_t i = 0; i < values; i++) {
        double reference =
            (without < 0 ? sum[i] : sum[i] - batch[(size_t)without * values + i]) / count;
        wrong += fabs(solved[i] - reference);
        more += solved[i] - reference;
        all += reference;
    }
    return (struct errors){wrong / all, more / all};
}

START_TEST(test_accuracy)
{
    const struct accuracy *want = &accuracies[_i];
    const struct scene_options how = {.quiet = 1};
    if (getenv("ACCURACY_ONLY") && strcmp(getenv("ACCURACY_ONLY"), want->scene) != 0)
        return;
    fprintf(stderr, "accuracy: %s ...\n", want->scene);
    struct scene scene;
    ck_assert_int_eq(scene_read(&scene, want->path, &how), 0);
    uint32_t bands = scene.bands;
    size_t values = (size_t)scene.input_count * bands;
    double *area = malloc(scene.face_count * sizeof *area),
           *powers = path_powers(&scene, want->particles, area);
    double *batch = calloc(BATCHES * values, sizeof *batch), *sum = calloc(values, sizeof *sum);
    for (size_t b = 0; b < BATCHES; b++)
        for (uint32_t f = 0; f < scene.face_count; f++)
            for (uint32_t k = 0; k < bands; k++) {
                double reflected = scene.materials[scene.faces[f].material].reflectance[k]
                                   * powers[(b * scene.face_count + f) * bands + k];
                batch[b * values + (size_t)scene.faces[f].input * bands + k] += reflected;
                sum[(size_t)scene.faces[f].input * bands + k] += reflected;
            }
    double *solved = solved_powers(want->path, scene.input_count, bands), noise = 0, all = 0;
    for (size_t i = 0; i < values; i++) { /* the mean of |x| is sqrt(2 / pi) standard deviations */
        double squares = 0, mean = sum[i] / BATCHES;
        for (size_t b = 0; b < BATCHES; b++)
            squares += (batch[b * values + i] - mean) * (batch[b * values + i] - mean);
        noise += sqrt(2 / M_PI * squares / (BATCHES * (BATCHES - 1.0)));
        all += mean;
    }
    struct errors found = errors(solved, sum, batch, -1, values), spread = {0, 0}, part[BATCHES],
                  mean = {0, 0};
    for (int b = 0; b < BATCHES; b++) {
        part[b] = errors(solved, sum, batch, b, values);
        mean.l1 += part[b].l1 / BATCHES;
        mean.power += part[b].power / BATCHES;
    }
    for (int b = 0; b < BATCHES; b++) {
        spread.l1 += (part[b].l1 - mean.l1) * (part[b].l1 - mean.l1);
        spread.power += (part[b].power - mean.power) * (part[b].power - mean.power);
    }
    spread.l1 = sqrt(spread.l1 * (BATCHES - 1) / BATCHES);
    spread.power = sqrt(spread.power * (BATCHES - 1) / BATCHES);
    int right =
        found.l1 - 3 * spread.l1 <= want->l1 && fabs(found.power) - 3 * spread.power <= want->power;
    printf("accuracy %-8s %6u faces  L1 %6.3f %% +- %.3f, of it noise at most %.3f, bound %.2f;  "
           "power %+6.3f %% +- %.3f, bound %.2f  %s\n",
           want->scene, scene.input_count, 100 * found.l1, 100 * spread.l1, 100 * noise / all,
           100 * want->l1, 100 * found.power, 100 * spread.power, 100 * want->power,
           right ? want->known_failure ? "passes, though a known failure: judge it from now on"
                                       : "passed"
           : want->known_failure ? "KNOWN FAILURE"
                                 : "FAILED");
    fflush(stdout);
    ck_assert_msg(noise / all <= want->l1 / 3, "the reference is too noisy to judge by");
    ck_assert(right != want->known_failure);
    free(area);
    free(powers);
    free(batch);
    free(sum);
    free(solved);
    scene_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("accuracy");
    TCase *c = tcase_create("accuracy");
    tcase_set_timeout(c, 600);
    if (thorough())
        tcase_add_loop_test(c, test_accuracy, 0, SCENES);
    suite_add_tcase(suite, c);
    return suite_failures(suite) != 0;
}
