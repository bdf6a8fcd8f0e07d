/* spread.c - see spread.h.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include "particles/running_sums.h"
#include "particles/spread.h"

int spread_around(struct spread *s, const double *place, const double *weight, uint32_t count,
                  int per_length)
{
    *s = (struct spread){0};
    if (count == 0)
        return 0;
    s->edge = malloc((count + 1) * sizeof *s->edge);
    s->sum = malloc((count + 1) * sizeof *s->sum);
    if (!s->edge || !s->sum) {
        spread_close(s);
        return -1;
    }
    /* Places that coincide share what they have: cells without length are left out. */
    double sum = 0, kept = 0;
    s->edge[0] = s->sum[0] = 0;
    for (uint32_t i = 0; i < count; i++) {
        double to = i + 1 < count ? 0.5 * (place[i] + place[i + 1]) : 1,
               length = to - s->edge[s->count], one = weight ? weight[i] : 1;
        kept += per_length ? one * length : one;
        if (!(length > 0))
            continue;
        sum += kept;
        kept = 0;
        s->edge[++s->count] = to;
        s->sum[s->count] = sum;
    }
    if (!(sum > 0)) {
        spread_close(s);
        return 0;
    }
    for (uint32_t i = 0; i <= s->count; i++)
        s->sum[i] /= sum;
    return 0;
}

void spread_close(struct spread *s)
{
    free(s->edge);
    free(s->sum);
    *s = (struct spread){0};
}

/* The cell of which `from` .. the next holds x. */
static uint32_t find_cell(const double *from, uint32_t count, double x)
{
    return running_sums_find(from + 1, count, x);
}

double spread_place(const struct spread *s, double v)
{
    if (s->count == 0)
        return v;
    uint32_t i = find_cell(s->sum, s->count, v);
    double share = s->sum[i + 1] - s->sum[i],
           u = s->edge[i]
               + (share > 0 ? (v - s->sum[i]) / share : 0.5) * (s->edge[i + 1] - s->edge[i]);
    return fmin(u, 1 - 0x1p-53);
}

double spread_density(const struct spread *s, double u)
{
    if (s->count == 0)
        return 1;
    uint32_t i = find_cell(s->edge, s->count, u);
    return (s->sum[i + 1] - s->sum[i]) / (s->edge[i + 1] - s->edge[i]);
}
