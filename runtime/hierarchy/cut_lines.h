/* cut_lines.h - contacts of a face on one line, taken together.
 * SPDX-License-Identifier: MIT */
#ifndef CUT_LINES_H
#define CUT_LINES_H

#include "hierarchy/cut_contacts.h"

struct cut_line {
    double direction[3], across[3]; /* unit vectors in the face's plane */
    double offset;                  /* of the line along `across`, from the frame's centre (m) */
    size_t first, count;            /* its contacts, disjoint and in order */
};

struct line_list {
    struct cut_line *lines; /* [count] */
    size_t count, capacity;
};

/* Make `lines` hold the lines of the contacts, which are sorted and joined. Returns 0, or -1
 * when out of memory. */
int lines_of_contacts(struct line_list *lines, const struct cut_frame *frame,
                      struct contact_list *contacts);

#endif
