/* arena.c - memory of one compilation, and the tables of names that live in it.
 *
 * Blocks are chained and freed together. Lists double in place of the old copy, which stays in
 * the arena: at most as much again is wasted. When malloc fails, control returns to dag_protect,
 * so no pass ever sees a null pointer. After Lua's protected calls.
 * SPDX-License-Identifier: MIT */
#include <locale.h>
#include <stdlib.h>
#include <string.h>

#include "base/internal.h"

struct block {
    struct block *next;
    size_t used, size;
    max_align_t bytes[];
};

enum { BLOCK_SIZE = 32 * 1024 };

void dag_out_of_memory(struct arena *arena)
{
    longjmp(arena->protector->jump, 1);
}

void *dag_alloc(struct arena *arena, size_t size)
{
    size_t unit = sizeof(max_align_t);
    size_t need = (size + unit - 1) / unit * unit;
    struct block *block = arena->blocks;
    if (block == NULL || block->size - block->used < need) {
        size_t room = need > BLOCK_SIZE ? need : BLOCK_SIZE;
        block = malloc(sizeof *block + room);
        if (block == NULL)
            dag_out_of_memory(arena);
        block->used = 0;
        block->size = room;
        block->next = arena->blocks;
        arena->blocks = block;
    }
    void *result = (char *)block->bytes + block->used;
    block->used += need;
    return memset(result, 0, size);
}

/* Room for one more item, zeroed. A list's capacity needs no field: it is the power of two, 8 or
 * more, that its count has not yet passed. */
void *dag_grow(struct arena *arena, void *items, int count, size_t size)
{
    if (count != 0 && (count < 8 || (count & (count - 1)) != 0))
        return items;
    size_t capacity = count == 0 ? 8 : (size_t)count * 2;
    void *grown = dag_alloc(arena, capacity * size);
    if (count != 0)
        memcpy(grown, items, (size_t)count * size);
    return grown;
}

const char *dag_copy(struct arena *arena, const char *text, size_t length)
{
    char *copy = dag_alloc(arena, length + 1);
    memcpy(copy, text, length);
    return copy;
}

const char *dag_vformat(struct arena *arena, const char *format, va_list arguments)
{
    va_list again;
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    char *text = NULL;
    if (length >= 0) {
        text = dag_alloc(arena, (size_t)length + 1);
        vsnprintf(text, (size_t)length + 1, format, again);
    }
    va_end(again);
    return text != NULL ? text : "";
}

const char *dag_format(struct arena *arena, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    const char *text = dag_vformat(arena, format, arguments);
    va_end(arguments);
    return text;
}

int dag_protect(struct dag *dag, void (*body)(struct dag *dag, void *context), void *context)
{
    locale_t plain = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (plain == (locale_t)0)
        return -1;
    locale_t before = uselocale(plain);
    struct protector protector;
    dag->arena.protector = &protector;
    volatile int result = -1;
    if (setjmp(protector.jump) == 0) {
        body(dag, context);
        result = 0;
    }
    dag->arena.protector = NULL;
    uselocale(before);
    freelocale(plain);
    return result;
}

/* A list that nothing was added to points here, not to NULL: C does not let `&list[0]` be taken of
 * NULL, and an empty span asks for just that. Nothing is read or written through it. */
static max_align_t nothing;

struct dag *dag_new(void)
{
    struct dag *dag = calloc(1, sizeof *dag);
    if (dag == NULL)
        return NULL;
    void *none = &nothing;
    dag->units = none, dag->types = none, dag->levels = none, dag->terms = none, dag->needs = none;
    dag->answers = none, dag->tools = none, dag->decisions = none, dag->facts = none;
    dag->callbacks = none, dag->parameters = none, dag->expressions = none;
    dag->arguments = none, dag->labels = none, dag->rules = none, dag->arcs = none;
    dag->drafts = none, dag->nodes = none, dag->uses = none, dag->order = none;
    dag->oracles = none, dag->branches = none, dag->sources = none, dag->imports = none;
    dag->diagnostics = none;
    dag->use = -1;
    dag->verb = "refine";
    dag->verb_where.source = -1;
    return dag;
}

void dag_arena_free(struct arena *arena)
{
    struct block *block = arena->blocks;
    while (block != NULL) {
        struct block *next = block->next;
        free(block);
        block = next;
    }
    arena->blocks = NULL;
}

void dag_free(struct dag *dag)
{
    if (dag == NULL)
        return;
    dag_arena_free(&dag->arena);
    free(dag->opened);
    free(dag->reading);
    free(dag);
}

/* ---- tables */

static uint32_t hash(const char *name)
{
    uint32_t value = 2166136261u;
    for (; *name != '\0'; name++)
        value = (value ^ (unsigned char)*name) * 16777619u;
    return value;
}

/* The slot of the name, or the empty one where it belongs. Capacity is a power of two. */
static int slot_of(const struct table *table, const char *name)
{
    uint32_t mask = (uint32_t)table->capacity - 1;
    uint32_t slot = hash(name) & mask;
    while (table->keys[slot] != NULL && strcmp(table->keys[slot], name) != 0)
        slot = (slot + 1) & mask;
    return (int)slot;
}

int dag_find(const struct table *table, const char *name)
{
    if (table->capacity == 0)
        return -1;
    int slot = slot_of(table, name);
    return table->keys[slot] == NULL ? -1 : table->values[slot];
}

int dag_put(struct arena *arena, struct table *table, const char *name, int value)
{
    if (table->count * 2 >= table->capacity) {
        struct table grown = {NULL, NULL, table->capacity == 0 ? 16 : table->capacity * 2,
                              table->count};
        grown.keys = dag_alloc(arena, (size_t)grown.capacity * sizeof *grown.keys);
        grown.values = dag_alloc(arena, (size_t)grown.capacity * sizeof *grown.values);
        for (int i = 0; i < table->capacity; i++)
            if (table->keys[i] != NULL) {
                int slot = slot_of(&grown, table->keys[i]);
                grown.keys[slot] = table->keys[i];
                grown.values[slot] = table->values[i];
            }
        *table = grown;
    }
    int slot = slot_of(table, name);
    if (table->keys[slot] != NULL)
        return table->values[slot];
    table->keys[slot] = name;
    table->values[slot] = value;
    table->count++;
    return -1;
}
