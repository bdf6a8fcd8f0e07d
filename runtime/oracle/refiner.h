/* refiner.h - an oracle ready to be asked, whatever its release: flat, hand or DAG.
 * SPDX-License-Identifier: MIT */
#ifndef REFINER_H
#define REFINER_H

#include "oracle.h"
#include "util/messages.h"

/* To ask it: refiner->refine(refiner->state, &discussion). Safe from many threads at once as long
 * as no parameter is set meanwhile. */
struct refiner {
    enum decision (*refine)(const void *state, struct discussion *d);
    /* the same of `count` discussions with one host; NULL: only pair by pair */
    void (*wave)(const void *state, struct discussion *block, int count, enum decision *decisions);
    const void *state; /* a parameter structure, or the interpreter's program */
    const char *oracle, *release, *doc;
    const char *fingerprint; /* of its graph, in all releases alike; NULL when hand-written */
    const struct oracle_parameter *parameters; /* [parameter_count] */
    int parameter_count;
    const int *reads; /* [read_count], enum catalog_fact: what its arguments read */
    int read_count;
    void *block;                              /* owned: where parameters[i].offset points into */
    void (*prepare)(struct refiner *refiner); /* after a parameter has changed; may be NULL */
    void (*release_state)(struct refiner *refiner);
    void *own; /* what release_state frees */
};

/* A compiled oracle (flat or hand) with its default parameters; `release` names which.
 * Returns NULL when out of memory or when it was compiled against another RUNTIME_ABI. */
struct refiner *refiner_compiled(const struct oracle *oracle, const char *release);

/* The DAG release: load `path` ("-": standard input) or, when `text` is not NULL, that text under
 * the name `path`, and interpret the oracle called `name` (NULL: the only one). Returns NULL after
 * a message. */
struct refiner *refiner_interpreted(const char *path, const char *text, const char *name,
                                    struct messages *messages);

/* A C function that an oracle names with `extern`, for the interpreter; the flat release is
 * linked with it. */
typedef double extern_function(const struct discussion *d);
struct extern_entry {
    const char *name;
    extern_function *call;
};

/* All that the interpreter may be told; zero: as refiner_interpreted. Everything is the caller's
 * and need not outlive the call, but for the functions. */
struct interpretation {
    const char *path, *text, *oracle; /* as above */
    const char *catalog_path;         /* the catalog's file; NULL: the standard catalog */
    /* where imports are looked for, after the importing file's own */
    const char *const *folders;
    int folder_count;
    const struct extern_entry *externs;
    int extern_count;
    /* asked, with `find_where`, for an extern that is not among them; NULL: nobody is */
    extern_function *(*find_extern)(const void *where, const char *name);
    const void *find_where;
    /* of warnings, as in struct dag_options; NULL: errors alone */
    const char *switches;
    /* nodes that are to be otherwise, as in struct dag_options */
    const char *const *replacements;
    int replacement_count;
};

/* The DAG release again. An `extern` of the oracle that nobody defines is an error, and so is a
 * tool, term or fact that the program was built without. */
struct refiner *refiner_interpret(const struct interpretation *how, struct messages *messages);

/* Set a parameter. Returns 0, or -1 after a message that names the parameter and its range, or
 * those there are. */
int refiner_set(struct refiner *refiner, const char *name, double value, struct messages *messages);
/* a parameter's index; -1: there is none */
int refiner_find(const struct refiner *refiner, const char *name);
double refiner_get(const struct refiner *refiner, int parameter);

/* The first parameter of that role (enum catalog_role), after the index `after`; -1: there is
 * none. Begin with -1. */
int refiner_find_role(const struct refiner *refiner, int role, int after);

/* Does some argument of it read that fact (enum catalog_fact), so that whoever asks must provide
 * it? */
int refiner_reads(const struct refiner *refiner, int fact);

/* The graph of an interpreted oracle as dagc --emit=json gives it, the refiner's own. NULL after a
 * message. Not from two threads at once. */
const char *refiner_graph(const struct refiner *refiner, struct messages *messages);

void refiner_close(struct refiner *refiner); /* NULL is fine */

#endif
