/* viewfactors.c - `radiosity viewfactors`: the matrix of face-to-face view factors.
 *
 * F_ij is the share of what leaves face i evenly that meets face j. Faces count as in the file: a
 * face with two sides, or cut into parts, is one row, a mean over its parts.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include "commands/commands.h"
#include "commands/factor_state.h"
#include "commands/product_columns.h"
#include "commands/ranks_report.h"
#include "commands/sensor_rows.h"
#include "kernel/hash_bytes.h"
#include "output/factor_file.h"
#include "output/factor_names.h"
#include "output/json_file.h"
#include "output/json_values.h"
#include "util/beside.h"
#include "util/clock.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/open_oracle.h"
#include "util/read_alike.h"
#include "util/report.h"

/* Which faces are one row. NULL: each its own. Returns 0, or -1 after a message. */
static int parts_of(const struct options *o, const struct scene_file *f, struct factor_parts *parts,
                    const struct factor_parts **by)
{
    const struct part_names *named = o->by == BY_GROUP    ? &f->groups
                                     : o->by == BY_OBJECT ? &f->objects
                                                          : NULL;
    const char *other = o->by == BY_GROUP && f->objects.count   ? "object"
                        : o->by == BY_OBJECT && f->groups.count ? "group"
                                                                : "material";
    *by = o->by == BY_FACE ? NULL : parts;
    *parts = (struct factor_parts){f->polygon_materials, f->names, f->material_count};
    if (named && !named->count)
        return report_error(o->scene, 0, "names no %ss; give --by %s", by_words[o->by], other);
    if (named)
        *parts = (struct factor_parts){named->of, named->names, named->count};
    return 0;
}

static void print(const struct options *o, const struct open_scene *scene, uint32_t rows,
                  const struct RadExchangeReport *r, double write_seconds)
{
    printf("faces     %u", scene->originals);
    printf(o->copies.count ? ", %u with their copies\n" : "\n", scene->report.polygons);
    if (o->by != BY_FACE)
        printf("rows      %u, a sum over faces for each %s\n", rows, by_words[o->by]);
    printf("links     %llu for %llu pairs of faces, %.3g rays; refine %.2f s, fill %.2f s, write "
           "%.2f s\n",
           (unsigned long long)r->links, (unsigned long long)r->pairs, (double)r->rays,
           r->seconds.refine, r->seconds.fill, write_seconds);
    printf("row sums  %.9f to %.9f\n", r->low, r->high);
    if (r->rows_closed)
        printf("defect    |1 - sum| %.2e at the most, %.2e in the mean, of %u rows that see no "
               "sky%s\n",
               r->defect_most, r->defect_mean, r->rows_closed,
               o->closure ? ", before closure" : "");
    if (r->entry_error > 0)
        printf("entries   in half shadow are off by %.1e at the most, as estimated\n",
               r->entry_error);
    if (r->rows_open)
        printf("to sky    %.2f %% of what all faces send; up to %.2f %% of one of %u rows; not "
               "normalised away\n",
               100 * r->environment_mean, 100 * r->environment_most, r->rows_open);
    if (r->rows_backs)
        printf("to backs  %.2f %% of what all faces send; up to %.2f %% of one of %u rows\n",
               100 * r->backs_mean, 100 * r->backs_most, r->rows_backs);
    if (r->rows_covered)
        printf("covered   %u rows that others stand on: their covered parts see nothing\n",
               r->rows_covered);
    if (o->closure)
        printf("closure   factors changed by up to %.2e%s; defect left %.1e\n", r->closure_change,
               o->closure == RAD_CLOSURE_RECIPROCAL ? ", the same both ways"
                                                    : "; A_i F_ij is no longer A_j F_ji",
               r->closure_left);
}

static json_t *report_json(const struct options *o, const struct open_scene *scene,
                           const struct RadExchangeReport *r, double write_seconds)
{
    return json_pack(
        "{s:o, s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:I, s:I, s:I, s:f, s:f, s:s, s:f, s:f, "
        "s:f, s:f, s:f, s:f, s:I, s:f, s:f, s:f}",
        "scene", json_text(o->scene), "faces", (json_int_t)scene->originals, "links",
        (json_int_t)r->links, "pairs", (json_int_t)r->pairs, "rays", (json_int_t)r->rays,
        "row_sum_smallest", r->low, "row_sum_largest", r->high, "row_defect_largest",
        r->defect_most, "row_defect_mean", r->defect_mean, "rows_closed",
        (json_int_t)r->rows_closed, "rows_to_sky", (json_int_t)r->rows_open, "rows_covered",
        (json_int_t)r->rows_covered, "to_sky_largest", r->environment_most, "to_sky_mean",
        r->environment_mean, "closure", closure_words[o->closure], "closure_largest_change",
        r->closure_change, "closure_defect_left", r->closure_left, "seconds",
        r->seconds.refine + r->seconds.fill + write_seconds, "seconds_refine", r->seconds.refine,
        "seconds_fill", r->seconds.fill, "seconds_write", write_seconds, "rows_to_backs",
        (json_int_t)r->rows_backs, "to_backs_largest", r->backs_most, "to_backs_mean",
        r->backs_mean, "entry_error_largest", r->entry_error);
}

/* The matrix, or a product with it, and its names; of how many rows. Returns 0, or -1 after a
 * message. */
static int write_matrix(const struct options *o, const struct open_scene *scene,
                        const struct factor_parts *by, RadExchange exchange,
                        const struct columns *columns, uint32_t *rows)
{
    struct surfaces surfaces =
        surfaces_of(scene->scene, scene->file.polygon_materials, scene->file.names);
    struct factor_table table;
    const int speaks = machines_number() == 0;
    surfaces.polygon_count = scene->originals;
    int status = factor_table_open(&table, exchange, scene->report.polygons, o->scene, &surfaces,
                                   by, o->losses);
    *rows = table.count;
    if (status < 0)
        report_error(o->scene, 0, "out of memory for the names of rows");
    else if ((o->product && columns_write_product(columns, o->out, exchange, scene) < 0)
             || (o->out && !o->product && speaks
                 && factor_file_write(o->out, o->format, &table, o->threads) < 0)
             || (o->names && speaks && factor_names_write(o->names, &table) < 0))
        status = -1;
    factor_table_close(&table);
    return status;
}

/* Write what was asked for, which one of several ranks does. Returns 0, or -1 after a message. */
static int write_outputs(const struct options *o, const struct open_scene *scene,
                         const struct factor_parts *by, RadExchange exchange,
                         const struct columns *columns)
{
    struct RadExchangeReport r;
    struct RadRank ranks[MACHINES_MOST];
    radGetExchangeReport(exchange, &r);
    /* asks all ranks: before one that writes may fail */
    const int rank_count = radGetExchangeRanks(exchange, ranks, MACHINES_MOST);
    double start = seconds();
    uint32_t rows;
    if (write_matrix(o, scene, by, exchange, columns, &rows) < 0)
        return -1;
    double write_seconds = seconds() - start;
    if (machines_number() > 0)
        return 0;
    if (!o->quiet && !path_is_stdout(o->json)) {
        print(o, scene, rows, &r, write_seconds);
        ranks_print(ranks, rank_count);
    }
    if (!o->quiet && r.worst > o->tolerance)
        report_warning(o->scene, scene->file.lines[r.worst_row],
                       "a row sum is off by %.1e, that of face %u, above the tolerance %.1e; a "
                       "smaller --tolerance takes longer",
                       r.worst, (unsigned)r.worst_row, o->tolerance);
    if (!o->json)
        return 0;
    json_t *report = report_json(o, scene, &r, write_seconds);
    json_object_set_new(report, "by", json_string(by_words[o->by]));
    json_object_set_new(report, "rows", json_integer(rows));
    json_object_set_new(report, "ranks", ranks_json(ranks, rank_count));
    return json_file_write(o->json, report);
}

/* Work it out, and write what was asked for. Returns the exit status. */
static int work(const struct options *o, const struct open_scene *scene,
                const struct factor_parts *by, RadOracle oracle, const struct columns *columns)
{
    struct factor_state state;
    if (machines_agree(factor_state_open(&state, o) < 0))
        return 1;
    const struct RadExchangeOptions how = {.tolerance = o->tolerance,
                                           .closure = o->closure,
                                           .rows = o->copies.count ? scene->originals : 0,
                                           .stream = o->product != NULL,
                                           .state = factor_state_host(&state)};
    radSetDeviceProgressFunction(scene->device, factor_state_show, &state);
    RadExchange exchange = radNewExchange(scene->scene, oracle, &how);
    factor_state_close(&state);
    int status = exchange ? write_outputs(o, scene, by, exchange, columns) < 0
                          : factor_state_report(&state, scene->device, o->scene);
    radReleaseExchange(exchange);
    if (status == 0)
        factor_state_remove(&state);
    return status;
}

/* The matrix, or the columns' product with it. Returns the exit status. */
static int compute(const struct options *o, const struct open_scene *scene,
                   const struct columns *columns)
{
    struct factor_parts parts;
    const struct factor_parts *by;
    if (parts_of(o, &scene->file, &parts, &by) < 0)
        return 1; /* before the work */
    RadOracle oracle = radNewExchangeOracle(scene->device, o->tolerance);
    if (!oracle)
        return report_device(scene->device, o->scene) < 0;
    int status = 1;
    if (set_oracle(scene->device, oracle, o->settings, o->setting_count) == 0)
        status = work(o, scene, by, oracle, columns);
    radReleaseOracle(oracle);
    return status;
}

int command_viewfactors(const struct options *o, const struct open_scene *scene)
{
    struct columns columns = {0};
    if (o->sensor)
        return sensor_rows(o, scene);
    int status = o->product && columns_read(&columns, o->product, scene->originals) < 0;
    status =
        machines_agree(status)
        || (o->product
            && read_alike(o->product, hash_bytes(columns.count, columns.x,
                                                 columns.rows * columns.count * sizeof *columns.x))
                   < 0);
    if (status == 0)
        status = compute(o, scene, &columns);
    columns_free(&columns);
    return status;
}
