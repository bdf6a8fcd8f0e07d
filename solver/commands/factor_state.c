/* factor_state.c - see factor_state.h.
 * SPDX-License-Identifier: MIT */
#include "commands/factor_state.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "util/clock.h"
#include "util/device.h"
#include "util/machines.h"
#include "util/report.h"
#include "util/saving.h"
#include "util/stop_signal.h"

/* ---- what the library calls */

static size_t read_state(void *user, void *bytes, size_t size)
{
    struct factor_state *s = user;
    const size_t count = fread(bytes, 1, size, s->in);
    s->unread = ferror(s->in);
    return count;
}

static enum RadStateWish ask(void *user)
{
    struct factor_state *s = user;
    const double now = seconds();
    const int stop = stop_signal_came(), due = save_is_due(now - s->saved, s->save_for);
    s->save_began = now;
    if (stop || due)
        s->failed = 0;
    if (stop) /* nothing is tried after it */
        s->told = 0;
    s->whole = s->whole && !stop; /* until it is, anew */
    return stop ? RAD_STATE_STOP : due ? RAD_STATE_SAVE : RAD_STATE_NONE;
}

static void note_time(struct factor_state *s)
{
    s->saved = seconds();
    s->save_for = s->saved - s->save_began;
}

/* What is full now may have room at the next save. */
static int fail(struct factor_state *s)
{
    s->failed = s->told = 1;
    note_time(s);
    return -1;
}

static int write_state(void *user, const void *bytes, size_t size)
{
    struct factor_state *s = user;
    if (!s->out.stream
        && (s->told ? atomic_open_silently(&s->out, s->path) : atomic_open(&s->out, s->path)) < 0)
        return fail(s);
    if (bytes && fwrite(bytes, 1, size, s->out.stream) == size)
        return 0;
    if (atomic_commit(&s->out) < 0) /* which says why it could not be written */
        return fail(s);
    s->whole = 1;
    s->told = 0;
    note_time(s);
    return 0;
}

/* ---- what the command calls */

int factor_state_open(struct factor_state *s, const struct options *o)
{
    *s = (struct factor_state){.path = o->resume, .quiet = o->quiet};
    progress_start(&s->progress, o->quiet);
    if (!s->path)
        return 0;
    s->start = s->saved = seconds();
    if (machines_number() > 0) { /* rank 0 has the file; no rank is to end before it is written */
        stop_signal_watch();
        return 0;
    }
    struct stat status;
    if (stat(s->path, &status) == 0) {
        s->in = S_ISREG(status.st_mode) ? fopen(s->path, "rb") : NULL;
        if (!s->in)
            return report_error(s->path, 0, "cannot be read: %s; give --resume another name",
                                S_ISREG(status.st_mode) ? strerror(errno) : "it is no file");
    } else if (errno != ENOENT) {
        return report_error(s->path, 0, "cannot be read: %s; give --resume another name",
                            strerror(errno));
    }
    s->host = (struct RadExchangeState){
        .read = s->in ? read_state : NULL, .asked = ask, .write = write_state, .user = s};
    stop_signal_watch();
    return 0;
}

const struct RadExchangeState *factor_state_host(const struct factor_state *s)
{
    return s->host.asked ? &s->host : NULL;
}

int factor_state_show(void *user, const struct RadProgress *at)
{
    struct factor_state *s = user;
    if (strcmp(at->phase, "resumed") != 0)
        return progress_show(&s->progress, at);
    progress_end(&s->progress);
    if (s->quiet)
        return 0;
    if (at->share > 0)
        fprintf(stderr, "goes on from %s: %.3g links, %.0f %% of the factors done, %.3g rays\n",
                s->path, (double)at->links, 100 * at->share, (double)at->rays);
    else
        fprintf(stderr, "goes on from %s: round %llu, %.3g pairs (%.3g waiting), %.3g links\n",
                s->path, (unsigned long long)at->rounds, (double)at->pairs, (double)at->waiting,
                (double)at->links);
    return 0;
}

int factor_state_report(struct factor_state *s, RadDevice device, const char *scene)
{
    char message[256];
    if (!s->path)
        return report_device(device, scene) < 0;
    snprintf(message, sizeof message, "%s",
             s->unread ? "it cannot be read" : radGetDeviceErrorMessage(device));
    switch (radGetDeviceError(device)) {
    case RAD_ERROR_CANCELLED:
        if (machines_number() > 0)
            return 0;                /* rank 0 knows whether all is written */
        if (!s->whole && !s->failed) /* a failure has been told */
            report_error(s->path, 0, "out of memory for the state");
        if (s->whole && !s->quiet)
            fprintf(stderr, "stopped after %.3g s; the same command goes on from %s\n",
                    seconds() - s->start, s->path);
        return s->whole ? STOPPED : 1;
    case RAD_ERROR_INVALID_ARGUMENT:
        report_error(s->path, 0, "%s; remove it to start anew, or give --resume another name",
                     message);
        return 1;
    default:
        report_error(scene, 0, "%s", message);
        return 1;
    }
}

void factor_state_close(struct factor_state *s)
{
    progress_end(&s->progress);
    if (s->in)
        fclose(s->in);
    s->in = NULL;
    atomic_discard(&s->out);
    if (s->path)
        stop_signal_unwatch();
}

void factor_state_remove(const struct factor_state *s)
{
    if (s->path && machines_number() == 0)
        (void)unlink(s->path);
}
