/* c_items.c - C text taken apart into top-level items.
 *
 * Not a parser: it knows comments, literals, brackets and directives, and that is enough for
 * headers written plainly: one declaration per item, no macro that opens or closes a bracket.
 * Tags and ordinary names are two name spaces, as in C; members are left alone, since a name
 * after `.` or `->` is never renamed and members are not top-level declarations.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "emit/c_items.h"

enum c_kind { C_END, C_SPACE, C_COMMENT, C_NAME, C_NUMBER, C_LITERAL, C_DIRECTIVE, C_MARK };

struct c_token {
    enum c_kind kind;
    const char *text;
    size_t length;
};

static int is_letter(char c)
{
    return isalpha((unsigned char)c) || c == '_';
}

static int is_name_byte(char c)
{
    return is_letter(c) || isdigit((unsigned char)c);
}

/* `at` starts a line when only blanks stand before it. */
static int starts_line(const char *begin, const char *at)
{
    while (at > begin && (at[-1] == ' ' || at[-1] == '\t'))
        at--;
    return at == begin || at[-1] == '\n';
}

static struct c_token next_token(const char *begin, const char *at, const char *end)
{
    struct c_token token = {C_MARK, at, 1};
    const char *p = at + 1;
    if (at >= end) {
        token.kind = C_END;
        token.length = 0;
        return token;
    }
    if (isspace((unsigned char)*at)) {
        token.kind = C_SPACE;
        while (p < end && isspace((unsigned char)*p))
            p++;
    } else if (at[0] == '/' && p < end && *p == '*') {
        token.kind = C_COMMENT;
        for (p++; p + 1 < end && !(p[0] == '*' && p[1] == '/'); p++)
            ;
        p = p + 1 < end ? p + 2 : end;
    } else if (at[0] == '/' && p < end && *p == '/') {
        token.kind = C_COMMENT;
        while (p < end && *p != '\n')
            p++;
    } else if (is_letter(*at)) {
        token.kind = C_NAME;
        while (p < end && is_name_byte(*p))
            p++;
    } else if (isdigit((unsigned char)*at)
               || (*at == '.' && p < end && isdigit((unsigned char)*p))) {
        token.kind = C_NUMBER;
        while (p < end
               && (is_name_byte(*p) || *p == '.'
                   || ((*p == '+' || *p == '-') && strchr("eEpP", p[-1]) != NULL)))
            p++;
    } else if (*at == '"' || *at == '\'') {
        token.kind = C_LITERAL;
        for (; p < end && *p != *at && *p != '\n'; p++)
            if (*p == '\\' && p + 1 < end)
                p++;
        p = p < end ? p + 1 : end;
    } else if (*at == '#' && starts_line(begin, at)) {
        token.kind = C_DIRECTIVE;
        while (p < end && !(*p == '\n' && p[-1] != '\\')) {
            if (p[0] == '/' && p + 1 < end && p[1] == '*') /* a comment may run over lines */
                for (p += 2; p + 1 < end && !(p[0] == '*' && p[1] == '/'); p++)
                    ;
            p++;
        }
    }
    token.length = (size_t)(p - at);
    return token;
}

static int is_word(const struct c_token *token, const char *word)
{
    return token->length == strlen(word) && memcmp(token->text, word, token->length) == 0;
}

/* What a directive says after `#` and blanks, if it is `word`; else NULL. */
static const char *directive(const struct c_token *token, const char *word)
{
    const char *at = token->text + 1, *end = token->text + token->length;
    size_t length = strlen(word);
    while (at < end && (*at == ' ' || *at == '\t'))
        at++;
    if ((size_t)(end - at) < length || memcmp(at, word, length) != 0
        || (at + length < end && is_name_byte(at[length])))
        return NULL;
    for (at += length; at < end && (*at == ' ' || *at == '\t'); at++)
        ;
    return at;
}

static const char *copy_name(struct c_items *items, const char *text)
{
    size_t length = 0;
    while (is_name_byte(text[length]))
        length++;
    return dag_copy(&items->dag->arena, text, length);
}

static void declare(struct c_items *items, struct table *table, const char *text, int item)
{
    dag_put(&items->dag->arena, table, copy_name(items, text), item);
}

/* ---- one item */

/* Everything that directives of the item define. */
static void declare_defines(struct c_items *items, int item, const char *text, size_t length)
{
    const char *end = text + length;
    for (const char *at = text; at < end;) {
        struct c_token token = next_token(text, at, end);
        const char *name = token.kind == C_DIRECTIVE ? directive(&token, "define") : NULL;
        if (name != NULL)
            declare(items, &items->names, name, item);
        at += token.length;
    }
}

static int is_tag_word(const struct c_token *token)
{
    return is_word(token, "struct") || is_word(token, "enum") || is_word(token, "union");
}

/* Tags that get a body, enumerators, and the one function, object or type that is declared. */
static void declare_names(struct c_items *items, int item, const char *text, size_t length)
{
    const char *end = text + length, *declared = NULL;
    struct c_token before = {C_MARK, "", 0}, two_before = before;
    int depth = 0, enumerators = 0, settled = 0;
    for (const char *at = text; at < end;) {
        struct c_token token = next_token(text, at, end);
        at += token.length;
        if (token.kind == C_SPACE || token.kind == C_COMMENT || token.kind == C_DIRECTIVE)
            continue;
        char mark = token.kind == C_MARK ? *token.text : '\0';
        if (mark == '{' && before.kind == C_NAME && is_tag_word(&two_before))
            declare(items, &items->tags, before.text, item);
        if (mark == '{' && depth == 0)
            enumerators = is_word(&two_before, "enum") || is_word(&before, "enum");
        if (depth == 1 && enumerators && before.kind == C_NAME
            && (mark == ',' || mark == '=' || mark == '}'))
            declare(items, &items->names, before.text, item);
        if (depth == 1 && enumerators && mark == ',')
            enumerators = 1;
        if (depth == 0 && !settled && before.kind == C_NAME && !is_tag_word(&two_before)
            && !is_word(&before, "__attribute__")
            && (mark == '(' || mark == '[' || mark == '=' || mark == ';')) {
            declared = before.text;
            settled = 1;
        }
        depth += mark == '{' || mark == '(' || mark == '[';
        depth -= mark == '}' || mark == ')' || mark == ']';
        two_before = before;
        before = token;
    }
    if (declared != NULL)
        declare(items, &items->names, declared, item);
}

static void add_item(struct c_items *items, int file, const char *begin, const char *end)
{
    struct dag *dag = items->dag;
    while (begin < end && isspace((unsigned char)*begin))
        begin++;
    if (begin == end)
        return;
    items->items = dag_grow(&dag->arena, items->items, items->item_count, sizeof *items->items);
    struct c_item *item = &items->items[items->item_count++];
    item->text = begin;
    item->length = (size_t)(end - begin);
    item->file = file;
    declare_defines(items, items->item_count - 1, begin, item->length);
    declare_names(items, items->item_count - 1, begin, item->length);
}

/* Up to the end of the declaration that starts at `at`: its `;`, or a function's `}`. */
static const char *end_of_declaration(const char *begin, const char *at, const char *end)
{
    struct c_token before = {C_MARK, "", 0};
    int depth = 0, function = 0;
    while (at < end) {
        struct c_token token = next_token(begin, at, end);
        at += token.length;
        if (token.kind == C_SPACE || token.kind == C_COMMENT)
            continue;
        char mark = token.kind == C_MARK ? *token.text : '\0';
        if (mark == '{' && depth == 0)
            function = before.kind == C_MARK && *before.text == ')';
        depth += mark == '{' || mark == '(' || mark == '[';
        depth -= mark == '}' || mark == ')' || mark == ']';
        if (depth == 0 && (mark == ';' || (mark == '}' && function)))
            break;
        before = token;
    }
    /* A comment on the same line belongs to it. */
    struct c_token blank = next_token(begin, at, end);
    const char *after = blank.kind == C_SPACE && memchr(blank.text, '\n', blank.length) == NULL
                            ? at + blank.length
                            : at;
    struct c_token comment = next_token(begin, after, end);
    return comment.kind == C_COMMENT && after != at ? after + comment.length : at;
}

/* Up to the #endif that closes the #if at `at`. */
static const char *end_of_condition(const char *begin, const char *at, const char *end)
{
    int depth = 0;
    while (at < end) {
        struct c_token token = next_token(begin, at, end);
        at += token.length;
        if (token.kind != C_DIRECTIVE)
            continue;
        depth += directive(&token, "if") != NULL || directive(&token, "ifdef") != NULL
                 || directive(&token, "ifndef") != NULL;
        depth -= directive(&token, "endif") != NULL;
        if (depth == 0)
            break;
    }
    return at;
}

/* ---- a file */

/* The first comment, without a line that names a licence: what is generated is its user's. */
static const char *idea_of(struct c_items *items, const struct c_token *comment)
{
    const char *spdx = NULL;
    for (const char *at = comment->text; at < comment->text + comment->length; at++)
        if (strncmp(at, "SPDX", 4) == 0)
            spdx = at;
    if (spdx == NULL)
        return dag_copy(&items->dag->arena, comment->text, comment->length);
    while (spdx > comment->text && (spdx[-1] == ' ' || spdx[-1] == '*' || spdx[-1] == '\n'))
        spdx--;
    const char *head = dag_copy(&items->dag->arena, comment->text, (size_t)(spdx - comment->text));
    return *head == '\0' || strcmp(head, "/") == 0 ? NULL
                                                   : dag_format(&items->dag->arena, "%s */", head);
}

static void add_system(struct c_items *items, const char *text)
{
    const char *close = strchr(text, '>');
    const char *name =
        close == NULL ? "" : dag_copy(&items->dag->arena, text, (size_t)(close - text) + 1);
    for (int i = 0; i < items->system_count; i++)
        if (strcmp(items->system[i], name) == 0)
            return;
    items->system =
        dag_grow(&items->dag->arena, items->system, items->system_count, sizeof *items->system);
    items->system[items->system_count++] = name;
}

void dag_items_add(struct c_items *items, const char *name, const char *text,
                   void (*include)(struct c_items *items, const char *name, void *context),
                   void *context)
{
    const char *end = text + strlen(text), *from = NULL, *at = text;
    const char *guard = NULL;
    int file = items->file_count, first = 1;
    items->files =
        dag_grow(&items->dag->arena, items->files, items->file_count, sizeof *items->files);
    items->files[items->file_count++].name = name;
    while (at < end) {
        struct c_token token = next_token(text, at, end);
        if (token.kind == C_COMMENT && first) {
            items->files[file].idea = idea_of(items, &token);
            first = 0;
        } else if (token.kind == C_COMMENT && from == NULL)
            from = at;
        else if (token.kind == C_DIRECTIVE) {
            const char *what;
            if ((what = directive(&token, "include")) != NULL && *what == '"') {
                const char *close = strchr(what + 1, '"');
                if (close != NULL)
                    include(items,
                            dag_copy(&items->dag->arena, what + 1, (size_t)(close - what - 1)),
                            context);
                from = NULL;
            } else if (what != NULL) {
                add_system(items, what);
                from = NULL;
            } else if (guard == NULL && (what = directive(&token, "ifndef")) != NULL) {
                guard = copy_name(items, what); /* the file's own: its lines go */
                from = NULL;
            } else if ((what = directive(&token, "define")) != NULL) {
                const char *defined = copy_name(items, what);
                if (guard == NULL || strcmp(defined, guard) != 0)
                    add_item(items, file, from != NULL ? from : at, at + token.length);
                from = NULL;
            } else if (directive(&token, "if") != NULL || directive(&token, "ifdef") != NULL) {
                const char *close = end_of_condition(text, at, end);
                add_item(items, file, from != NULL ? from : at, close);
                token.length = (size_t)(close - at);
                from = NULL;
            }
        } else if (token.kind != C_SPACE && token.kind != C_COMMENT) {
            const char *close = end_of_declaration(text, at, end);
            add_item(items, file, from != NULL ? from : at, close);
            token.length = (size_t)(close - at);
            from = NULL;
        }
        first &= token.kind == C_SPACE;
        at += token.length;
    }
}

/* ---- what is needed, and under which name */

/* Is it a member's name, given what stands before it? */
static int is_member(const struct c_token *before)
{
    return before->kind == C_MARK
           && (*before->text == '.' || (*before->text == '>' && before->text[-1] == '-'));
}

/* The item that declares the name at a token; -1: nobody does, or it is a member. */
static int declared_by(const struct c_items *items, const struct c_token *token,
                       const struct c_token *before)
{
    char name[256];
    if (token->length >= sizeof name)
        return -1;
    memcpy(name, token->text, token->length);
    name[token->length] = '\0';
    if (is_tag_word(before))
        return dag_find(&items->tags, name);
    if (is_member(before))
        return -1;
    return dag_find(&items->names, name);
}

static void reach(struct c_items *items, int index, int reached_by)
{
    struct c_item *item = &items->items[index];
    if ((item->reached_by & reached_by) != 0)
        return;
    item->kept = 1;
    item->reached_by = (unsigned char)(item->reached_by | reached_by);
    const char *text = item->text, *end = text + item->length;
    struct c_token before = {C_MARK, " ", 1};
    for (const char *at = text; at < end;) {
        struct c_token token = next_token(text, at, end);
        at += token.length;
        if (token.kind == C_DIRECTIVE) { /* look inside: #define ALIAS name */
            token.length = 1;
            at = token.text + 1;
        }
        if (token.kind == C_SPACE || token.kind == C_COMMENT)
            continue;
        if (token.kind == C_NAME) {
            int by = declared_by(items, &token, &before);
            if (by >= 0)
                reach(items, by, reached_by);
            if (is_member(&before))
                dag_put(&items->dag->arena, &items->members, copy_name(items, token.text), 1);
        }
        before = token;
    }
}

void dag_items_keep(struct c_items *items, const char *file, int reached_by)
{
    for (int i = 0; i < items->item_count; i++)
        if (strcmp(items->files[items->items[i].file].name, file) == 0)
            reach(items, i, reached_by);
}

/* PREFIX_NAME for what is all capitals, prefix_name for the rest; once only. */
static void print_name(struct text *out, const struct c_token *token, const char *prefix)
{
    size_t length = strlen(prefix);
    int small = 0;
    for (size_t i = 0; i < token->length; i++)
        small |= islower((unsigned char)token->text[i]);
    int has = token->length > length + 1 && token->text[length] == '_';
    for (size_t i = 0; has && i < length; i++)
        has = small ? token->text[i] == prefix[i]
                    : token->text[i] == (char)toupper((unsigned char)prefix[i]);
    if (!has && small)
        dag_print(out, "%s_", prefix);
    else if (!has) {
        dag_print_upper(out, prefix);
        dag_print(out, "_");
    }
    dag_print(out, "%.*s", (int)token->length, token->text);
}

void dag_items_print(struct c_items *items, struct c_item *item, struct text *out,
                     const char *prefix)
{
    const char *text = item->text, *end = text + item->length;
    struct c_token before = {C_MARK, " ", 1};
    struct c_file *file = &items->files[item->file];
    if (!file->shown && file->idea != NULL && strcmp(file->name, "catalog.h") != 0)
        dag_print(out, "\n%s\n", file->idea);
    file->shown = 1;
    dag_print(out, "\n");
    for (const char *at = text; at < end;) {
        struct c_token token = next_token(text, at, end);
        if (token.kind == C_DIRECTIVE)
            token.length = 1;
        at += token.length;
        if (token.kind == C_NAME && declared_by(items, &token, &before) >= 0)
            print_name(out, &token, prefix);
        else
            dag_print(out, "%.*s", (int)token.length, token.text);
        if (token.kind != C_SPACE && token.kind != C_COMMENT)
            before = token;
    }
    dag_print(out, "\n");
    item->shown = 1;
}
