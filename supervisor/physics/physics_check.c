/* A frame's look, from top to bottom. */
#include "supervisor/physics/physics_check.h"

#include "supervisor/physics/body_measures.h"
#include "supervisor/physics/hull_shape.h"
#include "supervisor/physics/joined_bodies.h"
#include "world/entity/event.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/persistent_contact.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/state.h"
#include "world/world.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static int find_shapes(struct physics_check *check)
{
    uint32_t hulls = check->world->counts.hulls;
    check->shape = calloc((size_t)hulls + 1, sizeof *check->shape);
    if (!check->shape)
        return -1;
    for (uint32_t i = 0; i < hulls; i++) {
        if (hull_shape_find(&check->shape[i], check->world, &check->world->hulls[i]) != 0)
            return -1;
    }
    return 0;
}

/* Only these responses keep bodies apart, and only methods that test whole paths let them. */
static void choose_bounds(struct physics_check *check)
{
    const struct collision_params *collision = &check->world->params->collision;
    bool apart = collision->response == MODEL_IMPULSE || collision->response == MODEL_SPRING;
    bool paths = collision->method != METHOD_NPSNET2 && collision->method != METHOD_MPS;
    struct measure *of = check->measures.of;
    of[MEASURE_OF_OVERLAP].unbound = of[MEASURE_OF_WALL_OVERLAP].unbound =
        of[MEASURE_OF_OVERLAP_GROWTH].unbound = !(apart && paths);
}

/* Returns the first event of the frame that the ring still has. */
static uint64_t first_event(const struct physics_check *check, uint64_t end,
                            const struct physics_events *events)
{
    return end - check->event_end > events->slots ? end - events->slots : check->event_end;
}

static void explain(struct physics_check *check, uint64_t end, const struct physics_events *events)
{
    for (uint64_t i = first_event(check, end, events); i < end; i++)
        body_looks_explain(&check->looks, &events->slot[i & (events->slots - 1)]);
    body_looks_wrecked(&check->looks);
}

/* Keeps the contacts for the look at the next frame. */
static void keep_contacts(struct physics_check *check, const struct state *state)
{
    check->contact_count = state->head->contact_count;
    if (check->contact_count > 0)
        memcpy(check->contact, state->contacts, check->contact_count * sizeof *check->contact);
}

/* Bodies that collided in the frame share their energy, even if they are apart again. */
static int join_struck(struct physics_check *check, uint64_t end,
                       const struct physics_events *events)
{
    for (uint64_t i = first_event(check, end, events); i < end; i++) {
        const struct event *event = &events->slot[i & (events->slots - 1)];
        if (event->type != EVENT_COLLISION || event->collision.a.fixed || event->collision.b.fixed)
            continue;
        uint32_t a = body_looks_find(&check->looks, event->collision.a.id);
        uint32_t b = body_looks_find(&check->looks, event->collision.b.id);
        if (a != NO_LOOK && b != NO_LOOK &&
            neighbour_pairs_add(&check->overlaps.touching, a, b) != 0)
            return -1;
    }
    return 0;
}

/* So do bodies that have pressed on each other in the frame: the guard at its end may have sent one
 * of them back since. */
static int join_pressed(struct physics_check *check, const struct state *state)
{
    for (uint32_t i = 0; i < state->head->contact_count; i++) {
        const struct persistent_contact *contact = &state->contacts[i];
        if (contact->pressed_tick != state->head->tick)
            continue;
        uint32_t a = body_looks_find(&check->looks, contact->a_id);
        uint32_t b = body_looks_find(&check->looks, contact->b_id);
        if (a != NO_LOOK && b != NO_LOOK &&
            neighbour_pairs_add(&check->overlaps.touching, a, b) != 0)
            return -1;
    }
    return 0;
}

/* A body of another simulator is corrected at the end of a frame, so it may have touched a body
 * from which it is apart now. */
static void mark_touched(struct physics_check *check)
{
    const struct neighbour_pairs *touching = &check->overlaps.touching;
    for (uint32_t i = 0; i < touching->count; i++) {
        struct body_look *a = &check->looks.body[touching->pair[i].a],
                         *b = &check->looks.body[touching->pair[i].b];
        a->touches |= b->foreign;
        b->touches |= a->foreign;
    }
}

static void look_at_bodies(struct physics_check *check, const struct ground_look *ground)
{
    struct body_looks *looks = &check->looks;
    for (uint32_t i = 0; i < looks->count; i++) {
        struct body_look *body = &looks->body[i];
        if (body->foreign)
            continue;
        body_measures_numbers(&check->measures, body, check->world->terrain.squares.world_m);
        if (body->finite)
            body_measures_ground(&check->measures, ground, body);
    }
}

static void look_at_motion(struct physics_check *check, const struct ground_look *ground)
{
    const struct body_looks *looks = &check->looks;
    for (uint32_t i = 0; i < looks->count; i++) {
        if (!looks->body[i].finite || looks->body[i].foreign)
            continue;
        body_measures_rest(&check->measures, ground, &looks->body[i]);
        body_measures_motion(&check->measures, ground, &looks->body[i]);
    }
    energy_look(&check->energy, &check->measures, looks, &check->overlaps.touching, ground->dt_s);
}

static int look_at(struct physics_check *check, const struct state *state,
                   const struct physics_events *events)
{
    double dt_s = check->world->params->dt_s;
    const struct ground_look ground = {.surface = &check->surface,
                                       .shape = check->shape,
                                       .dt_s = dt_s,
                                       .boxes =
                                           check->world->params->collision.shape == SHAPE_SPHERE,
                                       .fresh = state->head->crater_count != check->surface.count};
    check->measures.frame = state->head->frame;
    check->measures.time_s = (double)state->head->tick * dt_s;
    if (surface_update(&check->surface, state->craters, state->head->crater_count) != 0)
        return -1;
    crater_index_update(&check->craters, state->head->crater_count);
    check->looks.craters = &check->craters;
    body_looks_begin(&check->looks, check->world, state);
    look_at_bodies(check, &ground);
    if (events)
        explain(check, state->head->event_end, events);
    body_looks_hits(&check->looks, state, check->contact, check->contact_count);
    if (overlaps_look(&check->overlaps, &check->measures, &check->looks, state->fixed_damage,
                      dt_s) != 0 ||
        (events && join_struck(check, state->head->event_end, events) != 0) ||
        join_pressed(check, state) != 0)
        return -1;
    mark_touched(check);
    joined_bodies_find(&check->looks, &check->overlaps.touching);
    look_at_motion(check, &ground);
    body_looks_end(&check->looks);
    keep_contacts(check, state);
    check->event_end = state->head->event_end;
    return 0;
}

int physics_check_begin(struct physics_check *check, const struct world *world,
                        const struct state *state)
{
    uint32_t capacity = world->params->capacity;
    *check = (struct physics_check){.world = world, .surface = {.terrain = &world->terrain}};
    choose_bounds(check);
    check->contact = calloc(world->params->contact_slots, sizeof *check->contact);
    if (check->contact && find_shapes(check) == 0 &&
        crater_index_init(&check->craters, &world->terrain.squares, state->craters) == 0 &&
        body_looks_make(&check->looks, capacity) == 0 &&
        energy_make(&check->energy, capacity) == 0 &&
        overlaps_make(&check->overlaps, world, check->shape) == 0 &&
        look_at(check, state, NULL) == 0)
        return 0;
    physics_check_free(check);
    errno = ENOMEM;
    return -1;
}

void physics_check_free(struct physics_check *check)
{
    uint32_t hulls = check->shape ? check->world->counts.hulls : 0;
    for (uint32_t i = 0; i < hulls; i++)
        hull_shape_free(&check->shape[i]);
    free(check->shape);
    free(check->contact);
    surface_free(&check->surface);
    crater_index_free(&check->craters);
    body_looks_free(&check->looks);
    overlaps_free(&check->overlaps);
    energy_free(&check->energy);
    *check = (struct physics_check){0};
}

int physics_check_frame(struct physics_check *check, const struct state *state,
                        const struct physics_events *events)
{
    if (look_at(check, state, events) != 0)
        return -1;
    uint32_t bodies = check->looks.count - check->looks.foreign;
    check->frames++;
    check->bodies += bodies;
    check->most = check->most > bodies ? check->most : bodies;
    return 0;
}
