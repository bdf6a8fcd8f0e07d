/* stop_signal.c - see stop_signal.h.
 * SPDX-License-Identifier: MIT */
#include <signal.h>
#include <stddef.h>
#include "util/stop_signal.h"
#include "util/temporary.h"

static volatile sig_atomic_t watched, came;

static void on_signal(int number)
{
    if (!watched || came)
        temporary_signal(number);
    else
        came = number;
}

void stop_signal_watch(void)
{
    static const int stops[] = {SIGINT, SIGTERM};
    watched = 1;
    for (size_t i = 0; i < sizeof stops / sizeof *stops; i++) {
        struct sigaction action;
        if (sigaction(stops[i], NULL, &action) != 0 || action.sa_handler == SIG_IGN)
            continue; /* whoever started us does not want it to end us */
        action = (struct sigaction){0};
        action.sa_handler = on_signal;
        sigemptyset(&action.sa_mask);
        sigaction(stops[i], &action, NULL);
    }
}

void stop_signal_unwatch(void)
{
    watched = 0;
}

int stop_signal_came(void)
{
    return came;
}
