/* main.c - a Poisson solve on a mesh that a decision graph refines: -(u_xx + u_yy) = f in the unit
 * square, u a narrow peak, 0 on the boundary (the peak has e^-180 there).
 *
 * Cells are finite volumes; what flows through a side is the difference of means over the distance
 * of centres. Before each solve every cell is shown to the graph. At last the mean error is held
 * against that of an even mesh with at least as many cells, and the mesh is drawn.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "node_counts.h"
#include "refine.h"

enum { SWEEPS = 400, ROUNDS = 12 };
static const double width = 0.0005; /* of the peak, squared (m2) */

/* The peak, or the source whose answer it is. */
static double peak(double x, double y, int source)
{
    double r = ((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6)) / width;
    return source ? 4 / width * (1 - r) * exp(-r) : exp(-r);
}

int mesh_neighbour(const struct refine_mesh *mesh, int cell, int side, int half)
{
    const struct refine_cell *c = &mesh->cells[cell];
    double out = side % 2 ? 0.501 : -0.501, along = half ? 0.25 : -0.25;
    double x = c->x + c->size * (side < 2 ? out : along);
    double y = c->y + c->size * (side < 2 ? along : out);
    int inside = x > 0 && x < 1 && y > 0 && y < 1;
    return inside ? mesh->at[(int)(y * REFINE_GRID)][(int)(x * REFINE_GRID)] : -1;
}

double mesh_across(const struct refine_mesh *mesh, int cell, int side, double *distance)
{
    double u = 0, size = mesh->cells[cell].size;
    *distance = size / 2;
    for (int half = 0; half < 2; half++) {
        int n = mesh_neighbour(mesh, cell, side, half);
        u += n < 0 ? 0 : mesh->cells[n].u / 2;
        *distance += n < 0 ? 0 : mesh->cells[n].size / 4;
    }
    return u;
}

static void add(struct refine_mesh *mesh, double x, double y, double size, double u)
{
    const struct refine_cell cell = {x, y, size, u};
    int column = (int)((x - size / 2) * REFINE_GRID), row = (int)((y - size / 2) * REFINE_GRID);
    int side = (int)(size * REFINE_GRID); /* in squares of the grid */
    for (int k = 0; k < side * side; k++)
        mesh->at[row + k / side][column + k % side] = mesh->count;
    mesh->cells[mesh->count++] = cell;
}

/* Shows every cell to the graph; the next mesh has it, or its quarters. */
static void refine(const struct refine_mesh *mesh, const struct refine_parameters *parameters,
                   struct refine_counters *counters, struct refine_mesh *next)
{
    struct refine_discussion d;
    next->count = 0;
    for (int i = 0; i < mesh->count; i++) {
        const struct refine_cell *c = &mesh->cells[i];
        memset(&d, 0, sizeof d);
        d.mesh = mesh;
        d.cell = i;
        int parts =
            refine_decide_counted(parameters, &d, counters) == REFINE_DECISION_SPLIT ? 2 : 1;
        double size = c->size / parts, first = (size - c->size) / 2;
        for (int k = 0; k < parts * parts; k++)
            add(next, c->x + first + k % parts * size, c->y + first + k / parts * size, size, c->u);
    }
}

/* Successive over-relaxation; the source is taken at Gauss's four points. Returns the mean of
 * |u - peak| at centres (K). */
static double solve(struct refine_mesh *mesh)
{
    static const double gauss[] = {-0.28867513459481287, 0.28867513459481287};
    double error = 0;
    for (int i = 0; i < SWEEPS * mesh->count; i++) {
        struct refine_cell *c = &mesh->cells[i % mesh->count];
        double sum = 0, all = 0, distance;
        for (int k = 0; k < 4; k++) {
            double x = c->x + c->size * gauss[k % 2], y = c->y + c->size * gauss[k / 2];
            sum += peak(x, y, 1) * c->size / 4;
            sum += mesh_across(mesh, i % mesh->count, k, &distance) / distance;
            all += 1 / distance;
        }
        c->u += 1.8 * (sum / all - c->u);
    }
    for (int i = 0; i < mesh->count; i++) {
        const struct refine_cell *c = &mesh->cells[i];
        error += c->size * c->size * fabs(c->u - peak(c->x, c->y, 0));
    }
    return error;
}

static int draw(const struct refine_mesh *mesh, const char *path)
{
    FILE *out = fopen(path, "w");
    if (out == NULL)
        return -1;
    fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\" width=\"512\" "
                 "height=\"512\" stroke=\"#888\" stroke-width=\".0006\">\n");
    for (int i = 0; i < mesh->count; i++) {
        const struct refine_cell *c = &mesh->cells[i];
        int warm = (int)(255 * fmin(1, fmax(0, c->u)));
        fprintf(out, "<path d=\"M%g %gh%gv%gh-%gz\" fill=\"#%02x%02xff\"/>\n", c->x - c->size / 2,
                1 - c->y - c->size / 2, c->size, c->size, c->size, 255 - warm, 255 - warm / 2);
    }
    fprintf(out, "</svg>\n");
    return fclose(out);
}

int main(int count, char **arguments)
{
    static struct refine_mesh adapted[2], even;
    static struct refine_counters counters;
    struct refine_parameters parameters;
    double error = 0, even_error;
    int n = 1;
    refine_defaults(&parameters);
    counters.clock = node_counts_seconds;
    add(&adapted[0], 0.5, 0.5, 1, 0);
    for (int round = 0; round < ROUNDS; round++) {
        refine(&adapted[round % 2], &parameters, &counters, &adapted[(round + 1) % 2]);
        error = solve(&adapted[(round + 1) % 2]);
    }
    const struct refine_mesh *last = &adapted[ROUNDS % 2];
    while (n * n < last->count)
        n *= 2;
    for (int i = 0; i < n * n; i++)
        add(&even, (i % n + 0.5) / n, (i / n + 0.5) / n, 1.0 / n, 0);
    even_error = solve(&even);
    printf("adapted: %d cells, mean error %.2g K\neven:    %d cells, mean error %.2g K\n",
           last->count, error, even.count, even_error);
    node_counts_print(stdout, NODE_COUNTS(refine, &counters));
    return draw(last, count > 1 ? arguments[1] : "mesh.svg") == 0 && 4 * error < even_error ? 0 : 1;
}
