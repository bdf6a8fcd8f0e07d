/* check_error_image.c - the picture of the error: hues, the scale and its number, where it stands.
 *
 * Solutions and errors are made up, a known share on each face, so that the right colour of each
 * pixel is known.
 * SPDX-License-Identifier: MIT */
#include <check.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "hierarchy/hierarchy.h"
#include "output/bitmap_text.h"
#include "output/error_image.h"
#include "output/image.h"
#include "folder.h"
#include "read_png.h"
#include "suite.h"

/* ---- a row of squares, 1 m wide, that the eye looks at ---- */

enum { FACES = 6, ELEMENTS_MAX = 4000, W = 600, H = 300 };

/* Each is off by a share of what it truly reflects. */
struct row {
    struct RadFace faces[FACES];
    struct RadMaterial materials[2]; /* 0: reflects; 1: a lamp */
    struct hierarchy h;
    struct solution solution;
    struct vertex_values values;
    double b[3 * ELEMENTS_MAX], error[3 * ELEMENTS_MAX], limit[3 * ELEMENTS_MAX];
    struct error_seen seen; /* both */
    struct view view;
};

static void hold_element(struct row *r, uint32_t element, uint32_t bands, double truth,
                         double share)
{
    for (uint32_t k = 0; k < bands; k++) {
        r->error[element * bands + k] = share * truth;
        r->b[element * bands + k] = (1 + share) * truth;
    }
}

static void hold_face(struct row *r, uint32_t face, uint32_t bands, double truth, double share)
{
    for (uint32_t i = 0; i < r->h.count; i++)
        if (r->h.elements[i].vertices && r->h.elements[i].face == face)
            hold_element(r, i, bands, truth, share);
}

/* Squares along x at y = 4, 100 pixels wide each, the middle of face i at (50 + 100 i, 100). */
static struct row *row_new(uint32_t bands, const double *shares, uint32_t lamp)
{
    struct row *r = calloc(1, sizeof *r);
    for (uint32_t i = 0; i < FACES; i++) {
        double x = (double)i - 3;
        const double v[4][3] = {{x, 4, 0}, {x + 1, 4, 0}, {x + 1, 4, 1}, {x, 4, 1}};
        memcpy(r->faces[i].vertex, v, sizeof v);
        r->faces[i].vertices = 4;
        r->faces[i].input = i;
        r->faces[i].material = i == lamp;
    }
    r->materials[1].exitance[0] = 7;
    r->seen = (struct error_seen){r->error, r->limit};
    r->solution.surfaces =
        (struct surfaces){.faces = r->faces, .face_count = FACES, .materials = r->materials};
    ck_assert_int_eq(hierarchy_build(&r->h, (const struct face *)(const void *)r->faces, FACES), 0);
    for (uint32_t i = 0; i < FACES; i++)
        hold_face(r, i, bands, 2, shares[i]);
    r->solution.tree = (struct RadElements){
        r->h.elements, r->h.count, r->h.built, r->h.face_element, bands, r->b, r->b, NULL, NULL};
    ck_assert_int_eq(vertex_values_build(&r->values, &r->solution), 0);
    char text[64];
    /* at distance 4 the picture is 3 m high; its middle is at z = 0 */
    snprintf(text, sizeof text, "0,0,0:0,1,0:%.12f", 2 * atan(1.5 / 4) * 180 / 3.14159265358979323);
    ck_assert_int_eq(view_parse(text, &r->view), 0);
    r->view.up[2] = 1;
    return r;
}

static void row_free(struct row *r)
{
    vertex_values_free(&r->values);
    hierarchy_free(&r->h);
    free(r);
}

static struct pixels draw(struct row *r, int width, int height, int mesh)
{
    ck_assert_int_eq(error_image_write(in_folder("e.png"), &r->solution, &r->values, &r->seen,
                                       &r->view, width, height, mesh),
                     0);
    return load(in_folder("e.png"));
}

static int red_less_blue(const unsigned char *c)
{
    return c[0] - c[2];
}

static int sum(const unsigned char *c)
{
    return c[0] + c[1] + c[2];
}

/* ---- colours ---- */

/* Too bright is red, too dark blue, right and lamps grey; deeper the more it is off; what is beyond
 * the scale is darker than all that is not. Of one band and of three. */
START_TEST(test_hues)
{
    /* The scale is 40 %: a sixth of the area is off by as much. Lamps' errors are none. */
    static const double shares[FACES] = {-0.4, -0.1, 0, 0.1, 0.4, 3};
    for (uint32_t bands = 1; bands <= 3; bands += 2) {
        struct row *r = row_new(bands, shares, 5);
        ck_assert_double_eq(error_image_scale(&r->solution, r->error), 0.4);
        struct pixels p = draw(r, W, H, 0);
        int warm[FACES];
        for (int i = 0; i < FACES; i++)
            warm[i] = red_less_blue(at(&p, 50 + 100 * i, 100));
        ck_assert_int_lt(warm[0], -60);
        ck_assert_int_lt(warm[1], -30);
        ck_assert_int_eq(warm[2], 0);
        ck_assert_int_gt(warm[3], 30);
        ck_assert_int_gt(warm[4], 60);
        ck_assert_int_lt(sum(at(&p, 50, 100)), sum(at(&p, 150, 100)) - 60);
        ck_assert_int_lt(sum(at(&p, 450, 100)), sum(at(&p, 350, 100)) - 60);
        ck_assert_int_eq(warm[5], 0);
        /* One face is one colour, and errors of other faces do not run into it. */
        for (int i = 0; i < FACES - 1; i++)
            ck_assert_msg(abs(sum(at(&p, 100 * i + 5, 100)) - sum(at(&p, 100 * i + 95, 100))) < 40,
                          "face %d", i);
        free(p.rgb);
        row_free(r);
    }
}
END_TEST

/* A face off by more than the scale, and too small to count for it, is darker than the end of the
 * scale even where that is in the dark. */
START_TEST(test_beyond)
{
    for (int sign = -1; sign <= 1; sign += 2) {
        const double shares[FACES] = {0.1 * sign, 0.1 * sign, 0.1 * sign,
                                      0.1 * sign, 0.1 * sign, 0.1 * sign};
        struct row *r = row_new(1, shares, FACES);
        /* Split: face 0 into 64 leaves, one of them 1/384 of the area. */
        uint32_t first = r->h.face_element[0], inner = 0;
        for (int depth = 0; depth < 3; depth++) {
            ck_assert_int_eq(hierarchy_split(&r->h, first), 0);
            inner = r->h.elements[first].child + 2;
            first = inner;
        }
        for (uint32_t i = 0; i < FACES; i++)
            hold_face(r, i, 1, 2, 0.1 * sign);
        hold_element(r, inner, 1, 2, 0.12 * sign);
        /* Face 5 is in the dark: there a share is one of ERROR_IMAGE_DARK of the mean. */
        double mean = (5 * 2 + 0.02) / 6, off = 0.1 * sign * ERROR_IMAGE_DARK * mean;
        uint32_t dark = r->h.face_element[5];
        r->error[dark] = off;
        r->b[dark] = 0.02 + off;
        vertex_values_free(&r->values);
        r->solution.tree.elements = r->h.elements;
        r->solution.tree.count = r->h.count;
        ck_assert_int_eq(vertex_values_build(&r->values, &r->solution), 0);
        ck_assert_double_eq(error_image_scale(&r->solution, r->error), 0.1);
        struct pixels p = draw(r, W, H, 0);
        const struct element *e = &r->h.elements[inner];
        int x = (int)(300 + 100 * e->centre[0]), y = (int)(150 - 100 * e->centre[2]);
        const unsigned char *beyond = at(&p, x, y), *end = at(&p, 450, 100),
                            *dim = at(&p, 596, 100);
        ck_assert_int_gt(sign * red_less_blue(beyond), 20);
        ck_assert_int_gt(sign * red_less_blue(dim), 40);
        ck_assert_int_lt(sum(dim), sum(end));
        ck_assert_int_lt(sum(beyond), sum(dim) - 20);
        free(p.rgb);
        row_free(r);
    }
}
END_TEST

/* The darkest and the brightest pixel of what is in the middle of a face's square. */
static void span(const struct pixels *p, int face, int *low, int *high)
{
    *low = 3 * 255;
    *high = 0;
    for (int y = 80; y < 120; y++)
        for (int x = 30; x < 70; x++) {
            int s = sum(at(p, 100 * face + x, y));
            *low = s < *low ? s : *low;
            *high = s > *high ? s : *high;
        }
}

/* Hatched is what may be off by more than a twentieth and is not told to be: no lamp, nothing that
 * is coloured, nothing that is known well enough; of what is dark, a twentieth of its own light.
 * Plain and hatched differ by grey alone. */
START_TEST(test_hatch)
{
    enum { TOLD = 0, KNOWN, UNKNOWN, LAMP, DARK_KNOWN, DARK };
    static const double shares[FACES] = {0.1, 0, 0, 0, 0, 0};
    for (uint32_t bands = 1; bands <= 3; bands += 2) {
        struct row *r = row_new(bands, shares, LAMP);
        hold_face(r, DARK_KNOWN, bands, 0.02, 0);
        hold_face(r, DARK, bands, 0.02, 0);
        const double limit[FACES] = {0.9, 0.09, 0.11, 9, 0.0009, 0.0011};
        for (uint32_t i = 0; i < FACES; i++)
            for (uint32_t k = 0; k < bands; k++)
                r->limit[r->h.face_element[i] * bands + k] = limit[i];
        vertex_values_free(&r->values);
        ck_assert_int_eq(vertex_values_build(&r->values, &r->solution), 0);
        struct pixels p = draw(r, W, H, 0);
        for (int i = 0; i < FACES; i++) {
            int low, high, hatched = i == UNKNOWN || i == DARK;
            span(&p, i, &low, &high);
            ck_assert_msg((high - low > 60) == hatched && (high - low < 40) == !hatched,
                          "face %d: %d to %d", i, low, high);
            for (int x = 30; x < 70 && i != TOLD; x++)
                ck_assert_int_eq(red_less_blue(at(&p, 100 * i + x, 100)), 0);
            ck_assert_int_eq(error_image_unknown(&r->solution, &r->seen, r->h.face_element[i]),
                             hatched);
        }
        free(p.rgb);
        row_free(r);
    }
}
END_TEST

/* The share is of what the place truly reflects, but of no less than a tenth of the mean. */
START_TEST(test_share)
{
    static const double shares[FACES] = {0, 0, 0, 0, 0, 0};
    struct row *r = row_new(3, shares, 1);
    uint32_t e = r->h.face_element[0], lamp = r->h.face_element[1];
    hold_face(r, 0, 3, 4, 0.25);
    hold_face(r, 1, 3, 100, 1); /* the lamp counts nowhere */
    double mean = (4 + 4 * 2) / 5.;
    ck_assert_double_eq_tol(error_image_mean(&r->solution, r->error), mean, 1e-12);
    ck_assert_double_eq_tol(error_image_share(&r->solution, r->error, mean, e), 0.25, 1e-12);
    ck_assert_double_eq(error_image_share(&r->solution, r->error, mean, lamp), 0);
    hold_face(r, 0, 3, 4, -0.25);
    ck_assert_double_eq_tol(error_image_share(&r->solution, r->error, mean, e), -0.25, 1e-12);
    hold_face(r, 0, 3, 0.001, 2);
    ck_assert_double_eq_tol(error_image_share(&r->solution, r->error, mean, e),
                            0.002 / (0.1 * mean), 1e-9);
    /* Bands count as an eye weighs them. */
    hold_face(r, 0, 3, 4, 0);
    r->error[3 * e + 1] = 0.4;
    r->b[3 * e + 1] += 0.4;
    ck_assert_double_eq_tol(error_image_share(&r->solution, r->error, mean, e), 0.07152, 1e-12);
    /* No light at all, and yet too bright: off by any share. */
    ck_assert(error_image_share(&r->solution, r->error, 0, r->h.face_element[2]) == 0);
    hold_face(r, 2, 3, 0, 0);
    r->b[3 * r->h.face_element[2]] = r->error[3 * r->h.face_element[2]] = 1;
    ck_assert(isinf(error_image_share(&r->solution, r->error, 0, r->h.face_element[2])));
    row_free(r);
}
END_TEST

/* ---- the scale ---- */

START_TEST(test_scale)
{
    static const struct {
        double share, scale;
    } rounds[] = {{0, 0.01},     {0.004, 0.01}, {0.01, 0.01}, {0.0101, 0.02}, {-0.02, 0.02},
                  {-0.03, 0.04}, {0.15, 0.2},   {-0.2, 0.2},  {0.3, 0.4},     {0.41, 1},
                  {-0.99, 1},    {1.5, 2},      {3, 4},       {7, 10},        {70, 10}};
    for (size_t i = 0; i < sizeof rounds / sizeof *rounds; i++) {
        const double shares[FACES] = {rounds[i].share, rounds[i].share, rounds[i].share,
                                      rounds[i].share, rounds[i].share, rounds[i].share};
        struct row *r = row_new(1, shares, FACES);
        ck_assert_double_eq(error_image_scale(&r->solution, r->error), rounds[i].scale);
        row_free(r);
    }
}
END_TEST

/* Of the area a hundredth at the most is beyond the scale: a leaf of 1/96 counts, one of 1/384 does
 * not, one of a lamp or under something that stands on it neither. */
START_TEST(test_scale_area)
{
    static const double shares[FACES] = {0, 0, 0, 0, 0, 0};
    for (int depth = 2; depth <= 3; depth++)
        for (uint32_t lamp = 0; lamp < 2; lamp++) {
            struct row *r = row_new(1, shares, lamp ? 0 : FACES);
            uint32_t last = r->h.face_element[0];
            for (int i = 0; i < depth; i++) {
                ck_assert_int_eq(hierarchy_split(&r->h, last), 0);
                last = r->h.elements[last].child;
            }
            for (uint32_t i = 0; i < FACES; i++)
                hold_face(r, i, 1, 2, 0);
            hold_element(r, last, 1, 2, 0.35);
            r->solution.tree.elements = r->h.elements;
            r->solution.tree.count = r->h.count;
            ck_assert_double_eq(error_image_scale(&r->solution, r->error),
                                depth == 2 && !lamp ? 0.4 : 0.01);
            double uncovered[64];
            for (uint32_t i = 0; i < r->h.count && i < 64; i++)
                uncovered[i] = i != last;
            r->solution.tree.uncovered = uncovered;
            ck_assert_double_eq(error_image_scale(&r->solution, r->error), 0.01);
            row_free(r);
        }
}
END_TEST

/* Does the strip say the text, white on black, in dots of `zoom`? */
static int says(const struct pixels *p, int zoom, const char *text)
{
    int w = bitmap_text_width(text) * zoom, h = TEXT_ASCENT * zoom;
    struct bitmap b = {calloc((size_t)(w * h), 3), w, h};
    bitmap_text(&b, 0, 0, zoom, (const uint8_t[3]){255, 255, 255}, text);
    int found = 0;
    for (int y = p->height - 34 * zoom; y + h <= p->height && !found; y++)
        for (int x = 0; x + w <= p->width && !found; x++) {
            int same = 1;
            for (int i = 0; i < w * h && same; i++)
                same = (at(p, x + i % w, y + i / w)[1] == 255) == (b.rgb[3 * i] == 255);
            found = same;
        }
    free(b.rgb);
    return found;
}

/* Numbers and words, as far as there is room, and blue left of red. */
START_TEST(test_bar)
{
    static const double shares[FACES] = {0.2, 0.2, 0.2, 0.2, 0.2, -0.2};
    struct row *r = row_new(1, shares, FACES);
    struct pixels p = draw(r, 1024, 768, 0);
    ck_assert(says(&p, 2, "-20% too dark"));
    ck_assert(says(&p, 2, "too bright +20%"));
    ck_assert(says(&p, 2, "-5%"));
    ck_assert(says(&p, 2, "+5%"));
    ck_assert(!says(&p, 2, "+40%"));
    ck_assert(says(&p, 2, "not known to 5%"));
    ck_assert(says(&p, 2, "right within 5%"));
    int y = 768 - (4 + 3 + 7 + 2) * 2;
    ck_assert_int_lt(red_less_blue(at(&p, 30, y)), -60);
    ck_assert_int_eq(red_less_blue(at(&p, 512, y)), 0);
    ck_assert_int_gt(red_less_blue(at(&p, 994, y)), 60);
    ck_assert_int_lt(sum(at(&p, 6, y)), sum(at(&p, 30, y)) - 50); /* the tips: beyond */
    ck_assert_int_lt(sum(at(&p, 1017, y)), sum(at(&p, 994, y)) - 50);
    free(p.rgb);
    p = draw(r, 160, 120, 0);
    ck_assert(says(&p, 1, "-20% too dark"));
    ck_assert(says(&p, 1, "too bright +20%"));
    ck_assert(says(&p, 1, "not known to 5%"));
    ck_assert(!says(&p, 1, "right within 5%"));
    free(p.rgb);
    p = draw(r, 80, 70, 0);
    ck_assert(says(&p, 1, "-20%"));
    ck_assert(says(&p, 1, "+20%"));
    ck_assert(!says(&p, 1, "dark"));
    free(p.rgb);
    /* Too small for any: the picture alone. */
    static const int small[][2] = {{40, 90}, {300, 50}, {1, 1}, {3, 200}};
    for (int i = 0; i < 4; i++) {
        p = draw(r, small[i][0], small[i][1], 0);
        for (int j = 0; j < p.width * p.height; j++) /* no pixel of the strip's black */
            ck_assert(memcmp(&p.rgb[3 * j], (const uint8_t[3]){20, 20, 20}, 3) != 0);
        free(p.rgb);
    }
    row_free(r);
}
END_TEST

/* Every character of every scale is there, and none reaches out of its place. */
START_TEST(test_text)
{
    static const char all[] = "0123456789.%+- abdghiknortw";
    for (size_t i = 0; i + 1 < sizeof all; i++) {
        uint8_t rgb[3 * 12 * 12] = {0}, unknown[sizeof rgb] = {0};
        char text[2] = {all[i], 0};
        struct bitmap b = {rgb, 12, 12}, none = {unknown, 12, 12};
        bitmap_text(&b, 3, 2, 1, (const uint8_t[3]){9, 9, 9}, text);
        bitmap_text(&none, 3, 2, 1, (const uint8_t[3]){9, 9, 9}, "\x7f");
        ck_assert_msg((memcmp(rgb, unknown, sizeof rgb) != 0) == (all[i] != ' '), "%c", all[i]);
        for (int j = 0; j < 144; j++)
            if (j % 12 < 3 || j % 12 >= 3 + bitmap_text_width(text) || j / 12 < 2
                || j / 12 >= 2 + TEXT_ASCENT + TEXT_DESCENT)
                ck_assert_msg(rgb[3 * j] == 0, "%c", all[i]);
        bitmap_text(&b, -2, -3, 3, (const uint8_t[3]){9, 9, 9}, text); /* cut off, no crash */
        bitmap_text(&b, 10, 11, 3, (const uint8_t[3]){9, 9, 9}, text);
    }
    ck_assert_int_eq(bitmap_text_width(""), 0);
    ck_assert_int_eq(bitmap_text_width("11"), 7);
    uint8_t two[3 * 12 * 12] = {0};
    bitmap_text(&(struct bitmap){two, 12, 12}, 2, 2, 1, (const uint8_t[3]){9, 9, 9}, "1-");
    int right = 0;
    for (int j = 0; j < 144; j++)
        right = two[3 * j] && j % 12 > right ? j % 12 : right;
    ck_assert_int_eq(right, 2 + bitmap_text_width("1-") - 1);
}
END_TEST

/* ---- as the picture of the light ---- */

/* The same surfaces in the same pixels, mesh lines too. */
START_TEST(test_same_camera)
{
    static const double shares[FACES] = {0.2, 0.2, 0.2, 0.2, 0.2, -0.2};
    struct row *r = row_new(1, shares, FACES);
    r->view.at[0] = 0.5;
    ck_assert_int_eq(
        image_write(in_folder("i.png"), &r->solution, &r->values, &r->view, W, H, 0, NULL), 0);
    struct pixels image = load(in_folder("i.png")), error = draw(r, W, H, 0),
                  lined = draw(r, W, H, 1);
    int seen = 0, lines = 0;
    for (int i = 0; i < W * (H - 35); i++) {
        int ground = memcmp(&image.rgb[3 * i], image.rgb, 3) == 0; /* as in the corner */
        ck_assert_int_eq(memcmp(&error.rgb[3 * i], image.rgb, 3) == 0, ground);
        seen += !ground;
        lines += memcmp(&error.rgb[3 * i], &lined.rgb[3 * i], 3) != 0;
    }
    ck_assert_int_gt(seen, 30000);
    ck_assert_int_gt(lines, 1000);
    ck_assert_int_lt(lines, 6000);
    free(image.rgb);
    free(error.rgb);
    free(lined.rgb);
    row_free(r);
}
END_TEST

static size_t bytes_of(const char *path, unsigned char *bytes, size_t most)
{
    FILE *f = fopen(path, "rb");
    ck_assert_ptr_nonnull(f);
    size_t size = fread(bytes, 1, most, f);
    (void)fclose(f);
    return size;
}

START_TEST(test_threads)
{
    static unsigned char first[1 << 20], other[1 << 20];
    static const double shares[FACES] = {-0.3, 0.07, 0.2, 0, 0.01, -0.2};
    struct row *r = row_new(3, shares, FACES);
    size_t size = 0;
    for (int threads = 1; threads <= 5; threads += 2) {
        r->solution.threads = threads;
        free(draw(r, 203, 157, 1).rgb);
        size_t now = bytes_of(in_folder("e.png"), threads == 1 ? first : other, sizeof first);
        size = threads == 1 ? now : size;
        ck_assert_uint_gt(now, 100);
        ck_assert_uint_eq(now, size);
        ck_assert(threads == 1 || memcmp(first, other, size) == 0);
    }
    row_free(r);
}
END_TEST

START_TEST(test_broken)
{
    static const double shares[FACES] = {0, 0, 0, 0, 0, 0};
    struct row *r = row_new(1, shares, FACES);
    const char *bad = in_folder("no/e.png"), *file = in_folder("n.png");
    ck_assert_int_eq(error_image_write(bad, &r->solution, &r->values, &r->seen, NULL, 10, 10, 0),
                     -1);
    ck_assert_int_eq(error_image_write(file, &r->solution, &r->values, &r->seen, NULL, 0, 10, 0),
                     -1);
    ck_assert_int_eq(
        error_image_write(file, &r->solution, &r->values, &r->seen, NULL, 10, 20000, 0), -1);
    const struct error_seen none = {NULL, NULL};
    ck_assert_int_eq(error_image_write(file, &r->solution, &r->values, &none, NULL, 10, 10, 0), -1);
    ck_assert_int_ne(access(file, F_OK), 0);
    /* All black and no error: still a picture. */
    for (uint32_t i = 0; i < FACES; i++)
        hold_face(r, i, 1, 0, 0);
    ck_assert_int_eq(error_image_write(file, &r->solution, &r->values, &r->seen, NULL, 200, 100, 1),
                     0);
    row_free(r);
}
END_TEST

int main(void)
{
    if (folder_make("error") < 0)
        return EXIT_FAILURE;
    Suite *suite = suite_create("error image");
    TCase *t = tcase_create("error image");
    tcase_set_timeout(t, 60);
    tcase_add_test(t, test_hues);
    tcase_add_test(t, test_beyond);
    tcase_add_test(t, test_hatch);
    tcase_add_test(t, test_share);
    tcase_add_test(t, test_scale);
    tcase_add_test(t, test_scale_area);
    tcase_add_test(t, test_bar);
    tcase_add_test(t, test_text);
    tcase_add_test(t, test_same_camera);
    tcase_add_test(t, test_threads);
    tcase_add_test(t, test_broken);
    suite_add_tcase(suite, t);
    int failed = suite_failures(suite);
    folder_remove();
    return failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
