/* replace.c - nodes that somebody wants otherwise for once, without touching the file.
 *
 *     NODE = TOOL(arguments)            the node asks another tool; answers that both tools have
 *                                       lead where they led
 *     NODE = TOOL(arguments) { rules }  the same, with other rules
 *     NODE = ANSWER                     the node asks nothing: what led to it leads where this
 *                                       answer led
 *
 * Drafts are changed before their names are resolved, so that whatever was written is checked as if
 * it stood in the file. USE__NAME, a node of a branch in place, is one of many copies: the branch
 * is read once more from its text for this use alone, and changed there. [Turbet & Sillion,
 * section 4.3: tools "can be easily exchanged, added, replaced, deleted"]
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "read/parse.h"

/* What a graph is made of, wherever arrays move: an oracle, or a branch. */
struct place {
    int branch, index; /* branch 1: in branches, 0: in oracles */
    int draft;         /* in drafts */
};

static struct oracle_graph *graph_of(struct dag *dag, struct place place)
{
    return place.branch ? &dag->branches[place.index] : &dag->oracles[place.index];
}

static int find_branch(const struct dag *dag, const char *name)
{
    for (int i = 0; name != NULL && i < dag->branch_count; i++)
        if (strcmp(dag->branches[i].name, name) == 0)
            return i;
    return -1;
}

/* A branch that a node uses alone has a name that no file can give. */
static int is_own(const char *branch)
{
    return strchr(branch, ' ') != NULL;
}

/* The branch that the draft uses, read anew unless the draft has it alone. Returns its index, or -1
 * after an error. */
static int own_branch(struct dag *dag, int draft)
{
    int branch = find_branch(dag, dag->drafts[draft].tool_name);
    if (is_own(dag->branches[branch].name))
        return branch;
    const struct where where = dag->branches[branch].where;
    struct parser parser = {0};
    parser.dag = dag;
    parser.lexer = (struct lexer){dag, where.source, where.offset, 0};
    parser.content = CONTENT_ORACLES;
    if (!dag_parse_branch(&parser))
        return -1;
    struct oracle_graph *own = &dag->branches[dag->branch_count - 1];
    own->name = dag_format(&dag->arena, "%s in %s %d", own->name, dag->drafts[draft].name,
                           dag->branch_count);
    dag->drafts[draft].tool_name = own->name;
    return dag->branch_count - 1;
}

/* The node called `name` in the graph at *place or in branches below it; 1: *place is where. */
static int find_node(struct dag *dag, struct place *place, const char *name)
{
    const struct span drafts = graph_of(dag, *place)->drafts;
    for (int i = drafts.first; i < drafts.first + drafts.count; i++)
        if (strcmp(dag->drafts[i].name, name) == 0) {
            place->draft = i;
            return 1;
        }
    for (int i = drafts.first; i < drafts.first + drafts.count; i++) {
        size_t length = strlen(dag->drafts[i].name);
        int branch = find_branch(dag, dag->drafts[i].tool_name);
        if (branch < 0 || strncmp(name, dag->drafts[i].name, length) != 0
            || strncmp(name + length, "__", 2) != 0)
            continue;
        struct place inside = {1, branch, -1};
        if (!find_node(dag, &inside, name + length + 2))
            continue;
        branch = own_branch(dag, i);
        *place = (struct place){1, branch, -1};
        return branch >= 0 && find_node(dag, place, name + length + 2);
    }
    return 0;
}

enum { NAMES_SHOWN = 100, NESTED_SHOWN = 8 };

/* The names of all nodes, of branches in place, too. */
static void list_nodes(struct dag *dag, const struct oracle_graph *graph, const char *prefix,
                       struct suggestion *suggestion, const char **list, int *count, int nested)
{
    for (int i = 0; i < graph->drafts.count && nested < NESTED_SHOWN; i++) {
        const struct node *n = &dag->drafts[graph->drafts.first + i];
        const char *name = dag_format(&dag->arena, "%s%s", prefix, n->name);
        int branch = find_branch(dag, n->tool_name);
        dag_suggest(suggestion, name);
        if ((*count)++ < NAMES_SHOWN)
            *list = *list == NULL ? name : dag_format(&dag->arena, "%s, %s", *list, name);
        if (branch >= 0)
            list_nodes(dag, &dag->branches[branch], dag_format(&dag->arena, "%s__", name),
                       suggestion, list, count, nested + 1);
    }
}

static void unknown_node(struct dag *dag, const struct node *wanted)
{
    struct suggestion suggestion = {wanted->name, NULL, 0};
    const char *list = NULL;
    int count = 0;
    dag_error(dag, wanted->where, "there is no node '%s'", wanted->name);
    for (int i = 0; i < dag->oracle_count; i++)
        list_nodes(dag, &dag->oracles[i], "", &suggestion, &list, &count, 0);
    dag_note_suggestion(dag, &suggestion);
    if (list != NULL)
        dag_note(dag, dag_nowhere, "the nodes are: %s%s", list, count > NAMES_SHOWN ? ", ..." : "");
}

/* The answers of a tool, or the exits of a branch; count -1: there is none of that name. */
static struct span answers_of(const struct dag *dag, const char *tool)
{
    int index = tool == NULL ? -1 : dag_find(&dag->tool_names, tool), branch;
    if (index >= 0)
        return dag->tools[index].answers;
    branch = find_branch(dag, tool);
    return branch >= 0 ? dag->branches[branch].exits : (struct span){0, -1};
}

static int has_answer(const struct dag *dag, struct span answers, const char *name)
{
    for (int i = answers.first; i < answers.first + answers.count; i++)
        if (strcmp(dag->answers[i].name, name) == 0)
            return 1;
    return 0;
}

/* The rules of a node, without what another tool never answers. */
static struct span rules_for(struct dag *dag, struct span rules, struct span answers)
{
    struct span kept = {dag->rule_count, 0};
    for (int i = rules.first; i < rules.first + rules.count; i++) {
        struct rule rule = dag->rules[i];
        const struct span labels = rule.labels;
        rule.labels = (struct span){dag->label_count, 0};
        for (int k = labels.first; k < labels.first + labels.count; k++) {
            const struct label label = dag->labels[k];
            if (!has_answer(dag, answers, label.name))
                continue;
            int at = ADD(dag, labels, label_count);
            dag->labels[at] = label;
            rule.labels.count++;
        }
        if (labels.count > 0 && rule.labels.count == 0)
            continue;
        int at = ADD(dag, rules, rule_count);
        dag->rules[at] = rule;
        kept.count++;
    }
    return kept;
}

static void ask_another(struct dag *dag, int draft, const struct node *wanted)
{
    const struct span answers = answers_of(dag, wanted->tool_name);
    struct span rules = wanted->rules;
    if (rules.count == 0 && answers.count >= 0)
        rules = rules_for(dag, dag->drafts[draft].rules, answers);
    struct node *node = &dag->drafts[draft];
    node->where = wanted->where; /* of whatever is wrong with it now */
    node->tool_name = wanted->tool_name;
    node->tool_where = wanted->tool_where;
    node->written = wanted->written;
    node->rules = rules;
}

/* Where the node's rules send an answer; NULL: nowhere. */
static const struct target *target_of(const struct dag *dag, const struct node *node,
                                      const char *answer)
{
    const struct target *otherwise = NULL;
    for (int i = node->rules.first; i < node->rules.first + node->rules.count; i++) {
        const struct rule *rule = &dag->rules[i];
        if (rule->labels.count == 0)
            otherwise = &rule->target;
        for (int k = rule->labels.first; k < rule->labels.first + rule->labels.count; k++)
            if (strcmp(dag->labels[k].name, answer) == 0)
                return &rule->target;
    }
    return otherwise;
}

static void never_answers(struct dag *dag, const struct node *node, const struct node *wanted,
                          struct span answers)
{
    struct suggestion suggestion = {wanted->tool_name, NULL, 0};
    const char *list = "";
    dag_error(dag, wanted->tool_where, "%s of node '%s' never answers '%s'", node->tool_name,
              wanted->name, wanted->tool_name);
    for (int i = answers.first; i < answers.first + answers.count; i++) {
        const char *name = dag->answers[i].name;
        dag_suggest(&suggestion, name);
        list = i == answers.first ? name : dag_format(&dag->arena, "%s, %s", list, name);
    }
    dag_note_suggestion(dag, &suggestion);
    dag_note(dag, dag_nowhere, "its answers are: %s; another tool is written TOOL()", list);
}

/* What led to the node leads where its answer led. */
static void ask_nothing(struct dag *dag, struct place place, const struct node *wanted)
{
    const struct node *node = &dag->drafts[place.draft];
    struct oracle_graph *graph = graph_of(dag, place);
    const struct span answers = answers_of(dag, node->tool_name);
    const struct target *found = target_of(dag, node, wanted->tool_name);
    if (answers.count >= 0 && !has_answer(dag, answers, wanted->tool_name)) {
        never_answers(dag, node, wanted, answers);
        return;
    }
    if (found == NULL)
        return; /* the rules lack an answer, which is told where they are resolved */
    const struct target target = *found;
    for (int i = graph->drafts.first; i < graph->drafts.first + graph->drafts.count; i++) {
        const struct span rules = dag->drafts[i].rules;
        for (int k = rules.first; k < rules.first + rules.count; k++)
            if (strcmp(dag->rules[k].target.name, node->name) == 0)
                dag->rules[k].target.name = target.name;
    }
    if (graph->start.name != NULL && strcmp(graph->start.name, node->name) == 0) {
        graph->start.name = target.name;
        graph->start.where = wanted->where;
    }
}

static void replace(struct dag *dag, const char *text)
{
    int found = 0, source = dag_read_text(dag, "--replace", text, strlen(text));
    struct node wanted;
    if (source < 0 || !dag_parse_replacement(dag, source, &wanted))
        return;
    for (int i = 0; i < dag->oracle_count; i++) {
        struct place place = {0, i, -1};
        if (!find_node(dag, &place, wanted.name))
            continue;
        found = 1;
        if (wanted.written.first < 0)
            ask_nothing(dag, place, &wanted);
        else
            ask_another(dag, place.draft, &wanted);
    }
    if (!found && dag->error_count == 0)
        unknown_node(dag, &wanted);
}

void dag_replace(struct dag *dag)
{
    for (int i = 0; i < dag->replacement_count && dag->error_count == 0; i++)
        replace(dag, dag->replacements[i]);
}
