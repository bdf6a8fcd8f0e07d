/* particles.c - see particles.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "kernel/constants.h"
#include "kernel/leaf_at.h"
#include "particles/landing_mail.h"
#include "particles/particles.h"
#include "particles/running_sums.h"

enum {
    BATCH = 1024,
    COPIES = 16,  /* at most, of one particle at one place */
    WAITING = 32, /* places on its way at most where copies wait; beyond, none are made */
    LANDINGS = 64 /* that are counted at once */
};

/* Counts of all that lands, at the most: half of what there is room for, as rays are about so many.
 * Of a million rays each counts parts of 1e-12: a lamp that has so little of the power may be all
 * the light of a closed room. */
#define ALL_SPLIT 0x1p62

/* Of what an emitter sends, by bands. */
static void emitted_shares(const struct tracer *t, uint32_t face, double share[3])
{
    const double *exitance = &t->exitance[(size_t)face * t->bands];
    double whole = 0;
    for (uint32_t k = 0; k < t->bands; k++)
        whole += exitance[k];
    for (uint32_t k = 0; k < t->bands; k++)
        share[k] = exitance[k] / whole;
}

/* What a particle carries that leaves there, over what is wanted of one, in the band where that is
 * most: in a band in which light is dim one that carries as much as others do would be one of few.
 * Without windows, over the power of one at the start. */
static double strength(const struct tally *tally, uint32_t leaf, const double share[3],
                       double least)
{
    double most = 0;
    for (uint32_t k = 0; k < tally->bands; k++)
        most = fmax(most,
                    tally->window
                        ? share[k]
                              / fmax((double)tally->window[(size_t)leaf * tally->bands + k], least)
                        : share[k]);
    return most;
}

/* From an emitter one carries what the window wants of those that leave its place, but no less than
 * the emitter's share of all power: what shines into the dark is not asked for more than others. */
int tally_split(struct tally *tally, const struct tracer *t, const float *window, double least,
                double rays)
{
    const struct lights *l = &t->lights;
    double all = 0;
    tally->window = window;
    tally->least = least;
    tally->until = malloc((l->count + 1) * sizeof *tally->until);
    tally->carried = malloc((l->count + 1) * sizeof *tally->carried);
    if (!tally->until || !tally->carried)
        return -1;
    for (uint32_t i = 0; i < l->count; i++) {
        const double share = (l->until[i] - (i > 0 ? l->until[i - 1] : 0)) / l->power;
        double sent[3];
        emitted_shares(t, l->face[i], sent);
        const uint32_t element = t->hierarchy->face_element[l->face[i]];
        tally->carried[i] = fmax(1 / strength(tally, element, sent, 0), share);
        tally->until[i] = all += share / tally->carried[i];
    }
    for (uint32_t i = 0; i < l->count; i++)
        tally->carried[i] *= all;
    /* none carries more than `all`, or, later, than is within what a window wants, 1.25 at most */
    tally->one = ALL_SPLIT / (fmax(rays, 1) * fmax(all, 1.25 * SPLIT_WINDOW));
    return 0;
}

/* Where a particle has landed, with how much. */
struct landing {
    uint32_t face;
    double at[3], share[3];
};

/* A run of particles of one replicate, and its sums that are no place's. */
struct batch {
    uint32_t shift[SOBOL_COORDINATES];
    int replicate, landed;
    uint64_t rays;
    int64_t first[3], second[3];      /* sums of w and w^2, as counts */
    int64_t lost[3];                  /* of w that is not met again */
    struct mail *mail;                /* what has landed on others' faces; NULL: it stays here */
    struct landing landing[LANDINGS]; /* [landed]: not counted yet */
};

/* The leaves that hold them, as owners of their faces have them. All go down level by level, side
 * by side: each waits for memory at every level, and so they wait together. */
static void find_leaves(const struct tally *tally, const struct tracer *t,
                        const struct landing *landing, int count, uint32_t *leaf)
{
    const struct quarters *q = tally->quarters;
    const uint32_t common = q ? q->common : 0;
    struct leaf_walk walk[LANDINGS];
    for (int i = 0; i < count; i++)
        walk[i] = leaf_walk_from(t->hierarchy->elements,
                                 t->hierarchy->face_element[landing[i].face], landing[i].at);
    for (int more = 1; more;) {
        more = 0;
        for (int i = 0; i < count; i++) {
            const uint32_t child = tally->first[walk[i].at];
            if (!child)
                continue;
            if (walk[i].at < common)
                leaf[i] = walk[i].at; /* in the end the leaf that all have */
            leaf_walk_down(&walk[i], child);
            more = 1;
        }
    }
    for (int i = 0; i < count; i++)
        leaf[i] = q ? quarters_at_owner(q, leaf[i], walk[i].at) : walk[i].at;
}

/* Count what has landed. Returns the leaf of the last, or 0 where leaves are not counted on. */
static uint32_t count_landings(struct tally *tally, const struct tracer *t, struct batch *batch)
{
    const int count = batch->landed;
    uint32_t leaf[LANDINGS] = {0};
    int here[LANDINGS];
    size_t place[LANDINGS];
    if (tally->element)
        find_leaves(tally, t, batch->landing, count, leaf);
    const uint32_t last = count > 0 ? leaf[count - 1] : 0;
    for (int i = 0; i < count; i++) {
        here[i] = !batch->mail || tally_holds(tally, batch->landing[i].face);
        place[i] = here[i] ? tally_place(tally, batch->landing[i].face) : 0;
        if (here[i])
            tally_prefetch(tally, batch->replicate, place[i], leaf[i]);
    }
    for (int i = 0; i < count; i++) {
        const struct landing *l = &batch->landing[i];
        int64_t w[3] = {0, 0, 0};
        for (uint32_t k = 0; k < tally->bands; k++) {
            w[k] = (int64_t)(l->share[k] * tally->one + 0.5);
            batch->first[k] += w[k];
            batch->second[k] += (int64_t)(l->share[k] * l->share[k] * tally->one + 0.5);
        }
        if (here[i])
            tally_count(tally, batch->replicate, place[i], leaf[i], w);
        else
            mail_landing(batch->mail, tally, batch->replicate, l->face, leaf[i], w);
    }
    batch->landed = 0;
    return last;
}

/* Returns the leaf that is met where a window asks for it. */
static uint32_t land(struct tally *tally, const struct tracer *t, uint32_t face, const double at[3],
                     const double share[3], struct batch *batch)
{
    struct landing *l = &batch->landing[batch->landed++];
    l->face = face;
    memcpy(l->at, at, sizeof l->at);
    memcpy(l->share, share, sizeof l->share);
    return tally->window || batch->landed == LANDINGS ? count_landings(tally, t, batch) : 0;
}

/* A particle, or several alike, about to leave a surface. */
struct flight {
    uint32_t face;
    int copies; /* how many are to leave */
    double p[3], share[3];
    double least; /* what a window wants at the least of what its emitter has sent */
};

/* The emitter that u[0] in [0, 1) stands for, the point on it, and what leaves there. */
static struct flight emit(const struct tally *tally, const struct tracer *t, const double *u)
{
    const struct lights *l = &t->lights;
    const double *until = tally->window ? tally->until : l->until;
    uint32_t light = running_sums_find(until, l->count, u[0] * until[l->count - 1]);
    struct flight f = {.face = l->face[light]};
    emitted_shares(t, f.face, f.share);
    if (tally->window) {
        for (uint32_t k = 0; k < t->bands; k++)
            f.share[k] *= tally->carried[light];
        f.least = fmin(tally->least, tally->carried[light]);
    }
    tracer_point(t, f.face, u[1], u[2], f.p);
    return f;
}

/* Set how many go on from the leaf that f has met, right in the mean by u in [0, 1), and with how
 * much each: as before, or, where that is not within SPLIT_WINDOW of what the window wants, with
 * that; but no more than `most` of them. */
static void reflect(const struct tally *tally, const struct tracer *t, uint32_t leaf, double u,
                    int most, struct flight *f)
{
    const double *rho = &t->reflectance[(size_t)f->face * t->bands];
    double strongest = strength(tally, leaf, f->share, f->least);
    for (uint32_t k = 0; k < t->bands; k++)
        f->share[k] *= rho[k];
    const double left = strength(tally, leaf, f->share, f->least);
    if (tally->window && (strongest > SPLIT_WINDOW || strongest * SPLIT_WINDOW < 1))
        strongest = fmax(1, left / most);
    f->copies = left > 0 ? (int)(left / strongest) : 0;
    f->copies += u * strongest < left - f->copies * strongest;
    for (uint32_t k = 0; k < t->bands && f->copies > 0; k++)
        f->share[k] *= strongest / left;
}

/* What met no front. */
static void lose(struct tally *tally, int64_t met, const double *share, struct batch *batch)
{
    int64_t all = 0;
    for (uint32_t k = 0; k < tally->bands; k++) {
        const int64_t w = (int64_t)(share[k] * tally->one + 0.5);
        batch->lost[k] += w;
        all += w;
    }
    if (met < RAY_MEETS_NO_FRONT)
        tally->back[ray_meets_back(met)] += all;
}

static void trace(struct tally *tally, const struct tracer *t, uint64_t index, struct batch *batch)
{
    struct dice dice = dice_of_point(t, tally->stream * REPLICATES + (uint64_t)batch->replicate,
                                     index, batch->shift, index);
    struct flight waiting[WAITING];
    int places = 0;
    double u[5], at[3];
    for (int d = 0; d < 5; d++)
        u[d] = dice_throw(&dice);
    struct flight f = emit(tally, t, u);
    double s = u[3], v = u[4];
    for (;;) {
        int64_t met = tracer_step(t, f.face, f.p, s, v, at);
        batch->rays++;
        f.copies = 0;
        if (met >= 0) {
            f.face = (uint32_t)met;
            uint32_t leaf = land(tally, t, f.face, at, f.share, batch);
            reflect(tally, t, leaf, dice_throw(&dice), places < WAITING ? COPIES : 1, &f);
        } else {
            lose(tally, met, f.share, batch);
        }
        if (f.copies > 1) {
            f.copies--;
            waiting[places++] = f;
        } else if (f.copies == 0) {
            if (places == 0)
                return;
            dice.used = SOBOL_COORDINATES; /* the sequence was the first copy's */
            f = waiting[places - 1];
            if (--waiting[places - 1].copies == 0)
                places--;
        }
        s = dice_throw(&dice);
        v = dice_throw(&dice);
    }
}

/* What batches come to. */
struct sums {
    _Atomic uint64_t rays;
    _Atomic int64_t first[3], second[3];
};

/* Particles from .. to - 1 of every replicate, in batches, each of one replicate; of these every
 * `ranks`th from number `rank` on, without the first `done` of them. */
struct batches {
    struct tally *tally;
    const struct tracer *t;
    uint64_t from, to, rank, ranks, done;
    struct watched_loop *loop;
    struct sums *sums;
    struct mail *mail; /* [batch]; NULL: all counts stay here */
};

/* The particles low .. high - 1 of a batch in the order of where they begin on the line of
 * emitters: those of a run of the sequence fall evenly on it, one at a time here and there. One
 * after the other they find faces, and what rays pass by, where the one before has just been. */
static void order_by_emitter(const struct batches *all, const struct batch *batch, uint64_t low,
                             uint64_t high, uint16_t order[BATCH])
{
    uint16_t first[BATCH + 1] = {0}, place[BATCH];
    const uint32_t count = (uint32_t)(high - low);
    for (uint32_t i = 0; i < count; i++) {
        const double u = sobol_sequence_at(&all->t->sobol, (uint32_t)(low + i), 0, batch->shift[0]);
        place[i] = (uint16_t)(u * BATCH);
        first[place[i] + 1]++;
    }
    for (int k = 0; k < BATCH; k++)
        first[k + 1] = (uint16_t)(first[k + 1] + first[k]);
    for (uint32_t i = 0; i < count; i++)
        order[first[place[i]]++] = (uint16_t)i;
}

static void trace_batches(const void *batches, size_t begin, size_t end)
{
    const struct batches *all = batches;
    uint16_t order[BATCH];
    for (uint64_t i = begin; i < end; i++) {
        const uint64_t b = (all->done + i) * all->ranks + all->rank;
        struct batch batch = {.replicate = (int)(b % REPLICATES),
                              .mail = all->mail ? &all->mail[i] : NULL};
        uint64_t low = all->from + b / REPLICATES * BATCH,
                 high = low + BATCH < all->to ? low + BATCH : all->to,
                 set = all->tally->stream * REPLICATES + (uint64_t)batch.replicate;
        if (watched_loop_stopped(all->loop))
            continue;
        sobol_sequence_shifts(set, batch.shift);
        order_by_emitter(all, &batch, low, high, order);
        for (uint64_t k = low; k < high; k++)
            trace(all->tally, all->t, low + order[k - low], &batch);
        count_landings(all->tally, all->t, &batch);
        all->sums->rays += batch.rays;
        for (int k = 0; k < 3; k++) {
            all->sums->first[k] += batch.first[k];
            all->sums->second[k] += batch.second[k];
            all->tally->lost[batch.replicate][k] += batch.lost[k];
        }
        watched_loop_tell(all->loop);
    }
}

/* Before all ranks trace their parts: what has been added stays with the first; */
static void part_counts(struct tally *tally, struct ranks *ranks)
{
    const int several = ranks_count(ranks) > 1 && !tally->quarters,
              others = several && ranks_number(ranks) > 0;
    if (others && !tally->parted_faces) {
        memset((void *)(uintptr_t)tally->face, 0,
               (size_t)REPLICATES * tally->held * tally->bands * sizeof *tally->face);
        memset((void *)(uintptr_t)tally->lost, 0, sizeof tally->lost);
        memset((void *)(uintptr_t)tally->back, 0, tally->faces * sizeof *tally->back);
    }
    if (others && !tally->parted_leaves && tally->element)
        memset((void *)(uintptr_t)tally->element, 0,
               (size_t)tally->elements * tally->bands * sizeof *tally->element);
    tally->parted_faces = several;
    tally->parted_leaves = several && tally->element;
}

/* after it all have the sums of all. */
static void add_sums(struct ranks *ranks, struct sums *sums)
{
    uint64_t few[7] = {sums->rays};
    for (int k = 0; k < 3; k++) {
        few[1 + k] = (uint64_t)sums->first[k];
        few[4 + k] = (uint64_t)sums->second[k];
    }
    ranks_add_counts(ranks, RANKS_PARTICLES, few, 7);
    sums->rays = few[0];
    for (int k = 0; k < 3; k++) {
        sums->first[k] = (int64_t)few[1 + k];
        sums->second[k] = (int64_t)few[4 + k];
    }
}

/* Batches of which landings are told before others are traced, so that few wait. */
static int trace_and_tell(struct batches *all, uint64_t mine, uint64_t rounds)
{
    struct mail mail[MAIL_BATCHES] = {{0}};
    int failed = 0;
    all->mail = mail;
    for (uint64_t i = 0; i < rounds; i++) { /* as many on all ranks */
        const uint64_t left = mine > all->done ? mine - all->done : 0;
        thread_pool_run(all->t->threads, left < MAIL_BATCHES ? left : MAIL_BATCHES, 1,
                        trace_batches, all);
        failed |= mail_send(mail, MAIL_BATCHES, all->tally, all->t->ranks) < 0;
        all->done += MAIL_BATCHES;
    }
    mail_close(mail, MAIL_BATCHES);
    return failed ? -1 : 0;
}

int tally_trace_part(struct tally *tally, const struct tracer *t, uint64_t particles,
                     const struct watch *watch)
{
    uint64_t from = tally->particles, to = from + particles,
             count = (particles + BATCH - 1) / BATCH * REPLICATES;
    tally->particles = to;
    if (!(tally->power > 0))
        return 0;
    const uint64_t rank = (uint64_t)ranks_number(t->ranks), ranks = (uint64_t)ranks_count(t->ranks),
                   mine = (count + ranks - 1 - rank) / ranks;
    struct watched_loop loop = {.watch = watch, .all = mine};
    struct sums sums = {0};
    struct batches all = {tally, t, from, to, rank, ranks, 0, &loop, &sums, NULL};
    int failed = 0;
    part_counts(tally, t->ranks);
    if (tally->quarters)
        failed =
            trace_and_tell(&all, mine, (count + ranks * MAIL_BATCHES - 1) / (ranks * MAIL_BATCHES));
    else
        thread_pool_run(t->threads, mine, 1, trace_batches, &all);
    add_sums(t->ranks, &sums);
    tally->rays += sums.rays;
    for (uint32_t k = 0; k < tally->bands; k++) /* of this call: all are alike but for chance */
        tally->square[k] = sums.first[k] > 0 ? (double)sums.second[k] / (double)sums.first[k] : 0;
    return failed || loop.stopped ? -1 : 0;
}

int tally_trace(struct tally *tally, const struct tracer *t, uint64_t particles,
                const struct watch *watch)
{
    const int result = tally_trace_part(tally, t, particles, watch);
    tally_add(tally, t->ranks);
    return result;
}
