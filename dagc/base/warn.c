/* warn.c - warnings by name: their switches, their list, their way to the sink of messages.
 *
 * After gcc: a later switch wins over an earlier one, -Werror leaves alone what -Wno-error=NAME
 * spares, and each message ends with the switch that it obeys.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/warn.h"

const struct warning_fact dag_warning_facts[WARNINGS] = {
#define WARNING(number, name, level, says) {name, says, LEVEL_##level},
#include "base/warnings.def"
#undef WARNING
};

void dag_warnings_default(struct warnings *warnings)
{
    memset(warnings, 0, sizeof *warnings);
    for (int i = 0; i < WARNINGS; i++)
        warnings->level[i] = (unsigned char)dag_warning_facts[i].level;
}

void dag_warnings_quiet(struct warnings *warnings)
{
    dag_warnings_default(warnings);
    for (int i = 0; i < WARNINGS; i++)
        if (warnings->level[i] == LEVEL_WARN)
            warnings->level[i] = LEVEL_OFF;
}

/* The warning of that name; -1: none, and *nearest is one like it or NULL. */
static int find(const char *name, const char **nearest)
{
    struct suggestion suggestion = {name, NULL, 0};
    for (int i = 0; i < WARNINGS; i++) {
        if (strcmp(dag_warning_facts[i].name, name) == 0)
            return i;
        dag_suggest(&suggestion, dag_warning_facts[i].name);
    }
    *nearest = suggestion.best;
    return -1;
}

/* The rest of text after prefix, NULL when it does not begin so. */
static const char *after(const char *text, const char *prefix)
{
    size_t length = strlen(prefix);
    return strncmp(text, prefix, length) == 0 ? text + length : NULL;
}

const char *dag_warnings_switch(struct warnings *warnings, const char *what, const char **nearest)
{
    const char *no = after(what, "no-");
    if (strcmp(what, "error") == 0 || strcmp(what, "no-error") == 0) {
        warnings->all_errors = no == NULL;
        return NULL;
    }
    if (strcmp(what, "all") == 0 || strcmp(what, "no-all") == 0) {
        for (int i = 0; i < WARNINGS; i++)
            if (no != NULL)
                warnings->level[i] = LEVEL_OFF;
            else if (warnings->level[i] == LEVEL_OFF)
                warnings->level[i] = LEVEL_WARN;
        return NULL;
    }
    const char *name;
    int index;
    if ((name = after(what, "error=")) != NULL) {
        if ((index = find(name, nearest)) < 0)
            return name;
        warnings->level[index] = LEVEL_ERROR;
        warnings->spared[index] = 0;
    } else if ((name = after(what, "no-error=")) != NULL) {
        if ((index = find(name, nearest)) < 0)
            return name;
        if (warnings->level[index] == LEVEL_ERROR)
            warnings->level[index] = LEVEL_WARN;
        warnings->spared[index] = 1;
    } else {
        name = no != NULL ? no : what;
        if ((index = find(name, nearest)) < 0)
            return name;
        if (no != NULL)
            warnings->level[index] = LEVEL_OFF;
        else if (warnings->level[index] == LEVEL_OFF)
            warnings->level[index] = LEVEL_WARN;
    }
    return NULL;
}

void dag_warnings_list(FILE *out)
{
    static const char *const words[] = {"off", "on", "error"};
    for (int i = 0; i < WARNINGS; i++)
        fprintf(out, "  %-18s %-6s %s\n", dag_warning_facts[i].name,
                words[dag_warning_facts[i].level], dag_warning_facts[i].says);
}

enum warning_level dag_warning_level(const struct dag *dag, enum warning warning)
{
    const struct warnings *warnings = dag->warnings;
    if (warnings == NULL)
        return dag_warning_facts[warning].level == LEVEL_ERROR ? LEVEL_ERROR : LEVEL_OFF;
    if (warnings->level[warning] == LEVEL_WARN && warnings->all_errors
        && !warnings->spared[warning])
        return LEVEL_ERROR;
    return (enum warning_level)warnings->level[warning];
}

/* A branch's nodes are copied wherever it is used; what is wrong in it is said once. */
static int said_of_another_use(const struct dag *dag, enum warning warning, struct where where)
{
    const char *name = dag_warning_facts[warning].name;
    for (int i = 0; dag->use >= 0 && i < dag->diagnostic_count; i++) {
        const struct diagnostic *said = &dag->diagnostics[i];
        const char *tail = strrchr(said->message, '[');
        if (said->where.source == where.source && said->where.offset == where.offset
            && said->use != dag->use && tail != NULL && strstr(tail, name) != NULL)
            return 1;
    }
    return 0;
}

int dag_warn(struct dag *dag, enum warning warning, struct where where, const char *format, ...)
{
    enum warning_level level = dag_warning_level(dag, warning);
    if (level == LEVEL_OFF || said_of_another_use(dag, warning, where))
        return 0;
    enum severity severity = level == LEVEL_ERROR ? SEVERITY_ERROR : SEVERITY_WARNING;
    if (dag_is_full(dag, severity)) {
        dag_report(dag, severity, where, "");
        return 0;
    }
    /* An error by a switch names that switch; one by its nature is named by how to be rid of it. */
    int forced = level == LEVEL_ERROR && dag_warning_facts[warning].level != LEVEL_ERROR;
    va_list arguments;
    va_start(arguments, format);
    const char *message = dag_vformat(&dag->arena, format, arguments);
    va_end(arguments);
    return dag_report(dag, severity, where,
                      dag_format(&dag->arena, "%s [-W%s%s]", message, forced ? "error=" : "",
                                 dag_warning_facts[warning].name));
}
