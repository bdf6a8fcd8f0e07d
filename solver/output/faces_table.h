/* faces_table.h - a table of faces read again: of `solve --faces`, or of `reference`.
 * SPDX-License-Identifier: MIT */
#ifndef FACES_TABLE_H
#define FACES_TABLE_H

#include <stdint.h>

/* Row i is line i + 2 of the file. */
struct faces_table {
    uint32_t count, bands;
    uint32_t *face;        /* [count], rising: of the scene file */
    double *area;          /* [count], m2, of both sides where a column `sides` says 2 */
    double *radiosity;     /* [count * bands]: B, W/m2 */
    double *exitance;      /* [count * bands]: E, W/m2; NULL: the table has none */
    double *deviation;     /* [count * bands]: of B, one standard error, W/m2; NULL: none */
    const char **material; /* [count]; NULL: none */
    char *text;            /* what names stand in */
};

/* Read a table with columns `face`, `area` and `B_0` (`B_1`, `B_2`); of others `material`, E_k and
 * se_k are taken up, the last only where no err_k says that they are of an error. It may have a
 * sample of the scene's faces, in order. `faces`: how many the scene has, 0: not known. Returns 0,
 * or -1 after a message that names file and line, with nothing to free. */
int faces_table_read(struct faces_table *t, const char *path, uint32_t faces);

void faces_table_free(struct faces_table *t);

#endif
