/* export_xdmf.c - see export_xdmf.h.
 * SPDX-License-Identifier: MIT */
#include "output/export_xdmf.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output/hdf5_file.h"
#include "output/xml_text.h"
#include "util/atomic_file.h"
#include "util/beside.h"
#include "util/report.h"

/* XDMF's numbers for cells of a mesh of several kinds; a polygon's is followed by its corners'
 * number. */
enum { XDMF_POLYGON = 3, XDMF_TRIANGLE = 4, XDMF_QUAD = 5 };

struct xdmf {
    const struct solution *solution;
    const struct leaf_mesh *mesh;
    const struct vertex_values *values;
    uint32_t *leaf; /* [mesh->polygons]: elements */
    FILE *text;
    struct hdf5_file *file;
    const char *beside; /* its name, without folders */
    double *number;     /* [3 * the most of vertices and cells] */
    uint32_t *word;     /* [what the topology takes, or cells] */
};

/* A table of the .h5, and the text's word of it. Returns 0, or -1 after a message. */
static int put(struct xdmf *x, const char *name, enum hdf5_type type, uint32_t rows,
               uint32_t columns, const void *data)
{
    fprintf(x->text, "<DataItem Format=\"HDF\" %s Dimensions=\"%u",
            type == HDF5_WORDS ? "NumberType=\"UInt\" Precision=\"4\""
                               : "NumberType=\"Float\" Precision=\"8\"",
            (unsigned)rows);
    fprintf(x->text, columns > 1 ? " %u\">" : "\">", (unsigned)columns);
    xml_text_write(x->text, x->beside);
    fprintf(x->text, ":/%s</DataItem>\n", name);
    return hdf5_put(x->file, name, type, rows, columns, data, 0);
}

static int put_attribute(struct xdmf *x, const char *name, int of_cells, enum hdf5_type type,
                         const void *data)
{
    fprintf(x->text, "<Attribute Name=\"%s\" AttributeType=\"Scalar\" Center=\"%s\">\n", name,
            of_cells ? "Cell" : "Node");
    const int failed = put(x, name, type, of_cells ? x->mesh->polygons : x->values->count, 1, data);
    fprintf(x->text, "</Attribute>\n");
    return failed;
}

/* Every so manieth of values[], of each leaf or vertex. */
static int put_band(struct xdmf *x, const char *what, uint32_t band, int of_cells,
                    const double *values)
{
    char name[32];
    const uint32_t bands = x->solution->tree.bands,
                   count = of_cells ? x->mesh->polygons : x->values->count;
    for (uint32_t i = 0; i < count; i++)
        x->number[i] = values[(size_t)(of_cells ? x->leaf[i] : i) * bands + band];
    snprintf(name, sizeof name, "%s_%u", what, (unsigned)band);
    return put_attribute(x, name, of_cells, HDF5_NUMBERS, x->number);
}

static int put_geometry(struct xdmf *x)
{
    const struct leaf_mesh *m = x->mesh;
    uint32_t n = 0;
    for (uint32_t i = 0; i < x->values->count; i++)
        memcpy(&x->number[3 * (size_t)i], x->values->vertices[i].position, 3 * sizeof *x->number);
    fprintf(x->text, "<Geometry GeometryType=\"XYZ\">\n");
    if (put(x, "vertices", HDF5_NUMBERS, x->values->count, 3, x->number) < 0)
        return -1;
    for (uint32_t i = 0; i < m->polygons; i++) {
        const uint32_t corners = m->start[i + 1] - m->start[i];
        x->word[n++] = corners == 3 ? XDMF_TRIANGLE : corners == 4 ? XDMF_QUAD : XDMF_POLYGON;
        if (corners > 4)
            x->word[n++] = corners;
        memcpy(&x->word[n], &m->corner[m->start[i]], corners * sizeof *x->word);
        n += corners;
    }
    fprintf(x->text, "</Geometry>\n<Topology TopologyType=\"Mixed\" NumberOfElements=\"%u\">\n",
            (unsigned)m->polygons);
    const int failed = put(x, "cells", HDF5_WORDS, n, 1, x->word);
    fprintf(x->text, "</Topology>\n");
    return failed;
}

/* What cells are of. */
static int put_origin(struct xdmf *x)
{
    const struct solution *s = x->solution;
    for (uint32_t i = 0; i < x->mesh->polygons; i++) {
        const struct element *e = &s->tree.elements[x->leaf[i]];
        x->word[i] = s->surfaces.faces[e->face].input;
        x->number[i] = e->area;
    }
    if (put_attribute(x, "face", 1, HDF5_WORDS, x->word) < 0
        || put_attribute(x, "area", 1, HDF5_NUMBERS, x->number) < 0)
        return -1;
    return put_attribute(x, "material", 1, HDF5_WORDS, x->mesh->material);
}

static int put_all(struct xdmf *x, const double *error)
{
    const struct RadElements *tree = &x->solution->tree;
    int failed = 0;
    fprintf(x->text, "<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\">\n<Domain>\n"
                     "<Grid Name=\"leaves\" GridType=\"Uniform\">\n");
    failed = put_geometry(x) < 0 || put_origin(x) < 0;
    for (uint32_t k = 0; k < tree->bands && !failed; k++)
        failed = put_band(x, "radiosity", k, 0, x->values->value) < 0
                 || put_band(x, "radiosity_mean", k, 1, tree->radiosity) < 0
                 || put_band(x, "irradiance", k, 1, tree->irradiance) < 0
                 || (error && put_band(x, "error", k, 1, error) < 0);
    fprintf(x->text, "</Grid>\n</Domain>\n</Xdmf>\n");
    return failed ? -1 : 0;
}

/* Room for what is put at a time, and the elements that the mesh's polygons are. */
static int make_room(struct xdmf *x)
{
    const struct solution *s = x->solution;
    const size_t cells = x->mesh->polygons, vertices = x->values->count;
    uint32_t n = 0;
    x->leaf = malloc((cells + 1) * sizeof *x->leaf);
    x->number = malloc((3 * (cells > vertices ? cells : vertices) + 1) * sizeof *x->number);
    x->word = malloc((x->mesh->corners + 2 * cells + 1) * sizeof *x->word);
    if (!x->leaf || !x->number || !x->word)
        return -1;
    for (uint32_t i = 0; i < s->tree.count; i++)
        if (is_leaf(&s->tree.elements[i]))
            x->leaf[n++] = i;
    return 0;
}

int export_xdmf(const char *path, const struct solution *solution, const struct leaf_mesh *mesh,
                const struct vertex_values *values, const double *error)
{
    struct xdmf x = {.solution = solution, .mesh = mesh, .values = values};
    struct atomic_file text = {0};
    char *beside = path_with_ending(path, ".h5");
    int status = -1;
    if (!beside || make_room(&x) < 0) {
        report_error(path, 0, "out of memory for the mesh; use a coarser solution");
    } else if (atomic_open(&text, path) == 0) {
        x.beside = path_name(beside);
        x.text = text.stream;
        x.file = hdf5_create(beside, 0);
        if (x.file && put_all(&x, error) < 0)
            hdf5_discard(x.file);
        else if (x.file)
            status = hdf5_commit(x.file);
        if (status == 0)
            status = atomic_commit(&text);
        else
            atomic_discard(&text);
    }
    free(beside);
    free(x.leaf);
    free(x.number);
    free(x.word);
    return status;
}
