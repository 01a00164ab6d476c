/* Jolon as an engine: the broad phase, then the exact swept sphere test of each candidate pair. */
#include "tests/bench/engine.h"

#include "collider/broad_phase/broad_phase.h"
#include "ipc/process/log.h"
#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/params.h"
#include "world/runtime/prefault.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#define PAIRS_A_PIECE  4096
#define PREFETCH_PAIRS 12

/* A world of spheres. The moving spheres are of kind 0. */
struct jolon {
    const struct engine_scene *scene;
    struct params params;
    struct kind kinds[2];
    struct fixed_object *fixed;
    uint8_t *damage;
    float posts[4];
    uint8_t cover[4];
    void *rows;
    size_t rows_bytes;
    struct entities entities;
    struct path *path;
    struct world world;
    struct method_input input;
    struct thread_pool *workers;
    struct broad_phase broad;
    struct pair_list touching[THREAD_POOL_MAX];
    const struct pair_list *list; /* the list whose pairs are tested */
};

static void *reserve(size_t bytes)
{
    size_t al = bytes > 1000000 ? 2u << 20 : 64;
    void *memory = aligned_alloc(al, (bytes + al) / al * al);
    if (al > 64)
        madvise(memory, (bytes + al) / al * al, MADV_HUGEPAGE);
    if (!memory)
        die_refused("out of memory");
    memset(memory, 0, bytes);
    return memory;
}

static void make_world(struct jolon *self)
{
    const struct engine_scene *scene = self->scene;
    self->params.capacity = scene->bodies;
    self->params.dt_s = ENGINE_DT_S;
    self->kinds[0] = (struct kind){.radius_m = ENGINE_RADIUS_M, .domain = DOMAIN_LAND};
    self->kinds[1] = (struct kind){.radius_m = 1.0, .domain = DOMAIN_FIXED};
    self->fixed = reserve(scene->fixed_count * sizeof *self->fixed);
    self->damage = reserve(scene->fixed_count);
    for (uint32_t i = 0; i < scene->fixed_count; i++)
        self->fixed[i] = (struct fixed_object){.x = scene->fixed[i].x,
                                               .z = scene->fixed[i].z,
                                               .radius_m = (float)scene->fixed[i].radius_m,
                                               .kind = 1};
    /* The table belongs to the world and not to detection, so it is mapped and not counted. */
    self->rows_bytes = entities_bytes(scene->bodies) + TABLE_ALIGN;
    self->rows =
        mmap(NULL, self->rows_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (self->rows == MAP_FAILED)
        die_refused("out of memory");
    prefault_own(self->rows, self->rows_bytes);
    entities_bind(&self->entities, scene->bodies, self->rows);
    self->path = reserve(scene->bodies * sizeof *self->path);
    for (uint32_t i = 0; i < scene->bodies; i++) {
        self->entities.row[i].id = i + 1;
        self->entities.row[i].state = ENTITY_ACTIVE;
        self->entities.row[i].behaviour = BEHAVIOUR_HOLD;
    }
    self->world = (struct world){
        .params = &self->params,
        .counts = {.kinds = 2, .fixed = scene->fixed_count},
        .terrain = {self->posts, self->cover, 2, 50000.0, .squares = GRIDSQUARES_DEFAULT_INIT},
        .kinds = self->kinds,
        .fixed = self->fixed};
    self->input = (struct method_input){.world = &self->world,
                                        .entities = &self->entities,
                                        .path = self->path,
                                        .fixed_damage = self->damage,
                                        .rows = scene->bodies};
}

static void *jolon_open(const struct engine_scene *scene, uint32_t threads)
{
    struct jolon *self = reserve(sizeof *self);
    self->scene = scene;
    make_world(self);
    self->workers = thread_pool_create(threads);
    if (!self->workers || broad_phase_init(&self->broad, &self->world, self->workers) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    broad_phase_touch(&self->broad, scene->bodies);
    for (int i = 0; i < THREAD_POOL_MAX; i++) {
        if (pair_list_init(&self->touching[i], pair_filter_pairs_first(&self->world)) != 0)
            die_refused("cannot begin: %s", strerror(errno));
    }
    return self;
}

static void jolon_close(void *handle)
{
    struct jolon *self = handle;
    broad_phase_free(&self->broad);
    thread_pool_destroy(self->workers);
    for (int i = 0; i < THREAD_POOL_MAX; i++)
        pair_list_free(&self->touching[i]);
    free(self->path);
    munmap(self->rows, self->rows_bytes);
    free(self->damage);
    free(self->fixed);
    free(self);
}

static void jolon_place(void *handle)
{
    struct jolon *self = handle;
    for (uint32_t i = 0; i < self->scene->bodies; i++) {
        const struct engine_body *body = &self->scene->body[i];
        self->path[i] =
            (struct path){.at = {body->x, 0.0, body->z},
                          .along = {body->vx * ENGINE_DT_S, 0.0, body->vz * ENGINE_DT_S}};
    }
}

static void test_pairs(void *context, uint32_t first, uint32_t end, uint32_t worker)
{
    struct jolon *self = context;
    const struct pair *pair = self->list->pair;
    for (uint32_t i = first; i < end; i++) {
        struct pair now = pair[i];
        struct path other;
        double reach = ENGINE_RADIUS_M, toi;
        if (i + PREFETCH_PAIRS < end) {
            struct pair ahead = pair[i + PREFETCH_PAIRS];
            __builtin_prefetch(&self->path[ahead.a]);
            if (!(ahead.b & PAIR_FIXED))
                __builtin_prefetch(&self->path[ahead.b]);
        }
        if (now.b & PAIR_FIXED) {
            const struct fixed_object *object = &self->fixed[now.b & ~PAIR_FIXED];
            other = (struct path){.at = {object->x, (double)object->y, object->z}};
            reach += (double)object->radius_m;
        } else {
            other = self->path[now.b];
            reach += ENGINE_RADIUS_M;
        }
        if (analytic_impact_spheres(&self->path[now.a], &other, reach, 0.0, &toi))
            pair_list_add(&self->touching[worker], now.a, now.b);
    }
}

static void jolon_detect(void *handle, struct engine_touches *touches)
{
    struct jolon *self = handle;
    broad_phase_pairs(&self->broad, &self->input);
    for (int i = 0; i < THREAD_POOL_MAX; i++) {
        self->list = &self->broad.list[i];
        thread_pool_run(self->workers, test_pairs, self, self->list->count, PAIRS_A_PIECE);
    }
    for (int i = 0; i < THREAD_POOL_MAX; i++) {
        struct pair_list *list = &self->touching[i];
        for (uint32_t n = 0; n < list->count; n++)
            engine_touches_add(touches, list->pair[n].a, list->pair[n].b);
        list->count = 0;
    }
}

const struct engine engine_jolon = {"jolon",     "",          THREAD_POOL_MAX, jolon_open,
                                    jolon_close, jolon_place, jolon_detect};
