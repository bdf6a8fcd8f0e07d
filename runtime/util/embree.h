/* embree.h - Embree 4 where it is installed, else 3; the calls in which these differ.
 * SPDX-License-Identifier: MIT */
#ifndef EMBREE_H
#define EMBREE_H

#if defined __has_include
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define EMBREE 4
#endif
#endif
#ifndef EMBREE
#include <embree3/rtcore.h>
#define EMBREE 3
#endif

#if EMBREE == 4

/* Of a scene whose rays may bring a filter. */
#define EMBREE_FILTERED RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS

/* The first hit that the filter leaves; NULL: all. */
static inline void embree_intersect(RTCScene scene, struct RTCRayHit *query,
                                    RTCFilterFunctionN filter)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.filter = filter;
    arguments.flags = filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_NONE;
    rtcIntersect1(scene, query, &arguments);
}

/* Of rays that go one way. */
static inline void embree_intersect_16(RTCScene scene, const int *valid, struct RTCRayHit16 *query,
                                       RTCFilterFunctionN filter)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.filter = filter;
    arguments.flags = filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_NONE;
    rtcIntersect16(valid, scene, query, &arguments);
}

static inline void embree_occluded(RTCScene scene, struct RTCRay *ray)
{
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcOccluded1(scene, ray, &arguments);
}

static inline void embree_occluded_16(RTCScene scene, const int *valid, struct RTCRay16 *packet)
{
    struct RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    rtcOccluded16(valid, scene, packet, &arguments);
}

#else

#define EMBREE_FILTERED RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION

static inline void embree_intersect(RTCScene scene, struct RTCRayHit *query,
                                    RTCFilterFunctionN filter)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.filter = filter;
    rtcIntersect1(scene, &context, query);
}

static inline void embree_intersect_16(RTCScene scene, const int *valid, struct RTCRayHit16 *query,
                                       RTCFilterFunctionN filter)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.filter = filter;
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, scene, &context, query);
}

static inline void embree_occluded(RTCScene scene, struct RTCRay *ray)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(scene, &context, ray);
}

static inline void embree_occluded_16(RTCScene scene, const int *valid, struct RTCRay16 *packet)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded16(valid, scene, &context, packet);
}

#endif

#endif
