/* check_dagc.c - the compiler's library and command.
 *
 * The library: what a loaded graph looks like, the fingerprint, errors into a stream. Random
 * graphs: their structure, and that the C text generated for them makes the same calls with the
 * same arguments and decides alike as a walk over the graph. Mutated sources: an error or a graph,
 * never a crash. The scripts in dagc/ test the messages and the command. Run from the top folder.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "dag.h"
#include "suite.h"

static char dagc[4096];    /* the command */
static char catalog[8192]; /* text of dagc/test_catalog.dag */
static const char folder[] = "tests/dagc";

static char *read_file(const char *path, size_t *length)
{
    FILE *file = fopen(path, "rb");
    ck_assert_msg(file != NULL, "cannot read %s: run from the top folder", path);
    fseek(file, 0, SEEK_END);
    *length = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(*length + 1);
    ck_assert(text != NULL && fread(text, 1, *length, file) == *length);
    text[*length] = '\0';
    fclose(file);
    return text;
}

static void setup(void)
{
    size_t length;
    char *text = read_file("tests/dagc/test_catalog.dag", &length);
    ck_assert(length < sizeof catalog);
    memcpy(catalog, text, length + 1);
    free(text);
}

/* Graphs that are to be read, whether or not an analysis would let them pass. */
static struct dag *load(const char *text, FILE *errors)
{
    return dag_load_switched("no-all", "test.dag", text, strlen(text), "test_catalog.dag", catalog,
                             errors);
}

static const char small[] =
    "oracle small \"a doc\" {\n"
    "  param limit : flux = 2.5 in [0, 10] \"how much\";\n"
    "  param n : count = 3 in [1, 9];\n"
    "  start a;\n"
    "  node c = measure() { done -> keep; }\n"
    "  node b = weigh(share = 0.25, most = limit) { light -> c; heavy -> split; }\n"
    "  node a = look() { left -> b; right -> c; otherwise -> drop; }\n"
    "  node lost = tally(upto = n) { otherwise -> drop; }\n"
    "}\n";

/* ---- the library */

START_TEST(graph)
{
    struct dag *dag = load(small, stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag_oracle(dag, NULL), 0);
    ck_assert_int_eq(dag_oracle(dag, "small"), 0);
    ck_assert_int_eq(dag_oracle(dag, "other"), -1);
    const struct oracle_graph *oracle = &dag->oracles[0];
    ck_assert_str_eq(oracle->doc, "a doc");
    ck_assert_int_eq(oracle->parameters.count, 2);
    const struct parameter *limit = &dag->parameters[oracle->parameters.first];
    ck_assert_str_eq(limit->name, "limit");
    ck_assert_str_eq(limit->doc, "how much");
    ck_assert_str_eq(dag->types[limit->type].unit_text, "W/m2");
    ck_assert(limit->value == 2.5 && limit->low == 0 && limit->high == 10);
    ck_assert_int_eq(dag->types[limit[1].type].base, BASE_INTEGER);

    /* a, b, c from the start on; the last is not reached */
    ck_assert_int_eq(oracle->nodes.count, 4);
    ck_assert_int_eq(oracle->order.count, 3);
    const int *order = &dag->order[oracle->order.first];
    ck_assert_str_eq(dag->nodes[order[0]].name, "a");
    ck_assert_str_eq(dag->nodes[order[1]].name, "b");
    ck_assert_str_eq(dag->nodes[order[2]].name, "c");
    ck_assert_int_eq(oracle->start.index, order[0]);
    ck_assert_int_eq(dag->nodes[oracle->nodes.first + 3].order, -1);

    /* arguments in the tool's order: most, share */
    const struct node *b = &dag->nodes[order[1]];
    ck_assert_int_eq(b->arguments.count, 2);
    const struct argument *arguments = &dag->arguments[b->arguments.first];
    const struct expression *most = &dag->expressions[arguments[0].expression];
    const struct expression *share = &dag->expressions[arguments[1].expression];
    ck_assert_int_eq(most->kind, EXPRESSION_PARAMETER);
    ck_assert_int_eq(most->parameter, oracle->parameters.first);
    ck_assert(share->kind == EXPRESSION_NUMBER && share->number == 0.25);

    /* arcs in the order of the answers: left, right, neither */
    const struct arc *arcs = &dag->arcs[dag->nodes[order[0]].arcs.first];
    ck_assert(arcs[0].target.kind == TARGET_NODE && arcs[0].target.index == order[1]);
    ck_assert(arcs[1].target.kind == TARGET_NODE && arcs[1].target.index == order[2]);
    ck_assert_int_eq(arcs[2].target.kind, TARGET_DECISION);
    ck_assert_str_eq(dag->decisions[arcs[2].target.index].name, "drop");
    dag_free(dag);
    dag_free(NULL);
}
END_TEST

START_TEST(standard_catalog)
{
    struct dag *dag = dag_load("examples/oracles/bf.dag", NULL, NULL, stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_str_eq(dag->oracles[0].name, "bf");
    dag_free(dag);
}
END_TEST

START_TEST(errors_in_a_stream)
{
    char *text = NULL;
    size_t length = 0;
    FILE *errors = open_memstream(&text, &length);
    ck_assert_ptr_null(load("oracle t { start a; }", errors));
    ck_assert_ptr_null(dag_load("no/such/file.dag", NULL, NULL, errors));
    ck_assert_ptr_null(dag_load_text("x", "", 0, "broken", "type x", errors));
    fclose(errors);
    ck_assert_ptr_nonnull(strstr(text, "test.dag:1:18: error: "));
    ck_assert_ptr_nonnull(strstr(text, "cannot read no/such/file.dag"));
    ck_assert_ptr_nonnull(strstr(text, "broken:1:7: error: "));
    free(text);
    ck_assert_ptr_null(load("oracle t { start a; }", NULL));
    struct dag *dag = load("oracle a { start n; node n = look() { otherwise -> drop; } }"
                           "oracle b { start n; node n = look() { otherwise -> drop; } }",
                           stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag_oracle(dag, NULL), -1);
    ck_assert_int_eq(dag_oracle(dag, "b"), 1);
    dag_free(dag);
}
END_TEST

START_TEST(analyses)
{
    static const char text[] = "oracle t { start a; node a = look() { otherwise -> split; } }";
    char *said = NULL;
    size_t length = 0;
    FILE *errors = open_memstream(&said, &length);
    /* what is an error by nature refuses the graph; warnings are silent unless asked for */
    ck_assert_ptr_null(dag_load_text("t", text, strlen(text), NULL, catalog, errors));
    struct dag *dag =
        dag_load_switched("no-unguarded-split", "t", text, strlen(text), NULL, catalog, stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag->warning_count, 0);
    dag_free(dag);
    dag = dag_load_switched("no-error=unguarded-split idle-question", "t", text, strlen(text), NULL,
                            catalog, errors);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag->warning_count, 2);
    dag_free(dag);
    ck_assert_ptr_null(dag_load_switched("error idle-question no-all-of-it", "t", text,
                                         strlen(text), NULL, catalog, errors));
    fclose(errors);
    ck_assert_ptr_nonnull(strstr(said, "error: a path to 'split' holds no answer"));
    ck_assert_ptr_nonnull(strstr(said, "warning: 'a' decides nothing"));
    ck_assert_ptr_nonnull(strstr(said, "no warning is called 'no-all-of-it'"));
    free(said);
}
END_TEST

/* ---- the fingerprint */

static uint64_t fingerprint(const char *text)
{
    struct dag *dag = load(text, stderr);
    ck_assert_ptr_nonnull(dag);
    uint64_t result = dag->oracles[0].fingerprint;
    dag_free(dag);
    return result;
}

START_TEST(same_fingerprint)
{
    static const char other[] =
        "oracle renamed {fixed param limit:flux=25e-1 in[0,10];param n:count=3.0 in[1,9] "
        "\"doc\";start "
        "first;"
        "node first=look(){neither->drop;right->last;left->second;}# comment\n"
        "node second=weigh(most=limit,share=0.250){otherwise->split;light->last;}"
        "node last=measure(){otherwise->keep;} }";
    ck_assert(fingerprint(small) == fingerprint(other));
}
END_TEST

START_TEST(other_fingerprint)
{
    static const char *const changes[][2] = {
        {"2.5", "2.5000000000000004"},
        {"[1, 9]", "[1, 8]"},
        {"param n", "param m"},
        {"0.25", "0.5"},
        {"most = limit", "most = 2.5"},
        {"right -> c", "right -> b"},
        {"done -> keep", "done -> drop"},
        {"light -> c; heavy -> split", "light -> split; heavy -> c"},
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        const char *at = strstr(small, changes[i][0]);
        ck_assert_ptr_nonnull(at);
        char text[2048];
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - small), small, changes[i][1],
                 at + strlen(changes[i][0]));
        char *n = strcmp(changes[i][1], "param m") == 0 ? strstr(text, "= n)") : NULL;
        if (n != NULL)
            n[2] = 'm';
        ck_assert_msg(fingerprint(text) != fingerprint(small), "%s", changes[i][1]);
    }
}
END_TEST

/* ---- random graphs */

static uint64_t seed;

static int pick(int count)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int)((seed >> 33) % (uint64_t)count);
}

static void print_target(FILE *out, const int *names, int node, int nodes)
{
    static const char *const decisions[] = {"keep", "drop", "split"};
    if (node + 1 < nodes && pick(4) != 0) {
        int far = nodes - node - 1;
        fprintf(out, "n%d", names[node + 1 + pick(far < 6 || pick(5) == 0 ? far : 6)]);
    } else
        fprintf(out, "%s", decisions[pick(3)]);
}

static void print_arguments(FILE *out, int tool)
{
    if (tool == 1) {
        fprintf(out, "share = %s", pick(2) ? "ps" : pick(2) ? "0.1" : "1");
        if (pick(3))
            fprintf(out, ", most = %s", pick(2) ? "pf" : pick(2) ? "1e-300" : "inf");
    } else if (tool == 2 && pick(3)) {
        fprintf(out, "upto = %s", pick(2) ? "pc" : pick(2) ? "100" : "7");
        if (pick(2))
            fprintf(out, ", scale = %s", pick(2) ? "pc" : pick(2) ? "-0.0" : "-inf");
    }
}

/* Every arc leads to a node of a larger number or to a decision; names and the order in the text
 * are shuffled. */
static void print_graph(FILE *out, int number)
{
    static const char *const tools[] = {"look", "weigh", "tally", "measure"};
    static const char *const answers[][3] = {{"left", "right", "neither"},
                                             {"light", "heavy", NULL},
                                             {"few", "some", "many"},
                                             {"done", NULL, NULL}};
    int nodes = 1 + pick(number % 10 == 0 ? 200 : 30), names[200] = {0}, lines[200];
    for (int i = 0; i < nodes; i++)
        names[i] = lines[i] = i;
    for (int i = 1; i < nodes; i++) {
        int j = pick(i), k = pick(i), t = names[i];
        names[i] = names[j];
        names[j] = t;
        t = lines[i];
        lines[i] = lines[k];
        lines[k] = t;
    }
    fprintf(out,
            "oracle g%d {\n param pf : flux = 0.3 in [0, 5]; param ps : ratio = 0.7 in [0, 1];\n"
            " param pc : count = 9 in [2, 99];\n start n%d;\n",
            number, names[0]);
    for (int i = 0; i < nodes; i++) {
        int tool = pick(4), node = lines[i];
        fprintf(out, " node n%d = %s(", names[node], tools[tool]);
        print_arguments(out, tool);
        fprintf(out, ") {");
        for (int a = 0; a < 3 && answers[tool][a] != NULL; a++) {
            int otherwise = pick(6) == 0;
            fprintf(out, " %s -> ", otherwise ? "otherwise" : answers[tool][a]);
            print_target(out, names, node, nodes);
            fprintf(out, ";");
            if (otherwise)
                break;
        }
        fprintf(out, " }\n");
    }
    fprintf(out, "}\n");
}

enum { GRAPHS = 60, WALKS = 300, CALLS = 4096 };

/* As in dagc/runtime/discussion.h, for this catalog. */
struct record {
    const unsigned char *script;
    int calls;
    int tools[CALLS];
    double arguments[CALLS][2];
    double facts[4];
};
struct discussion {
    struct {
        const char *no_number;
        double where[3], size;
        int times;
        unsigned char where_level, size_level, times_level;
    } terms;
    struct record *record;
};

static double value(const struct dag *dag, const struct node *node, int argument)
{
    int index = dag->arguments[node->arguments.first + argument].expression;
    const struct expression *e = &dag->expressions[index];
    return e->kind == EXPRESSION_NUMBER ? e->number : dag->parameters[e->parameter].value;
}

static int walk(const struct dag *dag, const struct oracle_graph *oracle, struct discussion *d)
{
    int at = oracle->start.index;
    for (;;) {
        const struct node *node = &dag->nodes[at];
        int call = d->record->calls++;
        d->record->tools[call] = node->tool;
        for (int i = 0; i < 2; i++)
            d->record->arguments[call][i] = i < node->arguments.count ? value(dag, node, i) : 0;
        if (node->tool == 2) {
            d->terms.times += (int)value(dag, node, 0);
            d->terms.times_level = 1;
        } else if (node->tool == 3) {
            d->terms.size = d->terms.where[0] = d->terms.where[1] = d->terms.where[2] = call;
            d->terms.size_level = 2;
            d->terms.where_level = 1;
        }
        int answer = d->record->script[call] % node->arcs.count;
        const struct target *target = &dag->arcs[node->arcs.first + answer].target;
        if (target->kind == TARGET_DECISION)
            return target->index;
        ck_assert_int_eq(target->kind, TARGET_NODE);
        ck_assert_int_gt(dag->nodes[target->index].order, node->order); /* topological */
        at = target->index;
    }
}

static void check_same(const struct dag *dag, const struct oracle_graph *oracle, void *library)
{
    static struct record walked, called;
    char name[64], parameters[256];
    int (*refine)(const void *, struct discussion *);
    void (*defaults)(void *);
    snprintf(name, sizeof name, "%s_refine", oracle->name);
    *(void **)&refine = dlsym(library, name);
    snprintf(name, sizeof name, "%s_defaults", oracle->name);
    *(void **)&defaults = dlsym(library, name);
    ck_assert(refine != NULL && defaults != NULL);
    defaults(parameters);
    unsigned char script[CALLS];
    for (int w = 0; w < WALKS; w++) {
        struct discussion a, b;
        memset(&a, 0, sizeof a);
        memset(&b, 0, sizeof b);
        a.record = &walked;
        b.record = &called;
        for (int i = 0; i < CALLS; i++)
            script[i] = (unsigned char)pick(256);
        walked.script = called.script = script;
        walked.calls = called.calls = 0;
        int decision = walk(dag, oracle, &a);
        ck_assert_int_eq(refine(parameters, &b), decision);
        ck_assert_int_eq(called.calls, walked.calls);
        for (int i = 0; i < walked.calls; i++) {
            ck_assert_int_eq(called.tools[i], walked.tools[i]);
            ck_assert_mem_eq(called.arguments[i], walked.arguments[i], sizeof walked.arguments[i]);
        }
        if (decision == 0) { /* keep reads all terms */
            ck_assert_mem_eq(a.terms.where, b.terms.where, sizeof a.terms.where);
            ck_assert(a.terms.size == b.terms.size && a.terms.times == b.terms.times);
            ck_assert(a.terms.where_level == b.terms.where_level
                      && a.terms.size_level == b.terms.size_level
                      && a.terms.times_level == b.terms.times_level);
        }
    }
}

static void run(const char *format, const char *a, const char *b, const char *c)
{
    char command[8192];
    snprintf(command, sizeof command, format, a, b, c);
    ck_assert_msg(system(command) == 0, "%s", command);
}

START_TEST(random_graphs)
{
    char place[] = "/tmp/check_dagc.XXXXXX", path[256];
    ck_assert_ptr_nonnull(mkdtemp(place));
    snprintf(path, sizeof path, "%s/g.dag", place);
    FILE *out = fopen(path, "w");
    seed = 1;
    int graphs = thorough() ? GRAPHS : GRAPHS / 3;
    for (int i = 0; i < graphs; i++)
        print_graph(out, i);
    fclose(out);
    run("cp -r %s/runtime/* runtime/oracle.h %s%s", folder, place, "");
    run("%s --emit=catalog-h -o %s/catalog.h %s/test_catalog.dag", dagc, place, folder);
    run("%s -Wno-all --catalog tests/dagc/test_catalog.dag -o %s/g.c %s/g.dag", dagc, place, place);
    run("cc -std=c11 -O1 -Wall -Wextra -Wpedantic -Werror -shared -fPIC -I%s -o %s/g.so %s/g.c",
        place, place, place);

    size_t length;
    char *text = read_file(path, &length);
    struct dag *dag = load(text, stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag->oracle_count, graphs);
    snprintf(path, sizeof path, "%s/g.so", place);
    void *library = dlopen(path, RTLD_NOW);
    ck_assert_msg(library != NULL, "%s", dlerror());
    for (int i = 0; i < graphs; i++)
        check_same(dag, &dag->oracles[i], library);
    dlclose(library);
    dag_free(dag);
    free(text);
    run("rm -r %s%s%s", place, "", "");
}
END_TEST

/* ---- mutated sources: they need not be right, they must not hurt */

static void mutate(char *text, size_t *length, size_t room)
{
    static const char *const pieces[] = {"{",  "}",      ";",      "->",        "node a",     "(",
                                         ")",  "=",      "\"",     "in [",      "oracle t {", "1e",
                                         "-",  "|",      "#",      "start",     "param",      ",",
                                         ">=", "levels", "tool t", "answers (", "\xc3\xa9"};
    int count = 1 + pick(4);
    for (int i = 0; i<count && * length> 0; i++) {
        size_t at = (size_t)pick((int)*length);
        const char *piece = pieces[pick((int)(sizeof pieces / sizeof *pieces))];
        size_t size = strlen(piece), cut = (size_t)pick(20);
        if (cut > *length - at)
            cut = *length - at;
        if (pick(3) == 0)
            text[at] = (char)pick(256);
        else if (pick(2) == 0) {
            memmove(text + at, text + at + cut, *length - at - cut);
            *length -= cut;
        } else if (*length + size < room) {
            memmove(text + at + size, text + at, *length - at);
            memcpy(text + at, piece, size);
            *length += size;
        }
    }
}

START_TEST(mutations)
{
    size_t rich_length;
    char *rich = read_file("tests/dagc/emit_c.dag", &rich_length);
    char text[8192], mutated[8192];
    FILE *nowhere = fopen("/dev/null", "w");
    rich_length = (size_t)(strstr(rich, "# run") - rich);
    seed = 2;
    for (int i = 0; i < (thorough() ? 6000 : 2000); i++) {
        memcpy(text, rich, rich_length);
        size_t length = rich_length;
        mutate(text, &length, sizeof text);
        dag_free(dag_load_switched("no-missing-term no-unguarded-split all shared-question", "m",
                                   text, length, NULL, catalog, nowhere));
        length = strlen(catalog);
        memcpy(mutated, catalog, length + 1);
        mutate(mutated, &length, sizeof mutated - 1);
        mutated[length] = '\0';
        dag_free(dag_load_switched("no-error=missing-term no-error=unguarded-split", "m", rich,
                                   rich_length, NULL, mutated, nowhere));
    }
    fclose(nowhere);
    free(rich);
}
END_TEST

/* ---- the scripts */

START_TEST(messages)
{
    run("%s/run.sh %s%s", folder, dagc, "");
}
END_TEST

START_TEST(command)
{
    run("%s/command.sh %s%s", folder, dagc, "");
}
END_TEST

START_TEST(memory)
{
    run("%s/memory.sh %s%s", folder, dagc, "");
}
END_TEST

int main(void)
{
    const char *given = getenv("DAGC");
    snprintf(dagc, sizeof dagc, "%s", given ? given : "build/bin/dagc");
    Suite *suite = suite_create("dagc");
    TCase *library = tcase_create("library"), *scripts = tcase_create("scripts");
    tcase_add_checked_fixture(library, setup, NULL);
    tcase_set_timeout(library, 120);
    tcase_set_timeout(scripts, 300);
    tcase_add_test(library, graph);
    tcase_add_test(library, standard_catalog);
    tcase_add_test(library, errors_in_a_stream);
    tcase_add_test(library, analyses);
    tcase_add_test(library, same_fingerprint);
    tcase_add_test(library, other_fingerprint);
    tcase_add_test(library, random_graphs);
    tcase_add_test(library, mutations);
    tcase_add_test(scripts, messages);
    tcase_add_test(scripts, command);
    tcase_add_test(scripts, memory);
    suite_add_tcase(suite, library);
    suite_add_tcase(suite, scripts);
    return suite_failures(suite) != 0;
}
