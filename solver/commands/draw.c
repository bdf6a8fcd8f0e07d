/* draw.c - `radiosity draw`: the graph of an oracle as SVG, with what a solve counted in it.
 * SPDX-License-Identifier: MIT */
#include "commands/commands.h"
#include "output/graph_svg.h"
#include "output/statistics_read.h"
#include "util/atomic_file.h"
#include "util/device.h"
#include "util/open_oracle.h"

static int write_drawing(const char *path, RadOracle oracle, const json_t *statistics)
{
    struct atomic_file file;
    if (atomic_open(&file, path) < 0)
        return -1;
    if (graph_svg_write(file.stream, oracle, statistics) == 0)
        return atomic_commit(&file);
    atomic_discard(&file);
    return -1;
}

int command_draw(const struct options *o, const struct open_scene *scene)
{
    (void)scene;
    RadDevice device = open_device(1);
    RadOracle oracle =
        device ? open_oracle(device, o->oracle, RAD_RELEASE_DAG, o->settings, o->setting_count)
               : NULL;
    json_t *statistics = NULL;
    int status = oracle ? 0 : -1;
    if (status == 0 && o->statistics && !(statistics = statistics_read(o->statistics)))
        status = -1;
    if (status == 0)
        status = write_drawing(o->out, oracle, statistics);
    json_decref(statistics);
    radReleaseOracle(oracle);
    radReleaseDevice(device);
    return status < 0;
}
