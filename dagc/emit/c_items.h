/* c_items.h - C text taken apart into top-level items, to keep those needed and rename what they
 * declare.
 * SPDX-License-Identifier: MIT */
#ifndef C_ITEMS_H
#define C_ITEMS_H

#include "base/internal.h"

/* A declaration, a definition, a #define or a whole #if ... #endif, with the comment before it. */
struct c_item {
    const char *text;
    size_t length;
    int file;                  /* in files */
    unsigned char kept, shown; /* is it needed? was it printed? */
    unsigned char reached_by;  /* which roots need it: C_PUBLIC | C_PRIVATE */
};
enum { C_PUBLIC = 1, C_PRIVATE = 2 };

struct c_file {
    const char *name;
    const char *idea; /* its first comment, without the licence line; NULL: none */
    unsigned char shown;
};

struct c_items {
    struct dag *dag;
    struct c_item *items;
    int item_count;
    struct c_file *files;
    int file_count;
    const char **system;
    int system_count;         /* <math.h> and the like, as written, once each */
    struct table tags, names; /* what the items declare: the item */
    struct table members;     /* what kept items name after `.` or `->` */
};

/* Adds the items of a text. `include` is called for each #include "NAME" before what follows it. */
void dag_items_add(struct c_items *items, const char *name, const char *text,
                   void (*include)(struct c_items *items, const char *name, void *context),
                   void *context);

/* Marks the items of a file and all that they need. */
void dag_items_keep(struct c_items *items, const char *file, int reached_by);

/* Prints an item; what the items declare gets the prefix: P_name, and P in capitals for NAME. */
void dag_items_print(struct c_items *items, struct c_item *item, struct text *out,
                     const char *prefix);

#endif
