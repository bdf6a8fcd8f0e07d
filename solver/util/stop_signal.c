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
    struct sigaction action = {0};
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    watched = 1;
    sigaction(SIGINT, &action, NULL);
    sigaction(SIGTERM, &action, NULL);
}

void stop_signal_unwatch(void)
{
    watched = 0;
}

int stop_signal_came(void)
{
    return came;
}
