/* vtk_arrays.h - arrays of VTK's XML files: numbers as words, as base64 in their place, or appended
 * behind all elements, as base64 or as bytes; plain or compressed by zlib.
 *
 * Before bytes is their length. Compressed ones stand in blocks, before which are their number,
 * their size, the last one's (0: as the others) and what each takes. [VTK file formats, XML File
 * Formats]
 * SPDX-License-Identifier: MIT */
#ifndef VTK_ARRAYS_H
#define VTK_ARRAYS_H

#include <stddef.h>
#include <stdint.h>

struct vtk_values {
    double *at;
    size_t count, capacity;
    uint32_t line; /* where they begin; 0: not there */
};

enum vtk_form { VTK_WORDS, VTK_BASE64, VTK_APPENDED };

struct vtk_arrays {
    const char *path;
    int big_endian, compressed;
    unsigned header;      /* bytes of a length */
    const char *appended; /* what is behind the _; NULL: nothing is appended */
    size_t appended_size;
    int appended_base64;
    /* the array under way */
    enum vtk_form form;
    double offset; /* of `appended` */
    char type[16];
    char *text; /* characters, which become bytes */
    size_t size, capacity;
};

/* Where in the text what is appended begins and ends, which is no XML; its end both where there is
 * none. Returns 0, or -1 after a message. */
int vtk_arrays_appended(struct vtk_arrays *a, const char *text, size_t size, size_t *from,
                        size_t *to);

/* All return 0, or -1 after a message. */
int vtk_array_add_text(struct vtk_arrays *a, const char *text, size_t size);
/* The array under way, which begins on v->line. */
int vtk_array_read(struct vtk_arrays *a, struct vtk_values *v);
void vtk_arrays_free(struct vtk_arrays *a);

#endif
