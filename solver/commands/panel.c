/* panel.c - `radiosity panel`: an oracle's drawing and parameters as a page in a browser.
 *
 * "Each tool owns its interface with the parameters manipulators. The collection of all tools
 * interface can be packed together for an automatic graph interface generation." [Turbet and
 * Sillion, section 4.3] Here parameters are the oracle's, and it says which of them it offers.
 * SPDX-License-Identifier: MIT */
#include "commands/commands.h"
#include "output/panel_page.h"
#include "output/statistics_read.h"
#include "util/device.h"
#include "util/open_oracle.h"

static int write_panel(const struct options *o, RadOracle oracle)
{
    json_t *statistics = o->statistics ? statistics_read(o->statistics) : NULL;
    int status =
        o->statistics && !statistics ? -1 : panel_page_write(o->out, oracle, o->oracle, statistics);
    json_decref(statistics);
    return status;
}

int command_panel(const struct options *o, const struct open_scene *scene)
{
    (void)scene;
    RadDevice device = open_device(1);
    RadOracle oracle = device ? open_oracle(device, o->oracle, RAD_RELEASE_DAG, NULL, 0) : NULL;
    int status = oracle ? write_panel(o, oracle) : -1;
    radReleaseOracle(oracle);
    radReleaseDevice(device);
    return status < 0;
}
