/* check_language.c - branches, imports and computed arguments as the library gives them.
 *
 * Random expressions: the interpreter and flat code pass the same bits to every tool. The example
 * of a user's own tool: built and run. Run from the top folder.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "dag.h"
#include "suite.h"

static char dagc[4096];
static const char catalog[] = "tests/dagc/test_catalog.dag";

static struct dag *load(const char *text, FILE *errors)
{
    struct dag_options options = {0};
    options.text = text;
    options.length = strlen(text);
    options.catalog_path = catalog;
    options.switches = "no-all"; /* the language is tested, not what graphs are good for */
    return dag_load_with("test.dag", &options, errors);
}

static void run(const char *format, const char *a, const char *b, const char *c)
{
    char command[8192];
    snprintf(command, sizeof command, format, a, b, c);
    ck_assert_msg(system(command) == 0, "%s", command);
}

static const struct node *node_named(const struct dag *dag, const char *name)
{
    for (int i = 0; i < dag->node_count; i++)
        if (strcmp(dag->nodes[i].name, name) == 0)
            return &dag->nodes[i];
    ck_abort_msg("no node '%s'", name);
    return NULL;
}

static const char *target(const struct dag *dag, const char *name, int answer)
{
    return dag->arcs[node_named(dag, name)->arcs.first + answer].target.name;
}

/* ---- branches */

static const char nested[] =
    "graph one(x : flux in [0, inf], s : ratio = 0.5 in [0, 1]) exits (low precise, high "
    "approximate, last) {\n"
    "  start w; node w = weigh(most = x * 2, share = s) { light -> low; heavy -> l; }\n"
    "  node l = look() { left -> high; right -> last; neither -> drop; }\n"
    "}\n"
    "graph two(y : flux in [0, inf]) exits (yes, no) {\n"
    "  start first; node first = one(x = y) { low -> yes; high -> second; last -> no; }\n"
    "  node second = one(x = y + 1, s = 0.25) { low -> yes; otherwise -> no; }\n"
    "}\n"
    "graph three(z : flux in [0, inf]) exits (out) { start t; node t = two(y = z) { otherwise -> "
    "out; } }\n"
    "oracle o { param p : flux = 1 in [0, inf]; start a;\n"
    "  node a = three(z = p) { out -> b; }\n"
    "  node b = one(x = lamp) { low -> a__t__first__w; otherwise -> keep; }\n"
    "  node a__t__first__w = measure() { done -> keep; } }\n";

START_TEST(three_deep)
{
    struct dag *dag = load(nested, stderr);
    ck_assert_ptr_nonnull(dag);
    const struct oracle_graph *oracle = &dag->oracles[0];
    ck_assert_int_eq(dag->branch_count, 3);
    ck_assert_int_eq(oracle->nodes.count, 7);
    ck_assert_int_eq(oracle->order.count, 7);
    /* nothing but tools, decisions and nodes is left */
    for (int i = 0; i < oracle->nodes.count; i++) {
        const struct node *node = &dag->nodes[oracle->nodes.first + i];
        ck_assert_int_ge(node->tool, 0);
        ck_assert_int_eq(node->branch, -1);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *t = &dag->arcs[node->arcs.first + a].target;
            ck_assert(t->kind == TARGET_NODE || t->kind == TARGET_DECISION);
            ck_assert(t->kind != TARGET_NODE || dag->nodes[t->index].order > node->order);
        }
    }
    /* The name a__t__first__w is taken by the oracle itself. */
    const struct node *start = &dag->nodes[oracle->start.index];
    ck_assert_int_eq(strncmp(start->name, "a__t__first", 11), 0);
    ck_assert_str_ne(start->name, "a__t__first__w");
    ck_assert_str_eq(target(dag, "a__t__first__l", 0), "a__t__second__w");
    ck_assert_str_eq(target(dag, "a__t__first__l", 1), "b__w");
    ck_assert_str_eq(target(dag, "a__t__first__l", 2), "drop");
    ck_assert_str_eq(target(dag, "b__w", 0), "a__t__first__w");
    /* The chain of uses: second in t, t in a. */
    const struct use *use = &dag->uses[node_named(dag, "a__t__second__w")->use];
    ck_assert_str_eq(dag->branches[use->branch].name, "one");
    ck_assert_str_eq(use->node, "a__t__second");
    use = &dag->uses[use->outer];
    ck_assert_str_eq(dag->branches[use->branch].name, "two");
    use = &dag->uses[use->outer];
    ck_assert_str_eq(dag->branches[use->branch].name, "three");
    ck_assert_int_eq(use->outer, -1);
    ck_assert_int_eq(node_named(dag, "a__t__first__w")->use, -1);
    /* (p + 1) * 2, and the exits' kinds */
    const struct node *second = node_named(dag, "a__t__second__w");
    const struct expression *e =
        &dag->expressions[dag->arguments[second->arguments.first].expression];
    ck_assert_int_eq(e->kind, EXPRESSION_MULTIPLY);
    ck_assert_int_eq(dag->expressions[e->left].kind, EXPRESSION_ADD);
    e = &dag->expressions[dag->expressions[e->left].left];
    ck_assert_int_eq(e->kind, EXPRESSION_PARAMETER);
    ck_assert_int_eq(e->parameter, oracle->parameters.first);
    const struct answer *exits = &dag->answers[dag->branches[0].exits.first];
    ck_assert_int_eq(exits[0].kind, KIND_PRECISE);
    ck_assert_int_eq(exits[1].kind, KIND_APPROXIMATE);
    ck_assert_int_eq(exits[2].kind, KIND_OTHER);
    dag_free(dag);
}
END_TEST

static uint64_t fingerprint(const char *text)
{
    struct dag *dag = load(text, stderr);
    ck_assert_ptr_nonnull(dag);
    uint64_t result = dag->oracles[0].fingerprint;
    dag_free(dag);
    return result;
}

START_TEST(same_as_by_hand)
{
    static const char branch[] = "graph g(s : ratio in [0, 1]) exits (x, y) { start w; node w = "
                                 "weigh(share = s, most = lamp * s) "
                                 "{ light -> x; heavy -> y; } }\n"
                                 "oracle o { start a; node a = g(s = 0.5) { x -> b; y -> drop; } "
                                 "node b = g(s = 1) { otherwise -> keep; } }";
    static const char plain[] =
        "oracle o { start a; node a = weigh(share = 0.5, most = lamp * 0.5) { light -> b; heavy -> "
        "drop; } "
        "node b = weigh(share = 1, most = lamp * 1) { otherwise -> keep; } }";
    static const char other[] =
        "oracle o { start a; node a = weigh(share = 0.5, most = 0.5 * lamp) { light -> b; heavy -> "
        "drop; } "
        "node b = weigh(share = 1, most = lamp * 1) { otherwise -> keep; } }";
    ck_assert(fingerprint(branch) == fingerprint(plain));
    ck_assert(fingerprint(other) != fingerprint(plain));
}
END_TEST

START_TEST(reads)
{
    struct dag *dag = load(
        "extern outside(where, size >= fine) : flux;\n"
        "oracle o { start a; node a = weigh(share = 1, most = max(abs(outside) * size / times, 0)) "
        "{ otherwise -> keep; } }",
        stderr);
    ck_assert_ptr_nonnull(dag);
    const struct node *a = node_named(dag, "a");
    const struct need *needs = &dag->needs[a->reads.first];
    ck_assert_int_eq(a->reads.count, 4);
    ck_assert_str_eq(needs[0].term_name, "where");
    ck_assert(strcmp(needs[1].term_name, "size") == 0 && needs[1].level == 2);
    ck_assert(strcmp(needs[2].term_name, "size") == 0 && needs[2].level == 1);
    ck_assert_str_eq(needs[3].term_name, "times");
    dag_free(dag);
}
END_TEST

/* ---- imports */

START_TEST(imports)
{
    char place[] = "/tmp/check_language.XXXXXX", path[256];
    ck_assert_ptr_nonnull(mkdtemp(place));
    run("mkdir %s/lib && echo 'import \"g.dag\"; graph g() exits (x) { start q; node q = look() "
        "{ otherwise -> x; } }' >%s/lib/g.dag%s",
        place, place, "");
    run("echo 'import \"g.dag\"; import \"lib/g.dag\"; oracle o { start q; node q = g() { x -> "
        "keep; } }' "
        ">%s/o.dag%s%s",
        place, "", "");
    snprintf(path, sizeof path, "%s/lib", place);
    const char *folders[] = {"no/such/folder", path};
    struct dag_options options = {0};
    options.catalog_path = catalog;
    options.folders = folders;
    options.folder_count = 2;
    options.switches = "no-all";
    snprintf(path + 200, sizeof path - 200, "%s/o.dag", place);
    struct dag *dag = dag_load_with(path + 200, &options, stderr);
    ck_assert_ptr_nonnull(dag);
    ck_assert_int_eq(dag->import_count, 3);
    ck_assert_int_eq(dag->source_count, 3); /* the catalog, o.dag and, once, g.dag */
    ck_assert_int_eq(dag->imports[1].source, dag->imports[0].source);
    const struct where first = dag->sources[dag->imports[0].source].importer;
    ck_assert_int_eq(first.source, dag->imports[0].where.source);
    ck_assert_int_eq(first.offset, dag->imports[0].where.offset);
    ck_assert_int_ne(first.offset, dag->imports[1].where.offset);
    dag_free(dag);
    options.folder_count = 1;
    run("sed -i 's/import .lib.g.dag.;//' %s/o.dag%s%s", place, "", "");
    ck_assert_ptr_null(dag_load_with(path + 200, &options, NULL));
    run("rm -r %s%s%s", place, "", "");
}
END_TEST

/* ---- mutated sources: they need not be right, they must not hurt */

static int pick(int count);

START_TEST(mutations)
{
    static const char *const pieces[] = {"graph g(",
                                         ") exits (x)",
                                         "import \"x\";",
                                         "import standard;",
                                         "one(",
                                         "three(",
                                         "x * ",
                                         " / (",
                                         "min(",
                                         "sqrt(",
                                         "-",
                                         ".",
                                         "start",
                                         "{",
                                         "}",
                                         ";",
                                         "size.fine",
                                         "fact a.b : ",
                                         "extern e() : flux;",
                                         "lamp",
                                         "inf",
                                         "= p",
                                         "two",
                                         "low",
                                         "w"};
    FILE *nowhere = fopen("/dev/null", "w");
    for (int i = 0; i < 20000; i++) {
        size_t length = strlen(nested);
        char text[4096];
        memcpy(text, nested, length + 1);
        for (int k = 1 + pick(3); k > 0; k--) {
            const char *piece = pieces[pick((int)(sizeof pieces / sizeof *pieces))];
            size_t at = (size_t)pick((int)length), size = strlen(piece), cut = (size_t)pick(12);
            if (cut > length - at)
                cut = length - at;
            if (pick(2)) {
                memmove(text + at, text + at + cut, length - at - cut + 1);
                length -= cut;
            }
            if (pick(3)) {
                memmove(text + at + size, text + at, length - at + 1);
                memcpy(text + at, piece, size);
                length += size;
            }
        }
        dag_free(load(text, nowhere));
    }
    fclose(nowhere);
}
END_TEST

/* ---- random expressions */

static uint64_t seed = 3;

static int pick(int count)
{
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (int)((seed >> 33) % (uint64_t)count);
}

enum dimension { FLUX, RATIO, AREA, WHOLE };

static void print_leaf(FILE *out, enum dimension unit, int in_branch)
{
    static const char *const leaves[][6] = {
        {"pf", "lamp", "outside", "0.1 * lamp", "pf", "outside / 3"},
        {"ps", "size", "size.fine", "times", "(ps / size)", "0.7"},
        {"left.area", "right.area", "left.area", "left.area", "right.area", "2 * left.area"},
        {"pc", "times", "right.depth", "3", "17", "pc"}};
    const char *leaf = leaves[unit][pick(6)];
    fprintf(out, "%s", in_branch && pick(3) == 0 && unit == FLUX ? "gf" : leaf);
}

static void print_expression(FILE *out, enum dimension unit, int depth, int in_branch)
{
    static const char *const operators[] = {" + ", " - "}, *const functions[] = {"min(", "max("};
    int kind = depth <= 0 ? 0 : pick(10);
    if (kind == 0)
        print_leaf(out, unit, in_branch);
    else if (kind <= 3) {
        fprintf(out, "(");
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, "%s", operators[pick(2)]);
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, ")");
    } else if (kind <= 5) {
        fprintf(out, "%s", functions[pick(2)]);
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, ", ");
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, ")");
    } else if (kind == 6) {
        fprintf(out, pick(2) ? "-(" : "abs(");
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, ")");
    } else if (unit == WHOLE) {
        print_expression(out, WHOLE, depth - 1, in_branch);
        fprintf(out, " * ");
        print_leaf(out, WHOLE, in_branch);
    } else if (kind == 7) {
        print_leaf(out, unit, in_branch);
        fprintf(out, pick(2) ? " * " : " / ");
        print_leaf(out, RATIO, in_branch);
    } else if (kind == 8) {
        fprintf(out, "(");
        print_expression(out, unit, depth - 1, in_branch);
        fprintf(out, ") * left.area / right.area");
    } else if (unit == RATIO) {
        fprintf(out, "sqrt(abs(");
        print_expression(out, RATIO, depth - 1, in_branch);
        fprintf(out, "))");
    } else
        fprintf(out, "sqrt(max(%s * %s, 0))", unit == FLUX ? "lamp" : "left.area",
                unit == FLUX ? "pf" : "right.area");
}

static void print_arguments(FILE *out, int in_branch)
{
    fprintf(out, "weigh(most = max(");
    print_expression(out, FLUX, 5, in_branch);
    fprintf(out, ", 0), share = min(max(");
    print_expression(out, RATIO, 5, in_branch);
    fprintf(out, ", 0), 1))");
}

enum { ORACLES = 40, NODES = 8 };

static void print_oracle(FILE *out, int number)
{
    fprintf(out,
            "graph way%d(pf : flux in [0, inf], ps : ratio in [0, 1], pc : count in [0, 50],\n"
            "  gf : flux in [0, inf]) exits (a, b) { start n;\n  node n = ",
            number);
    print_arguments(out, 1);
    fprintf(out,
            " { light -> a; heavy -> b; } }\n"
            "oracle g%d { param pf : flux = 0.3 in [0, inf]; param ps : ratio = 0.7 in [0, 1];\n"
            "  param pc : count = 9 in [0, 50]; start n0;\n",
            number);
    for (int i = 0; i < NODES; i++) {
        int kind = i == 0 ? 3 : pick(4);
        fprintf(out, "  node n%d = ", i);
        if (kind == 0) {
            fprintf(out, "tally(upto = min(max(");
            print_expression(out, WHOLE, 4, 0);
            fprintf(out, ", 1), 100), scale = ");
            print_expression(out, RATIO, 3, 0);
            fprintf(out, ") { otherwise -> ");
        } else if (kind == 1) {
            fprintf(out, "way%d(gf = max(", number);
            print_expression(out, FLUX, 3, 0);
            fprintf(out, ", 0), pf = pf, ps = ps, pc = min(pc + 1, 50)) { otherwise -> ");
        } else if (i == 0) /* sure to need the extern */
            fprintf(out, "weigh(most = abs(outside), share = ps) { otherwise -> ");
        else {
            print_arguments(out, 0);
            fprintf(out, " { otherwise -> ");
        }
        if (i + 1 < NODES)
            fprintf(out, "n%d; }\n", i + 1);
        else
            fprintf(out, "keep; }\n");
    }
    fprintf(out, "}\n");
}

START_TEST(same_bits)
{
    const int oracles = thorough() ? ORACLES : ORACLES / 4;
    char place[] = "/tmp/check_language.XXXXXX", path[256], top[8192];
    ck_assert_ptr_nonnull(mkdtemp(place));
    snprintf(path, sizeof path, "%s/g.dag", place);
    FILE *out = fopen(path, "w");
    fprintf(out, "extern outside(size >= fine) : flux \"from outside\";\n");
    for (int i = 0; i < oracles; i++)
        print_oracle(out, i);
    fclose(out);
    snprintf(path, sizeof path, "%s/list.c", place);
    out = fopen(path, "w");
    fprintf(out, "#include \"oracles.h\"\nextern const struct oracle *const oracles[];\nextern "
                 "const int oracle_count;\n"
                 "const struct oracle *const oracles[] = {");
    for (int i = 0; i < oracles; i++)
        fprintf(out, "&g%d_oracle,", i);
    fprintf(out, "};\nconst int oracle_count = %d;\n", oracles);
    fclose(out);
    run("cp -r tests/dagc/runtime/* tests/dagc/compare/main.c runtime/oracle.h %s%s%s", place, "",
        "");
    run("mkdir %s/oracle %s/util && cp runtime/util/messages.[ch] %s/util", place, place, place);
    run("cp runtime/oracle/tool_table.h runtime/oracle/program.h runtime/oracle/refiner.[ch] "
        "runtime/oracle/interpreter.c "
        "runtime/oracle/arguments.c runtime/oracle/load_graph.[ch] "
        "%s/oracle%s%s",
        place, "", "");
    run("%s --emit=catalog-h -o %s/catalog.h %s", dagc, place, catalog);
    run("%s --emit=catalog-c -o %s/catalog.c %s", dagc, place, catalog);
    snprintf(top, sizeof top, "%s -Wno-all --catalog %s --header %s/oracles.h", dagc, catalog,
             place);
    run("%s -o %s/oracles.c %s/g.dag", top, place, place);
    snprintf(top, sizeof top, "%.*s", (int)(strrchr(dagc, '/') - dagc), dagc);
    const char *const compilers[] = {"gcc", "clang"}, *const levels[] = {thorough() ? "-O2" : "-O1",
                                                                         "-O0"};
    for (int i = 0; i < 2; i++) {
        char compile[512];
        snprintf(compile, sizeof compile, "command -v %s >/dev/null", compilers[i]);
        if (system(compile) != 0) {
            printf("skipped: %s is not installed\n", compilers[i]);
            continue;
        }
        snprintf(compile, sizeof compile,
                 "%s -std=c11 %s -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror "
                 "-ffp-contract=off $SANITIZE",
                 compilers[i], levels[i]);
        char command[16384];
        snprintf(command, sizeof command,
                 "%s -I%s -I%s/oracle -Idagc -o %s/compare %s/*.c %s/oracle/*.c %s/util/*.c "
                 "%s/../libdagc.a -lm",
                 compile, place, place, place, place, place, place, top);
        run("%s%s%s", command, "", "");
        run("%s/compare %s/g.dag %s", place, place, catalog);
    }
    run("rm -r %s%s%s", place, "", "");
}
END_TEST

/* ---- the example */

START_TEST(user_tool)
{
    char top[8192], place[] = "/tmp/check_language.XXXXXX";
    ck_assert_ptr_nonnull(mkdtemp(place));
    snprintf(top, sizeof top, "%.*s/../libdagc.a)\" OPT=%s", (int)(strrchr(dagc, '/') - dagc), dagc,
             thorough() ? "-O2" : "-O0");
    run("make -s -C examples/user_tool OUT=%s DAGC=\"$(realpath %s)\" LIBDAGC=\"$(realpath "
        "%s",
        place, dagc, top);
    run("rm -r %s%s%s", place, "", "");
}
END_TEST

int main(void)
{
    const char *given = getenv("DAGC");
    snprintf(dagc, sizeof dagc, "%s", given ? given : "build/bin/dagc");
    Suite *suite = suite_create("language");
    TCase *library = tcase_create("library"), *programs = tcase_create("programs");
    tcase_set_timeout(programs, 300);
    tcase_add_test(library, three_deep);
    tcase_add_test(library, same_as_by_hand);
    tcase_add_test(library, reads);
    tcase_add_test(library, imports);
    tcase_add_test(library, mutations);
    tcase_set_timeout(library, 120);
    tcase_add_test(programs, same_bits);
    tcase_add_test(programs, user_tool);
    suite_add_tcase(suite, library);
    suite_add_tcase(suite, programs);
    return suite_failures(suite) != 0;
}
