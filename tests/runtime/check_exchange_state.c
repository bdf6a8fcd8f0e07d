/* check_exchange_state.c - view factors that are put down at any place and gone on with on other
 * threads have the bits of those that are not; a state that is damaged, cut short or of other work
 * is refused, and none leads outside of an array.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "engine/exchange_state.h"
#include "kernel/hash_bytes.h"
#include "runtime/make_tables.h"
#include "suite.h"

/* A state. */
struct kept {
    unsigned char *bytes;
    size_t size, capacity;
};

/* What a run goes on from and puts down. */
struct run {
    const struct kept *from; /* NULL: it begins */
    struct kept *to;         /* empty */
    size_t at;               /* in `from` */
    int asked, stop_at;      /* the how manieth time it is asked; 0: never */
    const char *stop_in;     /* in this phase; NULL: in any */
    int in;                  /* the work is in that phase */
    int whole;               /* `to` is there */
    int resumed;             /* it was told, so often */
    int mend;                /* checks that are read are right, whatever stands before them */
    size_t check[3];         /* where they stand */
    uint64_t hash;
};

static size_t read_run(void *user, void *bytes, size_t size)
{
    struct run *r = user;
    const size_t left = r->from->size - r->at, count = left < size ? left : size;
    memcpy(bytes, r->from->bytes + r->at, count);
    for (int i = 0; i < 3 && r->mend && count == sizeof r->hash; i++)
        if (r->at == r->check[i])
            memcpy(bytes, &r->hash, count);
    r->hash = hash_bytes(r->hash, bytes, count);
    r->at += count;
    return count;
}

static enum RadStateWish ask_run(void *user)
{
    struct run *r = user;
    r->asked += !r->stop_in || r->in;
    return r->asked == r->stop_at ? RAD_STATE_STOP : RAD_STATE_NONE;
}

static int write_run(void *user, const void *bytes, size_t size)
{
    struct run *r = user;
    struct kept *k = r->to;
    ck_assert_int_eq(r->whole, 0);
    r->whole = !bytes;
    if (k->size + size > k->capacity) {
        k->capacity = 2 * k->capacity + size;
        k->bytes = realloc(k->bytes, k->capacity);
        ck_assert_ptr_nonnull(k->bytes);
    }
    if (size)
        memcpy(k->bytes + k->size, bytes, size);
    k->size += size;
    return 0;
}

static int watch(void *user, const struct RadProgress *at)
{
    struct run *r = user;
    r->resumed += strcmp(at->phase, "resumed") == 0;
    r->in = r->stop_in && strcmp(at->phase, r->stop_in) == 0;
    return 0;
}

static struct state_head head_of(const struct kept *k)
{
    struct state_head head;
    ck_assert_uint_ge(k->size, sizeof head);
    memcpy(&head, k->bytes, sizeof head);
    return head;
}

static void forget(struct kept *k)
{
    free(k->bytes);
    *k = (struct kept){0};
}

/* A room of 3 x 3 faces on each wall, and plates in it that stand before each other. */
static void make_room_with_plates(void)
{
    clear();
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++)
            for (int i = 0; i < 9; i++) {
                double at[3] = {0, 0, 0}, u[3] = {0, 0, 0}, v[3] = {0, 0, 0};
                const int a = (axis + 1 + side) % 3, b = (axis + 2 - side) % 3;
                at[axis] = side;
                at[a] = i % 3 / 3.0;
                at[b] = i / 3 / 3.0;
                u[a] = v[b] = 1 / 3.0;
                rectangle(at, u, v);
            }
    for (int i = 0; i < 4; i++)
        rectangle((double[3]){.15 + .2 * i, .2, .2 + .05 * i}, (double[3]){.1, 0, .02 * i},
                  (double[3]){0, .5, .03});
}

struct work {
    RadDevice device;
    RadScene scene;
    RadOracle oracle;
};

static const double TOLERANCE = 3e-3;

static struct work begin(int threads)
{
    struct work w = {.device = radNewDevice(&(struct RadDeviceOptions){.threads = threads})};
    w.scene = scene_on(w.device);
    w.oracle = radNewExchangeOracle(w.device, TOLERANCE);
    /* groups, and faces in parts: all that there is to a state */
    ck_assert_int_eq(radSetOracleParameter(w.oracle, "from_faces", 2), 0);
    ck_assert_int_eq(radSetOracleParameter(w.oracle, "shadow", .02), 0);
    ck_assert_int_eq(radSetOracleParameter(w.oracle, "min_share", 1e-4), 0);
    return w;
}

static void end(struct work *w)
{
    radReleaseOracle(w->oracle);
    radReleaseScene(w->scene);
    radReleaseDevice(w->device);
}

static RadExchange compute(const struct work *w, struct run *r, struct RadExchangeOptions how)
{
    const struct RadExchangeState state = {.read = r->from ? read_run : NULL,
                                           .asked = r->stop_at ? ask_run : NULL,
                                           .write = r->to ? write_run : NULL,
                                           .user = r};
    how.tolerance = how.tolerance > 0 ? how.tolerance : TOLERANCE;
    how.state = &state;
    radSetDeviceProgressFunction(w->device, watch, r);
    return radNewExchange(w->scene, w->oracle, &how);
}

/* What there is to compare of a run that came to its end. */
struct result {
    double rows[FACES][FACES];
    struct RadExchangeReport report;
};

static void result_of(RadExchange x, struct result *result)
{
    memset(result, 0, sizeof *result);
    for (uint32_t i = 0; i < scene.faces; i++)
        ck_assert_double_ge(radGetExchangeRow(x, i, result->rows[i]), 0);
    radGetExchangeReport(x, &result->report);
    memset(&result->report.seconds, 0, sizeof result->report.seconds);
}

/* A run on so many threads, from a state (NULL: the start), that is put down the `stop_at`th time
 * that it can be. Returns 1 when it came to its end before, with the result. */
static int run_on(int threads, const struct kept *from, int stop_at, struct kept *to,
                  struct result *result)
{
    struct work w = begin(threads);
    struct run r = {.from = from, .to = to, .stop_at = stop_at};
    RadExchange x = compute(&w, &r, (struct RadExchangeOptions){0});
    ck_assert_int_eq(r.resumed, from != NULL);
    if (x) {
        result_of(x, result);
    } else {
        ck_assert_int_eq(radGetDeviceError(w.device), RAD_ERROR_CANCELLED);
        ck_assert_int_eq(r.whole, 1);
    }
    radReleaseExchange(x);
    end(&w);
    return x != NULL;
}

static struct result first, second;

static void compare(const char *what, int stop)
{
    ck_assert_msg(memcmp(&first, &second, sizeof first) == 0, "%s %d", what, stop);
}

/* Put down at each place once, on one, two or three threads, and gone on with on another number. */
START_TEST(test_any_place)
{
    struct state_head most = {.splits = 0};
    make_room_with_plates();
    ck_assert_int_eq(run_on(1, NULL, 0, NULL, &first), 1);
    int stop = 1, in_values = 0;
    for (;; stop += under_sanitizers() ? 4 : 1) {
        struct kept state = {0};
        const int done = run_on(1 + stop % 3, NULL, stop, &state, &second);
        if (!done) {
            const struct state_head h = head_of(&state);
            most.splits = h.splits > most.splits ? h.splits : most.splits;
            most.queue = h.queue > most.queue ? h.queue : most.queue;
            most.lists = h.lists > most.lists ? h.lists : most.lists;
            in_values += h.blocks > 0;
            ck_assert_int_eq(run_on(1 + (stop + 1) % 3, &state, 0, NULL, &second), 1);
        }
        compare("stop", stop);
        forget(&state);
        if (done)
            break;
    }
    ck_assert_int_gt(stop, 8);
    ck_assert_int_gt(in_values, 2);
    ck_assert_uint_gt(most.queue, 100);
    ck_assert_uint_gt(most.lists, 10);
    ck_assert_uint_gt(most.splits, 1);
}
END_TEST

/* Upright sides over n corners, counter-clockwise from above, from the floor up, and a top. */
static void stand(const double (*p)[2], uint32_t n, double tall)
{
    for (uint32_t i = 0; i < n; i++) {
        const double *a = p[i], *b = p[(i + 1) % n];
        rectangle((double[3]){a[0], a[1], 0}, (double[3]){b[0] - a[0], b[1] - a[1], 0},
                  (double[3]){0, 0, tall});
    }
    for (uint32_t i = 0; i < n; i++)
        corner(p[i][0], p[i][1], tall);
    end_face(n);
}

/* A floor on which a box stands, of which is known how much it covers, and something small that is
 * not convex, of which it is not: the row lacks more than is known, and is looked at again. */
static void make_row_that_is_off(void)
{
    static const double size[3] = {1, 1, 1}, x = 0.05, y = 0.05,
                        block[4][2] = {{0.1, 0.1}, {0.6, 0.1}, {0.6, 0.6}, {0.1, 0.6}};
    const double a = sqrt(0.002 / (3 * CELLS * CELLS)),
                 angle[6][2] = {{x, y},         {x + 2 * a, y},     {x + 2 * a, y + a},
                                {x + a, y + a}, {x + a, y + 2 * a}, {x, y + 2 * a}};
    clear();
    room(size, 0);
    stand(block, 4, 0.3);
    stand(angle, 6, 0.1);
}

/* Put down while rows that were off are looked at again: nothing of that is in it. */
START_TEST(test_again)
{
    struct kept state = {0};
    struct run down = {.to = &state, .stop_at = 1, .stop_in = "again"}, on = {.from = &state},
               whole = {0};
    make_row_that_is_off();
    struct work w = {.device = radNewDevice(&(struct RadDeviceOptions){.threads = 2})};
    const struct RadExchangeOptions how = {.tolerance = 3e-4};
    w.scene = scene_on(w.device);
    RadExchange x = compute(&w, &whole, how);
    ck_assert_ptr_nonnull(x);
    result_of(x, &first);
    radReleaseExchange(x);
    ck_assert_ptr_null(compute(&w, &down, how));
    ck_assert_int_eq(radGetDeviceError(w.device), RAD_ERROR_CANCELLED);
    ck_assert_int_eq(down.whole, 1);
    x = compute(&w, &on, how);
    ck_assert_ptr_nonnull(x);
    result_of(x, &second);
    radReleaseExchange(x);
    compare("again", 1);
    forget(&state);
    end(&w);
}
END_TEST

/* Put down at every place. */
START_TEST(test_every_place)
{
    struct kept state = {0}, next = {0};
    make_room_with_plates();
    ck_assert_int_eq(run_on(2, NULL, 0, NULL, &first), 1);
    int runs = 1;
    const int each = under_sanitizers() ? 4 : 1; /* so many places further */
    while (!run_on(1 + runs % 3, runs > 1 ? &state : NULL, each, &next, &second)) {
        forget(&state);
        state = next;
        next = (struct kept){0};
        runs++;
        ck_assert_int_lt(runs, 10000);
    }
    compare("runs", runs);
    ck_assert_int_gt(runs, 8);
    forget(&state);
}
END_TEST

/* A state of the refinement in its midst, with lists, or one with values. */
static struct kept some_state(int with_values)
{
    struct kept best = {0}, state = {0};
    uint64_t most = 0;
    const int step = under_sanitizers() ? 3 : 1;
    for (int stop = 1; !run_on(1, NULL, stop, &state, &second); stop += step) {
        const struct state_head h = head_of(&state);
        const uint64_t counts = with_values ? h.values : h.lists;
        if (counts > most) {
            forget(&best);
            best = state;
            state = (struct kept){0};
            most = counts;
        }
        forget(&state);
    }
    ck_assert_uint_gt(most, 0);
    return best;
}

/* It is refused for that cause, if any is named, and nothing is left. */
static void refused(const struct work *w, const struct kept *state, struct RadExchangeOptions how,
                    const char *cause, size_t place)
{
    struct run r = {.from = state};
    RadExchange x = compute(w, &r, how);
    ck_assert_msg(x == NULL, "place %zu", place);
    const char *message = radGetDeviceErrorMessage(w->device);
    ck_assert_msg(!cause || strstr(message, cause), "place %zu: %s", place, message);
    ck_assert_int_eq(radGetDeviceError(w->device), RAD_ERROR_INVALID_ARGUMENT);
}

/* One bit is wrong, or all that is behind a place is missing, or there is more. */
START_TEST(test_damaged)
{
    make_room_with_plates();
    struct kept state = some_state(_i);
    struct work w = begin(1);
    const struct RadExchangeOptions plain = {0};
    const size_t of_head = under_sanitizers() ? 4 : 1;
    const size_t step = thorough() ? 1 : under_sanitizers() ? 4001 : 131;
    for (size_t i = 0; i < state.size; i += i < sizeof(struct state_head) + 16 ? of_head : step) {
        state.bytes[i] ^= (unsigned char)(1 << i % 8);
        refused(&w, &state, plain, NULL, i);
        state.bytes[i] ^= (unsigned char)(1 << i % 8);
        struct kept part = {state.bytes, i, i};
        refused(&w, &part, plain, i < 6 ? "is no state of view factors" : "is cut short", i);
    }
    struct kept more = {calloc(state.size + 1, 1), state.size + 1, state.size + 1};
    memcpy(more.bytes, state.bytes, state.size);
    refused(&w, &more, plain, "is damaged", state.size);
    forget(&more);
    forget(&state);
    end(&w);
}
END_TEST

/* Of other work; what the state does not depend on may be other. */
START_TEST(test_other_work)
{
    make_room_with_plates();
    struct kept state = some_state(1);
    struct work w = begin(1);
    const struct RadExchangeOptions finer = {.tolerance = TOLERANCE / 2}, fewer = {.rows = 3},
                                    stream = {.stream = 1}, plain = {0},
                                    closed = {.closure = RAD_CLOSURE_RECIPROCAL, .keep = 1};
    refused(&w, &state, finer, "is of another tolerance", 0);
    refused(&w, &state, fewer, "is of other rows", 0);
    refused(&w, &state, stream, "is of a matrix, not of a product", 0);
    struct run r = {.from = &state};
    RadExchange x = compute(&w, &r, closed);
    ck_assert_ptr_nonnull(x);
    radReleaseExchange(x);
    ck_assert_int_eq(radSetOracleParameter(w.oracle, "exact", .01), 0);
    refused(&w, &state, plain, "is of another oracle, or of one with other parameters", 0);
    end(&w);
    scene.positions[0] = nextafter(scene.positions[0], 1);
    w = begin(1);
    refused(&w, &state, plain, "is of another scene", 0);
    end(&w);
    forget(&state);
}
END_TEST

/* Who was to have it takes no more: the work goes on, and a whole state is never said to be. */
static int refuse_more(void *user, const void *bytes, size_t size)
{
    struct run *r = user;
    (void)size;
    r->whole = !bytes;
    return 1;
}

static enum RadStateWish ask_often(void *user)
{
    struct run *r = user;
    r->asked++;
    return RAD_STATE_SAVE;
}

START_TEST(test_full_disk)
{
    make_room_with_plates();
    ck_assert_int_eq(run_on(1, NULL, 0, NULL, &first), 1);
    struct work w = begin(2);
    struct run r = {.whole = 0};
    const struct RadExchangeState state = {.asked = ask_often, .write = refuse_more, .user = &r};
    const struct RadExchangeOptions how = {.tolerance = TOLERANCE, .state = &state};
    RadExchange x = radNewExchange(w.scene, w.oracle, &how);
    ck_assert_ptr_nonnull(x);
    ck_assert_int_gt(r.asked, 8);
    ck_assert_int_eq(r.whole, 0);
    result_of(x, &second);
    compare("asked", r.asked);
    radReleaseExchange(x);
    end(&w);
}
END_TEST

/* Anything may stand in a state whose checks are right: it is refused, or gone on with. */
START_TEST(test_unbelieved)
{
    make_room_with_plates();
    const struct kept state = some_state(_i);
    struct kept made = {malloc(state.size), state.size, state.size};
    struct work w = begin(1);
    const int runs = thorough() ? 20000 : under_sanitizers() ? 10 : 400;
    int believed = 0;
    for (int i = 0; i < runs; i++) {
        memcpy(made.bytes, state.bytes, state.size);
        const int changes = 1 + i % 3;
        for (int k = 0; k < changes; k++) {
            uint64_t random = hash64((uint64_t)i * 16 + (uint64_t)k * 4 + 1);
            const size_t name = offsetof(struct state_head, splits),
                         at = name + random % (state.size - name - 8);
            random = hash64(random);
            if (random % 4 == 0) /* a number of any size */
                memcpy(made.bytes + at / 8 * 8, &random, 1 + random / 4 % 8);
            else if (random % 4 == 1)
                made.bytes[at] ^= (unsigned char)(random >> 8);
            else /* one that is near */
                made.bytes[at / 4 * 4] = (unsigned char)(made.bytes[at / 4 * 4] + 1 + random % 3);
        }
        const struct state_head h = head_of(&made);
        struct run r = {.from = &made, .stop_at = 1, .mend = 1};
        r.check[0] = sizeof h;
        r.check[1] = sizeof h + 8 + 4 * h.splits + h.elements + 4 * h.splits
                     + sizeof(struct link) * h.links + sizeof(struct state_pair) * h.queue
                     + sizeof(struct state_list) * h.lists;
        r.check[2] = state.size - 8;
        RadExchange x = compute(&w, &r, (struct RadExchangeOptions){0});
        believed += x || r.asked;
        radReleaseExchange(x);
        (void)radGetDeviceError(w.device);
    }
    ck_assert_int_gt(believed, runs / 50);
    end(&w);
    forget(&made);
    free(state.bytes);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("exchange state");
    TCase *tcase = tcase_create("exchange state");
    tcase_set_timeout(tcase, thorough() ? 600 : 60);
    tcase_add_test(tcase, test_any_place);
    tcase_add_test(tcase, test_every_place);
    tcase_add_test(tcase, test_again);
    tcase_add_loop_test(tcase, test_damaged, 0, 2);
    tcase_add_test(tcase, test_other_work);
    tcase_add_test(tcase, test_full_disk);
    tcase_add_loop_test(tcase, test_unbelieved, 0, 2);
    suite_add_tcase(suite, tcase);
    return suite_failures(suite) != 0;
}
