/* watch_pair.c - see watch_pair.h.
 * SPDX-License-Identifier: MIT */
#include "commands/watch_pair.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "geometry.h"
#include "output/explanation.h"
#include "util/array.h"
#include "util/device.h"
#include "util/report.h"

/* ---- one discussion */

void occasion_free(struct occasion *o)
{
    if (!o)
        return;
    free(o->text);
    json_decref(o->json);
    free(o);
}

/* Remember a discussion with what was made of it. NULL when out of memory. */
static struct occasion *make_occasion(const struct discussion *before,
                                      const struct RadExplanation *x)
{
    struct occasion *o = calloc(1, sizeof *o);
    size_t size = 0;
    FILE *out = o ? open_memstream(&o->text, &size) : NULL;
    if (!out) {
        free(o);
        return NULL;
    }
    explanation_print(out, x);
    const int failed = fclose(out) != 0 || !o->text;
    o->json = explanation_json(x);
    if (failed || !o->json) {
        occasion_free(o);
        return NULL;
    }
    o->way = x->way;
    o->rays = (uint32_t)x->rays;
    o->nodes = x->asked_count;
    o->decision = x->decision_name;
    o->elements[0] = *before->receiver;
    o->elements[1] = *before->emitter;
    o->host = *before->host;
    o->discussion = *before;
    o->discussion.receiver = &o->elements[0];
    /* tools that ask whether the two are the same ask by address */
    o->discussion.emitter = before->receiver == before->emitter ? &o->elements[0] : &o->elements[1];
    o->discussion.host = &o->host;
    if (before->blockers) {
        o->list = *before->blockers;
        o->discussion.blockers = &o->list;
    }
    return o;
}

struct occasion *occasion_hold(RadDevice device, RadSolution solution, RadOracle oracle,
                               const uint32_t element[2], const char *where)
{
    struct RadElements tree;
    radGetElements(solution, &tree);
    const struct discussion d = {.receiver = &tree.elements[element[0]],
                                 .emitter = &tree.elements[element[1]],
                                 .host = radGetHost(solution)};
    struct RadExplanation x;
    if (radExplain(solution, oracle, &d, &x) < 0) {
        report_device(device, where);
        return NULL;
    }
    struct occasion *o = make_occasion(&d, &x);
    if (!o) {
        report_error(where, 0, "out of memory");
        return NULL;
    }
    o->receiver = element[0];
    o->emitter = element[1];
    return o;
}

/* ---- lines of elements */

/* The child at the point, or the one that the name goes on with; -1: neither. */
static int next_child(struct watched_end *end, const struct element *elements,
                      const struct element *e)
{
    if (*end->name) {
        if (*end->rest != '/')
            return -1;
        char *after;
        const unsigned long child = strtoul(end->rest + 1, &after, 10);
        if (child >= e->children)
            return -1;
        end->rest = after;
        return (int)child;
    }
    double nearest = INFINITY;
    int found = -1;
    for (int k = 0; k < e->children; k++) {
        const struct element *c = &elements[e->child + (uint32_t)k];
        const double d = polygon_distance(end->point, c->vertex, c->vertices, c->normal);
        if (d < nearest) {
            nearest = d;
            found = k;
        }
    }
    return found;
}

static int push(struct watched_end *end, uint32_t element)
{
    if (array_reserve(&end->line, end->count + 1, &end->capacity, sizeof *end->line) < 0)
        return -1;
    end->line[end->count++] = element;
    return 0;
}

/* As far down as there are elements now. Returns 0, or -1 when out of memory. */
static int extend(struct watched_end *end, const struct element *elements)
{
    for (;;) {
        const struct element *e = &elements[end->line[end->count - 1]];
        const int child = e->children ? next_child(end, elements, e) : -1;
        if (child < 0)
            return 0;
        if (push(end, e->child + (uint32_t)child) < 0)
            return -1;
    }
}

/* A pass has ended: what it has split is numbered anew. Returns 0, or -1 when out of memory. */
static int extend_anew(struct watch *w, const struct element *elements)
{
    for (int i = 0; i < 2; i++) {
        struct watched_end *end = &w->end[i];
        end->count = end->begun;
        if (*end->name)
            end->rest = end->name + strcspn(end->name, "/");
        if (extend(end, elements) < 0)
            return -1;
    }
    return 0;
}

static int is_on(const struct watched_end *end, uint32_t element)
{
    for (size_t i = end->count; i-- > 0;)
        if (end->line[i] == element)
            return 1;
    return 0;
}

static int note(void *user, const struct RadTraced *t)
{
    struct watch *w = user;
    const struct element *elements = *t->before->host->elements;
    if ((t->pass != w->pass && extend_anew(w, elements) < 0) || extend(&w->end[0], elements) < 0
        || extend(&w->end[1], elements) < 0)
        return w->failed = 1;
    w->pass = t->pass;
    if (!is_on(&w->end[0], t->receiver) || !is_on(&w->end[1], t->emitter))
        return 0;
    struct RadExplanation x;
    if (radExplain(w->solution, w->oracle, t->before, &x) < 0
        || array_reserve(&w->occasions, w->count + 1, &w->capacity, sizeof *w->occasions) < 0)
        return w->failed = 1;
    struct occasion *o = make_occasion(t->before, &x);
    if (!o)
        return w->failed = 1;
    o->pass = t->pass;
    o->round = t->round;
    o->receiver = t->receiver;
    o->emitter = t->emitter;
    w->occasions[w->count++] = o;
    return 0;
}

/* ---- what was asked for */

int watch_split(const char *pair, char name[2][RAD_NAME])
{
    const char *comma = strchr(pair, ',');
    const size_t first = comma ? (size_t)(comma - pair) : 0, second = comma ? strlen(comma + 1) : 0;
    if (!first || !second || first >= RAD_NAME || second >= RAD_NAME || strchr(comma + 1, ','))
        return -1;
    memcpy(name[0], pair, first);
    name[0][first] = 0;
    memcpy(name[1], comma + 1, second + 1);
    return 0;
}

static int read_points(struct watch *w, const char *at)
{
    char *end;
    for (int side = 0; side < 2; side++)
        for (int k = 0; k < 3; k++) {
            w->end[side].point[k] = strtod(at, &end);
            if (end == at || !isfinite(w->end[side].point[k])
                || *end
                       != (k < 2  ? ','
                           : side ? 0
                                  : ':'))
                return -1;
            at = end + 1;
        }
    return 0;
}

/* From the root to where its line begins before anything is split. Returns 0, or -1 after an error
 * of the device, or 1 when out of memory. */
static int begin_line(struct watch *w, struct watched_end *end)
{
    char base[RAD_NAME];
    uint32_t element;
    if (*end->name) {
        const size_t length = strcspn(end->name, "/");
        snprintf(base, sizeof base, "%.*s", (int)length, end->name);
        end->rest = end->name + length;
        if (radFindElement(w->solution, base, &element) < 0)
            return -1;
    } else if (radFindFaceAt(w->solution, end->point, &element) < 0) {
        return -1;
    }
    struct RadElements tree;
    radGetElements(w->solution, &tree);
    size_t above = 0;
    for (uint32_t e = element; e != 0; e = tree.elements[e].parent)
        above++;
    for (size_t i = 0; i <= above; i++)
        if (push(end, element) < 0)
            return 1;
    for (size_t i = above; i-- > 0;)
        end->line[i] = tree.elements[end->line[i + 1]].parent;
    end->begun = end->count;
    return extend(end, tree.elements) < 0;
}

/* "/0/3": a slash and digits, again and again. */
static int is_rest(const char *rest)
{
    while (*rest == '/' && isdigit((unsigned char)rest[1]))
        for (rest++; isdigit((unsigned char)*rest); rest++)
            ;
    return *rest == 0;
}

int watch_open(struct watch *w, RadDevice device, RadSolution solution, RadOracle oracle,
               const char *pair, const char *at)
{
    char name[2][RAD_NAME];
    *w = (struct watch){.solution = solution, .oracle = oracle};
    if (pair && watch_split(pair, name) < 0) {
        report_error("--pair", 0, "'%s' is no pair; write RECEIVER,EMITTER, as 12/0,3", pair);
        return 2;
    }
    if (!pair && read_points(w, at) < 0) {
        report_error("--at", 0, "'%s' is not two points; write X,Y,Z:X,Y,Z in metres", at);
        return 2;
    }
    for (int i = 0; i < 2; i++) {
        struct watched_end *end = &w->end[i];
        if (pair)
            memcpy(end->name, name[i], sizeof end->name);
        if (pair && !is_rest(name[i] + strcspn(name[i], "/"))) {
            report_error("--pair", 0,
                         "'%s' names no element; 12 is a face, 12/0/3 a part of it, "
                         "root/1 a cluster",
                         name[i]);
            watch_close(w);
            return 2;
        }
        int status = begin_line(w, end);
        if (status < 0)
            report_device(device, pair ? "--pair" : "--at");
        else if (status > 0)
            report_error(pair ? "--pair" : "--at", 0, "out of memory");
        if (status) {
            watch_close(w);
            return 1;
        }
    }
    if (radTraceSolution(solution, note, w) == 0)
        return 0;
    report_device(device, pair ? "--pair" : "--at");
    watch_close(w);
    return 1;
}

static uint32_t on_line(const struct watched_end *end, const struct element *elements, uint64_t id)
{
    size_t i = end->count - 1;
    while (i > 0 && elements[end->line[i]].id != id)
        i--;
    return end->line[i];
}

int watch_settle(struct watch *w)
{
    struct RadElements tree;
    radGetElements(w->solution, &tree);
    if (extend_anew(w, tree.elements) < 0)
        return -1;
    for (size_t i = 0; i < w->count; i++) {
        struct occasion *o = w->occasions[i];
        o->receiver = on_line(&w->end[0], tree.elements, o->elements[0].id);
        o->emitter = on_line(&w->end[1], tree.elements, o->discussion.emitter->id);
    }
    return 0;
}

int watch_element(struct watch *w, int end, uint32_t *element)
{
    struct watched_end *e = &w->end[end];
    struct RadElements tree;
    radGetElements(w->solution, &tree);
    if (*e->name)
        return radFindElement(w->solution, e->name, element);
    *element = e->line[e->count - 1];
    return 0;
}

void watch_close(struct watch *w)
{
    for (size_t i = 0; i < w->count; i++)
        occasion_free(w->occasions[i]);
    free(w->occasions);
    free(w->end[0].line);
    free(w->end[1].line);
    *w = (struct watch){0};
}
