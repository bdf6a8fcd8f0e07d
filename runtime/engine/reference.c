/* reference.c - see reference.h.
 *
 * How sure. Of a polygon that many particles have met, how the replicates differ says how sure
 * its mean is. Of one that few have met, or none, they say as little of that as of the mean, and
 * where they say little of both, what is dark by chance would seem certain and count most: there
 * what chance alone would do to the light that paths find is taken, which the particles have no
 * part in. To either method one thing unseen is allowed for: one more particle at the polygon, one
 * more path that finds as much as an average place of the scene has.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include "engine/reference.h"
#include "engine/solve_tracer.h"
#include "kernel/constants.h"

/* Random numbers that nothing else takes: a reference must not share its noise with what it
 * judges. Of paths each face has its own. */
static const uint64_t PARTICLE_STREAM = 0x7265666572, PATH_STREAM = (uint64_t)0x70617468 << 32;

int reference_open(struct reference *r, const struct scene *scene, int threads, struct ranks *ranks,
                   const char **cause)
{
    const struct solve_options options = {
        .tolerance = SOLVE_TOLERANCE, .iterations = 1, .threads = threads, .ranks = ranks};
    *r = (struct reference){0};
    if (solve_open(&r->solve, scene, &options, cause) < 0)
        return -1;
    r->tracer = solve_tracer(&r->solve);
    if (tracer_open(&r->tracer) == 0 && tally_open(&r->tally, &r->tracer, PARTICLE_STREAM, 0) == 0
        && face_paths_open(&r->paths, &r->tracer, PATH_STREAM) == 0)
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

/* [input_count] each; one allocation, which begins with `area`. */
struct means {
    double *area;              /* m2, all that the polygon became */
    double *counted, *spread;  /* W by particles; the variance of that by how replicates differ */
    double *found, *scattered; /* W by paths, and its variance */
    double *one;               /* for what is being summed */
};

static int means_open(struct means *m, size_t count)
{
    double *room = calloc(6 * count + 1, sizeof *room);
    *m = (struct means){
        room, room + count, room + 2 * count, room + 3 * count, room + 4 * count, room + 5 * count};
    return room ? 0 : -1;
}

static void gather(const struct reference *r, uint32_t band, struct means *m)
{
    const struct scene *scene = r->solve.problem.scene;
    size_t count = scene->input_count;
    double mean_light = r->tally.power / r->solve.hierarchy.elements[0].area;
    memset(m->area, 0, 6 * count * sizeof *m->area);
    for (uint32_t i = 0; i < scene->face_count; i++) {
        uint32_t input = scene->faces[i].input;
        uint64_t paths = face_paths_count(&r->paths, i, r->paths.paths);
        double area = area_of(r, i), mean, variance;
        face_paths_mean(&r->paths, i, band, &mean, &variance);
        double unseen = paths > 0 ? mean_light / (double)paths : 0;
        m->area[input] += area;
        m->found[input] += area * mean;
        m->scattered[input] += area * area * (variance + unseen * unseen);
    }
    for (int k = 0; k < REPLICATES; k++) {
        memset(m->one, 0, count * sizeof *m->one);
        for (uint32_t i = 0; i < scene->face_count; i++)
            m->one[scene->faces[i].input] += tally_face(&r->tally, k, i, band);
        for (size_t i = 0; i < count; i++) {
            m->counted[i] += m->one[i] / REPLICATES;
            m->spread[i] += m->one[i] * m->one[i] / REPLICATES;
        }
    }
    for (size_t i = 0; i < count; i++)
        m->spread[i] = fmax(m->spread[i] - m->counted[i] * m->counted[i], 0) / (REPLICATES - 1);
}

/* Irradiance of one polygon in one band by each method, and the variances (W/m2, squared). */
struct known {
    double mean[REFERENCE_METHODS], variance[REFERENCE_METHODS];
};

static struct known weigh(const struct reference *r, const struct means *m, size_t i, uint32_t band)
{
    struct known k = {{0, 0, 0}, {0, 0, 0}};
    double area = m->area[i], one = tally_power_of_one(&r->tally);
    if (!(area > 0))
        return k;
    int both = m->scattered[i] > 0 && r->tally.particles > 0;
    double spread = both && m->found[i] < REFERENCE_FEW * one
                        ? tally_chance(&r->tally, m->found[i], band)
                        : m->spread[i] + one * one;
    k.mean[REFERENCE_PARTICLES] = m->counted[i] / area;
    k.mean[REFERENCE_PATHS] = m->found[i] / area;
    k.variance[REFERENCE_PARTICLES] = spread / (area * area);
    k.variance[REFERENCE_PATHS] = m->scattered[i] / (area * area);
    /* Weights that go against variances make the variance of the sum its least. */
    double by_paths = both ? spread / (spread + m->scattered[i]) : m->scattered[i] > 0;
    k.mean[REFERENCE_BOTH] =
        by_paths * k.mean[REFERENCE_PATHS] + (1 - by_paths) * k.mean[REFERENCE_PARTICLES];
    k.variance[REFERENCE_BOTH] =
        by_paths * by_paths * k.variance[REFERENCE_PATHS]
        + (1 - by_paths) * (1 - by_paths) * k.variance[REFERENCE_PARTICLES];
    return k;
}

int reference_irradiance(const struct reference *r, enum reference_method method, uint32_t band,
                         double *mean, double *variance)
{
    size_t count = r->solve.problem.scene->input_count;
    struct means m;
    if (means_open(&m, count) < 0)
        return -1;
    gather(r, band, &m);
    for (size_t i = 0; i < count; i++) {
        const struct known k = weigh(r, &m, i, band);
        mean[i] = k.mean[method];
        variance[i] = k.variance[method];
    }
    free(m.area);
    return 0;
}

/* ---- the whole */

/* What each replicate says is reflected in all (W). */
static void replicate_powers(const struct reference *r, double power[REPLICATES])
{
    const struct problem *p = &r->solve.problem;
    for (int k = 0; k < REPLICATES; k++) {
        power[k] = 0;
        for (uint32_t i = 0; i < p->scene->face_count; i++)
            for (uint32_t b = 0; b < p->bands; b++)
                power[k] +=
                    p->reflectance[(size_t)i * p->bands + b] * tally_face(&r->tally, k, i, b);
    }
}

static double variance_of_mean(const double power[REPLICATES])
{
    double mean = 0, square = 0;
    for (int k = 0; k < REPLICATES; k++)
        mean += power[k] / REPLICATES;
    for (int k = 0; k < REPLICATES; k++)
        square += (power[k] - mean) * (power[k] - mean);
    return square / (REPLICATES * (REPLICATES - 1));
}

int reference_summary(const struct reference *r, struct reference_summary *s)
{
    const struct problem *p = &r->solve.problem;
    const struct scene *scene = p->scene;
    size_t count = scene->input_count;
    struct means m;
    *s = (struct reference_summary){.emitted = r->tally.power};
    double *rho = calloc(count + 1, sizeof *rho), *deviation = calloc(count + 1, sizeof *deviation);
    if (means_open(&m, count) < 0 || !rho || !deviation) {
        free(m.area);
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
            if (chance > 0 && m.found[i] >= REFERENCE_FEW * tally_power_of_one(&r->tally)
                && m.found[i] * m.found[i] >= REFERENCE_SURE * m.scattered[i]) {
                s->chi_square += off * off / chance;
                s->compared++;
            }
        }
    }
    double power[REPLICATES], variance;
    replicate_powers(r, power);
    variance = variance_of_mean(power);
    for (size_t i = 0; i < count; i++)
        variance += deviation[i] * deviation[i];
    s->deviation = sqrt(variance);
    s->chi_square = s->compared ? s->chi_square / (double)s->compared : 0;
    free(m.area);
    free(rho);
    free(deviation);
    return 0;
}

/* ---- what was traced, as bytes */

struct state_head {
    char name[8];
    uint64_t check;               /* of all bytes behind it */
    uint64_t scene, faces, bands; /* whose it is */
    uint64_t particles, paths;    /* how many */
    uint64_t particle_rays, path_rays;
    double square[3];
};
static const char STATE_NAME[8] = "radref1";

static uint64_t mix(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    for (; size >= 8; size -= 8, at += 8) {
        uint64_t word;
        memcpy(&word, at, 8);
        hash = hash64(hash + HASH_STEP + word);
    }
    for (; size > 0; size--)
        hash = hash64(hash + HASH_STEP + *at++);
    return hash;
}

/* Of all that paths depend on: faces, light, and how many random numbers go where. */
static uint64_t identity(const struct reference *r)
{
    const struct problem *p = &r->solve.problem;
    size_t values = (size_t)p->scene->face_count * p->bands;
    uint64_t hash = mix(REPLICATES, p->exitance, values * sizeof *p->exitance);
    hash = mix(hash, p->reflectance, values * sizeof *p->reflectance);
    for (uint32_t i = 0; i < p->scene->face_count; i++) {
        const struct face *f = &p->scene->faces[i];
        hash = mix(hash + f->input + f->back, f->vertex, f->vertices * sizeof *f->vertex);
    }
    return hash;
}

struct part {
    void *at;
    size_t size;
};

/* The arrays, in their order. */
static int parts(const struct reference *r, struct part part[3])
{
    size_t values = (size_t)r->tally.faces * r->tally.bands;
    part[0] = (struct part){r->tally.face, REPLICATES * values * sizeof *r->tally.face};
    part[1] = (struct part){r->paths.sum, values * sizeof *r->paths.sum};
    part[2] = (struct part){r->paths.square, values * sizeof *r->paths.square};
    return 3;
}

size_t reference_state_size(const struct reference *r)
{
    struct part part[3];
    size_t size = sizeof(struct state_head);
    for (int i = parts(r, part); i-- > 0;)
        size += part[i].size;
    return size;
}

/* Of what stands behind the head's check. */
static uint64_t check(const unsigned char *bytes, size_t size)
{
    size_t from = offsetof(struct state_head, scene);
    return mix(size, bytes + from, size - from);
}

void reference_state(const struct reference *r, unsigned char *bytes)
{
    struct part part[3];
    int count = parts(r, part);
    struct state_head head = {.scene = identity(r),
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
    struct part part[3];
    int count = parts(r, part);
    struct state_head head;
    *cause = "it is no state of a reference, or one of another version";
    if (size < sizeof head)
        return -1;
    memcpy(&head, bytes, sizeof head);
    if (memcmp(head.name, STATE_NAME, sizeof head.name) != 0)
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
