/* import_child.c - see import_child.h.
 *
 * fork(2) without exec: the child runs one function and ends by _exit, so nothing of the parent is
 * flushed or closed twice, and threads that the parent may have by then are not waited for. The
 * parent reads with a look at the child's clock between two waits: a child that computes for ever
 * is ended by the kernel (RLIMIT_CPU), one that waits for ever, but for a disk, by the parent.
 * SPDX-License-Identifier: MIT */
#include "scene/import_child.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "util/beside.h"
#include "util/clock.h"
#include "util/end_with_parent.h"
#include "util/ends_with.h"
#include "util/report.h"

/* Address sanitizer reserves terabytes and maps them as it goes. */
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define SANITIZED 1
#elif defined __has_feature
#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer) \
    || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif
#ifndef SANITIZED
#define SANITIZED 0
#endif

/* Processor seconds: some, and some for each MB. Assimp 5.2 reads a mesh of 490,000 quadrilaterals
 * at 130 MB/s (Collada) to 500 MB/s (STL); 30 times as long is more than any whole file took. */
static const double SECONDS = 3, SECONDS_PER_MB = 0.25;
/* Bytes beside what the process has at the fork, and for each byte of the file. Of the same mesh it
 * takes 3 (STL) to 9 (Collada) bytes for each, and we as many again. */
static const double MEMORY = 1 << 30, MEMORY_PER_BYTE = 50;
/* A child that neither sends nor computes for so long (s) waits for something that never comes. */
static const double IDLE = 5;
/* Seconds of the clock for each of the processor, on a machine that has others' work to do. */
static const double LATE = 3;

/* Exit statuses of the child. 0 and 1 may come from libraries, too. */
enum { DONE = 80, TOLD, NO_MEMORY };

struct child {
    pid_t process;
    int pipe;       /* the end to read from */
    int idle, late; /* why it is ended here */
    double seconds; /* of a processor */
    double begun;   /* s, of the clock */
};

/* What comes first; then positions, indices, sizes, polygon_materials, materials, and of each name
 * its length and its bytes; then groups and objects: their polygons' parts, and names so. */
struct header {
    uint64_t position_count, index_count;
    uint32_t polygon_count, material_count, group_count, object_count, other, lights;
    int32_t single_precision;
};

/* ---- the child */

/* Bytes of the file, and of a glTF's buffers, which lie beside it as a rule. */
static double size_of(const char *path)
{
    struct stat status;
    double size = stat(path, &status) ? 0 : (double)status.st_size;
    if (!ends_with(path, ".gltf"))
        return size;
    char *name = path_beside(path, ".", 1);
    DIR *folder = name ? opendir(name) : NULL;
    for (const struct dirent *e; folder && (e = readdir(folder)) != NULL;)
        if (ends_with(e->d_name, ".bin") && fstatat(dirfd(folder), e->d_name, &status, 0) == 0)
            size += (double)status.st_size;
    if (folder)
        closedir(folder);
    free(name);
    return size;
}

/* Bytes of address space that the process has, 0 when nobody knows. */
static double address_space(void)
{
    double pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%lf", &pages) != 1)
        pages = 0;
    if (f)
        fclose(f);
    return pages * (double)sysconf(_SC_PAGESIZE);
}

/* Never above what the user allows. */
static void limit(int what, double most, double hard)
{
    struct rlimit r;
    if (getrlimit(what, &r))
        return;
    if (r.rlim_cur == RLIM_INFINITY || most < (double)r.rlim_cur)
        r.rlim_cur = (rlim_t)most;
    if (r.rlim_max == RLIM_INFINITY || hard < (double)r.rlim_max)
        r.rlim_max = (rlim_t)hard;
    setrlimit(what, &r);
}

static void set_limits(double seconds, double memory)
{
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_CPU, ceil(seconds), ceil(seconds) + 1);
    double before = address_space();
    if (!SANITIZED && before > 0)
        limit(RLIMIT_AS, before + memory, before + memory);
    /* Ctrl-C goes to both processes; the parent decides what becomes of the child. */
    signal(SIGINT, SIG_IGN);
    signal(SIGTERM, SIG_DFL);
    signal(SIGHUP, SIG_DFL);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXCPU, SIG_DFL);
}

static void send(FILE *to, const void *array, size_t size, size_t count)
{
    if (count) /* or there may be no array */
        fwrite(array, size, count, to);
}

static void send_names(FILE *to, char *const *names, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t length = (uint32_t)strlen(names[i]);
        send(to, &length, sizeof length, 1);
        send(to, names[i], 1, length);
    }
}

static void send_parts(FILE *to, const struct part_names *p, uint32_t polygons)
{
    send(to, p->of, sizeof *p->of, p->count ? polygons : 0);
    send_names(to, p->names, p->count);
}

static int send_file(FILE *to, const struct scene_file *f)
{
    const struct header h = {f->position_count, f->index_count,  f->polygon_count,
                             f->material_count, f->groups.count, f->objects.count,
                             f->other,          f->lights,       f->single_precision};
    send(to, &h, sizeof h, 1);
    send(to, f->positions, 3 * sizeof *f->positions, f->position_count);
    send(to, f->indices, sizeof *f->indices, f->index_count);
    send(to, f->sizes, sizeof *f->sizes, f->polygon_count);
    send(to, f->polygon_materials, sizeof *f->polygon_materials, f->polygon_count);
    send(to, f->materials, sizeof *f->materials, f->material_count);
    send_names(to, f->names, f->material_count);
    send_parts(to, &f->groups, f->polygon_count);
    send_parts(to, &f->objects, f->polygon_count);
    return fclose(to) ? -1 : 0;
}

static _Noreturn void run(const char *path, import_reader *read, int out, double seconds,
                          double memory)
{
    set_limits(seconds, memory);
    struct scene_file file = {0};
    const int result = read(&file, path);
    FILE *to = result ? NULL : fdopen(out, "wb");
    if (result || !to)
        _exit(result < 0 ? TOLD : NO_MEMORY);
    _exit(send_file(to, &file) ? NO_MEMORY : DONE);
}

/* ---- the parent */

/* Processor seconds of the child so far; -1: nobody knows. */
static double spent(const struct child *c)
{
    clockid_t clock;
    struct timespec t;
    if (clock_getcpuclockid(c->process, &clock) || clock_gettime(clock, &t))
        return -1;
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Linux knows of whom a disk keeps waiting, which is no fault of the file however long it takes. */
static int waits_for_disk(const struct child *c)
{
    char text[512];
    snprintf(text, sizeof text, "/proc/%ld/stat", (long)c->process);
    FILE *f = fopen(text, "r");
    const char *line = f ? fgets(text, sizeof text, f) : NULL;
    const char *name_end = line ? strrchr(line, ')') : NULL;
    if (f)
        fclose(f);
    return name_end && strncmp(name_end, ") D", 3) == 0;
}

/* Returns 0, or -1 when the child sends no more. */
static int receive(struct child *c, void *to, size_t size)
{
    double last = spent(c), idle = 0;
    const int step = 100; /* ms */
    for (size_t have = 0; have < size;) {
        struct pollfd wait = {.fd = c->pipe, .events = POLLIN};
        const int ready = poll(&wait, 1, step);
        if (ready == 0) {
            const double now = spent(c);
            idle = now > last || waits_for_disk(c) ? 0 : idle + 1e-3 * step;
            last = now;
            c->idle = idle >= IDLE;
            c->late = seconds() - c->begun > LATE * c->seconds;
            if (c->idle || c->late)
                return -1;
            continue;
        }
        const ssize_t got = ready > 0 ? read(c->pipe, (char *)to + have, size - have) : -1;
        if (got == 0 || (got < 0 && errno != EINTR))
            return -1;
        have += got > 0 ? (size_t)got : 0;
    }
    return 0;
}

/* Room for n elements, and what the child sends for them. Returns 0, -1, or IMPORT_MEMORY. */
static int receive_array(struct child *c, void *array, size_t n, size_t size)
{
    void *room = n > SIZE_MAX / size - 1 ? NULL : malloc(n * size + 1);
    memcpy(array, &room, sizeof room);
    return !room ? IMPORT_MEMORY : receive(c, room, n * size);
}

static int receive_name(struct child *c, char **name)
{
    uint32_t length;
    if (receive(c, &length, sizeof length))
        return -1;
    const int result = receive_array(c, name, length, 1);
    if (result == 0)
        (*name)[length] = 0;
    return result;
}

static int receive_parts(struct child *c, struct part_names *p, uint32_t count, uint32_t polygons)
{
    if (!count)
        return 0;
    p->names = calloc(count, sizeof *p->names);
    if (!p->names)
        return IMPORT_MEMORY;
    p->count = count;
    p->name_capacity = count;
    p->of_capacity = polygons;
    int result = receive_array(c, &p->of, polygons, sizeof *p->of);
    for (uint32_t i = 0; i < count && !result; i++)
        result = receive_name(c, &p->names[i]);
    return result;
}

static int are_sound(const struct part_names *p, uint32_t polygons)
{
    for (uint32_t i = 0; i < polygons && p->count; i++)
        if (p->of[i] >= p->count)
            return 0;
    return 1;
}

/* Is it a scene_file at all? */
static int is_sound(const struct scene_file *f)
{
    uint64_t corners = 0;
    for (uint32_t i = 0; i < f->polygon_count; i++) {
        corners += f->sizes[i];
        if (f->polygon_materials[i] >= f->material_count)
            return 0;
    }
    for (size_t i = 0; i < f->index_count; i++)
        if (f->indices[i] >= f->position_count)
            return 0;
    return corners == f->index_count && are_sound(&f->groups, f->polygon_count)
           && are_sound(&f->objects, f->polygon_count);
}

/* Returns 0, -1, or IMPORT_MEMORY. */
static int receive_file(struct child *c, struct scene_file *f)
{
    struct header h;
    if (receive(c, &h, sizeof h))
        return -1;
    f->position_count = f->position_capacity = h.position_count;
    f->index_count = f->index_capacity = h.index_count;
    f->polygon_count = h.polygon_count;
    f->polygon_capacity = h.polygon_count;
    f->other = h.other;
    f->lights = h.lights;
    f->single_precision = h.single_precision;
    int result = receive_array(c, &f->positions, f->position_count, 3 * sizeof *f->positions);
    if (!result)
        result = receive_array(c, &f->indices, f->index_count, sizeof *f->indices);
    if (!result)
        result = receive_array(c, &f->sizes, f->polygon_count, sizeof *f->sizes);
    if (!result)
        result =
            receive_array(c, &f->polygon_materials, f->polygon_count, sizeof *f->polygon_materials);
    if (!result)
        result = receive_array(c, &f->materials, h.material_count, sizeof *f->materials);
    if (result)
        return result;
    f->lines = calloc((size_t)f->polygon_count + 1, sizeof *f->lines);
    f->names = calloc((size_t)h.material_count + 1, sizeof *f->names);
    f->places = calloc((size_t)h.material_count + 1, sizeof *f->places);
    if (!f->lines || !f->names || !f->places)
        return IMPORT_MEMORY;
    f->material_count = h.material_count;
    f->material_capacity = h.material_count;
    for (uint32_t i = 0; i < f->material_count && !result; i++)
        result = receive_name(c, &f->names[i]);
    if (!result)
        result = receive_parts(c, &f->groups, h.group_count, f->polygon_count);
    if (!result)
        result = receive_parts(c, &f->objects, h.object_count, f->polygon_count);
    return result ? result : is_sound(f) - 1;
}

/* The child has ended, or is ended here. Returns its status as waitpid tells it, -1: unknown. */
static int end_of(struct child *c, int taken)
{
    int status = -1;
    if (c->idle || c->late || taken > 0)
        kill(c->process, SIGKILL);
    close(c->pipe); /* a child that still sends dies of it */
    while (waitpid(c->process, &status, 0) < 0)
        if (errno != EINTR)
            return -1;
    return status;
}

/* Say why the child has sent no scene; `status` as waitpid tells it, -1: unknown. Returns -1. */
static int tell(const struct child *c, const char *path, int status, int taken, double megabytes)
{
    const int exited = status != -1 && WIFEXITED(status) ? WEXITSTATUS(status) : -1,
              killed = status != -1 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (exited == TOLD)
        return -1;
    if (taken == IMPORT_MEMORY || exited == NO_MEMORY)
        return report_error(path, 0,
                            "the importer ran out of memory; the file is damaged, or needs more "
                            "than %.0f MB: convert it to OBJ, or give a larger machine",
                            megabytes);
    if (c->idle)
        return report_error(path, 0,
                            "the importer hung: it waited %.0f s for something that does not come; "
                            "the file is damaged, or names a file that never ends",
                            IDLE);
    if (c->late || killed == SIGXCPU || killed == SIGKILL)
        return report_error(path, 0,
                            "the importer hung: stopped after %.0f s%s; the file is damaged, or "
                            "needs more: convert it to OBJ",
                            c->late ? LATE * c->seconds : ceil(c->seconds),
                            c->late ? "" : " of processor time");
    return report_error(path, 0,
                        "the importer crashed%s%s; the file is damaged, or needs what the importer "
                        "cannot do: export it again, or convert it to OBJ",
                        killed ? ": " : "", killed ? strsignal(killed) : "");
}

int import_in_child(struct scene_file *file, const char *path, import_reader *read)
{
    const double size = size_of(path), memory = MEMORY + MEMORY_PER_BYTE * size;
    struct child c = {.seconds = SECONDS + SECONDS_PER_MB * 1e-6 * size, .begun = seconds()};
    int ends[2];
    if (pipe(ends))
        return report_error(
            path, 0,
            "cannot start the importer: %s; end other programs, or convert the file to OBJ",
            strerror(errno));
    c.pipe = ends[0];
    const pid_t parent = getpid();
    c.process = fork();
    if (c.process == 0) {
        end_with_parent(parent, SIGKILL);
        close(ends[0]);
        run(path, read, ends[1], c.seconds, memory);
    }
    const int cause = errno;
    close(ends[1]);
    if (c.process < 0) {
        close(ends[0]);
        return report_error(
            path, 0,
            "cannot start the importer: %s; end other programs, or convert the file to OBJ",
            strerror(cause));
    }
    const int taken = receive_file(&c, file), status = end_of(&c, taken);
    if (taken == 0)
        return 0;
    scene_file_free(file);
    return tell(&c, path, status, taken, 1e-6 * memory);
}
