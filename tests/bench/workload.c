/* The workload: positions, motion and bounces of the spheres. */
#include "tests/bench/workload.h"

#include "config/loader.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/making/scenario.h"
#include "world/making/world_build.h"
#include "world/maths/random.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"

#include <stdlib.h>
#include <string.h>

#define SPEED_MPS 16.6
#define SEED      1991u

static void take_fixed(struct engine_scene *scene)
{
    char data_dir[512];
    struct error_text error;
    struct scenario scenario;
    struct world_build built;
    if (process_data_dir(data_dir, sizeof data_dir) != 0)
        die_refused("cannot find the data; set JOLON_DATA");
    if (loader_scenario(&scenario, data_dir, NULL, NULL, 0, &error) != 0)
        die_refused("%s", error.text);
    if (world_build_make(&built, &scenario, &error) != 0)
        die_refused("%s", error.text);
    scene->fixed_count = built.counts.fixed;
    scene->fixed = malloc(built.counts.fixed * sizeof *scene->fixed);
    if (!scene->fixed)
        die_refused("out of memory");
    for (uint32_t i = 0; i < built.counts.fixed; i++)
        scene->fixed[i] = (struct engine_sphere){built.fixed[i].x, built.fixed[i].z,
                                                 (double)built.fixed[i].radius_m};
    world_build_free(&built);
    scenario_free(&scenario);
}

void workload_open(struct workload *workload, uint32_t vehicles)
{
    struct engine_scene *scene = &workload->scene;
    memset(workload, 0, sizeof *workload);
    take_fixed(scene);
    scene->body = calloc((size_t)vehicles + 1, sizeof *scene->body);
    if (!scene->body)
        die_refused("out of memory");
    scene->bodies = vehicles;
    workload_rewind(workload);
}

void workload_close(struct workload *workload)
{
    free(workload->scene.fixed);
    free(workload->scene.body);
}

static double uniform(uint64_t *state, double high)
{
    *state += 0x9e3779b97f4a7c15u;
    return high * ((double)(random_mix(*state) >> 11) * 0x1.0p-53);
}

void workload_rewind(struct workload *workload)
{
    uint64_t random = SEED;
    for (uint32_t i = 0; i < workload->scene.bodies; i++) {
        struct engine_body *body = &workload->scene.body[i];
        body->x = uniform(&random, WORLD_SIDE_DEFAULT_M);
        body->z = uniform(&random, WORLD_SIDE_DEFAULT_M);
        double speed = uniform(&random, SPEED_MPS), sine, cosine;
        maths_sincos(uniform(&random, TWO_PI), &sine, &cosine);
        body->vx = speed * cosine;
        body->vz = speed * sine;
    }
    workload->contacts = workload->fixed_contacts = 0;
}

/* Bounces a body along the line of centres from a to b. */
static void bounce(struct workload *workload, struct engine_touch touch)
{
    const struct engine_scene *scene = &workload->scene;
    struct engine_body *a = &scene->body[touch.a], *b = NULL;
    double x, z, vx = 0.0, vz = 0.0;
    if (touch.b & ENGINE_FIXED) {
        const struct engine_sphere *ball = &scene->fixed[touch.b & ~ENGINE_FIXED];
        x = ball->x;
        z = ball->z;
    } else {
        b = &scene->body[touch.b];
        x = b->x;
        z = b->z;
        vx = b->vx;
        vz = b->vz;
    }
    x -= a->x;
    z -= a->z;
    double length = sqrt(x * x + z * z);
    double nearing = ((a->vx - vx) * x + (a->vz - vz) * z) / length;
    if (!(nearing > 0.0))
        return;
    double change = (b ? nearing : 2.0 * nearing) / length;
    a->vx -= change * x;
    a->vz -= change * z;
    if (b) {
        b->vx += change * x;
        b->vz += change * z;
    }
    workload->contacts++;
    workload->fixed_contacts += b == NULL;
}

static void move_axis(double *at, double *speed)
{
    *at += *speed * ENGINE_DT_S;
    if ((*at < 0.0 && *speed < 0.0) || (*at > WORLD_SIDE_DEFAULT_M && *speed > 0.0))
        *speed = -*speed;
}

static int by_bodies(const void *p, const void *q)
{
    const struct engine_touch *a = p, *b = q;
    if (a->a != b->a)
        return a->a < b->a ? -1 : 1;
    return (a->b > b->b) - (a->b < b->b);
}

void workload_step(struct workload *workload, struct engine_touches *touches)
{
    /* The speed of a body that touches two others depends on which of them is answered first. */
    if (touches->count > 0)
        qsort(touches->touch, touches->count, sizeof *touches->touch, by_bodies);
    for (size_t i = 0; i < touches->count; i++)
        bounce(workload, touches->touch[i]);
    for (uint32_t i = 0; i < workload->scene.bodies; i++) {
        struct engine_body *body = &workload->scene.body[i];
        move_axis(&body->x, &body->vx);
        move_axis(&body->z, &body->vz);
    }
}
