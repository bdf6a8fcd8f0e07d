/* explain_steps.c - see explain_steps.h.
 * SPDX-License-Identifier: MIT */
#include "commands/explain_steps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "output/explanation.h"
#include "util/array.h"
#include "util/device.h"
#include "util/open_oracle.h"
#include "util/report.h"

enum { LINE = 4096 };

static const char lesson[] = "  n, next           ask the next node; an empty line, too\n"
                             "  all               ask the rest\n"
                             "  set NAME=VALUE    change a parameter; `set` alone lists them\n"
                             "  replace NODE=...  ask another tool there, or give an answer\n"
                             "  again             hold the same discussion from its start\n"
                             "  p, pair R,E       another pair, as it stands now\n"
                             "  terms             what is known so far\n"
                             "  where             which pair, which node\n"
                             "  q, quit\n";

struct steps {
    const struct options *options;
    RadDevice device;
    RadSolution solution;
    RadOracle oracle;
    struct occasion *other;              /* of another pair, owned; NULL: the first */
    const struct discussion *discussion; /* what each is held from */
    char name[2][RAD_NAME];
    struct RadExplanation now;
    int at;              /* nodes that were asked of now.asked */
    char **replacements; /* the options', then those given here; owned */
    int replacement_count;
    size_t replacement_capacity;
    int quitting;
};

/* Hold the discussion from its start. Returns 0, or -1 after a message. */
static int discuss(struct steps *s)
{
    s->at = 0;
    return radExplain(s->solution, s->oracle, s->discussion, &s->now) < 0
               ? report_device(s->device, "explain")
               : 0;
}

static void say_where(const struct steps *s)
{
    printf("%s gets light from %s: ", s->name[0], s->name[1]);
    if (s->at < s->now.asked_count)
        printf("node %d of %d is next, %s\n", s->at + 1, s->now.asked_count,
               s->now.asked[s->at].node);
    else
        printf("decided after %d nodes, %s\n", s->now.asked_count, s->now.decision_name);
}

static int ask_next(struct steps *s, const char *argument)
{
    (void)argument;
    if (s->at >= s->now.asked_count) {
        say_where(s);
        return 0;
    }
    explanation_print_node(stdout, &s->now, s->at++);
    if (s->at == s->now.asked_count)
        explanation_print_decision(stdout, &s->now);
    return 0;
}

static int ask_rest(struct steps *s, const char *argument)
{
    do
        (void)ask_next(s, argument);
    while (s->at < s->now.asked_count);
    return 0;
}

/* A copy of `text` at the end of the replacements. Returns 0, or -1 after a message. */
static int append(struct steps *s, const char *text)
{
    char *copy = strdup(text);
    if (!copy
        || array_reserve(&s->replacements, (size_t)s->replacement_count + 1,
                         &s->replacement_capacity, sizeof *s->replacements)
               < 0) {
        free(copy);
        return report_error("explain", 0, "out of memory");
    }
    s->replacements[s->replacement_count++] = copy;
    return 0;
}

static int set(struct steps *s, const char *argument)
{
    struct RadOracleReport report;
    radGetOracleReport(s->oracle, &report);
    for (int i = 0; !*argument && i < report.parameter_count; i++) {
        const struct oracle_parameter *p = &report.parameters[i];
        printf("     %s = %g%s%s: %s\n", p->name, radGetOracleParameter(s->oracle, p->name),
               *p->unit ? " " : "", p->unit, p->doc);
    }
    if (!*argument)
        return 0;
    char *setting = (char *)(uintptr_t)argument;
    return set_oracle(s->device, s->oracle, &setting, 1) < 0 ? -1 : discuss(s);
}

static int replace(struct steps *s, const char *argument)
{
    if (!*argument)
        return report_error("replace", 0, "write NODE=TOOL(...) or NODE=ANSWER");
    if (append(s, argument) < 0)
        return -1;
    RadOracle oracle = open_oracle_replaced(s->device, s->options->oracle, RAD_RELEASE_DAG,
                                            s->replacements, s->replacement_count);
    if (!oracle) {
        free(s->replacements[--s->replacement_count]);
        return -1;
    }
    struct RadOracleReport report;
    radGetOracleReport(s->oracle, &report);
    for (int i = 0; i < report.parameter_count; i++) {
        const char *name = report.parameters[i].name;
        if (!report.parameters[i].fixed) /* to set one fails, and the next message would say so */
            (void)radSetOracleParameter(oracle, name, radGetOracleParameter(s->oracle, name));
    }
    radReleaseOracle(s->oracle);
    s->oracle = oracle;
    return discuss(s);
}

static int again(struct steps *s, const char *argument)
{
    (void)argument;
    if (discuss(s) < 0)
        return -1;
    printf("again: %d nodes, %s\n", s->now.asked_count, s->now.decision_name);
    return 0;
}

static int change_pair(struct steps *s, const char *argument)
{
    char name[2][RAD_NAME];
    uint32_t element[2];
    if (watch_split(argument, name) < 0)
        return report_error("pair", 0, "'%s' is no pair; write RECEIVER,EMITTER, as 12/0,3",
                            argument);
    for (int i = 0; i < 2; i++)
        if (radFindElement(s->solution, name[i], &element[i]) < 0)
            return report_device(s->device, "pair");
    struct occasion *other = occasion_hold(s->device, s->solution, s->oracle, element, "pair");
    if (!other)
        return -1;
    occasion_free(s->other);
    s->other = other;
    s->discussion = &other->discussion;
    memcpy(s->name, name, sizeof name);
    if (discuss(s) < 0)
        return -1;
    say_where(s);
    return 0;
}

/* Terms as the nodes that were asked have left them. */
static int show_terms(struct steps *s, const char *argument)
{
    (void)argument;
    if (s->at == s->now.asked_count) {
        explanation_print_terms(stdout, s->now.terms, s->now.term_count);
        return 0;
    }
    int shown = 0;
    for (int i = 0; i < s->at; i++)
        for (int k = 0; k < s->now.asked[i].term_count; k++) {
            const struct RadTerm *t = &s->now.asked[i].terms[k];
            int later = 0;
            for (int j = i + 1; j < s->at; j++)
                for (int m = 0; m < s->now.asked[j].term_count; m++)
                    later |= strcmp(s->now.asked[j].terms[m].name, t->name) == 0;
            if (later || !t->level)
                continue;
            explanation_print_terms(stdout, t, 1);
            shown++;
        }
    if (!shown)
        explanation_print_terms(stdout, NULL, 0);
    return 0;
}

static int where(struct steps *s, const char *argument)
{
    (void)argument;
    say_where(s);
    return 0;
}

static int quit(struct steps *s, const char *argument)
{
    (void)argument;
    s->quitting = 1;
    return 0;
}

static int help(struct steps *s, const char *argument)
{
    (void)s;
    (void)argument;
    fputs(lesson, stdout);
    return 0;
}

static int obey(struct steps *s, char *line)
{
    static const struct {
        const char *word;
        int (*obey)(struct steps *s, const char *argument);
        int takes; /* an argument */
    } commands[] = {{"n", ask_next, 0},       {"next", ask_next, 0}, {"", ask_next, 0},
                    {"all", ask_rest, 0},     {"set", set, 1},       {"replace", replace, 1},
                    {"again", again, 0},      {"p", change_pair, 1}, {"pair", change_pair, 1},
                    {"terms", show_terms, 0}, {"where", where, 0},   {"quit", quit, 0},
                    {"q", quit, 0},           {"help", help, 0}};
    char *word = line + strspn(line, " \t\r\n"), *end = word + strcspn(word, " \t\r\n");
    char *argument = end + strspn(end, " \t\r\n");
    size_t length = strlen(argument);
    while (length && strchr(" \t\r\n", argument[length - 1]))
        argument[--length] = 0;
    *end = 0;
    for (size_t i = 0; i < sizeof commands / sizeof *commands; i++) {
        if (strcmp(word, commands[i].word) != 0)
            continue;
        if (*argument && !commands[i].takes)
            return report_error(word, 0, "takes nothing, not '%s'; help lists the commands",
                                argument);
        return commands[i].obey(s, argument);
    }
    return report_error("explain", 0, "there is no command '%s'; help lists them", word);
}

int explain_steps(const struct options *o, RadDevice device, RadSolution solution, RadOracle oracle,
                  const struct occasion *first)
{
    struct steps s = {.options = o,
                      .device = device,
                      .solution = solution,
                      .oracle = oracle,
                      .discussion = &first->discussion};
    int status = 0, refused = 0, prompt = isatty(STDIN_FILENO);
    char line[LINE];
    radRetainOracle(oracle);
    for (int i = 0; i < o->replacement_count; i++)
        status |= append(&s, o->replacements[i]) < 0;
    status |= radGetElementName(solution, first->receiver, s.name[0]) < 0
              || radGetElementName(solution, first->emitter, s.name[1]) < 0 || discuss(&s) < 0;
    if (!status && s.now.way != first->way)
        printf("held again, the parts below it being what they are now, it goes another way:\n");
    if (!status)
        say_where(&s);
    while (!status && !s.quitting) {
        if (prompt) {
            printf("explain> ");
            fflush(stdout);
        }
        if (!fgets(line, sizeof line, stdin))
            break;
        fflush(stdout);
        refused |= obey(&s, line) < 0; /* the commands behind it are obeyed, too */
    }
    for (int i = 0; i < s.replacement_count; i++)
        free(s.replacements[i]);
    free(s.replacements);
    occasion_free(s.other);
    radReleaseOracle(s.oracle);
    return status || (refused && !prompt);
}
