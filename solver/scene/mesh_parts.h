/* mesh_parts.h - what mesh formats have in common: nodes with numbers of their own, groups of faces
 * with names, elements that are no faces.
 *
 * A node may be used before it is defined; mesh_finish names the first that never was. Faces of one
 * group have one material, whose name is the group's; such formats know no reflectance, so it is
 * GREY unless the reader says another.
 * SPDX-License-Identifier: MIT */
#ifndef MESH_PARTS_H
#define MESH_PARTS_H

#include "scene/scene_file.h"
#include "scene/text_lines.h"

/* Whole numbers to indices, a table searched from the number's hash on. */
struct numbered {
    struct numbered_entry {
        int64_t number;
        uint32_t value; /* UINT32_MAX: none */
    } * entry;
    size_t count, slots; /* slots: 0 or a power of two */
};

uint32_t numbered_find(const struct numbered *n, int64_t number); /* UINT32_MAX: not there */
/* The number must not be there yet. Returns 0, or -1 when out of memory. */
int numbered_add(struct numbered *n, int64_t number, uint32_t value);

static const double MESH_GREY = .5;

/* How many there are of what is passed over, and the line of the first. */
struct mesh_note {
    uint32_t count, first;
};

struct mesh {
    struct scene_file *file;
    const char *path;
    struct numbered nodes;     /* to positions, NaN while a node is used and not defined */
    struct numbered materials; /* hashes of names and reflectances to materials */
    struct mesh_note volumes;  /* elements that fill space */
    struct mesh_note curved;   /* faces with nodes beside their corners */
};

/* All return 0, or -1 after a message with the line. */
int mesh_define_node(struct mesh *m, int64_t number, const double position[3], uint32_t line);
/* A further corner of the polygon to come. */
int mesh_corner(struct mesh *m, int64_t number);
int mesh_polygon(struct mesh *m, uint32_t size, uint32_t material, uint32_t line);
/* The material of this name and reflectance, made when there is none. */
int mesh_material(struct mesh *m, const char *name, size_t length, double reflectance,
                  uint32_t *material);
void mesh_note(struct mesh_note *n, uint32_t line);
/* The word at hand, which must be a finite number: `what` belongs there. */
int mesh_number(const struct mesh *m, const struct text_lines *t, const char *what, double *x);
/* Says that the word at hand is none of what belongs there; -1. */
int mesh_unexpected(const struct mesh *m, const struct text_lines *t, const char *what);

/* At the file's end: are all nodes there, is there a face? Tells of volumes and of what may be
 * curved unless `quiet`. */
int mesh_finish(struct mesh *m, int quiet);
void mesh_free(struct mesh *m);

#endif
