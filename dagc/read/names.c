/* names.c - the catalog's names once they are names in C.
 *
 * Two names that differ in a catalog may meet in catalog.h (the tool `a` with the answer `b_c`
 * and the tool `a_b` with the answer `c` both give A_B_C), and a word of C cannot name a field.
 * Both are found here, in the catalog's terms, and not by a C compiler in generated text.
 * SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <string.h>

#include "base/internal.h"

/* Keywords of C11 and C++20, and macros of the headers that a generated file sees. */
static const char *const words[] = {
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "complex",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "false",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "imaginary",
    "inline",
    "int",
    "linux",
    "long",
    "math_errhandling",
    "mutable",
    "namespace",
    "new",
    "noexcept",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "short",
    "signed",
    "sizeof",
    "static",
    "static_assert",
    "static_cast",
    "struct",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "union",
    "unix",
    "unsigned",
    "using",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
};

/* In capitals every name of letters may be a macro somewhere (NULL, EOF, M_PI, HUGE_VAL, ...);
 * these are the ones that the headers of a generated file do define. */
static const char *const macros[] = {
    "DOMAIN",         "FP_FAST_FMA",  "FP_INFINITE", "FP_NAN",      "FP_NORMAL", "FP_SUBNORMAL",
    "FP_ZERO",        "HUGE_VAL",     "HUGE_VALF",   "HUGE_VALL",   "INFINITY",  "MATH_ERRNO",
    "MATH_ERREXCEPT", "M_E",          "M_LN2",       "M_PI",        "NAN",       "NULL",
    "ORACLE_H",       "DISCUSSION_H", "OUTLINE",     "RUNTIME_ABI", "SIZE_MAX",  "TOOL",
};

static int is_in(const char *const *list, size_t count, const char *name)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(list[i], name) == 0)
            return 1;
    return 0;
}

int dag_is_c_word(const char *name)
{
    return is_in(words, sizeof words / sizeof *words, name)
           || is_in(macros, sizeof macros / sizeof *macros, name);
}

int dag_is_c_taken(const char *name, const char *const *own, size_t count)
{
    return dag_is_c_word(name) || is_in(own, count, name);
}

const char *dag_c_name(struct dag *dag, const char *name)
{
    char *copy = dag_alloc(&dag->arena, strlen(name) + 1);
    for (size_t i = 0; name[i] != '\0'; i++)
        copy[i] = name[i] == '.' ? '_' : name[i];
    return copy;
}

/* The names claimed so far and who claims them. */
struct claims {
    struct table table;
    struct where *where;
    int count;
};

static void claim(struct dag *dag, struct claims *claims, struct where where, const char *prefix,
                  const char *name)
{
    char *full = dag_alloc(&dag->arena, strlen(prefix) + strlen(name) + 2);
    size_t length = 0;
    for (const char *part = prefix; *part != '\0'; part++)
        full[length++] = (char)toupper((unsigned char)*part);
    if (*prefix != '\0')
        full[length++] = '_';
    for (const char *part = name; *part != '\0'; part++)
        full[length++] = *prefix != '\0' ? (char)toupper((unsigned char)*part) : *part;
    int other = dag_put(&dag->arena, &claims->table, full, claims->count);
    if (other >= 0) {
        dag_error(dag, where, "this becomes '%s' in C, as another name does", full);
        dag_note(dag, claims->where[other], "the other is here");
        return;
    }
    claims->where = dag_grow(&dag->arena, claims->where, claims->count, sizeof *claims->where);
    claims->where[claims->count++] = where;
}

/* What else generated text calls NAME_something. */
static void check_verb(struct dag *dag)
{
    static const char *const taken[] = {"arc_kinds", "arc_names",       "arc_nodes",    "arcs",
                                        "clock",     "count",           "counted_part", "counters",
                                        "defaults",  "defaults_any",    "node_names",   "nodes",
                                        "oracle",    "parameter_table", "parameters",   "part",
                                        "reads",     "traced_part"};
    if (is_in(taken, sizeof taken / sizeof *taken, dag->verb))
        dag_error(dag, dag->verb_where, "the C text has another NAME_%s already: take another verb",
                  dag->verb);
}

void dag_check_names(struct dag *dag)
{
    struct claims claims = {{NULL, NULL, 0, 0}, NULL, 0};
    check_verb(dag);
    if (dag->error_count > 0) /* what is declared twice has been named already */
        return;
    for (int i = 0; i < dag->decision_count; i++)
        claim(dag, &claims, dag->decisions[i].where, "decision", dag->decisions[i].name);
    for (int i = 0; i < dag->tool_count; i++) {
        const struct tool *tool = &dag->tools[i];
        claim(dag, &claims, tool->where, tool->name, "answers");
        for (int a = 0; a < tool->answers.count; a++) {
            const struct answer *answer = &dag->answers[tool->answers.first + a];
            claim(dag, &claims, answer->where, tool->name, answer->name);
        }
    }
    for (int i = 0; i < dag->term_count; i++) {
        const struct term *term = &dag->terms[i];
        if (dag_is_c_word(term->name)) {
            dag_error(dag, term->where, "'%s' is a word of C or C++ and cannot name a term",
                      term->name);
            dag_note(dag, dag_nowhere, "choose another name, such as '%s_'", term->name);
        }
        claim(dag, &claims, term->where, "", term->name);
        claim(dag, &claims, term->where, "", dag_format(&dag->arena, "%s_level", term->name));
        claim(dag, &claims, term->where, term->name, "absent");
        if (term->levels.count == 0)
            claim(dag, &claims, term->where, term->name, "present");
        for (int l = 0; l < term->levels.count; l++) {
            const struct level *level = &dag->levels[term->levels.first + l];
            claim(dag, &claims, level->where, term->name, level->name);
        }
    }
    for (int i = 0; i < dag->fact_count; i++) {
        const struct fact *fact = &dag->facts[i];
        claim(dag, &claims, fact->where, "fact", dag_c_name(dag, fact->name));
    }
    for (int i = 0; i < dag->role_count; i++)
        claim(dag, &claims, dag->roles[i].where, "role", dag->roles[i].name);
    for (int i = 0; i < dag->callback_count; i++) {
        const struct callback *callback = &dag->callbacks[i];
        if (dag_is_c_word(callback->name))
            dag_error(dag, callback->where, "'%s' is a word of C or C++ and cannot name a function",
                      callback->name);
    }
}
