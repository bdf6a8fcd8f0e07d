/* analyse_repeats.c - what a path has asked before.
 *
 * A question is a tool with its arguments. Asked again on one path it gives the same answer,
 * unless a tool in between has written a term that it reads or hands back: `transfer` may answer
 * otherwise once `form_factor` has made the form factor more precise. So for every question that
 * stands at several nodes, a sweep in topological order carries to each node how a path to it
 * may have left the question: not asked (or asked before such a change), or asked with the
 * answer a. That is one bit each, 64 bits of several questions travel together, and arcs that
 * contradict the earlier answer are not followed. What a node finds of its own question:
 *
 *     one answer, and not "not asked"     every path knows the answer: implied-answer
 *     some answers, on all paths or on    these paths ask twice: repeated-question
 *       all through one arc that leads here
 *     some answers, but every arc also    the price of sharing the node: shared-question,
 *       brings paths that have not asked  which is off, for only a copy of the node mends it
 *
 * A command is reported in the first case only.
 * SPDX-License-Identifier: MIT */
#include "analyse/analyse.h"

enum { BITS = 64 };

/* A question that stands at more than one node of the oracle. */
struct question {
    int first;          /* a node that asks it */
    int nodes;          /* how many do */
    int shift, answers; /* its bits in the word: 1 << shift is "not asked", then the answers; the
                          last stands for all answers that have no bit of their own */
};

struct repeats {
    struct dag *dag;
    const struct oracle_graph *oracle;
    struct question *questions;
    int question_count;
    int *question;            /* by place in the order */
    int *arc;                 /* by place in the order: an arc on which its question has surely been
                                 asked, best one with a known answer; -1: there is none */
    int *arc_place;           /* where that arc begins */
    unsigned char *arc_known; /* it brings one answer */
    uint64_t *state;          /* by place in the order: the word being swept */
    uint64_t *changed; /* by tool: "not asked", of the questions it may change the answer of */
    int from, to;      /* the questions in the word */
    struct search search;
};

static int writes_any(const struct dag *dag, const struct tool *tool, struct span needs)
{
    for (int i = needs.first; i < needs.first + needs.count; i++)
        if (dag_written_level(dag, tool, -1, dag->needs[i].term) > 0)
            return 1;
    return 0;
}

/* Do the node's arguments raise one of these terms? At its lowest level anyone who reads a term
 * computes it, which changes no answer. */
static int raises_any(const struct dag *dag, const struct node *node, struct span needs)
{
    for (int i = node->reads.first; i < node->reads.first + node->reads.count; i++)
        for (int k = needs.first; dag->needs[i].level > 1 && k < needs.first + needs.count; k++)
            if (dag->needs[k].term == dag->needs[i].term)
                return 1;
    return 0;
}

/* May the tool's writes change what the question of that node answers next time? Its own alone
 * do not: it finds what it left. Reading what it writes, it may count. */
static int may_change(const struct dag *dag, const struct tool *tool, const struct node *question,
                      int same_question)
{
    const struct tool *asked = &dag->tools[question->tool];
    return writes_any(dag, tool, asked->reads) || writes_any(dag, tool, question->reads)
           || (!same_question && writes_any(dag, tool, asked->writes));
}

/* The same of what the arguments of another question's node read. */
static int arguments_may_change(const struct dag *dag, const struct node *node,
                                const struct node *question)
{
    const struct tool *asked = &dag->tools[question->tool];
    return raises_any(dag, node, asked->reads) || raises_any(dag, node, question->reads)
           || raises_any(dag, node, asked->writes);
}

int dag_may_change(const struct dag *dag, const struct node *node, const struct node *asked,
                   int same)
{
    return may_change(dag, &dag->tools[node->tool], asked, same)
           || (!same && arguments_may_change(dag, node, asked));
}

static const struct node *node_of(const struct repeats *repeats, const struct question *question)
{
    return dag_node_at(repeats->dag, repeats->oracle, question->first);
}

static const struct tool *tool_of(const struct repeats *repeats, const struct question *question)
{
    const struct dag *dag = repeats->dag;
    return &dag->tools[dag_node_at(dag, repeats->oracle, question->first)->tool];
}

/* ---- the questions */

static void find_questions(struct repeats *repeats)
{
    struct dag *dag = repeats->dag;
    struct table table = {NULL, NULL, 0, 0};
    int count = repeats->oracle->order.count;
    repeats->question_count = 0;
    for (int i = 0; i < count; i++) {
        const struct node *node = dag_node_at(dag, repeats->oracle, i);
        int old = dag_put(&dag->arena, &table, dag_call_text(dag, node), repeats->question_count);
        repeats->question[i] = old >= 0 ? old : repeats->question_count++;
    }
    repeats->questions =
        dag_alloc(&dag->arena, (size_t)repeats->question_count * sizeof(struct question));
    for (int i = count - 1; i >= 0; i--) {
        struct question *question = &repeats->questions[repeats->question[i]];
        question->first = i;
        question->nodes++;
    }
}

/* The questions from `from` on that fill one word. */
static void fill_word(struct repeats *repeats)
{
    const struct dag *dag = repeats->dag;
    int used = 0;
    for (int t = 0; t < dag->tool_count; t++)
        repeats->changed[t] = 0;
    int i;
    for (i = repeats->from; i < repeats->question_count; i++) {
        struct question *question = &repeats->questions[i];
        const struct tool *tool = tool_of(repeats, question);
        if (question->nodes < 2)
            continue;
        question->answers = tool->answers.count < BITS ? tool->answers.count : BITS - 1;
        if (used + 1 + question->answers > BITS)
            break;
        question->shift = used;
        used += 1 + question->answers;
        for (int t = 0; t < dag->tool_count; t++)
            if (may_change(dag, &dag->tools[t], node_of(repeats, question), 0))
                repeats->changed[t] |= UINT64_C(1) << question->shift;
    }
    repeats->to = i;
}

static int answer_bit(const struct question *question, int answer)
{
    return 1 + (answer < question->answers ? answer : question->answers - 1);
}

/* The question's own bits, moved to the right: bit 0 is "not asked". */
static uint64_t bits_of(const struct question *question, uint64_t word)
{
    int width = 1 + question->answers;
    uint64_t mask = width == BITS ? ~UINT64_C(0) : (UINT64_C(1) << width) - 1;
    return word >> question->shift & mask;
}

static uint64_t with_bits(const struct question *question, uint64_t word, uint64_t bits)
{
    return (word & ~(bits_of(question, ~UINT64_C(0)) << question->shift)) | bits << question->shift;
}

static int is_in_word(const struct repeats *repeats, int question)
{
    return question >= repeats->from && question < repeats->to
           && repeats->questions[question].nodes > 1;
}

/* "not asked", of the questions in the word whose answer the node may change. */
static uint64_t changes(const struct repeats *repeats, const struct node *node)
{
    uint64_t changed = repeats->changed[node->tool];
    for (int i = repeats->from; node->reads.count > 0 && i < repeats->to; i++) {
        const struct question *question = &repeats->questions[i];
        if (question->nodes > 1
            && arguments_may_change(repeats->dag, node, node_of(repeats, question)))
            changed |= UINT64_C(1) << question->shift;
    }
    return changed;
}

/* The word once the node at a place has been asked, but for its own question. */
static uint64_t changed_by(const struct repeats *repeats, int place)
{
    uint64_t word = repeats->state[place];
    uint64_t changed = changes(repeats, dag_node_at(repeats->dag, repeats->oracle, place));
    for (int i = repeats->from; changed != 0 && i < repeats->to; i++) {
        const struct question *question = &repeats->questions[i];
        if (question->nodes < 2 || (changed >> question->shift & 1) == 0)
            continue;
        changed &= ~(UINT64_C(1) << question->shift);
        if (bits_of(question, word) != 0)
            word = with_bits(question, word, 1);
    }
    return word;
}

/* The same behind one of its answers; `word` is what changed_by gave. */
static uint64_t after(const struct repeats *repeats, int place, int answer, uint64_t word)
{
    if (!is_in_word(repeats, repeats->question[place]))
        return word;
    const struct question *question = &repeats->questions[repeats->question[place]];
    const struct tool *tool = tool_of(repeats, question);
    uint64_t before = bits_of(question, repeats->state[place]);
    uint64_t bit = UINT64_C(1) << answer_bit(question, answer);
    if ((before & (bit | 1)) == 0) /* the earlier answer was another one */
        return with_bits(question, word, 0);
    return with_bits(question, word,
                     may_change(repeats->dag, tool, node_of(repeats, question), 1) ? 1 : bit);
}

static int is_single(uint64_t bits)
{
    return bits != 0 && (bits & (bits - 1)) == 0;
}

/* The answer that all these bits agree on; -1: they leave it open. */
static int agreed(const struct repeats *repeats, const struct question *question, uint64_t bits)
{
    int answers = tool_of(repeats, question)->answers.count;
    if (!is_single(bits) || bits == 1)
        return -1;
    for (int a = 0; a < question->answers; a++)
        if (bits >> (1 + a) & 1)
            return a == question->answers - 1 && answers > question->answers ? -1 : a;
    return -1;
}

/* A word arrives at a node: remembers the arc if it brings an answer on all its paths. */
static void arrive(struct repeats *repeats, int from, int answer, int place, uint64_t word)
{
    repeats->state[place] |= word;
    if (!is_in_word(repeats, repeats->question[place]))
        return;
    const struct question *question = &repeats->questions[repeats->question[place]];
    uint64_t bits = bits_of(question, word);
    if (bits == 0 || (bits & 1) != 0)
        return;
    int known = agreed(repeats, question, bits) >= 0;
    if (repeats->arc[place] >= 0 && (!known || repeats->arc_known[place]))
        return;
    repeats->arc_known[place] = (unsigned char)known;
    repeats->arc[place] = answer;
    repeats->arc_place[place] = from;
}

static void sweep(struct repeats *repeats)
{
    const struct dag *dag = repeats->dag;
    int count = repeats->oracle->order.count;
    for (int i = 0; i < count; i++) {
        repeats->state[i] = 0;
        repeats->arc[i] = -1;
    }
    for (int i = repeats->from; i < repeats->to; i++)
        if (repeats->questions[i].nodes > 1)
            repeats->state[0] |= UINT64_C(1) << repeats->questions[i].shift;
    for (int i = 0; i < count; i++) {
        const struct node *node = dag_node_at(dag, repeats->oracle, i);
        uint64_t word = changed_by(repeats, i);
        for (int a = 0; a < node->arcs.count; a++) {
            const struct target *target = &dag->arcs[node->arcs.first + a].target;
            if (target->kind == TARGET_NODE)
                arrive(repeats, i, a, dag->nodes[target->index].order, after(repeats, i, a, word));
        }
    }
}

/* ---- what to say */

struct asked {
    const struct node *node;
    const int *question; /* by place in the order */
};

static int asks_it(const struct asked *asked, const struct node *node)
{
    return asked->question[node->order] == asked->question[asked->node->order];
}

/* Phase 1: the question of that node has been asked, and nothing has changed its answer since. */
static int asked(const struct search *search, const struct node *node, int answer, int phase)
{
    const struct asked *context = search->context;
    const struct dag *dag = search->dag;
    const struct tool *tool = &dag->tools[node->tool];
    (void)answer;
    if (asks_it(context, node))
        return !may_change(dag, tool, context->node, 1);
    return phase && !may_change(dag, tool, context->node, 0)
           && !arguments_may_change(dag, node, context->node);
}

/* The path to the node on which it is asked twice, through the arc on which that is sure if there
 * is one; and where that arc can lead instead when it is known what the answer will be. */
static void note_witness(struct repeats *repeats, const struct node *node,
                         const struct question *question)
{
    struct dag *dag = repeats->dag;
    struct search *search = &repeats->search;
    struct asked context = {node, repeats->question};
    int arc = repeats->arc[node->order], place = repeats->arc_place[node->order];
    dag_search(search, repeats->oracle, 2, asked, &context);
    if (arc < 0) {
        const struct node *first = dag_search_turn(search, node);
        if (first != NULL)
            dag_note(dag, first->where, "asked first here: %s",
                     dag_search_path(search, node, 1, -1, NULL));
        return;
    }
    const struct node *last = dag_node_at(dag, repeats->oracle, place);
    int phase = asks_it(&context, last) && dag_search_reached(search, last, 0) ? 0 : 1;
    const struct node *first = phase == 0 ? last : dag_search_turn(search, last);
    if (first == NULL)
        return;
    dag_note(dag, first->where, "asked first here: %s",
             dag_search_path(search, last, phase, arc, node->name));
    int known = agreed(repeats, question,
                       bits_of(question, after(repeats, place, arc, changed_by(repeats, place))));
    if (known >= 0)
        dag_note(dag, dag->arcs[last->arcs.first + arc].target.where,
                 "from here the answer is always '%s': '%s' can lead to '%s' at once",
                 dag_answer_name(dag, node, known), dag_answer_name(dag, last, arc),
                 dag_target_name(dag, &dag->arcs[node->arcs.first + known].target));
}

/* Every path knows the answer. */
static void check_implied(struct repeats *repeats, const struct node *node,
                          const struct question *question, int answer)
{
    struct dag *dag = repeats->dag;
    const char *call = dag_call_text(dag, node);
    int shown =
        dag->tools[node->tool].answers.count == 1
            ? dag_warn(dag, WARNING_IMPLIED_ANSWER, node->where,
                       "'%s' does nothing: every path to it has had %s already", node->name, call)
            : dag_warn(dag, WARNING_IMPLIED_ANSWER, node->where,
                       "'%s' always answers '%s': every path to it has asked %s already",
                       node->name, dag_answer_name(dag, node, answer), call);
    if (shown)
        note_witness(repeats, node, question);
}

static void check_node(struct repeats *repeats, int place)
{
    struct dag *dag = repeats->dag;
    const struct node *node = dag_node_at(dag, repeats->oracle, place);
    const struct question *question = &repeats->questions[repeats->question[place]];
    uint64_t bits = bits_of(question, repeats->state[place]);
    dag->use = node->use;
    int answer = agreed(repeats, question, bits), all = (bits & 1) == 0;
    if ((bits & ~UINT64_C(1)) == 0)
        return;
    if (answer >= 0) {
        check_implied(repeats, node, question, answer);
        return;
    }
    if (dag->tools[node->tool].answers.count == 1)
        return;
    const char *call = dag_call_text(dag, node);
    if (all || repeats->arc[place] >= 0) {
        if (dag_warn(dag, WARNING_REPEATED_QUESTION, node->where,
                     "%s path to '%s' has asked %s already, and nothing has changed the answer",
                     all ? "every" : "a", node->name, call))
            note_witness(repeats, node, question);
    } else if (dag_warn(
                   dag, WARNING_SHARED_QUESTION, node->where,
                   "a path to '%s' has asked %s already, and shares it with paths that have not",
                   node->name, call)) {
        note_witness(repeats, node, question);
        dag_note(dag, dag_nowhere, "a copy of the nodes they share would spare the question");
    }
}

static void check_oracle(struct repeats *repeats)
{
    find_questions(repeats);
    for (repeats->from = 0; repeats->from < repeats->question_count; repeats->from = repeats->to) {
        fill_word(repeats);
        sweep(repeats);
        for (int i = 0; i < repeats->oracle->order.count; i++)
            if (is_in_word(repeats, repeats->question[i]))
                check_node(repeats, i);
    }
}

void dag_analyse_repeats(struct dag *dag)
{
    struct repeats repeats = {0};
    size_t count = (size_t)dag->order_count;
    if (dag_warning_level(dag, WARNING_REPEATED_QUESTION) == LEVEL_OFF
        && dag_warning_level(dag, WARNING_SHARED_QUESTION) == LEVEL_OFF
        && dag_warning_level(dag, WARNING_IMPLIED_ANSWER) == LEVEL_OFF)
        return;
    repeats.dag = dag;
    repeats.question = dag_alloc(&dag->arena, count * sizeof(int));
    repeats.arc = dag_alloc(&dag->arena, count * sizeof(int));
    repeats.arc_place = dag_alloc(&dag->arena, count * sizeof(int));
    repeats.arc_known = dag_alloc(&dag->arena, count);
    repeats.state = dag_alloc(&dag->arena, count * sizeof(uint64_t));
    repeats.changed = dag_alloc(&dag->arena, (size_t)dag->tool_count * sizeof(uint64_t));
    repeats.search = dag_search_new(dag);
    for (int i = 0; i < dag->oracle_count; i++) {
        repeats.oracle = &dag->oracles[i];
        check_oracle(&repeats);
    }
}
