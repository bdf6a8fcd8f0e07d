/* emit_standalone.c - an oracle with all it needs: one .c and one .h, no other header but libc's.
 *
 * The texts of the runtime's header, of the tools' and of whatever they include (from the folders
 * of -I, else those built into the command, headers.c) and the generated catalog are taken apart
 * into items (c_items.c). Kept is what the oracles' functions need, no more: to know which terms
 * that are, all is done twice, at first without those that nothing but their own clearing names.
 * What the prototypes need goes to the header. Every name that is declared gets the prefix, so that
 * the two files can be dropped into any program, beside others of their kind.
 * SPDX-License-Identifier: MIT */
#include <string.h>

#include "emit/c_items.h"
#include "emit/emit.h"
#include "emit/headers.h"

struct standalone {
    struct dag *dag;
    struct emit_options options;
    const char *catalog; /* the text of catalog.h */
    struct table seen;   /* headers that were included */
    struct table read;   /* headers that were read: in texts */
    const char **texts;
    int text_count;
};

static void include(struct c_items *items, const char *name, void *context);

/* Takes the header in, once; 0: there is none of this name. */
static int include_once(struct standalone *s, struct c_items *items, const char *name)
{
    if (dag_put(&s->dag->arena, &s->seen, name, 1) >= 0)
        return 1;
    const char *text = s->catalog;
    if (strcmp(name, "catalog.h") != 0) {
        int known = dag_find(&s->read, name);
        if (known < 0) {
            known = s->text_count;
            s->texts = dag_grow(&s->dag->arena, s->texts, s->text_count, sizeof *s->texts);
            s->texts[s->text_count++] = dag_header_text(s->dag, name);
            dag_put(&s->dag->arena, &s->read, name, known);
        }
        text = s->texts[known];
    }
    if (text != NULL)
        dag_items_add(items, name, text, include, s);
    return text != NULL;
}

static void include(struct c_items *items, const char *name, void *context)
{
    struct standalone *s = context;
    if (!include_once(s, items, name))
        dag_error(s->dag, dag_nowhere, "no header \"%s\" for --standalone: name its folder with -I",
                  name);
}

/* The text in the arena; the buffer is freed. A text that was cut short must not go on. */
static const char *text_kept(struct dag *dag, struct text *text)
{
    if (text->failed) {
        dag_text_free(text);
        dag_out_of_memory(&dag->arena);
    }
    const char *copy = text->bytes == NULL ? "" : dag_copy(&dag->arena, text->bytes, text->length);
    dag_text_free(text);
    return copy;
}

static const char public_name[] = "<declarations>", private_name[] = "<functions>";

static void collect(struct standalone *s, struct c_items *items)
{
    struct dag *dag = s->dag;
    const unsigned char *reached = dag_emit_reached_tools(dag);
    struct text catalog = {0}, declarations = {0}, functions = {0};
    s->seen = (struct table){NULL, NULL, 0, 0};
    dag_emit_catalog_h(dag, &catalog, s->options.terms);
    s->catalog = text_kept(dag, &catalog);
    dag_emit_externs(dag, &declarations);
    for (int i = 0; i < dag->oracle_count; i++)
        dag_emit_oracle_h(dag, &declarations, &dag->oracles[i], &s->options);
    dag_emit_accessors(dag, &functions);
    dag_emit_callers(dag, &functions, reached);
    dag_emit_known_macro(dag, &functions, &s->options);
    for (int i = 0; i < dag->oracle_count; i++)
        dag_emit_oracle_c(dag, &functions, &dag->oracles[i], &s->options);

    include(items, dag->runtime_header, s);
    include(items, "catalog.h", s);
    include_once(s, items, "standalone.h"); /* a runtime need not have one */
    for (int i = 0; i < dag->tool_count; i++)
        if (reached[i])
            include(items, dag->tools[i].header, s);
    dag_items_add(items, public_name, text_kept(dag, &declarations), include, s);
    dag_items_add(items, private_name, text_kept(dag, &functions), include, s);
}

static void keep(struct c_items *items)
{
    dag_items_keep(items, private_name, C_PRIVATE);
    dag_items_keep(items, public_name, C_PUBLIC);
    dag_items_keep(items, "standalone.h", C_PUBLIC);
}

/* By term: does the text that is kept name it? The catalog says what a tool reads and writes of the
 * data manager, but its function may use more. */
static unsigned char *find_terms(struct dag *dag, const struct c_items *items)
{
    unsigned char *found = dag_alloc(&dag->arena, (size_t)dag->term_count);
    for (int i = 0; i < dag->term_count; i++)
        found[i] =
            dag_find(&items->members, dag->terms[i].name) >= 0
            || dag_find(&items->members, dag_format(&dag->arena, "%s_level", dag->terms[i].name))
                   >= 0;
    return found;
}

static void print_items(struct c_items *items, struct text *out, const char *prefix,
                        int public_part)
{
    for (int i = 0; i < items->item_count; i++) {
        struct c_item *item = &items->items[i];
        if (item->kept && !item->shown && ((item->reached_by & C_PUBLIC) != 0) == public_part)
            dag_items_print(items, item, out, prefix);
    }
}

static int is_prefix(const char *text)
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

void dag_emit_standalone(struct dag *dag, struct text *c, struct text *header,
                         const char *header_name, const struct emit_options *options)
{
    const char *prefix = options->prefix != NULL ? options->prefix : dag->oracles[0].name;
    struct standalone s = {0};
    struct c_items first = {0}, items = {0};
    if (!is_prefix(prefix)) {
        dag_error(dag, dag_nowhere, "'%s' cannot begin a C name", prefix);
        return;
    }
    s.dag = first.dag = items.dag = dag;
    s.options = *options;
    /* none: what is still named is needed */
    s.options.terms = dag_alloc(&dag->arena, (size_t)dag->term_count);
    collect(&s, &first);
    if (dag->error_count > 0)
        return;
    keep(&first);
    s.options.terms = find_terms(dag, &first);
    collect(&s, &items);
    keep(&items);

    dag_emit_banner(dag, header);
    dag_print(header, "#ifndef ");
    dag_print_upper(header, prefix);
    dag_print(header, "_H\n#define ");
    dag_print_upper(header, prefix);
    dag_print(header, "_H\n\n");
    for (int i = 0; i < items.system_count; i++)
        if (strcmp(items.system[i], "<math.h>") != 0)
            dag_print(header, "#include %s\n", items.system[i]);
    dag_print(header, "\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n");
    print_items(&items, header, prefix, 1);
    dag_print(header, "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n");

    dag_emit_banner(dag, c);
    dag_print(c, "#include \"%s\"\n\n#include <math.h>\n", header_name);
    print_items(&items, c, prefix, 0);
}
