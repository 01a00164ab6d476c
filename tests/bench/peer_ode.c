/* ODE as an engine: geometries only, all in one sweep-and-prune space. Category bits prevent
 * comparisons between fixed objects. Other arrangements are slower: with a space for each group ODE
 * compares all pairs between them (170 ms for 500 vehicles), and its hash space takes 260 ms for
 * them and aborts from 100,000 on. */
#include "tests/bench/engine.h"

#include "ipc/process/log.h"

#include <ode/ode.h>
#include <stdlib.h>

struct ode {
    const struct engine_scene *scene;
    dSpaceID space;
    dGeomID *geom; /* [bodies] */
    struct engine_touches *touches;
};

#define BIT_MOVING 1u
#define BIT_FIXED  2u

static dGeomID add(dSpaceID space, double radius, double x, double z, uint32_t name)
{
    bool stands = name & ENGINE_FIXED;
    dGeomID geom = dCreateSphere(space, radius);
    dGeomSetPosition(geom, x, 0.0, z);
    dGeomSetCategoryBits(geom, stands ? BIT_FIXED : BIT_MOVING);
    dGeomSetCollideBits(geom, stands ? BIT_MOVING : BIT_MOVING | BIT_FIXED);
    dGeomSetData(geom, (void *)(uintptr_t)name);
    return geom;
}

static void *ode_open(const struct engine_scene *scene, uint32_t threads)
{
    struct ode *self = calloc(1, sizeof *self);
    dGeomID *geom = calloc((size_t)scene->bodies + 1, sizeof *geom);
    (void)threads;
    if (!self || !geom)
        die_refused("out of memory");
    dInitODE2(0);
    dSpaceID space = dSweepAndPruneSpaceCreate(NULL, dSAP_AXES_XZY);
    *self = (struct ode){.scene = scene, .space = space, .geom = geom};
    for (uint32_t i = 0; i < scene->fixed_count; i++) {
        const struct engine_sphere *ball = &scene->fixed[i];
        add(space, ball->radius_m, ball->x, ball->z, i | ENGINE_FIXED);
    }
    for (uint32_t i = 0; i < scene->bodies; i++)
        geom[i] = add(space, ENGINE_RADIUS_M, scene->body[i].x, scene->body[i].z, i);
    return self;
}

static void ode_close(void *handle)
{
    struct ode *self = handle;
    dSpaceDestroy(self->space);
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
        engine_touches_add(self->touches, a, b);
}

static void ode_detect(void *handle, struct engine_touches *touches)
{
    struct ode *self = handle;
    self->touches = touches;
    dSpaceCollide(self->space, self, near);
}

const struct engine engine_ode = {"ode", "sap", 1, ode_open, ode_close, ode_place, ode_detect};
