/* compile_oracle.c - run dagc and cc on a .dag file and load what comes out.
 *
 * dagc and the headers are found from where this program stands: in the build folder, or installed
 * as PREFIX/bin and PREFIX/include/dagc. The C compiler gets the flags that keep releases equal to the bit.
 * SPDX-License-Identifier: MIT */
#include <dlfcn.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
#include "oracle/compile_oracle.h"
#include "dag.h"
#include "util/messages.h"

enum { PATH_SIZE = PATH_MAX + 64 };

/* The folder that the program's file is in, without the last slash. */
static int own_folder(char folder[PATH_MAX])
{
    ssize_t n = readlink("/proc/self/exe", folder, PATH_MAX - 1);
    char *slash;
    if (n <= 0)
        return -1;
    folder[n] = 0;
    slash = strrchr(folder, '/');
    if (!slash)
        return -1;
    *slash = 0;
    return 0;
}

/* Run a program and wait. Returns its exit status, or -1 when it could not be started. */
static int run(char *const arguments[])
{
    pid_t child = fork();
    int status;
    if (child == 0) {
        execvp(arguments[0], arguments);
        _exit(127);
    }
    if (child < 0)
        return -1;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) == 127)
        return -1;
    return WEXITSTATUS(status);
}

static void close_library(struct refiner *r)
{
    dlclose(r->own);
}

static struct refiner *load(const char *path, const char *library, const char *name)
{
    char symbol[128];
    void *handle = dlopen(library, RTLD_NOW | RTLD_LOCAL);
    const struct oracle *oracle;
    struct refiner *r;
    if (!handle) {
        report_error(path, 0, "cannot load what was compiled: %s", dlerror());
        return NULL;
    }
    snprintf(symbol, sizeof symbol, "%s_oracle", name);
    oracle = dlsym(handle, symbol);
    r = oracle ? refiner_compiled(oracle, "flat") : NULL;
    if (!r) {
        report_error(path, 0, "the compiled oracle does not fit this program; is dagc of the same version?");
        dlclose(handle);
        return NULL;
    }
    r->own = handle;
    r->release_state = close_library;
    return r;
}

/* Compile path to folder/oracle.so. Returns 0 or -1 after a message. */
static int compile(const char *path, const char *folder)
{
    char own[PATH_MAX], dagc[PATH_SIZE], source[PATH_SIZE], library[PATH_SIZE];
    char include[3][PATH_SIZE];
    char *cc = getenv("CC") && *getenv("CC") ? getenv("CC") : (char *)"cc";
    char *emit[] = { dagc, (char *)"-o", source, (char *)path, NULL };
    /* -Bsymbolic: an oracle may be called as a built-in one is, whose functions this program exports. */
    char *build[] = { cc, (char *)"-std=c11", (char *)"-O2", (char *)"-fPIC", (char *)"-shared", (char *)"-Wl,-Bsymbolic",
                      (char *)"-ffp-contract=off", include[0], include[1], include[2],
                      (char *)"-o", library, source, (char *)"-lm", NULL };
    int status;
    if (own_folder(own) < 0)
        return report_error(path, 0, "cannot tell where this program stands; use --release dag");
    snprintf(dagc, sizeof dagc, "%s/dagc", own);
    snprintf(source, sizeof source, "%s/oracle.c", folder);
    snprintf(library, sizeof library, "%s/oracle.so", folder);
    snprintf(include[0], sizeof include[0], "-I%s/../gen", own);
    snprintf(include[1], sizeof include[1], "-I%s/../../runtime", own);
    snprintf(include[2], sizeof include[2], "-I%s/../include/dagc", own);
    status = run(emit);
    if (status != 0)
        return status < 0 ? report_error(path, 0, "cannot run dagc, which should stand beside this program; use --release dag")
                          : -1; /* dagc has said why */
    status = run(build);
    if (status != 0)
        return report_error(path, 0, status < 0 ? "cannot run the C compiler '%s'; install one, set CC, or use --release dag"
                                                : "the C compiler '%s' failed (see above); use --release dag", cc);
    return 0;
}

struct refiner *compile_oracle(const char *path)
{
    const char *temporary = getenv("TMPDIR");
    char folder[PATH_MAX], file[PATH_SIZE];
    struct refiner *r = NULL;
    struct dag *dag;
    int index;
    dag = dag_load(path, NULL, NULL, stderr);
    if (!dag)
        return NULL;
    index = dag_oracle(dag, NULL);
    if (index < 0) {
        report_error(path, 0, "%d oracles here, not one", dag->oracle_count);
        dag_free(dag);
        return NULL;
    }
    snprintf(folder, sizeof folder, "%s/radiosity-XXXXXX", temporary && *temporary ? temporary : "/tmp");
    if (!mkdtemp(folder)) {
        report_error(folder, 0, "cannot make a temporary folder: %s", strerror(errno));
        dag_free(dag);
        return NULL;
    }
    snprintf(file, sizeof file, "%s/oracle.so", folder);
    if (compile(path, folder) == 0)
        r = load(path, file, dag->oracles[index].name);
    unlink(file); /* a loaded library stays loaded */
    snprintf(file, sizeof file, "%s/oracle.c", folder);
    unlink(file);
    rmdir(folder);
    dag_free(dag);
    return r;
}
