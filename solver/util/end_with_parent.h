/* end_with_parent.h - a child process that does not outlive whoever wants what it makes.
 * SPDX-License-Identifier: MIT */
#ifndef END_WITH_PARENT_H
#define END_WITH_PARENT_H

#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

/* In the child: it gets that signal when its parent ends, which it may have before the system is
 * told so. */
static inline void end_with_parent(pid_t parent, int signal)
{
#ifdef __linux__
    prctl(PR_SET_PDEATHSIG, signal);
#else
    (void)signal;
#endif
    if (getppid() != parent)
        _exit(1);
}

#endif
