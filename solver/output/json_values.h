/* json_values.h - values that several of the command's JSON files hold.
 * SPDX-License-Identifier: MIT */
#ifndef JSON_VALUES_H
#define JSON_VALUES_H

#include <jansson.h>

#include "radiosity.h"

/* JSON has no INFINITY and no NAN: they are null. */
json_t *json_finite(double value);

/* An object's member, which is a text; "" where there is none. The object's. */
const char *json_word(const json_t *object, const char *key);

/* A name; of one that is no UTF-8, as files' names may be, what is ASCII, and ? for the rest. */
json_t *json_text(const char *text);

/* The values of all parameters of the oracle, by name. */
json_t *oracle_parameters_json(RadOracle oracle);

#endif
