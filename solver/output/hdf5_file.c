/* hdf5_file.c - see hdf5_file.h.
 * SPDX-License-Identifier: MIT */
#include "output/hdf5_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "util/machines.h"
#include "util/report.h"
#include "util/temporary.h"

#ifdef RADIOSITY_HDF5

#include <hdf5.h>

struct hdf5_file {
    char *path, *target, *temporary; /* target: what path leads to; NULL: it is read */
    hid_t id;                        /* negative: it is closed */
    int together, named;             /* named: whoever is stopped by a signal removes it */
};

int hdf5_built(void)
{
    return 1;
}

/* What fails is told here, and what could not be written is not tried again at exit. */
static void be_quiet(void)
{
    H5dont_atexit();
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
}

/* ---- writing */

void hdf5_discard(struct hdf5_file *f)
{
    if (!f)
        return;
    /* the file of HDF5 stays open: to close it is to write what could not be written, which 1.10
     * does not survive, nor when it does so itself as MPI ends */
    if (f->id >= 0)
        machines_leave_open();
    if (f->named) {
        temporary_lock();
        unlink(f->temporary);
        temporary_forget(f->temporary);
        temporary_unlock();
    }
    free(f->path);
    free(f->target);
    free(f->temporary);
    free(f);
}

/* The innermost of HDF5's errors. */
static herr_t take_cause(unsigned n, const H5E_error2_t *error, void *text)
{
    if (n == 0 && error->desc)
        snprintf(text, 160, "%s", error->desc);
    return 0;
}

static int agree(const struct hdf5_file *f, int failed)
{
    return f->together ? machines_agree(failed) : failed;
}

/* Has any failed? Then all tell, of whom machines.h lets one be heard. Returns 0 or -1. */
static int all_did(const struct hdf5_file *f, int failed, int cause)
{
    char text[160] = "another process could not write it";
    if (failed && cause)
        snprintf(text, sizeof text, "%s", strerror(cause));
    else if (failed)
        snprintf(text, sizeof text, "HDF5 could not");
    if (failed && !cause)
        H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_cause, text);
    if (!agree(f, failed != 0))
        return 0;
    return report_error(f->path, 0, "cannot write: %s; free some space or write elsewhere", text);
}

/* How the file is reached: by this process, or by all together. */
static hid_t access_of(const struct hdf5_file *f)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_libver_bounds(access, H5F_LIBVER_LATEST, H5F_LIBVER_LATEST);
#if defined RADIOSITY_MPI && defined H5_HAVE_PARALLEL
    if (f->together && machines_count() > 1)
        H5Pset_fapl_mpio(access, MPI_COMM_WORLD, MPI_INFO_NULL);
#endif
    (void)f;
    return access;
}

struct hdf5_file *hdf5_create(const char *path, int together)
{
    struct hdf5_file *f = calloc(1, sizeof *f);
    struct stat status;
    uint64_t own = 0, process = (uint64_t)getpid();
    if (together) /* all write one file, of the first one's name */
        machines_place(machines_number() == 0 ? process : 0, &own, &process);
    be_quiet();
    if (f) {
        *f = (struct hdf5_file){.path = strdup(path), .id = -1, .together = together};
        f->target = stat(path, &status) == 0 ? realpath(path, NULL) : strdup(path);
        f->temporary = f->target ? malloc(strlen(f->target) + 40) : NULL;
    }
    if (!f || !f->path || !f->temporary) {
        report_error(path, 0, "cannot write: %s; choose a place where you may write",
                     strerror(errno));
        hdf5_discard(f);
        return NULL;
    }
    sprintf(f->temporary, "%s.%llu.tmp", f->target, (unsigned long long)process);
    int failed = 0;
    errno = 0;
    if (!together || machines_number() == 0) {
        temporary_lock();
        const int made = open(f->temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        failed = made < 0;
        if (!failed) {
            f->named = 1;
            temporary_add(f->temporary);
            close(made);
        }
        temporary_unlock();
    }
    const int cause = failed ? errno : 0;
    if (all_did(f, failed, cause) < 0) {
        hdf5_discard(f);
        return NULL;
    }
    /* or else those that do not find it would be waited for */
    if (agree(f, access(f->temporary, R_OK | W_OK) < 0)) {
        report_error(path, 0,
                     "cannot write: not all processes find it there; name a file in a folder that "
                     "all machines share");
        hdf5_discard(f);
        return NULL;
    }
    const hid_t reached = access_of(f);
    f->id = H5Fcreate(f->temporary, H5F_ACC_TRUNC, H5P_DEFAULT, reached);
    H5Pclose(reached);
    if (all_did(f, f->id < 0, 0) < 0) {
        hdf5_discard(f);
        return NULL;
    }
    return f;
}

/* In a file, and in memory: struct RadLink has no gaps, and both are this machine's. */
static hid_t type_of(enum hdf5_type type)
{
    if (type != HDF5_LINKS)
        return H5Tcopy(type == HDF5_LONGS   ? H5T_NATIVE_UINT64
                       : type == HDF5_WORDS ? H5T_NATIVE_UINT32
                                            : H5T_NATIVE_DOUBLE);
    const hid_t link = H5Tcreate(H5T_COMPOUND, sizeof(struct RadLink));
    H5Tinsert(link, "receiver", HOFFSET(struct RadLink, receiver), H5T_NATIVE_UINT32);
    H5Tinsert(link, "emitter", HOFFSET(struct RadLink, emitter), H5T_NATIVE_UINT32);
    H5Tinsert(link, "form_factor", HOFFSET(struct RadLink, form_factor), H5T_NATIVE_FLOAT);
    H5Tinsert(link, "visibility", HOFFSET(struct RadLink, visibility), H5T_NATIVE_UINT16);
    H5Tinsert(link, "levels", HOFFSET(struct RadLink, levels), H5T_NATIVE_UINT8);
    H5Tinsert(link, "mark", HOFFSET(struct RadLink, mark), H5T_NATIVE_UINT8);
    return link;
}

/* So many rows of the data set from `first` on, in one column or more. Returns 0 or -1. */
static int move_rows(hid_t set, hid_t type, uint64_t first, uint64_t count, uint64_t columns,
                     void *to, const void *from)
{
    const hsize_t start[2] = {first, 0}, size[2] = {count, columns};
    const int rank = columns > 1 ? 2 : 1;
    const hid_t file = H5Dget_space(set), memory = H5Screate_simple(rank, size, NULL);
    int failed = file < 0 || memory < 0;
    if (count == 0)
        failed = failed || H5Sselect_none(file) < 0 || H5Sselect_none(memory) < 0;
    else
        failed = failed || H5Sselect_hyperslab(file, H5S_SELECT_SET, start, NULL, size, NULL) < 0;
    if (!failed)
        failed = (to ? H5Dread(set, type, memory, file, H5P_DEFAULT, to)
                     : H5Dwrite(set, type, memory, file, H5P_DEFAULT, from))
                 < 0;
    if (memory >= 0)
        H5Sclose(memory);
    if (file >= 0)
        H5Sclose(file);
    return failed ? -1 : 0;
}

int hdf5_put(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t rows,
             uint64_t columns, const void *data, int own_rows)
{
    uint64_t first = 0, all = rows;
    if (f->together && own_rows)
        machines_place(rows, &first, &all);
    const hsize_t size[2] = {all, columns};
    const hid_t kind = type_of(type), space = H5Screate_simple(columns > 1 ? 2 : 1, size, NULL),
                set = H5Dcreate2(f->id, name, kind, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    int failed = set < 0;
    const int mine = own_rows || !f->together || machines_number() == 0;
    if (!failed && mine && rows > 0)
        failed = move_rows(set, kind, first, rows, columns, NULL, data) < 0;
    const int result = all_did(f, failed, 0);
    if (set >= 0)
        H5Dclose(set);
    H5Sclose(space);
    H5Tclose(kind);
    return result;
}

/* Takes over `kind`. */
static int put_attribute(struct hdf5_file *f, const char *name, hid_t kind, const void *value)
{
    const hid_t space = H5Screate(H5S_SCALAR),
                attribute = H5Acreate2(f->id, name, kind, space, H5P_DEFAULT, H5P_DEFAULT);
    const int failed = attribute < 0 || H5Awrite(attribute, kind, value) < 0;
    const int result = all_did(f, failed, 0);
    if (attribute >= 0)
        H5Aclose(attribute);
    H5Tclose(kind);
    H5Sclose(space);
    return result;
}

int hdf5_put_number(struct hdf5_file *f, const char *name, double value)
{
    return put_attribute(f, name, H5Tcopy(H5T_NATIVE_DOUBLE), &value);
}

int hdf5_put_text(struct hdf5_file *f, const char *name, const char *text)
{
    const hid_t kind = H5Tcopy(H5T_C_S1);
    H5Tset_size(kind, strlen(text) + 1);
    return put_attribute(f, name, kind, text);
}

/* On the disk, before it takes the name of what was there. */
static int bring_to_disk(const char *path)
{
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    const int failed = file < 0 || fsync(file) < 0;
    const int cause = errno;
    if (file >= 0)
        close(file);
    errno = cause;
    return failed;
}

int hdf5_commit(struct hdf5_file *f)
{
    int failed = H5Fclose(f->id) < 0, cause = 0, result;
    if (!failed)
        f->id = -1;
    result = all_did(f, failed, 0);
    if (result == 0) {
        if (f->named) {
            temporary_lock();
            failed = bring_to_disk(f->temporary) || rename(f->temporary, f->target) < 0;
            cause = errno;
            if (!failed) {
                temporary_forget(f->temporary);
                temporary_written();
                f->named = 0;
            }
            temporary_unlock();
        }
        result = all_did(f, failed, failed && !cause ? EIO : cause);
    }
    hdf5_discard(f);
    return result;
}

/* ---- reading */

struct hdf5_file *hdf5_open(const char *path, const char **cause)
{
    struct hdf5_file *f = calloc(1, sizeof *f);
    struct stat status;
    be_quiet();
    *cause = "out of memory";
    if (f)
        f->id = -1;
    if (f && stat(path, &status) < 0)
        *cause = strerror(errno);
    else if (f && (!S_ISREG(status.st_mode) || access(path, R_OK) < 0))
        *cause = S_ISREG(status.st_mode) ? strerror(errno) : "it is no file";
    else if (f) {
        f->id = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        *cause = H5Fis_hdf5(path) > 0 ? "it is damaged or cut short" : "it is no file of HDF5";
    }
    if (f && f->id >= 0)
        return f;
    free(f);
    return NULL;
}

static hid_t set_of(struct hdf5_file *f, const char *name)
{
    return H5Lexists(f->id, name, H5P_DEFAULT) > 0 ? H5Dopen2(f->id, name, H5P_DEFAULT) : -1;
}

static hid_t attribute_of(struct hdf5_file *f, const char *name)
{
    return H5Aexists(f->id, name) > 0 ? H5Aopen(f->id, name, H5P_DEFAULT) : -1;
}

int hdf5_size(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t *rows,
              uint64_t *columns)
{
    const hid_t set = set_of(f, name);
    if (set < 0)
        return -1;
    const hid_t space = H5Dget_space(set), kind = H5Dget_type(set), wanted = type_of(type);
    hsize_t size[2] = {0, 1};
    const int dimensions = space < 0 ? -1 : H5Sget_simple_extent_ndims(space);
    const int good = kind >= 0 && H5Tequal(kind, wanted) > 0 && (dimensions == 1 || dimensions == 2)
                     && H5Sget_simple_extent_dims(space, size, NULL) >= 0;
    *rows = size[0];
    *columns = size[1];
    if (kind >= 0)
        H5Tclose(kind);
    if (space >= 0)
        H5Sclose(space);
    H5Tclose(wanted);
    H5Dclose(set);
    return good ? 0 : -1;
}

int hdf5_get(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t first,
             uint64_t count, uint64_t columns, void *data)
{
    const hid_t set = set_of(f, name);
    if (set < 0)
        return -1;
    const hid_t kind = type_of(type);
    const int failed = count > 0 && move_rows(set, kind, first, count, columns, data, NULL) < 0;
    H5Tclose(kind);
    H5Dclose(set);
    return failed ? -1 : 0;
}

int hdf5_get_number(struct hdf5_file *f, const char *name, double *value)
{
    const hid_t attribute = attribute_of(f, name);
    if (attribute < 0)
        return -1;
    const hid_t space = H5Aget_space(attribute);
    const int failed = space < 0 || H5Sget_simple_extent_npoints(space) != 1
                       || H5Aread(attribute, H5T_NATIVE_DOUBLE, value) < 0;
    if (space >= 0)
        H5Sclose(space);
    H5Aclose(attribute);
    return failed ? -1 : 0;
}

int hdf5_has_text(struct hdf5_file *f, const char *name, const char *text)
{
    char is[64] = "";
    const hid_t attribute = attribute_of(f, name);
    if (attribute < 0)
        return 0;
    const hid_t kind = H5Aget_type(attribute);
    const int same = kind >= 0 && H5Tget_class(kind) == H5T_STRING && H5Tis_variable_str(kind) == 0
                     && H5Tget_size(kind) == strlen(text) + 1 && H5Tget_size(kind) < sizeof is
                     && H5Aread(attribute, kind, is) >= 0 && strcmp(is, text) == 0;
    if (kind >= 0)
        H5Tclose(kind);
    H5Aclose(attribute);
    return same;
}

void hdf5_close(struct hdf5_file *f)
{
    if (f)
        H5Fclose(f->id);
    free(f);
}

#else

int hdf5_built(void)
{
    return 0;
}

struct hdf5_file *hdf5_create(const char *path, int together)
{
    (void)path;
    (void)together;
    return NULL;
}

int hdf5_put(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t rows,
             uint64_t columns, const void *data, int own_rows)
{
    (void)f, (void)name, (void)type, (void)rows, (void)columns, (void)data, (void)own_rows;
    return -1;
}

int hdf5_put_number(struct hdf5_file *f, const char *name, double value)
{
    (void)f, (void)name, (void)value;
    return -1;
}

int hdf5_put_text(struct hdf5_file *f, const char *name, const char *text)
{
    (void)f, (void)name, (void)text;
    return -1;
}

int hdf5_commit(struct hdf5_file *f)
{
    (void)f;
    return -1;
}

void hdf5_discard(struct hdf5_file *f)
{
    (void)f;
}

struct hdf5_file *hdf5_open(const char *path, const char **cause)
{
    (void)path;
    *cause = "built without HDF5";
    return NULL;
}

int hdf5_size(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t *rows,
              uint64_t *columns)
{
    (void)f, (void)name, (void)type, (void)rows, (void)columns;
    return -1;
}

int hdf5_get(struct hdf5_file *f, const char *name, enum hdf5_type type, uint64_t first,
             uint64_t count, uint64_t columns, void *data)
{
    (void)f, (void)name, (void)type, (void)first, (void)count, (void)columns, (void)data;
    return -1;
}

int hdf5_get_number(struct hdf5_file *f, const char *name, double *value)
{
    (void)f, (void)name, (void)value;
    return -1;
}

int hdf5_has_text(struct hdf5_file *f, const char *name, const char *text)
{
    (void)f, (void)name, (void)text;
    return 0;
}

void hdf5_close(struct hdf5_file *f)
{
    (void)f;
}

#endif
