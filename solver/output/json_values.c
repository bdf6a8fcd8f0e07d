/* json_values.c - see json_values.h.
 * SPDX-License-Identifier: MIT */
#include "output/json_values.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

json_t *json_finite(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

const char *json_word(const json_t *object, const char *key)
{
    const char *text = json_string_value(json_object_get(object, key));
    return text ? text : "";
}

json_t *json_text(const char *text)
{
    json_t *whole = json_string(text);
    char *plain = whole ? NULL : strdup(text);
    for (char *c = plain; c && *c; c++)
        if ((unsigned char)*c > 127)
            *c = '?';
    if (plain)
        whole = json_string(plain);
    free(plain);
    return whole;
}

json_t *oracle_parameters_json(RadOracle oracle)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    json_t *values = json_object();
    for (int i = 0; i < report.parameter_count; i++) {
        const char *name = report.parameters[i].name;
        json_object_set_new(values, name, json_finite(radGetOracleParameter(oracle, name)));
    }
    return values;
}
