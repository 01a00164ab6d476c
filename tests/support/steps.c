/* Lets tests change a world and enter a frame in the middle. */
#include "tests/support/steps.h"

#include "collider/geometry/level_gap.h"
#include "mover/motion/kinematics.h"
#include "mover/weapon/turret.h"
#include "world/entity/cruise.h"
#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/terrain/terrain_cache.h"
#include "world/maths/rotation.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include <cmocka.h>

/* The fixture's memory is writable. Only its types are const. */
static void *writable(const void *constant)
{
    return (void *)(uintptr_t)constant;
}

struct kind *steps_kind(const struct fixture *fixture, const char *name)
{
    return writable(&fixture->view.world.kinds[fixture_kind(fixture, name)]);
}

struct params *steps_params(const struct fixture *fixture)
{
    return writable(fixture->view.world.params);
}

void steps_small_ring(const struct fixture *fixture, uint32_t slots)
{
    struct params *params = steps_params(fixture);
    ((struct segment_header *)fixture->view.base)->event_slots = slots;
    params->event_slots = slots;
    params->events_per_frame = slots / 8;
    params->intents_per_frame = slots / 16;
}

/* Clears what the mover remembers of the ground: the posts below its rows, and steepest slopes. */
static void clear_terrain_cache(const struct fixture *fixture)
{
    const struct mover *mover = &fixture->stepper.mover;
    uint32_t capacity = mover->world->params->capacity;
    memset(mover->terrain_entries, 0, capacity * sizeof *mover->terrain_entries);
    memset(mover->terrain_entries_ahead, 0, capacity * sizeof *mover->terrain_entries_ahead);
    for (uint32_t square = 0; square < GRIDSQUARES_DEFAULT.count; square++)
        atomic_store_explicit(&mover->slopes.bound[square], 0, memory_order_relaxed);
}

double steps_waves(double x, double z, const void *context)
{
    double sine, cosine;
    (void)context;
    maths_sincos(0.02 * x + 0.035 * z, &sine, &cosine);
    return FIXTURE_GROUND_M + 4.0 * sine + 2.0 * cosine;
}

void steps_ground(const struct fixture *fixture, steps_height *height, const void *context)
{
    const struct terrain *terrain = &fixture->view.world.terrain;
    float *posts = writable(terrain->posts);
    for (uint32_t row = 0; row < terrain->side; row++) {
        for (uint32_t column = 0; column < terrain->side; column++)
            posts[(size_t)row * terrain->side + column] = (float)height(
                (double)column * terrain->spacing_m, (double)row * terrain->spacing_m, context);
    }
    clear_terrain_cache(fixture);
}

struct plane {
    double east, south;
};

static double plane_height(double x, double z, const void *context)
{
    const struct plane *plane = context;
    return FIXTURE_GROUND_M + plane->east * (x - 25000.0) + plane->south * (z - 25000.0);
}

void steps_plane(const struct fixture *fixture, double east, double south)
{
    steps_ground(fixture, plane_height, &(struct plane){east, south});
}

void steps_cover(const struct fixture *fixture, enum cover cover, double x0, double z0, double x1,
                 double z1)
{
    const struct terrain *terrain = &fixture->view.world.terrain;
    uint8_t *posts = writable(terrain->cover);
    for (uint32_t row = 0; row < terrain->side; row++) {
        for (uint32_t column = 0; column < terrain->side; column++) {
            double x = (double)column * terrain->spacing_m, z = (double)row * terrain->spacing_m;
            if (x >= x0 && x <= x1 && z >= z0 && z <= z1)
                posts[(size_t)row * terrain->side + column] = (uint8_t)cover;
        }
    }
    clear_terrain_cache(fixture);
}

double steps_ground_at(const struct fixture *fixture, double x, double z)
{
    return terrain_height(&fixture->view.world.terrain, &fixture->stepper.mover.craters, x, z);
}

/* --- rows --------------------------------------------------------------------------------------*/

struct entities steps_rows(const struct fixture *fixture)
{
    return fixture_state(fixture).entities;
}

double steps_speed(const struct fixture *fixture, uint32_t row)
{
    struct entities e = steps_rows(fixture);
    return vec3_length(entities_velocity(&e, row));
}

struct vec3 steps_position(const struct fixture *fixture, uint32_t row)
{
    struct state state = fixture_state(fixture);
    return cruise_position(&state.entities, row, state.head->tick,
                           world_dt_s(&fixture->view.world));
}

struct vec3 steps_velocity(const struct fixture *fixture, uint32_t row)
{
    struct state state = fixture_state(fixture);
    return cruise_velocity(&state.entities, row, state.head->tick,
                           world_dt_s(&fixture->view.world));
}

uint32_t steps_find(const struct fixture *fixture, uint32_t id)
{
    struct state state = fixture_state(fixture);
    return entities_find(&state.entities, state.head->used, id);
}

uint32_t steps_put(struct fixture *fixture, const char *kind, struct vec3 at, enum force force,
                   enum behaviour behaviour)
{
    uint32_t row = fixture_put(
        fixture, (struct fixture_entity){
                     .kind = kind, .at = at, .force = force, .behaviour = BEHAVIOUR_HOLD});
    struct entities e = steps_rows(fixture);
    e.row[row].behaviour = e.row[row].order = (uint8_t)behaviour;
    return row;
}

uint32_t steps_put_driving(struct fixture *fixture, const char *kind, double x, double z,
                           double heading_deg, double speed_mps)
{
    double heading = heading_deg * RAD_PER_DEG;
    return fixture_put(fixture,
                       (struct fixture_entity){.kind = kind,
                                               .at = {x, steps_ground_at(fixture, x, z), z},
                                               .velocity = {speed_mps * maths_sin(heading), 0.0,
                                                            -speed_mps * maths_cos(heading)},
                                               .heading_rad = heading});
}

void steps_threaten(const struct fixture *fixture, uint32_t row, uint32_t by)
{
    struct entities e = steps_rows(fixture);
    e.row[row].threat_slot = by;
    e.row[row].threat_id = e.row[by].id;
}

void steps_target(const struct fixture *fixture, uint32_t row, uint32_t target)
{
    struct entities e = steps_rows(fixture);
    e.row[row].target_slot = target;
    e.row[row].target_id = e.row[target].id;
}

void steps_empty(struct fixture *fixture)
{
    struct view *view = &fixture->view;
    *view->w[0].head = (struct state_head){.time_scale = 1.0, .next_id = 1};
    memset(view->w[0].fixed_damage, DAMAGE_NONE, view->world.counts.fixed);
    atomic_store(&view->commit->commit, 0);
    atomic_store(&view->commit->writing, 0);
    atomic_store(&view->moved_word->moved, 0);
}

/* --- commands ----------------------------------------------------------------------------------*/

void steps_send(struct fixture *fixture, enum command_ring ring, struct command command)
{
    struct command_ring_words *words = fixture->view.commands[ring];
    uint64_t head = atomic_load(&words->head);
    command.sequence = head;
    words->slot[head & (layout_ring_slots(fixture->view.header, (int)ring) - 1)] = command;
    atomic_store(&words->head, head + 1);
}

struct event_command steps_command(struct fixture *fixture, struct command command)
{
    uint32_t before = fixture_event_count(fixture, EVENT_COMMAND);
    steps_send(fixture, RING_CLIENTS, command);
    fixture_run(fixture, 1);
    const struct event *event = fixture_event(fixture, EVENT_COMMAND, before);
    assert_non_null(event);
    assert_int_equal(event->command.type, command.type);
    return event->command;
}

void steps_drive(struct fixture *fixture, uint32_t row, double throttle, double steer, double climb)
{
    struct event_command answer =
        steps_command(fixture, (struct command){.type = COMMAND_DRIVE,
                                                .entity = steps_rows(fixture).row[row].id,
                                                .value = {throttle, steer, climb}});
    assert_int_equal(answer.result, COMMAND_DONE);
}

void steps_pedals(struct fixture *fixture, uint32_t row, double throttle, double brake,
                  enum gearing gear)
{
    struct event_command answer =
        steps_command(fixture, (struct command){.type = COMMAND_DRIVE,
                                                .entity = steps_rows(fixture).row[row].id,
                                                .force = (uint16_t)gear,
                                                .value = {throttle, 0.0, 0.0, 0.0, 0.0, brake}});
    assert_int_equal(answer.result, COMMAND_DONE);
}

void steps_aim(const struct fixture *fixture, uint32_t row, uint32_t target)
{
    struct entities e = steps_rows(fixture);
    const struct kind *kinds = fixture->view.world.kinds;
    const struct step_context context = {.world = &fixture->view.world,
                                         .firing_tables = fixture->stepper.mover.firing_tables};
    struct mat3 body =
        rotation_matrix(rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll));
    struct vec3 lead = turret_lead(&context, turret_muzzle(&context, &e, row),
                                   kinds[e.row[row].kind].munition, &e, target);
    lead = rotation_back(&body, lead);
    e.row[row].turret = (float)maths_atan2(lead.z, lead.x);
    e.row[row].gun = (float)maths_atan2(lead.y, sqrt(lead.x * lead.x + lead.z * lead.z));
}

/* --- the middle of a frame ---------------------------------------------------------------------*/

void steps_serial_context(struct fixture *fixture, struct step_context *step,
                          struct serial_context *context)
{
    struct view *view = &fixture->view;
    const struct state *committed = &view->w[atomic_load(&view->commit->commit) & 1];
    *step = mover_context(&fixture->stepper.mover, committed, &view->m);
    *view->m.head = *committed->head;
    entities_copy(&view->m.entities, &committed->entities, 0, committed->head->used);
    *context = (struct serial_context){
        .step = step,
        .moved = &view->m,
        .writer = {&view->m.entities, fixture->stepper.mover.resting.resting, view->m.written},
        .remotes = &fixture->stepper.mover.remotes};
}

void steps_respond(struct fixture *fixture, struct response_context *context)
{
    struct view *view = &fixture->view;
    struct collider *collider = &fixture->stepper.collider;
    uint64_t commit = atomic_load(&view->commit->commit);
    const struct state *committed = &view->w[commit & 1];
    struct state *next = &view->w[(commit + 1) & 1];
    *next->head = *committed->head;
    next->head->frame++;
    next->head->tick++;
    entities_copy(&next->entities, &committed->entities, 0, committed->head->used);
    memcpy(next->fixed_damage, committed->fixed_damage, view->world.counts.fixed);
    body_motion_begin(&collider->motion, committed, next, &collider->craters);
    for (uint32_t i = 0; i < next->head->used; i++)
        body_motion_compute(&collider->motion, i);
    *context = collider_response_context(collider, next);
    context->events = (struct event_writer){.slot = view->events,
                                            .slots = view->header->event_slots,
                                            .first = committed->head->event_end,
                                            .frame = next->head->frame,
                                            .tick = next->head->tick,
                                            .most = view->world.params->events_per_frame,
                                            .tally = &next->head->tally};
    broad_phase_pairs(&collider->broad, &context->input.detect);
    contact_queue_begin(&collider->contacts, collider->broad.list, THREAD_POOL_MAX);
}

void steps_methods_agree(struct fixture *fixture, void (*begin)(const char *method))
{
    static const char *const methods[] = {"swept", "brute", "hopcroft", "occupancy", "swept"};
    uint64_t hash = 0;
    for (uint32_t i = 0; i < 5; i++) {
        begin(methods[i]);
        fixture_threads(fixture, i == 4 ? 3 : 1);
        fixture_continue(fixture, 60);
        const struct state now = fixture_state(fixture);
        uint64_t own = steps_state_hash(fixture, &now);
        if (i > 0)
            assert_int_equal(own, hash);
        hash = own;
        fixture_close(fixture);
    }
}

void steps_replace(struct fixture *fixture, struct response_context *context, uint32_t row,
                   uint32_t id)
{
    context->next->entities.row[row].id = id;
    fixture->stepper.collider.fresh[row / 64] |= (uint64_t)1 << row % 64;
}

void steps_respond_end(struct response_context *context)
{
    contact_queue_end(context->contacts);
    context->charges->count = 0;
}

/* --- purity ------------------------------------------------------------------------------------*/

static uint64_t hash_rows(uint64_t hash, const struct entities *e, uint32_t used)
{
    return XXH3_64bits_withSeed(e->row, used * sizeof *e->row, hash);
}

uint64_t steps_moved_hash(const struct fixture *fixture)
{
    const struct moved *moved = &fixture->view.m;
    uint64_t hash = XXH3_64bits(moved->head, sizeof *moved->head);
    hash = XXH3_64bits_withSeed(moved->intents, moved->head->intent_count * sizeof(struct event),
                                hash);
    return hash_rows(hash, &moved->entities, moved->head->used);
}

uint64_t steps_state_hash(const struct fixture *fixture, const struct state *state)
{
    const struct view *view = &fixture->view;
    uint64_t slots = view->header->event_slots, end = state->head->event_end;
    uint64_t hash = XXH3_64bits(state->head, sizeof *state->head);
    hash = hash_rows(hash, &state->entities, state->head->used);
    hash = XXH3_64bits_withSeed(state->fixed_damage, view->world.counts.fixed, hash);
    hash = XXH3_64bits_withSeed(state->craters, state->head->crater_count * sizeof(struct crater),
                                hash);
    hash = XXH3_64bits_withSeed(state->contacts,
                                state->head->contact_count * sizeof *state->contacts, hash);
    for (uint64_t i = end > slots ? end - slots : 0; i < end; i++)
        hash = XXH3_64bits_withSeed(&view->events[i & (slots - 1)], sizeof(struct event), hash);
    return hash;
}

double steps_gap(const struct fixture *fixture, const struct entities *entities, uint32_t a,
                 uint32_t b)
{
    const struct body_motion *motion = &fixture->stepper.collider.motion;
    struct swept_body body_a = body_motion_standing(motion, entities, a);
    struct swept_body body_b = body_motion_standing(motion, entities, b);
    return level_gap_least(&body_a, &body_b, 0.0, 9.0);
}

double steps_deepest(const struct fixture *fixture, uint32_t count)
{
    const struct body_motion *motion = &fixture->stepper.collider.motion;
    struct state now = fixture_state(fixture);
    double least = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        struct swept_body a = body_motion_standing(motion, &now.entities, i);
        for (uint32_t j = i + 1; j < count; j++) {
            struct swept_body b = body_motion_standing(motion, &now.entities, j);
            if (vec3_length(vec3_sub(a.path.at, b.path.at)) < a.bound_m + b.bound_m)
                least = maths_min(least, level_gap_least(&a, &b, 0.0, 0.0));
        }
    }
    return -least;
}

double steps_off_the_ground(const struct fixture *fixture, uint32_t count)
{
    struct state now = fixture_state(fixture);
    const struct entities *e = &now.entities;
    double worst = 0.0;
    for (uint32_t i = 0; i < count; i++)
        worst = maths_max(worst,
                          fabs(e->row[i].y - steps_ground_at(fixture, e->row[i].x, e->row[i].z)));
    return worst;
}

void steps_move(struct fixture *fixture)
{
    struct view *view = &fixture->view;
    struct command_source sources[COMMAND_RING_COUNT];
    frame_stepper_sources(view, sources);
    mover_step(&fixture->stepper.mover, &view->w[atomic_load(&view->commit->commit) & 1], &view->m,
               sources);
}
