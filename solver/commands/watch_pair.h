/* watch_pair.h - all that is said of one pair while a scene is solved.
 *
 * Refinement goes from the pair (root, root) down: of the pairs that hold the wanted one, each is
 * split into others of which one holds it, until a link is made or light is given up. These pairs
 * are watched: at each, the discussion is held once more, node by node, while everything is as the
 * oracle saw it.
 * SPDX-License-Identifier: MIT */
#ifndef WATCH_PAIR_H
#define WATCH_PAIR_H

#include <jansson.h>
#include "radiosity.h"

/* Receiver or emitter: the way down the tree to it, as far as there are elements. */
struct watched_end {
    char name[RAD_NAME]; /* "": by its point */
    const char *rest;    /* of name: parts that are not there yet */
    double point[3];
    uint32_t *line; /* [count], the root first */
    size_t count, capacity;
    size_t begun; /* of them, so many were there before anything was split */
};

/* A discussion that was held, and all that it began with: `discussion` points into the rest. */
struct occasion {
    int pass;
    uint64_t round, way;
    uint32_t receiver, emitter, rays;
    int nodes;
    const char *decision;
    char *text;   /* node by node, as explanation_print */
    json_t *json; /* as explanation_json */
    struct element elements[2];
    struct host host;
    struct blockers list;
    struct discussion discussion;
};

struct watch {
    RadSolution solution;
    RadOracle oracle;
    struct watched_end end[2];   /* receiver, emitter */
    struct occasion **occasions; /* [count], in the order of time */
    size_t count, capacity;
    int pass;   /* of the last */
    int failed; /* out of memory, or the library */
};

/* `pair`: "RECEIVER,EMITTER"; or `at`: "X,Y,Z:X,Y,Z". Before anything is refined. Returns 0, 2
 * after a message about how it is written, 1 after any other. */
int watch_open(struct watch *w, RadDevice device, RadSolution solution, RadOracle oracle,
               const char *pair, const char *at);
void watch_close(struct watch *w);

/* After the solve: the occasions' elements as they are numbered now. Returns 0, or -1 when out of
 * memory. */
int watch_settle(struct watch *w);

/* After that: the element at one end; of a point, the leaf. Returns 0, or -1 after an error of
 * the device. */
int watch_element(struct watch *w, int end, uint32_t *element);

/* Hold a discussion of receiver and emitter as things stand now. Returns NULL after a message that
 * names `where`. */
struct occasion *occasion_hold(RadDevice device, RadSolution solution, RadOracle oracle,
                               const uint32_t element[2], const char *where);

void occasion_free(struct occasion *o);

/* Both by name, "12/0,3". Returns 0, or -1: it is none. */
int watch_split(const char *pair, char name[2][RAD_NAME]);

#endif
