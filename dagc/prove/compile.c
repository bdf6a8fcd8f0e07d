/* compile.c - a temporary folder, the compiler, dlopen; then the folder goes, a loaded library
 * stays.
 *
 * The flags keep the releases of an oracle equal to the bit. -Bsymbolic: an oracle may be called as
 * one that the program exports itself.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "prove/compile.h"
#include "emit/emit.h"
#include "emit/headers.h"
#include "base/internal.h"
#include "base/tidy.h"

extern char **environ;

enum {
    PATH_SIZE = PATH_MAX + 64,
    WORDS_MAX = 8, /* of the compiler's command, as in CC="ccache gcc -m64" */
    FLAGS_MAX = 24,
    SOURCES_MAX = 8,
    QUOTED = 2000 /* bytes of what the compiler says */
};

static const char library_name[] = "oracles.so", output_name[] = "output.txt";

/* folder/name; 0 when it does not fit. A signal's handler calls it, so no snprintf. */
static int path_of(char path[PATH_SIZE], const char *folder, const char *name)
{
    const size_t above = strlen(folder), length = strlen(name);
    if (above + 1 + length >= PATH_SIZE)
        return 0;
    memcpy(path, folder, above);
    path[above] = '/';
    memcpy(path + above + 1, name, length + 1);
    return 1;
}

static int write_file(const char *folder, const struct c_file *file)
{
    char path[PATH_SIZE];
    if (!path_of(path, folder, file->name)) {
        errno = ENAMETOOLONG;
        return -1;
    }
    char *slash = strchr(file->name, '/') != NULL ? strrchr(path, '/') : NULL;
    if (slash != NULL) {
        *slash = '\0';
        if (mkdir(path, 0700) < 0 && errno != EEXIST)
            return -1;
        *slash = '/';
    }
    FILE *stream = fopen(path, "wb");
    if (stream == NULL)
        return -1;
    int bad = fwrite(file->text, 1, file->length, stream) != file->length;
    return fclose(stream) != 0 || bad ? -1 : 0;
}

static void remove_all(const char *folder, const struct c_file *files, int count)
{
    char path[PATH_SIZE];
    for (int i = 0; i < count; i++)
        if (path_of(path, folder, files[i].name)) {
            unlink(path);
            if (strchr(files[i].name, '/') != NULL) {
                *strrchr(path, '/') = '\0';
                rmdir(path); /* succeeds with the last of its files */
            }
        }
    if (path_of(path, folder, library_name))
        unlink(path);
    if (path_of(path, folder, output_name))
        unlink(path);
    rmdir(folder);
}

/* What stands in the temporary folder, and who writes there. */
struct standing {
    const char *folder;
    const struct c_file *files;
    int count;
    volatile sig_atomic_t compiler; /* its process; 0: none */
};

/* When a signal ends us: the compiler ends first, or it would write there behind us, and has files
 * of its own to remove. */
static void remove_standing(const void *of)
{
    const struct standing *s = of;
    const struct timespec moment = {0, 10000000}; /* ns */
    const pid_t child = s->compiler;
    int patience = 100; /* moments */
    if (child > 0)
        kill(child, SIGTERM);
    while (child > 0 && waitpid(child, NULL, WNOHANG) == 0 && patience-- > 0)
        nanosleep(&moment, NULL);
    remove_all(s->folder, s->files, s->count);
}

/* Runs a program, its output going to a file; *running names it meanwhile. Its status; -1 with
 * errno when it did not end by itself. Where the host ignores SIGCHLD, nobody learns it, and it is
 * 0. */
static int run(char *const arguments[], const char *output, volatile sig_atomic_t *running)
{
    posix_spawn_file_actions_t actions;
    pid_t child = 0;
    int error = posix_spawn_file_actions_init(&actions);
    if (error == 0) {
        error = posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output,
                                                 O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (error == 0)
            error = posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
        if (error == 0)
            error = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
        posix_spawn_file_actions_destroy(&actions);
    }
    if (error != 0) {
        errno = error;
        return -1;
    }
    int status, known;
    *running = child;
    do
        known = waitpid(child, &status, 0) == child;
    while (!known && errno == EINTR);
    *running = 0;
    if (!known)
        return errno == ECHILD ? 0 : -1;
    errno = EINTR; /* by a signal */
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/* Puts the compiler's words below the message. */
static void quote(char *message, size_t size, const char *output)
{
    size_t used = strlen(message), room = size - used > QUOTED ? QUOTED : size - used;
    FILE *stream = fopen(output, "rb");
    if (stream == NULL)
        return;
    if (room > 2) {
        size_t got = fread(message + used + 1, 1, room - 2, stream);
        while (got > 0 && message[used + got] == '\n')
            got--;
        message[used] = got > 0 ? '\n' : '\0';
        message[used + 1 + got] = '\0';
    }
    fclose(stream);
}

static int is_source(const struct c_file *file)
{
    size_t length = strlen(file->name);
    return length > 2 && strcmp(file->name + length - 2, ".c") == 0;
}

/* The words of a command into `words`, which point into `text`; a program's path may hold blanks.
 * Returns how many there are. */
static int split(char *text, const char *words[WORDS_MAX])
{
    int count = 0;
    if (strchr(text, '/') != NULL && access(text, X_OK) == 0)
        words[count++] = text;
    else
        for (char *rest = NULL, *word = strtok_r(text, " \t", &rest);
             word != NULL && count < WORDS_MAX; word = strtok_r(NULL, " \t", &rest))
            words[count++] = word;
    return count;
}

static int compile(struct standing *standing, char sources[SOURCES_MAX][PATH_SIZE],
                   int source_count, const char *library, const char *const *flags,
                   const char *command, char *message, size_t size)
{
    /* The last three are the Makefile's: without them roots and choices take twice the time. */
    static const char *const fixed[] = {"-std=c11",          "-shared",           "-fPIC",
                                        "-Wl,-Bsymbolic",    "-ffp-contract=off", "-fno-math-errno",
                                        "-fno-trapping-math"};
    char include[PATH_SIZE + 2], output[PATH_SIZE], words[PATH_SIZE];
    const char *arguments[WORDS_MAX + FLAGS_MAX + SOURCES_MAX + 16];
    snprintf(words, sizeof words, "%s", command);
    int count = split(words, arguments);
    if (count == 0) /* blanks alone */
        arguments[count++] = command;
    for (size_t i = 0; i < sizeof fixed / sizeof *fixed; i++)
        arguments[count++] = fixed[i];
    arguments[count++] = include;
    for (int i = 0; flags[i] != NULL && i < FLAGS_MAX; i++)
        arguments[count++] = flags[i];
    arguments[count++] = "-o";
    arguments[count++] = library;
    for (int i = 0; i < source_count; i++)
        arguments[count++] = sources[i];
    arguments[count++] = "-lm";
    arguments[count] = NULL;
    snprintf(include, sizeof include, "-I%s", standing->folder);
    if (!path_of(output, standing->folder, output_name))
        return -1;
    int status = run((char *const *)(void *)arguments, output, &standing->compiler);
    if (status == 0 && access(library, F_OK) == 0)
        return 0;
    if (status < 0)
        snprintf(message, size,
                 "cannot run the C compiler '%s': %s; install it or set CC to another", command,
                 strerror(errno));
    else {
        snprintf(message, size,
                 "the C compiler '%s' failed; mend what it names, or set CC to another", command);
        quote(message, size, output);
    }
    return -1;
}

void *dag_compile(const struct c_file *files, int count, const char *const *flags,
                  const struct dag_compiler *compiler, char *message, size_t size)
{
    const char *parent =
        compiler != NULL && compiler->temporary != NULL ? compiler->temporary : "/tmp";
    const char *command = compiler != NULL && compiler->command != NULL ? compiler->command : "cc";
    char folder[PATH_MAX], sources[SOURCES_MAX][PATH_SIZE], library[PATH_SIZE];
    void *handle = NULL;
    int length = snprintf(folder, sizeof folder, "%s/dagc.XXXXXX", parent), bad = 0, count_c = 0;
    errno = ENAMETOOLONG;
    struct standing standing = {folder, files, count, 0};
    struct tidy tidy = {remove_standing, &standing, NULL};
    dag_tidy_hold();
    const int made = length < (int)sizeof folder && mkdtemp(folder) != NULL;
    if (made)
        dag_tidy_push(&tidy);
    dag_tidy_release();
    if (!made) {
        snprintf(message, size,
                 "cannot make a temporary folder in %s: %s; set TMPDIR to another place", parent,
                 strerror(errno));
        return NULL;
    }
    for (int i = 0; i < count && !bad; i++) {
        bad = write_file(folder, &files[i]) < 0;
        if (!bad && is_source(&files[i]) && count_c < SOURCES_MAX)
            bad = !path_of(sources[count_c++], folder, files[i].name);
    }
    if (bad || !path_of(library, folder, library_name))
        snprintf(message, size, "cannot write to %s: %s; set TMPDIR to another place", folder,
                 strerror(errno));
    else if (compile(&standing, sources, count_c, library, flags, command, message, size) == 0) {
        handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
        if (handle == NULL)
            snprintf(message, size, "cannot load what was compiled: %s", dlerror());
    }
    remove_all(folder, files, count);
    dag_tidy_pop(&tidy);
    return handle;
}

/* ---- oracles against the runtime's own headers */

struct request {
    const struct dag_compiler *compiler;
    char *message;
    size_t size;
    struct text c, catalog, externs;
    const char *plugin; /* its path */
    void *library;
};

/* Files beside the catalog's header and those that the library carries. */
static void *compile_with_headers(struct dag *dag, const struct c_file *own, int own_count,
                                  const char *const *flags, struct request *r)
{
    int count = 0;
    while (dagc_headers[count].name != NULL)
        count++;
    struct c_file *files =
        dag_alloc(&dag->arena, ((size_t)count + 1 + (size_t)own_count) * sizeof *files);
    dag_emit_catalog_h(dag, &r->catalog);
    if (r->catalog.failed)
        dag_out_of_memory(&dag->arena);
    for (int i = 0; i < count; i++)
        files[i] = (struct c_file){dagc_headers[i].name, dagc_headers[i].text,
                                   strlen(dagc_headers[i].text)};
    files[count++] = (struct c_file){"catalog.h", r->catalog.bytes, r->catalog.length};
    for (int i = 0; i < own_count; i++)
        files[count++] = own[i];
    return dag_compile(files, count, flags, r->compiler, r->message, r->size);
}

static void build(struct dag *dag, void *context)
{
    struct request *r = context;
    const struct source *source = &dag->sources[dag->oracles[0].where.source];
    const char *slash = source->is_file ? strrchr(source->name, '/') : NULL;
    const char *beside =
        slash == NULL ? "-I." : /* headers of the user's own tools */
            dag_format(&dag->arena, "-I%.*s", (int)(slash - source->name) + 1, source->name);
    const char *const flags[] = {"-O2", beside, NULL};
    const struct emit_options options = {.wave = r->compiler->wave};
    dag_emit_c(dag, &r->c, NULL, NULL, &options);
    int externs = dag_emit_extern_calls(dag, &r->externs);
    if (r->c.failed || r->externs.failed)
        dag_out_of_memory(&dag->arena);
    const struct c_file own[] = {{"oracles.c", r->c.bytes, r->c.length},
                                 {"externs.c", r->externs.bytes, r->externs.length}};
    r->library = compile_with_headers(dag, own, 1 + (externs > 0), flags, r);
}

static void *compile_protected(struct dag *dag, void (*body)(struct dag *dag, void *context),
                               struct request *r)
{
    struct protector *outer = dag->arena.protector;
    r->message[0] = '\0';
    if (dag_protect(dag, body, r) != 0)
        snprintf(r->message, r->size, "out of memory");
    dag->arena.protector = outer;
    dag_text_free(&r->c);
    dag_text_free(&r->catalog);
    dag_text_free(&r->externs);
    return r->library;
}

void *dag_compile_oracles(struct dag *dag, const struct dag_compiler *compiler, char *message,
                          size_t size)
{
    struct request r = {.compiler = compiler, .message = message, .size = size};
    return compile_protected(dag, build, &r);
}

/* ---- a user's C file */

static void build_plugin(struct dag *dag, void *context)
{
    struct request *r = context;
    const char *slash = strrchr(r->plugin, '/');
    const char *beside =
        slash == NULL ? "-I."
                      : dag_format(&dag->arena, "-I%.*s", (int)(slash - r->plugin) + 1, r->plugin);
    const char *file = *r->plugin == '-' ? dag_format(&dag->arena, "./%s", r->plugin) : r->plugin;
    const char *const flags[] = {"-O2", beside, file, NULL};
    r->library = compile_with_headers(dag, NULL, 0, flags, r);
}

void *dag_compile_plugin(const char *path, const struct dag_compiler *compiler, char *message,
                         size_t size)
{
    struct request r = {.compiler = compiler, .message = message, .size = size, .plugin = path};
    struct dag *dag = dag_load(NULL, NULL, NULL, NULL); /* for its catalog's header */
    if (dag == NULL) {
        snprintf(message, size, "out of memory");
        return NULL;
    }
    void *library = compile_protected(dag, build_plugin, &r);
    dag_free(dag);
    return library;
}
