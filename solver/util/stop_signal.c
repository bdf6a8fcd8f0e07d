/* stop_signal.c - see stop_signal.h.
 * SPDX-License-Identifier: MIT */
#include <signal.h>
#include "util/catch_signal.h"
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
    watched = 1;
    catch_signal(SIGINT, on_signal, 0);
    catch_signal(SIGTERM, on_signal, 0);
}

void stop_signal_unwatch(void)
{
    watched = 0;
}

int stop_signal_came(void)
{
    return came;
}
