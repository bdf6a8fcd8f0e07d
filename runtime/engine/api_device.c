/* api_device.c - devices: the first error since it was asked for, messages and progress.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "util/thread_pool.h"

enum { THREADS_MAX = 1024 };

/* Why the last radNewDevice of this thread made none. */
static _Thread_local enum RadError no_device;
static _Thread_local char no_device_message[MESSAGE_SIZE];

static RadDevice refuse_device(enum RadError code, const char *message)
{
    no_device = code;
    snprintf(no_device_message, sizeof no_device_message, "%s", message);
    return NULL;
}

RadDevice radNewDevice(const struct RadDeviceOptions *options)
{
    int threads = options ? options->threads : 0;
    if (threads < 0 || threads > THREADS_MAX)
        return refuse_device(RAD_ERROR_INVALID_ARGUMENT,
                             "RadDeviceOptions.threads takes 1 to 1024, or 0 for all processors");
    RadDevice device = calloc(1, sizeof *device);
    if (!device)
        return refuse_device(RAD_ERROR_OUT_OF_MEMORY, "out of memory for a device");
    if (pthread_mutex_init(&device->lock, NULL) != 0) {
        free(device);
        return refuse_device(RAD_ERROR_OUT_OF_MEMORY, "out of memory for a device's lock");
    }
    atomic_init(&device->holders, 1);
    thread_pool_retain();
    device->compiler = options && options->compiler ? strdup(options->compiler) : NULL;
    device->temporary = options && options->temporary ? strdup(options->temporary) : NULL;
    if (options
        && ((options->compiler && !device->compiler)
            || (options->temporary && !device->temporary))) {
        radReleaseDevice(device);
        return refuse_device(RAD_ERROR_OUT_OF_MEMORY, "out of memory for a device");
    }
    device->sources.compiler = device->compiler;
    device->sources.temporary = device->temporary;
    int processors = thread_pool_processors();
    device->threads = threads ? threads : processors < THREADS_MAX ? processors : THREADS_MAX;
    return device;
}

RadDevice radNewDeviceMPI(const struct RadDeviceOptions *options, const void *communicator)
{
    const char *cause;
    if (!communicator)
        return refuse_device(RAD_ERROR_INVALID_ARGUMENT,
                             "radNewDeviceMPI needs the address of an MPI_Comm");
    struct ranks *ranks = ranks_open(communicator, &cause);
    if (!ranks)
        return refuse_device(RAD_ERROR_UNSUPPORTED, cause);
    RadDevice device = radNewDevice(options);
    if (device)
        device->ranks = ranks;
    else
        ranks_close(ranks);
    return device;
}

int api_alone(RadDevice device, const char *what)
{
    if (ranks_count(device->ranks) == 1)
        return 0;
    return api_fail(
        device, RAD_ERROR_UNSUPPORTED,
        "%s needs all links, of which each of the %d ranks has its own; run one process", what,
        ranks_count(device->ranks));
}

void radRetainDevice(RadDevice device)
{
    if (device)
        atomic_fetch_add(&device->holders, 1);
}

void radReleaseDevice(RadDevice device)
{
    if (!device || atomic_fetch_sub(&device->holders, 1) != 1)
        return;
    ranks_close(device->ranks);
    thread_pool_release();
    pthread_mutex_destroy(&device->lock);
    oracle_sources_free(&device->sources);
    free(device->compiler);
    free(device->temporary);
    free(device);
}

void radSetDeviceMessageFunction(RadDevice device, RadMessageFunction function, void *user)
{
    if (!device)
        return;
    pthread_mutex_lock(&device->lock);
    device->tell = function;
    device->tell_user = user;
    pthread_mutex_unlock(&device->lock);
}

void radSetDeviceProgressFunction(RadDevice device, RadProgressFunction function, void *user)
{
    if (!device)
        return;
    pthread_mutex_lock(&device->lock);
    device->progress = function;
    device->progress_user = user;
    pthread_mutex_unlock(&device->lock);
}

enum RadError radGetDeviceError(RadDevice device)
{
    enum RadError code;
    if (!device) {
        code = no_device;
        no_device = RAD_ERROR_NONE;
        no_device_message[0] = 0;
        return code;
    }
    pthread_mutex_lock(&device->lock);
    code = device->error;
    device->error = RAD_ERROR_NONE;
    device->message[0] = 0;
    pthread_mutex_unlock(&device->lock);
    return code;
}

const char *radGetDeviceErrorMessage(RadDevice device)
{
    return device ? device->message : no_device_message;
}

/* The message function is called without the lock, so that it may call the device. */
int api_fail(RadDevice device, enum RadError code, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    char message[MESSAGE_SIZE];
    vsnprintf(message, sizeof message, format, list);
    va_end(list);
    pthread_mutex_lock(&device->lock);
    if (device->error == RAD_ERROR_NONE) {
        device->error = code;
        snprintf(device->message, sizeof device->message, "%s", message);
    }
    RadMessageFunction function = device->tell;
    void *user = device->tell_user;
    pthread_mutex_unlock(&device->lock);
    if (function)
        function(user, code, message);
    return -1;
}

int api_needs(RadDevice device, const void *given, const char *what)
{
    return given ? 0 : api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "%s, which is NULL", what);
}

int api_progress(RadDevice device, const struct RadProgress *progress)
{
    pthread_mutex_lock(&device->lock);
    RadProgressFunction function = device->progress;
    void *user = device->progress_user;
    pthread_mutex_unlock(&device->lock);
    return function ? function(user, progress) : 0;
}

enum RadError api_cause(const char *cause)
{
    return strncmp(cause, "Embree finds", 12) == 0     ? RAD_ERROR_UNSUPPORTED
           : strncmp(cause, "LU solves", 9) == 0       ? RAD_ERROR_INVALID_ARGUMENT
           : strncmp(cause, "PETSc cannot", 12) == 0   ? RAD_ERROR_INVALID_ARGUMENT
           : strncmp(cause, "refinement for", 14) == 0 ? RAD_ERROR_LIMIT
                                                       : RAD_ERROR_OUT_OF_MEMORY;
}

int api_place(const double place[3])
{
    for (int k = 0; k < 3; k++)
        if (!(fabs(place[k]) <= (double)FLT_MAX))
            return 0;
    return 1;
}
