/* number_text.h - numbers as text, fast: matrices have tens of millions of them.
 * SPDX-License-Identifier: MIT */
#ifndef NUMBER_TEXT_H
#define NUMBER_TEXT_H

#include <stdint.h>

enum { NUMBER_TEXT = 24 }; /* room that any number takes */

/* The bytes that printf("%.12g", x) writes, without an end of string. Returns how many. */
int number_text(char out[NUMBER_TEXT], double x);

/* The same of a whole number, "%u". */
int number_text_whole(char out[NUMBER_TEXT], uint32_t n);

#endif
