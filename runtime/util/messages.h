/* messages.h - what went wrong, kept for whoever called: nothing in the engine prints.
 *
 * The first error stays, later ones follow from it. All zero: nothing has been said. A function
 * that takes one may be given NULL, and then only fails.
 * SPDX-License-Identifier: MIT */
#ifndef MESSAGES_H
#define MESSAGES_H

#if defined __GNUC__
#define MESSAGE_LIKE(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define MESSAGE_LIKE(text, first)
#endif

enum message_cause {
    MESSAGE_NONE,
    MESSAGE_ARGUMENT, /* a name that nobody has, a value out of range */
    MESSAGE_GRAPH,    /* dagc's: lines "FILE:LINE:COLUMN: error: ..." as they stand */
    MESSAGE_COMPILER, /* of the C compiler; what it printed follows on lines of its own */
    MESSAGE_MEMORY
};

struct messages {
    enum message_cause cause;
    /* but for GRAPH a sentence without a newline at its end; NULL: there was no memory for it */
    char *text;
};

/* Returns -1, so that a function can `return messages_say(...)`. */
int messages_say(struct messages *messages, enum message_cause cause, const char *format, ...)
    MESSAGE_LIKE(3, 4);
const char *messages_text(const struct messages *messages); /* never NULL */
void messages_free(struct messages *messages);              /* and nothing has been said again */

#endif
