/* cut_lines.c - see cut_lines.h.
 *
 * Contacts whose angles form a chain with no gap above CUT_SAME_LINE are parallel; of these, those
 * whose offsets do are on one line. It is where the longest of them is. Every order here is total
 * (ties go by face), so that it does not depend on the tree.
 * SPDX-License-Identifier: MIT */
#include "hierarchy/cut_lines.h"

#include <math.h>
#include <stdlib.h>

#include "geometry.h"
#include "kernel/constants.h"
#include "util/array.h"

static int compare(double a, double b)
{
    return (a > b) - (a < b);
}

static int by_face(const struct contact *x, const struct contact *y)
{
    return (x->face > y->face) - (x->face < y->face);
}

static int by_angle(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = compare(x->angle, y->angle);
    return o ? o : by_face(x, y);
}

static int by_offset(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = compare(x->offset, y->offset);
    return o ? o : by_face(x, y);
}

static int by_start(const void *a, const void *b)
{
    const struct contact *x = a, *y = b;
    int o = compare(x->from, y->from);
    return o ? o : by_face(x, y);
}

/* Contacts [first, end) lie on one line: that of the longest, of those as long the first face's. */
static int add_line(struct line_list *lines, const struct cut_frame *c, struct contact *x,
                    size_t first, size_t end)
{
    if (array_reserve(&lines->lines, lines->count + 1, &lines->capacity, sizeof *lines->lines) < 0)
        return -1;
    struct contact best = {.face = UINT32_MAX};
    double longest = 0;
    qsort(x + first, end - first, sizeof *x, by_start);
    for (size_t i = first; i < end; i++)
        longest = fmax(longest, x[i].to - x[i].from);
    for (size_t i = first; i < end; i++)
        if (x[i].to - x[i].from >= longest - c->touch && x[i].face < best.face)
            best = x[i];
    struct cut_line *l = &lines->lines[lines->count++];
    *l = (struct cut_line){.offset = best.offset, .first = first, .count = 1};
    for (int k = 0; k < 3; k++)
        l->direction[k] = cos(best.angle) * c->u[k] + sin(best.angle) * c->v[k];
    cross3(l->across, c->normal, l->direction);
    for (size_t i = first + 1; i < end; i++) {
        struct contact *last = &x[first + l->count - 1];
        if (x[i].from <= last->to)
            last->to = fmax(last->to, x[i].to);
        else
            x[first + l->count++] = x[i];
    }
    return 0;
}

int lines_of_contacts(struct line_list *lines, const struct cut_frame *frame,
                      struct contact_list *contacts)
{
    struct contact *x = contacts->contacts;
    size_t n = contacts->count;
    lines->count = 0;
    if (n)
        qsort(x, n, sizeof *x, by_angle);
    for (size_t i = 0, j; i < n; i = j) {
        for (j = i + 1; j < n && x[j].angle - x[j - 1].angle <= CUT_SAME_LINE; j++)
            continue;
        qsort(x + i, j - i, sizeof *x, by_offset);
        for (size_t a = i, b; a < j; a = b) {
            for (b = a + 1; b < j && x[b].offset - x[b - 1].offset <= CUT_SAME_LINE * frame->size;
                 b++)
                continue;
            if (add_line(lines, frame, x, a, b) < 0)
                return -1;
        }
    }
    return 0;
}
