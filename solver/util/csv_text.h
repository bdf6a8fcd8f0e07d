/* csv_text.h - a text as a field of a table: as it is, or in quotes, which are then doubled within.
 * Blanks at its ends are its own, and many readers take them off where no quotes keep them.
 * [RFC 4180]
 * SPDX-License-Identifier: MIT */
#ifndef CSV_TEXT_H
#define CSV_TEXT_H

#include <stdio.h>
#include <string.h>

static inline void write_csv_text(FILE *out, const char *text)
{
    const size_t length = strlen(text);
    if (!strpbrk(text, ",\"\r\n") && (!length || (text[0] != ' ' && text[length - 1] != ' '))) {
        fputs(text, out);
        return;
    }
    putc('"', out);
    for (; *text; text++) {
        if (*text == '"')
            putc('"', out);
        putc(*text, out);
    }
    putc('"', out);
}

#endif
