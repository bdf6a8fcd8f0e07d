/* json_value.h - JSON that others wrote, with the place of every value, for messages.
 * SPDX-License-Identifier: MIT */
#ifndef JSON_VALUE_H
#define JSON_VALUE_H

#include "base/internal.h"

enum json_kind { JSON_NULL, JSON_TRUTH, JSON_NUMBER, JSON_TEXT, JSON_LIST, JSON_OBJECT };

struct json_value {
    enum json_kind kind;
    struct where where;
    const char *name;         /* in an object */
    const char *text;         /* TEXT */
    double number;            /* NUMBER; TRUTH: 0 or 1 */
    struct json_value *first; /* LIST, OBJECT: what it holds, in its order */
    struct json_value *next;  /* in the same list or object */
};

/* The value that a source holds; NULL after an error. All is in the arena. */
const struct json_value *dag_read_json(struct dag *dag, int source);

/* Of an object, by name; NULL: there is none, or it is no object. */
const struct json_value *dag_json_member(const struct json_value *object, const char *name);

#endif
