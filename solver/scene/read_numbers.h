/* read_numbers.h - the numbers of a line and of bytes, with messages that name file and line.
 * SPDX-License-Identifier: MIT */
#ifndef READ_NUMBERS_H
#define READ_NUMBERS_H

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "scene/text_lines.h"
#include "util/report.h"

enum { QUOTED = 64 }; /* no message quotes more bytes of a word, so that it keeps its end */

static inline int quoted_length(const char *from, const char *end)
{
    return end - from < QUOTED ? (int)(end - from) : QUOTED;
}

/* Coordinates are handed to programs that know floats alone: what none of these can hold is no
 * number here. */
static inline int is_finite_float(double x)
{
    return fabs(x) <= (double)FLT_MAX;
}

/* Does a decimal number say more than a float? Then it is off the next float by more than half a
 * unit in its last place; else a program that keeps floats may have written it. */
static inline int is_finer_than_float(const char *word, const char *end, double x)
{
    double off = fabs(x - (double)(float)x);
    int decimals = 0, point = 0;
    if (!(off > 0))
        return 0;
    for (; word < end && *word != 'e' && *word != 'E'; word++) {
        decimals += point;
        point |= *word == '.';
    }
    long exponent = word < end ? strtol(word + 1, NULL, 10) : 0;
    return off > 0.5001 * pow(10, (double)(exponent - decimals));
}

/* The finite numbers on the rest of the line, of which the first `most` go to `value`. Returns
 * how many; -1 after an error. */
static inline int read_numbers(struct text_lines *t, const char *path, const char *what, int most,
                               double *value)
{
    int count = 0;
    while (next_word(t)) {
        double x;
        int length = quoted_length(t->word, t->word_end);
        if (!word_number(t, &x))
            return report_error(path, t->number,
                                "'%.*s' is not a number in %s; write a decimal number", length,
                                t->word, what);
        if (!is_finite_float(x))
            return report_error(path, t->number, "%s is not finite ('%.*s'); write a finite number",
                                what, length, t->word);
        if (count < most) {
            value[count] = x;
            t->finer = t->finer || is_finer_than_float(t->word, t->word_end, x);
        }
        count++;
    }
    return count;
}

/* Is it 0, 1, 2 ... below `most`? */
static inline int is_whole(double x, double most)
{
    return x >= 0 && x < most && floor(x) >= x;
}

/* The number without a sign that these bytes are, eight at most. */
static inline uint64_t bytes_number(const void *from, unsigned size, int big_endian)
{
    const unsigned char *byte = from;
    uint64_t number = 0;
    for (unsigned i = 0; i < size; i++)
        number |= (uint64_t)byte[i] << 8 * (big_endian ? size - 1 - i : i);
    return number;
}

/* The number that these bytes are: of kind F a float, I a whole one with a sign, else without. */
static inline double typed_number(const void *from, char kind, unsigned size, int big_endian)
{
    const uint64_t bits = bytes_number(from, size, big_endian);
    const uint64_t sign = (uint64_t)1 << (8 * size - 1);
    if (kind == 'F') {
        const uint32_t low = (uint32_t)bits;
        float single;
        double value;
        memcpy(&single, &low, sizeof single);
        memcpy(&value, &bits, sizeof value);
        return size == 4 ? (double)single : value;
    }
    return kind == 'I' && bits & sign ? -(double)(~bits & (sign - 1)) - 1 : (double)bits;
}

/* A text that was cut ends within a line, as a rule. */
static inline void warn_of_cut(const char *path, uint32_t line, const char *text, size_t size)
{
    if (size && text[size - 1] != '\n' && text[size - 1] != '\r')
        report_warning(path, line, "the last line has no end; the file may be cut");
}

#endif
