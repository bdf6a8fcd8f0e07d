/* checkpoint.c - see checkpoint.h.
 * SPDX-License-Identifier: MIT */
#include "commands/checkpoint.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/hdf5_file.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/report.h"

static const char FORMAT[] = "radiosity checkpoint 2";

/* ---- writing */

static int write_checkpoint(struct checkpoint *c, const struct RadStatePart *part)
{
    struct hdf5_file *f = hdf5_create(c->to, 1);
    if (!f)
        return -1;
    int failed = hdf5_put_text(f, "format", FORMAT) < 0 || hdf5_put_number(f, "scale", c->scale) < 0
                 || hdf5_put_number(f, "chosen", c->chosen) < 0
                 || hdf5_put_number(f, "rays", c->rays) < 0;
    for (int i = 0; i < RAD_STATE_PARTS && !failed; i++)
        failed = hdf5_put(f, part[i].name, (enum hdf5_type)part[i].type, part[i].rows,
                          part[i].columns, part[i].data, i == RAD_STATE_LINK)
                 < 0;
    if (!failed)
        return hdf5_commit(f);
    hdf5_discard(f);
    return -1;
}

static int between(void *user, RadSolution solution)
{
    struct checkpoint *c = user;
    struct RadStatePart part[RAD_STATE_PARTS];
    struct RadReport report;
    radGetReport(solution, &report);
    if (report.passes == c->passes) /* it stands in a file already */
        return 0;
    if (radGetSolutionState(solution, part) < 0)
        return 1;
    c->failed = write_checkpoint(c, part) < 0;
    return c->failed;
}

/* ---- reading */

struct parts {
    struct RadStatePart part[RAD_STATE_PARTS];
    void *data[RAD_STATE_PARTS];
};

static void free_parts(struct parts *p)
{
    for (int i = 0; i < RAD_STATE_PARTS; i++)
        free(p->data[i]);
}

/* Each process reads all parts but links, and its part of these. */
static const char *read_parts(struct hdf5_file *f, struct parts *p)
{
    static const struct {
        const char *name;
        enum hdf5_type type;
    } parts[RAD_STATE_PARTS] = {[RAD_STATE_HEAD] = {"head", HDF5_LONGS},
                                [RAD_STATE_SPLIT] = {"split", HDF5_WORDS},
                                [RAD_STATE_MARK] = {"mark", HDF5_WORDS},
                                [RAD_STATE_SEEN] = {"seen", HDF5_NUMBERS},
                                [RAD_STATE_UNCOVERED] = {"uncovered", HDF5_NUMBERS},
                                [RAD_STATE_RADIOSITY] = {"radiosity", HDF5_NUMBERS},
                                [RAD_STATE_IRRADIANCE] = {"irradiance", HDF5_NUMBERS},
                                [RAD_STATE_LINK] = {"links", HDF5_LINKS}};
    static const uint64_t most = (uint64_t)1 << 40, wide = 16;
    for (int i = 0; i < RAD_STATE_PARTS; i++) {
        uint64_t rows, columns, first = 0;
        if (hdf5_size(f, parts[i].name, parts[i].type, &rows, &columns) < 0 || rows > most
            || columns < 1 || columns > wide)
            return "it is damaged";
        if (i == RAD_STATE_LINK) {
            const uint64_t ranks = (uint64_t)machines_count(), k = (uint64_t)machines_number();
            first = rows / ranks * k + rows % ranks * k / ranks;
            rows = rows / ranks * (k + 1) + rows % ranks * (k + 1) / ranks - first;
        }
        p->data[i] = malloc((size_t)(rows * columns) * sizeof(struct RadLink) + 1);
        if (!p->data[i])
            return "out of memory for what it holds";
        if (hdf5_get(f, parts[i].name, parts[i].type, first, rows, columns, p->data[i]) < 0)
            return "it is damaged";
        p->part[i] = (struct RadStatePart){parts[i].name, (enum RadStateType)parts[i].type, rows,
                                           columns, p->data[i]};
    }
    return NULL;
}

static int refuse(const struct checkpoint *c, const char *cause)
{
    return report_error(c->from, 0, "cannot go on from it: %s; leave --restart out to start anew",
                        cause);
}

int checkpoint_open(struct checkpoint *c, RadDevice device, const struct options *o)
{
    *c = (struct checkpoint){.to = o->checkpoint,
                             .from = o->restart,
                             .device = device,
                             .where = o->scene,
                             .scale = 0,
                             .passes = -1,
                             .quiet = o->quiet};
    if (!c->from)
        return 0;
    const char *cause;
    struct hdf5_file *f = hdf5_open(c->from, &cause);
    double chosen;
    if (f) {
        cause = !hdf5_has_text(f, "format", FORMAT) ? "it is no checkpoint of this version"
                : hdf5_get_number(f, "scale", &c->scale) < 0
                        || hdf5_get_number(f, "chosen", &chosen) < 0
                        || hdf5_get_number(f, "rays", &c->rays) < 0 || !(c->scale > 0)
                        || !(c->rays >= 0 && c->rays < 9e18) || !(chosen == 0 || chosen == 1)
                    ? "it is damaged"
                    : NULL;
        hdf5_close(f);
        if (!cause)
            c->chosen = chosen > 0;
    }
    if (machines_agree(cause != NULL))
        return refuse(c, cause ? cause : "another process cannot");
    return 0;
}

/* Returns 0, or -1 after a message. */
static int take_state(struct checkpoint *c, RadSolution solution)
{
    struct parts p = {0};
    const char *cause;
    struct hdf5_file *f = hdf5_open(c->from, &cause);
    if (f) {
        cause = read_parts(f, &p);
        hdf5_close(f);
    }
    int failed = machines_agree(cause != NULL);
    if (failed) {
        refuse(c, cause ? cause : "another process cannot");
    } else if (radSetSolutionState(solution, p.part) < 0) {
        failed = 1;
        if (radGetDeviceErrorMessage(c->device)[0])
            refuse(c, radGetDeviceErrorMessage(c->device));
        (void)radGetDeviceError(c->device);
    }
    free_parts(&p);
    if (failed)
        return -1;
    struct RadReport report;
    radGetReport(solution, &report);
    c->passes = report.passes;
    if (!c->quiet)
        fprintf(stderr, "goes on from %s: pass %d, %.3g links, %.3g rays\n", c->from,
                report.passes + 1, (double)report.links, (double)report.rays);
    c->from = NULL;
    return 0;
}

int checkpoint_begin(struct checkpoint *c, RadSolution solution)
{
    c->passes = -1;
    if (c->from && take_state(c, solution) < 0) {
        c->failed = 1;
        return -1;
    }
    if (c->to)
        radSetSolutionPassFunction(solution, between, c);
    return 0;
}

int checkpoint_report(struct checkpoint *c)
{
    if (!c->failed)
        return report_device(c->device, c->where);
    (void)radGetDeviceError(c->device);
    return -1;
}
