/* check_cut_output.c - what pictures, meshes and tables show of faces that were cut at load: the
 * faces of the file, no more.
 *
 * A floor of 2 x 1 m with a wall on it at x = 1, over the first 0.6 m of its width (which cuts it
 * along the whole width), and a box on the bright side. Radiosities are made up: bright on one
 * side, dark on the other, black under the box.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <assimp/cimport.h>
#include <assimp/scene.h>

#include "geometry.h"
#include "hierarchy/hierarchy.h"
#include "load_scene.h"
#include "output/contact.h"
#include "output/export.h"
#include "output/faces_csv.h"
#include "output/image.h"
#include "output/leaf_mesh.h"
#include "folder.h"
#include "suite.h"

static const char materials[] =
    "newmtl floor\nKd 0.5 0.5 0.5\nnewmtl wall_2s\nKd 0.2 0.2 0.2\nnewmtl box\nKd 0.3 0.3 0.3\n";
static const char room[] =
    "mtllib cut.mtl\nusemtl floor\n"
    "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4\n"
    "usemtl wall_2s\n"
    "v 1 0 0\nv 1 0.6 0\nv 1 0.6 0.1\nv 1 0 0.1\nf 5 6 7 8\n"
    "usemtl box\n"
    "v 0.2 0.2 0\nv 0.8 0.2 0\nv 0.8 0.8 0\nv 0.2 0.8 0\nv 0.2 0.2 0.1\nv 0.8 0.2 0.1\nv 0.8 0.8 "
    "0.1\nv 0.2 0.8 0.1\n"
    "f 13 14 15 16\nf 9 10 14 13\nf 10 11 15 14\nf 11 12 16 15\nf 12 9 13 16\n";
enum { FACES = 7 };
static const double areas[FACES] = {2, 0.06, 0.36, 0.06, 0.06, 0.06, 0.06};

struct stage {
    struct loaded loaded;
    struct hierarchy h; /* of the engine, for quadtrees as uneven as they come */
    struct solution solution;
    struct vertex_values values;
    double *b;
};

static void put(const char *name, const char *text)
{
    FILE *f = fopen(in_folder(name), "w");
    ck_assert_ptr_nonnull(f);
    ck_assert_int_ge(fputs(text, f), 0);
    ck_assert_int_eq(fclose(f), 0);
}

static int under_box(const double p[3])
{
    return p[0] > 0.2 && p[0] < 0.8 && p[1] > 0.2 && p[1] < 0.8;
}

static double made_up(const double p[3])
{
    return under_box(p) ? 0 : p[0] < 1 ? 4 : 1;
}

/* An uneven quadtree on every part, then the radiosities. */
static void stage_open(struct stage *s)
{
    *s = (struct stage){.b = NULL};
    put("cut.mtl", materials);
    put("cut.obj", room);
    load_scene(&s->loaded, in_folder("cut.obj"));
    const struct surfaces *surfaces = &s->loaded.surfaces;
    ck_assert_uint_eq(s->loaded.report.polygons, FACES);
    ck_assert_uint_eq(s->loaded.report.cut, 1);
    ck_assert_uint_gt(s->loaded.report.parts, 5);
    ck_assert_int_eq(hierarchy_build(&s->h, (const struct face *)(const void *)surfaces->faces,
                                     surfaces->face_count),
                     0);
    for (int round = 0; round < 4; round++) {
        uint32_t count = s->h.count;
        for (uint32_t i = 0; i < count; i++)
            if (is_leaf(&s->h.elements[i]) && (round < 2 || (s->h.elements[i].id >> 20) % 3 == 0))
                ck_assert_int_eq(hierarchy_split(&s->h, i), 0);
    }
    s->b = malloc(s->h.count * sizeof *s->b);
    ck_assert_ptr_nonnull(s->b);
    const struct element *e = s->h.elements;
    for (uint32_t i = 0; i < s->h.count; i++)
        s->b[i] = e[i].vertices && surfaces->faces[e[i].face].input == 0 ? made_up(e[i].centre) : 2;
    for (uint32_t i = s->h.count; i-- > 0;) /* a face has its parts' mean */
        if (e[i].vertices && e[i].children) {
            s->b[i] = 0;
            for (uint32_t c = e[i].child; c < e[i].child + 4; c++)
                s->b[i] += s->b[c] * e[c].area / e[i].area;
        }
    s->solution = (struct solution){
        *surfaces, {e, s->h.count, s->h.built, s->h.face_element, 1, s->b, s->b, NULL, NULL}, 0, 0};
    ck_assert_int_eq(vertex_values_build(&s->values, &s->solution), 0);
}

static void stage_close(struct stage *s)
{
    vertex_values_free(&s->values);
    hierarchy_free(&s->h);
    unload_scene(&s->loaded);
    free(s->b);
}

/* What is shown at the point (x, y) of the floor. */
static double shown(const struct stage *s, double x, double y)
{
    const double p[3] = {x, y, 0};
    for (uint32_t f = 0; f < s->solution.surfaces.face_count; f++) {
        const struct RadFace *face = &s->solution.surfaces.faces[f];
        int inside = face->input == 0;
        for (uint32_t i = 0; inside && i < face->vertices; i++) {
            const double *a = face->vertex[i],
                         *b = face->vertex[i + 1 < face->vertices ? i + 1 : 0];
            inside = (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) >= 0;
        }
        if (inside) {
            double value[3];
            uint32_t k = vertex_values_at(&s->values, &s->solution, f, p, value);
            (void)k;
            return value[0];
        }
    }
    ck_abort_msg("no part of the floor at %g %g", x, y);
    return 0;
}

/* On both sides of the wall its own light, up to it; the same at the box's sides; past the
 * wall's end half of the jump at the most. */
START_TEST(test_walls_part)
{
    double worst = 0;
    struct stage s;
    stage_open(&s);
    for (double y = 0.01; y < 0.6 - 1 / 8.0; y += 0.01) {
        ck_assert_double_eq_tol(shown(&s, 1 - 1e-6, y), 4, 1e-4);
        ck_assert_double_eq_tol(shown(&s, 1 + 1e-6, y), 1, 1e-4);
        ck_assert_double_eq_tol(shown(&s, 0.9, y), 4, 1e-4);
    }
    for (double y = 0.21; y < 0.75; y += 0.01) {
        ck_assert_double_eq_tol(shown(&s, 0.2 - 1e-6, y), 4, 1e-4);
        ck_assert_double_eq_tol(shown(&s, y, 0.2 - 1e-6), 4, 1e-4);
        ck_assert_double_eq_tol(shown(&s, y, 0.8 + 1e-6), 4, 1e-4);
        ck_assert_double_eq_tol(shown(&s, 0.2 + 1e-6, y), 0, 1e-4);
    }
    for (double y = 0.61; y < 1; y += 0.01) {
        double left = shown(&s, 1 - 1e-9, y), right = shown(&s, 1 + 1e-9, y);
        worst = fmax(worst, fabs(left - right));
        ck_assert(left > 1.2 && left < 3.8);
    }
    printf("past the wall's end the sides differ by at most %.2g\n", worst);
    /* where no wall is, cut parts blend; their leaves differ in size, so not to the last digit */
    ck_assert_double_le(worst, 1.5);
    stage_close(&s);
}
END_TEST

/* Whatever the leaves under the box have been given, they show what they emit, and none beside them
 * shows any of it, where the box's sides part them. */
START_TEST(test_under_a_box)
{
    struct stage s;
    stage_open(&s);
    double *uncovered = malloc(s.h.count * sizeof *uncovered);
    ck_assert_ptr_nonnull(uncovered);
    for (uint32_t i = 0; i < s.h.count; i++) {
        const struct element *e = &s.h.elements[i];
        int under =
            is_leaf(e) && s.solution.surfaces.faces[e->face].input == 0 && under_box(e->centre);
        uncovered[i] = !under;
        if (under)
            s.b[i] = 7;
    }
    s.solution.tree.uncovered = uncovered;
    vertex_values_free(&s.values);
    ck_assert_int_eq(vertex_values_build(&s.values, &s.solution), 0);
    for (double y = 0.21; y < 0.8; y += 0.01) {
        ck_assert_double_eq_tol(shown(&s, 0.2 - 1e-6, y), 4, 1e-4);
        ck_assert_double_eq_tol(shown(&s, 0.2 + 1e-6, y), 0, 1e-4);
        ck_assert_double_eq_tol(shown(&s, 0.5, y), 0, 1e-4);
    }
    free(uncovered);
    stage_close(&s);
}
END_TEST

/* From above: bright and dark meet at the wall with nothing between, and no pixel of the floor
 * is empty. */
START_TEST(test_picture)
{
    enum { W = 160, H = 80 };
    /* 1 m high at 40 m */
    const struct view view = {
        .eye = {1, 0.5, 40}, .at = {1, 0.5, 0}, .up = {0, 1, 0}, .fov = 2 * 0.7161599454704085};
    png_image image = {.version = PNG_IMAGE_VERSION};
    struct stage s;
    stage_open(&s);
    ck_assert_int_eq(
        image_write(in_folder("cut.png"), &s.solution, &s.values, &view, W, H, 0, NULL), 0);
    ck_assert_int_ne(png_image_begin_read_from_file(&image, in_folder("cut.png")), 0);
    image.format = PNG_FORMAT_GRAY;
    unsigned char *rgb = malloc(PNG_IMAGE_SIZE(image));
    ck_assert_int_ne(png_image_finish_read(&image, NULL, rgb, 0, NULL), 0);
    int bright = rgb[(H - 8) * W + 4];
    int dark = rgb[(H - 8) * W + W - 4];
    ck_assert_int_gt(bright, dark + 40);
    for (int y = 2; y < H - 2; y++)
        for (int x = 2; x < W - 2; x++) {
            double px = (x + 0.5) / 80, py = 1 - (y + 0.5) / 80;
            int value = rgb[y * W + x];
            if (fabs(px - 1) < 0.02 || (py > 0.45 && fabs(px - 1) < 0.55)
                || (px > 0.17 && px < 0.83 && py > 0.17 && py < 0.83))
                continue; /* the wall's edge, what is blended past its end, the box */
            ck_assert_msg(abs(value - (px < 1 ? bright : dark)) <= 1, "pixel %d %d is %d", x, y,
                          value);
        }
    free(rgb);
    stage_close(&s);
}
END_TEST

/* The meshes that are written cover each face of the file once. */
START_TEST(test_meshes)
{
    static const char *const names[] = {"cut.ply", "cut.gltf", "cut.glb", "cut_out.obj"};
    struct stage s;
    stage_open(&s);
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        double floor = 0, all = 0;
        ck_assert_int_eq(export_write(in_folder(names[n]), &s.solution, &s.values, NULL), 0);
        const struct aiScene *read = aiImportFile(in_folder(names[n]), 0);
        ck_assert_msg(read != NULL, "%s: %s", names[n], aiGetErrorString());
        for (unsigned m = 0; m < read->mNumMeshes; m++)
            for (unsigned i = 0; i < read->mMeshes[m]->mNumFaces; i++) {
                const struct aiMesh *mesh = read->mMeshes[m];
                const struct aiFace *f = &mesh->mFaces[i];
                double sum[3] = {0, 0, 0}, high = 0;
                for (unsigned j = 2; j < f->mNumIndices; j++) {
                    double p[3][3], a[3], b[3], c[3];
                    for (int k = 0; k < 3; k++) {
                        const struct aiVector3D *v =
                            &mesh->mVertices[f->mIndices[k == 0 ? 0 : j + (unsigned)k - 2]];
                        p[k][0] = (double)v->x;
                        p[k][1] = (double)v->y;
                        p[k][2] = (double)v->z;
                        high = fmax(high, p[k][2]);
                    }
                    sub3(a, p[1], p[0]);
                    sub3(b, p[2], p[0]);
                    cross3(c, a, b);
                    for (int k = 0; k < 3; k++)
                        sum[k] += 0.5 * c[k];
                }
                all += length3(sum);
                if (high <= 0) {
                    ck_assert_double_gt(sum[2], 0);
                    floor += sum[2];
                }
            }
        ck_assert_double_eq_tol(floor, areas[0], 1e-5);
        /* the wall has two sides */
        ck_assert_double_eq_tol(all, 2 + 2 * 0.06 + 0.36 + 4 * 0.06, 1e-5);
        aiReleaseImport(read);
    }
    stage_close(&s);
}
END_TEST

/* No T-junction: every corner of a polygon that lies on another's edge, of the same surface and
 * side, is a corner of that, too. */
START_TEST(test_no_gaps)
{
    uint32_t inserted = 0;
    struct stage s;
    stage_open(&s);
    struct leaf_mesh m;
    ck_assert_int_eq(leaf_mesh_build(&m, &s.solution, &s.values), 0);
    for (uint32_t i = 0; i < m.polygons; i++)
        for (uint32_t j = m.start[i]; j < m.start[i + 1]; j++) {
            uint32_t a = m.corner[j], b = m.corner[j + 1 < m.start[i + 1] ? j + 1 : m.start[i]];
            const struct shared_vertex *p = &s.values.vertices[a], *q = &s.values.vertices[b];
            ck_assert_uint_ne(a, b);
            for (uint32_t c = 0; c < s.values.count; c++) {
                const struct shared_vertex *r = &s.values.vertices[c];
                double e[3], w[3], x[3], left[3];
                if (r->material != p->material || dot3(r->normal, p->normal) < 0.99)
                    continue;
                sub3(e, q->position, p->position);
                sub3(w, r->position, p->position);
                cross3(x, e, w);
                cross3(left, p->normal, e);
                double t = dot3(w, e) / dot3(e, e);
                ck_assert_msg(
                    !(length3(x) < 1e-9 && t > 1e-6 && t < 1 - 1e-6)
                        || contact_sector(r->normal, r->contacts,
                                          (const double(*)[3]) & s.values.contact[r->contact], left)
                               != r->sector,
                    "%g %g in the edge from %g %g to %g %g", r->position[0], r->position[1],
                    p->position[0], p->position[1], q->position[0], q->position[1]);
            }
        }
    for (uint32_t i = 0; i < m.polygons; i++) {
        uint32_t n = m.start[i + 1] - m.start[i];
        inserted += n > 4;
    }
    ck_assert_uint_gt(inserted, 20);
    leaf_mesh_free(&m);
    stage_close(&s);
}
END_TEST

/* One row per face of the file; the floor's means are its parts' by area. */
START_TEST(test_table)
{
    int row = 0;
    struct stage s;
    stage_open(&s);
    ck_assert_int_eq(faces_csv_write(in_folder("cut.csv"), &s.solution, NULL), 0);
    FILE *f = fopen(in_folder("cut.csv"), "r");
    ck_assert_ptr_nonnull(f);
    char line[256];
    ck_assert_ptr_nonnull(fgets(line, sizeof line, f));
    ck_assert_str_eq(line, "face,material,area,E_0,rho_0,H_0,B_0,sides\n");
    for (; fgets(line, sizeof line, f); row++) {
        ck_assert_int_lt(row, FACES);
        char name[32];
        double area, e, rho, h, b;
        int face, sides;
        ck_assert_int_eq(sscanf(line, "%d,%31[^,],%lf,%lf,%lf,%lf,%lf,%d", &face, name, &area, &e,
                                &rho, &h, &b, &sides),
                         8);
        ck_assert_int_eq(sides, row == 1 ? 2 : 1);
        ck_assert_int_eq(face, row);
        ck_assert_double_eq_tol(area, areas[row], 1e-6);
        ck_assert_double_eq_tol(h, row ? 2 : (4 * (1 - 0.36) + 1) / 2, 1e-5);
        ck_assert_double_eq_tol(b, rho * h, 1e-9);
        ck_assert_str_eq(name, row == 0 ? "floor" : row == 1 ? "wall_2s" : "box");
    }
    ck_assert_int_eq(row, FACES);
    fclose(f);
    stage_close(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("what is written of cut faces");
    TCase *c = tcase_create("output");
    if (folder_make("cut") < 0)
        return EXIT_FAILURE;
    tcase_set_timeout(c, 60);
    tcase_add_test(c, test_walls_part);
    tcase_add_test(c, test_under_a_box);
    tcase_add_test(c, test_picture);
    tcase_add_test(c, test_meshes);
    tcase_add_test(c, test_no_gaps);
    tcase_add_test(c, test_table);
    suite_add_tcase(suite, c);
    int failed = suite_failures(suite);
    folder_remove();
    return failed != 0;
}
