/* stop_signal.h - SIGINT and SIGTERM ask long work to come to an end that leaves what it has; a
 * second one ends the program at once.
 * SPDX-License-Identifier: MIT */
#ifndef STOP_SIGNAL_H
#define STOP_SIGNAL_H

enum { STOPPED = 130 }; /* the exit status of what SIGINT ends, by the habit of shells */

void stop_signal_watch(void);

/* Either ends the program again, as temporary.h says. */
void stop_signal_unwatch(void);

/* Nonzero once one has come while they were watched. */
int stop_signal_came(void);

#endif
