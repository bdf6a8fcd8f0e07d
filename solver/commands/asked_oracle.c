/* asked_oracle.c - see asked_oracle.h.
 * SPDX-License-Identifier: MIT */
#include "commands/asked_oracle.h"

#include "util/open_oracle.h"
#include "util/parameter_file.h"

RadOracle open_asked_oracle(const struct options *o, RadDevice device, enum RadRelease release)
{
    RadOracle oracle =
        open_oracle_replaced(device, o->oracle, release, o->replacements, o->replacement_count);
    if (oracle
        && ((o->params && parameter_file_apply(o->params, device, oracle, o->oracle) < 0)
            || set_oracle(device, oracle, o->settings, o->setting_count) < 0)) {
        radReleaseOracle(oracle);
        return NULL;
    }
    return oracle;
}
