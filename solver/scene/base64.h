/* base64.h - bytes written as letters, four for three.
 * [RFC 4648]
 * SPDX-License-Identifier: MIT */
#ifndef BASE64_H
#define BASE64_H

#include "scene/text_lines.h"

/* In place; groups of four characters, so that parts encoded one by one may stand together.
 * Returns how many bytes, or SIZE_MAX when it is no base64. */
static inline size_t from_base64(char *text, size_t size)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t bytes = 0;
    uint32_t group = 0;
    int have = 0, pads = 0;
    for (size_t i = 0; i < size; i++) {
        if (is_blank(text[i]) || text[i] == '\n')
            continue;
        const char *digit = text[i] ? strchr(digits, text[i]) : NULL;
        if (text[i] != '=' && (!digit || pads))
            return SIZE_MAX;
        pads += text[i] == '=';
        group = group << 6 | (digit ? (uint32_t)(digit - digits) : 0);
        if (++have < 4)
            continue;
        if (pads > 2)
            return SIZE_MAX;
        for (int k = 0; k < 3 - pads; k++)
            text[bytes++] = (char)(group >> (16 - 8 * k) & 0xff);
        group = 0;
        have = pads = 0;
    }
    return have ? SIZE_MAX : bytes;
}

#endif
