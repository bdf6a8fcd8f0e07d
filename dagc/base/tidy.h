/* tidy.h - what the command must not leave behind when SIGINT, SIGTERM or SIGHUP ends it.
 *
 * A library knows nothing of its program's signals: without dag_tidy_watch nothing here does
 * anything.
 * SPDX-License-Identifier: MIT */
#ifndef TIDY_H
#define TIDY_H

/* Called by the handler of a signal: `remove` may do what such may [POSIX, 2.4.3], to what `of`
 * points to at that moment. */
struct tidy {
    void (*remove)(const void *of);
    const void *of;
    struct tidy *below;
};

/* The program's handler of these signals calls dag_tidy_all before it ends the process. */
enum { TIDY_SIGNALS = 3 };
extern const int dag_tidy_signals[TIDY_SIGNALS];
void dag_tidy_watch(void);
void dag_tidy_all(void);

/* The last one pushed is the first to be popped. */
void dag_tidy_push(struct tidy *tidy);
void dag_tidy_pop(struct tidy *tidy);

/* Signals wait meanwhile: around what is not to be done by half. Not nested. */
void dag_tidy_hold(void);
void dag_tidy_release(void);

#endif
