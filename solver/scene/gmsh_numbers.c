/* gmsh_numbers.c - see gmsh_numbers.h.
 * SPDX-License-Identifier: MIT */
#include "scene/gmsh_numbers.h"

#include <stdio.h>
#include <string.h>

#include "scene/read_numbers.h"
#include "util/report.h"

int gmsh_need_line(struct gmsh_numbers *g, const char *what)
{
    if (g->bytes)
        return 0;
    while (next_line(&g->lines))
        if (next_word(&g->lines)) {
            g->lines.word_end = g->lines.word;
            return 0;
        }
    return report_error(g->mesh->path, g->lines.number,
                        "ends before %s; the file is cut, export it again", what);
}

int gmsh_bits(struct gmsh_numbers *g, const char *what, unsigned size, uint64_t *bits)
{
    struct text_lines *t = &g->lines;
    if ((size_t)(t->end - t->next) < size)
        return report_error(g->mesh->path, t->number,
                            "ends before %s; the file is cut, export it again", what);
    *bits = bytes_number(t->next, size, g->big_endian);
    t->next += size;
    return 0;
}

int gmsh_number(struct gmsh_numbers *g, const char *what, double *x)
{
    struct text_lines *t = &g->lines;
    uint64_t bits;
    if (!g->bytes) {
        if (!next_word(t))
            return report_error(g->mesh->path, t->number,
                                "the line ends before %s; the file is damaged, export it again",
                                what);
        return mesh_number(g->mesh, t, what, x);
    }
    if (gmsh_bits(g, what, 8, &bits))
        return -1;
    memcpy(x, &bits, sizeof *x);
    return is_finite_float(*x) ? 0
                               : report_error(g->mesh->path, t->number,
                                              "%s is not finite; write finite numbers", what);
}

static int take_whole_of(struct gmsh_numbers *g, const char *what, unsigned size, int64_t *i)
{
    double x;
    uint64_t bits;
    if (g->bytes) {
        if (gmsh_bits(g, what, size, &bits))
            return -1;
        *i = size == 4 ? (int32_t)(uint32_t)bits : (int64_t)bits;
        return 0;
    }
    if (gmsh_number(g, what, &x))
        return -1;
    if (!is_whole(fabs(x), 0x1p53))
        return report_error(g->mesh->path, g->lines.number,
                            "%g where %s belongs; the file is damaged, export it again", x, what);
    *i = (int64_t)x;
    return 0;
}

int gmsh_whole(struct gmsh_numbers *g, const char *what, int64_t *i)
{
    return take_whole_of(g, what, 4, i);
}

int gmsh_long(struct gmsh_numbers *g, const char *what, int64_t *i)
{
    return take_whole_of(g, what, g->version == 4 ? 8 : 4, i);
}

int gmsh_count(struct gmsh_numbers *g, const char *what, int64_t *i)
{
    if (gmsh_long(g, what, i))
        return -1;
    return *i < 0
               ? report_error(g->mesh->path, g->lines.number,
                              "%lld %s; the file is damaged, export it again", (long long)*i, what)
               : 0;
}

int gmsh_need_end(struct gmsh_numbers *g, const char *end)
{
    g->bytes = 0;
    if (gmsh_need_line(g, end))
        return -1;
    next_word(&g->lines);
    return word_is(&g->lines, end)
               ? 0
               : report_error(g->mesh->path, g->lines.number,
                              "'%.*s' where %s belongs: the counts do not fit what is there; the "
                              "file is damaged, export it again",
                              quoted_length(g->lines.word, g->lines.word_end), g->lines.word, end);
}
