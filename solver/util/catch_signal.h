/* catch_signal.h - a handler for a signal, unless whoever started us wants it ignored.
 * SPDX-License-Identifier: MIT */
#ifndef CATCH_SIGNAL_H
#define CATCH_SIGNAL_H

#include <signal.h>
#include <stddef.h>

/* As nohup and a shell's jobs have it: what is ignored stays so. flags: of sigaction. */
static inline void catch_signal(int number, void (*handler)(int), int flags)
{
    struct sigaction action;
    if (sigaction(number, NULL, &action) != 0 || action.sa_handler == SIG_IGN)
        return;
    action = (struct sigaction){.sa_flags = flags};
    action.sa_handler = handler;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, NULL);
}

#endif
