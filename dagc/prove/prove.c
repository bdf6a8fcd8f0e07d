/* prove.c - does what runs do what the graph says?
 *
 * Both releases of each oracle are compiled (scripted.c): the emitted C, counted, traced and over
 * blocks too where that is asked for, and the graph under the interpreter that programs have. What
 * they say of themselves must be the graph's (described.c), and on every path from every beginning
 * they must make its calls and its decision (walk.c); all paths are followed by their states
 * (states.c).
 * SPDX-License-Identifier: MIT */
#include <dlfcn.h>
#include <math.h>

#include "prove/prove.h"
#include "prove/proving.h"

enum { SEED = 1 };

static double count_paths(const struct proof *proof)
{
    const struct dag *dag = proof->dag;
    size_t nodes = (size_t)proof->oracle->order.count;
    double *paths = dag_alloc(&proof->dag->arena, nodes * sizeof *paths);
    for (int i = proof->oracle->order.count - 1; i >= 0; i--) {
        const struct node *node = prove_node_at(proof, i);
        for (int a = node->arcs.first; a < node->arcs.first + node->arcs.count; a++) {
            const struct target *target = &dag->arcs[a].target;
            paths[i] += target->kind == TARGET_NODE ? paths[dag->nodes[target->index].order] : 1;
        }
    }
    return paths[0];
}

/* Paths are exponentially many: a double need not hold their number. */
static const char *paths_text(const struct proof *proof)
{
    struct arena *arena = &proof->dag->arena;
    double paths = count_paths(proof);
    return isinf(paths)   ? "1e308 or more"
           : paths < 1e15 ? dag_format(arena, "%.0f", paths)
                          : dag_format(arena, "%.3g", paths);
}

static void report(const struct proof *proof, const struct prove_extent *extent, int flavours)
{
    if (extent->cut) { /* a path may be run from many beginnings */
        fprintf(proof->report,
                "%s: no difference in %ld runs: a sample of its paths (%s) from all beginnings, "
                "since they go through more than %ld states\n",
                proof->oracle->name, extent->walks, paths_text(proof), extent->states);
        return;
    }
    fprintf(proof->report, "%s: proved on all %s paths", proof->oracle->name, paths_text(proof));
    fprintf(proof->report, " from %ld beginnings, by %ld states:", extent->starts, extent->states);
    for (enum prove_flavour f = 0; f < PROVE_FLAVOURS; f++)
        if (flavours >> f & 1)
            fprintf(proof->report, "%s %s", f > 0 ? "," : "", prove_flavour_name(proof->dag, f));
    fprintf(proof->report, "\n");
}

static int prove_oracle(struct proof *proof)
{
    const struct prove_host host = {proof->dag,  dag_is_fixed,         dag_reads_fact,
                                    dag_node_at, dag_fingerprint_text, dag_is_doubtful,
                                    dag_doubt};
    int flavours = 1 << PROVE_PLAIN | (proof->options->copies > 1) << PROVE_FIRST
                   | proof->options->counted << PROVE_COUNTED
                   | proof->options->traced << PROVE_TRACED | proof->options->wave << PROVE_WAVE
                   | 1 << PROVE_INTERPRETED;
    struct prove_extent most = {0};
    const char *cause = proof->library->open(&host, proof->number);
    if (cause != NULL) {
        fprintf(stderr, "dagc: error: oracle %s: %s\n", proof->oracle->name, cause);
        return -1;
    }
    proof->random = SEED;
    proof->different = 0;
    prove_prepare(proof);
    (void)prove_descriptions(proof);
    for (int way = 0; way < PROVE_VALUES && !proof->different; way++) {
        prove_choose_values(proof, way);
        for (enum prove_flavour f = 0; f < PROVE_FLAVOURS && !proof->different; f++) {
            struct prove_extent extent;
            if ((flavours >> f & 1) == 0)
                continue;
            prove_states(proof, f, way == 0 && f != PROVE_FIRST, &extent);
            if (extent.states > most.states || extent.cut)
                most = extent;
        }
    }
    proof->library->close();
    if (!proof->different)
        report(proof, &most, flavours);
    return proof->different;
}

struct request {
    struct proof proof;
    int result;
};

static void prove_all(struct dag *dag, void *context)
{
    struct request *request = context;
    struct proof *proof = &request->proof;
    request->result = prove_build(proof);
    for (int i = 0; i < dag->oracle_count && request->result >= 0; i++) {
        proof->oracle = &dag->oracles[i];
        proof->number = i;
        int result = prove_oracle(proof);
        request->result = result < 0 ? -1 : request->result | result;
    }
}

int dag_prove(struct dag *dag, const struct emit_options *options,
              const struct dag_compiler *compiler, FILE *report)
{
    struct request request = {0};
    struct protector *outer = dag->arena.protector;
    request.proof.dag = dag;
    request.proof.options = options;
    request.proof.compiler = compiler;
    request.proof.report = report;
    request.proof.width = 1;
    for (int i = 0; i < dag->tool_count; i++)
        if (dag->tools[i].parameters.count > request.proof.width)
            request.proof.width = dag->tools[i].parameters.count;
    for (int i = 0; i < dag->term_count; i++)
        request.proof.term_values += dag->types[dag->terms[i].type].length;
    /* Of its own, so that the library goes even when memory runs out. */
    if (dag_protect(dag, prove_all, &request) != 0) {
        fprintf(stderr, "dagc: error: out of memory\n");
        request.result = -1;
    }
    dag->arena.protector = outer;
    if (request.proof.handle != NULL)
        dlclose(request.proof.handle);
    return request.result;
}
