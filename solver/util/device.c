/* device.c - see device.h.
 * SPDX-License-Identifier: MIT */
#include "util/device.h"

#include <stdlib.h>
#include <string.h>

#include "util/machines.h"
#include "util/report.h"
#include "util/temporary.h"

static const struct oracle *const *hand_releases;

void register_hand_releases(const struct oracle *const *table)
{
    hand_releases = table;
}

static char *const *plugins;
static int plugin_count;

void use_plugins(char *const *paths, int count)
{
    plugins = paths;
    plugin_count = count;
}

static const char *from_environment(const char *name)
{
    const char *value = getenv(name);
    return value && *value ? value : NULL;
}

RadDevice open_device(int threads)
{
    const char *folder = temporary_folder();
    const struct RadDeviceOptions options = {threads, from_environment("CC"),
                                             folder ? folder : from_environment("TMPDIR")};
    RadDevice device = machines_device(&options);
    if (!device) {
        report_device(NULL, "radiosity");
        return NULL;
    }
    for (int i = 0; hand_releases && hand_releases[i]; i++)
        if (radRegisterOracle(device, hand_releases[i]) < 0) {
            report_device(device, hand_releases[i]->name);
            radReleaseDevice(device);
            return NULL;
        }
    for (int i = 0; i < plugin_count; i++)
        if (radLoadPlugin(device, plugins[i]) < 0) {
            report_device(device, plugins[i]);
            radReleaseDevice(device);
            return NULL;
        }
    return device;
}

int report_device(RadDevice device, const char *where)
{
    report_error(where, 0, "%s", radGetDeviceErrorMessage(device));
    (void)radGetDeviceError(device);
    return -1;
}

int report_unless_cancelled(RadDevice device, const char *where)
{
    char *message = strdup(radGetDeviceErrorMessage(device)); /* asking for the code forgets it */
    int cancelled = radGetDeviceError(device) == RAD_ERROR_CANCELLED;
    if (!cancelled)
        report_error(where, 0, "%s", message && *message ? message : "out of memory");
    free(message);
    return cancelled ? 1 : -1;
}
