/* emit_standalone.c - an oracle with all it needs: one .c and one .h, no other header but libc's
 * and the program's own.
 *
 * Into the header go the runtime's header, the generated catalog and the prototypes; into the C
 * file the headers of the tools and terms that the oracles reach, and the functions. Files go in
 * whole (amalgam.c), from the folders of -I, from beside the catalog, or from those built into the
 * command when the runtime's header is one of these. Of the catalog only what those texts name is
 * generated, so all is done twice, at first without it. Every name that is defined gets the prefix
 * (c_names.c), so that the two files can be dropped into any program, beside others of their kind.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/amalgam.h"
#include "emit/emit.h"
#include "emit/headers.h"

struct standalone {
    struct dag *dag;
    struct emit_options options;
    const unsigned char *tools; /* by tool: is its answers' enum in the catalog? */
    const unsigned char *reached;
    struct amalgam files;
};

/* The text in the arena; the buffer is freed. A text that was cut short must not go on. */
static const char *text_kept(struct dag *dag, struct text *text)
{
    if (text->failed) {
        dag_text_free(text);
        dag_out_of_memory(&dag->arena);
    }
    const char *copy = dag_copy(&dag->arena, text->bytes == NULL ? "" : text->bytes, text->length);
    dag_text_free(text);
    return copy;
}

static const char declarations_name[] = "<declarations>", functions_name[] = "<functions>";

/* What dagc writes itself. */
static void add_generated(struct standalone *s)
{
    struct dag *dag = s->dag;
    struct text catalog = {0}, declarations = {0}, functions = {0};
    dag_emit_catalog_part(dag, &catalog, s->options.terms, s->tools);
    dag_amalgam_text(&s->files, "catalog.h", text_kept(dag, &catalog));
    dag_emit_externs(dag, &declarations);
    for (int i = 0; i < dag->oracle_count; i++)
        dag_emit_oracle_h(dag, &declarations, &dag->oracles[i], &s->options);
    dag_amalgam_text(&s->files, declarations_name, text_kept(dag, &declarations));
    dag_emit_accessors(dag, &functions);
    dag_emit_callers(dag, &functions, s->reached, &s->options);
    if (s->options.wave)
        dag_emit_wave_calls(dag, &functions, s->reached);
    dag_emit_known_macro(dag, &functions, &s->options);
    for (int i = 0; i < dag->oracle_count; i++)
        dag_emit_oracle_c(dag, &functions, &dag->oracles[i], &s->options);
    dag_amalgam_text(&s->files, functions_name, text_kept(dag, &functions));
    for (int i = 0; i < dag->callback_count; i++) /* each refiner has its own kind of discussion */
        dag_put(&dag->arena, &s->files.names.ordinary, dag->callbacks[i].name, 1);
}

static void put(struct standalone *s, struct text *out, const char *name, struct where declared)
{
    struct dag *dag = s->dag;
    const char *beside = dag_source_folder(dag, declared.source);
    if (dag_amalgam_put(&s->files, out, name, beside))
        return;
    dag_error(dag, declared, "no header \"%s\" for --standalone", name);
    dag_note(dag, dag_nowhere, "looked for in the folders given with -I%s",
             beside == NULL ? "" : " and beside this file");
}

static void put_public(struct standalone *s, struct text *out)
{
    put(s, out, s->dag->runtime_header, s->dag->runtime_where);
    put(s, out, "catalog.h", dag_nowhere);
    (void)dag_amalgam_put(&s->files, out, "standalone.h", NULL); /* a runtime need not have one */
}

static void put_private(struct standalone *s, struct text *out)
{
    struct dag *dag = s->dag;
    const unsigned char *terms = dag_emit_reached(dag).terms;
    for (int i = 0; i < dag->tool_count; i++)
        if (s->reached[i])
            put(s, out, dag->tools[i].header, dag->tools[i].where);
    for (int i = 0; i < dag->term_count; i++)
        if (terms[i])
            put(s, out, dag->terms[i].header, dag->terms[i].where);
    for (int i = 0; i < dag->tool_count && s->options.wave; i++)
        if (s->reached[i] && dag->tools[i].wave != NULL)
            put(s, out, dag->tools[i].wave, dag->tools[i].where);
    for (int i = 0; i < dag->term_count && s->options.wave; i++)
        if (terms[i] && dag->terms[i].wave != NULL)
            put(s, out, dag->terms[i].wave, dag->terms[i].where);
    put(s, out, functions_name, dag_nowhere);
}

/* All files are found and the names they define gathered. */
static void open_files(struct standalone *s, const char *prefix)
{
    s->files = (struct amalgam){0};
    s->files.dag = s->dag;
    s->files.prefix = prefix;
    s->files.directives = s->options.directives;
    s->files.host = s->options.host;
    s->files.host_count = s->options.host_count;
    s->files.built_in = dag_runtime_is_ours(s->dag);
    add_generated(s);
    put_public(s, NULL);
    put_private(s, NULL);
    dag_amalgam_again(&s->files);
}

/* By term: do the texts name it? The catalog says what a tool reads and writes of the data manager,
 * but its function may use more. */
static unsigned char *find_terms(struct dag *dag, const struct amalgam *files)
{
    unsigned char *found = dag_alloc(&dag->arena, (size_t)dag->term_count);
    for (int i = 0; i < dag->term_count; i++)
        found[i] = dag_find(&files->members, dag->terms[i].name) >= 0
                   || dag_find(&files->names.expanded,
                               dag_format(&dag->arena, "%s_level", dag->terms[i].name))
                          >= 0;
    return found;
}

/* By tool: do the texts name one of its answers? */
static unsigned char *find_tools(struct dag *dag, const struct amalgam *files)
{
    unsigned char *found = dag_alloc(&dag->arena, (size_t)dag->tool_count);
    for (int i = 0; i < dag->tool_count; i++) {
        const struct tool *tool = &dag->tools[i];
        const char *name = dag_c_upper(dag, tool->name);
        found[i] =
            dag_find(&files->names.expanded, dag_format(&dag->arena, "%s_answer", tool->name)) >= 0;
        found[i] |=
            dag_find(&files->names.expanded, dag_format(&dag->arena, "%s_ANSWERS", name)) >= 0;
        for (int a = 0; a < tool->answers.count; a++) {
            const char *answer =
                dag_format(&dag->arena, "%s_%s", name,
                           dag_c_upper(dag, dag->answers[tool->answers.first + a].name));
            found[i] |= dag_find(&files->names.expanded, answer) >= 0;
        }
    }
    return found;
}

int dag_is_prefix(const char *text)
{
    int letters = 0;
    for (const char *at = text; *at != '\0'; at++) {
        letters |= (*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z');
        if (!((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || *at == '_'
              || (at != text && *at >= '0' && *at <= '9')))
            return 0;
    }
    return letters && strlen(text) <= NAME_MAX_LENGTH;
}

/* Is the guard that of a header which stays where it is? It is not read, but guards go by names. */
static int is_guard_of_host(struct dag *dag, const struct emit_options *options, const char *guard)
{
    for (int i = 0; i < options->host_count; i++) {
        const char *path = options->host[i], *slash = strrchr(path, '/');
        const char *base = slash == NULL ? path : slash + 1;
        char *name = dag_alloc(&dag->arena, strlen(base) + 1);
        memcpy(name, base, strlen(base));
        for (char *at = name; *at != '\0'; at++)
            *at = *at == '.' || *at == '-' ? '_' : *at;
        if (strcmp(dag_c_upper(dag, name), guard) == 0)
            return 1;
    }
    return 0;
}

/* The header's: PREFIX_H, but where a file in it, or one that it includes, has that. */
static const char *choose_guard(struct standalone *s)
{
    struct dag *dag = s->dag;
    const char *upper = dag_c_upper(dag, s->files.prefix);
    const char *guard = dag_format(&dag->arena, "%s_H", upper);
    while (dag_find(&s->files.names.macros, guard) >= 0
           || is_guard_of_host(dag, &s->options, guard))
        guard = dag_format(&dag->arena, "%s_%s", upper, guard);
    dag_put(&dag->arena, &s->files.names.macros, guard, 1);
    return guard;
}

void dag_emit_standalone(struct dag *dag, struct text *c, struct text *header,
                         const char *header_name, const struct emit_options *options)
{
    const char *prefix = options->prefix != NULL ? options->prefix : dag->oracles[0].name;
    struct standalone s = {0};
    s.dag = dag;
    s.options = *options;
    s.reached = dag_emit_reached_tools(dag);
    s.options.terms = dag_alloc(&dag->arena, (size_t)dag->term_count); /* none */
    s.tools = dag_alloc(&dag->arena, (size_t)dag->tool_count);
    open_files(&s, prefix);
    if (dag->error_count > 0)
        return;
    s.options.terms = find_terms(dag, &s.files);
    s.tools = find_tools(dag, &s.files);
    open_files(&s, prefix);
    const char *guard = choose_guard(&s);

    dag_emit_banner(dag, header);
    dag_print(header, "#ifndef %s\n#define %s\n", guard, guard);
    put_public(&s, header);
    if (!options->cxx)
        dag_print(header, "\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n");
    put(&s, header, declarations_name, dag_nowhere);
    if (!options->cxx)
        dag_print(header, "\n#ifdef __cplusplus\n}\n#endif\n");
    dag_print(header, "\n#endif\n");

    dag_emit_banner(dag, c);
    dag_print(c,
              "#include \"%s\"\n\n#include <math.h>\n#include <stddef.h>\n%s\n"
              "/* Whole files are in here; no graph uses all that is in them. */\n"
              "#if defined __GNUC__ || defined __clang__\n"
              "#pragma GCC diagnostic ignored \"-Wunused-function\"\n"
              "#pragma GCC diagnostic ignored \"-Wunused-macros\"\n#endif\n",
              header_name, options->wave ? "#include <stdint.h>\n" : "");
    put_private(&s, c);
}
