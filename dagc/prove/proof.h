/* proof.h - what the two halves of a proof tell each other: dagc, which walks the graph, and the
 * library that it has compiled, in which both releases run over scripted tools.
 *
 * The library (runtime/oracle/in_proof.inc) is compiled from the same text of this header, so the
 * structures are the same.
 * SPDX-License-Identifier: MIT */
#ifndef PROOF_H
#define PROOF_H

#include <stddef.h>

struct argument;
struct dag;
struct dag_doubt;
struct discussion;
struct node;
struct oracle;
struct oracle_graph;

/* What runs. What the options do not ask for is not there. */
enum prove_flavour {
    PROVE_PLAIN,
    PROVE_FIRST, /* the entry for a first discussion (--copies) */
    PROVE_COUNTED,
    PROVE_TRACED,
    PROVE_WAVE, /* the function over a block (--release=wave), in which the pair is not alone */
    PROVE_INTERPRETED,
    PROVE_FLAVOURS
};

enum { PROVE_LEVELS = 256 }; /* more than any term has */

/* One discussion: what its tools find and answer, and what they were asked. */
struct prove_record {
    const unsigned char *script; /* [room]: the answers to give */
    const unsigned char *start;  /* by term: the level it comes with */
    /* [PROVE_LEVELS] by term: its value at each level, of a vector the first of its numbers, of
     * which each is larger by 1 than the one before */
    const double *known;
    const double *facts;   /* by fact, then by extern */
    int room;              /* no path has more events */
    int calls;             /* of tools */
    int events;            /* calls, and terms and externs that arguments read */
    int *what;             /* by event: a tool, ~term, or ~(terms + extern) */
    long long *site;       /* by event: from which place in its text or step it came */
    double *arguments;     /* [width] by event; of a term the level that is asked for */
    unsigned char *levels; /* [terms] by event: what is known then */
    double *terms;         /* at the end: all numbers of all terms */
    unsigned char *end;    /* by term: its level then */
    const char *no_number; /* at the end: which argument was none, first of all; NULL: all were */
    int watched;           /* calls that the counters or the trace have seen */
    int untrue;            /* the text takes for known what is not */
};

/* A parameter as a release describes it. */
struct prove_parameter {
    const char *name, *unit, *doc;
    double value, low, high, given; /* given: what the release begins with */
    size_t offset, field, end; /* as described; in truth; behind the field. Of the flat release */
    int integer, role, fixed;
};

struct prove_description {
    const char *name, *doc, *fingerprint;
    int parameters, reads;
    const int *read;
    size_t size, block; /* of the parameters: as described, in truth */
};

enum prove_release { PROVE_FLAT, PROVE_DAG, PROVE_RELEASES };

/* Of each oracle, by its number, printed with its text: where its parameters are in truth. */
struct prove_compiled {
    const struct oracle *oracle;
    int (*watched)(int flavour, const void *parameters, struct discussion *d);
    const size_t *fields, *ends;
    size_t size;
};

/* What the interpreter asks of dagc's library. */
struct prove_host {
    struct dag *dag;
    int (*is_fixed)(const struct dag *dag, int expression);
    int (*reads_fact)(const struct dag *dag, const struct oracle_graph *oracle, int fact);
    const struct node *(*node_at)(const struct dag *dag, const struct oracle_graph *oracle,
                                  int place);
    void (*fingerprint_text)(const struct oracle_graph *oracle, char text[17]);
    int (*is_doubtful)(const struct dag *dag, const struct argument *argument);
    struct dag_doubt (*doubt)(struct dag *dag, const struct node *node,
                              const struct argument *argument);
};

/* The library's one symbol, prove_library. */
struct prove_library {
    /* Opens both releases of an oracle with their defaults. NULL, or what is wrong. */
    const char *(*open)(const struct prove_host *host, int oracle);
    void (*close)(void);
    void (*describe)(enum prove_release release, struct prove_description *description);
    void (*parameter)(enum prove_release release, int number, struct prove_parameter *parameter);
    /* As a program sets it, then what it is: 0, or -1 where it is refused. */
    int (*set)(enum prove_release release, int number, double value, double *then);
    /* In both releases where their descriptions say that it is, whatever its range. */
    void (*write)(int number, double value);
    void (*written)(void); /* after the last of them */
    int (*run)(enum prove_flavour flavour, struct prove_record *record);
};

#endif
