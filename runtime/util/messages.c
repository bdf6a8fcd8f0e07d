/* messages.c - see messages.h.
 * SPDX-License-Identifier: MIT */
#include "util/messages.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

int messages_say(struct messages *m, enum message_cause cause, const char *format, ...)
{
    if (!m || m->cause != MESSAGE_NONE)
        return -1;
    va_list arguments;
    va_start(arguments, format);
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    m->cause = cause;
    m->text = length < 0 ? NULL : malloc((size_t)length + 1);
    if (m->text)
        vsnprintf(m->text, (size_t)length + 1, format, arguments);
    va_end(arguments);
    return -1;
}

const char *messages_text(const struct messages *m)
{
    return m->text ? m->text : m->cause == MESSAGE_NONE ? "" : "out of memory";
}

void messages_free(struct messages *m)
{
    free(m->text);
    *m = (struct messages){0};
}
