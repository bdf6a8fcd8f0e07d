/* other_formats.h - formats that are not read, and which programs make of them what is.
 * SPDX-License-Identifier: MIT */
#ifndef OTHER_FORMATS_H
#define OTHER_FORMATS_H

/* Returns 0 when the path's ending is none of these, -1 after a message. */
int other_formats_refuse(const char *path);

#endif
