/* stop_signal.c - see stop_signal.h.
 * SPDX-License-Identifier: MIT */
#include <signal.h>
#include <stddef.h>
#include "util/stop_signal.h"

static volatile sig_atomic_t came;

static void on_signal(int number)
{
    came = number;
}

static void handle_by(void (*handler)(int))
{
    struct sigaction action = {.sa_flags = (int)SA_RESETHAND};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void stop_signal_watch(void)
{
    handle_by(on_signal);
}

void stop_signal_unwatch(void)
{
    handle_by(SIG_DFL);
}

int stop_signal_came(void)
{
    return came;
}
