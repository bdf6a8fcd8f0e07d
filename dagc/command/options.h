/* options.h - what a command line asks for.
 * SPDX-License-Identifier: MIT */
#ifndef OPTIONS_H
#define OPTIONS_H

#include "base/warn.h"
#include "base/write.h"
#include "emit/skeleton.h"

enum emit {
#define EMIT(number, name, source, says) EMIT_##number,
#include "emit/emits.def"
#undef EMIT
    EMITS
};

enum { OUTPUT_TEXT, OUTPUT_HEADER, OUTPUT_DEPFILE, OUTPUTS };

struct job {
    const char *input_path, *catalog_path; /* catalog_path NULL: the standard catalog */
    const char *emit_name, *dump_name;     /* as they were asked for; NULL: not */
    enum emit emit;
    enum pass stop; /* --dump; PASSES: none */
    struct warnings warnings;
    struct emit_options c;    /* of C text */
    int prove;                /* --prove */
    int skeleton;             /* --emit=stub of a catalog */
    int proved;               /* what it found */
    const char *profile_path; /* NULL: none */
    struct input input, catalog, profile;
    const char **folders; /* of -I; room for as many as there are arguments */
    int folder_count;
    struct skeleton files;   /* when it makes one */
    const char **host;       /* of --host; likewise */
    const char *second_path; /* of diff */
    struct output outputs[OUTPUTS];
};

/* Is FILE.dag a catalog? */
int dag_job_is_catalog(const struct job *job);

/* Reads the command line. -1: run the job; else the status to exit with: all has been said. */
int dag_parse_arguments(struct job *job, int count, char **arguments);

/* dagc diff [OPTION]... A.dag B.dag: the same, for two files. */
int dag_parse_diff(struct job *job, int count, char **arguments);

#endif
