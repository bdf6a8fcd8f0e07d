/* c_names.c - the names that a C text defines, and the same text with a prefix before them.
 *
 * This is no parser, and need not be one: a name is given the prefix in all places or in none, so
 * that one which is overlooked costs nothing but its prefix, and only what is defined here beyond
 * doubt may be taken: a function with a body, an initialised object, a type, an enumerator, a tag
 * with a body, a macro. What is only declared is the program's, and keeps its name; so does a macro
 * that is never expanded and stands before an #include of the system's: it speaks to that, as
 * NDEBUG does.
 * A field is never renamed.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "emit/c_text.h"

/* The tokens that are neither blank nor directive. */
struct line {
    const struct c_token **items;
    int count;
};

static int is_mark(const struct line *line, int at, char mark)
{
    return at >= 0 && at < line->count && line->items[at]->kind == C_MARK
           && *line->items[at]->text == mark;
}

static int is_word(const struct line *line, int at, const char *word)
{
    return at >= 0 && at < line->count && dag_c_is(line->items[at], word);
}

/* A name that is neither a keyword nor the compiler's own. */
static int is_name(struct dag *dag, const struct line *line, int at)
{
    return at >= 0 && at < line->count && line->items[at]->kind == C_NAME
           && *line->items[at]->text != '_'
           && !dag_is_c_word(dag_c_copy_name(dag, line->items[at]->text));
}

static void add(struct dag *dag, struct table *table, const struct c_token *token)
{
    dag_put(&dag->arena, table, dag_c_copy_name(dag, token->text), 1);
}

/* The bracket that closes the one at `at`; the end when none does. */
static int closing(const struct line *line, int at)
{
    int depth = 0;
    for (; at < line->count; at++) {
        depth += is_mark(line, at, '(') || is_mark(line, at, '[') || is_mark(line, at, '{');
        depth -= is_mark(line, at, ')') || is_mark(line, at, ']') || is_mark(line, at, '}');
        if (depth == 0)
            break;
    }
    return at;
}

static int opening(const struct line *line, int at)
{
    int depth = 0;
    for (; at >= 0; at--) {
        depth -= is_mark(line, at, '(') || is_mark(line, at, '[') || is_mark(line, at, '{');
        depth += is_mark(line, at, ')') || is_mark(line, at, ']') || is_mark(line, at, '}');
        if (depth == 0)
            break;
    }
    return at;
}

/* TYPE NAME(...) [__attribute__((...))] before the `{` at `brace`; -1: no function's. */
static int function_name(struct dag *dag, const struct line *line, int begin, int brace)
{
    int at = brace - 1;
    while (is_mark(line, at, ')')) {
        int name = opening(line, at) - 1;
        if (name <= begin)
            return -1;
        if (is_name(dag, line, name))
            return line->items[name - 1]->kind == C_NAME || is_mark(line, name - 1, '*') ? name
                                                                                         : -1;
        if (*line->items[name]->text != '_')
            return -1;
        at = name - 1;
    }
    return -1;
}

/* typedef TYPE NAME, typedef TYPE NAME[...], typedef TYPE (*NAME)(...) */
static void add_types(struct dag *dag, struct c_names *names, const struct line *line, int begin,
                      int end)
{
    int any = 0;
    for (int at = begin + 1; at < end; at++) {
        if (is_mark(line, at, '(') && is_mark(line, at + 1, '*') && !any) {
            int name = at + 1;
            while (is_mark(line, name, '*') || is_mark(line, name, '(')
                   || is_word(line, name, "const"))
                name++;
            if (is_name(dag, line, name))
                add(dag, &names->ordinary, line->items[name]);
            any = 1;
        } else if (is_name(dag, line, at) && !any
                   && (is_mark(line, at + 1, ';') || is_mark(line, at + 1, ',')
                       || is_mark(line, at + 1, '[') || is_mark(line, at + 1, '(')
                       || (at + 1 < end && *line->items[at + 1]->text == '_'))) {
            add(dag, &names->ordinary, line->items[at]);
            any = 1;
        } else if (is_mark(line, at, ','))
            any = 0;
        if (is_mark(line, at, '{') || is_mark(line, at, '(') || is_mark(line, at, '['))
            at = closing(line, at);
    }
}

/* NAME = ..., NAME[...] = ... */
static void add_object(struct dag *dag, struct c_names *names, const struct line *line, int begin,
                       int equals)
{
    int at = equals - 1;
    while (at > begin && is_mark(line, at, ']'))
        at = opening(line, at) - 1;
    if (at > begin && is_name(dag, line, at))
        add(dag, &names->ordinary, line->items[at]);
}

/* One declaration or definition from `begin` on: where the next begins. */
static int add_declaration(struct dag *dag, struct c_names *names, const struct line *line,
                           int begin)
{
    int at = begin, equals = -1, type = is_word(line, begin, "typedef");
    for (; at < line->count && !is_mark(line, at, ';'); at++) {
        if (is_mark(line, at, '=') && equals < 0)
            equals = at;
        if (is_mark(line, at, '{') && equals < 0 && !type) {
            int name = function_name(dag, line, begin, at);
            if (name >= 0) {
                add(dag, &names->ordinary, line->items[name]);
                return closing(line, at) + 1;
            }
        }
        if (is_mark(line, at, '{') || is_mark(line, at, '(') || is_mark(line, at, '['))
            at = closing(line, at);
    }
    if (type)
        add_types(dag, names, line, begin, at);
    else if (equals >= 0)
        add_object(dag, names, line, begin, equals);
    return at + 1;
}

/* Tags with a body, and enumerators, wherever they stand. */
static void add_tags(struct dag *dag, struct c_names *names, const struct line *line)
{
    for (int at = 0; at < line->count; at++) {
        int is_enum = is_word(line, at, "enum");
        if (!is_enum && !is_word(line, at, "struct") && !is_word(line, at, "union"))
            continue;
        int name = at + 1, open = name;
        while (is_word(line, name, "__attribute__"))
            name = open = closing(line, name + 1) + 1;
        if (is_name(dag, line, name))
            open = name + 1;
        if (is_enum && is_mark(line, open, ':')) /* enum NAME : TYPE */
            for (int k = 0; k < 4 && !is_mark(line, open, '{'); k++)
                open++;
        if (!is_mark(line, open, '{'))
            continue;
        if (open > name)
            add(dag, &names->tags, line->items[name]);
        int close = closing(line, open), first = 1;
        for (int k = open + 1; is_enum && k < close; k++) {
            if (first && is_name(dag, line, k))
                add(dag, &names->ordinary, line->items[k]);
            first = is_mark(line, k, ',');
            if (is_mark(line, k, '(') || is_mark(line, k, '{'))
                k = closing(line, k);
        }
    }
}

/* #define NAME; and which names other lines hold. */
static void add_directive(struct dag *dag, struct c_names *names, const struct c_token *token)
{
    const char *name = dag_c_directive(token, "define"), *from = token->text + 1;
    if (dag_c_directive(token, "undef") != NULL || dag_c_directive(token, "ifdef") != NULL
        || dag_c_directive(token, "ifndef") != NULL || dag_c_directive(token, "include") != NULL
        || dag_c_directive(token, "error") != NULL)
        return;
    if (name != NULL) {
        const char *copy = dag_c_copy_name(dag, name);
        if (*copy != '_' && *copy != '\0')
            dag_put(&dag->arena, &names->macros, copy, 1);
        from = name + strlen(copy);
    }
    struct c_tokens inside = dag_c_tokens(dag, from, (size_t)(token->text + token->length - from));
    for (int i = 0; i < inside.count; i++)
        if (inside.items[i].kind == C_NAME
            && !(i >= 2 && dag_c_is(&inside.items[i - 2], "defined")) /* defined (NAME) */
            && !(i >= 1 && dag_c_is(&inside.items[i - 1], "defined")))
            add(dag, &names->expanded, &inside.items[i]);
}

/* What is defined behind the last #include <...> is for nobody else, and so is a file's guard. */
static void add_own_macros(struct dag *dag, struct c_names *names, const struct c_tokens *tokens)
{
    const char *guard = NULL;
    int own = 1, directives = 0;
    for (int i = tokens->count - 1; i >= 0; i--) {
        const char *what = dag_c_directive(&tokens->items[i], "include");
        own &= what == NULL || *what != '<';
        what = dag_c_directive(&tokens->items[i], "define");
        if (what != NULL && own)
            dag_put(&dag->arena, &names->expanded, dag_c_copy_name(dag, what), 1);
    }
    for (int i = 0; i < tokens->count && directives < 2; i++) {
        const struct c_token *token = &tokens->items[i];
        directives += token->kind == C_DIRECTIVE;
        if (directives == 1 && dag_c_directive(token, "ifndef") != NULL)
            guard = dag_c_copy_name(dag, dag_c_directive(token, "ifndef"));
        if (guard != NULL && dag_c_directive(token, "define") != NULL
            && strcmp(guard, dag_c_copy_name(dag, dag_c_directive(token, "define"))) == 0)
            dag_put(&dag->arena, &names->expanded, guard, 1);
    }
}

void dag_c_collect(struct dag *dag, struct c_names *names, const struct c_tokens *tokens)
{
    struct line line = {NULL, 0};
    for (int i = 0; i < tokens->count; i++) {
        const struct c_token *token = &tokens->items[i];
        if (token->kind == C_DIRECTIVE)
            add_directive(dag, names, token);
        else if (token->kind != C_SPACE && token->kind != C_COMMENT) {
            line.items = dag_grow(&dag->arena, line.items, line.count, sizeof *line.items);
            line.items[line.count++] = token;
            if (token->kind == C_NAME)
                add(dag, &names->expanded, token);
        }
    }
    add_own_macros(dag, names, tokens);
    add_tags(dag, names, &line);
    for (int at = 0; at < line.count;)
        if (is_mark(&line, at, ';') || is_mark(&line, at, '}'))
            at++;
        else if (is_word(&line, at, "extern") && at + 1 < line.count
                 && line.items[at + 1]->kind == C_LITERAL && is_mark(&line, at + 2, '{'))
            at += 3; /* what stands in it is at file scope */
        else
            at = add_declaration(dag, names, &line, at);
}

/* ---- the prefix */

static int is_defined(const struct c_names *names, const char *name)
{
    return dag_find(&names->tags, name) >= 0 || dag_find(&names->ordinary, name) >= 0
           || dag_find(&names->macros, name) >= 0;
}

/* PREFIX_NAME for what is all capitals, prefix_name for the rest. A name that begins so keeps
 * itself; another that would become the same gets the prefix once more. */
static void print_name(struct dag *dag, struct text *out, const struct c_token *token,
                       const struct c_names *names, const char *prefix)
{
    size_t length = strlen(prefix);
    const char *name = dag_c_copy_name(dag, token->text);
    int small = 0;
    for (size_t i = 0; i < token->length; i++)
        small |= islower((unsigned char)token->text[i]);
    const char *before = small ? prefix : dag_c_upper(dag, prefix);
    if (token->length <= length + 1 || strncmp(name, before, length) != 0 || name[length] != '_')
        do
            name = dag_format(&dag->arena, "%s_%s", before, name);
        while (is_defined(names, name));
    dag_print(out, "%s", name);
}

static int has_prefix(struct dag *dag, const struct c_names *names, const struct c_token *token,
                      const struct c_token *before)
{
    const char *name = dag_c_copy_name(dag, token->text);
    if (dag_find(&names->macros, name) >= 0)
        return dag_find(&names->expanded, name) >= 0;
    if (before != NULL
        && (dag_c_is(before, "struct") || dag_c_is(before, "enum") || dag_c_is(before, "union")))
        return dag_find(&names->tags, name) >= 0;
    return !token->member && dag_find(&names->ordinary, name) >= 0;
}

void dag_c_print(struct dag *dag, struct text *out, const struct c_token *token,
                 const struct c_token *before, const struct c_names *names, const char *prefix)
{
    if (token->kind == C_NAME && has_prefix(dag, names, token, before))
        print_name(dag, out, token, names, prefix);
    else if (token->kind == C_DIRECTIVE && dag_c_directive(token, "include") == NULL
             && dag_c_directive(token, "error") == NULL) {
        struct c_tokens inside = dag_c_tokens(dag, token->text + 1, token->length - 1);
        const struct c_token *last = NULL;
        dag_print(out, "#");
        for (int i = 0; i < inside.count; i++) {
            dag_c_print(dag, out, &inside.items[i], last, names, prefix);
            if (inside.items[i].kind != C_SPACE && inside.items[i].kind != C_COMMENT)
                last = &inside.items[i];
        }
    } else
        dag_print(out, "%.*s", (int)token->length, token->text);
}
