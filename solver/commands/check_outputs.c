/* check_outputs.c - see check_outputs.h.
 *
 * What a scene names inside it, and what is written beside a mesh, are files as those of the
 * command line are.
 * SPDX-License-Identifier: MIT */
#include "commands/check_outputs.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "commands/commands.h"
#include "output/export.h"
#include "scene/materials_by_name.h"
#include "scene/text_lines.h"
#include "util/array.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/ends_with.h"
#include "util/report.h"
#include "util/same_file.h"
#include "util/text_file.h"

struct named_file {
    char *path;       /* owned */
    const char *what; /* an input: what it is */
    int beside; /* an output: it is written beside another output, which the command line names */
};

struct named_files {
    struct named_file *inputs, *outputs;
    size_t input_count, input_capacity, output_count, output_capacity;
};

static void free_files(struct named_files *f)
{
    for (size_t i = 0; i < f->input_count; i++)
        free(f->inputs[i].path);
    for (size_t i = 0; i < f->output_count; i++)
        free(f->outputs[i].path);
    free(f->inputs);
    free(f->outputs);
}

/* Takes over `path`. Each returns 0, or -1 when out of memory. */
static int add_input(struct named_files *f, char *path, const char *what)
{
    if (!path
        || array_reserve(&f->inputs, f->input_count + 1, &f->input_capacity, sizeof *f->inputs) < 0)
        return free(path), -1;
    f->inputs[f->input_count++] = (struct named_file){.path = path, .what = what};
    return 0;
}

static int add_output(struct named_files *f, char *path, int beside)
{
    if (!path
        || array_reserve(&f->outputs, f->output_count + 1, &f->output_capacity, sizeof *f->outputs)
               < 0)
        return free(path), -1;
    f->outputs[f->output_count++] = (struct named_file){.path = path, .beside = beside};
    return 0;
}

/* ---- which files */

struct libraries {
    struct named_files *files;
    const char *scene;
};

static int add_library(void *to, const char *name, size_t length, int may_miss)
{
    const struct libraries *l = to;
    struct stat status;
    char *path = path_beside(l->scene, name, length);
    if (path && may_miss && (stat(path, &status) || !S_ISREG(status.st_mode) || access(path, R_OK)))
        return free(path), 1;
    return add_input(l->files, path, "a material file of the scene");
}

/* The material files of an OBJ scene. */
static int add_libraries(struct named_files *f, const char *scene, char *text, size_t size)
{
    struct text_lines t = text_lines(text, size);
    int failed = 0;
    while (!failed && next_line(&t)) {
        if (!next_word(&t) || !word_is(&t, "mtllib"))
            continue;
        char *name = rest_of_line(&t);
        failed = !name || materials_libraries(name, add_library, &(struct libraries){f, scene});
        free(name);
    }
    return failed ? -1 : 0;
}

/* The buffers of a glTF scene: "uri" : "NAME". */
static int add_buffers(struct named_files *f, const char *scene, const char *text)
{
    for (const char *at = text; (at = strstr(at, "\"uri\"")) != NULL;) {
        at += strlen("\"uri\"");
        const char *name = at + strspn(at, " \t\r\n:");
        const size_t length = *name == '"' ? strcspn(++name, "\"") : 0;
        if (length && strncmp(name, "data:", 5) != 0
            && add_input(f, path_beside(scene, name, length), "a file of the scene"))
            return -1;
    }
    return 0;
}

/* A scene and what it names. That it cannot be read is for its reader to say. */
static int add_scene_files(struct named_files *f, const char *scene, const char *what)
{
    struct stat status;
    if (add_input(f, strdup(scene), what))
        return -1;
    const int is_obj = ends_with_any_case(scene, ".obj");
    if ((!is_obj && !ends_with_any_case(scene, ".gltf")) || stat(scene, &status)
        || !S_ISREG(status.st_mode))
        return 0;
    size_t size;
    char *text = text_file_read(scene, &size);
    const int failed = !text    ? 0
                       : is_obj ? add_libraries(f, scene, text, size)
                                : add_buffers(f, scene, text);
    free(text);
    return failed;
}

struct imported {
    struct named_files *files;
    const char *oracle;
};

static int add_imported(void *to, const char *path)
{
    const struct imported *i = to;
    return same_file(path, i->oracle)
               ? 0
               : add_input(i->files, strdup(path), "a file that the oracle imports");
}

/* An oracle's file and what it imports. A name that is no file's is a built-in one's; a pipe can be
 * read but once. */
static int add_oracle_files(struct named_files *f, const struct options *o)
{
    struct stat status;
    if (!o->oracle || !(strchr(o->oracle, '/') || ends_with(o->oracle, ".dag"))
        || stat(o->oracle, &status) || !S_ISREG(status.st_mode))
        return 0;
    /* The one that tune is given may be replaced by what tune makes of it. */
    if (o->command != COMMAND_TUNE && add_input(f, strdup(o->oracle), "the oracle"))
        return -1;
    return radListOracleFiles(o->oracle, add_imported, &(struct imported){f, o->oracle});
}

static int add_inputs(struct named_files *f, const struct options *o)
{
    const int judged = o->command == COMMAND_ERROR;
    if (judged && add_input(f, strdup(o->scene), "the table"))
        return -1;
    if (!judged && o->scene && !o->scenes && add_scene_files(f, o->scene, "the scene"))
        return -1;
    for (int i = 0; i < o->scene_count; i++)
        if (add_scene_files(f, o->scenes[i], o->scene_count == 1 ? "the scene" : "a scene"))
            return -1;
    for (int i = 0; i < o->plugin_count; i++)
        if (add_input(f, strdup(o->plugins[i]), "a plugin"))
            return -1;
    const struct {
        const char *path, *what;
    } others[] = {
        {o->reference, "the reference"},
        {o->params, "the file of parameters"},
        {o->sensor, "the file of sensors"},
        {o->product, "the file of columns"},
        {o->checkpoint && o->restart && same_file(o->checkpoint, o->restart) ? NULL : o->restart,
         "the checkpoint to go on from"},
        {o->command == COMMAND_DRAW || o->command == COMMAND_PANEL ? o->statistics : NULL,
         "the file of statistics"}};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (others[i].path && add_input(f, strdup(others[i].path), others[i].what))
            return -1;
    return add_oracle_files(f, o);
}

static int add_outputs(struct named_files *f, const struct options *o)
{
    const char *paths[OUTPUTS_MAX];
    const int count = options_outputs(o, paths);
    for (int i = 0; i < count; i++)
        if (add_output(f, strdup(paths[i]), 0))
            return -1;
    if (o->command == COMMAND_REFERENCE && add_output(f, path_and(o->out, REFERENCE_STATE), 0))
        return -1;
    if (o->command == COMMAND_VIEWFACTORS && o->out && o->format == FACTOR_OPENFOAM
        && (add_output(f, path_beside(o->out, FACTOR_FACES, strlen(FACTOR_FACES)), 1)
            || add_output(f, path_beside(o->out, FACTOR_MAP, strlen(FACTOR_MAP)), 1)))
        return -1;
    const enum export_format format =
        o->command == COMMAND_SOLVE && o->out ? export_format(o->out) : EXPORT_UNKNOWN;
    const char *beside = format == EXPORT_OBJ    ? ".mtl"
                         : format == EXPORT_GLTF ? ".bin"
                         : format == EXPORT_XDMF ? ".h5"
                                                 : NULL;
    return beside ? add_output(f, path_with_ending(o->out, beside), 1) : 0;
}

/* ---- may they be written? */

/* Returns 0 or the exit status. */
static int check(const struct named_files *f, size_t i)
{
    const struct named_file *out = &f->outputs[i];
    const int standard = path_is_stdout(out->path);
    struct stat status;
    for (size_t j = 0; j < f->input_count && !standard; j++)
        if (stat(f->inputs[j].path, &status) == 0 && S_ISREG(status.st_mode)
            && same_file(out->path, f->inputs[j].path))
            return report_error(out->path, 0, "this is %s, which would be lost; give another name",
                                f->inputs[j].what),
                   2;
    for (size_t j = 0; j < i; j++)
        if (standard ? path_is_stdout(f->outputs[j].path)
                     : same_file(out->path, f->outputs[j].path))
            return report_error(standard ? "standard output" : out->path, 0,
                                "two outputs would go there; give each a file of its own"),
                   2;
    if (out->beside && stat(out->path, &status) == 0 && stat(f->outputs[0].path, &status) != 0)
        return report_error(out->path, 0,
                            "is written beside %s, but is there already and nothing of it; "
                            "move it, or give -o another name",
                            f->outputs[0].path),
               2;
    return standard || atomic_check(out->path) == 0 ? 0 : 1;
}

/* An archive is written with ways back in the file. Returns 0 or the exit status. */
static int check_archive(const struct options *o)
{
    struct stat status;
    if (o->command != COMMAND_VIEWFACTORS || !o->out || o->sensor || o->product
        || o->format != FACTOR_NPZ || stat(o->out, &status) || S_ISREG(status.st_mode)
        || S_ISDIR(status.st_mode))
        return 0;
    return -report_error(o->out, 0, "an archive cannot go to a pipe or a device; give a file");
}

int check_outputs(const struct options *o)
{
    struct named_files f = {0};
    int status = check_archive(o);
    if (add_outputs(&f, o) || (f.output_count && add_inputs(&f, o)))
        status = -report_error("radiosity", 0, "out of memory for the names of files");
    for (size_t i = 0; i < f.output_count && !status; i++)
        status = check(&f, i);
    free_files(&f);
    return status;
}
