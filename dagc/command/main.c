/* main.c - the command dagc: the passes, then what was asked for.
 *
 * Exit status: 0 done; 1 the sources have errors, or a file cannot be read or written; 2 the
 * command line is wrong. With a status other than 0 no output file has been touched.
 * SPDX-License-Identifier: MIT */
#define _XOPEN_SOURCE 700 /* sigaction */

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "analyse/order.h"
#include "base/tidy.h"
#include "command/depfile.h"
#include "prove/diff.h"
#include "emit/emit_svg.h"
#include "emit/line_directives.h"
#include "command/options.h"
#include "command/write_skeleton.h"
#include "prove/prove.h"

/* What #line calls a text that goes to standard output: as if it were a file beside its source. */
static const char *name_of(struct dag *dag, const struct job *job, int which)
{
    const char *path = job->outputs[which].path;
    if (path != NULL && strcmp(path, "-") != 0)
        return path;
    return dag_format(&dag->arena, "%s.%s", dag->oracles[0].name, which == OUTPUT_TEXT ? "c" : "h");
}

static void emit(struct dag *dag, struct job *job)
{
    struct text *out = &job->outputs[OUTPUT_TEXT].text;
    const struct output *header = &job->outputs[OUTPUT_HEADER];
    const char *slash = header->path == NULL ? NULL : strrchr(header->path, '/');
    const char *name = slash != NULL ? slash + 1 : header->path;
    switch (job->emit) {
    case EMIT_C:
        if (job->c.standalone)
            dag_emit_standalone(dag, out, &job->outputs[OUTPUT_HEADER].text, name, &job->c);
        else
            dag_emit_c(dag, out, name == NULL ? NULL : &job->outputs[OUTPUT_HEADER].text, name,
                       &job->c);
        for (int i = OUTPUT_TEXT; job->c.directives && i <= OUTPUT_HEADER; i++)
            dag_number_lines(&job->outputs[i].text, name_of(dag, job, i));
        break;
    case EMIT_DOT:
    case EMIT_SVG: /* run() has it drawn, outside of dag_protect */
        dag_emit_dot(dag, out);
        break;
    case EMIT_JSON:
        dag_emit_json(dag, out);
        break;
    case EMIT_TEXT:
        dag_emit_text(dag, out, PASS_ANALYSE);
        break;
    case EMIT_CATALOG:
        dag_emit_catalog_doc(dag, out);
        break;
    case EMIT_CATALOG_H:
        dag_emit_catalog_h(dag, out);
        break;
    case EMIT_CATALOG_C:
        dag_emit_catalog_c(dag, out);
        break;
    case EMIT_CXX: /* set_emit has made C text of it */
    case EMIT_STUB:
    case EMIT_STUB_CXX:
    case EMIT_NONE:
    case EMITS:
        break;
    }
    dag_emit_depfile(dag, job->outputs);
}

static const char *from_environment(const char *name)
{
    const char *value = getenv(name);
    return value != NULL && *value != '\0' ? value : NULL;
}

static const char *folder_of(const struct job *job)
{
    const char *path = job->outputs[OUTPUT_TEXT].path;
    return strcmp(path, "-") == 0 ? "." : path;
}

static void make_skeleton(struct dag *dag, struct job *job)
{
    job->files.dag = dag;
    job->files.cxx = job->emit == EMIT_STUB_CXX;
    job->files.catalog = dag_seen_from(dag, folder_of(job), job->input_path);
    dag_emit_skeleton(&job->files);
}

/* What was measured of an oracle goes in, and what follows from it. */
static void use_profile(struct dag *dag, struct job *job)
{
    struct profile *profile = dag_read_profile(dag, &job->profile);
    if (profile == NULL)
        return;
    dag_order_questions(dag, profile);
    dag->profile = profile;
    const int found = profile->ordered
                          ? dag_diff_graphs(dag, &profile->before, &dag->oracles[profile->oracle])
                          : 0;
    if (found == 2) /* each exchange was proved; but what is not proved once more is not done */
        dag_keep_order(dag, profile,
                       "all questions stay as they are: some commute, but there are too many ways "
                       "through the graph to compare it with the one that they would make of it");
    else if (found != 0) {
        dag_error(dag, dag_nowhere, "the ordered graph of %s decides otherwise",
                  profile->before.name);
        dag_note(dag, dag_nowhere, "that is a fault of dagc: compile without --profile");
    }
    if (job->stop == PASSES)
        dag_fingerprint(dag);
}

static void passes(struct dag *dag, void *context)
{
    struct job *job = context;
    int is_catalog = dag_job_is_catalog(job);
    struct text *text = &job->outputs[OUTPUT_TEXT].text;
    dag->warnings = &job->warnings;
    dag->folders = job->folders;
    dag->folder_count = job->folder_count;

    dag_run_passes(dag, is_catalog ? &job->input : &job->catalog,
                   is_catalog || job->emit == EMIT_STUB ? NULL : &job->input, job->stop);
    if (dag->error_count == 0 && job->profile_path != NULL)
        use_profile(dag, job);
    if (dag->error_count > 0)
        return;
    if (job->skeleton)
        make_skeleton(dag, job);
    else if (job->emit == EMIT_STUB)
        dag_emit_stub(dag, text, job->input_path);
    else if (job->stop != PASSES)
        dag_emit_text(dag, text, job->stop);
    else if (job->prove) {
        struct dag_compiler compiler = {from_environment("CC"), from_environment("TMPDIR"), 0};
        job->proved = dag_prove(dag, &job->c, &compiler, stdout);
    } else
        emit(dag, job);
}

/* Says so when an output would take the place of a file that was read, as imports are. */
static int replaces_source(const struct dag *dag, const struct job *job)
{
    struct stat status;
    for (int i = 0; i < OUTPUTS; i++) {
        const char *path = job->outputs[i].path;
        if (path == NULL || strcmp(path, "-") == 0 || stat(path, &status) != 0)
            continue;
        for (int k = 0; k < dag->source_count; k++)
            if (dag->sources[k].on_disk && dag->sources[k].device == (uint64_t)status.st_dev
                && dag->sources[k].inode == (uint64_t)status.st_ino) {
                fprintf(stderr,
                        "dagc: error: %s would replace %s, which was read; give another name\n",
                        path, dag->sources[k].name);
                return 1;
            }
    }
    return 0;
}

static int run(struct job *job)
{
    struct dag *dag = dag_new();
    struct text *out = &job->outputs[OUTPUT_TEXT].text;
    int result = 1;
    if (job->emit != EMIT_STUB || job->skeleton) /* there FILE.dag is the name of a tool */
        dag_input_open(&job->input, job->input_path);
    if (job->profile_path != NULL)
        dag_input_open(&job->profile, job->profile_path);
    if (job->catalog_path != NULL)
        dag_input_open(&job->catalog, job->catalog_path);
    else {
        job->catalog.name = "the standard catalog";
        job->catalog.bytes = dagc_standard_catalog;
        job->catalog.length = strlen(dagc_standard_catalog);
    }
    if (dag == NULL || dag_protect(dag, passes, job) != 0)
        fprintf(stderr, "dagc: error: out of memory\n");
    else {
        dag_print_diagnostics(dag, stderr);
        if (dag->error_count == 0) {
            int draws = job->emit == EMIT_SVG && job->stop == PASSES;
            if (job->prove || (job->emit == EMIT_NONE && job->stop == PASSES))
                job->outputs[OUTPUT_TEXT].path = NULL;
            if (replaces_source(dag, job))
                result = 1;
            else if (job->skeleton)
                result = dag_write_skeleton(&job->files, folder_of(job)) != 0;
            else if (job->prove)
                result = job->proved != 0 || dag_write_ends() != 0;
            else if (!draws || dag_draw_svg(out) == 0)
                result = dag_write_outputs(job->outputs, OUTPUTS) != 0;
        }
    }
    for (int i = 0; i < OUTPUTS; i++)
        dag_text_free(&job->outputs[i].text);
    for (int i = 0; i < job->files.file_count; i++)
        dag_text_free(&job->files.files[i].text);
    dag_input_close(&job->input);
    dag_input_close(&job->catalog);
    dag_input_close(&job->profile);
    dag_free(dag);
    return result;
}

static int run_diff(const struct job *job)
{
    struct dag_options options = {0};
    options.catalog_path = job->catalog_path;
    options.folders = job->folders;
    options.folder_count = job->folder_count;
    int result = dag_diff(job->input_path, job->second_path, &options, stdout);
    return dag_write_ends() != 0 ? 2 : result;
}

static void on_signal(int number)
{
    dag_tidy_all();
    signal(number, SIG_DFL);
    kill(getpid(), number);
}

/* Those that are ignored stay so. */
static void watch_signals(void)
{
    struct sigaction action;
    dag_tidy_watch();
    signal(SIGXFSZ, SIG_IGN); /* a write to a file that may not grow tells so, as of a full disk */
    for (int i = 0; i < TIDY_SIGNALS; i++) {
        if (sigaction(dag_tidy_signals[i], NULL, &action) != 0 || action.sa_handler == SIG_IGN)
            continue;
        action.sa_handler = on_signal;
        action.sa_flags = SA_RESTART;
        sigfillset(&action.sa_mask); /* one is enough */
        sigaction(dag_tidy_signals[i], &action, NULL);
    }
}

int main(int count, char **arguments)
{
    int diff = count > 1 && strcmp(arguments[1], "diff") == 0;
    struct job job = {0};
    watch_signals();
    job.folders = calloc((size_t)count, sizeof *job.folders);
    job.host = calloc((size_t)count, sizeof *job.host);
    if (job.folders == NULL || job.host == NULL) {
        fprintf(stderr, "dagc: error: out of memory\n");
        free(job.folders);
        free(job.host);
        return diff ? 2 : 1;
    }
    int status =
        diff ? dag_parse_diff(&job, count, arguments) : dag_parse_arguments(&job, count, arguments);
    if (status == 0)
        status = dag_write_ends() != 0;
    else if (status < 0)
        status = diff ? run_diff(&job) : run(&job);
    free(job.folders);
    free(job.host);
    return status;
}
