/* limits.c - where refinement ends that would not end by itself.
 *
 * What dagc proves of a graph's guards does not hold for a refiner in somebody's C, and guards
 * whose limits are set to 0 end too late to be of use. So refinement itself ends, with an error:
 * what it has by then is no answer, since pairs that still wait exchange no light.
 *
 *   depth     parts that are too small to matter anywhere, where can_split does not yet refuse
 *   elements  A pair that is split gives at least four, and each ends in a link or a stop, or is
 *             split again: refinement that ends has made no more parts of faces than 4/3 of these
 *             ends, and while it runs no more than 4/3 of them and of the pairs that wait. One that
 *             does not end makes parts, and few ends. So the limit is on how far the parts are
 *             ahead of twice the ends. [D: derived here]
 *             Given as a number it is a limit on all parts.
 *   links     that they, and elements, fit into half of the memory that is there; of several ranks
 *             each has its part of its machine, and all have the limits of the one with least
 *   pairs, rounds
 *             far beyond any run; they end what goes on at one depth in little memory
 *
 * The node at fault is found afterwards: the last pairs that were to be split are discussed again
 * by the interpreter, which tells the way each took.
 * SPDX-License-Identifier: MIT */
#include "engine/limits.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "engine/refine.h"
#include "engine/shares.h"
#include "kernel/constants.h"
#include "oracle/follow.h"
#include "util/ranks.h"

/* The first line of a file as a number; or `otherwise`. */
static double number_in(const char *path, double otherwise)
{
    double number = otherwise;
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%lf", &number) != 1)
        number = otherwise;
    if (file)
        (void)fclose(file);
    return number;
}

/* Bytes that are there now: of the machine, or what a limit on the container or on the address
 * space leaves. */
static double memory_there(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), size = sysconf(_SC_PAGESIZE);
    double there = pages > 0 && size > 0 ? (double)pages * (double)size : 4e9, kilobytes;
    struct rlimit space;
    char line[128];
    FILE *info = fopen("/proc/meminfo", "r");
    while (info && fgets(line, sizeof line, info))
        if (sscanf(line, "MemAvailable: %lf", &kilobytes) == 1)
            there = 1024 * kilobytes;
    if (info)
        (void)fclose(info);
    there = fmin(there, number_in("/sys/fs/cgroup/memory.max", INFINITY)); /* "max": none */
    if (getrlimit(RLIMIT_AS, &space) == 0 && space.rlim_cur != RLIM_INFINITY
        && (double)space.rlim_cur < there)
        there = (double)space.rlim_cur;
    return there;
}

struct limits limits_complete(struct limits wanted, struct ranks *ranks)
{
    struct limits l = wanted;
    double there = -memory_there() / ranks_beside(ranks);
    ranks_most(ranks, RANKS_PAIRS, &there, 1);
    there = -there; /* the least */
    /* a link stands twice while links are sorted */
    double links = LIMIT_MEMORY * there / (2 * sizeof(struct link));
    double elements = LIMIT_MEMORY * there / sizeof(struct element);
    double ahead = elements / 2 < LIMIT_AHEAD ? elements / 2 : LIMIT_AHEAD;
    l.ahead = l.elements ? 0 : (uint64_t)ahead;
    l.elements = l.elements ? l.elements : (uint64_t)elements;
    l.depth = l.depth ? l.depth : LIMIT_DEPTH;
    l.links = l.links ? l.links : (uint64_t)links;
    l.pairs = l.pairs ? l.pairs : LIMIT_PAIRS;
    l.rounds = l.rounds ? l.rounds : LIMIT_ROUNDS;
    return l;
}

enum { DEPTH, ELEMENTS, LINKS, PAIRS, ROUNDS, LIMITS };
static const char *const NAMES[LIMITS] = {"depth", "elements", "links", "pairs", "rounds"};
enum { LEAST = 1024 }; /* pairs between two questions to other ranks */

static uint64_t parts_of(const struct refinement *r)
{
    return r->hierarchy->count - r->built;
}

/* How many parts of faces there may be now. */
static uint64_t most_parts(const struct refinement *r)
{
    const struct limits *l = &r->limits;
    uint64_t ends =
        r->decided[DECISION_LINK] + r->decided[DECISION_LINK_CLUSTERS] + r->decided[DECISION_STOP];
    uint64_t most = l->ahead + 2 * ends;
    return l->ahead && most < l->elements ? most : l->elements;
}

const char *limits_met(const struct refinement *r)
{
    const struct limits *l = &r->limits;
    return r->deepest > l->depth         ? NAMES[DEPTH]
           : parts_of(r) > most_parts(r) ? NAMES[ELEMENTS]
           : r->link_count > l->links    ? NAMES[LINKS]
           : r->pairs > l->pairs         ? NAMES[PAIRS]
           : r->rounds > l->rounds       ? NAMES[ROUNDS]
                                         : NULL;
}

/* All ranks tell what they have come to. Returns how many of them go on refining. */
static uint64_t add_up(struct refinement *r, struct ranks *ranks, int goes_on, int failed)
{
    struct {
        uint64_t pairs, goes_on, failed, met[LIMITS]; /* ranks that failed otherwise, by limits */
    } all = {.pairs = r->pairs, .goes_on = (uint64_t)goes_on, .failed = failed && !r->met};
    for (int i = 0; i < LIMITS; i++)
        all.met[i] = failed && r->met == NAMES[i];
    ranks_add_counts(ranks, RANKS_PAIRS, &all.pairs, sizeof all / sizeof all.pairs);
    all.met[PAIRS] += all.pairs > r->limits.pairs;
    r->ended = all.failed > 0;
    r->met = NULL;
    for (int i = 0; i < LIMITS && !r->ended; i++)
        if (all.met[i]) {
            r->met = NAMES[i];
            r->ended = 1;
        }
    const uint64_t left = r->ended ? 0 : r->limits.pairs - all.pairs,
                   each = all.goes_on ? left / all.goes_on : left;
    r->allowed = r->pairs + (each > LEAST ? each : LEAST);
    return all.goes_on;
}

int limits_allow(struct refinement *r, int pairs)
{
    if (!r->shares)
        return pairs;
    struct ranks *ranks = r->shares->ranks;
    if (!r->allowed)
        r->allowed = r->limits.pairs / (uint64_t)ranks_count(ranks);
    if (r->pairs + 2 * (uint64_t)pairs > r->allowed) /* each counts twice if both ways round */
        add_up(r, ranks, 1, 0);
    if (r->ended)
        return -1;
    const uint64_t left = (r->allowed - r->pairs) / 2;
    return left < (uint64_t)pairs ? (int)left : pairs;
}

int limits_share(struct refinement *r, struct ranks *ranks, int failed)
{
    if (ranks_count(ranks) == 1 || r->deal)
        return ranks_any(ranks, failed);
    while (!r->ended && add_up(r, ranks, 0, failed) > 0) /* others ask whether they may go on */
        ;
    return r->ended;
}

/* ---- what is said */

enum { ASKED = 512, WAY_MOST = 4096 };

/* How often each arc of the graph ended a discussion with a split. */
struct blame {
    struct RadAnswer answer;
    int count;
};

static void add_blame(struct blame *blame, int *kinds, const struct RadAnswer *answer)
{
    int i = 0;
    while (i < *kinds
           && (blame[i].answer.node_number != answer->node_number
               || blame[i].answer.answer_number != answer->answer_number))
        i++;
    if (i == *kinds)
        blame[(*kinds)++] = (struct blame){*answer, 0};
    blame[i].count++;
}

/* One of the last pairs once more; the answer that decided. 0: it decided otherwise. */
static int ask_again(const struct refinement *r, const struct refiner *graph,
                     const struct link *pair, struct RadAnswer *way, struct RadAnswer *decided)
{
    struct blockers list = {.known = BLOCKERS_UNKNOWN};
    struct discussion d;
    uint64_t number;
    d.receiver = &r->hierarchy->elements[pair->receiver];
    d.emitter = &r->hierarchy->elements[pair->emitter];
    d.host = r->host;
    d.blockers = &list;
    memset(&d.terms, 0, sizeof d.terms);
    enum decision decision = follow_ask(graph, &d, &number);
    int count = follow_way(way, WAY_MOST, graph, number);
    if (decision == DECISION_STOP || decision_links(decision) || count < 1 || count > WAY_MOST)
        return 0;
    *decided = way[count - 1];
    return 1;
}

/* The node whose answer splits most of the last pairs: its count of *asked; 0: nobody knows. */
static int find_fault(const struct refinement *r, struct refiner *graph, struct RadAnswer *fault,
                      int *asked)
{
    struct messages messages = {0};
    struct RadAnswer decided, *way = malloc(WAY_MOST * sizeof *way);
    struct blame *blame = malloc(ASKED * sizeof *blame);
    int kinds = 0, most = 0;
    *asked = 0;
    int open = way && blame && graph && follow_open(graph, &messages) == 0;
    int step = r->round_count / ASKED + 1;
    for (int i = 0; open && i < r->round_count; i += step)
        if (ask_again(r, graph, &r->outcomes[i].link[0], way, &decided)) {
            add_blame(blame, &kinds, &decided);
            ++*asked;
        }
    for (int i = 0; i < kinds; i++)
        if (blame[i].count > most) {
            most = blame[i].count;
            *fault = blame[i].answer;
        }
    messages_free(&messages);
    free(blame);
    free(way);
    return most;
}

void limits_tell(const struct refinement *r, struct refiner *graph, char *text, size_t size)
{
    const struct limits *l = &r->limits;
    const char *met = r->met;
    struct RadAnswer fault = {0};
    int asked, most = find_fault(r, graph, &fault, &asked);
    uint64_t limit = strcmp(met, "depth") == 0      ? (uint64_t)l->depth
                     : strcmp(met, "elements") == 0 ? most_parts(r)
                     : strcmp(met, "links") == 0    ? l->links
                     : strcmp(met, "pairs") == 0    ? l->pairs
                                                    : l->rounds;
    size_t at = (size_t)snprintf(
        text, size,
        "refinement did not end within %s=%llu: oracle %s has made %llu parts of faces, %d splits "
        "deep, and %zu links, has discussed %llu pairs in %llu rounds, and %zu wait",
        met, (unsigned long long)limit, r->refiner->oracle, (unsigned long long)parts_of(r),
        r->deepest, r->link_count, (unsigned long long)r->pairs, (unsigned long long)r->rounds,
        r->queue_count);
    if (most > 0 && at < size)
        at += (size_t)snprintf(text + at, size - at,
                               "; of the last subdivisions node '%s' decides %d in %d, by answer "
                               "'%s' of %s -> %s",
                               fault.node, most, asked, fault.answer, fault.tool, fault.target);
    if (at < size)
        snprintf(text + at, size - at,
                 "; let it ask a tool that guards, such as can_split, whose limits are above 0, or "
                 "raise this one");
}
