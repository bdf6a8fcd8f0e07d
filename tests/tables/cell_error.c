/* cell_error.c - how far a solution is from the truth, point by point and face by face.
 *
 *     cell_error cut SCENE OUT [SHARE]             OUT.obj, OUT.mtl: the scene cut into cells
 *     cell_error faces SCENE REF.csv [SHARE]        REF.csv summed up: a reference of the faces
 *     cell_error compare SCENE REF.csv FACES.csv MESH.ply|CELLS.csv [SHARE]
 *
 * A cell has about SHARE (1e-4) of the scene's area. REF.csv: what `radiosity reference` says of
 * OUT.obj, from which a face's light is summed up, too; FACES.csv and MESH.ply: what `radiosity
 * solve` says of SCENE, by `--faces` and `-o`; CELLS.csv, instead of a mesh: a table of faces of
 * OUT.obj, of a method that knows cells alone. The last prints names and values, line by line,
 * errors as shares of the reflected light:
 *
 *     faces, cells, area (m2), reflected (W)
 *     l1_faces, power, l1_cells    sum of moduli over faces; with signs; of moduli over cells
 *     l2_faces, l2_cells    root mean squares by area, over that of what is reflected
 *     noise_faces, noise_power, noise_cells, noise_l2_faces, noise_l2_cells    what the reference's
 *         own noise makes of them, about
 *     worst, worst_face, worst_noise, worst_light    of faces above a hundredth of the area the one
 *         that is off most, as a share of what it reflects itself; which; the reference's noise
 *         there; its share of all reflected light
 *     missed    share of the area that no leaf was found on, which no error is known of
 *
 * The error of a cell is that of its mean light; a solution has it from POINTS^2 points, or, of a
 * face that is one cell, from FACES.csv: light may fall off along a lamp that touches it within
 * less than points are apart. A two-sided face's is the mean over both sides, as tables have it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "geometry.h"
#include "output/faces_table.h"
#include "tables/cells.h"
#include "tables/leaves.h"
#include "util/ends_with.h"
#include "util/report.h"

enum { POINTS = 16 };             /* leaves may be a hundredth of a cell */
static const double LARGE = 0.01; /* of the scene's area: faces that `worst` is sought among */

struct sums {
    double light, signed_error, faces, variance, noise_faces; /* of faces: W; variance W^2 */
    double worst, worst_noise, worst_light;                   /* shares of its light; W */
    double light_known, cells, noise_cells, missed;           /* of cells: W; missed m2 */
    struct squares {
        double error, variance, light; /* W^2/m2: integrals of squares of W/m2 over area */
    } square_faces, square_cells;
    uint32_t worst_face;
};

/* What a polygon reflects, by its cells, and the variance of that: W, W^2, per band. */
struct total {
    double power[3], variance[3], area;
};

/* A point of a cell, u and v in [0, 1]. Returns how much of the cell it stands for, beside others
 * of the same steps in u and v: a quad need not be as wide at both ends. */
static double point_in(double p[3], const struct cell *c, double u, double v)
{
    double du[3], dv[3], area[3];
    for (int k = 0; k < 3; k++) {
        double low = (1 - u) * c->corner[0][k] + u * c->corner[1][k],
               high = (1 - u) * c->corner[3][k] + u * c->corner[2][k];
        if (c->corners == 4) {
            p[k] = (1 - v) * low + v * high;
            du[k] = (1 - v) * (c->corner[1][k] - c->corner[0][k])
                    + v * (c->corner[2][k] - c->corner[3][k]);
            dv[k] = high - low;
        } else /* by area: sqrt keeps what u and v spread evenly */
            p[k] = (1 - sqrt(u)) * c->corner[0][k]
                   + sqrt(u) * ((1 - v) * c->corner[1][k] + v * c->corner[2][k]);
    }
    if (c->corners != 4)
        return 1;
    cross3(area, du, dv);
    return length3(area);
}

/* Mean B over a cell of the solution. Returns 0, or -1: no leaf is there. */
static int cell_value(const struct leaves *m, const struct cell *c, int two_sided, double *value)
{
    double a[3], b[3], n[2][3], got[3], found = 0;
    sub3(a, c->corner[1], c->corner[0]);
    sub3(b, c->corner[2], c->corner[0]);
    cross3(n[0], a, b);
    double l = length3(n[0]);
    for (int k = 0; k < 3; k++) {
        n[0][k] /= l;
        n[1][k] = -n[0][k];
    }
    memset(value, 0, m->bands * sizeof *value);
    for (int i = 0; i < POINTS * POINTS; i++)
        for (int side = 0; side <= two_sided; side++) {
            double p[3],
                weight = point_in(p, c, (i % POINTS + 0.5) / POINTS, (i / POINTS + 0.5) / POINTS);
            if (leaves_at(m, p, n[side], got) < 0)
                continue;
            found += weight;
            for (uint32_t k = 0; k < m->bands; k++)
                value[k] += weight * got[k];
        }
    for (uint32_t k = 0; k < m->bands && found > 0; k++)
        value[k] /= found;
    return found > 0 ? 0 : -1;
}

struct inputs {
    struct scene_file file;
    struct cells cells;
    struct faces_table reference, solution; /* of cells; of faces */
    struct leaves mesh;
    struct faces_table solution_cells; /* instead of the mesh; count 0: none */
    double area;                       /* m2 */
};

static int unfit(const char *path, const char *other)
{
    return report_error(path, 0, "does not fit %s; make both of the same scene", other);
}

/* ---- sums */

static void add_squares(struct squares *q, double area, double error, double variance, double light)
{
    q->error += area * error * error;
    q->variance += area * variance;
    q->light += area * light * light;
}

/* Is it all of its polygon? Cells of one stand together. */
static int is_whole(const struct cells *cells, uint32_t i)
{
    const struct cell *c = &cells->cell[i];
    return (i == 0 || c[-1].polygon != c->polygon)
           && (i + 1 == cells->count || c[1].polygon != c->polygon);
}

/* Returns whether there is a value. */
static int solution_at(const struct inputs *in, uint32_t i, double value[3])
{
    const struct cell *c = &in->cells.cell[i];
    uint32_t bands = in->reference.bands;
    if (in->solution_cells.count) {
        memcpy(value, in->solution_cells.radiosity + (size_t)i * bands, bands * sizeof *value);
        return 1;
    }
    int two_sided = in->file.materials[in->file.polygon_materials[c->polygon]].two_sided;
    if (!c->corners || cell_value(&in->mesh, c, two_sided, value) < 0)
        return 0;
    if (is_whole(&in->cells, i))
        memcpy(value, in->solution.radiosity + (size_t)c->polygon * bands, bands * sizeof *value);
    return 1;
}

static void add_cells(const struct inputs *in, struct sums *s, struct total *totals)
{
    uint32_t bands = in->reference.bands;
    for (uint32_t i = 0; i < in->cells.count; i++) {
        const struct cell *c = &in->cells.cell[i];
        struct total *t = &totals[c->polygon];
        double area = in->reference.area[i], value[3], off = 0, light = 0;
        int known = area > 0 && solution_at(in, i, value);
        t->area += area;
        for (uint32_t k = 0; k < bands && area > 0; k++) {
            size_t at = (size_t)i * bands + k;
            double b = in->reference.radiosity[at], deviation = area * in->reference.deviation[at],
                   power = area * (b - in->solution.exitance[(size_t)c->polygon * bands + k]);
            t->power[k] += power;
            t->variance[k] += deviation * deviation;
            light += power;
            off += area * (known ? fabs(value[k] - b) : 0);
            if (known)
                add_squares(&s->square_cells, area, value[k] - b,
                            deviation * deviation / (area * area), power / area);
            s->noise_cells += deviation * sqrt(2 / M_PI);
        }
        s->light_known += known ? light : 0;
        s->cells += off;
        s->missed += known ? 0 : area;
    }
}

static void add_faces(const struct inputs *in, struct sums *s, const struct total *totals)
{
    uint32_t bands = in->reference.bands;
    s->worst_face = in->solution.count;
    for (uint32_t i = 0; i < in->solution.count; i++) {
        const struct total *t = &totals[i];
        double off = 0, light = 0, noise = 0;
        for (uint32_t k = 0; k < bands; k++) {
            size_t at = (size_t)i * bands + k;
            double error =
                t->area * (in->solution.radiosity[at] - in->solution.exitance[at]) - t->power[k];
            s->signed_error += error;
            s->variance += t->variance[k];
            off += fabs(error);
            light += t->power[k];
            noise += sqrt(t->variance[k] * 2 / M_PI);
            if (t->area > 0)
                add_squares(&s->square_faces, t->area, error / t->area,
                            t->variance[k] / (t->area * t->area), t->power[k] / t->area);
        }
        s->light += light;
        s->faces += off;
        s->noise_faces += noise;
        if (t->area > LARGE * in->area && light > 0 && off / light > s->worst) {
            s->worst = off / light;
            s->worst_noise = noise / light;
            s->worst_light = light;
            s->worst_face = i;
        }
    }
}

static int compare(const struct inputs *in)
{
    struct sums s = {0};
    struct total *totals = calloc((size_t)in->solution.count + 1, sizeof *totals);
    if (!totals)
        return report_error("cell_error", 0, "out of memory");
    add_cells(in, &s, totals);
    add_faces(in, &s, totals);
    free(totals);
    printf("faces %u\ncells %u\narea %.9g\nreflected %.9g\n", (unsigned)in->solution.count,
           (unsigned)in->cells.count, in->area, s.light);
    printf("l1_faces %.6g\npower %.6g\nl1_cells %.6g\n", s.faces / s.light,
           s.signed_error / s.light, s.cells / s.light_known);
    printf("noise_faces %.6g\nnoise_power %.6g\nnoise_cells %.6g\n", s.noise_faces / s.light,
           sqrt(s.variance) / s.light, s.noise_cells / s.light);
    const struct squares *f = &s.square_faces, *c = &s.square_cells;
    printf("l2_faces %.6g\nl2_cells %.6g\nnoise_l2_faces %.6g\nnoise_l2_cells %.6g\n",
           sqrt(f->error / f->light), sqrt(c->error / c->light), sqrt(f->variance / f->light),
           sqrt(c->variance / c->light));
    printf("worst %.6g\nworst_face %u\nworst_noise %.6g\nworst_light %.6g\nmissed %.6g\n", s.worst,
           (unsigned)s.worst_face, s.worst_noise, s.worst_light / s.light, s.missed / in->area);
    return 0;
}

/* ---- the command */

/* A table of faces as `radiosity reference` writes it. */
static int print_faces(const struct inputs *in)
{
    const struct faces_table *r = &in->reference;
    struct total *totals = calloc((size_t)in->file.polygon_count + 1, sizeof *totals);
    if (!totals)
        return report_error("cell_error", 0, "out of memory");
    for (uint32_t i = 0; i < r->count; i++) {
        struct total *t = &totals[in->cells.cell[i].polygon];
        t->area += r->area[i];
        for (uint32_t k = 0; k < r->bands; k++) {
            double deviation = r->area[i] * r->deviation[(size_t)i * r->bands + k];
            t->power[k] += r->area[i] * r->radiosity[(size_t)i * r->bands + k];
            t->variance[k] += deviation * deviation;
        }
    }
    printf("face,area");
    for (uint32_t k = 0; k < 2 * r->bands; k++)
        printf(",%s_%u", k < r->bands ? "B" : "se", (unsigned)(k % r->bands));
    for (uint32_t i = 0; i < in->file.polygon_count; i++) {
        double area = totals[i].area;
        printf("\n%u,%.9g", (unsigned)i, area);
        for (uint32_t k = 0; k < r->bands; k++)
            printf(",%.9g", area > 0 ? totals[i].power[k] / area : 0);
        for (uint32_t k = 0; k < r->bands; k++)
            printf(",%.3g", area > 0 ? sqrt(totals[i].variance[k]) / area : 0);
    }
    putchar('\n');
    free(totals);
    return 0;
}

static int read_reference(struct inputs *in, const char *scene, const char *path)
{
    if (faces_table_read(&in->reference, path, in->cells.count) < 0)
        return -1;
    return in->reference.count == in->cells.count && in->reference.deviation ? 0
                                                                             : unfit(path, scene);
}

static int read_solution(struct inputs *in, const char *scene, const char *faces, const char *mesh)
{
    uint32_t bands = in->reference.bands;
    int cells = ends_with(mesh, ".csv");
    if (faces_table_read(&in->solution, faces, in->file.polygon_count) < 0
        || (cells ? faces_table_read(&in->solution_cells, mesh, in->cells.count)
                  : leaves_read(&in->mesh, mesh))
               < 0)
        return -1;
    if (in->solution.count != in->file.polygon_count || !in->solution.exitance
        || in->solution.bands != bands)
        return unfit(faces, scene);
    if (cells && in->solution_cells.count != in->cells.count)
        return unfit(mesh, scene);
    return (cells ? in->solution_cells.bands : in->mesh.bands) == bands ? 0 : unfit(mesh, scene);
}

enum verb { CUT, FACES, COMPARE, VERBS };
static const struct {
    const char *name;
    int words; /* before SHARE */
} verbs[VERBS] = {{"cut", 4}, {"faces", 4}, {"compare", 6}};

static int run(struct inputs *in, enum verb verb, char **word)
{
    if (verb == CUT)
        return cells_write(&in->cells, &in->file, word[3]);
    if (read_reference(in, word[2], word[3]) < 0)
        return -1;
    if (verb == FACES)
        return print_faces(in);
    return read_solution(in, word[2], word[4], word[5]) < 0 ? -1 : compare(in);
}

int main(int count, char **word)
{
    int verb = 0;
    while (verb < VERBS && (count < 2 || strcmp(word[1], verbs[verb].name) != 0))
        verb++;
    int words = verb < VERBS ? verbs[verb].words : 0;
    double share = count > words ? atof(word[words]) : 1e-4;
    if (verb == VERBS || count < words || count > words + 1 || !(share > 0)) {
        fputs("usage: cell_error cut SCENE OUT [SHARE]\n"
              "       cell_error faces SCENE REF.csv [SHARE]\n"
              "       cell_error compare SCENE REF.csv FACES.csv MESH.ply|CELLS.csv [SHARE]\n",
              stderr);
        return 2;
    }
    const struct scene_options how = {.quiet = 1};
    struct inputs in = {0};
    if (scene_file_read(&in.file, word[2], &how) < 0)
        return 1;
    int failed = cells_cut(&in.cells, &in.file, share, &in.area) < 0
                     ? report_error(word[2], 0, "out of memory for its cells")
                     : run(&in, (enum verb)verb, word);
    faces_table_free(&in.reference);
    faces_table_free(&in.solution);
    faces_table_free(&in.solution_cells);
    leaves_free(&in.mesh);
    cells_free(&in.cells);
    scene_file_free(&in.file);
    return failed < 0;
}
