/* hidden.h - is all light in a shaft stopped by faces that share edges?
 * SPDX-License-Identifier: MIT */
#ifndef HIDDEN_H
#define HIDDEN_H

#include "hierarchy/mates.h"

/* What is known of the faces of a shaft told of so far. */
struct hidden {
    const struct hierarchy *h;
    const struct mates *mates;
    const struct shaft *shaft;
    double ray[2][3]; /* between the ends */
    int met, open;    /* the ray meets a face; one of them has an outline in the shaft */
};

void hidden_start(struct hidden *hidden, const struct hierarchy *h, const struct mates *mates,
                  const struct shaft *shaft);
/* Of a face, or a group that stands as one, that meets the shaft. Of none when it is `open`. */
void hidden_add(struct hidden *hidden, uint32_t index);

/* Of all that meet the shaft: 1 when it is proved that they stop every ray between the ends. */
static inline int hidden_all(const struct hidden *hidden)
{
    return hidden->met && !hidden->open;
}

/* Which end is in front of a face whose plane parts the two: 1, the first; -1, the second; 0: it
 * does not part them, or is bent. */
int hidden_front(const struct shaft *shaft, const struct element *e);
/* Is a corner of the face farther than `flat` (m) off its plane? Then it has several. */
int hidden_bent(const struct element *e, double flat);
/* May the edge from a to b meet the shaft? */
int hidden_edge(const struct shaft *shaft, const double a[3], const double b[3]);
/* A ray between the ends, from middle to middle. */
void hidden_middle(const struct shaft *shaft, double ray[2][3]);

/* Twice the volume over the edge from a to b, as the ray from `eye` along w runs by it; exactly the
 * other sign of the edge from b to a, so that no ray passes between neighbours. */
static inline double hidden_side(const double eye[3], const double w[3], const double a[3],
                                 const double b[3])
{
    double p[3], q[3], c[3];
    sub3(p, a, eye);
    sub3(q, b, eye);
    cross3(c, p, q);
    return dot3(c, w);
}

/* Does the line from `eye` along w pass through a convex polygon, its rim included? */
static inline int hidden_through(const double eye[3], const double w[3], const double (*v)[3],
                                 int n)
{
    int left = 0, right = 0;
    for (int i = 0; i < n && !(left && right); i++) {
        double side = hidden_side(eye, w, v[i], v[i + 1 < n ? i + 1 : 0]);
        left |= side > 0;
        right |= side < 0;
    }
    return !(left && right);
}

#endif
