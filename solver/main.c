/* main.c - the command radiosity: parse the options, see that what shall be written can be, run the
 * command.
 * SPDX-License-Identifier: MIT */
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "commands/check_outputs.h"
#include "commands/commands.h"
#include "hand.h"
#include "study/study.h"
#include "util/atomic_file.h"
#include "util/device.h"
#include "util/heap.h"
#include "util/machines.h"
#include "util/report.h"
#include "util/temporary.h"

static int (*const commands[COMMANDS])(const struct options *, const struct open_scene *) = {
    [COMMAND_SOLVE] = command_solve,
    [COMMAND_COMPARE] = command_compare,
    [COMMAND_VIEWFACTORS] = command_viewfactors,
    [COMMAND_REFERENCE] = command_reference,
    [COMMAND_ERROR] = command_error,
    [COMMAND_TUNE] = command_tune,
    [COMMAND_STABILITY] = study_stability,
    [COMMAND_VISIBILITY] = study_visibility,
    [COMMAND_CLUSTERING] = study_clustering,
    [COMMAND_FORM_FACTORS] = study_form_factors,
    [COMMAND_ARVO] = study_arvo,
    [COMMAND_CAUSES] = study_causes,
    [COMMAND_GREEDY] = study_greedy,
    [COMMAND_DRAW] = command_draw,
    [COMMAND_PANEL] = command_panel,
    [COMMAND_ORACLES] = command_oracles,
    [COMMAND_EXPLAIN] = command_explain,
};

/* Run the command, on the scene where it takes one. Returns the exit status. */
static int run(const struct options *o)
{
    const struct scene_options how = {.two_sided = o->two_sided,
                                      .quiet = o->quiet,
                                      .factors_alone = o->command == COMMAND_VIEWFACTORS};
    if (!o->scene || o->scenes || o->command == COMMAND_ERROR)
        return commands[o->command](o, NULL);
    const enum RadTurned turned = o->flip_closed                      ? RAD_TURNED_FLIP
                                  : o->command == COMMAND_VIEWFACTORS ? RAD_TURNED_FIND
                                                                      : RAD_TURNED_IGNORE;
    struct open_scene scene;
    int status =
        open_whole_scene(&scene, o->scene, &how, &o->copies, turned, o->threads) < 0 ? 1 : 0;
    const int others = machines_agree(status);
    if (status == 0 && others == 0) {
        scene_file_forget_places(&scene.file); /* commands ask the committed scene */
        status = commands[o->command](o, &scene);
    }
    if (status == 0 || others == 0)
        close_scene(&scene);
    return status;
}

/* May several processes run it together? Returns 0, or 2 after a message. */
static int check_several(const struct options *o)
{
    if (machines_count() == 1)
        return 0;
    if (o->command != COMMAND_SOLVE && o->command != COMMAND_REFERENCE
        && o->command != COMMAND_VIEWFACTORS) {
        report_error("radiosity", 0,
                     "of the commands only solve, reference and viewfactors run as several "
                     "processes; start this one without mpirun");
        return 2;
    }
    if (o->limit_seconds) {
        report_error("--limit-seconds", 0,
                     "several processes have no clock in common; run one, or leave it out");
        return 2;
    }
    return 0;
}

/* See that what shall be written can be, and run the command. */
static int check_and_run(const struct options *o)
{
    int status = check_several(o);
    if (status == 0 && machines_number() == 0)
        status = check_outputs(o);
    return machines_agree(status) ? status : run(o);
}

/* Standard output that is full or closed is an error like that of any file. */
static int flush_output(int status)
{
    const int cause = stream_flush(stdout);
    if (!cause || status)
        return status;
    report_error("standard output", 0, "cannot write: %s; free some space or write elsewhere",
                 strerror(cause));
    return 1;
}

int main(int count, char **arguments)
{
    heap_settle();
    /* Or else a file that we open would stand in for a stream that is closed, and get its text. */
    int stream;
    while ((stream = open("/dev/null", O_RDONLY)) >= 0 && stream < 3)
        ;
    if (stream >= 3)
        close(stream);
    int status = machines_begin(&count, &arguments);
    if (status)
        return status;
    struct options o;
    status = options_parse(&o, count, arguments);
    register_hand_releases(hand_releases);
    use_plugins(o.plugins, o.plugin_count);
    if (status < 0) {
        temporary_watch();
        if (machines_number() > 0)
            o.quiet = 1;
        status = check_and_run(&o);
        temporary_end();
    }
    options_free(&o);
    return machines_end(flush_output(status));
}
