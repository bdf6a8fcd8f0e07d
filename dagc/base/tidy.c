/* tidy.c - see tidy.h.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>

#include "base/tidy.h"

const int dag_tidy_signals[TIDY_SIGNALS] = {SIGINT, SIGTERM, SIGHUP};

static struct tidy *volatile top;
static volatile sig_atomic_t watching;
static sigset_t before; /* what was blocked before dag_tidy_hold */

void dag_tidy_watch(void)
{
    watching = 1;
}

void dag_tidy_all(void)
{
    for (struct tidy *t = top; t != NULL; t = t->below)
        t->remove(t->of);
}

void dag_tidy_push(struct tidy *tidy)
{
    if (!watching)
        return;
    tidy->below = top;
    atomic_signal_fence(memory_order_release); /* a handler that sees it sees it whole */
    top = tidy;
}

void dag_tidy_pop(struct tidy *tidy)
{
    if (watching)
        top = tidy->below;
}

void dag_tidy_hold(void)
{
    sigset_t some;
    sigemptyset(&some);
    for (int i = 0; i < TIDY_SIGNALS; i++)
        sigaddset(&some, dag_tidy_signals[i]);
    if (watching)
        sigprocmask(SIG_BLOCK, &some, &before);
}

void dag_tidy_release(void)
{
    if (watching)
        sigprocmask(SIG_SETMASK, &before, NULL);
}
