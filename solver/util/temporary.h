/* temporary.h - what a run makes for itself and must not leave behind when SIGINT, SIGTERM or
 * SIGHUP ends it: files beside outputs, and a folder for what is compiled.
 *
 * A signal's handler can do next to nothing, so it wakes a thread that does the rest: removes what
 * is named here, says what was written, and ends the process by the same signal. Meanwhile no file
 * is made or given its name, for that takes the lock.
 * SPDX-License-Identifier: MIT */
#ifndef TEMPORARY_H
#define TEMPORARY_H

/* From now on signals end the process so; those that are ignored stay so. Without this call nothing
 * else here does anything. */
void temporary_watch(void);

/* Has one come? What fails from then on is its doing, and no news. */
int temporary_stopping(void);

/* What the handler of a signal calls that shall end the process. */
void temporary_signal(int number);

/* Around what makes, renames or removes a file and says so here; or around several that belong
 * together, for locks may be nested. */
void temporary_lock(void);
void temporary_unlock(void);

/* Under the lock. `path` is borrowed until it is forgotten. */
void temporary_add(const char *path);
void temporary_forget(const char *path);
void temporary_written(void); /* an output has its name */

/* A folder of this process alone, made in TMPDIR (/tmp) at the first call; NULL: there is none. */
const char *temporary_folder(void);

/* At the end of a run: the folder goes. */
void temporary_end(void);

#endif
