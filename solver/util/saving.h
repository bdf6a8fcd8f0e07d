/* saving.h - how often long work is saved.
 * SPDX-License-Identifier: MIT */
#ifndef SAVING_H
#define SAVING_H

/* Is it time to save long work, so many seconds after the last save, which took `took`? After 10 s,
 * and so that saving takes no more than a twentieth of the time. */
static inline int save_is_due(double since, double took)
{
    return since > 10 && since > 20 * took;
}

#endif
