/* reference.c - see reference.h.
 *
 * How sure. Of a polygon that many particles have met, how the replicates differ says how sure
 * its mean is. Of one that few have met they say as little of that as of the mean: there what
 * chance alone makes of so much light is taken, and where none came, of what paths find. To either
 * method one thing unseen is allowed for: one more particle at the polygon, one more path that
 * finds as much as an average place of the scene has.
 *
 * Few paths find light that comes through a small hole: most polygons behind it would seem certain,
 * and a few on which one path lit would be far off. How paths scatter is therefore also asked of
 * all polygons that as many particles met, and paths are passed over where they would not tell a
 * good part.
 *
 * No method weighs itself. The mean of both is taken by weights that go against variances, and what
 * is dark by chance has too small a variance, too: by weights of their own polygons would be too
 * dark, by half a percent of all light where their noise is 4 %. So particles and paths each come
 * in two halves, and each half is weighed by what the other knows of its noise: both are right in
 * the mean, and so is what comes of them, whatever the weights.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "engine/reference.h"
#include "engine/reflected_light.h"
#include "engine/solve_tracer.h"
#include "engine/state_identity.h"
#include "engine/state_stream.h"
#include "kernel/constants.h"
#include "kernel/hash_bytes.h"

/* Random numbers that nothing else takes: a reference must not share its noise with what it
 * judges. Of paths each face has its own. */
static const uint64_t PARTICLE_STREAM = 0x7265666572, PATH_STREAM = (uint64_t)0x70617468 << 32;

int reference_open(struct reference *r, const struct scene *scene, int threads, struct ranks *ranks,
                   const char **cause)
{
    const struct solve_options options = {.tolerance = SOLVE_TOLERANCE,
                                          .iterations = 1,
                                          .threads = threads,
                                          .ranks = ranks,
                                          .all_sides = 1};
    *r = (struct reference){0};
    if (solve_open(&r->solve, scene, &options, cause) < 0)
        return -1;
    r->tracer = solve_tracer(&r->solve);
    const int failed = tracer_open(&r->tracer) < 0
                       || tally_open(&r->tally, &r->tracer, PARTICLE_STREAM, 0) < 0
                       || face_paths_open(&r->paths, &r->tracer, PATH_STREAM, 0) < 0;
    if (!ranks_any(ranks, failed))
        return 0;
    reference_close(r);
    *cause = "out of memory for what is counted";
    return -1;
}

void reference_close(struct reference *r)
{
    face_paths_close(&r->paths);
    tally_close(&r->tally);
    tracer_close(&r->tracer);
    solve_close(&r->solve);
}

static double area_of(const struct reference *r, uint32_t face)
{
    return tracer_surface(&r->tracer, face)->area;
}

/* ---- means of polygons */

/* What half of the replicates, and of the paths, say of a polygon: W, W^2. */
struct half {
    double counted, square;  /* by particles; mean of the squares of replicates */
    double found, scattered; /* by paths, and the variance of that */
    double light;            /* by particles, or where none came by paths */
};

/* Of polygons that about as many particles met: how many; the sum of variances of one path there
 * (W^2/m4); the sum of squares of light. */
struct alike {
    double polygons, scattered, light;
};

enum { CLASSES = 32 };

struct means {
    size_t count;      /* of polygons */
    double *area;      /* [count]: m2, all that the polygon became */
    double *one;       /* the same, for what is being summed */
    double *paths;     /* [count]: of each half */
    struct half *half; /* [count * PATH_HALVES + half] */
    struct alike alike[CLASSES];
};

static void means_close(struct means *m)
{
    free(m->area);
    free(m->one);
    free(m->paths);
    free(m->half);
}

static int means_open(struct means *m, size_t count)
{
    m->count = count;
    m->area = malloc((count + 1) * sizeof *m->area);
    m->one = malloc((count + 1) * sizeof *m->one);
    m->paths = malloc((count + 1) * sizeof *m->paths);
    m->half = malloc((count + 1) * PATH_HALVES * sizeof *m->half);
    if (m->area && m->one && m->paths && m->half)
        return 0;
    means_close(m);
    return -1;
}

static int class_of(const struct reference *r, const struct half *h)
{
    const double particles = h->counted / tally_power_of_one(&r->tally);
    return particles >= 1 ? (int)fmin(1 + log2(particles), CLASSES - 1) : 0;
}

/* What is known of each polygon's light, and how paths scatter where it is alike. */
static void compare(const struct reference *r, struct means *m)
{
    memset(m->alike, 0, sizeof m->alike);
    for (size_t i = 0; i < m->count * PATH_HALVES; i++) {
        struct half *h = &m->half[i];
        const double area = m->area[i / PATH_HALVES], paths = m->paths[i / PATH_HALVES];
        h->light = paths > 0 && !(h->counted > 0) ? h->found : h->counted;
        if (paths > 0 && area > 0) {
            struct alike *alike = &m->alike[class_of(r, h)];
            alike->polygons++;
            alike->light += h->light * h->light / (area * area);
            alike->scattered += h->scattered * paths / (area * area);
        }
    }
}

static void gather(const struct reference *r, uint32_t band, struct means *m)
{
    const struct scene *scene = r->solve.problem.scene;
    size_t count = m->count;
    double mean_light = r->tally.power / r->solve.hierarchy.elements[0].area;
    memset(m->area, 0, count * sizeof *m->area);
    memset(m->paths, 0, count * sizeof *m->paths);
    memset(m->half, 0, count * PATH_HALVES * sizeof *m->half);
    for (uint32_t i = 0; i < scene->face_count; i++) {
        uint32_t input = scene->faces[i].input;
        uint64_t paths = face_paths_count(&r->paths, i, r->paths.paths) / PATH_HALVES;
        double area = area_of(r, i), unseen = paths > 0 ? mean_light / (double)paths : 0;
        m->area[input] += area;
        m->paths[input] += (double)paths;
        for (int h = 0; h < PATH_HALVES; h++) {
            struct half *half = &m->half[(size_t)input * PATH_HALVES + (size_t)h];
            double mean, variance;
            face_paths_mean(&r->paths, h, i, band, &mean, &variance);
            half->found += area * mean;
            half->scattered += area * area * (variance + unseen * unseen);
        }
    }
    for (int k = 0; k < REPLICATES; k++) {
        memset(m->one, 0, count * sizeof *m->one);
        for (uint32_t i = 0; i < scene->face_count; i++)
            m->one[scene->faces[i].input] += tally_face(&r->tally, k, i, band);
        for (size_t i = 0; i < count; i++) {
            struct half *half = &m->half[i * PATH_HALVES + (size_t)(k % PATH_HALVES)];
            half->counted += m->one[i] * PATH_HALVES / REPLICATES;
            half->square += m->one[i] * m->one[i] * PATH_HALVES / REPLICATES;
        }
    }
    compare(r, m);
}

/* Irradiance of one polygon in one band by each method, and the variances (W/m2, squared). */
struct known {
    double mean[REFERENCE_METHODS], variance[REFERENCE_METHODS];
};

/* The variance of what so many replicates count at a polygon (W^2). */
static double spread_of(const struct reference *r, const struct half *h, int replicates,
                        uint32_t band)
{
    double one = tally_power_of_one(&r->tally), share = (double)REPLICATES / replicates;
    if (h->light < REFERENCE_FEW * one)
        return share * tally_chance(&r->tally, h->light, band);
    return fmax(h->square - h->counted * h->counted, 0) / (replicates - 1) + share * one * one;
}

/* The variance of what half of the paths find at a polygon (W^2), by those that as many particles
 * met. Where none came it goes with the square of light. */
static double alike_scatter(const struct reference *r, const struct means *m, size_t i,
                            const struct half *half)
{
    const int class = class_of(r, half);
    const struct alike *alike = &m->alike[class];
    if (!(m->paths[i] > 0) || !(alike->light > 0))
        return half->scattered;
    const double share = class ? m->area[i] * m->area[i] / alike->polygons
                               : half->light * half->light / alike->light;
    return share * alike->scattered / m->paths[i];
}

/* What the variance of half of the paths must be, at the least, for particles to be right: where
 * paths find a bright spot one time in a million they find less, and seem sure. So many times what
 * either expects of its noise is no news. */
static double missed(const struct half *half, double spread, double times)
{
    const double off = (half->found - half->counted) / times;
    return fmax(off * off - spread, 0);
}

static struct known weigh(const struct reference *r, const struct means *m, size_t i, uint32_t band)
{
    struct known k = {{0, 0, 0}, {0, 0, 0}};
    const struct half *half = &m->half[i * PATH_HALVES];
    double area = m->area[i], by_paths[PATH_HALVES], spread[PATH_HALVES], scattered[PATH_HALVES];
    struct half all = {0, 0, 0, 0, 0};
    if (!(area > 0))
        return k;
    int paths = m->paths[i] > 0, both = paths && r->tally.particles > 0;
    for (int h = 0; h < PATH_HALVES; h++) {
        const double alike = alike_scatter(r, m, i, &half[h]);
        spread[h] = spread_of(r, &half[h], REPLICATES / PATH_HALVES, band);
        scattered[h] = (half[h].scattered + alike) / 2;
        by_paths[h] = paths;
        if (both && spread[h] > 0) {
            const double scatter = fmax(fmax(half[h].scattered, alike),
                                        missed(&half[h], spread[h], REFERENCE_DOUBT)),
                         w = spread[h] / (spread[h] + scatter);
            by_paths[h] = w < REFERENCE_LEAST ? 0 : w;
            scattered[h] = fmax(scattered[h], missed(&half[h], spread[h], REFERENCE_MISSED));
        }
        all.counted += half[h].counted / PATH_HALVES;
        all.square += half[h].square / PATH_HALVES;
        all.found += half[h].found / PATH_HALVES;
        all.scattered += scattered[h] / (PATH_HALVES * PATH_HALVES);
        all.light += half[h].light / PATH_HALVES;
    }
    k.mean[REFERENCE_PARTICLES] = all.counted / area;
    k.mean[REFERENCE_PATHS] = all.found / area;
    k.variance[REFERENCE_PARTICLES] = spread_of(r, &all, REPLICATES, band) / (area * area);
    k.variance[REFERENCE_PATHS] = all.scattered / (area * area);
    for (int h = 0; h < PATH_HALVES; h++) {
        const double w = by_paths[PATH_HALVES - 1 - h], u = 1 - w;
        k.mean[REFERENCE_BOTH] += (w * half[h].found + u * half[h].counted) / (PATH_HALVES * area);
        k.variance[REFERENCE_BOTH] +=
            (w * w * scattered[h] + u * u * spread[h]) / (PATH_HALVES * PATH_HALVES * area * area);
    }
    return k;
}

static int is_traced(const struct reference *r, enum reference_method method)
{
    return (method != REFERENCE_PATHS && r->tally.particles > 0)
           || (method != REFERENCE_PARTICLES && r->paths.paths > 0);
}

int reference_irradiance(const struct reference *r, enum reference_method method, uint32_t band,
                         double *mean, double *variance)
{
    size_t count = r->solve.problem.scene->input_count;
    struct means m;
    if (means_open(&m, count) < 0)
        return -1;
    gather(r, band, &m);
    const int traced = is_traced(r, method);
    for (size_t i = 0; i < count; i++) {
        const struct known k = weigh(r, &m, i, band);
        mean[i] = k.mean[method];
        variance[i] = traced ? k.variance[method] : INFINITY;
    }
    means_close(&m);
    return 0;
}

/* ---- the whole */

/* What was not traced tells nothing, nor what has seen nothing where there may be something. */
static void doubt(const struct reference *r, struct reference_summary *s)
{
    if (!(s->reflected > 0))
        s->unseen = unseen_light(&r->solve.problem, &r->tally);
    for (int way = 0; way < REFERENCE_METHODS; way++)
        if (s->unseen > 0 || !is_traced(r, (enum reference_method)way))
            s->noise[way] = INFINITY;
    if (!is_traced(r, REFERENCE_PARTICLES) || !is_traced(r, REFERENCE_PATHS)) {
        s->difference = s->chi_square = 0;
        s->deviation = INFINITY;
        s->compared = 0;
    }
}

int reference_summary(const struct reference *r, struct reference_summary *s)
{
    const struct problem *p = &r->solve.problem;
    const struct scene *scene = p->scene;
    size_t count = scene->input_count;
    struct means m;
    *s = (struct reference_summary){.emitted = r->tally.power};
    double *rho = calloc(count + 1, sizeof *rho), *deviation = calloc(count + 1, sizeof *deviation);
    if (!rho || !deviation || means_open(&m, count) < 0) {
        free(rho);
        free(deviation);
        return -1;
    }
    for (uint32_t b = 0; b < p->bands; b++) {
        gather(r, b, &m);
        for (uint32_t i = 0; i < scene->face_count; i++)
            rho[scene->faces[i].input] = p->reflectance[(size_t)i * p->bands + b];
        for (size_t i = 0; i < count; i++) {
            const struct known k = weigh(r, &m, i, b);
            double reflects = rho[i] * m.area[i];
            if (!(reflects > 0))
                continue;
            double off = k.mean[REFERENCE_PARTICLES] - k.mean[REFERENCE_PATHS],
                   chance = k.variance[REFERENCE_PARTICLES] + k.variance[REFERENCE_PATHS];
            s->reflected += reflects * k.mean[REFERENCE_BOTH];
            for (int way = 0; way < REFERENCE_METHODS; way++)
                s->noise[way] += reflects * sqrt(k.variance[way]);
            s->difference += reflects * off;
            /* bands of one path go together: their deviations add up, at the most */
            deviation[i] += reflects * sqrt(k.variance[REFERENCE_PATHS]);
            /* where both are sure of their own noise */
            double found = k.mean[REFERENCE_PATHS];
            if (chance > 0 && found * m.area[i] >= REFERENCE_FEW * tally_power_of_one(&r->tally)
                && found * found >= REFERENCE_SURE * k.variance[REFERENCE_PATHS]) {
                s->chi_square += off * off / chance;
                s->compared++;
            }
        }
    }
    double variance;
    (void)reflected_light(p, &r->tally, &variance);
    for (size_t i = 0; i < count; i++)
        variance += deviation[i] * deviation[i];
    s->deviation = sqrt(variance);
    s->chi_square = s->compared ? s->chi_square / (double)s->compared : 0;
    doubt(r, s);
    means_close(&m);
    free(rho);
    free(deviation);
    return 0;
}

/* ---- what was traced, as bytes */

struct state_head {
    char name[8];
    uint64_t version;             /* and this machine's order of bytes */
    uint64_t check;               /* of all bytes behind it */
    uint64_t scene, faces, bands; /* whose it is */
    uint64_t particles, paths;    /* how many */
    uint64_t particle_rays, path_rays;
    double square[3];
};
static const char STATE_NAME[8] = "radref3";

/* Of all that paths depend on: faces, light, and how many random numbers go where. */
static uint64_t identity(const struct reference *r)
{
    return state_identity_scene(&r->solve.problem, &r->solve.hierarchy) + REPLICATES;
}

enum { PARTS = 1 + 2 * PATH_HALVES };

struct part {
    void *at;
    size_t size;
};

/* The arrays, in their order. */
static int parts(const struct reference *r, struct part part[PARTS])
{
    size_t values = (size_t)r->tally.faces * r->tally.bands;
    int count = 0;
    part[count++] = (struct part){r->tally.face, REPLICATES * values * sizeof *r->tally.face};
    for (int h = 0; h < PATH_HALVES; h++) {
        part[count++] = (struct part){r->paths.sum[h], values * sizeof *r->paths.sum[h]};
        part[count++] = (struct part){r->paths.square[h], values * sizeof *r->paths.square[h]};
    }
    return count;
}

size_t reference_state_size(const struct reference *r)
{
    struct part part[PARTS];
    size_t size = sizeof(struct state_head);
    for (int i = parts(r, part); i-- > 0;)
        size += part[i].size;
    return size;
}

/* Of what stands behind the head's check. */
static uint64_t check(const unsigned char *bytes, size_t size)
{
    size_t from = offsetof(struct state_head, scene);
    return hash_bytes(size, bytes + from, size - from);
}

void reference_state(const struct reference *r, unsigned char *bytes)
{
    struct part part[PARTS];
    int count = parts(r, part);
    struct state_head head = {.version = state_identity_version(),
                              .scene = identity(r),
                              .faces = r->tally.faces,
                              .bands = r->tally.bands,
                              .particles = r->tally.particles,
                              .paths = r->paths.paths,
                              .particle_rays = r->tally.rays,
                              .path_rays = r->paths.rays};
    memcpy(head.name, STATE_NAME, sizeof head.name);
    memcpy(head.square, r->tally.square, r->tally.bands * sizeof *head.square);
    unsigned char *to = bytes + sizeof head;
    for (int i = 0; i < count; to += part[i++].size)
        memcpy(to, part[i].at, part[i].size);
    memcpy(bytes, &head, sizeof head);
    head.check = check(bytes, reference_state_size(r));
    memcpy(bytes, &head, sizeof head);
}

int reference_restore(struct reference *r, const unsigned char *bytes, size_t size,
                      const char **cause)
{
    struct part part[PARTS];
    int count = parts(r, part);
    struct state_head head;
    *cause = "it is no state of a reference, or one of another version";
    if (size < sizeof head)
        return -1;
    memcpy(&head, bytes, sizeof head);
    if (memcmp(head.name, STATE_NAME, sizeof head.name) != 0
        || head.version != state_identity_version())
        return -1;
    *cause = "it is damaged";
    if (head.check != check(bytes, size))
        return -1;
    *cause = "it is of another scene, or of another version of this one";
    if (size != reference_state_size(r) || head.scene != identity(r) || head.faces != r->tally.faces
        || head.bands != r->tally.bands)
        return -1;
    const unsigned char *from = bytes + sizeof head;
    for (int i = 0; i < count; from += part[i++].size)
        memcpy(part[i].at, from, part[i].size);
    memcpy(r->tally.square, head.square, r->tally.bands * sizeof *head.square);
    r->tally.particles = head.particles;
    r->tally.rays = head.particle_rays;
    r->paths.paths = head.paths;
    r->paths.rays = head.path_rays;
    return 0;
}
