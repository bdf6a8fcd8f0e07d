/* landing_mail.c - see landing_mail.h.
 * SPDX-License-Identifier: MIT */
#include "particles/landing_mail.h"
#include <stdatomic.h>
#include <stdlib.h>
#include "util/array.h"

void mail_landing(struct mail *mail, const struct tally *tally, int replicate, uint32_t face,
                  uint32_t leaf, const int64_t w[3])
{
    if (mail->failed
        || array_reserve(&mail->letter, mail->count + 1, &mail->capacity, sizeof *mail->letter)
               < 0) {
        mail->failed = 1;
        return;
    }
    struct letter *l = &mail->letter[mail->count++];
    *l = (struct letter){.at = tally->element ? leaf : face,
                         .replicate = (uint16_t)replicate,
                         .owner = tally->owner[face]};
    for (uint32_t k = 0; k < tally->bands; k++)
        l->count[k] = (uint32_t)w[k];
}

/* As it is sent: where; then counts, each in 28 bits, the replicate above the first one's. */
enum { COUNT_BITS = 28 };
_Static_assert(REPLICATES <= 1 << (32 - COUNT_BITS), "a replicate has room beside a count");

static size_t words(const struct tally *tally)
{
    return 1 + (size_t)tally->bands;
}

static void pack(const struct tally *tally, const struct letter *l, uint32_t *to)
{
    to[0] = l->at;
    for (uint32_t k = 0; k < tally->bands; k++)
        to[1 + k] = l->count[k];
    to[1] |= (uint32_t)l->replicate << COUNT_BITS;
}

/* No thread counts while letters are read: so additions need not wait for each other. */
static void add(_Atomic int64_t *count, int64_t w)
{
    const int64_t before = atomic_load_explicit(count, memory_order_relaxed);
    atomic_store_explicit(count, before + w, memory_order_relaxed);
}

enum { TOGETHER = 64 }; /* letters that wait for memory side by side */

/* Count what came, as it was packed. */
static void count_packed(struct tally *tally, const uint32_t *from, size_t count)
{
    const uint32_t mask = (1u << COUNT_BITS) - 1, bands = tally->bands;
    for (size_t i = 0; i < count; i += TOGETHER) {
        const size_t n = count - i < TOGETHER ? count - i : TOGETHER;
        size_t place[TOGETHER];
        for (size_t j = 0; j < n; j++) {
            const uint32_t *letter = &from[(i + j) * words(tally)];
            place[j] =
                tally->element ? tally->leaf_place[letter[0]] : tally_place(tally, letter[0]);
            tally_prefetch(tally, (int)(letter[1] >> COUNT_BITS), place[j], letter[0]);
        }
        for (size_t j = 0; j < n; j++) {
            const uint32_t *letter = &from[(i + j) * words(tally)];
            const size_t at = (size_t)(letter[1] >> COUNT_BITS) * tally->held + place[j];
            for (uint32_t k = 0; k < bands; k++) {
                const int64_t w = letter[1 + k] & mask;
                add(&tally->face[at * bands + k], w);
                if (tally->element)
                    add(&tally->element[(size_t)letter[0] * bands + k], w);
            }
        }
    }
}

/* All letters, by owner; count[ranks]: how many for each. NULL when out of memory. */
static uint32_t *sort(const struct mail *mail, int batches, const struct tally *tally, size_t ranks,
                      size_t *count)
{
    size_t all = 0, *place = calloc(ranks, sizeof *place);
    for (int b = 0; b < batches; b++)
        for (size_t i = 0; i < mail[b].count; i++)
            count[mail[b].letter[i].owner]++;
    for (size_t k = 0; k < ranks && place; k++) {
        place[k] = all;
        all += count[k];
    }
    uint32_t *sorted = place ? malloc((all + 1) * words(tally) * sizeof *sorted) : NULL;
    for (int b = 0; b < batches && sorted; b++)
        for (size_t i = 0; i < mail[b].count; i++) {
            const struct letter *l = &mail[b].letter[i];
            pack(tally, l, &sorted[place[l->owner]++ * words(tally)]);
        }
    free(place);
    return sorted;
}

int mail_send(struct mail *mail, int batches, struct tally *tally, struct ranks *ranks)
{
    const size_t n = (size_t)ranks_count(ranks), size = words(tally);
    size_t *count = calloc(2 * n, sizeof *count), came = 0;
    uint32_t *out = count ? sort(mail, batches, tally, n, count) : NULL, *in = NULL;
    int failed = !out;
    for (int b = 0; b < batches; b++) {
        failed |= mail[b].failed;
        mail[b].count = 0;
    }
    if (!ranks_any(ranks, failed))
        in = ranks_exchange(ranks, RANKS_PARTICLES, out, size * sizeof *out, count, count + n);
    for (size_t k = 0; k < n && in; k++)
        came += count[n + k];
    count_packed(tally, in, came);
    failed = !in;
    free(in);
    free(out);
    free(count);
    return failed ? -1 : 0;
}

void mail_close(struct mail *mail, int batches)
{
    for (int b = 0; b < batches; b++)
        free(mail[b].letter);
}
