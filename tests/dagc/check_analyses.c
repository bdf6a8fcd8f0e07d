/* check_analyses.c - what dagc says of random graphs against a walk over all their paths.
 *
 * The analyses sweep each graph a few times and may not enumerate its paths; here the graphs are
 * small, so all paths are walked, and for every node and decision both must say the same.
 * Run from the top folder.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "dag.h"
#include "suite.h"

enum { NODES = 9, GRAPHS = 3000, DECISIONS = 3 };

/* As in tests/dagc/analysis_catalog.dag, all that the analyses may look at. */
enum { SIZE = 1, CLEAR = 2 };
static const struct tool_fact {
    const char *call, *answers[3];
    int reads, writes, size; /* size: the level it writes */
    int guards;              /* the answer that allows a split, + 1; -1: behind side(right) alone */
    int needs_fine;
} tools[] = {
    {"look(rays = 4)", {"none", "some", "all"}, SIZE, CLEAR, 0, 0, 0},
    {"look(rays = 9)", {"none", "some", "all"}, SIZE, CLEAR, 0, 0, 0},
    {"weigh()", {"light", "heavy"}, SIZE, 0, 0, 0, 0},
    {"weigh(limit = 2)", {"light", "heavy"}, SIZE, 0, 0, 0, 0},
    {"side()", {"left", "right"}, 0, 0, 0, 0, 0},
    {"small()", {"yes", "no"}, 0, 0, 0, 2, 0},
    {"again()", {"left", "right"}, 0, 0, 0, -1, 0},
    {"again(limit = 0)", {"left", "right"}, 0, 0, 0, 0, 0},
    {"judge()", {"good", "bad"}, SIZE, 0, 0, 0, 1},
    {"estimate()", {"done"}, 0, SIZE, 1, 0, 0},
    {"measure()", {"done"}, 0, SIZE, 2, 0, 0},
    {"prove()", {"done"}, 0, SIZE, 3, 0, 0},
};
enum { TOOLS = sizeof tools / sizeof *tools };
static const char *const decisions[] = {"keep", "drop", "split"};

struct graph {
    int count, tool[NODES];
    int target[NODES][3]; /* a node, or -1 - decision */
    int written;          /* bytes in text */
    char text[4096];
};

/* What the walk finds. */
struct findings {
    int reached[NODES];
    int least[NODES];            /* the least level of size before a node */
    int lacks_size, lacks_clear; /* some path to keep */
    int judge_lacks, unguarded;
    /* outcomes for the node's own question, a bit per answer */
    int unasked[NODES], answers[NODES];
    int arc_unasked[NODES][NODES][3], arc_asked[NODES][NODES][3]; /* by arc, target first */
};

struct path {
    int length, node[NODES], answer[NODES];
};

static unsigned long long seed = 1;

static int pick(int count)
{
    seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
    return (int)((seed >> 33) % (unsigned)count);
}

static int answers_of(int tool)
{
    return tools[tool].answers[1] == NULL ? 1 : tools[tool].answers[2] == NULL ? 2 : 3;
}

static void make(struct graph *g)
{
    int few = pick(3); /* sometimes few tools, so that questions repeat */
    g->count = 2 + pick(NODES - 1);
    g->written = snprintf(g->text, sizeof g->text, "oracle t { start n0;\n");
    for (int n = 0; n < g->count; n++) {
        int tool = g->tool[n] = few ? (pick(4) + few * 2) % TOOLS : pick(TOOLS);
        g->written += snprintf(g->text + g->written, sizeof g->text - (size_t)g->written,
                               "node n%d = %s {", n, tools[tool].call);
        for (int a = 0; a < answers_of(tool); a++) {
            int left = g->count - n - 1, node = left > 0 && pick(4) > 0;
            int to = g->target[n][a] =
                node ? n + 1 + pick(left < 3 ? left : 3) : -1 - pick(DECISIONS);
            char name[32];
            if (node)
                snprintf(name, sizeof name, "n%d", to);
            else
                snprintf(name, sizeof name, "%s", decisions[-1 - to]);
            g->written += snprintf(g->text + g->written, sizeof g->text - (size_t)g->written,
                                   " %s -> %s;", tools[tool].answers[a], name);
        }
        g->written += snprintf(g->text + g->written, sizeof g->text - (size_t)g->written, " }\n");
    }
    g->written += snprintf(g->text + g->written, sizeof g->text - (size_t)g->written, "}\n");
}

/* May tool t change what question q answers? */
static int changes(int t, int q)
{
    return (tools[t].writes & tools[q].reads) != 0
           || (t != q && (tools[t].writes & tools[q].writes) != 0);
}

/* The answer that the path has to the tool's question: -1 none; -2 the path contradicts itself. */
static int known(const struct graph *g, const struct path *p, int tool)
{
    int answer = -1;
    for (int i = 0; i < p->length; i++) {
        int t = g->tool[p->node[i]];
        if (t == tool) {
            if (answer >= 0 && answer != p->answer[i])
                return -2;
            answer = changes(t, t) ? -1 : p->answer[i];
        } else if (changes(t, tool))
            answer = -1;
    }
    return answer;
}

/* Does the path agree with itself? */
static int consistent(const struct graph *g, const struct path *p)
{
    for (int t = 0; t < TOOLS; t++)
        if (known(g, p, t) == -2)
            return 0;
    return 1;
}

/* Does the last answer of the path allow a split? */
static int allowed(const struct graph *g, const struct path *p)
{
    int last = p->length - 1, guards = tools[g->tool[p->node[last]]].guards, behind = 0;
    for (int i = 0; i < last; i++)
        behind |= strcmp(tools[g->tool[p->node[i]]].call, "side()") == 0 && p->answer[i] == 1;
    return guards < 0 ? p->answer[last] == 0 && behind : p->answer[last] + 1 == guards;
}

static void walk(const struct graph *g, struct path *p, int at, int size, int clear, int guarded,
                 struct findings *f)
{
    int tool = g->tool[at], before = known(g, p, tool);
    if (!f->reached[at] || size < f->least[at])
        f->least[at] = size;
    f->reached[at] = 1;
    f->judge_lacks |= tools[tool].needs_fine && size < 2;
    if (before != -2) {
        int *unasked = NULL, *asked = NULL;
        if (p->length > 0) {
            int from = p->node[p->length - 1], answer = p->answer[p->length - 1];
            unasked = &f->arc_unasked[at][from][answer];
            asked = &f->arc_asked[at][from][answer];
        }
        if (before == -1) {
            f->unasked[at] = 1;
            if (unasked != NULL)
                *unasked = 1;
        } else {
            f->answers[at] |= 1 << before;
            *asked = 1;
        }
    }
    if (tools[tool].size > size)
        size = tools[tool].size;
    clear |= (tools[tool].writes & CLEAR) != 0;
    for (int a = 0; a < answers_of(tool); a++) {
        int to = g->target[at][a];
        p->node[p->length] = at;
        p->answer[p->length++] = a;
        if (to >= 0)
            walk(g, p, to, size, clear, guarded || allowed(g, p), f);
        else if (to == -1) {
            f->lacks_size |= size < 2;
            f->lacks_clear |= !clear;
        } else if (to == -3)
            f->unguarded |= !guarded && !allowed(g, p) && consistent(g, p);
        p->length--;
    }
}

/* Is there a line with both texts? */
static int says(const char *said, const char *warning, const char *what)
{
    for (const char *line = said; *line != '\0';) {
        const char *end = strchr(line, '\n');
        const char *w = strstr(line, warning), *t = strstr(line, what);
        if (w != NULL && w < end && t != NULL && t < end)
            return 1;
        line = end + 1;
    }
    return 0;
}

static void compare(const struct graph *g, const char *said, const char *warning, const char *what,
                    int wanted)
{
    ck_assert_msg(says(said, warning, what) == (wanted != 0), "%s %s: %s expected of\n%s\n%s",
                  warning, what, wanted ? "" : "not", g->text, said);
}

static void check_questions(const struct graph *g, const char *said, const struct findings *f,
                            int n)
{
    char path_to[32], it[32];
    int bits = f->answers[n], single = bits != 0 && (bits & (bits - 1)) == 0;
    int implied = single && !f->unasked[n], arc = 0, command = answers_of(g->tool[n]) == 1;
    for (int m = 0; m < NODES; m++)
        for (int a = 0; a < 3; a++)
            arc |= f->arc_asked[n][m][a] && !f->arc_unasked[n][m][a];
    int repeated = !implied && !command && bits != 0 && (!f->unasked[n] || arc);
    snprintf(path_to, sizeof path_to, "path to 'n%d'", n);
    snprintf(it, sizeof it, "'n%d' ", n);
    compare(g, said, "-Wimplied-answer]", it, implied);
    compare(g, said, "-Wrepeated-question]", path_to, repeated);
    compare(g, said, "-Wshared-question]", path_to, !implied && !command && bits != 0 && !repeated);
}

START_TEST(random_graphs)
{
    static struct graph g;
    static struct findings f;
    static char catalog[8192];
    FILE *file = fopen("tests/dagc/analysis_catalog.dag", "rb");
    ck_assert_msg(file != NULL, "run from the top folder");
    catalog[fread(catalog, 1, sizeof catalog - 1, file)] = '\0';
    fclose(file);
    for (int i = 0; i < GRAPHS; i++) {
        struct path path = {0, {0}, {0}};
        char *said = NULL;
        size_t length = 0;
        make(&g);
        memset(&f, 0, sizeof f);
        walk(&g, &path, 0, 0, 0, 0, &f);
        FILE *errors = open_memstream(&said, &length);
        struct dag *dag = dag_load_switched("all no-error=missing-term no-error=unguarded-split",
                                            "t", g.text, strlen(g.text), NULL, catalog, errors);
        fclose(errors);
        ck_assert_msg(dag != NULL, "%s\n%s", g.text, said);
        dag_free(dag);
        compare(&g, said, "-Wmissing-term]", "'keep' needs size", f.lacks_size);
        compare(&g, said, "-Wmissing-term]", "'keep' needs clear", f.lacks_clear);
        compare(&g, said, "-Wmissing-term]", "'judge' needs size", f.judge_lacks);
        compare(&g, said, "-Wunguarded-split]", "'split'", f.unguarded);
        int falling = 0;
        for (int n = 0; n < g.count; n++) {
            char name[32];
            snprintf(name, sizeof name, "the node 'n%d'", n);
            compare(&g, said, "-Wunreachable-node]", name, !f.reached[n]);
            int level = tools[g.tool[n]].size;
            falling |= f.reached[n] && level > 0 && level < f.least[n];
            if (f.reached[n])
                check_questions(&g, said, &f, n);
        }
        compare(&g, said, "-Wfalling-precision]", "computes size", falling);
        free(said);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("analyses");
    TCase *random = tcase_create("random");
    tcase_set_timeout(random, 120);
    tcase_add_test(random, random_graphs);
    suite_add_tcase(suite, random);
    return suite_failures(suite) != 0;
}
