/* Compares two frames, field by field. */
#include "supervisor/worldctl/compare.h"

#include "world/entity/dent.h"
#include "world/entity/persistent_contact.h"
#include "world/enum_names.h"
#include "world/params.h"
#include "world/terrain/crater.h"
#include "world/terrain/fallen.h"
#include "world/world.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

enum value_type { VALUE_DOUBLE, VALUE_FLOAT, VALUE_U64, VALUE_U32, VALUE_U16, VALUE_U8 };

#define TYPE_OF(type)                                                                              \
    _Generic((type){0}, double                                                                     \
             : VALUE_DOUBLE, float                                                                 \
             : VALUE_FLOAT, uint64_t                                                               \
             : VALUE_U64, uint32_t                                                                 \
             : VALUE_U32, uint16_t                                                                 \
             : VALUE_U16, uint8_t                                                                  \
             : VALUE_U8)

static const size_t value_bytes[] = {8, 4, 8, 4, 2, 1};

static void print_value(char text[32], enum value_type type, const void *at)
{
    double number;
    float single;
    uint64_t whole = 0;
    switch (type) {
    case VALUE_DOUBLE:
        memcpy(&number, at, sizeof number);
        snprintf(text, 32, "%.17g", number);
        break;
    case VALUE_FLOAT:
        memcpy(&single, at, sizeof single);
        snprintf(text, 32, "%.9g", (double)single);
        break;
    default: /* little-endian */
        memcpy(&whole, at, value_bytes[type]);
        snprintf(text, 32, "%" PRIu64, whole);
        break;
    }
}

static void set_values(struct difference *difference, enum value_type type, const void *a,
                       const void *b)
{
    print_value(difference->a, type, a);
    print_value(difference->b, type, b);
}

/* --- entities ----------------------------------------------------------------------------------*/

struct field {
    const char *name;
    enum value_type type;
    size_t offset;
};

static const unsigned char *value_of(const struct field *field, const struct entity *row)
{
    return (const unsigned char *)row + field->offset;
}

/* Returns the first row in which this field differs, or count. */
static uint32_t first_row(const struct field *field, const struct entity *a, const struct entity *b,
                          uint32_t count)
{
    uint32_t row = 0;
    while (row < count && memcmp(value_of(field, &a[row]), value_of(field, &b[row]),
                                 value_bytes[field->type]) == 0)
        row++;
    return row;
}

static void name_entity(struct difference *difference, const struct compared *a, uint32_t row)
{
    uint32_t id = a->state.entities.row[row].id;
    const char *name = world_entity_name(a->world, id);
    difference->row = row;
    if (name[0])
        snprintf(difference->field, sizeof difference->field, "%s of entity %u \"%s\" (row %u)",
                 difference->column, id, name, row);
    else
        snprintf(difference->field, sizeof difference->field, "%s of entity %u (row %u)",
                 difference->column, id, row);
}

static bool compare_entities(const struct compared *a, const struct compared *b,
                             struct difference *difference)
{
    static const struct field fields[] = {
#define X(type, name) {#name, TYPE_OF(type), offsetof(struct entity, name)},
        ENTITY_FIELDS(X)
#undef X
    };
    const struct entity *p = a->state.entities.row, *q = b->state.entities.row;
    uint32_t rows =
        a->state.head->used < b->state.head->used ? a->state.head->used : b->state.head->used;
    for (size_t i = 0; i < COUNT(fields); i++) {
        uint32_t row = first_row(&fields[i], p, q, rows);
        if (row == rows)
            continue;
        if (difference->columns++ == 0) {
            snprintf(difference->column, sizeof difference->column, "%s", fields[i].name);
            set_values(difference, fields[i].type, value_of(&fields[i], &p[row]),
                       value_of(&fields[i], &q[row]));
            name_entity(difference, a, row);
        }
    }
    return difference->columns > 0;
}

/* --- fixed objects, contacts, craters, dents, head ---------------------------------------------*/

static void name_damage(char *text, size_t bytes, uint8_t stored)
{
    if (stored < FALLEN_FIRST)
        snprintf(text, bytes, "%s", damage_name(fallen_damage(stored)));
    else
        snprintf(text, bytes, "fell to %.1f", fallen_heading(stored) * DEG_PER_RAD);
}

static bool compare_fixed(const struct compared *a, const struct compared *b,
                          struct difference *difference)
{
    const uint8_t *p = a->state.fixed_damage, *q = b->state.fixed_damage;
    uint32_t count = a->world->counts.fixed < b->world->counts.fixed ? a->world->counts.fixed
                                                                     : b->world->counts.fixed;
    uint32_t i = 0;
    if (memcmp(p, q, count) == 0)
        return false;
    while (p[i] == q[i])
        i++;
    difference->row = i;
    snprintf(difference->column, sizeof difference->column, "fixed_damage");
    snprintf(difference->field, sizeof difference->field, "damage of fixed object %u", i + 1);
    name_damage(difference->a, sizeof difference->a, p[i]);
    name_damage(difference->b, sizeof difference->b, q[i]);
    return true;
}

struct member {
    const char *name;
    enum value_type type;
    size_t offset;
};

#define MEMBER(type, struct_name, name)                                                            \
    {                                                                                              \
#name, TYPE_OF(type), offsetof(struct struct_name, name)                                   \
    }

/* Returns the first member in which two structs differ, or NULL. */
static const struct member *first_member(const struct member *members, size_t count, const void *a,
                                         const void *b)
{
    for (size_t i = 0; i < count; i++) {
        if (memcmp((const char *)a + members[i].offset, (const char *)b + members[i].offset,
                   value_bytes[members[i].type]) != 0)
            return &members[i];
    }
    return NULL;
}

static void name_member(struct difference *difference, const struct member *member, const void *a,
                        const void *b)
{
    snprintf(difference->column, sizeof difference->column, "%s", member->name);
    set_values(difference, member->type, (const char *)a + member->offset,
               (const char *)b + member->offset);
}

/* Names the member ("contact" itself if NULL) and both parties. */
static void name_contact(struct difference *difference, const struct member *member,
                         const struct persistent_contact *contact, uint32_t index)
{
    bool fixed = (contact->b_id & PERSISTENT_CONTACT_FIXED) != 0;
    uint32_t other = fixed ? (contact->b_id & ~PERSISTENT_CONTACT_FIXED) + 1 : contact->b_id;
    difference->row = index;
    snprintf(difference->field, sizeof difference->field, "%s%s of entity %u with %s %u",
             member ? member->name : "", member ? " of the contact" : "contact", contact->a_id,
             fixed ? "fixed object" : "entity", other);
}

/* The contact is in one frame only: in a, else in b. */
static void tell_one_sided(struct difference *difference, const struct persistent_contact *contact,
                           uint32_t index, bool in_a)
{
    snprintf(difference->column, sizeof difference->column, "contact");
    snprintf(difference->a, sizeof difference->a, "%s", in_a ? "present" : "none");
    snprintf(difference->b, sizeof difference->b, "%s", in_a ? "none" : "present");
    name_contact(difference, NULL, contact, index);
}

/* Both lists rise by their keys, so at the first difference the smaller key is in one of them
 * only. */
static bool compare_contacts(const struct compared *a, const struct compared *b,
                             struct difference *difference)
{
#define CONTACT(name) MEMBER(uint32_t, persistent_contact, name)
#define LOAD(i)                                                                                    \
    MEMBER(float, persistent_contact, load[i].normal_ns[0]),                                       \
        MEMBER(float, persistent_contact, load[i].normal_ns[1]),                                   \
        MEMBER(float, persistent_contact, load[i].friction_ns[0]),                                 \
        MEMBER(float, persistent_contact, load[i].friction_ns[1])
    static const struct member members[] = {CONTACT(a_row),
                                            CONTACT(b_row),
                                            CONTACT(begin_tick),
                                            CONTACT(pressed_tick),
                                            MEMBER(uint16_t, persistent_contact, flags),
                                            MEMBER(uint16_t, persistent_contact, impacts),
                                            MEMBER(float, persistent_contact, impulse_ns),
                                            MEMBER(uint64_t, persistent_contact, nearest[0]),
                                            MEMBER(uint64_t, persistent_contact, nearest[1]),
                                            MEMBER(uint64_t, persistent_contact, nearest[2]),
                                            MEMBER(uint64_t, persistent_contact, nearest[3]),
                                            LOAD(0),
                                            LOAD(1),
                                            LOAD(2),
                                            LOAD(3)};
#undef CONTACT
#undef LOAD
    uint32_t count_a = a->state.head->contact_count, count_b = b->state.head->contact_count;
    for (uint32_t i = 0; i < count_a || i < count_b; i++) {
        const struct persistent_contact *p = &a->state.contacts[i], *q = &b->state.contacts[i];
        uint64_t key_a = i < count_a ? persistent_contact_key(p) : UINT64_MAX;
        uint64_t key_b = i < count_b ? persistent_contact_key(q) : UINT64_MAX;
        if (key_a != key_b) {
            tell_one_sided(difference, key_a < key_b ? p : q, i, key_a < key_b);
            return true;
        }
        const struct member *member = first_member(members, COUNT(members), p, q);
        if (!member)
            continue;
        name_member(difference, member, p, q);
        name_contact(difference, member, p, i);
        return true;
    }
    return false;
}

static bool compare_craters(const struct compared *a, const struct compared *b,
                            struct difference *difference)
{
    static const struct member members[] = {
        MEMBER(double, crater, x), MEMBER(double, crater, z), MEMBER(float, crater, radius_m),
        MEMBER(float, crater, depth_m), MEMBER(uint64_t, crater, frame)};
    uint32_t count = a->state.head->crater_count < b->state.head->crater_count
                         ? a->state.head->crater_count
                         : b->state.head->crater_count;
    for (uint32_t i = 0; i < count; i++) {
        const struct crater *p = &a->state.craters[i], *q = &b->state.craters[i];
        const struct member *member = first_member(members, COUNT(members), p, q);
        if (!member)
            continue;
        name_member(difference, member, p, q);
        difference->row = i;
        snprintf(difference->field, sizeof difference->field, "%s of crater %u", member->name, i);
        return true;
    }
    return false;
}

static bool compare_dents(const struct compared *a, const struct compared *b,
                          struct difference *difference)
{
    static const struct member members[] = {
        MEMBER(uint32_t, dent, id),        MEMBER(uint32_t, dent, tick),
        MEMBER(float, dent, point[0]),     MEMBER(float, dent, point[1]),
        MEMBER(float, dent, point[2]),     MEMBER(float, dent, direction[0]),
        MEMBER(float, dent, direction[1]), MEMBER(float, dent, direction[2]),
        MEMBER(float, dent, plastic_m),    MEMBER(float, dent, elastic_m)};
    uint32_t count = a->state.head->dent_count < b->state.head->dent_count
                         ? a->state.head->dent_count
                         : b->state.head->dent_count;
    for (uint32_t i = 0; i < count; i++) {
        const struct dent *p = &a->state.dents[i], *q = &b->state.dents[i];
        const struct member *member = first_member(members, COUNT(members), p, q);
        if (!member)
            continue;
        name_member(difference, member, p, q);
        difference->row = i;
        snprintf(difference->field, sizeof difference->field, "%s of dent %u (entity %u)",
                 member->name, i, p->id);
        return true;
    }
    return false;
}

static bool compare_debris(const struct compared *a, const struct compared *b,
                           struct difference *difference)
{
    static const struct member members[] = {
        MEMBER(uint32_t, debris, object),   MEMBER(double, debris, x),
        MEMBER(double, debris, z),          MEMBER(float, debris, vx),
        MEMBER(float, debris, vz),          MEMBER(float, debris, heading_rad),
        MEMBER(float, debris, spin_rps),    MEMBER(float, debris, mass_kg),
        MEMBER(float, debris, radius_m),    MEMBER(float, debris, half_length_m),
        MEMBER(uint32_t, debris, fell_tick)};
    for (uint32_t i = 0; i < DEBRIS_MAX; i++) {
        const struct debris *p = &a->state.head->debris[i], *q = &b->state.head->debris[i];
        const struct member *member = first_member(members, COUNT(members), p, q);
        if (!member)
            continue;
        name_member(difference, member, p, q);
        difference->row = i;
        snprintf(difference->field, sizeof difference->field, "%s of debris %u", member->name, i);
        return true;
    }
    return false;
}

static bool compare_batteries(const struct compared *a, const struct compared *b,
                              struct difference *difference)
{
    static const struct member members[] = {
        MEMBER(uint32_t, battery, number),    MEMBER(double, battery, x),
        MEMBER(double, battery, z),           MEMBER(double, battery, aim_x),
        MEMBER(double, battery, aim_z),       MEMBER(float, battery, survey_x),
        MEMBER(float, battery, survey_z),     MEMBER(float, battery, mean_range),
        MEMBER(float, battery, mean_azimuth), MEMBER(float, battery, azimuth),
        MEMBER(float, battery, elevation),    MEMBER(float, battery, flight_s),
        MEMBER(float, battery, fell_x),       MEMBER(float, battery, fell_z),
        MEMBER(float, battery, step_m),       MEMBER(uint32_t, battery, volley_tick),
        MEMBER(uint32_t, battery, next_tick), MEMBER(uint32_t, battery, cold_tick),
        MEMBER(uint32_t, battery, rounds),    MEMBER(uint32_t, battery, gun_slot[0]),
        MEMBER(uint32_t, battery, gun_id[0]), MEMBER(uint32_t, battery, fired),
        MEMBER(uint8_t, battery, phase),      MEMBER(uint8_t, battery, guns)};
    for (uint32_t i = 0; i < BATTERIES_MAX; i++) {
        const struct battery *p = &a->state.head->battery[i], *q = &b->state.head->battery[i];
        const struct member *member = first_member(members, COUNT(members), p, q);
        if (!member)
            continue;
        name_member(difference, member, p, q);
        difference->row = i;
        snprintf(difference->field, sizeof difference->field, "%s of battery %u", member->name, i);
        return true;
    }
    return false;
}

/* Compares missions and objectives. */
static bool compare_battles(const struct compared *a, const struct compared *b,
                            struct difference *difference)
{
    static const struct member of_mission[] = {
        MEMBER(uint32_t, mission_state, since_tick), MEMBER(uint32_t, mission_state, reacted),
        MEMBER(uint16_t, mission_state, phase),      MEMBER(uint16_t, mission_state, resume),
        MEMBER(uint16_t, mission_state, able),       MEMBER(uint16_t, mission_state, begun)};
    static const struct member of_objective[] = {
        MEMBER(uint32_t, objective_state, since_tick), MEMBER(uint8_t, objective_state, owner),
        MEMBER(uint16_t, objective_state, present[FORCE_BLUE]),
        MEMBER(uint16_t, objective_state, present[FORCE_RED])};
    const struct battle_state *p = &a->state.head->battle, *q = &b->state.head->battle;
    for (uint32_t i = 0; i < MISSIONS_MAX + OBJECTIVES_MAX; i++) {
        const bool is_mission = i < MISSIONS_MAX;
        const uint32_t o = is_mission ? 0 : i - MISSIONS_MAX;
        const void *left = is_mission ? (const void *)&p->mission[i] : &p->objective[o];
        const void *right = is_mission ? (const void *)&q->mission[i] : &q->objective[o];
        const struct member *member =
            is_mission ? first_member(of_mission, COUNT(of_mission), left, right)
                       : first_member(of_objective, COUNT(of_objective), left, right);
        if (!member)
            continue;
        name_member(difference, member, left, right);
        difference->row = is_mission ? i : o;
        snprintf(difference->field, sizeof difference->field, "%s of %s %u", member->name,
                 is_mission ? "mission" : "objective", is_mission ? i : o);
        return true;
    }
    return false;
}

/* Compares the members that state_digest() covers: not pacing, quit, stage times and the
 * checksum. */
static bool compare_heads(const struct compared *a, const struct compared *b,
                          struct difference *difference)
{
#define HEAD(type, name) MEMBER(type, state_head, name)
    static const struct member members[] = {
        HEAD(uint64_t, frame),
        HEAD(uint64_t, tick),
        HEAD(uint32_t, paused),
        HEAD(uint32_t, steps_left),
        HEAD(uint32_t, used),
        HEAD(uint32_t, next_id),
        HEAD(uint32_t, alloc_next),
        HEAD(uint32_t, vehicles),
        HEAD(uint32_t, munitions),
        HEAD(uint32_t, crater_count),
        HEAD(uint32_t, dent_count),
        HEAD(uint32_t, contact_count),
        HEAD(uint32_t, fire_cursor),
        HEAD(uint32_t, battery_count),
        HEAD(uint32_t, debris_count),
        HEAD(uint32_t, advanced),
        HEAD(uint64_t, command_cursor[RING_CLIENTS]),
        HEAD(uint64_t, command_cursor[RING_RECORDER]),
        HEAD(uint64_t, command_cursor[RING_GATEWAY]),
        HEAD(uint64_t, tally.collisions),
        HEAD(uint64_t, tally.fires),
        HEAD(uint64_t, tally.detonations),
        HEAD(uint64_t, tally.destroyed),
        HEAD(uint64_t, tally.fixed_damaged),
        HEAD(uint64_t, tally.agent_changes),
        HEAD(uint64_t, tally.commands),
        HEAD(uint64_t, tally.events_dropped),
        HEAD(uint64_t, tally.craters_refused),
        HEAD(uint64_t, tally.spawns_refused),
        HEAD(uint64_t, tally.dents_refused),
        HEAD(uint64_t, tally.contacts_refused),
        HEAD(uint32_t, battle.round),
        HEAD(uint32_t, battle.round_tick),
        HEAD(uint32_t, battle.ended_tick),
        HEAD(uint32_t, battle.winner),
        HEAD(uint64_t, event_end),
        HEAD(uint64_t, event_digest),
    };
#undef HEAD
    const struct state_head *p = a->state.head, *q = b->state.head;
    const struct member *member = first_member(members, COUNT(members), p, q);
    if (!member)
        return false;
    name_member(difference, member, p, q);
    snprintf(difference->field, sizeof difference->field, "%s of the head", member->name);
    return true;
}

bool compare_states(const struct compared *a, const struct compared *b,
                    struct difference *difference)
{
    *difference = (struct difference){0};
    return compare_entities(a, b, difference) || compare_fixed(a, b, difference) ||
           compare_contacts(a, b, difference) || compare_craters(a, b, difference) ||
           compare_dents(a, b, difference) || compare_battles(a, b, difference) ||
           compare_heads(a, b, difference) || compare_batteries(a, b, difference) ||
           compare_debris(a, b, difference);
}

bool compare_worlds(const struct world *a, const struct world *b, struct difference *difference)
{
    static const struct member members[] = {
        MEMBER(uint64_t, params, seed),
        MEMBER(double, params, hz),
        MEMBER(uint32_t, params, capacity),
        MEMBER(uint32_t, params, collision.method),
        MEMBER(uint32_t, params, collision.shape),
        MEMBER(uint32_t, params, collision.response),
        MEMBER(uint32_t, params, initial_entities),
    };
    *difference = (struct difference){0};
    const struct member *member = first_member(members, COUNT(members), a->params, b->params);
    if (member) {
        name_member(difference, member, a->params, b->params);
    } else if (a->counts.fixed != b->counts.fixed) {
        snprintf(difference->column, sizeof difference->column, "fixed objects");
        set_values(difference, VALUE_U32, &a->counts.fixed, &b->counts.fixed);
    } else {
        return false;
    }
    snprintf(difference->field, sizeof difference->field, "%s", difference->column);
    return true;
}
