/* factor_names.h - the names of a matrix's rows, by themselves and as other programs take them.
 * SPDX-License-Identifier: MIT */
#ifndef FACTOR_NAMES_H
#define FACTOR_NAMES_H

#include "output/factor_table.h"

/* A name per line; to a file *.csv a table `row,name,area_m2` with names quoted where they must be.
 * Returns 0, or -1 after a message. */
int factor_names_write(const char *path, const struct factor_table *table);

/* Names as EnergyPlus takes them: without what ends a field there, and no two that differ in that
 * or in capitals alone. names[count], for factor_names_free. NULL after a message. */
char **factor_names_energyplus(const char *path, const struct factor_table *table);
char *factor_name_energyplus(const char *name); /* one; for free(), NULL when out of memory */
void factor_names_free(char **names, uint32_t count);

#endif
