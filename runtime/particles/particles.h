/* particles.h - light counted: particles leave the emitters, and each front that one meets is given
 * its power.
 *
 * A particle goes on with the probability of the reflectance of its strongest band, the others
 * dimmed by what they reflect in proportion, until it dies, leaves the scene or meets a black back.
 * What a face was given over its area is its irradiance H, exact but for the noise: nothing is
 * known of links, form factors or elements, and no constant is tuned. [Pattanaik and Mudur 1992]
 *
 * Noise. Particles come in REPLICATES independent sets; how these differ is the standard error of
 * whatever is computed of their mean. Within a set the emitter, the point on it, the first
 * direction, and whether and where each of the first five reflections goes on, follow a Sobol'
 * sequence, shifted at random [Cranley and Patterson 1976 the shift, here of digits]: light is then
 * far less noisy than by chance, smooth light most, and each set as free of bias. Of what goes on
 * beyond, a thirtieth where half is reflected, dice decide.
 *
 * Splitting. Where a thousandth of the light comes, so do a thousandth of the particles, and of
 * light behind a second door nearly nothing is seen. A particle that gets where light is dim may go
 * on as several that carry less each, about what a window wants there; one that comes back to the
 * bright goes on as one of the few that carry more. The mean stays what it is, dim places are met
 * as often as others, and the window need only be about right. [Booth and Hendricks 1984, weight
 * windows; Cooper and Larsen 2001, windows as the light itself]
 *
 * Ranks. Where each of several ranks has the quarters of its own faces, it has their counts, too:
 * what lands on others' faces is told to them (landing_mail.h). Else all count everywhere and add
 * up.
 *
 * Invariant: power is added in fixed point, so neither threads nor ranks nor their order show.
 * SPDX-License-Identifier: MIT */
#ifndef PARTICLES_H
#define PARTICLES_H

#include "particles/tracer.h"
#include "particles/watch.h"

enum { REPLICATES = 16 };
/* 97.5 % of a normal distribution, and of Student's t with REPLICATES - 1 degrees of freedom. */
#define NORMAL_T 1.959963984540054
#define REPLICATES_T 2.131449545559323
_Static_assert(REPLICATES == 16, "REPLICATES_T is that of 15 degrees of freedom");
#define FACE_ELSEWHERE UINT32_MAX

/* The mean of what replicates say, and the variance of that mean, by how they differ. */
static inline double replicates_mean(const double value[REPLICATES], double *variance)
{
    double mean = 0, square = 0;
    for (int r = 0; r < REPLICATES; r++)
        mean += value[r] / REPLICATES;
    for (int r = 0; r < REPLICATES; r++)
        square += (value[r] - mean) * (value[r] - mean);
    *variance = square / (REPLICATES * (REPLICATES - 1));
    return mean;
}

/* What has been counted. */
struct tally {
    uint32_t faces, elements, bands; /* elements: of the hierarchy here */
    /* borrowed; NULL: this rank has the counts of all faces. Else it has those of its own, `held`
     * of them, in the tree's order; faces' owners are as they were when it was opened */
    const struct quarters *quarters;
    const struct hierarchy *hierarchy;
    const uint16_t *owner; /* [face]; good until faces are dealt out anew */
    uint32_t held;
    uint32_t *place;       /* [face]: of those that are held; else FACE_ELSEWHERE. NULL: all are */
    uint64_t stream;       /* which random numbers: tallies of two streams are independent */
    uint64_t particles;    /* of each replicate, so far */
    uint64_t rays;         /* cast for them */
    double power;          /* of all emitters (W), all bands */
    double one;            /* a count of so much is one particle at its full power */
    _Atomic int64_t *face; /* [REPLICATES][held * bands + band]: tally_place */
    _Atomic int64_t
        *element; /* [elements * bands + band]: of leaves, all replicates; NULL: not asked */
    _Atomic int64_t lost[REPLICATES][3]; /* [band]: what left the scene or met a black back; of
                                          * what this rank has traced, where quarters is not NULL */
    _Atomic int64_t *back; /* [faces]: of that, what met its back, all bands; likewise */
    /* by replicate, and of all: counts are so much more, as a share (power_balance.h) */
    double correction[REPLICATES + 1][3];
    uint32_t *made; /* owned; what `first` is of where the hierarchy has all */
    const uint32_t
        *first;           /* [number]: first child, 0 of leaves; NULL likewise (kernel/leaf_at.h) */
    uint32_t *leaf_place; /* [elements]: place of the face; NULL likewise, and without leaves */
    double *square; /* [bands]: mean of w^2 over mean of w, w a particle's share of its power */
    const float *window;     /* [elements * bands + band]: NULL: particles are not split */
    double least;            /* what it wants at the least */
    double *until, *carried; /* [lights]: running sums of chances; what one carries from there */
    int alone;               /* 1: one thread counts, at a time */
    int by_paths;            /* 1: paths stand for particles (path_tally.h) */
    /* 1: each rank has counts of its own, which nobody has added yet: of faces, with `lost`; of
     * leaves */
    int parted_faces, parted_leaves;
};

/* Empty, over the elements of a hierarchy as it is now (leaves: 1: count on them, too). Returns 0,
 * or -1 when out of memory. */
int tally_open(struct tally *tally, const struct tracer *t, uint64_t stream, int leaves);
void tally_close(struct tally *tally);
/* Keep counts of faces alone. */
void tally_forget_leaves(struct tally *tally);

/* Before any is traced: split particles. window[leaf * bands + band]: what one should carry at the
 * most that leaves there, a share of the power of all over their number; borrowed. Emitters are
 * chosen by it, too. No particle is split down to less than `least`, but of an emitter that has
 * less than that to send, as of a weak lamp in a room of its own, no less than it starts with.
 * rays: that will be cast, about. The tally counts on leaves; tally_chance holds of it where light
 * is bright, and is more than chance makes of noise where it is dim. Returns 0, or -1 when out of
 * memory. */
int tally_split(struct tally *tally, const struct tracer *t, const float *window, double least,
                double rays);

/* Trace so many particles more in each replicate. Without emitters nothing is traced and all is
 * exactly 0. Where there are several ranks each traces its part, and all then have all. watch:
 * NULL, or asked. Returns 0, or -1 when it was stopped: then the tally is of no use. */
int tally_trace(struct tally *tally, const struct tracer *t, uint64_t particles,
                const struct watch *watch);

/* The same, but where there are several ranks counts stay with those who have made them, until
 * they are added: before that `rays`, `square` and what power_balance sets alone are right. */
int tally_trace_part(struct tally *tally, const struct tracer *t, uint64_t particles,
                     const struct watch *watch);
/* All that is asked for then has the counts of all: faces, or leaves as well. */
void tally_add_faces(struct tally *tally, struct ranks *ranks);
void tally_add(struct tally *tally, struct ranks *ranks);

/* W that one count of a replicate's stands for; of `element` and `back`, a REPLICATES-th of it. */
static inline double tally_unit(const struct tally *tally)
{
    return tally->particles > 0 ? tally->power / ((double)tally->particles * tally->one) : 0;
}

/* Has this rank the counts of a face? */
static inline int tally_holds(const struct tally *tally, uint32_t face)
{
    return !tally->place || tally->place[face] != FACE_ELSEWHERE;
}

/* Where these are in a replicate's. */
static inline size_t tally_place(const struct tally *tally, uint32_t face)
{
    return tally->place ? tally->place[face] : face;
}

/* Power that a face receives in a band (W), by one replicate. */
static inline double tally_face(const struct tally *tally, int replicate, uint32_t face,
                                uint32_t band)
{
    size_t at = (size_t)replicate * tally->held + tally_place(tally, face);
    return tally_unit(tally) * (double)tally->face[at * tally->bands + band]
           * (1 + tally->correction[replicate][band]);
}

/* The same, mean of all replicates. */
static inline double tally_face_mean(const struct tally *tally, uint32_t face, uint32_t band)
{
    double mean = 0;
    for (int r = 0; r < REPLICATES; r++)
        mean += tally_face(tally, r, face, band) / REPLICATES;
    return mean;
}

/* W that one count on leaves stands for. */
static inline double tally_leaf_unit(const struct tally *tally, uint32_t band)
{
    return tally_unit(tally) / REPLICATES * (1 + tally->correction[REPLICATES][band]);
}

/* Power that a leaf receives in a band (W), mean of all replicates. */
static inline double tally_leaf(const struct tally *tally, uint32_t element, uint32_t band)
{
    return tally_unit(tally) / REPLICATES
           * (double)tally->element[(size_t)element * tally->bands + band]
           * (1 + tally->correction[REPLICATES][band]);
}

/* All counts as one number: a sum over all ranks, so that no order shows. */
uint64_t tally_fingerprint(const struct tally *tally, struct ranks *ranks);

/* W that one particle of all replicates stands for. */
static inline double tally_power_of_one(const struct tally *tally)
{
    return tally_unit(tally) * (tally->one / REPLICATES);
}

/* The variance of a mean over all replicates (W2), if chance alone spread particles: of the power
 * `received` (W) in a band. A pseudo-count of one particle keeps places that none has met from
 * seeming certain. */
static inline double tally_chance(const struct tally *tally, double received, uint32_t band)
{
    double one = tally_power_of_one(tally);
    return one * (tally->square[band] * received + one);
}

/* The variance of what the mean over a face by paths lacks, as a share of its square, 0 of
 * particles: as if of all paths one more had found there what one finds in the mean. Light that is
 * met by a few of them, as a lamp is by directions of which one in a hundred finds it, may have
 * been met by none, and then no replicate differs. Faces have about as many paths each, so that of
 * one that has n of N its share of one more is 1 / n N. */
static inline double tally_unseen(const struct tally *tally)
{
    const double all = (double)tally->particles * REPLICATES;
    return tally->by_paths && all > 0 ? tally->faces / (all * all) : 0;
}

#endif
