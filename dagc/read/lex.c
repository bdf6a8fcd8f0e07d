/* lex.c - text to tokens, one at a time.
 *
 * A lexer is plain data (where it is), so that the parser looks ahead by lexing with a copy.
 * Whatever cannot start a token is reported once per run of such bytes and skipped: the parser
 * never sees it.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/internal.h"

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static int is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

static int is_name(char c)
{
    return is_letter(c) || is_digit(c) || c == '_';
}

static int is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

static int is_mark(char c)
{
    return c != '\0' && strchr("{}()[];:,=|<>-+*/.", c) != NULL;
}

#define LEX_ERROR(lexer, ...) \
    do { \
        if (!(lexer)->quiet) \
            dag_error((lexer)->dag, __VA_ARGS__); \
    } while (0)

/* What someone may take for a part of a name. */
static int is_foreign(char c)
{
    return (unsigned char)c >= 0x80;
}

/* name = letter { letter | digit | "_" } */
static struct token lex_name(struct lexer *lexer, const char *text, struct token token)
{
    int length = 0, foreign = 0;
    while (is_name(text[length]) || is_foreign(text[length]))
        foreign |= is_foreign(text[length++]);
    token.kind = TOKEN_NAME;
    token.where.length = length;
    if (!is_letter(*text) || foreign)
        LEX_ERROR(lexer, token.where,
                  "a name has letters (a-z, A-Z), digits and '_', and begins with a letter");
    if (length > NAME_MAX_LENGTH) {
        LEX_ERROR(lexer, token.where, "this name has %d letters, the most is %d", length,
                  NAME_MAX_LENGTH);
        length = NAME_MAX_LENGTH;
        while (length > 0 && ((unsigned char)text[length] & 0xc0) == 0x80)
            length--;
    }
    token.text = dag_copy(&lexer->dag->arena, text, (size_t)length);
    return token;
}

/* Are all the digits before the exponent 0? */
static int is_zero(const char *digits)
{
    while (*digits == '0' || *digits == '.')
        digits++;
    return !is_digit(*digits);
}

/* number = digits [ "." digits ] [ ("e" | "E") [ "+" | "-" ] digits ] */
static struct token lex_number(struct lexer *lexer, const char *text, struct token token)
{
    int length = 0;
    while (is_digit(text[length]))
        length++;
    if (text[length] == '.') {
        length++;
        while (is_digit(text[length]))
            length++;
    }
    if (text[length] == 'e' || text[length] == 'E') {
        int sign = text[length + 1] == '+' || text[length + 1] == '-';
        if (is_digit(text[length + 1 + sign])) {
            length += 1 + sign;
            while (is_digit(text[length]))
                length++;
        }
    }
    int tail = length;
    while (is_name(text[tail]) || text[tail] == '.')
        tail++;
    token.kind = TOKEN_NUMBER;
    token.where.length = tail;
    token.number = 1;
    if (tail != length) {
        LEX_ERROR(lexer, token.where, "this is neither a number nor a name");
        return token;
    }
    token.number = strtod(text, NULL); /* the text is a number in C, too */
    if (isinf(token.number)) {
        LEX_ERROR(lexer, token.where, "this number is too large: write inf for no limit");
        token.number = 1;
    } else if (token.number == 0 && !is_zero(text)) {
        LEX_ERROR(lexer, token.where, "this number is too small: it would become 0");
        token.number = 1;
    }
    return token;
}

/* string = '"' { any character but '"', "\" and the line's end | '\"' | "\\" } '"' */
static struct token lex_string(struct lexer *lexer, const char *text, struct token token)
{
    struct dag *dag = lexer->dag;
    int end = 1, length = 0;
    while (text[end] != '"' && text[end] != '\n' && text[end] != '\0')
        end += text[end] == '\\' && text[end + 1] != '\n' && text[end + 1] != '\0' ? 2 : 1;
    token.kind = TOKEN_STRING;
    token.text = "";
    token.where.length = text[end] == '"' ? end + 1 : end;
    if (text[end] != '"') {
        /* The ';' at the line's end was hardly meant to be in it. */
        int last = end;
        while (last > 1 && is_space(text[last - 1]))
            last--;
        if (text[last - 1] == ';')
            token.where.length = last - 1;
        LEX_ERROR(lexer, token.where, "this string has no closing '\"' on its line");
        return token;
    }
    if (end > STRING_MAX_LENGTH) {
        LEX_ERROR(lexer, token.where, "this string has %d bytes, the most is %d", end,
                  STRING_MAX_LENGTH);
        return token;
    }
    char *value = dag_alloc(&dag->arena, (size_t)end);
    for (int i = 1; i < end; i++) {
        if (text[i] == '\\') {
            struct where where = {lexer->source, token.where.offset + i, 2};
            i++;
            if (text[i] != '"' && text[i] != '\\')
                LEX_ERROR(lexer, where, "unknown escape: only \\\" and \\\\ are known");
        } else if ((unsigned char)text[i] < ' ' || text[i] == 0x7f) {
            struct where where = {lexer->source, token.where.offset + i, 1};
            LEX_ERROR(lexer, where, "a control character (0x%02x) in a string", (unsigned)text[i]);
            continue;
        }
        value[length++] = text[i];
    }
    token.text = value;
    return token;
}

static void skip_blank(struct lexer *lexer, const char *text)
{
    for (;;) {
        while (is_space(text[lexer->offset]))
            lexer->offset++;
        if (text[lexer->offset] != '#')
            return;
        while (text[lexer->offset] != '\n' && text[lexer->offset] != '\0')
            lexer->offset++;
    }
}

static void skip_unknown(struct lexer *lexer, const char *text)
{
    struct where where = {lexer->source, lexer->offset, 0};
    const char *at = text + lexer->offset;
    int length = 1;
    while (at[length] != '\0' && !is_space(at[length]) && !is_name(at[length])
           && !is_foreign(at[length]) && !is_mark(at[length]) && at[length] != '"'
           && at[length] != '#')
        length++;
    where.length = length;
    LEX_ERROR(lexer, where, "this has no meaning here");
    lexer->offset += length;
}

struct token dag_lex(struct lexer *lexer)
{
    const char *text = lexer->dag->sources[lexer->source].text;
    struct token token = {TOKEN_END, '\0', {lexer->source, 0, 0}, "", 0};
    if (lexer->offset == 0 && strncmp(text, "\xef\xbb\xbf", 3) == 0)
        lexer->offset = 3; /* a byte order mark */
    const char *at;
    for (;;) {
        skip_blank(lexer, text);
        at = text + lexer->offset;
        if (at[0] == '/' && (at[1] == '/' || at[1] == '*')) {
            struct where where = {lexer->source, lexer->offset, 2};
            LEX_ERROR(lexer, where, "a comment begins with '#' and ends with its line");
            int line = (int)strcspn(at, "\n"), length = line;
            for (int i = 2; at[1] == '*' && i + 1 < line && length == line; i++)
                if (at[i] == '*' && at[i + 1] == '/')
                    length = i + 2;
            lexer->offset += length;
        } else if (*at == '\0' || is_name(*at) || is_foreign(*at) || *at == '"' || is_mark(*at))
            break;
        else
            skip_unknown(lexer, text);
    }
    token.where.offset = lexer->offset;
    token.where.length = 1;
    if (is_digit(*at))
        token = lex_number(lexer, at, token);
    else if (is_name(*at) || is_foreign(*at))
        token = lex_name(lexer, at, token);
    else if (*at == '"')
        token = lex_string(lexer, at, token);
    else if (at[0] == '-' && at[1] == '>') {
        token.kind = TOKEN_ARROW;
        token.where.length = 2;
    } else if (at[0] == '>' && at[1] == '=') {
        token.kind = TOKEN_AT_LEAST;
        token.where.length = 2;
    } else if (*at != '\0') {
        token.kind = TOKEN_PUNCTUATION;
        token.mark = *at;
    }
    lexer->offset += token.where.length;
    if (token.kind == TOKEN_END) {
        lexer->offset = token.where.offset;
        token.where.length = 0;
    }
    return token;
}
