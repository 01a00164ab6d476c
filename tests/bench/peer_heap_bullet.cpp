// Bullet as an engine of the benchmark of heaps: boxes on a plane, with its defaults.
#include "tests/bench/heap_engine.h"

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

namespace
{

struct bullet {
    const heap_tanks *tanks;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btDbvtBroadphase broadphase;
    btSequentialImpulseConstraintSolver solver;
    btDiscreteDynamicsWorld world;
    btStaticPlaneShape plane;
    btBoxShape box;
    std::unique_ptr<btRigidBody> ground;
    std::vector<std::unique_ptr<btRigidBody>> body;

    explicit bullet(const heap_tanks *of)
        : tanks(of), dispatcher(&configuration),
          world(&dispatcher, &broadphase, &solver, &configuration), plane(btVector3(0, 1, 0), 0),
          box(btVector3(btScalar(of->half_m[0]), btScalar(of->half_m[1]), btScalar(of->half_m[2])))
    {
    }
};

std::unique_ptr<btRigidBody> make(btCollisionShape *shape, double mass_kg)
{
    btVector3 inertia(0, 0, 0);
    if (mass_kg > 0.0)
        shape->calculateLocalInertia(btScalar(mass_kg), inertia);
    btRigidBody::btRigidBodyConstructionInfo info(btScalar(mass_kg), nullptr, shape, inertia);
    info.m_friction = btSqrt(btScalar(HEAP_FRICTION)); // Bullet multiplies that of both bodies.
    return std::make_unique<btRigidBody>(info);
}

void add_tank(bullet *self, uint32_t i)
{
    const heap_place &place = self->tanks->place[i];
    btVector3 forward(btScalar(place.forward_x), 0, btScalar(place.forward_z)), up(0, 1, 0);
    btVector3 right = forward.cross(up);
    btMatrix3x3 turn(forward.x(), up.x(), right.x(), forward.y(), up.y(), right.y(), forward.z(),
                     up.z(), right.z());
    btVector3 at(btScalar(place.x), btScalar(self->tanks->half_m[1]), btScalar(place.z));
    auto body = make(&self->box, self->tanks->mass_kg);
    body->setWorldTransform(btTransform(turn, at));
    body->setInterpolationWorldTransform(body->getWorldTransform());
    body->setLinearVelocity(forward * btScalar(HEAP_SPEED_MPS));
    body->setUserIndex(int(i));
    self->world.addRigidBody(body.get());
    self->body.push_back(std::move(body));
}

void *bullet_open(const heap_tanks *tanks, uint32_t)
{
    bullet *self = new bullet(tanks);
    self->world.setGravity(btVector3(0, btScalar(-HEAP_GRAVITY), 0));
    self->ground = make(&self->plane, 0.0);
    self->ground->setUserIndex(-1);
    self->world.addRigidBody(self->ground.get());
    for (uint32_t i = 0; i < tanks->count; i++)
        add_tank(self, i);
    return self;
}

void bullet_close(void *handle)
{
    bullet *self = static_cast<bullet *>(handle);
    for (auto &body : self->body)
        self->world.removeRigidBody(body.get());
    self->world.removeRigidBody(self->ground.get());
    delete self;
}

void bullet_drive(void *handle, bool push)
{
    bullet *self = static_cast<bullet *>(handle);
    if (!push)
        return;
    for (auto &body : self->body) {
        btVector3 inwards = -body->getWorldTransform().getOrigin();
        inwards.setY(0);
        if (inwards.fuzzyZero())
            continue;
        body->activate();
        body->applyCentralForce(inwards.normalized() * btScalar(heap_engine_push(self->tanks)));
    }
}

void bullet_step(void *handle)
{
    static_cast<bullet *>(handle)->world.stepSimulation(btScalar(HEAP_DT_S), 0);
}

void copy(double to[3], const btVector3 &from)
{
    for (int i = 0; i < 3; i++)
        to[i] = double(from[i]);
}

void bullet_look(void *handle, heap_look *look)
{
    bullet *self = static_cast<bullet *>(handle);
    for (size_t i = 0; i < self->body.size(); i++) {
        const btTransform &place = self->body[i]->getWorldTransform();
        heap_body &body = look->body[i];
        copy(body.at, place.getOrigin());
        copy(body.forward, place.getBasis().getColumn(0));
        copy(body.up, place.getBasis().getColumn(1));
        copy(body.right, place.getBasis().getColumn(2));
        body.speed_mps = double(self->body[i]->getLinearVelocity().length());
    }
    for (int i = 0; i < self->dispatcher.getNumManifolds(); i++) {
        const btPersistentManifold *manifold = self->dispatcher.getManifoldByIndexInternal(i);
        int a = manifold->getBody0()->getUserIndex(), b = manifold->getBody1()->getUserIndex();
        if (manifold->getNumContacts() > 0 && a >= 0 && b >= 0)
            heap_look_add(look, uint32_t(a), uint32_t(b));
    }
}

} // namespace

extern "C" const heap_engine heap_bullet = {
    "bullet", 1, true, false, bullet_open, bullet_close, bullet_drive, bullet_step, bullet_look};
