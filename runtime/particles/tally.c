/* tally.c - see particles.h: where counts are, whose they are, and what ranks add of them.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include "kernel/hash.h"
#include "particles/particles.h"

/* Counts of one particle: room for 2^39 of them on a face. */
#define ONE_WHOLE 0x1p24

int tally_open(struct tally *tally, const struct tracer *t, uint64_t stream, int leaves)
{
    const struct hierarchy *h = t->hierarchy;
    *tally = (struct tally){.faces = h->face_count,
                            .elements = h->count,
                            .bands = t->bands,
                            .held = h->face_count,
                            .stream = stream,
                            .one = ONE_WHOLE,
                            .alone = t->threads == 1,
                            .power = t->lights.power};
    const struct quarters *q = t->quarters && t->quarters->common ? t->quarters : NULL;
    size_t bands = t->bands;
    if (q) {
        const size_t *mine = &t->stretch[ranks_number(t->ranks)];
        tally->quarters = q;
        tally->hierarchy = h;
        tally->owner = t->owner;
        tally->held = (uint32_t)(mine[1] - mine[0]);
        tally->place = malloc(tally->faces * sizeof *tally->place);
        for (uint32_t i = 0; i < tally->faces && tally->place; i++)
            tally->place[h->order[i]] =
                i - mine[0] < tally->held ? (uint32_t)(i - mine[0]) : FACE_ELSEWHERE;
    }
    tally->face = calloc((size_t)REPLICATES * tally->held * bands + 1, sizeof *tally->face);
    tally->back = calloc((size_t)tally->faces + 1, sizeof *tally->back);
    tally->square = calloc(bands, sizeof *tally->square);
    if (leaves) {
        tally->element = calloc((size_t)tally->elements * bands, sizeof *tally->element);
        tally->made = q ? NULL : malloc(tally->elements * sizeof *tally->made);
        tally->leaf_place = q ? malloc(tally->elements * sizeof *tally->leaf_place) : NULL;
        tally->first = q ? q->child : tally->made;
    }
    if (!tally->face || !tally->back || !tally->square || (q && !tally->place)
        || (leaves && (!tally->element || !tally->first || (q && !tally->leaf_place)))) {
        tally_close(tally);
        return -1;
    }
    for (uint32_t i = 0; leaves && q && i < tally->elements; i++)
        if (h->elements[i].vertices)
            tally->leaf_place[i] = tally->place[h->elements[i].face];
    for (uint32_t i = 0; leaves && !q && i < tally->elements; i++) {
        const struct element *e = &h->elements[i];
        tally->made[i] = e->children ? e->child : 0;
    }
    return 0;
}

void tally_forget_leaves(struct tally *tally)
{
    free(tally->element);
    free(tally->made);
    free(tally->leaf_place);
    tally->element = NULL;
    tally->made = NULL;
    tally->leaf_place = NULL;
    tally->first = NULL;
}

void tally_close(struct tally *tally)
{
    free(tally->face);
    free(tally->back);
    free(tally->element);
    free(tally->made);
    free(tally->leaf_place);
    free(tally->place);
    free(tally->square);
    free(tally->until);
    free(tally->carried);
    *tally = (struct tally){0};
}

/* Counts are integers: their sum has no order. */
_Static_assert(sizeof(_Atomic int64_t) == sizeof(uint64_t), "counts are sent as they stand");

void tally_add_faces(struct tally *tally, struct ranks *ranks)
{
    if (!tally->parted_faces)
        return;
    tally->parted_faces = 0;
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->face,
                     (size_t)REPLICATES * tally->held * tally->bands);
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->lost,
                     sizeof tally->lost / sizeof **tally->lost);
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->back, tally->faces);
}

void tally_add(struct tally *tally, struct ranks *ranks)
{
    tally_add_faces(tally, ranks);
    if (!tally->parted_leaves)
        return;
    tally->parted_leaves = 0;
    ranks_add_counts(ranks, RANKS_PARTICLES, (uint64_t *)(uintptr_t)tally->element,
                     (size_t)tally->elements * tally->bands);
}

/* Each count is told by one rank: of a face by who has it, of a cluster, where none are, by the
 * first. */
uint64_t tally_fingerprint(const struct tally *tally, struct ranks *ranks)
{
    const struct quarters *q = tally->quarters;
    const uint64_t bands = tally->bands, faces = (uint64_t)REPLICATES * tally->faces * bands;
    uint64_t sum = 0;
    for (uint32_t f = 0; f < tally->faces; f++)
        for (uint64_t i = 0; i < REPLICATES * bands && tally_holds(tally, f); i++) {
            const size_t r = i / bands, k = i % bands;
            const int64_t count =
                tally->face[(r * tally->held + tally_place(tally, f)) * bands + k];
            sum += hash64((r * tally->faces + f) * bands + k + hash64((uint64_t)count));
        }
    for (uint32_t e = 0; tally->element && e < tally->elements; e++) {
        const struct element *at = q ? &tally->hierarchy->elements[e] : NULL;
        if (q && (at->vertices ? !tally_holds(tally, at->face) : ranks_number(ranks) > 0))
            continue;
        for (uint64_t k = 0; k < bands; k++)
            sum += hash64(faces + quarters_number(q, e) * bands + k
                          + hash64((uint64_t)tally->element[e * bands + k]));
    }
    if (q)
        ranks_add_counts(ranks, RANKS_PARTICLES, &sum, 1);
    return sum;
}
