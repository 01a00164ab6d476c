/* ODE as an engine: geometries only, those that stand in a space of their own. */
#include "bench/engine.h"

#include "ipc/log.h"

#include <ode/ode.h>
#include <stdlib.h>

/* Cells of the hash space: from 8 m, the power of two above a sphere of 3 m, to 64 m. */
#define LEVEL_LEAST 3
#define LEVEL_MOST  6

struct ode {
    const struct engine_scene *scene;
    dSpaceID moving, fixed;
    dGeomID *geom; /* [bodies] */
    struct engine_touches *touches;
};

static dGeomID add(dSpaceID space, double radius, double x, double z, uint32_t name)
{
    dGeomID geom = dCreateSphere(space, radius);
    dGeomSetPosition(geom, x, 0.0, z);
    dGeomSetData(geom, (void *)(uintptr_t)name);
    return geom;
}

static void *open_with(const struct engine_scene *scene, dSpaceID moving, dSpaceID fixed)
{
    struct ode *self = calloc(1, sizeof *self);
    dGeomID *geom = calloc((size_t)scene->bodies + 1, sizeof *geom);
    if (!self || !geom)
        die_refused("out of memory");
    *self = (struct ode){.scene = scene, .moving = moving, .fixed = fixed, .geom = geom};
    for (uint32_t i = 0; i < scene->fixed_count; i++) {
        const struct engine_ball *ball = &scene->fixed[i];
        add(fixed, ball->radius_m, ball->x, ball->z, i | ENGINE_FIXED);
    }
    for (uint32_t i = 0; i < scene->bodies; i++)
        geom[i] = add(moving, ENGINE_RADIUS_M, scene->body[i].x, scene->body[i].z, i);
    return self;
}

static void *open_hash(const struct engine_scene *scene, uint32_t threads)
{
    (void)threads;
    dInitODE2(0);
    dSpaceID moving = dHashSpaceCreate(NULL), fixed = dHashSpaceCreate(NULL);
    dHashSpaceSetLevels(moving, LEVEL_LEAST, LEVEL_MOST);
    dHashSpaceSetLevels(fixed, LEVEL_LEAST, LEVEL_MOST);
    return open_with(scene, moving, fixed);
}

static void *open_sap(const struct engine_scene *scene, uint32_t threads)
{
    (void)threads;
    dInitODE2(0);
    return open_with(scene, dSweepAndPruneSpaceCreate(NULL, dSAP_AXES_XZY),
                     dSweepAndPruneSpaceCreate(NULL, dSAP_AXES_XZY));
}

static void ode_close(void *handle)
{
    struct ode *self = handle;
    dSpaceDestroy(self->moving);
    dSpaceDestroy(self->fixed);
    dCloseODE();
    free(self->geom);
    free(self);
}

static void ode_place(void *handle)
{
    struct ode *self = handle;
    for (uint32_t i = 0; i < self->scene->bodies; i++)
        dGeomSetPosition(self->geom[i], self->scene->body[i].x, 0.0, self->scene->body[i].z);
}

static void near(void *handle, dGeomID p, dGeomID q)
{
    struct ode *self = handle;
    uint32_t a = (uint32_t)(uintptr_t)dGeomGetData(p), b = (uint32_t)(uintptr_t)dGeomGetData(q);
    if (a & ENGINE_FIXED) {
        uint32_t swap = a;
        a = b;
        b = swap;
    }
    if (engine_touching(self->scene, a, b))
        engine_found(self->touches, a, b);
}

static void ode_detect(void *handle, struct engine_touches *touches)
{
    struct ode *self = handle;
    self->touches = touches;
    dSpaceCollide(self->moving, self, near);
    dSpaceCollide2((dGeomID)self->moving, (dGeomID)self->fixed, self, near);
}

const struct engine engine_ode_hash = {"ode",     "hash",    1,         open_hash,
                                       ode_close, ode_place, ode_detect};
const struct engine engine_ode_sap = {"ode", "sap", 1, open_sap, ode_close, ode_place, ode_detect};
