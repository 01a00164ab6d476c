/* Frames with arbitrary bodies. The input chooses method, response and shape, and which bodies lie,
 * drive and fly where, among trees 4 m apart: heaps, bombs, rounds, wrecks, bodies at the world's
 * edge. Mover and collider then compute a few frames. Two colliders compute each frame, one of them
 * with worker threads and without data from the previous frame. Both must give the same result. */
#include "tests/fuzz/support.h"

#include "collider/step.h"
#include "mover/step.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/runtime/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROWS_MAX   96
#define FRAMES     3
#define GRID       12
#define BODY_BYTES 10

static const char begin[] = "world = { seed = 1; capacity = 128; hz = 20.0; };\n"
                            "terrain = { source = \"flat\"; height_m = 100.0; };\n";

static struct view view;
static struct mover mover;
static struct collider first, second;

/* --- the world ---------------------------------------------------------------------------------*/

static void open_world(void)
{
    static char text[16384];
    size_t at = (size_t)snprintf(text, sizeof text, "%sobjects = (\n", begin);
    for (int i = 0; i < GRID * GRID; i++)
        at += (size_t)snprintf(text + at, sizeof text - at,
                               "%s{ kind = \"tree\"; at = [%d.0, %d.0]; }\n", i > 0 ? "," : "",
                               25000 + 4 * (i % GRID), 25000 + 4 * (i / GRID));
    at += (size_t)snprintf(text + at, sizeof text - at, ");\n");
    support_world_of(&view, support_file(text, at));
    CHECK(mover_init(&mover, &view.world, view.w[0].craters, NULL) == 0);
    CHECK(collider_init(&first, &view.world, view.w[0].craters, NULL) == 0);
    CHECK(collider_init(&second, &view.world, view.w[0].craters, thread_pool_create(2)) == 0);
}

/* Resets the world to frame 0 without bodies. No earlier input has an effect. */
static void empty_world(uint8_t choice)
{
    struct collision_params *collision =
        &((struct params *)(uintptr_t)view.world.params)->collision;
    struct state_head *head = view.w[0].head;
    for (uint32_t i = 0; i < view.header->capacity; i++)
        entities_clear(&view.w[0].entities, i);
    memset(view.w[0].fixed_damage, 0, view.world.counts.fixed);
    memset(head, 0, sizeof *head);
    head->next_id = 1;
    head->time_scale = 1.0;
    collision->method = choice % METHOD_COUNT;
    collision->response = choice / 8 % 5;
    collision->shape = choice & 0x80 ? SHAPE_MODEL : SHAPE_SPHERE;
    mover.left = first.left[0] = first.left[1] = second.left[0] = second.left[1] = 0;
    first.fixed_hash_frame = second.fixed_hash_frame = UINT64_MAX;
    first.lists = second.lists = (struct list_hashes){0};
}

/* --- bodies ------------------------------------------------------------------------------------*/

/* Returns bytes as a number in -1 .. 1. */
static double share(uint8_t byte)
{
    return ((double)byte - 127.5) / 127.5;
}

/* Chooses the place of a body: among the trees, in a heap, in a corner, or anywhere. */
static struct vec3 place_of(const uint8_t *body)
{
    static const double sizes[] = {24.0, 3.0, 150.0, 25000.0};
    double size = sizes[body[0] & 3], x = 25024.0 + size * share(body[1]);
    double z = 25024.0 + size * share(body[2]);
    if (body[0] & 4)
        x = body[1] < 128 ? 0.0 : WORLD_SIDE_DEFAULT_M;
    double up = body[0] & 8 ? 0.4 * (double)body[3] : 0.0;
    return (struct vec3){maths_clamp(x, 0.0, WORLD_SIDE_DEFAULT_M), 100.0 + up,
                         maths_clamp(z, 0.0, WORLD_SIDE_DEFAULT_M)};
}

static void put_body(const uint8_t *body)
{
    const struct entities *e = &view.w[0].entities;
    struct state_head *head = view.w[0].head;
    uint32_t row = head->used++;
    const uint16_t kind = (uint16_t)(body[4] % view.world.counts.kinds);
    const struct kind *of = &view.world.kinds[kind];
    bool round = of->domain == DOMAIN_MUNITION;
    if (of->domain == DOMAIN_FIXED) {
        head->used--;
        return;
    }
    double speed = (body[0] & 16 ? 2000.0 : 30.0) * share(body[5]), sine, cosine;
    double heading = TWO_PI * (double)body[6] / 256.0;
    maths_sincos(heading, &sine, &cosine);
    entities_set_position(e, row, place_of(body));
    entities_set_velocity(
        e, row, (struct vec3){speed * sine, round ? 50.0 * share(body[7]) : 0.0, -speed * cosine});
    e->row[row].heading = heading;
    e->row[row].id = head->next_id++;
    e->row[row].kind = kind;
    e->row[row].state = !round && body[8] > 230 ? ENTITY_WRECK : ENTITY_ACTIVE;
    e->row[row].behaviour = e->row[row].order = round ? BEHAVIOUR_FLIGHT
                                                : e->row[row].state == ENTITY_WRECK
                                                    ? BEHAVIOUR_IDLE
                                                    : BEHAVIOUR_HOLD;
    e->row[row].fuel_l = of->fuel_l;
    e->row[row].until_tick = round ? 1 + body[8] % 8 : 0;
    e->row[row].owner_slot = body[9] % ROWS_MAX;
    e->row[row].owner_id = body[9] % 3 ? e->row[row].owner_slot + 1 : 0;
    *(round ? &head->munitions : &head->vehicles) += 1;
    head->alloc_next = head->used;
}

/* --- frames ------------------------------------------------------------------------------------*/

static void check_rows(const struct state *state)
{
    const struct entities *e = &state->entities;
    const struct state_head *head = state->head;
    CHECK(head->used <= view.header->capacity && head->vehicles + head->munitions <= head->used);
    for (uint32_t i = 0; i < head->used; i++) {
        if (e->row[i].state == ENTITY_FREE)
            continue;
        bool inside = e->row[i].x >= 0.0 && e->row[i].x <= WORLD_SIDE_DEFAULT_M &&
                      e->row[i].z >= 0.0 && e->row[i].z <= WORLD_SIDE_DEFAULT_M;
        CHECK(inside || e->row[i].behaviour == BEHAVIOUR_FLIGHT); /* rounds fly out of the world */
        CHECK(isfinite(e->row[i].x) && isfinite(e->row[i].z));
        CHECK(isfinite(e->row[i].y) && isfinite(e->row[i].heading) && isfinite(e->row[i].harm_j));
        CHECK(isfinite(e->row[i].vx) && isfinite(e->row[i].vy) && isfinite(e->row[i].vz));
        CHECK(isfinite(e->row[i].spin_x) && isfinite(e->row[i].spin_y) &&
              isfinite(e->row[i].spin_z));
        CHECK(e->row[i].kind < view.world.counts.kinds && e->row[i].damage <= DAMAGE_DESTROYED);
    }
}

static void make_frame(uint32_t frame)
{
    static const struct command_source none[COMMAND_RING_COUNT];
    const struct event_ring ring = {view.events, view.header->event_slots};
    const struct state *now = &view.w[frame & 1];
    struct state *next = &view.w[(frame + 1) & 1];
    struct command_source sources[COMMAND_RING_COUNT];
    for (int i = 0; i < COMMAND_RING_COUNT; i++) {
        sources[i] = none[i];
        sources[i].slot = view.commands[i]->slot;
        sources[i].slots = view.header->command_slots;
    }
    mover_step(&mover, now, &view.m, sources);
    collider_step(&first, now, &view.m, next, &ring);
    const struct state_head head = *next->head;
    check_rows(next);
    collider_step(&second, now, &view.m, next, &ring);
    CHECK(memcmp(&head, next->head, sizeof head) == 0);
    CHECK(state_whole(next, view.world.counts.fixed));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (!view.base)
        open_world();
    if (size < 1 + BODY_BYTES)
        return 0;
    empty_world(data[0]);
    for (data++, size--; size >= BODY_BYTES && view.w[0].head->used < ROWS_MAX;
         data += BODY_BYTES, size -= BODY_BYTES)
        put_body(data);
    for (uint32_t frame = 0; frame < FRAMES; frame++)
        make_frame(frame);
    return 0;
}
