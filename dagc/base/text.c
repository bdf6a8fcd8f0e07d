/* text.c - output in memory, and values as C writes them.
 *
 * Everything is emitted into memory first, so that a run that fails has touched no file. A buffer
 * that could not grow remembers it; the writer of files asks once, at the end.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/internal.h"

static int reserve(struct text *text, size_t more)
{
    if (text->failed)
        return 0;
    if (text->length + more <= text->capacity)
        return 1;
    size_t capacity = (text->length + more) * 2;
    char *bytes = realloc(text->bytes, capacity);
    if (bytes == NULL) {
        text->failed = 1;
        return 0;
    }
    text->bytes = bytes;
    text->capacity = capacity;
    return 1;
}

void dag_print(struct text *text, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    if (length < 0)
        text->failed = 1;
    else if (reserve(text, (size_t)length + 1)) {
        vsnprintf(text->bytes + text->length, (size_t)length + 1, format, again);
        text->length += (size_t)length;
    }
    va_end(again);
    va_end(arguments);
}

static void print_byte(struct text *text, char byte)
{
    if (reserve(text, 1))
        text->bytes[text->length++] = byte;
}

void dag_print_upper(struct text *text, const char *name)
{
    for (; *name != '\0'; name++)
        print_byte(text, (char)toupper((unsigned char)*name));
}

void dag_print_constant(struct text *text, const char *prefix, const char *name)
{
    dag_print_upper(text, prefix);
    print_byte(text, '_');
    dag_print_upper(text, name);
}

const char *dag_number(double value, char buffer[32])
{
    if (isinf(value))
        return value < 0 ? "-inf" : "inf";
    for (int digits = 1; digits <= 17; digits++) {
        snprintf(buffer, 32, "%.*g", digits, value);
        if (strtod(buffer, NULL) == value)
            break;
    }
    /* "%.1g" of 64 is "6e+01": the plain form is as exact and easier to read. */
    if (fabs(value) < 1e6 && value == (double)(int)value && !(value == 0 && signbit(value)))
        snprintf(buffer, 32, "%.0f", value);
    return buffer;
}

void dag_print_number(struct text *text, double value)
{
    if (isinf(value))
        dag_print(text, "%s", value < 0 ? "-INFINITY" : "INFINITY");
    else {
        char buffer[32];
        const char *digits = dag_number(value, buffer);
        dag_print(text, "%s%s", digits, strpbrk(digits, ".e") == NULL ? ".0" : "");
    }
}

void dag_print_integer(struct text *text, double value)
{
    if (value == -2147483648.0) /* C has no such literal: minus is applied to 2147483648 */
        dag_print(text, "(-2147483647 - 1)");
    else
        dag_print(text, "%.0f", value == 0 ? 0.0 : value);
}

void dag_print_string(struct text *text, const char *value)
{
    print_byte(text, '"');
    for (; *value != '\0'; value++) {
        const unsigned char byte = (unsigned char)*value;
        if (byte < ' ' || byte == 0x7f) { /* as a file's name may have */
            dag_print(text, "\\%03o", byte);
            continue;
        }
        if (*value == '"' || *value == '\\' || *value == '?') /* "??/" would be a trigraph */
            print_byte(text, '\\');
        print_byte(text, *value);
    }
    print_byte(text, '"');
}

void dag_print_comment(struct text *text, const char *value)
{
    for (const char *at = value; *at != '\0'; at++) {
        int opens = at[0] == '/' && at[1] == '*', closes = at[0] == '*' && at[1] == '/';
        int trigraph = at[0] == '?' && at[1] == '?';
        unsigned char byte = (unsigned char)*at;
        print_byte(text, byte < ' ' || byte == 0x7f ? '?' : *at);
        if (opens || closes || trigraph)
            print_byte(text, ' ');
    }
}

void dag_text_free(struct text *text)
{
    free(text->bytes);
    *text = (struct text){NULL, 0, 0, 0};
}
