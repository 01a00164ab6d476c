// Bullet as an engine: the one file of C++ here, since Bullet has no interface in C.
#include "bench/engine.h"

#include <btBulletCollisionCommon.h>

#include <new>
#include <vector>

namespace
{

struct bullet {
    const engine_scene *scene;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btDbvtBroadphase broadphase;
    btCollisionWorld world;
    btSphereShape shape;
    std::vector<btSphereShape *> shapes;    // of the fixed spheres
    std::vector<btCollisionObject *> fixed, moving;

    explicit bullet(const engine_scene *of)
        : scene(of), dispatcher(&configuration),
          world(&dispatcher, &broadphase, &configuration), shape(btScalar(ENGINE_RADIUS_M))
    {
    }
};

btVector3 at(double x, double z)
{
    return btVector3(btScalar(x), 0, btScalar(z));
}

btCollisionObject *add(bullet *self, btSphereShape *shape, double x, double z, uint32_t name,
                       bool stands)
{
    btCollisionObject *object = new btCollisionObject;
    object->setCollisionShape(shape);
    object->setWorldTransform(btTransform(btQuaternion::getIdentity(), at(x, z)));
    object->setUserIndex(int(name));
    if (stands)
        object->setCollisionFlags(object->getCollisionFlags() |
                                  btCollisionObject::CF_STATIC_OBJECT);
    self->world.addCollisionObject(object, stands ? btBroadphaseProxy::StaticFilter
                                                  : btBroadphaseProxy::DefaultFilter,
                                   stands ? btBroadphaseProxy::DefaultFilter
                                          : btBroadphaseProxy::AllFilter);
    return object;
}

void *bullet_open(const engine_scene *scene, uint32_t)
{
    bullet *self = new bullet(scene);
    self->world.setForceUpdateAllAabbs(false); // what stands is not looked at again
    for (uint32_t i = 0; i < scene->fixed_count; i++) {
        const engine_ball &ball = scene->fixed[i];
        self->shapes.push_back(new btSphereShape(btScalar(ball.radius_m)));
        self->fixed.push_back(
            add(self, self->shapes.back(), ball.x, ball.z, i | ENGINE_FIXED, true));
    }
    for (uint32_t i = 0; i < scene->bodies; i++)
        self->moving.push_back(
            add(self, &self->shape, scene->body[i].x, scene->body[i].z, i, false));
    return self;
}

void bullet_close(void *handle)
{
    bullet *self = static_cast<bullet *>(handle);
    for (auto *list : {&self->moving, &self->fixed}) {
        for (btCollisionObject *object : *list) {
            self->world.removeCollisionObject(object);
            delete object;
        }
    }
    for (btSphereShape *shape : self->shapes)
        delete shape;
    delete self;
}

void bullet_place(void *handle)
{
    bullet *self = static_cast<bullet *>(handle);
    for (uint32_t i = 0; i < self->scene->bodies; i++)
        self->moving[i]->getWorldTransform().setOrigin(
            at(self->scene->body[i].x, self->scene->body[i].z));
}

void bullet_detect(void *handle, engine_touches *touches)
{
    bullet *self = static_cast<bullet *>(handle);
    self->world.performDiscreteCollisionDetection();
    for (int i = 0; i < self->dispatcher.getNumManifolds(); i++) {
        const btPersistentManifold *manifold = self->dispatcher.getManifoldByIndexInternal(i);
        uint32_t a = uint32_t(manifold->getBody0()->getUserIndex());
        uint32_t b = uint32_t(manifold->getBody1()->getUserIndex());
        if (manifold->getNumContacts() == 0)
            continue;
        if (a & ENGINE_FIXED) {
            uint32_t swap = a;
            a = b;
            b = swap;
        }
        if (engine_touching(self->scene, a, b))
            engine_found(touches, a, b);
    }
}

} // namespace

extern "C" const engine engine_bullet = {"bullet",     "dbvt",       1,            bullet_open,
                                         bullet_close, bullet_place, bullet_detect};
