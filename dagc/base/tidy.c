/* tidy.c - see tidy.h.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <signal.h>
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

static void block(sigset_t *was)
{
    sigset_t some;
    sigemptyset(&some);
    for (int i = 0; i < TIDY_SIGNALS; i++)
        sigaddset(&some, dag_tidy_signals[i]);
    sigprocmask(SIG_BLOCK, &some, was);
}

void dag_tidy_push(struct tidy *tidy)
{
    sigset_t was;
    if (!watching)
        return;
    block(&was); /* a handler that sees it sees it whole */
    tidy->below = top;
    top = tidy;
    sigprocmask(SIG_SETMASK, &was, NULL);
}

void dag_tidy_pop(struct tidy *tidy)
{
    if (watching)
        top = tidy->below;
}

void dag_tidy_hold(void)
{
    if (watching)
        block(&before);
}

void dag_tidy_release(void)
{
    if (watching)
        sigprocmask(SIG_SETMASK, &before, NULL);
}
