/* report.h - one way to say what went wrong: "path[:line]: error: cause; how to mend it".
 * SPDX-License-Identifier: MIT */
#ifndef REPORT_H
#define REPORT_H

#include <stdint.h>

#if defined __GNUC__
#define PRINTF_LIKE(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define PRINTF_LIKE(text, first)
#endif

/* Both write one line to stderr; line 0 stands for "no line". report_error returns -1, so that
 * a function can `return report_error(...)`. */
int report_error(const char *path, uint32_t line, const char *format, ...) PRINTF_LIKE(3, 4);
void report_warning(const char *path, uint32_t line, const char *format, ...) PRINTF_LIKE(3, 4);

#endif
