/* amalgam.h - C files put one into the other, as their #include lines say.
 * SPDX-License-Identifier: MIT */
#ifndef AMALGAM_H
#define AMALGAM_H

#include "emit/c_text.h"

struct amalgam_file {
    const char *name, *path, *text;
    const char *beside; /* the folder that its #include lines begin from; NULL: made or built in */
    struct c_tokens tokens;
    unsigned char guarded; /* a second inclusion has no effect */
    unsigned char once;    /* by #pragma once */
    unsigned char built_in;
    unsigned char made; /* by dagc: there is no such file */
    unsigned char in;   /* put in where no condition can take it out */
};

struct amalgam {
    struct dag *dag;
    struct amalgam_file *files;
    int file_count;
    struct c_names names;    /* that they define */
    struct table members;    /* that they name after `.` or `->` */
    const char *prefix;      /* of the names */
    const char *const *host; /* [host_count] headers that stay where they are */
    int host_count;
    int directives;      /* #line at each change of file */
    int built_in;        /* dagc's own headers may be taken */
    int depth;           /* of files in files */
    const char *catalog; /* the folder of the catalog: the last place to look; NULL: none */
};

/* Adds a text of this name, as good as a file. */
void dag_amalgam_text(struct amalgam *amalgam, const char *name, const char *text);

/* Puts in the header `name` that a catalog (in the folder `beside`; NULL: none) declares, with what
 * it includes. 0: there is none. With out NULL nothing is printed: the names are gathered, which
 * all printing needs first. */
int dag_amalgam_put(struct amalgam *amalgam, struct text *out, const char *name,
                    const char *beside);

/* After a pass over all files: the next one begins. */
void dag_amalgam_again(struct amalgam *amalgam);

#endif
