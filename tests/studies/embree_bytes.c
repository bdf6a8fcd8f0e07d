/* embree_bytes.c - what Embree's structure over a scene takes, built as runtime/visibility/rays.c
 * builds it:
 *
 *     embree_bytes <SCENE.obj
 *
 * writes how many quads there are, and the bytes that Embree holds and held at the most meanwhile,
 * of which Embree tells. Of the scene the lines `v` are read, four for each quad
 * (room_of_boxes.awk).
 * SPDX-License-Identifier: MIT */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include "util/array.h"
#include "util/embree.h"

static _Atomic ssize_t held, most;

static bool watch(void *nobody, ssize_t bytes, bool before)
{
    (void)nobody, (void)before;
    const ssize_t now = atomic_fetch_add(&held, bytes) + bytes;
    ssize_t so_far = atomic_load(&most);
    while (now > so_far && !atomic_compare_exchange_weak(&most, &so_far, now))
        ;
    return true;
}

int main(void)
{
    char line[256];
    float *corner = NULL;
    size_t count = 0, capacity = 0;
    while (fgets(line, sizeof line, stdin)) {
        if (line[0] != 'v' || line[1] != ' ')
            continue;
        if (array_reserve(&corner, count + 3, &capacity, sizeof *corner) < 0)
            return fputs("embree_bytes: out of memory\n", stderr), 1;
        if (sscanf(line + 2, "%f %f %f", &corner[count], &corner[count + 1], &corner[count + 2])
            != 3)
            return fputs("embree_bytes: three numbers are missing\n", stderr), 1;
        count += 3;
    }
    const size_t quads = count / 12;
    RTCDevice device = rtcNewDevice(NULL);
    rtcSetDeviceMemoryMonitorFunction(device, watch, NULL);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_QUAD);
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 3 * sizeof *vertices, 4 * quads);
    unsigned *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT4, 4 * sizeof *indices, quads);
    if (!quads || !vertices || !indices)
        return fputs("embree_bytes: no quads, or no memory for them\n", stderr), 1;
    for (size_t i = 0; i < 12 * quads; i++)
        vertices[i] = corner[i];
    for (size_t i = 0; i < 4 * quads; i++)
        indices[i] = (unsigned)i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    printf("quads %zu\nheld %zd\nmost %zd\n", quads, (ssize_t)atomic_load(&held),
           (ssize_t)atomic_load(&most));
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
    free(corner);
    return 0;
}
