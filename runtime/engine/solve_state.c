/* solve_state.c - see solve_state.h.
 *
 * Links are each in one rank's part, in no order that matters: whoever takes them says that all of
 * the tree is rank 0's, so that every rank hands on what it happens to have read, and shares_settle
 * does the rest, as after a pass.
 * SPDX-License-Identifier: MIT */
#include "engine/solve_state.h"

#include <stdlib.h>
#include <string.h>

#include "engine/state_identity.h"
#include "kernel/constants.h"
#include "kernel/hash_bytes.h"

static const uint64_t NAME = 0x31767672616c6f73u; /* of this layout */

enum { SEEN = 4 };

/* ---- what it is of */

/* Those that change the answer; whose picture counts does so only where nothing is kept. Of
 * clusters it is the strategy, whether it was asked for or chosen. */
static uint64_t hash_options(const struct solve *s)
{
    const struct solve_options *o = &s->problem.options;
    const int clusters = (int)s->hierarchy.strategy;
    const int words[] = {o->iterations,   (int)o->solver, (int)o->projection,
                         (int)o->closure, clusters,       o->linear,
                         o->unit,         o->no_links};
    const uint64_t hash = hash_bytes(0, &o->tolerance, sizeof o->tolerance);
    return hash_bytes(hash, words, sizeof words);
}

static void name_work(uint64_t *head, const struct solve *s, const struct refiner *refiner)
{
    head[STATE_NAME] = NAME;
    head[STATE_VERSION] = state_identity_version();
    head[STATE_SCENE] = state_identity_scene(&s->problem, &s->hierarchy);
    head[STATE_ORACLE] = state_identity_oracle(refiner);
    head[STATE_OPTIONS] = hash_options(s);
    head[STATE_BUILT] = s->hierarchy.built;
}

/* ---- checks */

static size_t size_of(enum RadStateType type)
{
    static const size_t sizes[] = {sizeof(uint64_t), sizeof(uint32_t), sizeof(double),
                                   sizeof(struct link)};
    return sizes[type];
}

/* A sum, whoever has which of them. */
static uint64_t check_links(const struct link *links, size_t count)
{
    uint64_t check = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t word[2];
        memcpy(word, &links[i], sizeof word);
        check += hash64(word[0] + hash64(word[1] + HASH_STEP));
    }
    return check;
}

static uint64_t check_part(const struct RadStatePart *p)
{
    if (p->type == RAD_STATE_OF_LINKS)
        return check_links(p->data, p->rows);
    return hash_bytes(p->rows, p->data, p->rows * p->columns * size_of(p->type));
}

/* Of all words but its own. */
static uint64_t check_head(const uint64_t *head)
{
    uint64_t copy[STATE_WORDS];
    memcpy(copy, head, sizeof copy);
    copy[STATE_CHECKS] = 0;
    return hash_bytes(STATE_WORDS, copy, sizeof copy);
}

/* The parts' forms; their data are still to be set. */
static void shape(struct RadStatePart part[RAD_STATE_PARTS], uint64_t splits, uint64_t elements,
                  uint64_t links, uint64_t bands)
{
    const struct RadStatePart shapes[RAD_STATE_PARTS] = {
        [RAD_STATE_HEAD] = {"head", RAD_STATE_OF_LONGS, STATE_WORDS, 1, NULL},
        [RAD_STATE_SPLIT] = {"split", RAD_STATE_OF_WORDS, splits, 1, NULL},
        [RAD_STATE_MARK] = {"mark", RAD_STATE_OF_WORDS, elements, 1, NULL},
        [RAD_STATE_SEEN] = {"seen", RAD_STATE_OF_NUMBERS, elements, SEEN, NULL},
        [RAD_STATE_UNCOVERED] = {"uncovered", RAD_STATE_OF_NUMBERS, elements, 1, NULL},
        [RAD_STATE_RADIOSITY] = {"radiosity", RAD_STATE_OF_NUMBERS, elements, bands, NULL},
        [RAD_STATE_IRRADIANCE] = {"irradiance", RAD_STATE_OF_NUMBERS, elements, bands, NULL},
        [RAD_STATE_LINK] = {"links", RAD_STATE_OF_LINKS, links, 1, NULL}};
    memcpy(part, shapes, sizeof shapes);
}

/* ---- making one */

const char *solve_state_refusal(const struct solve *s)
{
    const int more = s->error.target > 0 || s->ranking.asked || s->importance.capacity > 0
                     || s->bracket.capacity > 0;
    return more ? "checkpoints are not for oracles that compare errors of all links, read "
                  "importance or enclose the solution"
                : NULL;
}

/* The links that this rank counts: into state->links, unless it is all that there are. */
static int take_links(struct solve_state *state, const struct solve *s, struct RadStatePart *part)
{
    const struct refinement *r = &s->refinement;
    part->data = r->links;
    part->rows = r->link_count;
    if (ranks_count(s->problem.options.ranks) == 1)
        return 0;
    state->links = malloc((r->link_count + 1) * sizeof *state->links);
    part->data = state->links;
    part->rows = 0;
    for (size_t i = 0; i < r->link_count && state->links; i++)
        if (shares_counts(&s->operator.shares, r->links[i].receiver))
            state->links[part->rows++] = r->links[i];
    return state->links ? 0 : -1;
}

int solve_state_make(struct solve_state *state, const struct solve *s,
                     struct RadStatePart part[RAD_STATE_PARTS], const char **cause)
{
    const struct hierarchy *h = &s->hierarchy;
    const struct pass_counts *c = &s->report.counts;
    const uint32_t splits = (h->count - h->built) / 4;
    struct ranks *ranks = s->problem.options.ranks;
    uint64_t *head = state->head;
    solve_state_free(state);
    *cause = solve_state_refusal(s);
    if (*cause)
        return -1;
    *cause = "out of memory for a checkpoint";
    shape(part, splits, h->count, 0, s->problem.bands);
    state->split = malloc(((size_t)splits + 1) * sizeof *state->split);
    state->mark = malloc((size_t)h->count * sizeof *state->mark);
    state->seen = malloc((size_t)h->count * SEEN * sizeof *state->seen);
    if (ranks_any(ranks, !state->split || !state->mark || !state->seen
                             || take_links(state, s, &part[RAD_STATE_LINK]) < 0)) {
        solve_state_free(state);
        return -1;
    }
    for (uint32_t i = 0; i < splits; i++)
        state->split[i] = h->elements[h->built + 4 * i].parent;
    for (uint32_t i = 0; i < h->count; i++) {
        const struct element *e = &h->elements[i];
        const double seen[SEEN] = {e->radiosity, e->spread, e->deviation, (double)e->bend};
        state->mark[i] = e->mark;
        memcpy(&state->seen[SEEN * (size_t)i], seen, sizeof seen);
    }
    memset(head, 0, sizeof state->head);
    name_work(head, s, s->refinement.refiner);
    head[STATE_SPLITS] = splits;
    head[STATE_LINKS] = c->links;
    head[STATE_PASSES] = (uint64_t)s->report.passes;
    head[STATE_SWEEPS] = (uint64_t)s->report.sweeps;
    head[STATE_CHANGING] = s->report.changing;
    head[STATE_PAIRS] = c->pairs;
    head[STATE_ROUNDS] = s->report.rounds;
    head[STATE_RAYS] = c->rays;
    memcpy(&head[STATE_DECIDED], c->decided, sizeof c->decided);
    memcpy(&head[STATE_SECONDS], &s->report.seconds.refine, sizeof(double));
    memcpy(&head[STATE_SECONDS + 1], &s->report.seconds.iterate, sizeof(double));
    memcpy(&head[STATE_SECONDS + 2], &s->report.seconds.in_rays, sizeof(double));
    memcpy(&head[STATE_LINKED], &s->linked, sizeof(double));
    const void *const data[] = {head,
                                state->split,
                                state->mark,
                                state->seen,
                                s->operator.uncovered,
                                s->state.radiosity,
                                s->state.irradiance};
    for (int i = 0; i < RAD_STATE_LINK; i++)
        part[i].data = data[i];
    for (int i = 1; i < RAD_STATE_PARTS; i++)
        head[STATE_CHECKS + i] = check_part(&part[i]);
    ranks_add_counts(ranks, RANKS_VALUES, &head[STATE_CHECKS + RAD_STATE_LINK], 1);
    head[STATE_CHECKS] = check_head(head);
    return 0;
}

void solve_state_free(struct solve_state *state)
{
    free(state->split);
    free(state->mark);
    free(state->seen);
    free(state->links);
    state->split = state->mark = NULL;
    state->seen = NULL;
    state->links = NULL;
}

/* ---- taking one */

static const char damaged[] = "it is damaged";

/* Is it of this work? NULL, or why not. */
static const char *find_stranger(const struct solve *s, const struct refiner *refiner,
                                 const uint64_t *head)
{
    static const struct {
        enum solve_state_word word;
        const char *cause;
    } words[] = {
        {STATE_SCENE, "it is of another scene, or of this one with other materials or sides"},
        {STATE_BUILT, "it is of another scene, or of this one with other groups of faces"},
        {STATE_ORACLE, "it is of another oracle, or of one with other parameters"},
        {STATE_OPTIONS, "it is of a solve with other options"}};
    uint64_t own[STATE_WORDS] = {0};
    name_work(own, s, refiner);
    if (head[STATE_NAME] != own[STATE_NAME] || head[STATE_VERSION] != own[STATE_VERSION])
        return "it is of another version of this program, or damaged";
    if (head[STATE_CHECKS] != check_head(head))
        return damaged;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (head[words[i].word] != own[words[i].word])
            return words[i].cause;
    return NULL;
}

/* Are the parts of the form that the head says, and what they were? Without links of other ranks.
 */
static int are_whole(const struct solve *s, const struct RadStatePart *part, const uint64_t *head)
{
    struct RadStatePart own[RAD_STATE_PARTS];
    const uint64_t elements = head[STATE_BUILT] + 4 * head[STATE_SPLITS];
    if (head[STATE_SPLITS] > UINT32_MAX / 4 || elements > UINT32_MAX)
        return 0;
    shape(own, head[STATE_SPLITS], elements, part[RAD_STATE_LINK].rows, s->problem.bands);
    for (int i = 0; i < RAD_STATE_PARTS; i++)
        if (part[i].type != own[i].type || part[i].rows != own[i].rows
            || part[i].columns != own[i].columns || (part[i].rows && !part[i].data))
            return 0;
    for (int i = 1; i < RAD_STATE_LINK; i++)
        if (head[STATE_CHECKS + i] != check_part(&part[i]))
            return 0;
    const struct link *links = part[RAD_STATE_LINK].data;
    for (uint64_t i = 0; i < part[RAD_STATE_LINK].rows; i++)
        if (!link_may_be(&links[i], elements))
            return 0;
    return 1;
}

/* Split in the order that gives each four the place it had. Returns 0, -1 out of memory, 1 not so.
 */
static int split_again(struct hierarchy *h, const struct RadStatePart *part)
{
    const uint32_t *split = part->data;
    for (uint64_t i = 0; i < part->rows; i++) {
        const struct element *e = &h->elements[split[i] < h->count ? split[i] : 0];
        if (!e->vertices || e->children || e->depth >= LIMIT_DEPTH_MOST)
            return 1;
        if (hierarchy_split(h, split[i]) < 0)
            return -1;
    }
    return 0;
}

static void show_elements(struct hierarchy *h, const struct RadStatePart *part)
{
    const uint32_t *mark = part[RAD_STATE_MARK].data;
    const double *seen = part[RAD_STATE_SEEN].data;
    for (uint32_t i = 0; i < h->count; i++, seen += SEEN) {
        struct element *e = &h->elements[i];
        e->mark = (uint16_t)mark[i];
        e->radiosity = seen[0];
        e->spread = seen[1];
        e->deviation = seen[2];
        e->bend = (float)seen[3];
    }
}

/* Counts of before are rank 0's. */
static void recount(struct solve *s, const uint64_t *head)
{
    struct refinement *r = &s->refinement;
    struct report *report = &s->report;
    const int first = ranks_number(s->problem.options.ranks) == 0;
    double seconds[3];
    memcpy(seconds, &head[STATE_SECONDS], sizeof seconds);
    memcpy(&s->linked, &head[STATE_LINKED], sizeof s->linked);
    report->passes = (int)head[STATE_PASSES];
    report->sweeps = (int)head[STATE_SWEEPS];
    report->changing = head[STATE_CHANGING];
    report->seconds.refine = seconds[0];
    report->seconds.iterate = seconds[1];
    report->seconds.in_rays = seconds[2];
    r->rounds = head[STATE_ROUNDS];
    r->pairs = first ? head[STATE_PAIRS] : 0;
    for (int i = 0; i < 8 && first; i++)
        r->decided[i] = head[STATE_DECIDED + i];
    for (uint32_t i = r->built; i < s->hierarchy.count; i++)
        if (s->hierarchy.elements[i].depth > r->deepest)
            r->deepest = s->hierarchy.elements[i].depth;
    /* such that those of this run's beginning stand in their place, not beside them */
    r->common = rays_count(s->problem.rays).rays - (first ? head[STATE_RAYS] : 0);
}

int solve_state_take(struct solve *s, const struct refiner *refiner,
                     const struct RadStatePart part[RAD_STATE_PARTS], int *refused,
                     const char **cause)
{
    struct ranks *ranks = s->problem.options.ranks;
    struct refinement *r = &s->refinement;
    uint64_t head[STATE_WORDS], sums[2];
    *refused = 1;
    *cause = damaged;
    const struct RadStatePart *first = &part[RAD_STATE_HEAD], *links = &part[RAD_STATE_LINK];
    const int headless = !first->data || first->rows != STATE_WORDS || first->columns != 1
                         || first->type != RAD_STATE_OF_LONGS;
    if (ranks_any(ranks, headless))
        return -1;
    memcpy(head, first->data, sizeof head);
    const char *stranger = find_stranger(s, refiner, head);
    if (ranks_any(ranks, stranger != NULL)) {
        *cause = stranger ? stranger : damaged;
        return -1;
    }
    if (ranks_any(ranks, !are_whole(s, part, head)))
        return -1;
    sums[0] = links->rows;
    sums[1] = check_links(links->data, links->rows);
    ranks_add_counts(ranks, RANKS_VALUES, sums, 2);
    if (sums[0] != head[STATE_LINKS] || sums[1] != head[STATE_CHECKS + RAD_STATE_LINK])
        return -1;
    *refused = 0;
    if (solve_begin(s, refiner, cause) < 0)
        return -1;
    const char *refusal = solve_state_refusal(s);
    if (refusal) {
        *refused = 1;
        *cause = refusal;
        return -1;
    }
    const int splits = split_again(&s->hierarchy, &part[RAD_STATE_SPLIT]);
    if (ranks_any(ranks, splits > 0)) {
        *refused = 1;
        return -1;
    }
    *cause = "out of memory for what the checkpoint holds";
    struct link *own = splits < 0 ? NULL : malloc((links->rows + 1) * sizeof *own);
    if (own && links->rows)
        memcpy(own, links->data, links->rows * sizeof *own);
    free(r->links);
    r->links = own;
    r->link_count = own ? links->rows : 0;
    r->link_capacity = own ? links->rows + 1 : 0;
    if (ranks_any(ranks, !own || solve_make_room(s) < 0))
        return -1;
    show_elements(&s->hierarchy, part);
    double *const values[] = {s->operator.uncovered, s->state.radiosity, s->state.irradiance};
    for (int i = 0; i < 3; i++) {
        const struct RadStatePart *p = &part[RAD_STATE_UNCOVERED + i];
        memcpy(values[i], p->data, p->rows * p->columns * sizeof *values[i]);
    }
    shares_take_all(&s->operator.shares);
    if (shares_settle(&s->operator.shares, r, s->hierarchy.count) < 0)
        return -1;
    recount(s, head);
    return solve_recount(s) < 0 ? -1 : 0;
}
