/* oracles.c - `radiosity oracles`: the built-in oracles and their parameters.
 * SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>
#include "commands/commands.h"
#include "util/device.h"
#include "util/open_oracle.h"

static int print_oracle(RadDevice device, const char *name)
{
    RadOracle oracle = open_oracle(device, name, RAD_RELEASE_FLAT, NULL, 0);
    if (!oracle)
        return -1;
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    printf("%s%s: %s\n", name, strcmp(name, radGetDefaultOracle()) == 0 ? " (default)" : "",
           report.doc);
    for (int i = 0; i < report.parameter_count; i++) {
        const struct oracle_parameter *p = &report.parameters[i];
        printf("  %-10s %8g %-5s %s%s\n", p->name, p->value, p->unit, p->doc,
               p->fixed ? " (fixed by its author)" : "");
    }
    radReleaseOracle(oracle);
    return 0;
}

int command_oracles(const struct options *o, const struct open_scene *scene)
{
    (void)o;
    (void)scene;
    RadDevice device = open_device(1);
    int status = device ? 0 : -1;
    for (const char *const *name = radGetOracleNames(); *name && status == 0; name++)
        status = print_oracle(device, *name);
    radReleaseDevice(device);
    return status < 0;
}
