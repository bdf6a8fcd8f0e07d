/* open_oracle.c - see open_oracle.h.
 * SPDX-License-Identifier: MIT */
#include "util/open_oracle.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "util/decimal.h"
#include "util/device.h"
#include "util/ends_with.h"
#include "util/report.h"

static int is_file(const char *oracle)
{
    return strchr(oracle, '/') || (strlen(oracle) > 4 && ends_with(oracle, ".dag"))
           || strcmp(oracle, "-") == 0;
}

/* The message to a name that nobody has, or that has no such release. Returns NULL. */
static RadOracle refuse_oracle(RadDevice device, const char *oracle, enum RadRelease release)
{
    char names[256] = "";
    (void)radGetDeviceError(device);
    if (release != RAD_RELEASE_HAND
        || !(radHasOracle(device, oracle, RAD_RELEASE_DAG) || is_file(oracle))) {
        report_error(oracle, 0,
                     "no such oracle; `radiosity oracles` lists the built-in ones, a file's name "
                     "ends in .dag");
        return NULL;
    }
    for (const char *const *name = radGetOracleNames(); *name; name++)
        if (radHasOracle(device, *name, RAD_RELEASE_HAND))
            snprintf(names + strlen(names), sizeof names - strlen(names), "%s--oracle %s",
                     *names ? " or " : "", *name);
    report_error(oracle, 0,
                 "no hand-written release of this oracle; use --release flat, wave or dag, or %s",
                 names);
    return NULL;
}

/* The message to an oracle that could not be made: a graph's errors stand in lines of their own,
 * each with its place. Returns NULL. */
static RadOracle refuse_graph(RadDevice device, const char *oracle)
{
    const char *message = radGetDeviceErrorMessage(device);
    if (!ends_with(message, "\n")) {
        report_device(device, oracle);
        return NULL;
    }
    fputs(message, stderr);
    (void)radGetDeviceError(device);
    return NULL;
}

int set_oracle_parameter(RadDevice device, RadOracle oracle, const char *name, const char *text,
                         const char *where, uint32_t line)
{
    const char *equals = line ? " = " : "=";
    char *end;
    const double value = decimal(text, &end);
    if (!*text)
        return report_error(where, line, "%s has no value; write %s%sNUMBER", name, name, equals);
    if (end == text || *end || isnan(value))
        return report_error(where, line, "'%s' is not a number; write %s%sNUMBER", text, name,
                            equals);
    if (isinf(value) && strpbrk(text, "0123456789"))
        return report_error(where, line, "%s%s%s: too large to be a number here; inf is one", name,
                            equals, text);
    if (radSetOracleParameter(oracle, name, value) == 0)
        return 0;
    report_error(where, line, "%s", radGetDeviceErrorMessage(device));
    (void)radGetDeviceError(device);
    return -1;
}

/* Apply one text "NAME=VALUE". Returns 0, or -1 after a message. */
static int apply_setting(RadDevice device, RadOracle oracle, const char *setting)
{
    const char *equals = strchr(setting, '=');
    char name[64];
    size_t length = equals ? (size_t)(equals - setting) : 0;
    if (!equals || length == 0 || length >= sizeof name)
        return report_error("--set", 0, "'%s' names no parameter; write PARAM=VALUE", setting);
    memcpy(name, setting, length);
    name[length] = 0;
    return set_oracle_parameter(device, oracle, name, equals + 1, "--set", 0);
}

int set_oracle(RadDevice device, RadOracle oracle, char *const *settings, int count)
{
    for (int i = 0; i < count; i++)
        if (apply_setting(device, oracle, settings[i]) < 0)
            return -1;
    return 0;
}

RadOracle open_oracle(RadDevice device, const char *oracle, enum RadRelease release,
                      char *const *settings, int count)
{
    RadOracle opened = open_oracle_replaced(device, oracle, release, NULL, 0);
    if (opened && set_oracle(device, opened, settings, count) < 0) {
        radReleaseOracle(opened);
        return NULL;
    }
    return opened;
}

RadOracle open_oracle_replaced(RadDevice device, const char *oracle, enum RadRelease release,
                               char *const *replacements, int count)
{
    RadOracle opened;
    if (count > 0 && release != RAD_RELEASE_HAND && (is_file(oracle) || radGetOracleText(oracle))) {
        opened =
            radLoadOracleReplaced(device, oracle, is_file(oracle) ? NULL : radGetOracleText(oracle),
                                  release, (const char *const *)replacements, count);
    } else if (release == RAD_RELEASE_HAND || !is_file(oracle)) {
        if (!radHasOracle(device, oracle, release))
            return refuse_oracle(device, oracle, release);
        opened = radNewOracle(device, oracle, release);
    } else if (strcmp(oracle, "-") != 0 && access(oracle, R_OK) != 0) {
        report_error(oracle, 0,
                     "cannot read the oracle: %s; check the name, `radiosity oracles` lists "
                     "those that need no file",
                     strerror(errno));
        return NULL;
    } else {
        opened = radLoadOracle(device, oracle, NULL, release);
    }
    return opened ? opened : refuse_graph(device, oracle);
}
