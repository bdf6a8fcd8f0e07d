/* internal.h - what the passes share with each other and not with the library's users.
 *
 * A pass is a function over a `struct dag`: it reports what is wrong and goes on, so that one run
 * finds all errors; whoever runs the passes looks at dag->error_count between them. Memory that
 * runs out leaves a pass through dag_protect, never through exit.
 * SPDX-License-Identifier: MIT */
#ifndef INTERNAL_H
#define INTERNAL_H

#include <setjmp.h>
#include <stdarg.h>

#include "dag.h"

#if defined __GNUC__
#define PRINTF_LIKE(text, rest) __attribute__((format(printf, text, rest)))
#define NO_RETURN __attribute__((noreturn))
#else
#define PRINTF_LIKE(text, rest)
#define NO_RETURN
#endif

enum {
    NAME_MAX_LENGTH = 63,         /* what every C compiler tells apart */
    STRING_MAX_LENGTH = 2000,     /* C promises 4095 in a literal; escapes take up to twice */
    SOURCE_MAX_LENGTH = 64 << 20, /* so that every offset and index is an int */
    VECTOR_MAX_LENGTH = 16,
    BRANCH_DEPTH = 64,   /* branches within branches */
    NODES_MAX = 1 << 16, /* of a file's oracles that use branches, these expanded */
    ANSWERS_MAX = 256    /* an answer's number fits a byte */
};
#define PI 3.14159265358979323846 /* `pi` of the language */

/* ---- arena.c */

struct protector {
    jmp_buf jump;
};

/* Runs body(dag, context); 0, or -1 when memory ran out. Numbers are read and written with a
 * decimal point inside, whatever the thread's locale. */
int dag_protect(struct dag *dag, void (*body)(struct dag *dag, void *context), void *context);

struct dag *dag_new(void);                         /* NULL: out of memory */
void *dag_alloc(struct arena *arena, size_t size); /* zeroed, aligned for anything */
void *dag_grow(struct arena *arena, void *items, int count, size_t size);
void dag_arena_free(struct arena *arena);
NO_RETURN void dag_out_of_memory(struct arena *arena); /* back to dag_protect */
const char *dag_copy(struct arena *arena, const char *text, size_t length);
const char *dag_format(struct arena *arena, const char *format, ...) PRINTF_LIKE(2, 3);
const char *dag_vformat(struct arena *arena, const char *format, va_list arguments);

/* Appends a zeroed item to a list of the dag: its index. */
#define ADD(dag, list, list_count) \
    ((dag)->list = dag_grow(&(dag)->arena, (dag)->list, (dag)->list_count, sizeof *(dag)->list), \
     (dag)->list_count++)

int dag_find(const struct table *table, const char *name); /* -1: not there */
/* Adds the name; or returns the value it already has, changing nothing, else -1. */
int dag_put(struct arena *arena, struct table *table, const char *name, int value);

/* ---- text.c: output in memory; a failure to grow sticks until it is asked for */

struct text {
    char *bytes;
    size_t length, capacity;
    int failed;
};

void dag_print(struct text *text, const char *format, ...) PRINTF_LIKE(2, 3);
void dag_print_upper(struct text *text, const char *name);
void dag_print_constant(struct text *text, const char *prefix, const char *name); /* PREFIX_NAME */
void dag_print_number(struct text *text, double value); /* as C: 0.1, 16.0, -INFINITY */
void dag_print_integer(struct text *text, double value);
void dag_print_string(struct text *text, const char *value);  /* as a C literal, quotes included */
void dag_print_comment(struct text *text, const char *value); /* safe inside a C comment */
void dag_text_free(struct text *text);
/* Shortest digits that read back as the same double; "inf" for the infinities. */
const char *dag_number(double value, char buffer[32]);

/* ---- source.c */

/* A file's bytes, read before a dag is protected, so that nothing is lost when memory runs out. */
struct input {
    const char *name;
    const char *bytes;
    char *owned; /* the same, when dag_input_close is to free it */
    size_t length;
    int error;              /* an errno; dag_read reports it */
    unsigned char is_file;  /* not standard input, not a text in memory */
    uint64_t device, inode; /* which file it is */
    int on_disk;            /* these are known */
};
void dag_input_open(struct input *input, const char *path); /* "-": standard input */
/* What a source names: a pipe may have no other end, and is refused with ENOTSUP. */
void dag_input_open_named(struct input *input, const char *path);
void dag_input_close(struct input *input);
int dag_read(struct dag *dag, const struct input *input); /* index in sources; -1 after an error */
int dag_read_text(struct dag *dag, const char *name, const char *text, size_t length);

/* ---- import.c */

/* Reads the next import that names a new source: its index; -1: there is none left. */
int dag_next_import(struct dag *dag);

/* ---- catalog_name.c */

/* The path that a text names by `catalog "PATH";`, in the arena; NULL: it names none. */
const char *dag_named_catalog(struct dag *dag, const struct input *file);
/* Opens the catalog that a file at `beside` names; 0: there is none of this name. */
int dag_open_catalog(struct dag *dag, const char *path, const char *beside, struct input *input);
/* NULL: the catalog that was read is this one (path NULL: the standard one); else what is wrong. */
const char *dag_other_catalog(struct dag *dag, const char *path, int source);

/* ---- diag.c */

extern const struct where dag_nowhere;
void dag_error(struct dag *dag, struct where where, const char *format, ...) PRINTF_LIKE(3, 4);
/* Explains the last error or warning; dropped when that was dropped. */
void dag_note(struct dag *dag, struct where where, const char *format, ...) PRINTF_LIKE(3, 4);
/* Keeps a finished message, or only counts it when it is one too many: was it kept? */
int dag_report(struct dag *dag, enum severity severity, struct where where, const char *message);
int dag_is_full(const struct dag *dag, enum severity severity); /* the next is one too many */
/* Prints all messages in the order of the sources, then how many there were. */
void dag_print_diagnostics(const struct dag *dag, FILE *out);
int dag_line(const struct source *source, int offset); /* 1-based */

/* The nearest name: set `wanted`, offer every candidate, then say it as a note if one is near. */
struct suggestion {
    const char *wanted;
    const char *best;
    int distance;
};
void dag_suggest(struct suggestion *suggestion, const char *candidate);
void dag_note_suggestion(struct dag *dag, const struct suggestion *suggestion);
int dag_errors_full(const struct dag *dag); /* no more are shown: save the search */

/* ---- lex.c */

enum token_kind {
    TOKEN_END,
    TOKEN_NAME,
    TOKEN_NUMBER,
    TOKEN_STRING,
    TOKEN_ARROW,      /* -> */
    TOKEN_AT_LEAST,   /* >= */
    TOKEN_PUNCTUATION /* one character, in `mark` */
};

struct token {
    enum token_kind kind;
    char mark;
    struct where where;
    const char *text; /* NAME, STRING: in the arena */
    double number;
};

/* Plain data: a copy looks ahead. `quiet` copies report nothing. */
struct lexer {
    struct dag *dag;
    int source, offset;
    int quiet;
};

struct token dag_lex(struct lexer *lexer);

/* ---- passes.c */

/* What --dump can show, and --emit=text after the last of them. */
enum pass {
#define PASS(number, name, says) PASS_##number,
#include "base/passes.def"
#undef PASS
    PASSES
};

/* Runs them over a catalog and then, unless it is NULL, over a file of oracles, up to the pass that
 * --dump is to show (PASSES: all) or to errors, which dag->error_count tells. */
void dag_run_passes(struct dag *dag, const struct input *catalog, const struct input *file,
                    enum pass stop);

/* ---- passes, in their order */

enum content { CONTENT_CATALOG, CONTENT_ORACLES };
void dag_parse(struct dag *dag, int source, enum content content); /* and what it imports */
void dag_resolve_catalog(struct dag *dag); /* what was declared since the last time */
void dag_check_names(struct dag *dag);     /* the catalog's names as C names */
void dag_replace(struct dag *dag);         /* nodes, as dag_options.replacements say */
void dag_resolve(struct dag *dag);         /* the oracles: names to indices, rules to arcs */
void dag_check_values(struct dag *dag);    /* types, units, ranges */
void dag_expand(struct dag *dag);          /* branches to plain nodes */
void dag_check_graph(struct dag *dag);     /* cycles; the topological order */
void dag_analyse(struct dag *dag);         /* what paths prove: warnings, terms, termination */
void dag_fingerprint(struct dag *dag);
/* What --emit=c adds to the plain function. */
struct emit_options {
    int counted;        /* --instrument: NAME_refine_counted */
    int traced;         /* --trace: NAME_refine_traced */
    int wave;           /* --release=wave: NAME_refine_wave */
    int copies;         /* --copies: of a node for what paths know, at most; 0: one */
    int outline;        /* --outline: graphs used more than once are functions */
    int lines;          /* --lines: a comment at each node says where it stands in its source */
    int directives;     /* --line-directives: #line (line_directives.h) */
    int cxx;            /* for C++: functions have its linkage */
    int standalone;     /* --standalone: all that it needs, in one .c and one .h */
    const char *prefix; /* of every name in it; NULL: the first oracle's name */
    const char *const *folders; /* -I: where headers are looked for before the built-in ones */
    int folder_count;
    const char *const *host; /* --host: headers that --standalone leaves to the program */
    int host_count;
    const unsigned char *terms; /* by term: is it in struct terms? NULL: all are */
    const char *before;         /* of --prove: text before the first oracle; NULL: none */
};
void dag_emit_c(struct dag *dag, struct text *c, struct text *header, const char *header_name,
                const struct emit_options *options); /* options NULL: nothing is added */
int dag_is_prefix(const char *text);                 /* can it begin the C names of --standalone? */
void dag_emit_standalone(struct dag *dag, struct text *c, struct text *header,
                         const char *header_name, const struct emit_options *options);
void dag_emit_dot(struct dag *dag, struct text *out);
void dag_emit_json(struct dag *dag, struct text *out);
void dag_emit_text(struct dag *dag, struct text *out, enum pass pass);
void dag_emit_availability(struct dag *dag, struct text *out); /* --dump=availability */
void dag_emit_waves(struct dag *dag, struct text *out);        /* --dump=waves */
void dag_emit_catalog_doc(struct dag *dag, struct text *out);
void dag_emit_catalog_h(const struct dag *dag, struct text *out);
/* terms: as above; tools, by tool: are its answers in it? NULL: all are */
void dag_emit_catalog_part(const struct dag *dag, struct text *out, const unsigned char *terms,
                           const unsigned char *tools);
void dag_emit_catalog_c(const struct dag *dag, struct text *out);
/* a tool's or term's header */
void dag_emit_stub(struct dag *dag, struct text *out, const char *name);
/* What `wave` in the catalog asks for besides. */
void dag_emit_stub_wave(struct dag *dag, struct text *out, const char *name);

/* ---- expression.c */

int dag_reads_parameters(const struct dag *dag, int expression);
/* Adds an expression over operands that are there (-1: none); sets its size and depth. */
int dag_add_expression(struct dag *dag, const struct expression *expression);
/* A negative number is a number, however it is written: in parentheses, as -pi, or as an argument
 * that takes the place of a parameter. */
void dag_fold(const struct dag *dag, struct expression *e);
/* Appends to needs what the tree reads, in the order of evaluation. */
void dag_add_reads(struct dag *dag, int expression);
/* The expression as the source has it, cut when it is long. */
const char *dag_expression_text(struct dag *dag, int expression);

/* ---- check_expression.c */

/* Units, bounds and wholeness of the tree; 0 after an error. */
int dag_check_expression(struct dag *dag, int expression);

/* ---- unit.c, names.c */

int dag_parse_unit(const struct dag *dag, const char *text,
                   struct unit *unit);        /* -1, or the offset of what is wrong */
const char *dag_known_units(struct dag *dag); /* "m kg s ..." */
int dag_is_si_unit(const char *name);
/* for messages: "W/m2", "a plain number" */
const char *dag_unit_name(const struct type *type);
/* Exponents a + sign * b; 0: too large. */
int dag_unit_product(struct unit *result, const struct unit *a, const struct unit *b, int sign);
int dag_unit_root(struct unit *unit); /* halves the exponents; 0: one is odd */
/* "W/m2", as the catalog's first type of this unit has it, else in base units. */
const char *dag_unit_text(struct dag *dag, const struct unit *unit);
const char *dag_c_name(struct dag *dag, const char *name); /* receiver.area: receiver_area */
int dag_is_c_word(const char *name); /* keyword of C or C++, or a macro of the headers */
/* Such a word, or one of own[count], which a text has of its own; what it calls a variable then
 * gets an underscore. */
int dag_is_c_taken(const char *name, const char *const *own, size_t count);

#endif
