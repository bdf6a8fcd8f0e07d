/* oracle.h - how a program meets an oracle it did not know when it was compiled.
 *
 * Every C file that dagc emits for an oracle NAME defines, next to NAME_refine and
 * NAME_defaults, one `const struct oracle NAME_oracle`; a loader (dlsym) or a table of
 * built-in oracles needs no more to list parameters, set them and refine. (A catalog with a verb of
 * its own has that in place of `refine`.) It is of no domain: what a decision and a discussion are,
 * the runtime's header says, which comes first.
 * SPDX-License-Identifier: MIT */
#ifndef ORACLE_H
#define ORACLE_H

#include <stddef.h>
#ifndef RUNTIME_ABI /* no runtime has been included: radiosity's is meant */
#include "discussion.h"
#endif

/* One parameter of an oracle and where it lives in the oracle's parameter structure. */
struct oracle_parameter {
    const char *name;
    const char *unit; /* "" for a plain number */
    const char *doc;
    double value, low, high; /* default and closed range */
    int integer;             /* the field is an int, not a double */
    size_t offset;           /* of the field in the parameter structure */
    int role;                /* enum catalog_role: what it is to a program, whatever its name */
    int fixed;               /* by the oracle's author: it is not to be set */
};

struct oracle {
    int abi; /* RUNTIME_ABI it was compiled against */
    const char *name, *doc;
    const char *fingerprint; /* of the graph: equal fingerprints, equal decisions */
    const struct oracle_parameter *parameters;
    int parameter_count;
    size_t parameters_size;             /* sizeof the parameter structure */
    void (*defaults)(void *parameters); /* fills a parameter structure */
    /* where discussion->terms.no_number is not NULL afterwards, an argument was no number */
    enum decision (*refine)(const void *parameters, struct discussion *discussion);
    /* [read_count], enum catalog_fact: the facts that its arguments read, ascending */
    const int *reads;
    int read_count;
    /* What refine does, of each of `count` discussions; which of them stand together changes no
     * answer. All have one host. NULL: it was compiled without (dagc --release=wave). */
    void (*wave)(const void *parameters, struct discussion *block, int count,
                 enum decision *decisions);
};

#endif
