/* profile.c - see profile.h.
 *
 * Nodes are found by their names and held to be the same if tools and answers are: a profile of
 * another graph is refused at the first line that shows it.
 * SPDX-License-Identifier: MIT */
#include "analyse/profile.h"

#include <math.h>
#include <string.h>

#include "read/json_value.h"

const int dag_profile_widths[PROFILE_WIDTHS] = {4, 8, 16};

struct reading {
    struct dag *dag;
    const struct oracle_graph *oracle;
    struct profile *profile;
    unsigned char *seen; /* by place in the order */
};

/* The member that must be there, of that kind; NULL after an error. */
static const struct json_value *need_member(struct dag *dag, const struct json_value *object,
                                            const char *name, enum json_kind kind)
{
    static const char *const kinds[] = {
        [JSON_NUMBER] = "a number", [JSON_TEXT] = "a text", [JSON_LIST] = "a list"};
    const struct json_value *value = dag_json_member(object, name);
    if (value != NULL && value->kind == kind)
        return value;
    dag_error(dag, value != NULL ? value->where : object->where, "\"%s\" should be %s", name,
              kinds[kind]);
    return NULL;
}

/* A count or a time; -1 after an error. */
static double need_number(struct dag *dag, const struct json_value *object, const char *name)
{
    const struct json_value *value = need_member(dag, object, name, JSON_NUMBER);
    if (value != NULL && !(value->number >= 0)) {
        dag_error(dag, value->where, "\"%s\" should not be negative", name);
        return -1;
    }
    return value != NULL ? value->number : -1;
}

/* 0 where there is none. */
static double have_number(const struct json_value *object, const char *name)
{
    const struct json_value *value = dag_json_member(object, name);
    return value != NULL && value->kind == JSON_NUMBER && value->number > 0 ? value->number : 0;
}

static int find_oracle(struct dag *dag, const struct json_value *document)
{
    const struct json_value *name = need_member(dag, document, "oracle", JSON_TEXT);
    if (name == NULL) {
        dag_note(dag, dag_nowhere,
                 "a profile is what a program counted of the oracle, as "
                 "`radiosity solve --statistics FILE.json` writes it");
        return -1;
    }
    const int oracle = dag_oracle(dag, name->text);
    if (oracle < 0)
        dag_error(dag, name->where, "this is a profile of oracle %s, not of %s", name->text,
                  dag->oracles[0].name);
    return oracle;
}

/* The place of the node in the order, -1 after an error. */
static int find_place(struct reading *r, const struct json_value *node)
{
    const struct json_value *name = need_member(r->dag, node, "node", JSON_TEXT),
                            *tool = need_member(r->dag, node, "tool", JSON_TEXT);
    if (name == NULL || tool == NULL)
        return -1;
    for (int i = 0; i < r->oracle->order.count; i++) {
        const struct node *own = dag_node_at(r->dag, r->oracle, i);
        if (strcmp(own->name, name->text) != 0)
            continue;
        const char *asks = r->dag->tools[own->tool].name;
        if (strcmp(asks, tool->text) == 0 && !r->seen[i]) {
            r->seen[i] = 1;
            return i;
        }
        if (r->seen[i])
            dag_error(r->dag, name->where, "node %s a second time", name->text);
        else
            dag_error(r->dag, tool->where, "node %s of oracle %s asks %s, here it asked %s",
                      name->text, r->oracle->name, asks, tool->text);
        return -1;
    }
    dag_error(r->dag, name->where, "oracle %s has no node %s: this is a profile of another graph",
              r->oracle->name, name->text);
    return -1;
}

/* How often each answer was given; NULL after an error. */
static const double *read_answers(struct reading *r, const struct node *node,
                                  const struct json_value *value)
{
    const struct json_value *list = need_member(r->dag, value, "answers", JSON_LIST),
                            *at = list != NULL ? list->first : NULL;
    const struct answer *answers = &r->dag->answers[r->dag->tools[node->tool].answers.first];
    double *counts = dag_alloc(&r->dag->arena, (size_t)node->arcs.count * sizeof *counts + 1);
    if (list == NULL)
        return NULL;
    for (int i = 0; i < node->arcs.count; i++, at = at->next) {
        const struct json_value *name =
            at != NULL ? need_member(r->dag, at, "answer", JSON_TEXT) : NULL;
        if (at == NULL || (name != NULL && strcmp(name->text, answers[i].name) != 0)) {
            dag_error(r->dag, at != NULL ? name->where : list->where,
                      "answer %s of node %s is not there: this is a profile of another graph",
                      answers[i].name, node->name);
            return NULL;
        }
        if (name == NULL || (counts[i] = need_number(r->dag, at, "count")) < 0)
            return NULL;
    }
    return counts;
}

/* Do the counts agree with each other? What is shown are their quotients. */
static int agrees(struct reading *r, const struct node *node, const struct measured *measured,
                  const struct json_value *value)
{
    double sum = 0, most = measured->lists > 0 ? DAG_WAVE_PAIRS * measured->lists : INFINITY;
    for (int i = 0; i < node->arcs.count; i++)
        sum += measured->answers[i];
    if (sum != measured->calls) {
        dag_error(r->dag, value->where, "node %s was called %.15g times and answered %.15g times",
                  node->name, measured->calls, sum);
        return 0;
    }
    for (int k = 0; k < PROFILE_WIDTHS; k++)
        if (measured->vectors[k] > 0)
            most = fmin(most, dag_profile_widths[k] * measured->vectors[k]);
    if (measured->calls <= most)
        return 1;
    dag_error(r->dag, value->where,
              "node %s was called %.15g times, and its lists or vectors hold %.15g pairs at the "
              "most",
              node->name, measured->calls, most);
    return 0;
}

static int read_node(struct reading *r, const struct json_value *value)
{
    const int place = find_place(r, value);
    if (place < 0)
        return -1;
    const int index = r->dag->order[r->oracle->order.first + place];
    struct measured *measured = &r->profile->nodes[index];
    const struct json_value *vectors = dag_json_member(value, "vectors");
    measured->calls = need_number(r->dag, value, "calls");
    measured->seconds = have_number(value, "mean_seconds");
    measured->lists = have_number(value, "lists");
    for (int k = 0; vectors != NULL && k < PROFILE_WIDTHS; k++)
        measured->vectors[k] =
            have_number(vectors, dag_format(&r->dag->arena, "%d", dag_profile_widths[k]));
    measured->answers = read_answers(r, &r->dag->nodes[index], value);
    if (measured->calls < 0 || measured->answers == NULL)
        return -1;
    return agrees(r, &r->dag->nodes[index], measured, value) ? 0 : -1;
}

struct profile *dag_read_profile(struct dag *dag, const struct input *input)
{
    const int source = dag_read(dag, input);
    const struct json_value *document = source < 0 ? NULL : dag_read_json(dag, source), *nodes;
    struct reading r = {.dag = dag};
    const int oracle = document == NULL ? -1 : find_oracle(dag, document);
    if (oracle < 0 || (nodes = need_member(dag, document, "nodes", JSON_LIST)) == NULL)
        return NULL;
    r.oracle = &dag->oracles[oracle];
    r.seen = dag_alloc(&dag->arena, (size_t)r.oracle->order.count);
    r.profile = dag_alloc(&dag->arena, sizeof *r.profile);
    r.profile->oracle = oracle;
    r.profile->before = *r.oracle;
    r.profile->nodes = dag_alloc(&dag->arena, (size_t)dag->node_count * sizeof *r.profile->nodes);
    for (const struct json_value *at = nodes->first; at != NULL; at = at->next)
        if (read_node(&r, at) < 0)
            return NULL;
    for (int i = 0; i < r.oracle->order.count; i++)
        if (!r.seen[i]) {
            dag_error(dag, nodes->where, "node %s of oracle %s is not there",
                      dag_node_at(dag, r.oracle, i)->name, r.oracle->name);
            return NULL;
        }
    return r.profile;
}
