/* statistics_read.c - see statistics_read.h. Who edits such a file by hand, or cuts it, is told the
 * line; a field that is missing or of another kind, where it stands.
 * SPDX-License-Identifier: MIT */
#include "output/statistics_read.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/statistics_json.h"
#include "util/report.h"
#include "util/text_file.h"

/* Says that a field is not as it should be. Returns -1. */
static int refuse(const char *path, const char *where, const char *field, const char *wanted)
{
    return report_error(path, 0, "%s: \"%s\" is not %s; write the file anew by solve --statistics",
                        where, field, wanted);
}

static int check_text(const char *path, const char *where, const json_t *object, const char *field)
{
    return json_is_string(json_object_get(object, field)) ? 0
                                                          : refuse(path, where, field, "a text");
}

/* A number that is not negative. */
static int check_number(const char *path, const char *where, const json_t *object,
                        const char *field)
{
    const json_t *value = json_object_get(object, field);
    return json_is_number(value) && json_number_value(value) >= 0
               ? 0
               : refuse(path, where, field, "a number from 0");
}

static int check_answers(const char *path, const char *node, const json_t *answers)
{
    size_t i;
    json_t *answer;
    if (!json_is_array(answers))
        return refuse(path, node, "answers", "a list");
    json_array_foreach(answers, i, answer)
    {
        if (check_text(path, node, answer, "answer") < 0
            || check_text(path, node, answer, "target") < 0
            || check_number(path, node, answer, "count") < 0)
            return -1;
    }
    return 0;
}

static int check_nodes(const char *path, const json_t *nodes)
{
    static const char *const numbers[] = {"calls",         "share",        "seconds",
                                          "seconds_share", "mean_seconds", "rays"};
    char where[128];
    size_t i, k;
    json_t *node, *count;
    if (!json_is_array(nodes))
        return refuse(path, "the document", "nodes", "a list");
    json_array_foreach(nodes, i, node)
    {
        snprintf(where, sizeof where, "node %zu", i + 1);
        if (check_text(path, where, node, "node") < 0)
            return -1;
        snprintf(where, sizeof where, "node %s", json_string_value(json_object_get(node, "node")));
        if (check_text(path, where, node, "tool") < 0)
            return -1;
        for (k = 0; k < sizeof numbers / sizeof *numbers; k++)
            if (check_number(path, where, node, numbers[k]) < 0)
                return -1;
        const char *term;
        if (!json_is_object(json_object_get(node, "terms")))
            return refuse(path, where, "terms", "an object");
        json_object_foreach(json_object_get(node, "terms"), term, count)
        {
            if (!json_is_integer(count))
                return refuse(path, where, term, "a whole number");
        }
        if (check_answers(path, where, json_object_get(node, "answers")) < 0)
            return -1;
    }
    return 0;
}

static int check(const char *path, const json_t *document)
{
    static const char *const numbers[] = {"discussions", "seconds", "rays", "timed_every"};
    const json_t *schema = json_object_get(document, "schema");
    if (!json_is_string(schema))
        return report_error(path, 1,
                            "no \"schema\": this is no file of solve --statistics FILE.json; give "
                            "one that it wrote");
    if (strcmp(json_string_value(schema), STATISTICS_SCHEMA) != 0)
        return report_error(path, 1, "schema %s, this program reads %s; write the file anew",
                            json_string_value(schema), STATISTICS_SCHEMA);
    if (check_text(path, "the document", document, "oracle") < 0
        || check_text(path, "the document", document, "scene") < 0)
        return -1;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (check_number(path, "the document", document, numbers[i]) < 0)
            return -1;
    return check_nodes(path, json_object_get(document, "nodes"));
}

json_t *statistics_read(const char *path)
{
    size_t size;
    char *text = text_file_need(path, &size);
    if (!text)
        return NULL;
    json_error_t error;
    json_t *document = json_loadb(text, size, JSON_REJECT_DUPLICATES, &error);
    free(text);
    if (!document) {
        report_error(path, error.line > 0 ? (uint32_t)error.line : 0,
                     "not JSON: %s; only what solve --statistics FILE.json wrote can be drawn",
                     error.text);
        return NULL;
    }
    if (check(path, document) == 0)
        return document;
    json_decref(document);
    return NULL;
}
