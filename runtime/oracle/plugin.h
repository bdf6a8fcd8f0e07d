/* plugin.h - C functions of the user's that graphs name by `extern`: loaded once, and called by the
 * flat and by the interpreted release alike, so that both decide the same.
 * SPDX-License-Identifier: MIT */
#ifndef PLUGIN_H
#define PLUGIN_H

#include "dag.h"
#include "oracle/refiner.h"
#include "util/messages.h"

/* A list, the newest first; it only grows at its head. NULL: none. */
struct plugin {
    void *library;
    const struct plugin *next;
};

/* A shared object, or a C file (its name ends in .c), which the compiler makes one of. Of a shared
 * object it is asked that it says its ABI: `const int radiosity_plugin_abi = RUNTIME_ABI;`. Returns
 * NULL after a message. */
struct plugin *plugin_load(const char *path, const struct dag_compiler *compiler,
                           struct messages *messages);

/* The function of this name, of the newest that has one; `plugins` is a struct plugin. NULL: none
 * has. */
extern_function *plugin_find(const void *plugins, const char *name);

void plugins_free(const struct plugin *plugins);

#endif
