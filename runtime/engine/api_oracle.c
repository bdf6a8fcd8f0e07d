/* api_oracle.c - oracles: built in, from a file or a text, compiled into the program, or registered
 * by hand.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "engine/api.h"
#include "oracle/builtin.h"
#include "oracle/oracles.h"

const char *const *radGetOracleNames(void)
{
    return builtin_names;
}

const char *radGetDefaultOracle(void)
{
    return RAD_DEFAULT_ORACLE;
}

const char *radGetOracleText(const char *name)
{
    for (const struct builtin *b = builtins; name && b->name; b++)
        if (strcmp(b->name, name) == 0)
            return b->text;
    return NULL;
}

static int is_builtin(const char *name)
{
    return radGetOracleText(name) != NULL;
}

static const struct oracle *find_registered(RadDevice device, const char *name)
{
    const struct oracle *found = NULL;
    pthread_mutex_lock(&device->lock);
    for (int i = 0; i < device->sources.hand_count && !found; i++)
        if (strcmp(device->sources.hand[i]->name, name) == 0)
            found = device->sources.hand[i];
    pthread_mutex_unlock(&device->lock);
    return found;
}

/* Can this program call it? Returns 0, or -1 after an error. */
static int check_compiled(RadDevice device, const struct oracle *oracle)
{
    if (!oracle || !oracle->name || !oracle->refine || !oracle->defaults)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                        "a compiled oracle needs a name, defaults and a refine function");
    if (oracle->abi != RUNTIME_ABI)
        return api_fail(device, RAD_ERROR_INVALID_ORACLE,
                        "oracle %s was compiled against ABI %d, not %d; compile it anew with this "
                        "version's headers",
                        oracle->name, oracle->abi, RUNTIME_ABI);
    return 0;
}

static enum RadError code_of(const struct messages *messages)
{
    static const enum RadError codes[] = {[MESSAGE_NONE] = RAD_ERROR_OUT_OF_MEMORY,
                                          [MESSAGE_ARGUMENT] = RAD_ERROR_INVALID_ARGUMENT,
                                          [MESSAGE_GRAPH] = RAD_ERROR_INVALID_ORACLE,
                                          [MESSAGE_COMPILER] = RAD_ERROR_UNSUPPORTED,
                                          [MESSAGE_MEMORY] = RAD_ERROR_OUT_OF_MEMORY};
    return codes[messages->cause];
}

int radRegisterOracle(RadDevice device, const struct oracle *oracle)
{
    if (!device || check_compiled(device, oracle) < 0)
        return -1;
    pthread_mutex_lock(&device->lock);
    int status = oracle_register(&device->sources, oracle);
    pthread_mutex_unlock(&device->lock);
    return status < 0 ? api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for oracle %s",
                                 oracle->name)
                      : 0;
}

int radLoadPlugin(RadDevice device, const char *path)
{
    struct messages messages = {0};
    if (!device)
        return -1;
    if (!path)
        return api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a plugin's file needs a name");
    const struct dag_compiler compiler = {device->sources.compiler, device->sources.temporary, 0};
    struct plugin *plugin = plugin_load(path, &compiler, &messages);
    if (plugin) {
        pthread_mutex_lock(&device->lock);
        plugin->next = device->sources.plugins;
        device->sources.plugins = plugin;
        pthread_mutex_unlock(&device->lock);
    } else
        api_fail(device, code_of(&messages), "%s", messages_text(&messages));
    messages_free(&messages);
    return plugin ? 0 : -1;
}

const struct plugin *api_plugins(RadDevice device)
{
    pthread_mutex_lock(&device->lock);
    const struct plugin *plugins = device->sources.plugins;
    pthread_mutex_unlock(&device->lock);
    return plugins;
}

static int is_of_graphs(enum RadRelease release)
{
    return release == RAD_RELEASE_FLAT || release == RAD_RELEASE_DAG || release == RAD_RELEASE_WAVE;
}

static enum release release_of(enum RadRelease release)
{
    return release == RAD_RELEASE_DAG    ? RELEASE_DAG
           : release == RAD_RELEASE_WAVE ? RELEASE_WAVE
                                         : RELEASE_FLAT;
}

int radHasOracle(RadDevice device, const char *name, enum RadRelease release)
{
    if (!device || !name)
        return 0;
    return release == RAD_RELEASE_HAND ? find_registered(device, name) != NULL
                                       : is_of_graphs(release) && is_builtin(name);
}

RadOracle api_oracle(RadDevice device, struct refiner *refiner)
{
    RadOracle oracle = refiner ? calloc(1, sizeof *oracle) : NULL;
    if (!oracle) {
        refiner_close(refiner);
        api_fail(device, RAD_ERROR_OUT_OF_MEMORY, "out of memory for an oracle");
        return NULL;
    }
    atomic_init(&oracle->holders, 1);
    oracle->device = device;
    oracle->refiner = refiner;
    radRetainDevice(device);
    return oracle;
}

/* Of those that files and texts have. */
static int check_release(RadDevice device, enum RadRelease release)
{
    if (is_of_graphs(release))
        return 0;
    return api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                    "release %d: RAD_RELEASE_FLAT, RAD_RELEASE_DAG and RAD_RELEASE_WAVE are there, "
                    "and no other",
                    (int)release);
}

/* The graph `text`, or of the file `path` when it is NULL. */
static RadOracle load(RadDevice device, const char *path, const char *text, const char *name,
                      enum RadRelease release, const char *const *replacements, int count)
{
    struct oracle_sources how = {.compiler = device->sources.compiler,
                                 .temporary = device->sources.temporary,
                                 .replacements = replacements,
                                 .replacement_count = count};
    struct messages messages = {0};
    if (check_release(device, release) < 0)
        return NULL;
    how.plugins = api_plugins(device);
    struct refiner *refiner = oracle_load(&how, path, text, name, release_of(release), &messages);
    RadOracle oracle = refiner ? api_oracle(device, refiner) : NULL;
    if (!refiner)
        api_fail(device, code_of(&messages), "%s",
                 messages.cause == MESSAGE_NONE ? "out of memory for an oracle"
                                                : messages_text(&messages));
    if (oracle)
        api_keep_source(oracle, path, text, name, replacements, count);
    messages_free(&messages);
    return oracle;
}

RadOracle radNewOracle(RadDevice device, const char *name, enum RadRelease release)
{
    struct messages messages = {0};
    if (!device)
        return NULL;
    if (!name || (release != RAD_RELEASE_HAND && !is_builtin(name))) {
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                 "there is no built-in oracle '%s'; radGetOracleNames tells those that there are",
                 name ? name : "");
        return NULL;
    }
    if (release == RAD_RELEASE_HAND) {
        const struct oracle *hand = find_registered(device, name);
        if (hand)
            return api_oracle(device, refiner_compiled(hand, "hand"));
        api_fail(device, RAD_ERROR_INVALID_ARGUMENT,
                 "no hand-written release of oracle '%s' has been registered", name);
        return NULL;
    }
    if (check_release(device, release) < 0)
        return NULL;
    struct refiner *refiner = oracle_open(NULL, name, release_of(release), &messages);
    /* a built-in graph is right: there can have been no memory, and api_oracle says so */
    messages_free(&messages);
    RadOracle oracle = api_oracle(device, refiner);
    if (oracle)
        api_keep_source(oracle, name, radGetOracleText(name), name, NULL, 0);
    return oracle;
}

RadOracle radLoadOracle(RadDevice device, const char *path, const char *name,
                        enum RadRelease release)
{
    if (!device)
        return NULL;
    if (path)
        return load(device, path, NULL, name, release, NULL, 0);
    api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "an oracle's file needs a name");
    return NULL;
}

RadOracle radParseOracle(RadDevice device, const char *path, const char *text, const char *name,
                         enum RadRelease release)
{
    if (!device)
        return NULL;
    if (path && text)
        return load(device, path, text, name, release, NULL, 0);
    api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "a graph needs a text, and a name for messages");
    return NULL;
}

RadOracle radLoadOracleReplaced(RadDevice device, const char *path, const char *text,
                                enum RadRelease release, const char *const *replacements, int count)
{
    if (!device)
        return NULL;
    int listed = count >= 0 && (count == 0 || replacements);
    for (int i = 0; listed && i < count; i++)
        listed = replacements[i] != NULL;
    if (path && listed)
        return load(device, path, text, NULL, release, replacements, count);
    api_fail(device, RAD_ERROR_INVALID_ARGUMENT, "an oracle needs a name, and replacements a list");
    return NULL;
}

int radListOracleFiles(const char *path, int (*each)(void *user, const char *path), void *user)
{
    const struct dag_options options = {0};
    struct dag *dag = path && each ? dag_load_with(path, &options, NULL) : NULL;
    int result = 0;
    for (int i = 0; dag && i < dag->source_count && !result; i++)
        if (dag->sources[i].on_disk)
            result = each(user, dag->sources[i].name);
    dag_free(dag);
    return result;
}

RadOracle radNewOracleCompiled(RadDevice device, const struct oracle *compiled, const char *release)
{
    if (!device || check_compiled(device, compiled) < 0)
        return NULL;
    return api_oracle(device, refiner_compiled(compiled, release ? release : "flat"));
}

void radRetainOracle(RadOracle oracle)
{
    if (oracle)
        atomic_fetch_add(&oracle->holders, 1);
}

void radReleaseOracle(RadOracle oracle)
{
    if (!oracle || atomic_fetch_sub(&oracle->holders, 1) != 1)
        return;
    statistics_free(&oracle->counted);
    explain_free(&oracle->explained);
    api_forget_source(&oracle->source);
    refiner_close(oracle->refiner);
    free(oracle->set);
    radReleaseDevice(oracle->device);
    free(oracle);
}

void radGetOracleReport(RadOracle oracle, struct RadOracleReport *report)
{
    if (!report)
        return;
    *report = (struct RadOracleReport){.name = "", .release = "", .doc = "", .fingerprint = ""};
    if (!oracle)
        return;
    const struct refiner *r = oracle->refiner;
    report->name = r->oracle;
    report->release = r->release;
    report->doc = r->doc;
    report->fingerprint = r->fingerprint ? r->fingerprint : "";
    report->parameters = r->parameters;
    report->parameter_count = r->parameter_count;
    report->reads_importance = refiner_reads(r, FACT_RECEIVER_IMPORTANCE)
                               || refiner_reads(r, FACT_RECEIVER_IMPACT)
                               || refiner_reads(r, FACT_SCENE_RANK);
    report->reads_tolerance = refiner_reads(r, FACT_RECEIVER_TOLERANCE);
    report->reads = r->reads;
    report->read_count = r->read_count;
}

int radSetOracleParameter(RadOracle oracle, const char *name, double value)
{
    struct messages messages = {0};
    if (!oracle)
        return -1;
    int status = refiner_set(oracle->refiner, name ? name : "", value, &messages);
    if (status < 0)
        api_fail(oracle->device, RAD_ERROR_INVALID_ARGUMENT, "%s", messages_text(&messages));
    else if (oracle->set)
        oracle->set[refiner_find(oracle->refiner, name)] = value;
    messages_free(&messages);
    return status;
}

double radGetOracleParameter(RadOracle oracle, const char *name)
{
    int i = oracle && name ? refiner_find(oracle->refiner, name) : -1;
    return i < 0 ? (double)NAN : refiner_get(oracle->refiner, i);
}

static int is_scaled(const struct oracle_parameter *p)
{
    return !p->fixed
           && (p->role == ROLE_LINK_THRESHOLD || p->role == ROLE_SMALLEST_PART
               || p->role == ROLE_RELATIVE_ERROR_TOLERANCE
               || p->role == ROLE_RELATIVE_POWER_TOLERANCE);
}

/* What is set, kept from now on beside what is scaled. Returns 0, or -1. */
static int keep_set(RadOracle oracle)
{
    const struct refiner *r = oracle->refiner;
    if (oracle->set || r->parameter_count == 0)
        return 0;
    oracle->set = malloc((size_t)r->parameter_count * sizeof *oracle->set);
    if (!oracle->set)
        return api_fail(oracle->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for the parameters of oracle %s", r->oracle);
    for (int i = 0; i < r->parameter_count; i++)
        oracle->set[i] = refiner_get(r, i);
    return 0;
}

int radScaleOracle(RadOracle oracle, double scale)
{
    struct messages messages = {0};
    int count = 0;
    if (!oracle)
        return -1;
    if (!(scale > 0 && scale < INFINITY))
        return api_fail(oracle->device, RAD_ERROR_INVALID_ARGUMENT,
                        "the scale of thresholds is %g; it takes a number above 0", scale);
    if (keep_set(oracle) < 0)
        return -1;
    for (int i = 0; i < oracle->refiner->parameter_count; i++) {
        const struct oracle_parameter *p = &oracle->refiner->parameters[i];
        if (!is_scaled(p))
            continue;
        const double times = p->role == ROLE_SMALLEST_PART ? fmin(scale, 1) : scale,
                     near = p->integer ? round(oracle->set[i] * times) : oracle->set[i] * times;
        /* in range and not fixed: it cannot fail */
        (void)refiner_set(oracle->refiner, p->name, fmin(fmax(near, p->low), p->high), &messages);
        count++;
    }
    messages_free(&messages);
    return count;
}

enum decision radAskOracle(RadOracle oracle, struct discussion *discussion)
{
    return oracle && discussion ? oracle->refiner->refine(oracle->refiner->state, discussion)
                                : DECISION_STOP;
}

void radAskOracles(RadOracle oracle, struct discussion *block, int count, enum decision *decisions)
{
    if (!decisions)
        return;
    if (oracle && block && oracle->refiner->wave && count > 0) {
        oracle->refiner->wave(oracle->refiner->state, block, count, decisions);
        return;
    }
    for (int i = 0; i < count; i++)
        decisions[i] = radAskOracle(oracle, block ? &block[i] : NULL);
}

int radCountOracle(RadOracle oracle)
{
    if (!oracle || api_alone(oracle->device, "counting an oracle's discussions") < 0)
        return -1;
    if (refiner_count(oracle->refiner) < 0)
        return api_fail(oracle->device, RAD_ERROR_INVALID_OPERATION,
                        "only interpreted graphs count; make oracle %s with RAD_RELEASE_DAG",
                        oracle->refiner->oracle);
    oracle->counting = 1;
    return 0;
}

int radGetOracleStatistics(RadOracle oracle, struct RadStatistics *statistics)
{
    if (!oracle
        || api_needs(oracle->device, statistics, "radGetOracleStatistics needs a place") < 0)
        return -1;
    statistics_free(&oracle->counted);
    if (!oracle->counting)
        return api_fail(oracle->device, RAD_ERROR_INVALID_OPERATION,
                        "nothing is counted; radCountOracle comes first");
    if (statistics_take(&oracle->counted, oracle->refiner) < 0)
        return api_fail(oracle->device, RAD_ERROR_OUT_OF_MEMORY,
                        "out of memory for the statistics");
    *statistics = oracle->counted.shown;
    return 0;
}

const char *radGetOracleGraph(RadOracle oracle)
{
    if (!oracle)
        return NULL;
    struct messages messages = {0};
    const char *graph = refiner_graph(oracle->refiner, &messages);
    if (!graph)
        api_fail(oracle->device,
                 messages.cause == MESSAGE_MEMORY ? RAD_ERROR_OUT_OF_MEMORY
                                                  : RAD_ERROR_INVALID_OPERATION,
                 "%s", messages_text(&messages));
    messages_free(&messages);
    return graph;
}
