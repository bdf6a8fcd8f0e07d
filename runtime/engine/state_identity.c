/* state_identity.c - see state_identity.h.
 * SPDX-License-Identifier: MIT */
#include "engine/state_identity.h"

#include <string.h>

#include "kernel/hash_bytes.h"

/* The hash of a text behind another hash; NULL: the hash as it is. */
static uint64_t mix_text(uint64_t hash, const char *text)
{
    return text ? hash_bytes(hash + 1, text, strlen(text)) : hash;
}

uint64_t state_identity_faces(const struct hierarchy *h)
{
    uint64_t hash = hash_bytes(h->face_count, &h->built, sizeof h->built);
    for (uint32_t i = 0; i < h->face_count; i++) {
        const struct face *f = &h->faces[i];
        const uint32_t facts[4] = {f->vertices, f->input, f->back, f->black};
        hash = hash_bytes(hash, facts, sizeof facts);
        hash = hash_bytes(hash, f->vertex, f->vertices * sizeof *f->vertex);
    }
    return hash;
}

uint64_t state_identity_scene(const struct problem *p, const struct hierarchy *h)
{
    const size_t values = (size_t)h->face_count * p->bands;
    uint64_t hash = hash_bytes(state_identity_faces(h), p->exitance, values * sizeof *p->exitance);
    return hash_bytes(hash, p->reflectance, values * sizeof *p->reflectance);
}

uint64_t state_identity_version(void)
{
    return mix_text(RUNTIME_ABI, RADIOSITY_VERSION);
}

uint64_t state_identity_oracle(const struct refiner *refiner)
{
    uint64_t hash = mix_text(RUNTIME_ABI, refiner->oracle);
    hash = mix_text(hash, refiner->fingerprint);
    for (int i = 0; i < refiner->parameter_count; i++) {
        const double value = refiner_get(refiner, i);
        hash = mix_text(hash, refiner->parameters[i].name);
        hash = hash_bytes(hash, &value, sizeof value);
    }
    return hash;
}
