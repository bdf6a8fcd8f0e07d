/* hdf5_file.h - tables in a file of HDF5, which appears whole or not at all.
 *
 * A table is a data set of rows by columns under a word. Of several processes all make these calls
 * together, on one file: what all have alike the first writes; where each has rows of its own, they
 * stand in the order of the processes, and each writes its own (parallel HDF5). Metadata are of the
 * latest format, which has checks on all of them; what data hold their readers check.
 *
 * Built without HDF5 (make HDF5=1) there is none: hdf5_built says so, and nothing else is called.
 * SPDX-License-Identifier: MIT */
#ifndef HDF5_FILE_H
#define HDF5_FILE_H

#include <stdint.h>
#include "radiosity.h"

/* What items are: as in a state. */
enum hdf5_type {
    HDF5_LONGS = RAD_STATE_OF_LONGS,
    HDF5_WORDS = RAD_STATE_OF_WORDS,
    HDF5_NUMBERS = RAD_STATE_OF_NUMBERS,
    HDF5_LINKS = RAD_STATE_OF_LINKS
};

struct hdf5_file;

int hdf5_built(void);

/* Beside `path`, whose file stays until hdf5_commit. Of several processes with `together` all write
 * it. Each returns NULL or -1 after a message, on all of them. */
struct hdf5_file *hdf5_create(const char *path, int together);
int hdf5_put(struct hdf5_file *file, const char *name, enum hdf5_type type, uint64_t rows,
             uint64_t columns, const void *data, int own_rows);
int hdf5_put_number(struct hdf5_file *file, const char *name, double value);
int hdf5_put_text(struct hdf5_file *file, const char *name, const char *text);
/* It gets its name. Frees it in any case, as hdf5_discard does. */
int hdf5_commit(struct hdf5_file *file);
void hdf5_discard(struct hdf5_file *file);

/* To be read, by each process for itself. NULL, with *cause: there is no such file, or no good one.
 */
struct hdf5_file *hdf5_open(const char *path, const char **cause);
/* Returns 0, or -1: there is none of that type and at most two dimensions. */
int hdf5_size(struct hdf5_file *file, const char *name, enum hdf5_type type, uint64_t *rows,
              uint64_t *columns);
/* `count` rows from row `first` on. Returns 0, or -1. */
int hdf5_get(struct hdf5_file *file, const char *name, enum hdf5_type type, uint64_t first,
             uint64_t count, uint64_t columns, void *data);
int hdf5_get_number(struct hdf5_file *file, const char *name, double *value);
/* Is the attribute this text? */
int hdf5_has_text(struct hdf5_file *file, const char *name, const char *text);
void hdf5_close(struct hdf5_file *file);

#endif
