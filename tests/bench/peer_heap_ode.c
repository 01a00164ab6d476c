/* ODE as an engine of the benchmark of heaps: boxes on a plane, with its defaults and its
 * iterative solver. */
#include "tests/bench/heap_engine.h"

#include "ipc/process/log.h"

#include <math.h>
#include <ode/ode.h>
#include <stdlib.h>
#include <string.h>

#define CONTACTS_MOST 8 /* of two geometries */

struct ode {
    const struct heap_tanks *tanks;
    dWorldID world;
    dSpaceID space;
    dJointGroupID contacts;
    dBodyID *body; /* [tanks] */
    struct heap_look touching;
};

static void add_tank(struct ode *self, uint32_t i)
{
    const struct heap_tanks *tanks = self->tanks;
    const struct heap_place *place = &tanks->place[i];
    const double *half = tanks->half_m;
    dMass mass;
    dMatrix3 turn;
    dBodyID body = dBodyCreate(self->world);
    dMassSetBoxTotal(&mass, tanks->mass_kg, 2.0 * half[0], 2.0 * half[1], 2.0 * half[2]);
    dBodySetMass(body, &mass);
    dBodySetPosition(body, place->x, half[1], place->z);
    dRFrom2Axes(turn, place->forward_x, 0.0, place->forward_z, 0.0, 1.0, 0.0);
    dBodySetRotation(body, turn);
    dBodySetLinearVel(body, HEAP_SPEED_MPS * place->forward_x, 0.0,
                      HEAP_SPEED_MPS * place->forward_z);
    dBodySetData(body, (void *)(uintptr_t)i);
    dGeomSetBody(dCreateBox(self->space, 2.0 * half[0], 2.0 * half[1], 2.0 * half[2]), body);
    self->body[i] = body;
}

static void *ode_open(const struct heap_tanks *tanks, uint32_t threads)
{
    struct ode *self = calloc(1, sizeof *self);
    (void)threads;
    if (!self || !(self->body = calloc(tanks->count, sizeof(dBodyID))))
        die_refused("out of memory");
    dInitODE2(0);
    self->tanks = tanks;
    self->world = dWorldCreate();
    self->space = dHashSpaceCreate(NULL);
    self->contacts = dJointGroupCreate(0);
    dWorldSetGravity(self->world, 0.0, -HEAP_GRAVITY, 0.0);
    dCreatePlane(self->space, 0.0, 1.0, 0.0, 0.0);
    for (uint32_t i = 0; i < tanks->count; i++)
        add_tank(self, i);
    return self;
}

static void ode_close(void *handle)
{
    struct ode *self = handle;
    dJointGroupDestroy(self->contacts);
    dSpaceDestroy(self->space);
    dWorldDestroy(self->world);
    dCloseODE();
    free(self->touching.pair);
    free(self->body);
    free(self);
}

static void ode_drive(void *handle, bool push)
{
    struct ode *self = handle;
    for (uint32_t i = 0; i < self->tanks->count && push; i++) {
        const dReal *at = dBodyGetPosition(self->body[i]);
        double force = heap_engine_push(self->tanks), away = hypot(at[0], at[2]);
        if (away > 0.0)
            dBodyAddForce(self->body[i], -force * at[0] / away, 0.0, -force * at[2] / away);
    }
}

static void collide(void *handle, dGeomID p, dGeomID q)
{
    struct ode *self = handle;
    dContact contact[CONTACTS_MOST];
    dBodyID a = dGeomGetBody(p), b = dGeomGetBody(q);
    int count = dCollide(p, q, CONTACTS_MOST, &contact[0].geom, sizeof contact[0]);
    for (int i = 0; i < count; i++) {
        memset(&contact[i].surface, 0, sizeof contact[i].surface);
        contact[i].surface.mu = HEAP_FRICTION;
        contact[i].surface.mode = dContactApprox1;
        dJointAttach(dJointCreateContact(self->world, self->contacts, &contact[i]), a, b);
    }
    if (count > 0 && a && b)
        heap_look_add(&self->touching, (uint32_t)(uintptr_t)dBodyGetData(a),
                      (uint32_t)(uintptr_t)dBodyGetData(b));
}

static void ode_step(void *handle)
{
    struct ode *self = handle;
    self->touching.pairs = 0;
    dSpaceCollide(self->space, self, collide);
    dWorldQuickStep(self->world, HEAP_DT_S);
    dJointGroupEmpty(self->contacts);
}

static void ode_look(void *handle, struct heap_look *look)
{
    struct ode *self = handle;
    for (uint32_t i = 0; i < self->tanks->count; i++) {
        const dReal *at = dBodyGetPosition(self->body[i]), *turn = dBodyGetRotation(self->body[i]);
        const dReal *v = dBodyGetLinearVel(self->body[i]);
        look->body[i] = (struct heap_body){.at = {at[0], at[1], at[2]},
                                           .forward = {turn[0], turn[4], turn[8]},
                                           .up = {turn[1], turn[5], turn[9]},
                                           .right = {turn[2], turn[6], turn[10]},
                                           .speed_mps = hypot(hypot(v[0], v[1]), v[2])};
    }
    for (size_t i = 0; i < self->touching.pairs; i++)
        heap_look_add(look, self->touching.pair[i].a, self->touching.pair[i].b);
}

const struct heap_engine heap_ode = {.name = "ode",
                                     .threads = 1,
                                     .boxes = true,
                                     .open = ode_open,
                                     .close = ode_close,
                                     .drive = ode_drive,
                                     .step = ode_step,
                                     .look = ode_look};
