/* material_name.c - see material_name.h.
 * SPDX-License-Identifier: MIT */
#include "util/material_name.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *material_name_write(const char *name, const struct RadMaterial *m)
{
    static const char form[] = "%s {rho %.9g %.9g %.9g, E %.9g %.9g %.9g}";
    const double *r = m->reflectance, *e = m->exitance;
    int size = snprintf(NULL, 0, form, name, r[0], r[1], r[2], e[0], e[1], e[2]);
    char *text = malloc((size_t)size + 1);
    if (text)
        snprintf(text, (size_t)size + 1, form, name, r[0], r[1], r[2], e[0], e[1], e[2]);
    return text;
}

int material_name_read(char *name, struct RadMaterial *m)
{
    double v[6];
    int end = 0;
    char *brace = strrchr(name, '{');
    if (!brace || brace == name || brace[-1] != ' '
        || sscanf(brace, "{rho %lf %lf %lf, E %lf %lf %lf}%n", &v[0], &v[1], &v[2], &v[3], &v[4],
                  &v[5], &end)
               != 6
        || !end || brace[end])
        return 0;
    memcpy(m->reflectance, v, sizeof m->reflectance);
    memcpy(m->exitance, v + 3, sizeof m->exitance);
    brace[-1] = 0;
    return 1;
}
