/* body_contacts.h - faces that lie on each other, where one of them is of no convex solid.
 * SPDX-License-Identifier: MIT */
#ifndef BODY_CONTACTS_H
#define BODY_CONTACTS_H

#include "hierarchy/bodies.h"

/* Two faces, elements, that look the other way, on so much of each other (m2). */
struct body_contact {
    uint32_t face[2];
    double area, middle[3]; /* a point in both */
    int solid;              /* the caller's: 1: what is behind one of them is solid */
};

struct body_contacts {
    struct body_contact *list; /* [count] */
    size_t count, room;
};

/* Returns 0, or -1 when out of memory; the list is to be freed then too. */
int body_contacts_find(struct body_contacts *contacts, const struct bodies *bodies,
                       const struct hierarchy *h);

#endif
