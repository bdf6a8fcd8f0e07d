/* tune_parameters.c - see tune_parameters.h.
 * SPDX-License-Identifier: MIT */
#include "commands/tune_parameters.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options/option_table.h"
#include "util/report.h"

/* A parameter is looked for up to so many doublings from its default where no range is given: 64
 * times as much, or as little. */
enum { FARTHEST = 6 };

/* Only what is a real number above 0 has a logarithm to step along; what its author fixed stays. */
static int can_fit(const struct oracle_parameter *p)
{
    return !p->fixed && !p->integer && p->value > 0 && isfinite(p->value);
}

/* The names of those that can be fitted, or of all, for a message. */
static const char *names_of(const struct RadOracleReport *report, int all, char text[512])
{
    int length = 0;
    text[0] = 0;
    for (int i = 0; i < report->parameter_count && length < 512; i++)
        if (all || can_fit(&report->parameters[i]))
            length += snprintf(text + length, 512 - (size_t)length, "%s%s", length ? ", " : "",
                               report->parameters[i].name);
    return text;
}

/* Fit it from low to high, as far as it may have such values. Returns 0, or -1 after a message. */
static int add(struct tuner *t, const struct oracle_parameter *p, double low, double high)
{
    struct tune_parameter *to = &t->parameters[t->parameter_count];
    low = fmax(low, p->low);
    high = fmin(high, p->high);
    *to = (struct tune_parameter){.name = p->name, .value = p->value};
    for (int i = 0; i < t->parameter_count; i++)
        if (strcmp(t->parameters[i].name, p->name) == 0)
            return report_error("--param", 0, "%s is named twice; name it once", p->name);
    if (t->parameter_count == PATTERN_NUMBERS)
        return report_error("--param", 0, "more than %d parameters; fit some after the others",
                            (int)PATTERN_NUMBERS);
    int first = (int)floor(TUNE_QUARTERS * log2(fmax(low, 1e-300) / p->value)) - 1;
    int last = (int)ceil(TUNE_QUARTERS * log2(fmin(high, 1e300) / p->value)) + 1;
    while (first <= last && tune_value(to, first) < low)
        first++;
    while (first <= last && tune_value(to, last) > high)
        last--;
    if (first > last)
        return report_error("--param", 0,
                            "%s: no value between %g and %g; it is looked for at quarters of "
                            "doublings of its default %g, and may be from %g to %g",
                            p->name, low, high, p->value, p->low, p->high);
    to->low = first;
    to->high = last;
    t->parameter_count++;
    return 0;
}

/* As far as it is looked for where no range is given. Returns 0, or -1 after a message. */
static int add_unbounded(struct tuner *t, const struct oracle_parameter *p)
{
    const double times = exp2(FARTHEST);
    return add(t, p, p->value / times, p->value * times);
}

/* "NAME" or "NAME=LOW:HIGH". Returns 0, or -1 after a message. */
static int add_wanted(struct tuner *t, const struct RadOracleReport *report, const char *oracle,
                      const char *text)
{
    size_t length = strcspn(text, "=");
    char names[512];
    const struct oracle_parameter *p = NULL;
    for (int i = 0; i < report->parameter_count; i++)
        if (strlen(report->parameters[i].name) == length
            && memcmp(report->parameters[i].name, text, length) == 0)
            p = &report->parameters[i];
    if (!p)
        return report_error("--param", 0, "%s has no parameter %.*s; it has %s", oracle,
                            (int)length, text, names_of(report, 1, names));
    if (p->fixed)
        return report_error("--param", 0,
                            "%s is fixed by its author; take `fixed` away in a .dag file to fit it",
                            p->name);
    if (p->integer)
        return report_error("--param", 0,
                            "%s is a whole number, which is not fitted; try it by --set", p->name);
    if (!can_fit(p))
        return report_error("--param", 0,
                            "%s is %g, but it is looked for by factors; give it a default above 0 "
                            "in a .dag file",
                            p->name, p->value);
    if (!text[length])
        return add_unbounded(t, p);
    double low, high;
    return option_range(text + length + 1, &low, &high) < 0 ? -1 : add(t, p, low, high);
}

int tune_parameters(struct tuner *t, const char *name, char *const *wanted, int count)
{
    struct RadOracleReport report;
    char names[512];
    radGetOracleReport(t->oracle, &report);
    for (int i = 0; i < count; i++)
        if (add_wanted(t, &report, name, wanted[i]) < 0)
            return -1;
    for (int i = 0; i < report.parameter_count && count == 0; i++) {
        const struct oracle_parameter *p = &report.parameters[i];
        if (p->role == ROLE_LINK_THRESHOLD && can_fit(p) && add_unbounded(t, p) < 0)
            return -1;
    }
    if (t->parameter_count)
        return 0;
    if (!*names_of(&report, 0, names))
        return report_error(name, 0,
                            "no parameter can be fitted: none is a real number that is "
                            "above 0 by default; give one such a default in a .dag file");
    return report_error(name, 0,
                        "no parameter has the role link_threshold and a default above 0; say which "
                        "to fit by --param NAME: %s",
                        names);
}
