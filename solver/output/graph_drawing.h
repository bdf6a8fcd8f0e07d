/* graph_drawing.h - a decision graph as shapes with texts in them, before and after they have
 * places.
 *
 * graph_drawing.c makes the shapes from the graph and the statistics, graph_layout.c places them,
 * graph_svg.c draws. Lengths are points, y grows downwards. Texts are the drawing's.
 * SPDX-License-Identifier: MIT */
#ifndef GRAPH_DRAWING_H
#define GRAPH_DRAWING_H

#include <jansson.h>
#include <stddef.h>

enum { DRAWING_LINES = 12, DRAWING_HEATS = 7 };

/* The letters' height in points; widths are reckoned from it (graph_drawing.c). */
enum { DRAWING_NAME = 12, DRAWING_SMALL = 9 };

struct drawing_node {
    const char *name, *class;         /* "question", "term", "command" */
    const char *title;                /* what hovering tells, lines */
    const char *lines[DRAWING_LINES]; /* the first is its name */
    int line_count;
    int guards;                 /* its tool says that a subdivision may go on */
    int heat;                   /* 0 to DRAWING_HEATS - 1, share of the time; -1: no statistics */
    int unused;                 /* statistics know that it was never asked */
    int branch;                 /* in branches; -1: the oracle's own */
    double discussed;           /* how often, by the statistics */
    double x, y, width, height; /* x, y: the middle */
};

/* Leaves are drawn once below each node that decides: arcs from everywhere to one `stop` would
 * hide the graph. */
struct drawing_leaf {
    int node;
    const char *decision, *class; /* "links", "subdivides", "stops" */
    const char *title;
    int unused;
    double x, y, width, height;
};

/* Answers of one node, of one kind, that lead to one place: one line. Dead ones stand apart. */
struct drawing_arc {
    int from, node, leaf; /* from a node to a node or a leaf, the other is -1 */
    const char *kind;     /* "precise", "approximate", "other", "command" */
    const char *answer;   /* the first of them */
    const char *title;
    const char *lines[DRAWING_LINES];
    int line_count;
    int dead;       /* statistics know that no discussion took it */
    double share;   /* of all discussions; -1: no statistics */
    double *points; /* [2 * point_count]: a start, then cubic curves, three points each */
    size_t point_count;
    double tip[2];                          /* of the arrow */
    double x, y, label_width, label_height; /* of its label: the middle */
};

/* One place where a branch is used. */
struct drawing_branch {
    const char *name, *label, *title;
    int outer; /* in branches; -1 */
    double left, top, right, bottom, label_x, label_y, label_width;
};

struct drawing {
    const char *oracle, *doc, *summary; /* summary NULL: no statistics */
    struct drawing_node *nodes;
    struct drawing_leaf *leaves;
    struct drawing_arc *arcs;
    struct drawing_branch *branches;
    size_t node_count, leaf_count, arc_count, branch_count;
    double width, height;
    char **texts; /* owned */
    size_t text_count, text_capacity, leaf_capacity, arc_capacity;
    int failed; /* out of memory */
};

/* The oracle `name` of a dagc/1 document, with statistics (NULL: none). Returns 0, or -1 after a
 * message; to be closed either way. */
int drawing_open(struct drawing *p, const json_t *graph, const char *name,
                 const json_t *statistics);
void drawing_close(struct drawing *p);

/* Give everything its place, by Graphviz. Returns 0, or -1 after a message. */
int drawing_place(struct drawing *p);

/* About how wide a line is, at that height of its letters. */
double drawing_text_width(const char *text, double height);

#endif
