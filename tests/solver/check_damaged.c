/* check_damaged.c - scene files of every format, damaged at random, as commands read and solve
 * them.
 *
 * Seeds are tests/solver/formats: a byte, a number or a line of them is changed, cut, doubled or
 * swapped. Each file is read in a process of its own, which may neither crash nor take 10 s or a
 * gigabyte; what is refused must be so in one line; what is read must be finite, be what a plain
 * reading says where that is sure (scene/plain_reading.h), and be solved to finite values.
 *
 * FUZZ_FILES (800; 400 under sanitizers) files from seed FUZZ_SEED (1), or as many as FUZZ_SECONDS
 * allow; a file that fails stays in FUZZ_FOUND, a folder. `make fuzz-scenes` runs 20,000, and as
 * many under sanitizers as its time allows. Run from the top folder.
 * SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* wait4 */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "folder.h"
#include "scene/open_scene.h"
#include "scene/plain_reading.h"
#include "suite.h"

/* A scene file and one beside it, of which either is damaged. */
static const struct {
    const char *name, *beside;
} seeds[] = {
    {"room.obj", "room.mtl"}, {"styles.obj", "styles.mtl"},
    {"bare.obj", NULL},       {"later.obj", "later.mtl"},
    {"text.ply", NULL},       {"little.ply", NULL},
    {"big.ply", NULL},        {"strips.ply", NULL},
    {"text.stl", NULL},       {"bytes.stl", NULL},
    {"room.off", NULL},       {"colours.off", NULL},
    {"inside.gltf", NULL},    {"beside.gltf", "beside.bin"},
    {"room.glb", NULL},       {"room.dae", NULL},
    {"room.3ds", NULL},       {"room.ac", NULL},
    {"room.dxf", NULL},       {"room.x", NULL},
    {"room.vs3", NULL},       {"planes.vs3", NULL},
    {"two.msh", NULL},        {"four.msh", NULL},
    {"small.bdf", NULL},      {"large.nas", NULL},
    {"free.bdf", NULL},       {"three.vtk", NULL},
    {"five.vtk", NULL},       {"strip.vtk", NULL},
    {"room.vtu", NULL},       {"bytes.vtu", NULL},
    {"room.vtp", NULL},       {"behind.vtp", NULL},
    {"behind.vtu", NULL},     {"bytes.vtk", NULL},
    {"bytes.msh", NULL},
};
enum { SEEDS = sizeof seeds / sizeof *seeds, ROOM = 1 << 15, FILES = 800 };
static const long MEGABYTES = 1024;   /* beside what the program itself takes */
static const double SAME_AREA = 1e-6; /* relative */

#if defined __SANITIZE_ADDRESS__
static const int SANITIZED = 1; /* whose memory and time are another matter */
#else
static const int SANITIZED = 0;
#endif

struct bytes {
    unsigned char at[ROOM];
    size_t size;
};

static uint64_t state;

static uint32_t chance(size_t of) /* 0 .. of - 1, 0 when there is none */
{
    state = state * 6364136223846793005u + 1442695040888963407u;
    return of ? (uint32_t)((state >> 33) % of) : 0;
}

/* ---- damage */

static void replace(struct bytes *b, size_t from, size_t size, const void *by, size_t by_size)
{
    if (b->size - size + by_size > ROOM)
        return;
    memmove(b->at + from + by_size, b->at + from + size, b->size - from - size);
    memcpy(b->at + from, by, by_size);
    b->size += by_size - size;
}

static void odd_number(struct bytes *b)
{
    static const char *const odd[] = {
        "nan",        "inf",   "-inf", "1e308",      "1e-308", "1e39",
        "-1",         "0",     "1",    "2147483648", "0x1p-1", "4294967295",
        "4294967296", "",      "1e",   "--1",        "1.5",    "99999999999999999999",
        ".",          "1,5",   "-0",   "3e38",       "1e-45",  "\"\"",
        "null",       "[]",    "4",    "1e6",        "1e30",   "0.25",
        "2",          "65536", "-2",   "+7",         "1e-9",   "#"};
    size_t from = chance(b->size);
    while (from < b->size && !strchr("0123456789.-", b->at[from]))
        from++;
    size_t end = from;
    while (end < b->size && b->at[end] && strchr("0123456789.-+e", b->at[end]))
        end++;
    char plain[32];
    snprintf(plain, sizeof plain, chance(2) ? "%.0f" : "%g", chance(900) / 100.0);
    const char *by = chance(2) ? plain : odd[chance(sizeof odd / sizeof *odd)];
    replace(b, from, end - from, by, strlen(by));
}

static void odd_word(struct bytes *b)
{
    static const char *const odd[] = {"usemtl\n",
                                      "newmtl\n",
                                      "mtllib room.mtl\n",
                                      "f 1 2 3\n",
                                      "v 0 0\n",
                                      "\n\n",
                                      "  ",
                                      "\t",
                                      "# ",
                                      "\\\n",
                                      "Kd .5\n",
                                      "Ke 1 1\n",
                                      "f -1 -2 -3\n",
                                      "usemtl lamp\n",
                                      "f 1//1 2 3/\n",
                                      "{",
                                      "}",
                                      "<p>",
                                      "endsolid\n",
                                      "end_header\n",
                                      "element face 2\n",
                                      "property list uchar uint z\n"};
    const char *by = odd[chance(sizeof odd / sizeof *odd)];
    size_t from = chance(b->size + 1);
    while (from > 0 && from < b->size && b->at[from - 1] != '\n' && chance(60))
        from++;
    replace(b, from, 0, by, strlen(by));
}

static void odd_bytes(struct bytes *b)
{
    static const uint32_t odd[] = {0x7fc00000, 0x7f800000, 0xff800000, 0x7f7fffff, 0x00000001,
                                   0,          0xffffffff, 0x7fffffff, 0x80000000, 0x3f800000,
                                   0x0000ffff, 0x00010000, 0x49742400};
    uint32_t by = odd[chance(sizeof odd / sizeof *odd)];
    if (b->size >= 4)
        memcpy(b->at + chance(b->size - 3), &by, 2 + 2 * chance(2));
}

/* Where the line of a place begins and, behind its break, ends. */
static size_t line_at(const struct bytes *b, size_t place, size_t *end)
{
    size_t from = place;
    while (from > 0 && b->at[from - 1] != '\n')
        from--;
    const unsigned char *last = memchr(b->at + place, '\n', b->size - place);
    *end = last ? (size_t)(last - b->at) + 1 : b->size;
    return from;
}

static void swap_lines(struct bytes *b)
{
    static struct bytes was;
    size_t end[2],
        from[2] = {line_at(b, chance(b->size), &end[0]), line_at(b, chance(b->size), &end[1])};
    const int first = from[0] > from[1];
    if (from[0] == from[1])
        return;
    was = *b;
    b->size = from[first];
    for (int part = 0; part < 3; part++) {
        size_t begin = part == 1 ? end[first] : from[part ? first : !first],
               stop = part == 1 ? from[!first] : end[part ? first : !first];
        memcpy(b->at + b->size, was.at + begin, stop - begin);
        b->size += stop - begin;
    }
    memcpy(b->at + b->size, was.at + end[!first], was.size - end[!first]);
    b->size = was.size;
}

static void line_ends(struct bytes *b)
{
    static struct bytes was;
    was = *b;
    b->size = 0;
    const int kind = (int)chance(3);
    if (kind == 2)
        replace(b, 0, 0, "\xEF\xBB\xBF", 3);
    for (size_t i = 0; i < was.size && b->size + 2 < ROOM; i++) {
        if (was.at[i] == '\n' && kind < 2)
            b->at[b->size++] = '\r';
        if (was.at[i] != '\n' || kind)
            b->at[b->size++] = was.at[i];
    }
}

static void damage(struct bytes *b, const struct bytes *other)
{
    static unsigned char block[64];
    const size_t place = chance(b->size), size = 1 + chance(b->size - place);
    const size_t some = size < sizeof block ? size : 1 + chance(sizeof block - 1);
    if (!b->size)
        return;
    memcpy(block, b->at + place, some);
    switch (chance(18)) {
    case 0:
        b->at[place] ^= (unsigned char)(1 << chance(8));
        break;
    case 1:
        b->at[place] = (unsigned char)chance(256);
        break;
    case 2:
        b->size = place;
        break;
    case 3:
        replace(b, place, some, "", 0);
        break;
    case 4:
        replace(b, chance(b->size + 1), 0, block, some);
        break;
    case 5:
        line_ends(b);
        break;
    case 6: {
        size_t end, from = line_at(b, place, &end), to = chance(b->size);
        if (end - from < sizeof block) { /* a line once more, elsewhere */
            memcpy(block, b->at + from, end - from);
            to = line_at(b, to, &(size_t){0});
            replace(b, to, 0, block, end - from);
        }
        break;
    }
    case 7:
        swap_lines(b);
        break;
    case 8: {
        size_t from = chance(other->size), part = other->size - from;
        replace(b, place, 0, other->at + from, part < 64 ? part : 1 + chance(64));
        break;
    }
    case 9:
        odd_bytes(b);
        break;
    case 10:
        odd_word(b);
        break;
    default:
        odd_number(b);
    }
}

/* ---- judgement, in the process of one file: 0, or the exit status after a message */

enum { READ_PLAIN = 80, READ_UNSURE, REFUSED, WRONG };

static _Noreturn void wrong(const char *what, uint32_t face, double got, double wanted)
{
    fprintf(stderr, "WRONG: %s: face %u: %.17g, not %.17g\n", what, (unsigned)face, got, wanted);
    _exit(WRONG);
}

/* Newell's; *flat: is it a triangle, or flat and convex, and is its area more than rounding? */
static double area_of(const struct plain_face *f, int *flat)
{
    double normal[3] = {0}, length, longest = 0, far = 0;
    for (uint32_t i = 0; i < f->corners; i++) {
        const double *p = f->corner[i], *q = f->corner[(i + 1) % f->corners], *o = f->corner[0];
        double edge = 0;
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            normal[k] += .5 * ((p[a] - o[a]) * (q[b] - o[b]) - (p[b] - o[b]) * (q[a] - o[a]));
            edge += (p[k] - q[k]) * (p[k] - q[k]);
            far = fmax(far, fabs(p[k]));
        }
        longest = fmax(longest, sqrt(edge));
    }
    length = sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    *flat = f->corners >= 3 && isfinite(length) && length > 1e-5 * longest * longest
            && far < 1e6 * longest && longest > 1e-15;
    double round = 0; /* all turns; a convex outline makes one */
    for (uint32_t i = 0; i < f->corners && *flat && f->corners > 3; i++) {
        const double *p = f->corner[i], *q = f->corner[(i + 1) % f->corners],
                     *r = f->corner[(i + 2) % f->corners];
        double turn = 0, high = 0, on = 0;
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            turn += normal[k] / length
                    * ((q[a] - p[a]) * (r[b] - q[b]) - (q[b] - p[b]) * (r[a] - q[a]));
            high += normal[k] / length * (p[k] - f->corner[0][k]);
            on += (q[k] - p[k]) * (r[k] - q[k]);
        }
        round += atan2(turn, on);
        *flat = turn > 1e-9 * longest * longest && fabs(high) < 1e-12 * longest && round < 7;
    }
    return length;
}

struct box {
    double low[3], high[3];
};

static void grow(struct box *box, const struct plain_face *f)
{
    for (uint32_t c = 0; c < f->corners; c++)
        for (int k = 0; k < 3; k++) {
            box->low[k] = fmin(box->low[k], f->corner[c][k]);
            box->high[k] = fmax(box->high[k], f->corner[c][k]);
        }
}

static struct box box_of(const struct plain_face *f, uint32_t count)
{
    struct box box = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (uint32_t i = 0; i < count; i++)
        grow(&box, &f[i]);
    return box;
}

static double width(const struct box *b)
{
    return fmax(fmax(b->high[0] - b->low[0], b->high[1] - b->low[1]), b->high[2] - b->low[2]);
}

/* The farthest of g's corners from f's plane. */
static double distance(const struct plain_face *f, const struct plain_face *g)
{
    double normal[3], most = 0;
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        const double *o = f->corner[0];
        normal[k] = 0;
        for (uint32_t c = 0; c < f->corners; c++) {
            const double *p = f->corner[c], *q = f->corner[(c + 1) % f->corners];
            normal[k] += (p[a] - o[a]) * (q[b] - o[b]) - (p[b] - o[b]) * (q[a] - o[a]);
        }
    }
    const double length =
        sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    for (uint32_t c = 0; c < g->corners; c++) {
        double high = 0;
        for (int k = 0; k < 3; k++)
            high += normal[k] / length * (g->corner[c][k] - f->corner[0][k]);
        most = isnan(high) ? 0 : fmax(most, fabs(high));
    }
    return most;
}

/* May another face of the file lie on it in part? Then less of it may be left. What is nearer than
 * rays keep off surfaces, 2^-18 of the scene, may be taken for one plane. */
static int may_be_covered(const struct plain_scene *s, uint32_t i)
{
    const struct box all = box_of(s->face, s->count), own = box_of(&s->face[i], 1);
    const struct plain_face *f = &s->face[i];
    for (uint32_t j = 0; j < s->count; j++) {
        const struct plain_face *g = &s->face[j];
        const struct box other = box_of(g, 1);
        const double near = 1e-4 * (width(&own) + width(&other)) + 0x1p-17 * width(&all);
        int meet = j != i && f->corners >= 3 && g->corners >= 3;
        for (int k = 0; k < 3; k++)
            meet &= own.low[k] <= other.high[k] + near && other.low[k] <= own.high[k] + near;
        uint32_t shared = 0;
        for (uint32_t c = 0; c < f->corners * g->corners && meet; c++)
            shared +=
                memcmp(f->corner[c % f->corners], g->corner[c / f->corners], sizeof f->corner[0])
                == 0;
        if (meet && (shared >= f->corners || distance(f, g) <= near || distance(g, f) <= near))
            return 1;
    }
    return 0;
}

static int same_corners(const struct scene_file *f, size_t at, const struct plain_face *p)
{
    for (uint32_t j = 0; j < p->corners; j++)
        for (int k = 0; k < 3; k++) {
            double x = f->positions[3 * (size_t)f->indices[at + j] + (size_t)k];
            if (x < p->corner[j][k] || x > p->corner[j][k])
                return 0;
        }
    return 1;
}

static void compare(const struct open_scene *s, const struct plain_scene *plain)
{
    const struct scene_file *f = &s->file;
    const double *areas = radGetScenePolygonAreas(s->scene);
    size_t at = 0;
    if (f->polygon_count != plain->count)
        wrong("number of faces", 0, f->polygon_count, plain->count);
    for (uint32_t i = 0; i < plain->count; at += f->sizes[i++]) {
        const struct plain_face *p = &plain->face[i];
        const struct RadMaterial *m = &f->materials[f->polygon_materials[i]];
        int flat;
        const double area = area_of(p, &flat);
        if (f->sizes[i] != p->corners)
            wrong("corners", i, f->sizes[i], p->corners);
        for (int k = 0; k < 3; k++) {
            if (fabs(m->reflectance[k] - p->reflectance[k]) > 0)
                wrong("reflectance", i, m->reflectance[k], p->reflectance[k]);
            if (fabs(m->exitance[k] - p->exitance[k]) > 0)
                wrong("exitance", i, m->exitance[k], p->exitance[k]);
        }
        if (!same_corners(f, at, p))
            wrong("corners' places", i, 0, 0);
        if (flat && !may_be_covered(plain, i) && !(fabs(areas[i] - area) <= SAME_AREA * area))
            wrong("area", i, areas[i], area);
    }
}

static void check_finite(const struct open_scene *s)
{
    const struct scene_file *f = &s->file;
    const double *areas = radGetScenePolygonAreas(s->scene);
    size_t corners = 0;
    for (uint32_t i = 0; i < f->polygon_count; i++)
        corners += f->sizes[i];
    for (size_t i = 0; i < 3 * corners; i++) { /* what no face has may be what it likes */
        const double x = f->positions[3 * (size_t)f->indices[i / 3] + i % 3];
        if (!isfinite(x))
            wrong("corner", (uint32_t)(i / 3), x, 0);
    }
    for (uint32_t i = 0; i < f->polygon_count; i++) {
        const struct RadMaterial *m = &f->materials[f->polygon_materials[i]];
        if (!(areas[i] >= 0 && areas[i] <= DBL_MAX))
            wrong("area", i, areas[i], 0);
        for (int k = 0; k < 3; k++)
            if (!(m->reflectance[k] >= 0 && m->reflectance[k] < 1 && m->exitance[k] >= 0
                  && m->exitance[k] <= DBL_MAX))
                wrong("material", i, m->reflectance[k], m->exitance[k]);
    }
}

/* Whatever it costs, it ends, and in numbers. */
static void solve(const struct open_scene *s)
{
    const struct RadSolveOptions how = {.limits = {.elements = 20000, .links = 200000}};
    RadOracle oracle = radNewOracle(s->device, "bf_guarded", RAD_RELEASE_FLAT);
    if (oracle) {
        radSetOracleParameter(oracle, "min_share", 0.01);
        radSetOracleParameter(oracle, "relative", 0.2);
    }
    RadSolution solution = oracle ? radNewSolution(s->scene, oracle, &how) : NULL;
    double *values = malloc(((size_t)s->report.polygons + 1) * 3 * sizeof *values);
    const int failed = !values || !solution || radSolve(solution);
    if (failed && !(solution && radGetDeviceError(s->device) == RAD_ERROR_LIMIT)) {
        fprintf(stderr, "WRONG: not solved: %s\n", radGetDeviceErrorMessage(s->device));
        _exit(WRONG);
    }
    for (uint32_t band = 0; band < s->report.bands && !failed; band++) {
        double *part[3] = {values, values + s->report.polygons, values + 2 * s->report.polygons};
        if (radGetPolygonValues(solution, band, part[0], part[1]))
            wrong("no values", 0, 0, 0);
        for (uint32_t i = 0; i < s->report.polygons; i++)
            if (!isfinite(part[0][i]) || !isfinite(part[1][i]))
                wrong("value", i, part[0][i], part[1][i]);
    }
    free(values);
    radReleaseSolution(solution);
    radReleaseOracle(oracle);
}

static _Noreturn void judge(const char *path, const char *log)
{
    static struct plain_scene plain;
    struct open_scene s;
    int to = open(log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(to, STDERR_FILENO);
    close(to);
    alarm(SANITIZED ? 60 : 10);
    const enum plain sure = plain_reading(&plain, path);
    if (open_scene(&s, path, &(struct scene_options){.quiet = 1}, 1))
        _exit(REFUSED);
    check_finite(&s);
    if (sure == DAMAGED)
        wrong("this is damaged, but read", 0, 0, 0);
    if (sure == PLAIN)
        compare(&s, &plain);
    if (s.report.faces)
        solve(&s);
    close_scene(&s);
    _exit(sure == PLAIN ? READ_PLAIN : READ_UNSURE);
}

/* ---- the parent */

static void read_seed(const char *name, struct bytes *b)
{
    char path[256];
    snprintf(path, sizeof path, "tests/solver/formats/%s", name);
    FILE *f = fopen(path, "rb");
    b->size = f ? fread(b->at, 1, ROOM, f) : 0;
    if (!b->size) {
        fprintf(stderr, "cannot read %s: run from the top folder\n", path);
        exit(2);
    }
    fclose(f);
}

static void write_to(const char *path, const struct bytes *b)
{
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(b->at, 1, b->size, f) != b->size || fclose(f)) {
        fprintf(stderr, "cannot write %s: %s\n", path, strerror(errno));
        exit(2);
    }
}

static void keep(const char *name, const struct bytes *b, unsigned number)
{
    const char *found = getenv("FUZZ_FOUND");
    char path[512];
    if (!found)
        return;
    snprintf(path, sizeof path, "%.200s/%u", found, number);
    mkdir(found, 0777);
    mkdir(path, 0777);
    snprintf(path + strlen(path), sizeof path - strlen(path), "/%.100s", name);
    write_to(path, b);
}

/* Is the log one line, "FILE...: error: ...", as every refusal has? */
static int one_line(const char *text)
{
    const char *end = strchr(text, '\n');
    return end && !end[1] && strstr(text, ": error: ") != NULL;
}

static unsigned counts[WRONG + 1];

/* Returns what was wrong, NULL: nothing. A sound file must be read. */
static const char *try_file(const char *path, const char *log, int sound)
{
    static char said[2000];
    struct rusage used = {0};
    int status;
    fflush(NULL);
    pid_t child = fork();
    if (child == 0)
        judge(path, log);
    while (child < 0 || wait4(child, &status, 0, &used) < 0)
        if (child < 0 || errno != EINTR) {
            fprintf(stderr, "cannot start a process: %s\n", strerror(errno));
            exit(2);
        }
    FILE *f = fopen(log, "r");
    size_t size = f ? fread(said, 1, sizeof said - 1, f) : 0;
    if (f)
        fclose(f);
    said[size] = 0;
    if (WIFSIGNALED(status)) {
        static char ended[2100];
        snprintf(ended, sizeof ended, "%s %s",
                 WTERMSIG(status) == SIGALRM ? "it hangs" : strsignal(WTERMSIG(status)), said);
        return ended;
    }
    const int code = WEXITSTATUS(status);
    if (code < READ_PLAIN || code >= WRONG)
        return said;
    counts[code]++;
    if (code == REFUSED && (sound || !one_line(said)))
        return *said ? said : "refused without a word";
    return !SANITIZED && used.ru_maxrss / 1024 > MEGABYTES + 100 ? "it takes a gigabyte" : NULL;
}

static double setting(const char *name, double otherwise)
{
    const char *text = getenv(name);
    return text && *text ? atof(text) : otherwise;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

int main(void)
{
    static struct bytes whole[SEEDS][2], made[2];
    const double files = setting("FUZZ_FILES", SANITIZED ? FILES / 2 : FILES), begun = now(),
                 limit = setting("FUZZ_SECONDS", 0);
    const uint64_t seed = (uint64_t)setting("FUZZ_SEED", 1);
    unsigned failed = 0, number = 0;
    if (folder_make("damaged") < 0)
        return EXIT_FAILURE;
    for (size_t i = 0; i < SEEDS; i++) {
        read_seed(seeds[i].name, &whole[i][0]);
        if (seeds[i].beside)
            read_seed(seeds[i].beside, &whole[i][1]);
    }
    char log[512];
    snprintf(log, sizeof log, "%s", in_folder("said"));
    for (; limit > 0 ? now() - begun < limit : number < files; number++) {
        const size_t i = number % SEEDS;
        state = (seed * 1000003 + number) * 0x9E3779B97F4A7C15u + 1;
        chance(2);
        memcpy(made, whole[i], sizeof made);
        for (uint32_t n = number < SEEDS ? 0 : 1 + chance(2) * chance(3); n > 0; n--)
            damage(&made[seeds[i].beside && chance(2)], &whole[chance(SEEDS)][0]);
        write_to(in_folder(seeds[i].name), &made[0]);
        if (seeds[i].beside)
            write_to(in_folder(seeds[i].beside), &made[1]);
        const char *what = try_file(in_folder(seeds[i].name), log, number < SEEDS);
        if (!what)
            continue;
        failed++;
        printf("failed: file %u, of %s: %.*s\n", number, seeds[i].name, (int)strcspn(what, "\n"),
               what);
        keep(seeds[i].name, &made[0], number);
        if (seeds[i].beside)
            keep(seeds[i].beside, &made[1], number);
    }
    folder_remove();
    printf("damaged scenes: %u files in %.0f s: %u read and compared, %u read, %u refused, %u "
           "failed\n",
           number, now() - begun, counts[READ_PLAIN], counts[READ_UNSURE], counts[REFUSED], failed);
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
