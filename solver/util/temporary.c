/* temporary.c - see temporary.h.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* nftw, mkdtemp */
#include "util/temporary.h"

#include <ftw.h>
#include <limits.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "util/array.h"
#include "util/catch_signal.h"

static const int ending[] = {SIGINT, SIGTERM, SIGHUP};

static struct {
    pthread_mutex_t lock;
    sem_t came, begun;
    volatile sig_atomic_t number;
    const char **paths;
    size_t count, capacity;
    char folder[PATH_MAX]; /* "": none */
    int watching, folder_tried, written;
} all;

void temporary_lock(void)
{
    if (all.watching)
        pthread_mutex_lock(&all.lock);
}

void temporary_unlock(void)
{
    if (all.watching)
        pthread_mutex_unlock(&all.lock);
}

void temporary_add(const char *path)
{
    /* Without memory for its name it is one that a signal leaves. */
    if (array_reserve(&all.paths, all.count + 1, &all.capacity, sizeof *all.paths) == 0)
        all.paths[all.count++] = path;
}

void temporary_forget(const char *path)
{
    for (size_t i = all.count; i-- > 0;)
        if (all.paths[i] == path) {
            all.paths[i] = all.paths[--all.count];
            return;
        }
}

void temporary_written(void)
{
    all.written++;
}

/* ---- the folder */

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *at)
{
    (void)status, (void)kind, (void)at;
    (void)remove(path);
    return 0;
}

static void remove_folder(void)
{
    if (*all.folder)
        (void)nftw(all.folder, remove_one, 8, FTW_DEPTH | FTW_PHYS);
    *all.folder = 0;
}

const char *temporary_folder(void)
{
    temporary_lock();
    if (all.watching && !all.folder_tried) {
        const char *parent = getenv("TMPDIR");
        const int length = snprintf(all.folder, sizeof all.folder, "%s/radiosity.XXXXXX",
                                    parent && *parent ? parent : "/tmp");
        if (length >= (int)sizeof all.folder || !mkdtemp(all.folder))
            *all.folder = 0; /* whoever needs one will say why there is none */
        all.folder_tried = 1;
    }
    temporary_unlock();
    return *all.folder ? all.folder : NULL;
}

void temporary_end(void)
{
    temporary_lock();
    remove_folder();
    temporary_unlock();
}

/* ---- signals */

static void end_by(int number)
{
    struct sigaction action = {0};
    action.sa_handler = SIG_DFL;
    sigaction(number, &action, NULL);
    kill(getpid(), number);
}

static void wait_for(sem_t *what)
{
    while (sem_wait(what) != 0)
        ;
}

static void *wait_for_signal(void *unused)
{
    (void)unused;
    sem_post(&all.begun);
    wait_for(&all.came);
    temporary_lock(); /* for good */
    for (size_t i = 0; i < all.count; i++)
        unlink(all.paths[i]);
    remove_folder();
    if (all.written)
        fprintf(stderr, "radiosity: stopped by a signal; of its files %d %s written before\n",
                all.written, all.written == 1 ? "was" : "were");
    else
        fprintf(stderr, "radiosity: stopped by a signal; nothing was written\n");
    end_by(all.number);
    return NULL;
}

void temporary_signal(int number)
{
    if (!all.watching) {
        end_by(number);
        return;
    }
    all.number = number;
    sem_post(&all.came);
}

int temporary_stopping(void)
{
    return all.number != 0;
}

void temporary_watch(void)
{
    /* who writes to a file that may not grow tells so, as of a full disk */
    signal(SIGXFSZ, SIG_IGN);
    pthread_t thread;
    sigset_t every, before;
    sigfillset(&every);
    pthread_mutexattr_t again;
    if (sem_init(&all.came, 0, 0) || sem_init(&all.begun, 0, 0) || pthread_mutexattr_init(&again))
        return;
    pthread_mutexattr_settype(&again, PTHREAD_MUTEX_RECURSIVE);
    if (pthread_mutex_init(&all.lock, &again))
        return;
    pthread_sigmask(SIG_SETMASK, &every, &before); /* the thread takes none */
    all.watching = 1;                              /* which it sees */
    all.watching = pthread_create(&thread, NULL, wait_for_signal, NULL) == 0;
    if (all.watching) {
        pthread_detach(thread);
        /* a process forked while it starts would find its locks held for ever */
        wait_for(&all.begun);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    for (size_t i = 0; i < sizeof ending / sizeof *ending && all.watching; i++)
        catch_signal(ending[i], temporary_signal, SA_RESTART);
}
