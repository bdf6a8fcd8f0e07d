/* path_mending.c - see path_mending.h.
 *
 * Particles go where emitters shine. Of a sky over a house next to none finds the window, and of
 * those that leave a small lamp few meet a terrain's far end; paths start on what is asked for and
 * look for the light. In a room, where light is reflected many times, it is the other way round.
 * Noise^2 times rays is what each costs: both are measured, particles by the first look that
 * mending takes anyway, paths by a block for each face. Paths know nothing of places within a face,
 * so they have to be much cheaper. A look is an eighth of what particles are to take, even where
 * these would take more rays than there are: of a meadow, where most polygons are met by none of
 * them, all rays tell next to nothing. But what is left has to be enough for paths to mend by.
 *
 * They go by a sequence, whose noise falls faster than with the root of the number: where the first
 * block says that they are cheaper, but not by how much, and more are a small part of what is to
 * come, there is a second look.
 *
 * Paths that hardly ever find the light, as of a lamp behind two bends, may have found none and
 * seem to have no noise. So what they say of all light together is held against the particles:
 * where it is farther off than the noise of both, particles go on, and where they found nothing at
 * all. The other way round particles that hardly ever find a window have no more noise than those
 * that did: so theirs is no less than it would be if paths were right. [Derived here]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include "engine/mended_error.h"
#include "engine/path_mending.h"
#include "engine/reflected_light.h"
#include "kernel/constants.h"

/* of a path, about, before any is traced, where light is hardly reflected; and times the paths
 * there are, so many at the most before it is asked again how many are wanted */
enum { RAYS_OF_PATH = 4, GROWTH = 4 };
/* of all the rays there may be, one part in so many is for a first look at the most. Chosen: paths
 * have as many left as they have looked by; of two-sided blades of grass, cut where they cross,
 * looks take a sixth to a quarter */
enum { PART = 2 };

/* Do both see the same light, and any? */
static int agree(const struct solve *s, const struct tally *particles, const struct tally *paths)
{
    double of_particles, of_paths;
    const double by_particles = reflected_light(&s->problem, particles, &of_particles),
                 by_paths = reflected_light(&s->problem, paths, &of_paths),
                 off = by_particles - by_paths;
    of_particles = fmax(of_particles, tally_power_of_one(particles) * by_paths);
    return by_paths > 0 && off * off <= PATHS_AGREE * PATHS_AGREE * (of_particles + of_paths);
}

/* Rays of a path before any is traced: two at each step, one onward and one to the light, and as
 * many steps as particles take, if these are not few because they leave the scene at once. 1.7 to
 * 1.8 times as many in rooms that reflect .3 to .95. */
static double rays_of_path(const struct tally *particles)
{
    const double count = (double)particles->particles * REPLICATES;
    return fmax(RAYS_OF_PATH, count > 0 ? 2 * (double)particles->rays / count : 0);
}

/* The paths of a first look. */
static double paths_of_look(const struct tracer *t)
{
    uint32_t faces = 0;
    for (uint32_t f = 0; f < t->hierarchy->face_count; f++)
        faces += tracer_reflectance(t, f) * tracer_surface(t, f)->area > 0;
    return (double)PATH_BLOCK * faces;
}

int path_mending_trace(struct path_tally *y, const struct solve *s, const struct tracer *t,
                       const struct tally *tally, const struct mending_goal *goal,
                       const struct watch *watch)
{
    const double most = (double)goal->most;
    double times, alone, paths = 1;
    if (mended_error_times(s, tally, goal, &times, &alone) < 0)
        return -1;
    const double cost = alone * (double)tally->rays;
    const double look = paths_of_look(t);
    if (!(fmin(cost / PATHS_LOOK, most / PART) > rays_of_path(tally) * look))
        return 0;
    if (path_tally_open(y, t, path_mending_stream(0)) < 0)
        return -1;
    for (int chosen = 0, again = 0;;) {
        const uint64_t before = y->tally.rays;
        if (path_tally_trace(y, t, s->state.irradiance, (uint64_t)paths, watch) < 0
            || mended_error_times(s, &y->tally, goal, &times, &alone) < 0)
            return -1;
        const double rays = (double)y->tally.rays;
        if (!agree(s, tally, &y->tally))
            return 0;
        const int cheap = PATHS_CHEAPER * alone * rays < cost;
        if (!chosen && !cheap
            && (again || !(alone * rays < cost)
                || !(fmin(cost, most) > PATHS_LOOK * GROWTH * rays)))
            return 0;
        chosen |= cheap;
        again = 1;
        if (!(times > 1) || rays >= 0.99 * most || y->tally.rays == before)
            return 1;
        /* each face has a block more where there is room for that: less may be none */
        const double growth = chosen ? mended_error_growth(goal, rays, GROWTH) : GROWTH;
        const double traced = (double)y->tally.particles * REPLICATES;
        paths =
            fmin(fmax(traced * fmin(1.02 * times, growth), traced + look), traced * most / rays);
    }
}
