/* warn.h - which warnings are given, and as what.
 * SPDX-License-Identifier: MIT */
#ifndef WARN_H
#define WARN_H

#include "base/internal.h"

enum warning {
#define WARNING(number, name, level, says) WARNING_##number,
#include "base/warnings.def"
#undef WARNING
    WARNINGS
};

enum warning_level { LEVEL_OFF, LEVEL_WARN, LEVEL_ERROR };

struct warning_fact {
    const char *name, *says;
    enum warning_level level; /* unless a switch says otherwise */
};
extern const struct warning_fact dag_warning_facts[WARNINGS];

/* The switches of one compilation. */
struct warnings {
    unsigned char level[WARNINGS];  /* enum warning_level */
    unsigned char spared[WARNINGS]; /* -Wno-error=NAME: -Werror leaves it a warning */
    unsigned char all_errors;       /* -Werror */
};

void dag_warnings_default(struct warnings *warnings);
void dag_warnings_quiet(struct warnings *warnings); /* only what is an error unless switched */

/* Obeys what follows `-W`: NAME, no-NAME, error, error=NAME, no-error=NAME, all, no-all. Returns
 * NULL, or the name that no warning has; *nearest is then one like it, or NULL. */
const char *dag_warnings_switch(struct warnings *warnings, const char *what, const char **nearest);

/* `dagc -W`: each warning, whether it is on, what it says. */
void dag_warnings_list(FILE *out);

/* What the compilation does with a warning; OFF saves a pass the search for it. */
enum warning_level dag_warning_level(const struct dag *dag, enum warning warning);

/* Reports under the warning's switch. Returns whether it is shown, so that the caller looks for
 * the path that proves it, and adds its notes, only then. */
int dag_warn(struct dag *dag, enum warning warning, struct where where, const char *format, ...)
    PRINTF_LIKE(4, 5);

#endif
