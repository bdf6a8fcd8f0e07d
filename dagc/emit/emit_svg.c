/* emit_svg.c - Graphviz draws: `dot` is run on the text and what it writes takes its place.
 *
 * Both sides are unnamed temporary files, so that no pipe can fill up and nothing is left behind.
 * SPDX-License-Identifier: MIT */
#include <errno.h>
#include <signal.h>
#include <string.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#include <sys/wait.h>
#include <unistd.h>

#include "emit/emit_svg.h"

enum { NOT_RUN = 127 }; /* as a shell says it */

/* The status of `dot -Tsvg` from one file to the other; -1: it did not end by itself. */
static int run_dot(FILE *from, FILE *to)
{
    const pid_t parent = getpid();
    pid_t child = fork();
    if (child == 0) {
#ifdef __linux__
        prctl(PR_SET_PDEATHSIG, SIGTERM); /* whoever is killed wants no drawing any more */
#endif
        if (getppid() == parent && /* it may have been killed before the system was told so */
            dup2(fileno(from), STDIN_FILENO) >= 0 && dup2(fileno(to), STDOUT_FILENO) >= 0)
            execlp("dot", "dot", "-Tsvg", (char *)NULL);
        _exit(NOT_RUN);
    }
    if (child < 0)
        return -1;
    int status;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void read_back(FILE *file, struct text *text)
{
    text->length = 0;
    rewind(file);
    char bytes[4096];
    size_t count;
    while ((count = fread(bytes, 1, sizeof bytes - 1, file)) > 0) {
        bytes[count] = '\0';
        dag_print(text, "%s", bytes);
    }
    text->failed |= ferror(file) != 0;
}

int dag_draw_svg(struct text *text)
{
    FILE *from = tmpfile(), *to = tmpfile();
    int status = -1;
    if (from == NULL || to == NULL)
        fprintf(stderr, "dagc: error: no temporary file: %s\n", strerror(errno));
    else if (text->failed)
        fprintf(stderr, "dagc: error: out of memory\n");
    else if (fwrite(text->bytes, 1, text->length, from) != text->length || fflush(from) != 0)
        fprintf(stderr, "dagc: error: cannot write a temporary file: %s\n", strerror(errno));
    else {
        rewind(from);
        status = run_dot(from, to);
        if (status == NOT_RUN)
            fprintf(stderr,
                    "dagc: error: cannot run 'dot': --emit=svg draws with Graphviz, which is not"
                    " installed\n    note: --emit=dot gives the drawing's source without it\n");
        else if (status != 0)
            fprintf(stderr, "dagc: error: 'dot' could not draw the graph\n");
        else
            read_back(to, text);
    }
    if (from != NULL)
        fclose(from);
    if (to != NULL)
        fclose(to);
    return status == 0 ? 0 : -1;
}
