// Bullet as an engine: the one file of C++ here, since Bullet has no interface in C. Its broad
// phase alone, a dynamic tree of boxes, and our test of the spheres: its whole world, which also
// looks at every fixed object in each step and keeps manifolds, takes longer.
#include "tests/bench/engine.h"

#include <btBulletCollisionCommon.h>

#include <vector>

namespace
{

struct bullet {
    const engine_scene *scene;
    btDefaultCollisionConfiguration configuration;
    btCollisionDispatcher dispatcher;
    btDbvtBroadphase broadphase;
    std::vector<btBroadphaseProxy *> fixed, moving;

    explicit bullet(const engine_scene *of) : scene(of), dispatcher(&configuration) {}
};

btVector3 corner(double x, double z, double reach)
{
    return btVector3(btScalar(x + reach), btScalar(reach), btScalar(z + reach));
}

btBroadphaseProxy *add(bullet *self, double x, double z, double radius, uint32_t name)
{
    bool stands = name & ENGINE_FIXED;
    // The name travels as the proxy's pointer, which Bullet only hands back.
    void *pointer = reinterpret_cast<void *>(uintptr_t(name));
    return self->broadphase.createProxy(
        corner(x, z, -radius), corner(x, z, radius), SPHERE_SHAPE_PROXYTYPE, pointer,
        stands ? btBroadphaseProxy::StaticFilter : btBroadphaseProxy::DefaultFilter,
        stands ? btBroadphaseProxy::DefaultFilter : btBroadphaseProxy::AllFilter,
        &self->dispatcher);
}

void *bullet_open(const engine_scene *scene, uint32_t)
{
    bullet *self = new bullet(scene);
    for (uint32_t i = 0; i < scene->fixed_count; i++) {
        const engine_sphere &ball = scene->fixed[i];
        self->fixed.push_back(add(self, ball.x, ball.z, ball.radius_m, i | ENGINE_FIXED));
    }
    for (uint32_t i = 0; i < scene->bodies; i++)
        self->moving.push_back(add(self, scene->body[i].x, scene->body[i].z, ENGINE_RADIUS_M, i));
    return self;
}

void bullet_close(void *handle)
{
    bullet *self = static_cast<bullet *>(handle);
    for (auto *list : {&self->moving, &self->fixed}) {
        for (btBroadphaseProxy *proxy : *list)
            self->broadphase.destroyProxy(proxy, &self->dispatcher);
    }
    delete self;
}

// There is nothing to tell: the boxes are set by what is measured, for that is what changes the
// tree.
void bullet_place(void *) {}

void bullet_detect(void *handle, engine_touches *touches)
{
    bullet *self = static_cast<bullet *>(handle);
    for (uint32_t i = 0; i < self->scene->bodies; i++) {
        const engine_body &body = self->scene->body[i];
        self->broadphase.setAabb(self->moving[i], corner(body.x, body.z, -ENGINE_RADIUS_M),
                                 corner(body.x, body.z, ENGINE_RADIUS_M), &self->dispatcher);
    }
    self->broadphase.calculateOverlappingPairs(&self->dispatcher);
    const btBroadphasePairArray &pairs =
        self->broadphase.getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < pairs.size(); i++) {
        uint32_t a = uint32_t(reinterpret_cast<uintptr_t>(pairs[i].m_pProxy0->m_clientObject));
        uint32_t b = uint32_t(reinterpret_cast<uintptr_t>(pairs[i].m_pProxy1->m_clientObject));
        if (a & ENGINE_FIXED) {
            uint32_t swap = a;
            a = b;
            b = swap;
        }
        if (engine_touching(self->scene, a, b))
            engine_touches_add(touches, a, b);
    }
}

} // namespace

extern "C" const engine engine_bullet = {"bullet",     "dbvt",       1, bullet_open, bullet_close,
                                         bullet_place, bullet_detect};
