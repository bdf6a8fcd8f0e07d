/* factor_rays.c - a matrix of view factors against rays: `make factor-rays`, then
 *
 *     build/bin/factor_rays make N M DEGREES ROOM.obj                  writes the room of
 *     make_room.h, and room.mtl beside it build/bin/factor_rays check N M DEGREES MATRIX.coo RAYS
 *     FACE...  casts RAYS rays from each FACE and compares its row
 *
 * 1 as exit status says that a row differs by more than chance does once in 10^6 times.
 * SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>
#include "runtime/make_room.h"

static int make(const struct room *r, const char *path)
{
    const char *slash = strrchr(path, '/');
    FILE *out = fopen(path, "w");
    if (!out)
        return perror(path), 1;
    room_write(r, -1, out);
    if (fclose(out) != 0)
        return perror(path), 1;
    char library[4096];
    snprintf(library, sizeof library, "%.*sroom.mtl", slash ? (int)(slash - path) + 1 : 0, path);
    out = fopen(library, "w");
    if (!out)
        return perror(library), 1;
    fputs("newmtl wall\nKd .5 .5 .5\nnewmtl box\nKd .5 .5 .5\n", out);
    return fclose(out) != 0;
}

/* Row `face` of a coo file. */
static int read_row(const char *path, int face, int faces, double *f)
{
    FILE *in = fopen(path, "r");
    if (!in)
        return perror(path), -1;
    memset(f, 0, (size_t)faces * sizeof *f);
    char line[128];
    while (fgets(line, sizeof line, in)) {
        char *end;
        long i = strtol(line, &end, 10), j = *end ? strtol(end + 1, &end, 10) : -1;
        if (i < face)
            continue;
        if (i > face)
            break;
        if (j >= 0 && j < faces && *end)
            f[j] = strtod(end + 1, NULL);
    }
    return fclose(in);
}

int main(int count, char **argument)
{
    int status = 0;
    if (count < 6
        || (strcmp(argument[1], "make") != 0 && (strcmp(argument[1], "check") != 0 || count < 8))) {
        fputs("usage: factor_rays make N M DEGREES ROOM.obj\n       factor_rays check N M DEGREES "
              "MATRIX.coo RAYS FACE...\n",
              stderr);
        return 2;
    }
    struct room room;
    room_make(&room, atoi(argument[2]), atoi(argument[3]), strtod(argument[4], NULL));
    if (strcmp(argument[1], "make") == 0)
        return make(&room, argument[5]);
    double *f;
    f = malloc((size_t)room.faces * sizeof *f);
    long *hits;
    hits = malloc((size_t)room.faces * sizeof *hits);
    long rays = (long)strtod(argument[6], NULL);
    if (!f || !hits)
        return 1;
    printf("%ld rays; chance beside errors of %g F + %g. rms: of F, net of chance\n", rays,
           ROOM_RELATIVE, ROOM_ABSOLUTE);
    printf(
        "face     row sum      chi-square, deviations   one entry   largest |F - F_rays|   rms\n");
    for (int i = 7; i < count; i++) {
        int face = atoi(argument[i]);
        double sum = 0, most = 0, net = 0;
        if (face < 0 || face >= room.faces || read_row(argument[5], face, room.faces, f) < 0)
            return 1;
        memset(hits, 0, (size_t)room.faces * sizeof *hits);
        (void)room_rays(&room, face, rays, (uint64_t)face + 1, hits);
        double worst;
        double chi = room_chi(&room, f, hits, rays, &worst);
        for (int j = 0; j < room.faces; j++) {
            double g = (double)hits[j] / (double)rays;
            sum += f[j];
            most = fmax(most, fabs(f[j] - g));
            net += (f[j] - g) * (f[j] - g) - f[j] / (double)rays;
        }
        printf("%-8d %.9f  %+6.2f                   %5.2f       %.2e               %.1e\n", face,
               sum, chi, worst, most, sqrt(fmax(net, 0) / room.faces));
        status |= chi > 4.75;
    }
    free(f);
    free(hits);
    return status;
}
