/* parse_guards.c - of a tool that guards: which of its answers allows which subdivision.
 *
 * A guard vouches for a measure of the pair, a whole number from 0 on that no subdivision raises
 * and that a subdivision which one of its answers allows lowers: how often an area can be quartered
 * before it is below a limit, how many levels of groups are left. What holds on paths is found in
 * analyse/analyse_guards.c.
 * SPDX-License-Identifier: MIT */
#include "read/parse.h"

/* NAME { mark NAME } */
static int parse_names(struct parser *parser, char mark, const char *what, struct span *span)
{
    struct dag *dag = parser->dag;
    span->first = dag->label_count;
    span->count = 0;
    do {
        struct label label = {0};
        if (!dag_expect_name(parser, what, &label.name, &label.where))
            return 0;
        int index = ADD(dag, labels, label_count);
        dag->labels[index] = label;
        span->count++;
    } while (dag_take(parser, mark));
    return 1;
}

/* allowed = NAME { "|" NAME } "->" NAME */
static int parse_allowed(struct parser *parser, struct tool *tool)
{
    struct dag *dag = parser->dag;
    struct span answers;
    struct label decision;
    if (!parse_names(parser, '|', "the name of an answer", &answers))
        return 0;
    if (parser->token.kind != TOKEN_ARROW)
        return dag_expected(parser, "'|' or '->' after an answer");
    dag_advance(parser);
    if (!dag_expect_name(parser, "the name of a decision", &decision.name, &decision.where))
        return 0;
    for (int i = 0; i < answers.count; i++) {
        struct guard guard = {0};
        guard.answer = dag->labels[answers.first + i];
        guard.decision = decision;
        guard.answer_index = guard.decision_index = -1;
        int index = ADD(dag, guards, guard_count);
        dag->guards[index] = guard;
        tool->guards.count++;
    }
    return 1;
}

int dag_parse_guards(struct parser *parser, struct tool *tool)
{
    struct dag *dag = parser->dag;
    if (tool->guards.count != 0) {
        dag_error(dag, parser->last, "a second 'guards': write one");
        tool->guards.count = 0;
    }
    tool->guards.first = dag->guard_count;
    if (!dag_at_mark(parser, '(')) {
        dag_error(dag, parser->last, "'guards' must say which answer allows which subdivision");
        dag_note(dag, dag_nowhere,
                 "write: guards (ANSWER -> DECISION, ...), as in: guards (receiver | both -> "
                 "subdivide_receiver, emitter | both -> subdivide_emitter)");
        return 1;
    }
    dag_advance(parser);
    do {
        if (!parse_allowed(parser, tool))
            return 0;
    } while (dag_take(parser, ','));
    if (!dag_expect(parser, ')', "or ',' after a decision"))
        return 0;
    if (dag_take_word(parser, "by")
        && (!dag_expect(parser, '(', "and parameters here")
            || !parse_names(parser, ',', "the name of a parameter", &tool->by)
            || !dag_expect(parser, ')', "or ',' after a parameter")))
        return 0;
    if (dag_take_word(parser, "after")
        && (!dag_expect_name(parser, "the name of a tool", &tool->after.name, &tool->after.where)
            || !dag_expect(parser, '(', "and its answers here")
            || !parse_names(parser, '|', "the name of an answer", &tool->after_answers)
            || !dag_expect(parser, ')', "or '|' after an answer")))
        return 0;
    return 1;
}
