/* blockers.h - term: how many faces may stand between the two elements, 0 to 8, or 9: too many to
 * be worth a list.
 *
 * The faces themselves are kept in d->blockers, in ascending order. A list is made by the host,
 * from all faces, or filtered from that of a pair which holds this one: a shaft within a shaft
 * meets no other face. Both ways give the same list (shaft.h says why), and it is the same for a
 * pair either way round. [Haines & Wallace 1994] Lists of bent quads are not for the pairs below
 * them (`handed`), whose planes are others.
 * Fails (too many): clusters; a host without candidates; more than 8 faces.
 * SPDX-License-Identifier: MIT */
#ifndef TERM_BLOCKERS_H
#define TERM_BLOCKERS_H

#include "discussion.h"
#include "kernel/shaft.h"

/* Does a face of an inherited list meet the shaft? Most are known to without its planes, which are
 * made for the first that is not. */
static inline int blockers_meets(struct shaft *shaft, const struct polygon *p)
{
    const double(*v)[3] = (const double(*)[3])p->v;
    struct cut inside;
    int meets = shaft_meets_early(shaft, v, p->n);
    if (meets >= 0)
        return meets;
    if (shaft->planes == 0)
        shaft_close(shaft);
    return shaft_meets(shaft, v, p->n, &inside); /* does not ask again whether it is pierced */
}

OUTLINE void blockers_find(const struct element *r, const struct element *s,
                           const struct host *host, struct blockers *list)
{
    if (list->known == BLOCKERS_OWN)
        return;
    int found = list->known == BLOCKERS_INHERITED ? list->count : -1;
    list->known = BLOCKERS_OWN;
    list->covered = list->handed = 0;
    list->count = BLOCKERS_TOO_MANY;
    if (!r->vertices || !s->vertices || !host->candidates || !host->corners)
        return;
    list->count = 0;
    struct shaft shaft;
    if (!shaft_ends(&shaft, r, s, host)) {
        list->covered = 1;
        return;
    }
    const int known = found < 0 && host->exact; /* that they meet the shaft */
    if (found < 0) {
        shaft_close(&shaft);
        found = host->candidates(host, &shaft, BLOCKERS_MAX, list->face);
    }
    if (found == HOST_HIDDEN) {
        list->covered = 1;
        return;
    }
    if (found > BLOCKERS_MAX) {
        list->count = BLOCKERS_TOO_MANY;
        return;
    }
    list->handed = shaft_nests(&shaft, r) && shaft_nests(&shaft, s);
    int j;
    for (int i = 0; i < found; i++) {
        uint32_t face = list->face[i];
        struct polygon p;
        host->corners(host, face, &p);
        if (!known && !blockers_meets(&shaft, &p))
            continue;
        list->covered |= (unsigned char)shaft_covered(&shaft, (const double(*)[3])p.v, p.n);
        for (j = list->count++; j > 0 && list->face[j - 1] > face; j--)
            list->face[j] = list->face[j - 1];
        list->face[j] = face;
    }
}

/* The list; `own` is where it goes when the discussion keeps none. */
TOOL const struct blockers *blockers_list(struct discussion *d, struct blockers *own)
{
    struct blockers *list = d->blockers ? d->blockers : own;
    if (list == own)
        own->known = BLOCKERS_UNKNOWN;
    blockers_find(d->receiver, d->emitter, d->host, list);
    d->terms.blockers = list->count;
    d->terms.blockers_level = BLOCKERS_PRESENT;
    return list;
}

TOOL int term_blockers(struct discussion *d)
{
    if (d->terms.blockers_level < BLOCKERS_PRESENT) {
        struct blockers own;
        (void)blockers_list(d, &own);
    }
    return d->terms.blockers;
}

#endif
