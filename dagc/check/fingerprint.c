/* fingerprint.c - one number for what a graph decides.
 *
 * 64-bit FNV-1a over the resolved graph: parameters, then the nodes in topological order with
 * tool, arguments and arcs. The names of the oracle and its nodes, documentation, layout,
 * comments and the order of the nodes in the text play no part; numbers enter with all bits.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "base/internal.h"

static void add_byte(uint64_t *hash, unsigned byte)
{
    *hash = (*hash ^ (byte & 0xff)) * UINT64_C(1099511628211);
}

static void add_integer(uint64_t *hash, uint64_t value)
{
    for (int i = 0; i < 8; i++)
        add_byte(hash, (unsigned)(value >> 8 * i));
}

static void add_number(uint64_t *hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    add_integer(hash, bits);
}

static void add_name(uint64_t *hash, const char *name)
{
    for (; *name != '\0'; name++)
        add_byte(hash, (unsigned char)*name);
    add_byte(hash, 0);
}

static void add_parameter(const struct dag *dag, uint64_t *hash, const struct parameter *parameter)
{
    const struct type *type = &dag->types[parameter->type];
    add_name(hash, parameter->name);
    add_byte(hash, type->base);
    for (int i = 0; i < UNIT_BASES; i++)
        add_byte(hash, (unsigned char)type->unit.exponent[i]);
    if (type->unit.size != 0 && type->unit.size != 1)
        add_number(hash, type->unit.size);
    add_number(hash, parameter->value);
    add_number(hash, parameter->low);
    add_number(hash, parameter->high);
}

/* Numbers and parameters as before there were others: their fingerprints stay. */
static void add_expression(const struct dag *dag, uint64_t *hash, const struct oracle_graph *oracle,
                           int expression)
{
    const struct expression *e = &dag->expressions[expression];
    add_byte(hash, e->kind);
    if (e->kind == EXPRESSION_NUMBER)
        add_number(hash, e->number);
    else if (e->kind == EXPRESSION_PARAMETER)
        add_integer(hash, (uint64_t)(e->parameter - oracle->parameters.first));
    else if (e->kind == EXPRESSION_FACT) {
        add_name(hash, dag->facts[e->index].name);
        add_name(hash, dag->facts[e->index].c);
    } else if (e->kind == EXPRESSION_TERM) {
        add_name(hash, dag->terms[e->index].name);
        add_integer(hash, (uint64_t)e->level);
    } else if (e->kind == EXPRESSION_EXTERN)
        add_name(hash, dag->callbacks[e->index].name);
    if (e->left >= 0)
        add_expression(dag, hash, oracle, e->left);
    if (e->right >= 0)
        add_expression(dag, hash, oracle, e->right);
}

static void add_node(const struct dag *dag, uint64_t *hash, const struct oracle_graph *oracle,
                     const struct node *node)
{
    const struct tool *tool = &dag->tools[node->tool];
    add_name(hash, tool->name);
    for (int i = 0; i < node->arguments.count; i++) {
        const struct argument *argument = &dag->arguments[node->arguments.first + i];
        add_name(hash, argument->name);
        add_expression(dag, hash, oracle, argument->expression);
    }
    for (int i = 0; i < node->arcs.count; i++) {
        const struct target *target = &dag->arcs[node->arcs.first + i].target;
        add_name(hash, dag->answers[tool->answers.first + i].name);
        add_byte(hash, target->kind);
        if (target->kind == TARGET_NODE)
            add_integer(hash, (uint64_t)dag->nodes[target->index].order);
        else
            add_name(hash, dag->decisions[target->index].name);
    }
}

void dag_fingerprint(struct dag *dag)
{
    for (int i = 0; i < dag->oracle_count; i++) {
        struct oracle_graph *oracle = &dag->oracles[i];
        uint64_t hash = UINT64_C(14695981039346656037);
        add_integer(&hash, (uint64_t)oracle->parameters.count);
        for (int p = 0; p < oracle->parameters.count; p++)
            add_parameter(dag, &hash, &dag->parameters[oracle->parameters.first + p]);
        for (int n = 0; n < oracle->order.count; n++)
            add_node(dag, &hash, oracle, &dag->nodes[dag->order[oracle->order.first + n]]);
        oracle->fingerprint = hash;
    }
}

void dag_fingerprint_text(const struct oracle_graph *oracle, char text[17])
{
    for (int i = 0; i < 16; i++)
        text[i] = "0123456789abcdef"[oracle->fingerprint >> (60 - 4 * i) & 15];
    text[16] = '\0';
}
