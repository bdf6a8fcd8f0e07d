/* state_stream.h - bytes of a state on their way out or in, in pieces, with checks between them.
 *
 * A check is a hash of all that stands before it. Each word changes it in a way that no later word
 * undoes, so a change of one word never passes for another. Whoever reads makes the same calls as
 * whoever wrote; a piece may be read in several if all but the last are a multiple of 8 bytes.
 * SPDX-License-Identifier: MIT */
#ifndef STATE_STREAM_H
#define STATE_STREAM_H

#include <stddef.h>
#include <stdint.h>

enum { STATE_BUFFER = 1 << 16 };

struct state_out {
    int (*write)(void *user, const void *bytes, size_t size); /* nonzero: no more */
    void *user;
    uint64_t check;
    size_t used;
    int failed;
    unsigned char buffer[STATE_BUFFER];
};

struct state_in {
    size_t (*read)(void *user, void *bytes, size_t size); /* fewer than asked for: the end */
    void *user;
    uint64_t check;
};

/* What reading comes to. */
enum state_read { STATE_READ, STATE_SHORT, STATE_DAMAGED, STATE_MEMORY };

void state_put(struct state_out *out, const void *bytes, size_t size);
void state_put_check(struct state_out *out);
/* What is still held goes out. Returns 0, or -1 when the writer wanted no more. */
int state_put_end(struct state_out *out);

enum state_read state_get(struct state_in *in, void *bytes, size_t size);
/* SHORT, DAMAGED: what was read is not what was written. */
enum state_read state_get_check(struct state_in *in);
/* DAMAGED: there is more. */
enum state_read state_get_end(struct state_in *in);

/* `count` items of `size` bytes in memory that grows as they come, so that a count that is none
 * takes no more than twice what there is: *array, the caller's to free, also on failure. */
enum state_read state_get_array(struct state_in *in, void *array, uint64_t count, size_t size);

#endif
