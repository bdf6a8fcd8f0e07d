/* plugin.c - see plugin.h.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700
#include "oracle/plugin.h"

#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "util/loaded_symbol.h"

/* What the loader and the compiler say of a missing file is less plain. 0, or -1 after a message.
 */
static int check_file(const char *path, struct messages *messages)
{
    struct stat status;
    FILE *file = fopen(path, "rb");
    int error = file ? 0 : errno;
    if (file && fstat(fileno(file), &status) == 0 && S_ISDIR(status.st_mode))
        error = EISDIR;
    if (file)
        fclose(file);
    return error ? messages_say(messages, MESSAGE_ARGUMENT, "cannot read the plugin: %s",
                                strerror(error))
                 : 0;
}

static void *compile(const char *path, const struct dag_compiler *compiler,
                     struct messages *messages)
{
    char message[4096];
    void *library = dag_compile_plugin(path, compiler, message, sizeof message);
    if (!library)
        (void)messages_say(messages, MESSAGE_COMPILER, "%s", message);
    return library;
}

/* A shared object that was compiled against these headers, as far as it says. */
static void *load(const char *path, struct messages *messages)
{
    /* without a '/' the loader would search its own folders */
    size_t size = strlen(path) + 3;
    char *file = malloc(size);
    if (!file) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
        return NULL;
    }
    snprintf(file, size, "%s%s", strchr(path, '/') ? "" : "./", path);
    void *library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    free(file);
    if (!library) {
        (void)messages_say(
            messages, MESSAGE_ARGUMENT,
            "no shared object that can be loaded: %s; make one by `cc -shared -fPIC`, "
            "or give the C file itself",
            dlerror());
        return NULL;
    }
    const int *abi = dlsym(library, "radiosity_plugin_abi");
    if (abi && *abi == RUNTIME_ABI)
        return library;
    if (abi)
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "the plugin was compiled against ABI %d, not %d; compile it anew with "
                           "this version's headers",
                           *abi, RUNTIME_ABI);
    else
        (void)messages_say(messages, MESSAGE_ARGUMENT,
                           "the plugin does not say which headers it was compiled against; write "
                           "`const int radiosity_plugin_abi = RUNTIME_ABI;` below #include "
                           "\"discussion.h\"");
    dlclose(library);
    return NULL;
}

struct plugin *plugin_load(const char *path, const struct dag_compiler *compiler,
                           struct messages *messages)
{
    size_t length = strlen(path);
    if (check_file(path, messages) < 0)
        return NULL;
    void *library = length > 2 && strcmp(path + length - 2, ".c") == 0
                        ? compile(path, compiler, messages)
                        : load(path, messages);
    struct plugin *plugin = library ? calloc(1, sizeof *plugin) : NULL;
    if (plugin)
        plugin->library = library;
    else if (library) {
        (void)messages_say(messages, MESSAGE_MEMORY, "out of memory");
        dlclose(library);
    }
    return plugin;
}

extern_function *plugin_find(const void *plugins, const char *name)
{
    for (const struct plugin *p = plugins; p; p = p->next) {
        extern_function *function;
        if (loaded_symbol(p->library, name, &function) == 0)
            return function;
    }
    return NULL;
}

void plugins_free(const struct plugin *plugins)
{
    while (plugins) {
        const struct plugin *next = plugins->next;
        dlclose(plugins->library);
        free((void *)(uintptr_t)plugins);
        plugins = next;
    }
}
