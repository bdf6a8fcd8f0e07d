/* dag.h - the data dictionary of dagc: what a catalog and its decision graphs are in memory.
 *
 * A `struct dag` is one compilation: the sources, the catalog (types, terms, tools, decisions:
 * all that the compiler knows of its domain) and the oracles. Every kind of thing lives in one
 * array of the dag, and things name each other by index in that array, -1 for "none"; a list is
 * a span of an array. So neither order nor output can depend on an address, and one arena holds
 * and frees it all.
 *
 * Sources: Turbet and Sillion for the graph (nodes hold tools, arcs are answers, leaves are
 * decisions); QBE and chibicc for a compiler's data in one commented header.
 * SPDX-License-Identifier: MIT */
#ifndef DAG_H
#define DAG_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DAGC_VERSION "0.1.0"

/* A list: items first .. first + count - 1 of the array that the field's comment names. */
struct span {
    int first, count;
};

/* A piece of source text, for messages; line and column are computed only when printed. */
struct where {
    int source;         /* in sources; -1: nowhere (a whole file, the command line) */
    int offset, length; /* bytes */
};

enum { LINES_STEP = 1024 };

struct source {
    const char *name;       /* as the user gave it */
    const char *base;       /* without its directory: what generated files may mention */
    const char *text;       /* NUL-terminated copy */
    int length;             /* bytes, without the NUL */
    const int *lines;       /* how many end before byte 0, LINES_STEP, 2 * LINES_STEP ... */
    unsigned char is_file;  /* `name` is its path; else standard input or a text in memory */
    struct where importer;  /* the `import` that asked for it; nowhere: it was given */
    uint64_t device, inode; /* which file it is, however it is called */
    unsigned char on_disk;  /* device and inode are known */
    unsigned char standard; /* dagc_standard_catalog */
};

/* import "FILE"; or import standard; in the order of reading. */
struct import {
    const char *path; /* as written; NULL: the standard catalog */
    struct where where;
    int source; /* in sources; -1: not read */
};

/* Exponents of the base units m, kg, s, A, K, mol, cd; all zero: a plain number. */
enum { UNIT_BASES = 7 };
struct unit {
    signed char exponent[UNIT_BASES];
    double size; /* in those units: of ms 0.001; 0: 1 */
};

/* unit NAME = NUMBER UNIT; a unit of the catalog's own. */
struct own_unit {
    const char *name;
    struct where where;
    double number;
    const char *text; /* what it is a multiple of, as written: "m/s" */
    struct where text_where;
    struct unit unit;
    unsigned char known; /* unit is set */
};

enum base { BASE_REAL, BASE_INTEGER };

/* type NAME = real|real[N]|integer "UNIT"; */
struct type {
    const char *name;
    struct where where;    /* of the name; so in every struct below */
    enum base base;        /* double or int in C */
    int length;            /* 1: a scalar; N: a vector of N */
    const char *unit_text; /* as written: "W/m2" */
    struct where unit_where;
    struct unit unit;       /* the same, comparable */
    unsigned char any_unit; /* "?": whatever it is given; only of a tool's parameters */
};

/* One step of a term's precision, coarsest first. */
struct level {
    const char *name;
    struct where where;
};

/* term NAME : TYPE [in [a, b]] [levels (a < b < c)] [header "H"] [wave] "doc"; a value in the data
 * manager. */
struct term {
    const char *name;
    struct where where;
    struct where type_where;
    const char *type_name;
    int type;           /* in types */
    struct span levels; /* in levels; empty: the term is absent or present */
    double low, high;   /* the values it can have */
    const char *header; /* C header with `term_NAME`, "terms/NAME.h" when not written */
    const char *wave;   /* with `wave_term_NAME`: header's name with .wave.h; NULL: there is none */
    const char *doc;
};

/* fact NAME[.NAME] : TYPE [in [a, b]] [fixed] = "C" "doc"; a number that is there for the asking:
 * of an element, of the scene. */
struct fact {
    const char *name; /* "receiver.area" */
    struct where where;
    struct where type_where;
    const char *type_name;
    int type;
    double low, high;
    const char *c;       /* its value as a C expression over `const struct discussion *d` */
    unsigned char fixed; /* one number for all pairs */
    const char *doc;
};

/* role NAME : TYPE "doc"; what a parameter of an oracle may be for a program, which finds it by
 * this and not by its name. */
struct role {
    const char *name;
    struct where where;
    struct where type_where;
    const char *type_name;
    int type;
    const char *doc;
};

/* extern NAME(needs) : TYPE [in [a, b]] "doc"; a C function of the user's that gives a number:
 * double NAME(const struct discussion *d). */
struct callback {
    const char *name;
    struct where where;
    struct where type_where;
    const char *type_name;
    int type;
    double low, high;
    struct span reads; /* in needs: terms that are there, at that level, when it is called */
    const char *doc;
};

/* A term at a level or better, as tools and decisions read or write it. */
struct need {
    const char *term_name, *level_name; /* level_name NULL: none was written */
    struct where where, level_where;
    int term;  /* in terms */
    int level; /* 1 is the coarsest (or "present"), 0 `absent` (of decisions): what a path has is
                  kept, but not asked for; the enums of catalog.h count alike */
};

/* A parameter of an oracle, of a branch, or of a tool. */
struct parameter {
    const char *name;
    struct where where;
    struct where type_where, value_where, range_where, role_where;
    const char *type_name;
    const char *role_name; /* as written; NULL: none */
    int role;              /* in roles; -1: none */
    int type;              /* in types; always a scalar */
    const char *doc;       /* "" when none */
    double value;          /* the default, NAN when there is none (tools only) */
    double low, high;      /* closed range; -INFINITY, INFINITY when none was written */
    unsigned char fixed;   /* of an oracle: its author's; else it is offered to the user */
    unsigned char given;   /* PARAMETER_VALUE | PARAMETER_RANGE: which of them were written */
    unsigned char bad;     /* an error was reported: say no more about its value or range */
};
enum { PARAMETER_VALUE = 1, PARAMETER_RANGE = 2 };

/* How far an answer can be trusted. [Turbet & Sillion, section 3] */
enum kind { KIND_PRECISE, KIND_APPROXIMATE, KIND_OTHER };

struct answer {
    const char *name;
    struct where where;
    enum kind kind;
    /* of a command, NAME refuses: it could not; the terms that it writes are as they were */
    unsigned char refuses;
};

enum tool_kind { TOOL_QUESTION, TOOL_COMMAND };

/* What a walk that counts keeps of a tool's arguments. */
enum keeps {
    KEEPS_NOTHING,
    KEEPS_COUNT, /* counts: how often its only argument, a whole number, had each value */
    /* records: a histogram of its first argument, under the number that is the second */
    KEEPS_RECORD
};

/* A name as written where its meaning is looked up later: an answer, a parameter. */
struct label {
    const char *name;
    struct where where;
};

/* answer -> decision, in a tool's `guards`: with this answer the decision lowers the guard's
 * measure, which no subdivision raises. */
struct guard {
    struct label answer, decision;
    int answer_index;   /* of the tool */
    int decision_index; /* in decisions */
};

/* tool NAME(parameters) question|command answers (...) [reads] [writes]
 * [guards (...) [by (...)] [after TOOL(...)]] [counts|records] [header] [wave] [anywhere] "doc"; */
struct tool {
    const char *name;
    struct where where;
    enum tool_kind kind;
    struct span parameters; /* in parameters */
    struct span answers;    /* in answers; their numbers, from 0, are the C enum's values */
    struct span reads;      /* in needs */
    struct span writes;     /* in needs */
    struct span guards;     /* in guards: what its answers allow */
    /* in labels, its parameters: one of them must be above 0, and the same for a pair and what
     * becomes of it, or its answers allow nothing; empty: they always do */
    struct span by;
    struct label after; /* a tool; name NULL: none. Its answers allow something only behind */
    struct span after_answers; /* these of it, in labels */
    int after_index;           /* in tools */
    enum keeps keeps;
    struct where keeps_where; /* of the word that says so */
    const char *header;       /* C header with `tool_NAME`, "tools/NAME.h" when not written */
    const char *wave;         /* with `wave_NAME`, likewise, its form over a block; NULL: none */
    unsigned char anywhere;   /* it has an answer for every pair, whatever others have answered */
    const char *doc;
};

/* (Named so that an enum decision may stand beside it.) decision NAME [reads (...)] [subdivides]
 * "doc"; a leaf, the same in every oracle. */
struct decision_tool {
    const char *name;
    struct where where;
    struct span reads;        /* in needs: the terms the decision uses */
    unsigned char subdivides; /* the pair is discussed again, one step deeper */
    const char *doc;
};

/* The value of an argument: a tree of these. All arithmetic is in double, operands are evaluated
 * from left to right, both of them always. min and max are the same either way round: of no number
 * (0 * inf) and another they make no number, and -0 is less than 0. */
enum expression_kind {
    EXPRESSION_NUMBER,
    EXPRESSION_PARAMETER,
    EXPRESSION_NAME, /* a name not yet resolved, or unknown */
    EXPRESSION_FACT,
    EXPRESSION_TERM,
    EXPRESSION_EXTERN,
    EXPRESSION_NEGATE,
    EXPRESSION_SQRT,
    EXPRESSION_ABS, /* one operand, left */
    EXPRESSION_ADD,
    EXPRESSION_SUBTRACT,
    EXPRESSION_MULTIPLY,
    EXPRESSION_DIVIDE,
    EXPRESSION_MIN,
    EXPRESSION_MAX
};

struct expression {
    enum expression_kind kind;
    struct where where;     /* for a tool's default: of that default in the catalog */
    const char *name;       /* a name as written, with its part behind the '.', if any */
    int dot;                /* offset of the '.' in name; 0: none */
    double number;          /* NUMBER */
    int parameter;          /* PARAMETER: in parameters; in a node, one of the oracle's own */
    int index;              /* FACT, TERM, EXTERN: in facts, terms, callbacks */
    int level;              /* TERM: as in struct need */
    int left, right;        /* operands, in expressions; -1 */
    int size, depth;        /* of the tree: at most EXPRESSION_SIZE and EXPRESSION_DEPTH */
    struct unit unit;       /* of the value; of a bare NUMBER: the unit it was used with */
    double low, high;       /* bounds of the value, by interval arithmetic */
    unsigned char any_unit; /* numbers alone: it has the unit that it is used with */
    unsigned char whole;    /* an integer */
    unsigned char none;     /* enum none: may it be no number, as 0 * inf? */
    unsigned char checked, bad;
};
enum { EXPRESSION_SIZE = 1000, EXPRESSION_DEPTH = 200 };

/* NAME = VALUE between a node's parentheses. */
struct argument {
    const char *name;
    struct where where;
    int parameter;  /* of the tool or branch: in parameters */
    int expression; /* in expressions */
};

/* Where an arc leads: the name of a node or of a decision. */
enum target_kind {
    TARGET_NONE,
    TARGET_NODE,
    TARGET_DECISION,
    TARGET_EXIT /* inside a branch, before it is expanded */
};

struct target {
    enum target_kind kind; /* NONE: unresolved, an error has been reported */
    int index;             /* in nodes (before expand: in drafts), in decisions, or which exit */
    const char *name;
    struct where where;
};

/* answer | answer -> target; as written: resolve turns the rules of a node into its arcs. */
struct rule {
    struct span labels; /* in labels; empty: `otherwise` */
    struct where where;
    struct target target;
};

/* One answer of one node and where it leads. A node's arcs are in the order of its tool's
 * answers, one each, so that arc = node.arcs.first + answer. */
struct arc {
    struct target target;
    struct where where; /* of the rule that maps it */
};

/* One place where a branch is used: of what a node inside it is a copy. */
struct use {
    int branch;         /* in branches */
    const char *node;   /* the name of the node that uses it */
    struct where where; /* of the branch's name there */
    int outer;          /* in uses: of the branch that this node stands in; -1: an oracle */
};

/* node NAME = TOOL(arguments) { rules }
 *
 * Drafts are the nodes as written, of oracles and of branches. Expand makes the nodes of each
 * oracle from them: every use of a branch is replaced by a copy of its nodes, so that later
 * passes know nodes with tools, and no branches. */
struct node {
    const char *name; /* of a copy: USE__NAME */
    struct where where;
    const char *tool_name;
    struct where tool_where;
    int tool;              /* in tools; -1: a branch, or unknown */
    int branch;            /* in branches, of a draft that uses one; else -1 */
    int use;               /* in uses: the use that the node is a part of; -1: the oracle's own */
    struct span written;   /* in arguments: as in the source */
    struct span arguments; /* in arguments: after resolve, one per tool parameter, in the tool's
                              order, defaults filled in */
    struct span reads;     /* in needs: terms that its arguments read, in the order of evaluation */
    struct span rules;     /* in rules: as in the source */
    struct span arcs;      /* in arcs: after resolve */
    int order;             /* place in oracle.order after check; -1: not reachable from start */
    unsigned char bad;     /* broken syntax or unknown tool: do not report what follows from it */
};

/* oracle NAME "doc" { parameters; start NODE; nodes }: a decision graph.
 * graph NAME(parameters) exits (answers) "doc" { start NODE; nodes }: a branch. It is used in a
 * node as a tool is, its exits are the answers. */
struct oracle_graph {
    const char *name;
    struct where where;
    const char *doc;
    struct span parameters; /* in parameters */
    struct span exits;      /* in answers; a branch's */
    struct span drafts;     /* in drafts, in the source's order */
    struct span nodes;      /* in nodes, likewise, each use of a branch at its place; an oracle's */
    struct target start;    /* a node; a branch's: a draft */
    struct span order;      /* in order: the reachable nodes, topologically from start */
    uint64_t fingerprint;   /* of what the graph decides: same number, same decisions */
    int use;                /* of a branch, in uses: the first place that uses it; -1: none */
    unsigned char placed;   /* of a branch: some oracle holds a copy of it */
    unsigned char branch;   /* it is one */
    unsigned char bad;      /* a part was lost to a syntax error: names may seem to be missing */
};

/* A message. Notes follow the message that they explain. */
enum severity { SEVERITY_ERROR, SEVERITY_WARNING, SEVERITY_NOTE };

struct diagnostic {
    enum severity severity;
    struct where where;
    const char *message;
    int use; /* in uses: the branch it was found in; -1 */
};

enum { ERRORS_SHOWN = 50 }; /* the rest of the errors, or of the warnings, are only counted */

/* Memory in blocks that are freed together. Failure to get a block ends the pass that asked:
 * control returns to dag_protect (see internal.h), as in Lua. */
struct block;
struct protector;
struct warnings;
struct profile;
struct arena {
    struct block *blocks;
    struct protector *protector;
};

/* Names of one kind to their index; open addressing, in the arena. */
struct table {
    const char **keys;
    int *values;
    int capacity, count;
};

struct dag {
    struct arena arena;

    /* The catalog. */
    const char *runtime_header; /* included by every generated file; NULL: not declared */
    int runtime_abi;            /* the value RUNTIME_ABI must have */
    int lost;                   /* a declaration lost its name to a syntax error: a name that
                                   seems unknown may be that one */
    struct where runtime_where;
    const char *verb; /* an oracle's function is NAME_VERB; "refine" when not declared */
    struct where verb_where;
    struct own_unit *units;
    int unit_count;
    struct type *types;
    int type_count;
    struct level *levels;
    int level_count;
    struct term *terms;
    int term_count;
    struct need *needs;
    int need_count;
    struct answer *answers;
    int answer_count;
    struct tool *tools;
    int tool_count;
    struct guard *guards;
    int guard_count;
    struct decision_tool *decisions;
    int decision_count; /* their numbers are the C enum's values */
    struct fact *facts;
    int fact_count;
    struct role *roles;
    int role_count; /* their numbers, from 1, are the C enum's values */
    struct callback *callbacks;
    int callback_count;
    struct label *labels; /* of graphs, too */
    int label_count;

    /* The graphs. */
    struct parameter *parameters;
    int parameter_count; /* of tools and of oracles */
    struct expression *expressions;
    int expression_count;
    struct argument *arguments;
    int argument_count;
    struct rule *rules;
    int rule_count;
    struct arc *arcs;
    int arc_count;
    struct node *drafts;
    int draft_count;
    struct node *nodes;
    int node_count;
    struct use *uses;
    int use_count;
    int *order;
    int order_count;               /* indices in nodes */
    const struct profile *profile; /* what --profile told of one oracle; NULL: nothing */
    struct oracle_graph *oracles;
    int oracle_count;
    struct oracle_graph *branches;
    int branch_count;

    /* Names, filled by resolve. */
    struct table unit_names, type_names, term_names, tool_names, decision_names, oracle_names;
    struct table fact_names, callback_names, branch_names, role_names;
    /* how many are */
    struct {
        int units, types, terms, tools, decisions, facts, roles, callbacks;
    } resolved;
    unsigned char recursive; /* some branch uses itself: none is expanded */
    int use;                 /* in uses: of the branch that a pass looks at, for messages; -1 */

    /* Where the text came from and what is wrong with it. */
    struct source *sources;
    int source_count;
    struct import *imports;
    int import_count;
    int imports_read; /* the first so many have been read */
    const char *const *folders;
    int folder_count;                /* where to look for imports */
    const char *const *replacements; /* [replacement_count], as in struct dag_options */
    int replacement_count;
    char *opened;  /* a catalog's bytes, until it is a source */
    char *reading; /* a file's bytes on their way into sources */
    struct diagnostic *diagnostics;
    int diagnostic_count;
    int error_count, warning_count;  /* all of them, also those not kept */
    unsigned char muted;             /* the last one was not kept: nor are its notes */
    const struct warnings *warnings; /* see warn.h; NULL: only those that are errors by nature */
};

/* ------------------------------------------------------------------------------------------
 * The library: load a .dag file, read the arrays above, free it. Thread-safe, no globals. */

/* The catalog built into the library and the command, NUL-terminated (dagc/emit/embed.sh makes
 * it). */
extern const char dagc_standard_catalog[];

/* Reads, resolves and checks the file `path` ("-": standard input; NULL: none, the catalog alone)
 * under a catalog; `catalog` is
 * its text (NULL: dagc_standard_catalog), `catalog_name` what messages call it (NULL: "catalog").
 * All errors go to `errors` as text (NULL: nowhere). Returns NULL after any error, else a dag
 * that dag_free frees, in which every index is valid, every oracle has a start, `order` is
 * topological, and every argument and arc of a reachable node is resolved. */
struct dag *dag_load(const char *path, const char *catalog_name, const char *catalog, FILE *errors);

/* The same for text in memory; `name` stands for the file name in messages. */
struct dag *dag_load_text(const char *name, const char *text, size_t length,
                          const char *catalog_name, const char *catalog, FILE *errors);

/* What else dag_load_with may be told; all zero: what dag_load does. */
struct dag_options {
    const char *text; /* the source itself, `path` being its name; NULL: read path */
    size_t length;    /* of text */
    const char *catalog_name, *catalog; /* as above */
    const char *catalog_path;           /* the catalog's file, instead of its text */
    const char *const *folders; /* where imports are looked for, after the importing file's own */
    int folder_count;
    const char *switches; /* as after `-W` on the command line, separated by spaces, such as
                             "all no-unused-parameter error"; NULL: errors alone */
    /* [replacement_count] of nodes, one after the other, of every oracle that has such a node:
     * "NODE = TOOL(...)", "NODE = TOOL(...) { rules }", or "NODE = ANSWER", which asks nothing
     * (dagc/check/replace.c) */
    const char *const *replacements;
    int replacement_count;
};
struct dag *dag_load_with(const char *path, const struct dag_options *options, FILE *errors);

/* dag_load_text under such switches. */
struct dag *dag_load_switched(const char *switches, const char *name, const char *text,
                              size_t length, const char *catalog_name, const char *catalog,
                              FILE *errors);

void dag_free(struct dag *dag); /* NULL is fine */

/* The system's C compiler and where its files may stand for a while; NULL: "cc", "/tmp". */
struct dag_compiler {
    const char *command, *temporary;
    int wave; /* with the function over blocks of pairs */
};

/* The oracles as machine code: emits C, compiles it against the runtime's headers (which the
 * library carries) and loads it. Returns dlopen's handle, in which each oracle is `const struct
 * oracle NAME_oracle` (oracle.h), or NULL with the cause in `message`. The dag must hold one oracle
 * at least. For each extern that they read the library has a variable
 * `double (*extern_NAME)(const struct discussion *d)`, which is NULL: it is to be set before an
 * oracle that reads it is asked. */
void *dag_compile_oracles(struct dag *dag, const struct dag_compiler *compiler, char *message,
                          size_t size);

/* A C file of the user's, compiled with the same flags against the same headers and, where it
 * includes catalog.h, the standard catalog: dlopen's handle, or NULL with the cause in `message`.
 */
void *dag_compile_plugin(const char *path, const struct dag_compiler *compiler, char *message,
                         size_t size);

/* The oracles, and what they use of the catalog, as --emit=json gives them; for free(). NULL: out
 * of memory. */
char *dag_json(struct dag *dag);

/* Index in oracles of the oracle `name`, or of the only one when name is NULL; -1: none, or
 * many. */
int dag_oracle(const struct dag *dag, const char *name);

/* The node of the oracle at this place of its topological order, from 0. */
const struct node *dag_node_at(const struct dag *dag, const struct oracle_graph *oracle, int place);

/* held[u], one byte for each of uses, is 1 where some of the oracle's nodes are copies made for
 * this use of a branch, or for one in it. */
void dag_held_uses(const struct dag *dag, const struct oracle_graph *oracle, unsigned char *held);

/* The node's name without its branch's: "pair__cut__guard" in "pair__cut" is "guard". `name` of a
 * node or of a use, `use` the one around it; -1: none. */
const char *dag_name_in_use(const struct dag *dag, const char *name, int use);

/* "precise", "approximate", "other". */
const char *dag_kind_name(enum kind kind);

/* Is it made of numbers and parameters alone? Then it is the same in every discussion of a run. */
int dag_is_fixed(const struct dag *dag, int expression);

/* May an argument of a node be no number of its parameter's range, as p / q where both may be 0?
 * Then it is looked at when it is computed: a value that is not from `low` to `high` is replaced by
 * `instead`, the number of the range next to 0, and the discussion's terms.no_number becomes
 * `what`, unless it says something already. */
struct dag_doubt {
    double low, high, instead;
    const char *what; /* a sentence, the dag's */
};
int dag_is_doubtful(const struct dag *dag, const struct argument *argument);
struct dag_doubt dag_doubt(struct dag *dag, const struct node *node,
                           const struct argument *argument);

int dag_same_unit(const struct unit *a, const struct unit *b);

/* Does an argument of some node that the oracle reaches read this fact? */
int dag_reads_fact(const struct dag *dag, const struct oracle_graph *oracle, int fact);

/* Does one read this extern? */
int dag_reads_extern(const struct dag *dag, const struct oracle_graph *oracle, int callback);

/* An error that shows only when a graph is to run, printed as those of the passes:
 * "FILE:LINE:COLUMN: error: MESSAGE", the line with a caret, the note. */
void dag_print_error(const struct dag *dag, struct where where, const char *message,
                     const char *note, FILE *out);

/* The fingerprint as 16 hexadecimal digits and a NUL. */
void dag_fingerprint_text(const struct oracle_graph *oracle, char text[17]);

#ifdef __cplusplus
}
#endif

#endif
