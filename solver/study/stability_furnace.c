/* stability_furnace.c - cases of white furnaces: where every place emits and reflects alike, B = E
 * / (1 - rho) everywhere, whatever the form of the room.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "study/stability.h"

static void make_cube(struct made_scene *s, double rho)
{
    const uint32_t white[6] = {0, 0, 0, 0, 0, 0};
    made_material(s, rho, 1);
    made_room(s, white, 1, 1, 1);
}

static void make_box(struct made_scene *s, double rho)
{
    const uint32_t white[6] = {0, 0, 0, 0, 0, 0};
    made_material(s, rho, 1);
    made_room(s, white, 2, 1, 1);
}

/* An L of unit width with legs of 2, height 1: its floor and ceiling are three squares each. */
static void make_L(struct made_scene *s, double rho)
{
    static const double at[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    static const double wall[8][4] = {{0, 0, 1, 0}, {1, 0, 1, 0},  {2, 0, 0, 1},  {2, 1, -1, 0},
                                      {1, 1, 0, 1}, {1, 2, -1, 0}, {0, 2, 0, -1}, {0, 1, 0, -1}};
    made_material(s, rho, 1);
    for (int i = 0; i < 3; i++) {
        made_quad(s, 0, at[i][0], at[i][1], 0, 1, 0, 0, 0, 1, 0);
        made_quad(s, 0, at[i][0], at[i][1], 1, 0, 1, 0, 1, 0, 0);
    }
    for (int i = 0; i < 8; i++) /* counter-clockwise round the room, fronts inward */
        made_quad(s, 0, wall[i][0], wall[i][1], 0, 0, 0, 1, wall[i][2], wall[i][3], 0);
}

/* The largest |B (1 - rho) / E - 1| over the leaves of a furnace with E = 1. */
static double furnace_error(const struct solved *s, double rho)
{
    double worst = 0;
    for (uint32_t i = 0; i < s->elements.count; i++)
        if (s->elements.elements[i].vertices)
            worst = fmax(worst, fabs(s->elements.radiosity[i] * (1 - rho) - 1));
    return worst;
}

static int furnace(struct stability_trial *trial, void (*make)(struct made_scene *s, double rho),
                   double rho)
{
    const struct stability_scene room = {make, furnace_error};
    if (trial->method->kind == BY_ORACLE)
        return stability_measured(trial, &room, rho, &trial->error);
    double f[2];
    /* By symmetry all six B of the cube are equal, B = 1 + rho sum B. */
    stability_cube_factors(trial, f);
    trial->error = fabs((1 - rho) / (1 - rho * (f[0] + 4 * f[1])) - 1);
    if (rho * (f[0] + 4 * f[1]) >= 1)
        trial->error = INFINITY; /* every reflection adds power: no iteration ends */
    return 0;
}

int stability_furnace_95(struct stability_trial *trial)
{
    return furnace(trial, make_cube, 0.95);
}

int stability_furnace_98(struct stability_trial *trial)
{
    return furnace(trial, make_cube, 0.98);
}

int stability_furnace_99(struct stability_trial *trial)
{
    return furnace(trial, make_cube, 0.99);
}

int stability_furnace_box(struct stability_trial *trial)
{
    return furnace(trial, make_box, 0.99);
}

int stability_furnace_L(struct stability_trial *trial)
{
    return furnace(trial, make_L, 0.99);
}

/* A furnace cube solved with other sweeps than the default. Returns 0 or -1. */
static int sweep_furnace(struct stability_trial *trial, double rho,
                         const struct RadSolveOptions *options, double *error, int *sweeps)
{
    static const char *const six_elements[] = {"relative=1",
                                               NULL}; /* they are as good as many here */
    const struct stability_how how = {"bf", six_elements, trial->threads, *options, 0};
    struct made_scene cube = {.count = 0};
    make_cube(&cube, rho);
    struct solved s;
    if (stability_solve_so(&s, &cube, &how) < 0)
        return -1;
    *error = furnace_error(&s, rho);
    *sweeps = s.report.iterations;
    solved_close(&s);
    return 0;
}

/* What a rule about sweeps makes of rho = .999. */
int stability_near_white(struct stability_trial *trial)
{
    const double rho = 0.999, tolerance = 1e-3;
    struct RadSolveOptions how = {.tolerance = tolerance};
    if (trial->method == &stability_methods[JACOBI]) {
        how.solver = RAD_SOLVER_JACOBI;
        how.iterations = 100;
    } else if (trial->method == &stability_methods[NAIVE_STOP]) {
        how.solver = RAD_SOLVER_JACOBI;
        /* takes back what the solver allows for: stop where dB / B is 1e-3 */
        how.tolerance = tolerance * rho / (1 - rho);
    }
    int sweeps;
    if (sweep_furnace(trial, rho, &how, &trial->error, &sweeps) < 0)
        return -1;
    trial->count = sweeps;
    return 0;
}

/* Sweeps to 1e-3 for rho from .5 to .999, as a share of Jacobi's ln 1e-3 / ln rho. */
int stability_sweeps(struct stability_trial *trial)
{
    static const double rho[] = {0.5, 0.9, 0.99, 0.999};
    const struct RadSolveOptions how = {.tolerance = 1e-3,
                                        .solver = trial->method == &stability_methods[SWEEPS_JACOBI]
                                                      ? RAD_SOLVER_JACOBI
                                                      : RAD_SOLVER_GAUSS_SEIDEL};
    trial->error = 0;
    for (size_t i = 0; i < sizeof rho / sizeof *rho; i++) {
        double error;
        int sweeps;
        if (sweep_furnace(trial, rho[i], &how, &error, &sweeps) < 0)
            return -1;
        trial->error = fmax(trial->error, sweeps / ceil(log(1e-3) / log(rho[i])));
        trial->count = sweeps;
    }
    return 0;
}
