/* main.c - a Poisson solve on a mesh that a decision graph refines: -(u_xx + u_yy) = f in the unit
 * square, u a narrow peak, given on the boundary.
 *
 * Cells are finite volumes; what flows through half a side is the difference of the two cells'
 * means over the distance of their centres. After each solve every leaf is shown to the graph. At
 * last the mean error is held against that of an even mesh with at least as many cells, and the
 * mesh is drawn.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "refine.h"

enum { CELLS_MAX = 1 << 16, SWEEPS = 400, ROUNDS = 12 };
static const double width = 0.0005; /* of the peak, squared (m2) */

static double exact(double x, double y)
{
    return exp(-((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6)) / width);
}

static double source(double x, double y)
{
    double r = ((x - 0.3) * (x - 0.3) + (y - 0.6) * (y - 0.6)) / width;
    return 4 / width * (1 - r) * exp(-r);
}

static int leaf_at(const struct refine_mesh *mesh, double x, double y)
{
    int at = 0;
    if (!(x > 0 && x < 1 && y > 0 && y < 1))
        return -1;
    while (mesh->cells[at].child != 0) {
        const struct refine_cell *c = &mesh->cells[at];
        at = c->child + (x > c->x + c->size / 2) + 2 * (y > c->y + c->size / 2);
    }
    return at;
}

int mesh_neighbour(const struct refine_mesh *mesh, int cell, int side)
{
    const struct refine_cell *c = &mesh->cells[cell];
    double along = c->size * (side % 2 ? 0.75 : 0.25), out = c->size * 1e-6;
    double past = side / 2 % 2 ? c->size + out : -out;
    return side < 4 ? leaf_at(mesh, c->x + past, c->y + along)
                    : leaf_at(mesh, c->x + along, c->y + past);
}

/* u across half a side, on the line through the finer one's centre, and the distance of centres. */
static double half_across(const struct refine_mesh *mesh, int cell, int side, int n,
                          double *distance)
{
    const struct refine_cell *c = &mesh->cells[cell], *other = n < 0 ? c : &mesh->cells[n];
    *distance = n < 0 ? 0.5 * c->size : 0.5 * (c->size + other->size);
    if (n >= 0) {
        const struct refine_cell *larger = other->size > c->size ? other : c;
        double shift =
            0.5 * (c->size - other->size) + (side < 4 ? c->y - other->y : c->x - other->x);
        return other->u + shift * larger->slope[side < 4];
    }
    double along = c->size * (side % 2 ? 0.75 : 0.25), past = side / 2 % 2 ? c->size : 0;
    return side < 4 ? exact(c->x + past, c->y + along) : exact(c->x + along, c->y + past);
}

double mesh_across(const struct refine_mesh *mesh, int cell, int side, double *distance)
{
    double a, b, u = 0;
    u += 0.5 * half_across(mesh, cell, 2 * side, mesh_neighbour(mesh, cell, 2 * side), &a);
    u += 0.5 * half_across(mesh, cell, 2 * side + 1, mesh_neighbour(mesh, cell, 2 * side + 1), &b);
    *distance = 0.5 * (a + b);
    return u;
}

static void split(struct refine_mesh *mesh, int cell)
{
    struct refine_cell *c = &mesh->cells[cell];
    if (mesh->count + 4 > CELLS_MAX)
        return;
    c->child = mesh->count;
    for (int i = 0; i < 4; i++) {
        struct refine_cell part = *c;
        part.size = c->size / 2;
        part.x += i % 2 * part.size;
        part.y += i / 2 * part.size;
        part.depth++;
        part.child = 0;
        mesh->cells[mesh->count++] = part;
    }
}

/* Successive over-relaxation; slopes follow every few sweeps. */
static void solve(struct refine_mesh *mesh)
{
    int *next = (int *)malloc(sizeof(int) * REFINE_SIDES * (size_t)mesh->count);
    for (int i = 0; i < mesh->count * REFINE_SIDES; i++)
        next[i] = mesh_neighbour(mesh, i / REFINE_SIDES, i % REFINE_SIDES);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int i = 0; i < mesh->count; i++) {
            struct refine_cell *c = &mesh->cells[i];
            double sum = 0, all = 0, at[4] = {0, 0, 0, 0}, far[4] = {0, 0, 0, 0};
            for (int k = 0; c->child == 0 && k < REFINE_SIDES; k++) {
                double distance, u = half_across(mesh, i, k, next[i * REFINE_SIDES + k], &distance);
                sum += u * c->size / distance;
                all += c->size / distance;
                at[k / 2] += u / 2;
                far[k / 2] += distance / 2;
            }
            if (c->child != 0)
                continue;
            for (int k = 0; k < 4; k++) { /* Gauss's four points */
                double x = k % 2 ? 0.78867513459481288 : 0.21132486540518712;
                double y = k / 2 ? 0.78867513459481288 : 0.21132486540518712;
                sum += source(c->x + c->size * x, c->y + c->size * y) * c->size * c->size / 2;
            }
            c->u += 1.8 * (sum / all - c->u);
            for (int k = 0; sweep % 8 == 0 && k < 2; k++)
                c->slope[k] = (at[2 * k + 1] - at[2 * k]) / (far[2 * k] + far[2 * k + 1]);
        }
    free(next);
}

/* Shows every leaf to the graph, then splits; how many were split. */
static int refine(struct refine_mesh *mesh, const struct refine_parameters *parameters)
{
    int count = mesh->count, splits = 0, *chosen = (int *)malloc(sizeof(int) * (size_t)count);
    for (int i = 0; i < count; i++) {
        struct refine_discussion d;
        memset(&d, 0, sizeof d);
        d.mesh = mesh;
        d.cell = i;
        if (mesh->cells[i].child == 0 && refine_decide(parameters, &d) == REFINE_DECISION_SPLIT)
            chosen[splits++] = i;
    }
    for (int i = 0; i < splits; i++)
        split(mesh, chosen[i]);
    free(chosen);
    return splits;
}

/* The mean of |u - exact| over the square, and the number of leaves. */
static double error_of(const struct refine_mesh *mesh, int *leaves)
{
    double sum = 0;
    *leaves = 0;
    for (int i = 0; i < mesh->count; i++) {
        const struct refine_cell *c = &mesh->cells[i];
        if (c->child != 0)
            continue;
        sum += c->size * c->size * fabs(c->u - exact(c->x + c->size / 2, c->y + c->size / 2));
        ++*leaves;
    }
    return sum;
}

static struct refine_mesh square(void)
{
    struct refine_mesh mesh = {(struct refine_cell *)calloc(CELLS_MAX, sizeof(struct refine_cell)),
                               1};
    mesh.cells[0].size = 1;
    return mesh;
}

static void draw(const struct refine_mesh *mesh, const char *path)
{
    FILE *out = fopen(path, "w");
    if (out == NULL)
        return;
    fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1 1\" width=\"512\" "
                 "height=\"512\" stroke=\"#888\" stroke-width=\".0006\">\n");
    for (int i = 0; i < mesh->count; i++)
        if (mesh->cells[i].child == 0) {
            const struct refine_cell *c = &mesh->cells[i];
            int warm = (int)(255 * fmin(1, fmax(0, c->u)));
            fprintf(out, "<path d=\"M%g %gh%gv%gh-%gz\" fill=\"#%02x%02xff\"/>\n", c->x,
                    1 - c->y - c->size, c->size, c->size, c->size, 255 - warm, 255 - warm / 2);
        }
    fprintf(out, "</svg>\n");
    fclose(out);
}

int main(int count, char **arguments)
{
    struct refine_mesh adapted = square(), even = square();
    struct refine_parameters parameters;
    int leaves, even_leaves = 0, splits = 1;
    refine_defaults(&parameters);
    for (int round = 0; round < ROUNDS && splits > 0; round++) {
        splits = refine(&adapted, &parameters);
        solve(&adapted);
    }
    double error = error_of(&adapted, &leaves), even_error = 0;
    while (even_leaves < leaves) {
        for (int i = 0, n = even.count; i < n; i++)
            if (even.cells[i].child == 0)
                split(&even, i);
        solve(&even);
        even_error = error_of(&even, &even_leaves);
    }
    printf("adapted: %d cells, mean error %.2g K\neven:    %d cells, mean error %.2g K\n", leaves,
           error, even_leaves, even_error);
    draw(&adapted, count > 1 ? arguments[1] : "mesh.svg");
    free(adapted.cells);
    free(even.cells);
    return 4 * error < even_error ? 0 : 1;
}
