/* c_text.c - C text as tokens.
 *
 * Blanks, comments, literals and directives are told apart as in C; nothing is expanded. Which
 * names are those of fields is seen from their place alone: behind `.` or `->`, or declared in the
 * body of a structure.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "emit/c_text.h"

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
    struct c_token token = {C_MARK, at, 1, 0};
    const char *p = at + 1;
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
        while (p < end && !(*p == '\n' && p[-1] != '\\'))
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
            if (p[0] == '/' && p + 1 < end && p[1] == '*') { /* may run over lines */
                for (p += 2; p + 1 < end && !(p[0] == '*' && p[1] == '/'); p++)
                    ;
                p = p + 1 < end ? p + 1 : end - 1;
            }
            p++;
        }
    }
    token.length = (size_t)(p - at);
    return token;
}

int dag_c_is(const struct c_token *token, const char *word)
{
    return token->length == strlen(word) && memcmp(token->text, word, token->length) == 0;
}

const char *dag_c_directive(const struct c_token *token, const char *word)
{
    if (token->kind != C_DIRECTIVE)
        return NULL;
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

const char *dag_c_copy_name(struct dag *dag, const char *text)
{
    size_t length = 0;
    while (is_name_byte(text[length]))
        length++;
    return dag_copy(&dag->arena, text, length);
}

const char *dag_c_upper(struct dag *dag, const char *name)
{
    size_t length = strlen(name);
    char *upper = dag_alloc(&dag->arena, length + 1); /* its last byte is 0 */
    for (size_t i = 0; i < length; i++)
        upper[i] = (char)toupper((unsigned char)name[i]);
    return upper;
}

/* ---- fields */

static int is_blank(const struct c_token *token)
{
    return token->kind == C_SPACE || token->kind == C_COMMENT || token->kind == C_DIRECTIVE;
}

static int next_of(const struct c_tokens *tokens, int at)
{
    do
        at++;
    while (at < tokens->count && is_blank(&tokens->items[at]));
    return at;
}

static int is_mark(const struct c_tokens *tokens, int at, const char *marks)
{
    return at < tokens->count && tokens->items[at].kind == C_MARK
           && strchr(marks, *tokens->items[at].text) != NULL;
}

/* The body of a structure begins behind its `{` at `open`. Declared are names before `;`, `,`, `[`
 * and `:` outside of brackets, and NAME in `(*NAME`. Bodies inside have their own turn. */
static void mark_fields(struct c_tokens *tokens, int open)
{
    int round = 0, square = 0, braces = 0, before = open;
    for (int at = next_of(tokens, open); at < tokens->count;
         before = at, at = next_of(tokens, at)) {
        braces += is_mark(tokens, at, "{");
        braces -= is_mark(tokens, at, "}");
        if (braces < 0)
            return;
        round += is_mark(tokens, at, "(");
        round -= is_mark(tokens, at, ")");
        square += is_mark(tokens, at, "[");
        square -= is_mark(tokens, at, "]");
        struct c_token *token = &tokens->items[at];
        if (token->kind == C_NAME && braces == 0 && square == 0 && round == 0
            && !is_mark(tokens, before, ":") && is_mark(tokens, next_of(tokens, at), ";,[:"))
            token->member = 1;
        if (is_mark(tokens, at, "(") && braces == 0 && square == 0) {
            int name = next_of(tokens, at), stars = 0;
            for (;
                 is_mark(tokens, name, "*")
                 || (stars > 0 && name < tokens->count && dag_c_is(&tokens->items[name], "const"));
                 name = next_of(tokens, name))
                stars++;
            if (stars > 0 && name < tokens->count && tokens->items[name].kind == C_NAME)
                tokens->items[name].member = 1;
        }
    }
}

struct c_tokens dag_c_tokens(struct dag *dag, const char *text, size_t length)
{
    struct c_tokens tokens = {NULL, 0};
    const char *end = text + length;
    for (const char *at = text; at < end;) {
        struct c_token token = next_token(text, at, end);
        tokens.items = dag_grow(&dag->arena, tokens.items, tokens.count, sizeof *tokens.items);
        tokens.items[tokens.count++] = token;
        at += token.length;
    }
    for (int at = 0, before = -1; at < tokens.count; before = at, at = next_of(&tokens, at)) {
        struct c_token *token = &tokens.items[at];
        if (token->kind == C_NAME && before >= 0
            && (is_mark(&tokens, before, ".")
                || (is_mark(&tokens, before, ">") && tokens.items[before].text[-1] == '-')))
            token->member = 1;
        if (dag_c_is(token, "struct") || dag_c_is(token, "union")) {
            int open = next_of(&tokens, at);
            if (open < tokens.count && tokens.items[open].kind == C_NAME)
                open = next_of(&tokens, open);
            if (is_mark(&tokens, open, "{"))
                mark_fields(&tokens, open);
        }
    }
    return tokens;
}
