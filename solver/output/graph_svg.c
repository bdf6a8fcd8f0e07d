/* graph_svg.c - see graph_svg.h.
 *
 * All colours stand in one <style>, for light and for dark, so that a page may hold the drawing and
 * change them. Nothing is told by colour alone: what a node may do is in its outline, an arc's kind
 * in its line, heat and what is dead in words on hovering.
 * SPDX-License-Identifier: MIT */
#include "output/graph_svg.h"

#include <math.h>
#include <string.h>

#include "output/graph_drawing.h"
#include "output/xml_text.h"
#include "util/report.h"

static const double MARGIN = 16, HEAD = 30, SAID = 15, LEGEND = 118;

static void put_title(FILE *out, const char *text)
{
    fputs("<title>", out);
    xml_text_write(out, text);
    fputs("</title>", out);
}

/* ---- colours */

/* Heat from 0 to 6, fill and letters: lightness falls evenly, on dark ground it rises; letters have
 * a contrast of 4.5 or more on their fill (WCAG 2.1, 1.4.3). */
static const struct {
    const char *fill, *ink, *dark_fill, *dark_ink;
} heats[DRAWING_HEATS] = {
    {"#fffdf5", "#222222", "#23252b", "#e8e8e8"}, {"#fff3d0", "#222222", "#3a2f22", "#f0f0f0"},
    {"#fee3a2", "#222222", "#553a1a", "#f4f4f4"}, {"#fdc46b", "#222222", "#7a4510", "#ffffff"},
    {"#fb9a4b", "#222222", "#a6500a", "#ffffff"}, {"#c83a1e", "#ffffff", "#ff9d4d", "#1b1b1b"},
    {"#8c0d25", "#ffffff", "#ffd98a", "#1b1b1b"}};

static void put_rules(FILE *out, int dark)
{
    const char *ink = dark ? "#e8e8e8" : "#222222", *line = dark ? "#9db4d8" : "#334466",
               *grey = dark ? "#7d828c" : "#9a9a9a", *soft = dark ? "#b4b8c0" : "#555555";
    fprintf(out,
            ".graph .ground{fill:%s}.graph text{fill:%s}.graph .soft{fill:%s}"
            ".graph .node .shape{fill:%s;stroke:%s}.graph .arc path{stroke:%s}"
            ".graph .arc polygon{fill:%s}.graph .arc text{fill:%s}"
            ".graph .branch rect{fill:%s;stroke:%s}.graph .leaf rect{stroke:%s}",
            dark ? "#16181d" : "#ffffff", ink, soft, dark ? "#23252b" : "#ffffff", line, line, line,
            dark ? "#c3cfe4" : "#334466", dark ? "#1c1f26" : "#f7f8fb", grey, grey);
    fprintf(out,
            ".graph .leaf.links rect{fill:%s}.graph .leaf.subdivides rect{fill:%s}"
            ".graph .leaf.stops rect{fill:%s}",
            dark ? "#1f4a2a" : "#cfe8cf", dark ? "#5c4013" : "#f6d9b0",
            dark ? "#3a3d44" : "#e4e4e4");
    for (int i = 0; i < DRAWING_HEATS; i++)
        fprintf(out, ".graph .heat%d .shape{fill:%s}.graph .heat%d text{fill:%s}", i,
                dark ? heats[i].dark_fill : heats[i].fill, i,
                dark ? heats[i].dark_ink : heats[i].ink);
    fprintf(out,
            ".graph .unused .shape{fill:none;stroke:%s;stroke-dasharray:4 3}"
            ".graph .unused text,.graph .dead text{fill:%s}.graph .leaf.unused "
            "rect{fill:none;stroke-dasharray:4 3}"
            ".graph .dead path{stroke:%s}.graph .dead polygon{fill:%s}\n",
            grey, dark ? "#9aa0aa" : "#757575", grey, grey);
}

static void put_style(FILE *out)
{
    fputs("<style>\n.graph{font-family:Helvetica,Arial,sans-serif;font-size:9px}"
          ".graph .name{font-size:12px;font-weight:bold}.graph .head{font-size:16px;font-weight:"
          "bold}.graph .said{font-size:11px}"
          ".graph .arc path{fill:none}.graph .approximate path{stroke-dasharray:6 3}"
          ".graph .other path{stroke-dasharray:1.5 3}.graph .command path{stroke-dasharray:none}"
          ".graph .guards .shape{stroke-width:2.5}.graph .inner{fill:none!important}\n",
          out);
    put_rules(out, 0);
    fputs("@media (prefers-color-scheme:dark){\n", out);
    put_rules(out, 1);
    fputs("}\n</style>\n", out);
}

/* ---- shapes */

/* The outline says the class: round corners ask, cut corners may compute a term, a double line
 * commands. */
static void put_outline(FILE *out, const char *class, double x, double y, double width,
                        double height)
{
    const double left = x - width / 2, top = y - height / 2, right = x + width / 2,
                 bottom = y + height / 2, cut = 8;
    if (strcmp(class, "term") == 0) {
        fprintf(out,
                "<polygon class=\"shape\" points=\"%.1f,%.1f %.1f,%.1f %.1f,%.1f %.1f,%.1f "
                "%.1f,%.1f %.1f,%.1f %.1f,%.1f %.1f,%.1f\"/>",
                left + cut, top, right - cut, top, right, top + cut, right, bottom - cut,
                right - cut, bottom, left + cut, bottom, left, bottom - cut, left, top + cut);
        return;
    }
    int command = strcmp(class, "command") == 0;
    fprintf(out,
            "<rect class=\"shape\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" "
            "rx=\"%d\"/>",
            left, top, width, height, command ? 0 : 10);
    if (command)
        fprintf(out,
                "<rect class=\"shape inner\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" "
                "height=\"%.1f\"/>",
                left + 3, top + 3, width - 6, height - 6);
}

static void put_line(FILE *out, const char *class, const char *anchor, double x, double y,
                     const char *text)
{
    fprintf(out, "<text class=\"%s\" text-anchor=\"%s\" x=\"%.1f\" y=\"%.1f\">", class, anchor, x,
            y);
    xml_text_write(out, text);
    fputs("</text>", out);
}

static void put_node(FILE *out, const struct drawing_node *n)
{
    fprintf(out, "<g class=\"node %s", n->class);
    fputs(n->guards ? " guards" : "", out);
    if (n->unused)
        fputs(" unused", out);
    else if (n->heat >= 0)
        fprintf(out, " heat%d", n->heat);
    fprintf(out, "\" id=\"node-%s\" data-node=\"%s\">", n->name, n->name);
    put_title(out, n->title);
    put_outline(out, n->class, n->x, n->y, n->width, n->height);
    double y = n->y - n->height / 2 + 5 + DRAWING_NAME;
    put_line(out, "name", "middle", n->x, y, n->lines[0]);
    for (int i = 1; i < n->line_count; i++)
        put_line(out, "said-of", "middle", n->x, y += 1.3 * DRAWING_SMALL, n->lines[i]);
    fputs("</g>\n", out);
}

static void put_leaf(FILE *out, const struct drawing *p, const struct drawing_leaf *l)
{
    fprintf(out, "<g class=\"leaf %s %s%s\" id=\"leaf-%s-%s\">", l->class, l->decision,
            l->unused && p->summary ? " unused" : "", p->nodes[l->node].name, l->decision);
    put_title(out, l->title);
    fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" rx=\"6\"/>",
            l->x - l->width / 2, l->y - l->height / 2, l->width, l->height);
    put_line(out, "decision", "middle", l->x, l->y + 0.35 * DRAWING_SMALL, l->decision);
    fputs("</g>\n", out);
}

/* Area by count would drown the rest in the first arcs: width goes by the root. */
static double width_of(double share)
{
    return share < 0 ? 1 : 0.7 + 7 * sqrt(share);
}

static void put_arrow(FILE *out, const double from[2], const double tip[2], double width)
{
    double x = tip[0] - from[0], y = tip[1] - from[1], length = hypot(x, y);
    double half = (3 + width / 2) / (length > 0 ? length : 1);
    fprintf(out, "<polygon points=\"%.1f,%.1f %.1f,%.1f %.1f,%.1f\"/>", tip[0], tip[1],
            from[0] - y * half, from[1] + x * half, from[0] + y * half, from[1] - x * half);
}

static void put_arc(FILE *out, const struct drawing *p, const struct drawing_arc *a)
{
    const double width = a->dead ? 0.7 : width_of(a->share);
    fprintf(out, "<g class=\"arc %s%s\" id=\"arc-%s-%s\" data-from=\"node-%s\"", a->kind,
            a->dead ? " dead" : "", p->nodes[a->from].name, a->answer, p->nodes[a->from].name);
    if (a->leaf >= 0)
        fprintf(out, " data-to=\"leaf-%s-%s\">", p->nodes[p->leaves[a->leaf].node].name,
                p->leaves[a->leaf].decision);
    else
        fprintf(out, " data-to=\"node-%s\">", p->nodes[a->node].name);
    put_title(out, a->title);
    fprintf(out, "<path stroke-width=\"%.2f\" d=\"M%.1f,%.1f", width, a->points[0], a->points[1]);
    for (size_t i = 1; i < a->point_count; i++)
        fprintf(out, "%s%.1f,%.1f", i % 3 == 1 ? "C" : " ", a->points[2 * i], a->points[2 * i + 1]);
    fputs("\"/>", out);
    put_arrow(out, a->points + 2 * (a->point_count - 1), a->tip, width);
    double y = a->y - 0.65 * DRAWING_SMALL * a->line_count + 0.95 * DRAWING_SMALL;
    for (int i = 0; i < a->line_count; i++, y += 1.3 * DRAWING_SMALL)
        put_line(out, "answer", "middle", a->x, y, a->lines[i]);
    fputs("</g>\n", out);
}

static void put_branch(FILE *out, const struct drawing_branch *b)
{
    fprintf(out, "<g class=\"branch\" id=\"branch-%s\">", b->name);
    put_title(out, b->title);
    fprintf(out, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" rx=\"4\"/>", b->left,
            b->top, b->right - b->left, b->bottom - b->top);
    put_line(out, "soft", "start", b->label_x, b->label_y + 0.35 * DRAWING_SMALL, b->label);
    fputs("</g>\n", out);
}

/* ---- the legend: four columns below the graph */

static void put_nodes_legend(FILE *out, double x, double y)
{
    static const char *const rows[][2] = {{"question", "asks"},
                                          {"term", "asks, may compute a term"},
                                          {"command", "commands"},
                                          {"question guards", "heavy: guards subdivision"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++, y += 20) {
        fprintf(out, "<g class=\"node %s\">", rows[i][0]);
        put_outline(out, rows[i][0], x + 14, y, 28, 14);
        fputs("</g>", out);
        put_line(out, "said", "start", x + 36, y + 4, rows[i][1]);
    }
}

static void put_arcs_legend(FILE *out, double x, double y, int counted)
{
    static const char *const rows[][2] = {{"precise", "precise answer"},
                                          {"approximate", "approximate answer"},
                                          {"other", "other answer"},
                                          {"precise dead", "grey: never given"}};
    for (size_t i = 0; i < (counted ? 4 : 3); i++, y += 20) {
        fprintf(out,
                "<g class=\"arc %s\"><path stroke-width=\"1.4\" d=\"M%.1f,%.1fL%.1f,%.1f\"/></g>",
                rows[i][0], x, y, x + 30, y);
        put_line(out, "said", "start", x + 36, y + 4, rows[i][1]);
    }
    if (counted)
        put_line(out, "said", "start", x, y + 4, "width: share of discussions");
}

static void put_leaves_legend(FILE *out, double x, double y)
{
    static const char *const rows[][2] = {
        {"links", "links"}, {"subdivides", "subdivides"}, {"stops", "stops"}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++, y += 20) {
        fprintf(out,
                "<g class=\"leaf %s\"><rect x=\"%.1f\" y=\"%.1f\" width=\"28\" height=\"13\" "
                "rx=\"6\"/></g>",
                rows[i][0], x, y - 7);
        put_line(out, "said", "start", x + 36, y + 4, rows[i][1]);
    }
    fprintf(out,
            "<g class=\"branch\"><rect x=\"%.1f\" y=\"%.1f\" width=\"28\" height=\"13\" "
            "rx=\"4\"/></g>",
            x, y - 7);
    put_line(out, "said", "start", x + 36, y + 4, "a branch, reused");
}

static void put_heat_legend(FILE *out, double x, double y)
{
    static const char *const from[DRAWING_HEATS] = {"0", ".1", ".3", "1", "3", "10", "30"};
    put_line(out, "said", "start", x, y + 4, "colour: share of the time, from (%)");
    for (int i = 0; i < DRAWING_HEATS; i++) {
        fprintf(out,
                "<g class=\"node heat%d\"><rect class=\"shape\" x=\"%.1f\" y=\"%.1f\" "
                "width=\"26\" height=\"18\"/>",
                i, x + 27 * i, y + 14);
        put_line(out, "said", "middle", x + 27 * i + 13, y + 27, from[i]);
        fputs("</g>", out);
    }
    fprintf(out, "<g class=\"node question unused\">");
    put_outline(out, "question", x + 14, y + 46, 28, 14);
    fputs("</g>", out);
    put_line(out, "said", "start", x + 36, y + 50, "grey: never asked");
}

static void put_legend(FILE *out, double y, int counted)
{
    fputs("<g class=\"legend\">\n", out);
    put_nodes_legend(out, 0, y);
    put_arcs_legend(out, 190, y, counted);
    put_leaves_legend(out, 350, y);
    if (counted)
        put_heat_legend(out, 480, y);
    fputs("</g>\n", out);
}

/* ---- the whole */

/* A text in lines as wide as that, from `y` down; out NULL: none is written. Returns the line
 * behind the last. */
static double put_wrapped(FILE *out, const char *class, double width, double y, const char *text)
{
    const size_t letters = (size_t)(width / drawing_text_width("x", 11));
    char line[512];
    while (*text) {
        size_t length = strlen(text), most = letters < sizeof line ? letters : sizeof line - 1;
        if (length > most) {
            for (length = most; length > 0 && text[length] != ' ';)
                length--;
            length = length ? length : most;
            while ((text[length] & 0xc0) == 0x80) /* within a letter of UTF-8 */
                length--;
        }
        memcpy(line, text, length);
        line[length] = 0;
        if (out)
            put_line(out, class, "start", MARGIN, y, line);
        y += SAID;
        text += length + (text[length] == ' ');
    }
    return y;
}

static double put_head(FILE *out, const struct drawing *p, double width)
{
    double y = MARGIN + HEAD + 3;
    y = put_wrapped(out, "said", width, y, p->doc);
    return p->summary ? put_wrapped(out, "said soft", width, y, p->summary) : y;
}

static void put_drawing(FILE *out, const struct drawing *p)
{
    const double inside = fmax(p->width, p->summary ? 690 : 480), width = inside + 2 * MARGIN,
                 top = put_head(NULL, p, inside), height = top + p->height + LEGEND + MARGIN;
    fprintf(out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"graph\" role=\"img\" "
            "aria-labelledby=\"graph-title graph-doc\" width=\"%.0f\" height=\"%.0f\" "
            "viewBox=\"0 0 %.0f %.0f\">\n<title id=\"graph-title\">",
            width, height, width, height);
    xml_text_write(out, p->oracle);
    fputs("</title>\n<desc id=\"graph-doc\">", out);
    xml_text_write(out, p->doc);
    fputs("</desc>\n", out);
    put_style(out);
    fprintf(out, "<rect class=\"ground\" width=\"%.0f\" height=\"%.0f\"/>\n", width, height);
    put_line(out, "head", "start", MARGIN, MARGIN + 16, p->oracle);
    (void)put_head(out, p, inside);
    fprintf(out, "\n<g transform=\"translate(%.1f,%.1f)\">\n", MARGIN, top);
    for (size_t i = 0; i < p->branch_count; i++)
        put_branch(out, &p->branches[i]);
    for (size_t i = 0; i < p->arc_count; i++)
        put_arc(out, p, &p->arcs[i]);
    for (size_t i = 0; i < p->leaf_count; i++)
        put_leaf(out, p, &p->leaves[i]);
    for (size_t i = 0; i < p->node_count; i++)
        put_node(out, &p->nodes[i]);
    put_legend(out, p->height + 34, p->summary != NULL);
    fputs("</g>\n</svg>\n", out);
}

int graph_svg_write(FILE *out, RadOracle oracle, const json_t *statistics)
{
    struct RadOracleReport report;
    radGetOracleReport(oracle, &report);
    const char *text = radGetOracleGraph(oracle);
    json_t *graph = text ? json_loads(text, 0, NULL) : NULL;
    if (!text)
        return report_error(report.name, 0, "out of memory for its drawing");
    if (!graph)
        return report_error(report.name, 0,
                            "its texts are not UTF-8; save the .dag file in that encoding");
    struct drawing drawing;
    int status = drawing_open(&drawing, graph, report.name, statistics);
    if (status == 0)
        status = drawing_place(&drawing);
    if (status == 0)
        put_drawing(out, &drawing);
    drawing_close(&drawing);
    json_decref(graph);
    return status;
}
