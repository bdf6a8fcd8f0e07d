/* xml_text.h - a text within XML, between tags or as an attribute. Of characters below the blank,
 * which XML has no place for, new lines alone stay.
 * SPDX-License-Identifier: MIT */
#ifndef XML_TEXT_H
#define XML_TEXT_H

#include <stdio.h>

static inline void xml_text_write(FILE *out, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&':
            fputs("&amp;", out);
            break;
        case '<':
            fputs("&lt;", out);
            break;
        case '>':
            fputs("&gt;", out);
            break;
        case '"':
            fputs("&quot;", out);
            break;
        default:
            if ((unsigned char)*text >= ' ' || *text == '\n')
                fputc(*text, out);
        }
}

#endif
