/* panel_page.c - see panel_page.h.
 *
 * The page, its style and its script are the files of solver/panel/, in which @@WORD@@ stands for
 * what differs between oracles: the drawing, and data as JSON in a <script> that no browser runs.
 * There every '<', '>' and '&' is a \u escape, which JSON allows in strings and needs nowhere else;
 * so no name or text of an oracle can end the element. [HTML, section 4.12.1.3]
 * SPDX-License-Identifier: MIT */
#include "output/panel_page.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/graph_svg.h"
#include "util/atomic_file.h"
#include "util/report.h"

/* The files, as the build turns them into C (embed.sh). */
extern const char panel_html[], panel_css[], page_js[], parameters_js[], result_js[], graph_js[];

struct page {
    const char *path;
    FILE *out;
    RadOracle oracle;
    const char *named;
    const json_t *statistics;
};

static const char *oracle_name(const struct page *p)
{
    struct RadOracleReport report;
    radGetOracleReport(p->oracle, &report);
    return report.name;
}

/* A name has letters, digits and '_': it is the same in HTML. */
static int write_title(const struct page *p)
{
    fputs(oracle_name(p), p->out);
    return 0;
}

static int write_style(const struct page *p)
{
    fputs(panel_css, p->out);
    return 0;
}

static int write_script(const struct page *p)
{
    const char *const files[] = {page_js, parameters_js, result_js, graph_js};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        fputs(files[i], p->out);
    return 0;
}

static int write_drawing(const struct page *p)
{
    return graph_svg_write(p->out, p->oracle, p->statistics);
}

static int write_data(const struct page *p)
{
    const char *graph = radGetOracleGraph(p->oracle);
    json_t *parsed = graph ? json_loads(graph, 0, NULL) : NULL;
    json_t *data =
        parsed ? json_pack("{s:s, s:s, s:o, s:O?}", "oracle", oracle_name(p), "given", p->named,
                           "graph", parsed, "statistics", (json_t *)(uintptr_t)p->statistics)
               : NULL;
    char *text = data ? json_dumps(data, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
    for (const char *at = text; at && *at; at++)
        if (strchr("<>&", *at))
            fprintf(p->out, "\\u%04x", (unsigned)*at);
        else
            putc(*at, p->out);
    json_decref(data);
    if (!text)
        return report_error(p->path, 0,
                            "the oracle's name or a text in it is not UTF-8, or out of "
                            "memory");
    free(text);
    return 0;
}

static const struct part {
    const char *word;
    int (*write)(const struct page *p);
} parts[] = {{"TITLE", write_title},     {"STYLE", write_style}, {"SCRIPT", write_script},
             {"DRAWING", write_drawing}, {"DATA", write_data},   {NULL, NULL}};

static const struct part *part_of(const char *word)
{
    const struct part *part = parts;
    while (part->word && strncmp(word, part->word, strlen(part->word)) != 0)
        part++;
    return part;
}

static int write_page(const struct page *p)
{
    const char *at = panel_html, *mark;
    while ((mark = strstr(at, "@@"))) {
        const struct part *part = part_of(mark + 2);
        fwrite(at, 1, (size_t)(mark - at), p->out);
        if (part->word && part->write(p) < 0)
            return -1;
        at = mark + 4 + (part->word ? strlen(part->word) : 0);
    }
    fputs(at, p->out);
    return 0;
}

int panel_page_write(const char *path, RadOracle oracle, const char *named,
                     const json_t *statistics)
{
    struct atomic_file file;
    if (atomic_open(&file, path) < 0)
        return -1;
    struct page page = {path, file.stream, oracle, named, statistics};
    if (write_page(&page) < 0) {
        atomic_discard(&file);
        return -1;
    }
    return atomic_commit(&file);
}
