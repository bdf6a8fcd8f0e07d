/* command_viewfactors.c - `radiosity viewfactors`: the matrix of face-to-face view factors.
 *
 * F_ij is the share of what leaves face i evenly that meets face j. The hierarchy is refined by the
 * oracle viewfactors with B = 1 on every face; the links from parts of i to parts of j, weighted with
 * the receiving part's area, sum to F_ij. Faces count as in the file: a face with two sides, or cut into
 * triangles, is one row, a mean over its parts.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "atomic_file.h"
#include "commands.h"
#include "json_file.h"
#include "progress.h"
#include "report.h"
#include "solve.h"

struct rows {
    double *row;   /* [inputs]: the row being summed */
    double *area;  /* [inputs]: all parts, both sides (m2) */
    uint32_t *first, *next; /* faces of input i: first[i], next[that] ...; UINT32_MAX ends */
    double low, high, defect; /* of the row sums: range, mean |1 - sum| */
};

static int rows_open(struct rows *r, const struct solve *s)
{
    uint32_t n = s->scene->input_count, faces = s->scene->face_count, f;
    memset(r, 0, sizeof *r);
    r->row = calloc(n, sizeof *r->row);
    r->area = calloc(n, sizeof *r->area);
    r->first = malloc(n * sizeof *r->first);
    r->next = malloc(faces * sizeof *r->next);
    if (!r->row || !r->area || !r->first || !r->next)
        return -1;
    memset(r->first, 0xff, n * sizeof *r->first);
    for (f = faces; f-- > 0;) {
        uint32_t i = s->scene->faces[f].input;
        r->next[f] = r->first[i];
        r->first[i] = f;
        r->area[i] += s->hierarchy.elements[s->hierarchy.face_element[f]].area;
    }
    r->low = INFINITY;
    return 0;
}

static void rows_close(struct rows *r)
{
    free(r->row);
    free(r->area);
    free(r->first);
    free(r->next);
}

/* Add A_e F V of all links of e and below to the row. */
static void add_links(struct rows *r, const struct solve *s, uint32_t e)
{
    const struct element *x = &s->hierarchy.elements[e];
    size_t i;
    int c;
    for (i = s->refinement.first_link[e]; i < s->refinement.first_link[e + 1]; i++) {
        const struct link *l = &s->refinement.links[i];
        uint32_t j = s->scene->faces[s->hierarchy.elements[l->emitter].face].input;
        r->row[j] += x->area * (double)l->form_factor * (l->visibility * (1.0 / LINK_VISIBLE));
    }
    for (c = 0; c < x->children; c++)
        add_links(r, s, x->child + (uint32_t)c);
}

/* Compute row i and its sum. */
static double sum_row(struct rows *r, const struct solve *s, uint32_t i)
{
    uint32_t n = s->scene->input_count, f, j;
    double sum = 0;
    memset(r->row, 0, n * sizeof *r->row);
    if (!(r->area[i] > 0))
        return 0;
    for (f = r->first[i]; f != UINT32_MAX; f = r->next[f])
        add_links(r, s, s->hierarchy.face_element[f]);
    for (j = 0; j < n; j++) {
        r->row[j] /= r->area[i];
        sum += r->row[j];
    }
    r->low = sum < r->low ? sum : r->low;
    r->high = sum > r->high ? sum : r->high;
    r->defect += fabs(1 - sum);
    return sum;
}

static int write_matrix(const char *path, struct rows *r, const struct solve *s)
{
    uint32_t n = s->scene->input_count, i, j;
    struct atomic_file file = { 0 };
    if (path && atomic_open(&file, path) < 0)
        return -1;
    for (i = 0; i < n; i++) {
        (void)sum_row(r, s, i);
        for (j = 0; path && j < n; j++)
            fprintf(file.stream, "%s%.12g", j ? "," : "", r->row[j]);
        if (path)
            fputc('\n', file.stream);
    }
    return path ? atomic_commit(&file) : 0;
}

static int report(const struct options *o, const struct rows *r, const struct solve *s)
{
    uint32_t n = s->scene->input_count - s->scene->dropped;
    double mean = n ? r->defect / n : 0, worst = fmax(fabs(1 - r->low), fabs(1 - r->high));
    if (!o->quiet && !(o->json && strcmp(o->json, "-") == 0)) {
        printf("faces     %u\n", s->scene->input_count);
        printf("links     %zu, %.3g rays, %.2f s\n", s->refinement.link_count, (double)rays_count(s->rays).rays,
               s->seconds.build + s->seconds.refine);
        printf("row sums  %.9f to %.9f; defect |1 - sum| %.2e at the most, %.2e in the mean\n", r->low, r->high, worst, mean);
        printf("          (1 in a closed scene; what an open scene lacks goes to the sky)\n");
    }
    if (!o->json)
        return 0;
    return json_file_write(o->json, json_pack("{s:s, s:i, s:I, s:I, s:f, s:f, s:f, s:f, s:f}", "scene", o->scene, "faces",
                           (int)s->scene->input_count, "links", (json_int_t)s->refinement.link_count,
                           "rays", (json_int_t)rays_count(s->rays).rays, "row_sum_smallest", r->low,
                           "row_sum_largest", r->high, "row_defect_largest", worst, "row_defect_mean", mean,
                           "seconds", s->seconds.build + s->seconds.refine));
}

int command_viewfactors(const struct options *o, const struct scene *scene)
{
    struct progress progress;
    struct solve_options how = { .tolerance = o->tolerance, .iterations = 1, .threads = o->threads, .unit = 1,
                                 .progress = progress_show, .context = &progress };
    struct refiner *refiner = oracles_open("viewfactors", RELEASE_FLAT);
    struct solve s;
    struct rows rows;
    const char *cause;
    int status = 1;
    if (!refiner || oracles_set(refiner, o->settings, o->setting_count) < 0) {
        refiner_close(refiner);
        return 1;
    }
    progress_start(&progress, o->quiet);
    if (solve_open(&s, scene, &how, &cause) < 0) {
        report_error(o->scene, 0, "%s", cause);
        refiner_close(refiner);
        return 1;
    }
    if (solve_refine(&s, refiner, &cause) < 0) {
        progress_end(&progress);
        report_error(o->scene, 0, "%s", cause);
    } else {
        progress_end(&progress);
        if (rows_open(&rows, &s) < 0)
            report_error(o->scene, 0, "out of memory");
        else
            status = write_matrix(o->out, &rows, &s) < 0 || report(o, &rows, &s) < 0;
        rows_close(&rows);
    }
    solve_close(&s);
    refiner_close(refiner);
    return status;
}
