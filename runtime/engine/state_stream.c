/* state_stream.c - see state_stream.h.
 * SPDX-License-Identifier: MIT */
#include "engine/state_stream.h"

#include <stdlib.h>
#include <string.h>

#include "kernel/hash_bytes.h"
#include "util/array.h"

/* Items that an array grows by at first; then it doubles. */
enum { GROW = 1 << 12 };

static void send(struct state_out *out)
{
    if (!out->failed && out->used)
        out->failed = out->write(out->user, out->buffer, out->used) != 0;
    out->used = 0;
}

void state_put(struct state_out *out, const void *bytes, size_t size)
{
    const unsigned char *from = bytes;
    if (size)
        out->check = hash_bytes(out->check, bytes, size);
    while (size > 0 && !out->failed) {
        size_t room = sizeof out->buffer - out->used, part = size < room ? size : room;
        memcpy(out->buffer + out->used, from, part);
        out->used += part;
        from += part;
        size -= part;
        if (out->used == sizeof out->buffer)
            send(out);
    }
}

void state_put_check(struct state_out *out)
{
    const uint64_t check = out->check;
    state_put(out, &check, sizeof check);
}

int state_put_end(struct state_out *out)
{
    send(out);
    return out->failed ? -1 : 0;
}

enum state_read state_get(struct state_in *in, void *bytes, size_t size)
{
    if (!size)
        return STATE_READ;
    if (in->read(in->user, bytes, size) != size)
        return STATE_SHORT;
    in->check = hash_bytes(in->check, bytes, size);
    return STATE_READ;
}

enum state_read state_get_check(struct state_in *in)
{
    const uint64_t wanted = in->check;
    uint64_t check;
    enum state_read result = state_get(in, &check, sizeof check);
    return result ? result : check == wanted ? STATE_READ : STATE_DAMAGED;
}

enum state_read state_get_end(struct state_in *in)
{
    unsigned char byte;
    return in->read(in->user, &byte, 1) ? STATE_DAMAGED : STATE_READ;
}

enum state_read state_get_array(struct state_in *in, void *array, uint64_t count, size_t size)
{
    enum state_read result = STATE_READ;
    char *items = NULL;
    size_t have = 0, capacity = 0;
    while (have < count && result == STATE_READ) {
        size_t more = have > GROW ? have : GROW;
        more = more < count - have ? more : (size_t)(count - have);
        if (array_reserve(&items, have + more, &capacity, size) < 0)
            result = STATE_MEMORY;
        else
            result = state_get(in, items + have * size, more * size);
        have += more;
    }
    memcpy(array, &items, sizeof items);
    return result;
}
