/* json_value.c - see json_value.h: a reader by recursive descent, one function per rule.
 *
 * What it refuses is told at its place; the first mistake ends the reading. Depth is bounded, so
 * that no file can exhaust the stack. [RFC 8259]
 * SPDX-License-Identifier: MIT */
#include "read/json_value.h"

#include <stdlib.h>
#include <math.h>
#include <string.h>

enum { DEPTH_MOST = 64 };

struct reader {
    struct dag *dag;
    int source, at, depth;
    const char *text; /* ends with a NUL, which no rule accepts */
};

static struct where place(const struct reader *r, int from)
{
    return (struct where){r->source, from, r->at > from ? r->at - from : 1};
}

static struct json_value *refuse(struct reader *r, const char *wanted)
{
    if (r->text[r->at] == '\0')
        dag_error(r->dag, place(r, r->at), "the file ends where %s should be", wanted);
    else
        dag_error(r->dag, place(r, r->at), "%s should be here", wanted);
    return NULL;
}

static void skip_space(struct reader *r)
{
    r->at += (int)strspn(r->text + r->at, " \t\r\n");
}

/* Is this the next character? Then it is read. */
static int accept(struct reader *r, char mark)
{
    skip_space(r);
    if (r->text[r->at] != mark)
        return 0;
    r->at++;
    return 1;
}

static struct json_value *new_value(struct reader *r, enum json_kind kind, int from)
{
    struct json_value *value = dag_alloc(&r->dag->arena, sizeof *value);
    value->kind = kind;
    value->where = place(r, from);
    return value;
}

/* \uXXXX, without pairs: UTF-8 behind `to`. Returns how many bytes, 0: it is none. */
static int unescape_code(const char *digits, char *to)
{
    char four[5] = {0}, *end;
    memcpy(four, digits, strnlen(digits, 4));
    const unsigned long code = strtoul(four, &end, 16);
    if (end != four + 4 || strspn(four, "0123456789abcdefABCDEF") != 4 || code == 0
        || (code >= 0xd800 && code <= 0xdfff))
        return 0;
    if (code < 0x80) {
        to[0] = (char)code;
        return 1;
    }
    const int length = code < 0x800 ? 2 : 3;
    for (int i = length - 1; i >= 0; i--)
        to[i] = (char)(0x80 | (code >> (6 * (length - 1 - i)) & 0x3f));
    to[0] = (char)((length == 2 ? 0xc0 : 0xe0) | code >> (6 * (length - 1)));
    return length;
}

/* string: '"' (character | '\' escape)* '"' */
static const char *read_string(struct reader *r)
{
    static const char marks[] = "\"\\/bfnrt", means[] = "\"\\/\b\f\n\r\t";
    const char *from = r->text + ++r->at;
    const size_t most = strcspn(from, "\n") + 1;
    char *to = dag_alloc(&r->dag->arena, most), *end = to;
    for (; r->text[r->at] != '"'; r->at++) {
        const char *at = r->text + r->at;
        if ((unsigned char)*at < 0x20) {
            (void)refuse(r, "the end of the text, '\"',");
            return NULL;
        }
        const char *mark = *at == '\\' && at[1] != '\0' ? strchr(marks, at[1]) : NULL;
        int bytes;
        if (*at != '\\')
            *end++ = *at;
        else if (mark != NULL) {
            *end++ = means[mark - marks];
            r->at++;
        } else if (at[1] == 'u' && (bytes = unescape_code(at + 2, end)) > 0) {
            end += bytes;
            r->at += 5;
        } else {
            (void)refuse(r, "an escape of JSON");
            return NULL;
        }
    }
    r->at++;
    return to;
}

/* number: '-'? digits ('.' digits)? (('e'|'E') ('+'|'-')? digits)? */
static struct json_value *read_number(struct reader *r)
{
    static const char digits[] = "0123456789";
    const int from = r->at;
    const char *at = r->text + from + (r->text[from] == '-');
    size_t count = strspn(at, digits), part = 1;
    at += count;
    if (*at == '.')
        at += 1 + (part = strspn(at + 1, digits));
    if (count > 0 && part > 0 && (*at == 'e' || *at == 'E')) {
        at += at[1] == '+' || at[1] == '-' ? 2 : 1;
        at += part = strspn(at, digits);
    }
    if (count == 0 || part == 0)
        return refuse(r, "a number");
    r->at = (int)(at - r->text);
    struct json_value *value = new_value(r, JSON_NUMBER, from);
    value->number = strtod(r->text + from, NULL);
    if (isinf(value->number)) {
        r->at = from;
        return refuse(r, "a number below 1.8e308");
    }
    return value;
}

static struct json_value *read_word(struct reader *r)
{
    static const struct {
        const char *word;
        enum json_kind kind;
        double number;
    } words[] = {{"null", JSON_NULL, 0}, {"false", JSON_TRUTH, 0}, {"true", JSON_TRUTH, 1}};
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        if (strncmp(r->text + r->at, words[i].word, strlen(words[i].word)) == 0) {
            const int from = r->at;
            r->at += (int)strlen(words[i].word);
            struct json_value *value = new_value(r, words[i].kind, from);
            value->number = words[i].number;
            return value;
        }
    return refuse(r, "a value");
}

static struct json_value *read_value(struct reader *r);

/* member: string ':' value */
static struct json_value *read_member(struct reader *r)
{
    skip_space(r);
    if (r->text[r->at] != '"')
        return refuse(r, "a name in '\"'");
    const char *name = read_string(r);
    if (name == NULL)
        return NULL;
    if (!accept(r, ':'))
        return refuse(r, "':'");
    struct json_value *value = read_value(r);
    if (value != NULL)
        value->name = name;
    return value;
}

/* list: '[' (value (',' value)*)? ']'; object: '{' (member (',' member)*)? '}' */
static struct json_value *read_many(struct reader *r, enum json_kind kind)
{
    const char end = kind == JSON_LIST ? ']' : '}';
    struct json_value *many = new_value(r, kind, r->at), **last = &many->first;
    r->at++;
    if (accept(r, end))
        return many;
    if (++r->depth > DEPTH_MOST) {
        dag_error(r->dag, many->where, "more than %d lists and objects in each other", DEPTH_MOST);
        return NULL;
    }
    do {
        struct json_value *value = kind == JSON_LIST ? read_value(r) : read_member(r);
        if (value == NULL)
            return NULL;
        *last = value;
        last = &value->next;
    } while (accept(r, ','));
    r->depth--;
    return accept(r, end) ? many : refuse(r, kind == JSON_LIST ? "',' or ']'" : "',' or '}'");
}

/* value: object | list | string | number | 'true' | 'false' | 'null' */
static struct json_value *read_value(struct reader *r)
{
    skip_space(r);
    const char mark = r->text[r->at];
    if (mark == '{' || mark == '[')
        return read_many(r, mark == '[' ? JSON_LIST : JSON_OBJECT);
    if (mark == '"') {
        const int from = r->at;
        const char *text = read_string(r);
        struct json_value *value = text == NULL ? NULL : new_value(r, JSON_TEXT, from);
        if (value != NULL)
            value->text = text;
        return value;
    }
    return mark == '-' || (mark >= '0' && mark <= '9') ? read_number(r) : read_word(r);
}

const struct json_value *dag_read_json(struct dag *dag, int source)
{
    struct reader r = {.dag = dag, .source = source, .text = dag->sources[source].text};
    struct json_value *value = read_value(&r);
    if (value == NULL)
        return NULL;
    skip_space(&r);
    return r.text[r.at] == '\0' ? value : refuse(&r, "the end of the file");
}

const struct json_value *dag_json_member(const struct json_value *object, const char *name)
{
    const struct json_value *at = object->kind == JSON_OBJECT ? object->first : NULL;
    while (at != NULL && strcmp(at->name, name) != 0)
        at = at->next;
    return at;
}
