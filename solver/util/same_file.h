/* same_file.h - do two names lead to one file?
 * SPDX-License-Identifier: MIT */
#ifndef SAME_FILE_H
#define SAME_FILE_H

/* Links are followed. Names of files that are not there yet are the same in one folder. */
int same_file(const char *a, const char *b);

#endif
