/* summary.c - see summary.h. Whatever bounded the result, a cap, a guard or a closure, is told here
 * and never silent.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <sys/resource.h>
#include "commands/account_summary.h"
#include "commands/ranks_report.h"
#include "commands/summary.h"
#include "output/json_values.h"
#include "util/decisions.h"

/* the mark by which graphs say that a link was too large and could not be split (tools/mark.h) */
enum { GUARDED = 1 };

static double peak_megabytes(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return (double)usage.ru_maxrss / 1024;
}

/* Emitted less absorbed, as a share: 0 in a closed scene; in an open one, what left it. */
static double imbalance(const struct RadReport *r)
{
    return r->emitted > 0 ? (r->emitted - r->absorbed) / r->emitted : 0;
}

static json_t *marks_json(const uint64_t marked[RAD_LINK_MARKS])
{
    json_t *all = json_array();
    for (int i = 0; i < RAD_LINK_MARKS; i++)
        json_array_append_new(all, json_integer((json_int_t)marked[i]));
    return all;
}

static json_t *importance_json(const struct RadReport *r)
{
    if (!r->importance.sweeps)
        return json_null();
    return json_pack("{s:i, s:f, s:f, s:f}", "sweeps", r->importance.sweeps, "largest",
                     r->importance.largest, "mean", r->importance.mean, "area_seen",
                     r->importance.seen);
}

static json_t *bracket_json(const struct RadReport *r)
{
    if (!r->bracket.solves)
        return json_null();
    return json_pack("{s:i, s:f, s:f}", "solves", r->bracket.solves, "lower", r->bracket.lower,
                     "upper", r->bracket.upper);
}

static json_t *ranking_json(const struct RadReport *r)
{
    if (!r->ranking.asked)
        return json_null();
    return json_pack("{s:f, s:f}", "all", r->ranking.all, "worst", r->ranking.worst);
}

static json_t *error_control_json(const struct RadReport *r)
{
    if (!(r->tolerance.target > 0))
        return json_null();
    return json_pack("{s:f, s:f, s:f}", "target", r->tolerance.target, "largest",
                     r->tolerance.largest, "area_above", r->tolerance.area);
}

static json_t *closure_json(const struct options *o, const struct RadReport *r)
{
    if (o->closure == RAD_CLOSURE_NONE)
        return json_null();
    return json_pack("{s:b, s:I, s:f, s:f, s:f}", "closed_scene", r->closed > 0, "rays",
                     (json_int_t)r->closed_rays, "removed_mean",
                     r->closed > 0 ? r->rows.defect_mean : r->rows.moved, "removed_largest",
                     r->closed > 0 ? r->rows.defect_most : fmax(r->rows.high - 1, 0), "blind_area",
                     r->rows.blind_area);
}

/* How the links were solved over, and to what. */
static json_t *solver_json(const struct options *o, const struct RadReport *r)
{
    return json_pack("{s:s, s:s, s:b, s:f, s:o, s:f}", "method", solver_words[r->solver],
                     "projection", projection_words[r->projection], "tolerance_given",
                     o->tolerance > 0, "tolerance", r->solved.tolerance, "bound",
                     json_finite(r->solved.bound), "variation", r->solved.variation);
}

static json_t *basis_json(const struct RadReport *r)
{
    if (!r->linear.sweeps)
        return json_pack("{s:s}", "name", "constant");
    return json_pack("{s:s, s:i, s:I, s:f, s:f, s:f}", "name", "linear", "iterations",
                     r->linear.sweeps, "links_limited", (json_int_t)r->linear.limited, "flat_area",
                     r->linear.flat, "lowered_area", r->linear.lowered, "seconds",
                     r->linear.seconds);
}

/* How often each decision was taken; without those that never were. */
static json_t *decisions_json(const struct RadReport *r)
{
    json_t *decisions = json_object();
    for (int i = 0; i < DECISIONS; i++)
        if (r->decided[i])
            json_object_set_new(decisions, decision_names[i],
                                json_integer((json_int_t)r->decided[i]));
    return decisions;
}

/* As people compare them. */
static json_t *fingerprint_json(uint64_t value)
{
    char text[17];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)value);
    return json_string(text);
}

json_t *summary_json(const struct summary *s)
{
    const struct RadReport *r = &s->solved->report;
    const struct RadSceneReport *scene = &s->scene->report;
    struct RadOracleReport oracle;
    radGetOracleReport(s->oracle, &oracle);
    json_t *all =
        json_pack("{s:o, s:s, s:s, s:o, s:i, s:i, s:I, s:I, s:I, s:I, s:I}", "scene",
                  json_text(s->options->scene), "oracle", oracle.name, "release", oracle.release,
                  "parameters", oracle_parameters_json(s->oracle), "threads", s->options->threads,
                  "bands", (int)r->bands, "faces", (json_int_t)scene->polygons, "faces_cut",
                  (json_int_t)scene->cut, "faces_cut_into", (json_int_t)scene->parts, "elements",
                  (json_int_t)r->elements, "leaves", (json_int_t)r->leaves);
    json_t *replaced = json_array();
    for (int i = 0; i < s->options->replacement_count; i++)
        json_array_append_new(replaced, json_string(s->options->replacements[i]));
    json_object_set_new(all, "replaced", replaced);
    json_object_set_new(all, "element_marks", marks_json(r->marked_elements));
    json_object_set_new(all, "ranks", ranks_json(s->ranks, s->rank_count));
    json_object_set_new(all, "link_fingerprint", fingerprint_json(r->link_fingerprint));
    json_object_set_new(all, "particle_fingerprint", fingerprint_json(r->particle_fingerprint));
    json_t *links =
        json_pack("{s:I, s:I, s:o, s:I, s:o, s:I, s:I}", "links", (json_int_t)r->links, "pairs",
                  (json_int_t)r->pairs, "decisions", decisions_json(r), "guard_hits",
                  (json_int_t)r->marked[GUARDED], "marks", marks_json(r->marked), "rays",
                  (json_int_t)r->rays, "rounds", (json_int_t)r->rounds);
    json_t *solution =
        json_pack("{s:i, s:i, s:b, s:I, s:f, s:o, s:o, s:f, s:f, s:f}", "passes", r->passes,
                  "iterations", r->iterations, "converged", r->converged, "links_changing",
                  (json_int_t)r->changing, "residual", r->residual, "solver",
                  solver_json(s->options, r), "basis", basis_json(r), "power_emitted", r->emitted,
                  "power_absorbed", r->absorbed, "power_imbalance", imbalance(r));
    json_t *quality = json_pack(
        "{s:{s:f, s:f, s:f, s:f, s:f}, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}",
        "row_sums", "smallest", r->rows.low, "largest", r->rows.high, "excess_moved", r->rows.moved,
        "defect_mean", r->rows.defect_mean, "defect_largest", r->rows.defect_most, "closure",
        closure_json(s->options, r), "importance", importance_json(r), "error_control",
        error_control_json(r), "bracket", bracket_json(r), "ranking", ranking_json(r), "scale",
        s->coarse ? coarse_first_json(s->coarse) : json_null(), "error",
        measured_json(s->measured, scene->polygons), "correction", mended_json(s->measured),
        "promise", power_promise_json(s->promise), "accuracy",
        s->accuracy ? accuracy_json(s->accuracy, s->options) : json_null());
    json_t *cost = json_pack("{s:{s:f, s:f, s:f, s:f, s:f}, s:f}", "seconds", "build",
                             r->seconds.build, "refine", r->seconds.refine, "in_rays",
                             r->seconds.in_rays, "iterate", r->seconds.iterate, "output",
                             s->output_seconds, "peak_memory_mb", peak_megabytes());
    json_t *const parts[] = {links, solution, quality, cost};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        json_object_update(all, parts[i]);
        json_decref(parts[i]);
    }
    return all;
}

/* Links and elements that a graph has marked. A mark other than the guard's means what the graph's
 * author meant by it. */
static void print_marks(const struct RadReport *r)
{
    for (int i = 1; i < RAD_LINK_MARKS; i++)
        if (r->marked[i])
            printf("marks     %llu links (%.2g %%) with mark %d%s\n",
                   (unsigned long long)r->marked[i], 100 * (double)r->marked[i] / (double)r->links,
                   i,
                   i == GUARDED ? ": a guard kept them from being split, as the oracle asked" : "");
    for (int i = 1; i < RAD_LINK_MARKS; i++)
        if (r->marked_elements[i])
            printf("marks     %llu elements (%.2g %%) with mark %d\n",
                   (unsigned long long)r->marked_elements[i],
                   100 * (double)r->marked_elements[i] / (double)r->elements, i);
}

static void print_solver(const struct options *o, const struct RadReport *r)
{
    printf("solver    %s, %s: iteration left at most %.1e of B, %.1e allowed",
           solver_words[r->solver], projection_words[r->projection], r->solved.bound,
           r->solved.tolerance);
    if (o->tolerance > 0)
        printf(" as asked\n");
    else if (r->solved.variation > 0)
        printf(" beside the elements' own %.1e\n", r->solved.variation);
    else
        putchar('\n');
}

static void print_rows(const struct options *o, const struct RadReport *r)
{
    if (o->closure == RAD_CLOSURE_NONE) {
        printf("rows      sums of F V from %.4f to %.4f before the cap at 1, which moved %.2g of "
               "the exchange\n",
               r->rows.low, r->rows.high, r->rows.moved);
        return;
    }
    printf("rows      sums of F V from %.4f to %.4f before closure\n", r->rows.low, r->rows.high);
    if (r->closed > 0)
        printf("closure   the scene is closed (light finds no way out of it in %.3g steps): rows "
               "scaled to 1, which removed %.2g in the mean, "
               "%.2g at the most\n",
               (double)r->closed_rays, r->rows.defect_mean, r->rows.defect_most);
    else
        printf("closure   the scene is open (light leaves it or meets a black back, in %.3g "
               "steps): rows above 1 scaled to 1, which "
               "removed %.2g in the mean, %.2g at the most\n",
               (double)r->closed_rays, r->rows.moved, fmax(r->rows.high - 1, 0));
    if (r->rows.blind_area > 0)
        printf("blind     %.2g m2 of exposed leaves have no link%s\n", r->rows.blind_area,
               r->closed > 0 ? "; they take the mean of their face" : "");
}

/* What oracles that rank, bound or aim tell besides. */
static void print_aims(const struct options *o, const struct RadReport *r)
{
    if (r->importance.sweeps && !o->view_given)
        printf("impact    of a watt that leaves a surface come %.3g W at all surfaces in the mean, "
               "%.3g at the most; %d of the sweeps\n",
               r->importance.mean, r->importance.largest, r->importance.sweeps);
    else if (r->importance.sweeps)
        printf("view      %.4g m2 in the picture; importance %.3g in the mean, %.3g at the most; "
               "%d of the sweeps\n",
               r->importance.seen, r->importance.mean, r->importance.largest, r->importance.sweeps);
    if (r->ranking.asked)
        printf("ranked    error times impact of all links %.3g W, of the worst that can be split "
               "%.3g W\n",
               r->ranking.all, r->ranking.worst);
    if (r->bracket.solves)
        printf("bracket   proved: the radiosities of all surfaces come to %.6g W at least and %.6g "
               "W at the most\n",
               r->bracket.lower, r->bracket.upper);
    if (r->tolerance.target > 0)
        printf("control   estimated %.3g W/m2 at the most, %.3g were asked for; above that are "
               "%.3g m2%s\n",
               r->tolerance.largest, r->tolerance.target, r->tolerance.area,
               r->tolerance.area > 0 ? ", which nothing more can split" : "");
}

static void print_links(const struct options *o, const struct RadReport *r)
{
    char cause[SOLVED_CAUSE] = "";
    if (!r->converged)
        solved_cause(r, cause);
    printf("links     %llu from %llu discussions in %llu rounds; %.3g rays\n",
           (unsigned long long)r->links, (unsigned long long)r->pairs,
           (unsigned long long)r->rounds, (double)r->rays);
    print_marks(r);
    printf("solution  %d pass%s, %d sweep%s, residual %.1e, %s%s\n", r->passes,
           r->passes == 1 ? "" : "es", r->iterations, r->iterations == 1 ? "" : "s", r->residual,
           r->converged ? "converged" : "NOT converged: ", cause);
    print_solver(o, r);
    if (r->linear.sweeps)
        printf(
            "basis     linear over the last links: %d sweeps, %.2f s; constant on %.2g %% of the "
            "area, where a solid stands on a part\n",
            r->linear.sweeps, r->linear.seconds, 100 * r->linear.flat);
    print_aims(o, r);
}

void summary_print(const struct summary *s)
{
    const struct RadReport *r = &s->solved->report;
    const struct RadSceneReport *scene = &s->scene->report;
    struct RadOracleReport oracle;
    radGetOracleReport(s->oracle, &oracle);
    printf("scene     %s: %u face%s, %.4g m2, %s\n", s->options->scene, scene->polygons,
           scene->polygons == 1 ? "" : "s", scene->area, r->bands == 1 ? "grey" : "three bands");
    if (scene->cut)
        printf("cut       %u face%s, into %u, where others stand in %s or as %s long\n", scene->cut,
               scene->cut == 1 ? "" : "s", scene->parts, scene->cut == 1 ? "it" : "them",
               scene->cut == 1 ? "it is" : "they are");
    printf("oracle    %s (%s release)\n", oracle.name, oracle.release);
    for (int i = 0; i < s->options->replacement_count; i++)
        printf("replaced  %s\n", s->options->replacements[i]);
    printf("mesh      %u elements, of which %u leaves\n", r->elements, r->leaves);
    const int no_links = s->coarse && s->coarse->choice.no_links;
    if (no_links)
        printf("links     none: the same light on all surfaces, and what particles add\n");
    else
        print_links(s->options, r);
    printf("power     %.6g W emitted, %.6g W absorbed: %.2f %% %s\n", r->emitted, r->absorbed,
           100 * fabs(imbalance(r)),
           imbalance(r) < 0 ? "gained, which is error" : "leave the scene or are lost to error");
    if (!no_links)
        print_rows(s->options, r);
    if (s->coarse)
        coarse_first_print(s->coarse);
    measured_print(s->measured, scene->polygons, no_links);
    if (s->measured->accounted)
        account_print(&s->measured->account);
    power_promise_print(s->promise);
    if (s->accuracy)
        accuracy_print(s->accuracy, s->options);
    ranks_print(s->ranks, s->rank_count);
    const double solve = r->seconds.build + r->seconds.refine + r->seconds.iterate,
                 rest = s->accuracy ? fmax(s->accuracy->seconds - solve, 0)
                                    : measured_seconds(s->measured)
                                          + (s->coarse ? s->coarse->choice.seconds : 0);
    printf("time      %.2f s: build %.2f, refine %.2f (%.0f %% in Embree), iterate %.2f, %s "
           "%.2f, output %.2f; %.0f MB\n",
           solve + rest + s->output_seconds, r->seconds.build, r->seconds.refine,
           r->seconds.refine > 0 ? 100 * r->seconds.in_rays / r->seconds.refine : 0,
           r->seconds.iterate, s->accuracy ? "particles and solves before" : "particles", rest,
           s->output_seconds, peak_megabytes());
}
