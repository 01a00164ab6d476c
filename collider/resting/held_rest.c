/* Compares rows of two tables. */
#include "collider/resting/held_rest.h"

#include "world/entity/persistent_contact.h"
#include "world/params.h"
#include "world/world.h"

/* What moves faster from rest is driven, turns in its place or falls. */
#define DRIVEN_MPS2 0.15
#define TURNED_RPS2 0.15
/* Springs that a contact keeps from lifting or lowering a side tilt a body no faster. */
#define TILTED_RPS2 3.0

bool held_rest_ended(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    return body_motion_old(context->motion, row) && entities_still(e, row) &&
           e->row[row].x == w->row[row].x && e->row[row].y == w->row[row].y &&
           e->row[row].z == w->row[row].z && e->row[row].heading == w->row[row].heading &&
           e->row[row].pitch == w->row[row].pitch && e->row[row].roll == w->row[row].roll;
}

bool held_rest_stays(const struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    double dt_s = world_dt_s(context->world);
    return body_motion_old(context->motion, row) && e->row[row].state == ENTITY_ACTIVE &&
           w->row[row].flags & ENTITY_FLAG_CHASSIS && entities_still(w, row) &&
           vec3_length(entities_velocity(e, row)) <= DRIVEN_MPS2 * dt_s &&
           fabs(e->row[row].spin_y) <= TURNED_RPS2 * dt_s &&
           fabs(e->row[row].spin_x) + fabs(e->row[row].spin_z) <= TILTED_RPS2 * dt_s;
}

/* --- vehicles that are pinned ------------------------------------------------------------------*/

void held_rest_pin(const struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (e->row[row].jolt_tick != ENTITY_PINNED)
        table_set_jolt_tick(&context->writer, row, ENTITY_PINNED);
}

static void let_go(const struct response_context *context, uint32_t row, uint32_t id)
{
    const struct entities *e = &context->next->entities;
    if (entities_alive(e, row, id) && e->row[row].flags & ENTITY_FLAG_CHASSIS &&
        e->row[row].jolt_tick == ENTITY_PINNED)
        table_set_jolt_tick(&context->writer, row, (uint32_t)context->next->head->tick);
}

void held_rest_let_go(const struct response_context *context)
{
    const struct state *committed = context->motion->committed, *next = context->next;
    uint32_t n = 0, count = next->head->contact_count;
    for (uint32_t i = 0; i < committed->head->contact_count; i++) {
        const struct persistent_contact *held = &committed->contacts[i];
        uint64_t key = persistent_contact_key(held);
        if (!(held->flags & PERSISTENT_CONTACT_HOLDS))
            continue;
        while (n < count && persistent_contact_key(&next->contacts[n]) < key)
            n++;
        if (n < count && persistent_contact_key(&next->contacts[n]) == key &&
            next->contacts[n].flags & PERSISTENT_CONTACT_HOLDS)
            continue;
        let_go(context, held->a_row, held->a_id);
        if (!(held->b_id & PERSISTENT_CONTACT_FIXED))
            let_go(context, held->b_row, held->b_id);
    }
}

/* --- rows that go back -------------------------------------------------------------------------*/

void held_rest_keep_springs(struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before, *e = &context->next->entities;
    uint8_t flag = w->row[row].flags & ENTITY_FLAG_CHASSIS;
    if (e->row[row].state == ENTITY_ACTIVE && flag != 0 &&
        !(e->row[row].flags & ENTITY_FLAG_CHASSIS))
        table_set_flags(&context->writer, row, e->row[row].flags | flag);
}

static void set_turn(struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before;
    table_set_heading(&context->writer, row, w->row[row].heading);
    table_set_pitch(&context->writer, row, w->row[row].pitch);
    table_set_roll(&context->writer, row, w->row[row].roll);
}

bool held_rest_turn_back(struct response_context *context, uint32_t row)
{
    const struct entities *e = &context->next->entities;
    if (e->row[row].state != ENTITY_ACTIVE || !(e->row[row].flags & ENTITY_FLAG_CHASSIS) ||
        e->row[row].throttle == 0.0F)
        return false;
    set_turn(context, row);
    table_set_spin(&context->writer, row, (struct vec3){0.0, 0.0, 0.0});
    return true;
}

void held_rest_put_back(struct response_context *context, uint32_t row)
{
    const struct entities *w = &context->motion->before;
    held_rest_keep_springs(context, row);
    table_set_position(&context->writer, row, entities_position(w, row));
    set_turn(context, row);
    table_set_velocity(&context->writer, row, entities_velocity(w, row));
    table_set_spin(&context->writer, row,
                   (struct vec3){w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z});
    body_motion_compute(context->motion, row);
}

void held_rest_mark(struct response_context *context, uint32_t row)
{
    struct contact_queue *contacts = context->contacts;
    if (!held_rest_ended(context, row))
        return;
    for (uint32_t link = contacts->head[row]; link != 0; link = contacts->link[link - 1].next) {
        uint32_t index = contacts->link[link - 1].pair;
        const struct pair *pair = &contacts->pair[index];
        uint32_t other = pair->a == row ? pair->b : pair->a;
        if (contacts->marks[index] & CONTACT_RESTS &&
            (other & PAIR_FIXED || held_rest_ended(context, other)))
            contacts->marks[index] |= CONTACT_HOLDS;
    }
}
