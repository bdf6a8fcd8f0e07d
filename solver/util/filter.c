/* filter.c - see filter.h.
 *
 * Recursive descent to a list of nodes; each knows its type. A bare name that is no name of a value
 * may be a word: which one is known once the other side of the comparison is.
 * SPDX-License-Identifier: MIT */
#include "util/filter.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES_MOST = 256, DEEPEST = 64, NAMES_TOLD = 600 };

enum operation {
    OF_NUMBER,
    OF_STRING, /* in quotes */
    OF_BARE,   /* a name that is none of a value */
    OF_VALUE,  /* index: in names */
    OF_NEGATE,
    OF_NOT,
    OF_ADD,
    OF_SUBTRACT,
    OF_MULTIPLY,
    OF_DIVIDE,
    OF_EQUAL,
    OF_UNEQUAL,
    OF_LESS,
    OF_LESS_EQUAL,
    OF_MORE,
    OF_MORE_EQUAL,
    OF_AND,
    OF_OR
};

enum type {
    IS_NUMBER = FILTER_NUMBER,
    IS_WORD = FILTER_WORD,
    IS_TEXT = FILTER_TEXT,
    IS_TRUTH,
    IS_BARE
};

struct node {
    enum operation of;
    enum type type;
    int left, right;  /* in nodes */
    size_t index;     /* VALUE: in names */
    double number;    /* NUMBER; of words their number */
    const char *text; /* in the filter's copy */
    size_t length;
    int column; /* from 1 */
};

struct filter {
    char *text; /* what was read; strings in it are ended by 0 once all is read */
    const struct filter_name *names;
    size_t count;
    struct node nodes[NODES_MOST];
    int node_count, top;
};

struct reader {
    struct filter *f;
    const char *at;
    int depth;
    char *cause;
    size_t size;
};

static int column(const struct reader *r, const char *at)
{
    return (int)(at - r->f->text) + 1;
}

/* Returns -1. The first complaint stays. */
static int wrong(struct reader *r, int where, const char *format, ...)
{
    va_list list;
    if (*r->cause)
        return -1;
    int used = snprintf(r->cause, r->size, "column %d: ", where);
    va_start(list, format);
    vsnprintf(r->cause + used, r->size - (size_t)used, format, list);
    va_end(list);
    return -1;
}

static int add(struct reader *r, struct node node)
{
    if (r->f->node_count == NODES_MOST)
        return wrong(r, node.column, "the condition has more than %d parts", NODES_MOST);
    r->f->nodes[r->f->node_count] = node;
    return r->f->node_count++;
}

static void skip(struct reader *r)
{
    while (isspace((unsigned char)*r->at))
        r->at++;
}

static int accept(struct reader *r, const char *mark)
{
    skip(r);
    if (strncmp(r->at, mark, strlen(mark)) != 0)
        return 0;
    r->at += strlen(mark);
    return 1;
}

static int read_condition(struct reader *r);

static int is_name(char c)
{
    return isalnum((unsigned char)c) || c == '_' || c == '.';
}

static int read_name(struct reader *r)
{
    const char *from = r->at;
    while (is_name(*r->at))
        r->at++;
    struct node node = {.of = OF_BARE,
                        .type = IS_BARE,
                        .text = from,
                        .length = (size_t)(r->at - from),
                        .column = column(r, from)};
    for (size_t i = 0; i < r->f->count; i++)
        if (strlen(r->f->names[i].name) == node.length
            && memcmp(r->f->names[i].name, from, node.length) == 0) {
            node.of = OF_VALUE;
            node.index = i;
            node.type = (enum type)r->f->names[i].type;
            break;
        }
    return add(r, node);
}

/* A number, a string, a name or a condition in parentheses. */
static int read_primary(struct reader *r)
{
    skip(r);
    const char *from = r->at;
    if (isdigit((unsigned char)*from) || (*from == '.' && isdigit((unsigned char)from[1]))) {
        char *end;
        struct node node = {.of = OF_NUMBER, .type = IS_NUMBER, .column = column(r, from)};
        node.number = strtod(from, &end);
        r->at = end;
        if (is_name(*end))
            return wrong(r, column(r, from), "'%.*s' is no number", (int)(end - from) + 1, from);
        return add(r, node);
    }
    if (isalpha((unsigned char)*from) || *from == '_')
        return read_name(r);
    if (*from == '"' || *from == '\'') {
        const char *end = strchr(from + 1, *from);
        if (!end)
            return wrong(r, column(r, from), "the text has no end: a second %c is missing", *from);
        r->at = end + 1;
        return add(r, (struct node){.of = OF_STRING,
                                    .type = IS_TEXT,
                                    .text = from + 1,
                                    .length = (size_t)(end - from - 1),
                                    .column = column(r, from)});
    }
    if (accept(r, "(")) {
        if (++r->depth > DEEPEST)
            return wrong(r, column(r, from), "more than %d parentheses in each other", DEEPEST);
        int inside = read_condition(r);
        r->depth--;
        if (inside >= 0 && !accept(r, ")"))
            return wrong(r, column(r, r->at), "a ')' is missing");
        return inside;
    }
    return *from ? wrong(r, column(r, from), "a value is wanted here, not '%c'", *from)
                 : wrong(r, column(r, from), "a value is missing at the end");
}

/* Must be a number. Returns 0 or -1. */
static int want_number(struct reader *r, int node, const char *what)
{
    const struct node *n = &r->f->nodes[node];
    if (n->type == IS_NUMBER)
        return 0;
    if (n->type == IS_BARE) {
        char names[NAMES_TOLD] = "";
        size_t used = 0;
        for (size_t i = 0; i < r->f->count && used + 1 < sizeof names; i++)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", i ? ", " : "",
                                     r->f->names[i].name);
        return wrong(r, n->column, "there is no '%.*s'; there are %s%s", (int)n->length, n->text,
                     names, used >= sizeof names ? "..." : "");
    }
    return wrong(r, n->column, "%s takes numbers", what);
}

static int read_sign(struct reader *r)
{
    skip(r);
    const char *from = r->at;
    if (!accept(r, "-"))
        return read_primary(r);
    if (++r->depth > DEEPEST)
        return wrong(r, column(r, from), "more than %d signs in a row", DEEPEST);
    int of = read_sign(r);
    r->depth--;
    if (of < 0 || want_number(r, of, "-") < 0)
        return -1;
    return add(r, (struct node){
                      .of = OF_NEGATE, .type = IS_NUMBER, .left = of, .column = column(r, from)});
}

/* Two operands of numbers, from left to right. */
static int read_chain(struct reader *r, int (*part)(struct reader *), const char *marks,
                      const enum operation of[2])
{
    int left = part(r);
    while (left >= 0) {
        skip(r);
        const char *from = r->at, mark[2] = {*from, 0};
        if (!*from || !strchr(marks, *from))
            break;
        r->at++;
        int right = part(r);
        if (right < 0 || want_number(r, left, mark) < 0 || want_number(r, right, mark) < 0)
            return -1;
        left = add(r, (struct node){.of = of[*from != marks[0]],
                                    .type = IS_NUMBER,
                                    .left = left,
                                    .right = right,
                                    .column = column(r, from)});
    }
    return left;
}

static int read_product(struct reader *r)
{
    static const enum operation of[2] = {OF_MULTIPLY, OF_DIVIDE};
    return read_chain(r, read_sign, "*/", of);
}

static int read_sum(struct reader *r)
{
    static const enum operation of[2] = {OF_ADD, OF_SUBTRACT};
    return read_chain(r, read_product, "+-", of);
}

/* The word that the bare name is, of the value that it is compared with. Returns 0 or -1. */
static int find_word(struct reader *r, int bare, int value)
{
    struct node *b = &r->f->nodes[bare];
    const struct filter_name *name = &r->f->names[r->f->nodes[value].index];
    char words[NAMES_TOLD] = "";
    size_t used = 0;
    for (int i = 0; name->words[i]; i++) {
        if (strlen(name->words[i]) == b->length
            && memcmp(name->words[i], b->text, b->length) == 0) {
            b->of = OF_NUMBER;
            b->type = IS_WORD;
            b->number = i;
            return 0;
        }
        if (used + 1 < sizeof words)
            used += (size_t)snprintf(words + used, sizeof words - used, "%s%s", i ? ", " : "",
                                     name->words[i]);
    }
    return wrong(r, b->column, "%s is never '%.*s'; it is one of %s", name->name, (int)b->length,
                 b->text, words);
}

/* May the two be compared so? Returns 0 or -1. */
static int check_comparison(struct reader *r, int left, int right, const char *mark, int where)
{
    const struct node *nodes = r->f->nodes;
    const int equality = mark[1] == '=' && (mark[0] == '=' || mark[0] == '!');
    if (nodes[left].of == OF_VALUE && nodes[left].type == IS_WORD && nodes[right].type == IS_BARE) {
        if (find_word(r, right, left) < 0)
            return -1;
    } else if (nodes[right].of == OF_VALUE && nodes[right].type == IS_WORD
               && nodes[left].type == IS_BARE) {
        if (find_word(r, left, right) < 0)
            return -1;
    }
    if (nodes[left].type == IS_BARE || nodes[right].type == IS_BARE)
        return want_number(r, nodes[left].type == IS_BARE ? left : right, mark);
    if (nodes[left].type != nodes[right].type || nodes[left].type == IS_TRUTH)
        return wrong(r, where,
                     "'%s' compares numbers, or a name of words with one of its words, or a name "
                     "of text with text in quotes",
                     mark);
    if (nodes[left].type == IS_WORD && nodes[left].of == OF_VALUE && nodes[right].of == OF_VALUE)
        return wrong(r, where, "'%s': words of two names cannot be compared", mark);
    if (nodes[left].type != IS_NUMBER && !equality)
        return wrong(r, where, "'%s' compares numbers; words and texts take == and !=", mark);
    return 0;
}

static int read_comparison(struct reader *r)
{
    static const struct {
        const char *mark;
        enum operation of;
    } marks[] = {{"==", OF_EQUAL},      {"!=", OF_UNEQUAL}, {"<=", OF_LESS_EQUAL},
                 {">=", OF_MORE_EQUAL}, {"<", OF_LESS},     {">", OF_MORE}};
    int left = read_sum(r);
    if (left < 0)
        return -1;
    skip(r);
    const char *from = r->at;
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        if (!accept(r, marks[i].mark))
            continue;
        int right = read_sum(r);
        if (right < 0 || check_comparison(r, left, right, marks[i].mark, column(r, from)) < 0)
            return -1;
        return add(r, (struct node){.of = marks[i].of,
                                    .type = IS_TRUTH,
                                    .left = left,
                                    .right = right,
                                    .column = column(r, from)});
    }
    if (*from == '=')
        return wrong(r, column(r, from), "'=' is no comparison; write ==");
    return left;
}

/* Must be true or false. Returns 0 or -1. */
static int want_truth(struct reader *r, int node)
{
    const struct node *n = &r->f->nodes[node];
    if (n->type == IS_TRUTH)
        return 0;
    if (n->type == IS_BARE)
        return want_number(r, node, "");
    return wrong(r, n->column, "a comparison is wanted here, such as depth > 8");
}

static int read_not(struct reader *r)
{
    skip(r);
    const char *from = r->at;
    if (*from != '!' || from[1] == '=')
        return read_comparison(r);
    r->at++;
    if (++r->depth > DEEPEST)
        return wrong(r, column(r, from), "more than %d '!' in a row", DEEPEST);
    int of = read_not(r);
    r->depth--;
    if (of < 0 || want_truth(r, of) < 0)
        return -1;
    return add(
        r, (struct node){.of = OF_NOT, .type = IS_TRUTH, .left = of, .column = column(r, from)});
}

static int read_both(struct reader *r, int (*part)(struct reader *), const char *mark,
                     enum operation of)
{
    int left = part(r);
    while (left >= 0) {
        skip(r);
        const char *from = r->at;
        if (!accept(r, mark))
            break;
        int right = part(r);
        if (right < 0 || want_truth(r, left) < 0 || want_truth(r, right) < 0)
            return -1;
        left = add(r, (struct node){.of = of,
                                    .type = IS_TRUTH,
                                    .left = left,
                                    .right = right,
                                    .column = column(r, from)});
    }
    return left;
}

static int read_and(struct reader *r)
{
    return read_both(r, read_not, "&&", OF_AND);
}

static int read_condition(struct reader *r)
{
    return read_both(r, read_and, "||", OF_OR);
}

struct filter *filter_read(const char *text, const struct filter_name *names, size_t count,
                           char *cause, size_t size)
{
    struct filter *f = calloc(1, sizeof *f);
    if (f)
        f->text = malloc(strlen(text) + 1);
    *cause = 0;
    if (!f || !f->text) {
        snprintf(cause, size, "out of memory");
        free(f);
        return NULL;
    }
    strcpy(f->text, text);
    f->names = names;
    f->count = count;
    struct reader r = {f, f->text, 0, cause, size};
    f->top = read_condition(&r);
    skip(&r);
    if (f->top >= 0 && *r.at)
        f->top = wrong(&r, column(&r, r.at), "'%.20s' is not understood; && and || join conditions",
                       r.at);
    if (f->top >= 0 && want_truth(&r, f->top) < 0)
        f->top = -1;
    if (f->top < 0) {
        filter_free(f);
        return NULL;
    }
    for (int i = 0; i < f->node_count; i++)
        if (f->nodes[i].of == OF_STRING)
            f->text[f->nodes[i].text - f->text + (ptrdiff_t)f->nodes[i].length] = 0;
    return f;
}

static const char *text_of(const struct filter *f, int node, const struct filter_value *values)
{
    const struct node *n = &f->nodes[node];
    return n->of == OF_VALUE ? values[n->index].text : n->text;
}

static double evaluate(const struct filter *f, int node, const struct filter_value *values)
{
    const struct node *n = &f->nodes[node];
    if (n->of == OF_NUMBER || n->of == OF_STRING || n->of == OF_BARE)
        return n->number;
    if (n->of == OF_VALUE)
        return values[n->index].number;
    if (n->of == OF_AND || n->of == OF_OR) { /* both sides are without effects */
        int left = evaluate(f, n->left, values) != 0;
        return left == (n->of == OF_OR) ? left : evaluate(f, n->right, values) != 0;
    }
    if (f->nodes[n->left].type == IS_TEXT) {
        const char *a = text_of(f, n->left, values), *b = text_of(f, n->right, values);
        return (strcmp(a, b) == 0) == (n->of == OF_EQUAL);
    }
    const double a = evaluate(f, n->left, values),
                 b = n->of == OF_NEGATE || n->of == OF_NOT ? 0 : evaluate(f, n->right, values);
    switch (n->of) {
    case OF_NEGATE:
        return -a;
    case OF_NOT:
        return a == 0;
    case OF_ADD:
        return a + b;
    case OF_SUBTRACT:
        return a - b;
    case OF_MULTIPLY:
        return a * b;
    case OF_DIVIDE:
        return a / b;
    case OF_EQUAL:
        return a == b;
    case OF_UNEQUAL:
        return isnan(a) || isnan(b) ? 0 : a != b;
    case OF_LESS:
        return a < b;
    case OF_LESS_EQUAL:
        return a <= b;
    case OF_MORE:
        return a > b;
    default:
        return a >= b;
    }
}

int filter_holds(const struct filter *f, const struct filter_value *values)
{
    return evaluate(f, f->top, values) != 0;
}

void filter_free(struct filter *f)
{
    if (f)
        free(f->text);
    free(f);
}
