/* tidy.c - see tidy.h.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

#include "base/tidy.h"

static const int ending[] = {SIGINT, SIGTERM, SIGHUP};
enum { ENDING = sizeof ending / sizeof *ending };

static struct tidy *volatile top;
static volatile sig_atomic_t watching;
static sigset_t before; /* what was blocked before dag_tidy_hold */

static void on_signal(int number)
{
    for (struct tidy *t = top; t != NULL; t = t->below)
        t->remove(t->of);
    signal(number, SIG_DFL);
    kill(getpid(), number);
}

void dag_tidy_watch(void)
{
    struct sigaction action;
    watching = 1;
    for (int i = 0; i < ENDING; i++) {
        if (sigaction(ending[i], NULL, &action) != 0 || action.sa_handler == SIG_IGN)
            continue;
        action.sa_handler = on_signal;
        action.sa_flags = SA_RESTART;
        sigfillset(&action.sa_mask); /* one is enough */
        sigaction(ending[i], &action, NULL);
    }
}

void dag_tidy_push(struct tidy *tidy)
{
    if (!watching)
        return;
    tidy->below = top;
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
    for (int i = 0; i < ENDING; i++)
        sigaddset(&some, ending[i]);
    if (watching)
        sigprocmask(SIG_BLOCK, &some, &before);
}

void dag_tidy_release(void)
{
    if (watching)
        sigprocmask(SIG_SETMASK, &before, NULL);
}
