/* summary.c - see summary.h. Whatever bounded the result, a cap, a guard or a closure, is told here and never silent.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <sys/resource.h>
#include "commands/summary.h"

static double peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/* Emitted less absorbed, as a share: 0 in a closed scene; in an open one, what left it. */
static double imbalance(const struct solve *s)
{
    return s->report.emitted > 0 ? (s->report.emitted - s->report.absorbed) / s->report.emitted : 0;
}

static json_t *parameters_json(const struct refiner *r)
{
    json_t *all = json_object();
    int i;
    for (i = 0; i < r->parameter_count; i++)
        json_object_set_new(all, r->parameters[i].name, json_real(refiner_get(r, i)));
    return all;
}

static json_t *marks_json(const struct solve *s)
{
    json_t *all = json_array();
    int i;
    for (i = 0; i < LINK_MARKS; i++)
        json_array_append_new(all, json_integer((json_int_t)s->refinement.marked[i]));
    return all;
}

static json_t *importance_json(const struct solve *s)
{
    const struct importance *y = &s->importance;
    if (!y->sweeps)
        return json_null();
    return json_pack("{s:i, s:f, s:f, s:f}", "sweeps", y->sweeps, "largest", y->largest, "mean", y->mean, "area_seen", y->seen);
}

static json_t *error_json(const struct solve *s)
{
    const struct error_control *a = &s->error;
    if (!(a->target > 0))
        return json_null();
    return json_pack("{s:f, s:f, s:f}", "target", a->target, "largest", a->largest, "area_above", a->area);
}

static json_t *closure_json(const struct solve *s)
{
    if (s->problem.options.closure == CLOSURE_NONE)
        return json_null();
    return json_pack("{s:b, s:I, s:f, s:f, s:f}", "closed_scene", s->problem.closed > 0, "rays", (json_int_t)s->problem.closed_rays,
                     "removed_mean", s->problem.closed > 0 ? s->report.rows.defect_mean : s->report.rows.moved,
                     "removed_largest", s->problem.closed > 0 ? s->report.rows.defect_most : fmax(s->report.rows.high - 1, 0),
                     "blind_area", s->report.rows.blind_area);
}

json_t *summary_json(const struct options *o, const struct solve *s, const struct refiner *r, double output_seconds)
{
    struct rays_count rays = rays_count(s->problem.rays);
    return json_pack("{s:s, s:s, s:s, s:o, s:i, s:i, s:i, s:i, s:i, s:i, s:i, s:I, s:I, s:I, s:o, s:I, s:I, s:i, s:i, s:b, s:f, s:f, s:f, s:f,"
                     " s:{s:f, s:f, s:f, s:f, s:f}, s:o, s:o, s:o, s:{s:f, s:f, s:f, s:f, s:f}, s:f}",
                     "scene", o->scene, "oracle", r->oracle, "release", r->release, "parameters", parameters_json(r),
                     "threads", o->threads, "bands", (int)s->problem.bands, "faces", (int)s->problem.scene->input_count,
                     "faces_cut", (int)s->problem.scene->cut, "faces_cut_into", (int)s->problem.scene->parts,
                     "elements", (int)s->hierarchy.count, "leaves", (int)s->report.rows.leaves,
                     "links", (json_int_t)s->refinement.link_count, "pairs", (json_int_t)s->refinement.pairs,
                     "guard_hits", (json_int_t)s->refinement.marked[LINK_GUARDED], "marks", marks_json(s),
                     "rays", (json_int_t)rays.rays, "rounds", (json_int_t)s->refinement.rounds, "passes", s->report.passes,
                     "iterations", s->report.sweeps, "converged", s->report.converged, "residual", s->report.residual,
                     "power_emitted", s->report.emitted, "power_absorbed", s->report.absorbed, "power_imbalance", imbalance(s),
                     "row_sums", "smallest", s->report.rows.low, "largest", s->report.rows.high, "excess_moved", s->report.rows.moved,
                     "defect_mean", s->report.rows.defect_mean, "defect_largest", s->report.rows.defect_most, "closure", closure_json(s), "importance", importance_json(s),
                     "error", error_json(s),
                     "seconds", "build", s->report.seconds.build, "refine", s->report.seconds.refine, "in_rays", s->report.seconds.in_rays,
                     "iterate", s->report.seconds.iterate, "output", output_seconds, "peak_memory_mb", peak_megabytes());
}

/* Links that a graph has marked. A mark other than the guard's means what the graph's author meant by it. */
static void print_marks(const struct solve *s)
{
    int i;
    for (i = 1; i < LINK_MARKS; i++)
        if (s->refinement.marked[i])
            printf("marks     %llu links (%.2g %%) with mark %d%s\n", (unsigned long long)s->refinement.marked[i],
                   100 * (double)s->refinement.marked[i] / (double)s->refinement.link_count, i,
                   i == LINK_GUARDED ? ": a guard kept them from being split, as the oracle asked" : "");
}

static void print_rows(const struct solve *s)
{
    if (s->problem.options.closure == CLOSURE_NONE) {
        printf("rows      sums of F V from %.4f to %.4f before the cap at 1, which moved %.2g of the exchange\n",
               s->report.rows.low, s->report.rows.high, s->report.rows.moved);
        return;
    }
    printf("rows      sums of F V from %.4f to %.4f before closure\n", s->report.rows.low, s->report.rows.high);
    if (s->problem.closed > 0)
        printf("closure   the scene is closed (light finds no way out of it in %.3g steps): rows scaled to 1, which removed %.2g in the mean, "
               "%.2g at the most\n", (double)s->problem.closed_rays, s->report.rows.defect_mean, s->report.rows.defect_most);
    else
        printf("closure   the scene is open (light leaves it or meets a black back, in %.3g steps): rows above 1 scaled to 1, which "
               "removed %.2g in the mean, %.2g at the most\n", (double)s->problem.closed_rays, s->report.rows.moved, fmax(s->report.rows.high - 1, 0));
    if (s->report.rows.blind_area > 0)
        printf("blind     %.2g m2 of exposed leaves have no link%s\n", s->report.rows.blind_area,
               s->problem.closed > 0 ? "; they take the mean of their face" : "");
}

void summary_print(const struct options *o, const struct solve *s, const struct refiner *r, double output_seconds)
{
    struct rays_count rays = rays_count(s->problem.rays);
    printf("scene     %s: %u faces, %.4g m2, %s\n", o->scene, s->problem.scene->input_count, rays_host(s->problem.rays)->area,
           s->problem.bands == 1 ? "grey" : "three bands");
    if (s->problem.scene->cut)
        printf("cut       %u faces, into %u, where others stand in them\n", s->problem.scene->cut, s->problem.scene->parts);
    printf("oracle    %s (%s release)\n", r->oracle, r->release);
    printf("mesh      %u elements, of which %u leaves\n", s->hierarchy.count, s->report.rows.leaves);
    printf("links     %zu from %llu discussions in %llu rounds; %.3g rays\n", s->refinement.link_count,
           (unsigned long long)s->refinement.pairs, (unsigned long long)s->refinement.rounds, (double)rays.rays);
    print_marks(s);
    printf("solution  %d passes, %d sweeps, residual %.1e, %s\n", s->report.passes, s->report.sweeps, s->report.residual,
           s->report.converged ? "converged" : "NOT converged: allow more --iterations, or loosen --tolerance");
    if (s->importance.sweeps)
        printf("view      %.4g m2 in the picture; importance %.3g in the mean, %.3g at the most; %d of the sweeps\n",
               s->importance.seen, s->importance.mean, s->importance.largest, s->importance.sweeps);
    if (s->error.target > 0)
        printf("error     estimated %.3g W/m2 at the most, %.3g were asked for; above that are %.3g m2%s\n", s->error.largest,
               s->error.target, s->error.area, s->error.area > 0 ? ", which nothing more can split" : "");
    printf("power     %.6g W emitted, %.6g W absorbed: %.2f %% %s\n", s->report.emitted, s->report.absorbed, 100 * fabs(imbalance(s)),
           imbalance(s) < 0 ? "gained, which is error" : "leave the scene or are lost to error");
    print_rows(s);
    printf("time      %.2f s: build %.2f, refine %.2f (%.0f %% in Embree), iterate %.2f, output %.2f; %.0f MB\n",
           s->report.seconds.build + s->report.seconds.refine + s->report.seconds.iterate + output_seconds, s->report.seconds.build,
           s->report.seconds.refine, s->report.seconds.refine > 0 ? 100 * s->report.seconds.in_rays / s->report.seconds.refine : 0, s->report.seconds.iterate, output_seconds, peak_megabytes());
}
