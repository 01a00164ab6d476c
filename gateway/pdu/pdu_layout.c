/* The table of layouts. */
#include "gateway/pdu/pdu_layout.h"

#include <stddef.h>
#include <string.h>

/* clang-format off */
#define FIELD(name, at, kind, count, member)                                                       \
    {name, at, PDU_FIELD_##kind, count, offsetof(struct pdu, member)}

static const struct pdu_field entity_state[] = {
    FIELD("id", 12, ID, 1, entity_state.id),
    FIELD("force", 18, U8, 1, entity_state.force),
    FIELD("type", 20, ENTITY_TYPE, 1, entity_state.type),
    FIELD("alternative_type", 28, ENTITY_TYPE, 1, entity_state.alternative_type),
    FIELD("velocity", 36, F32, 3, entity_state.velocity),
    FIELD("location", 48, F64, 3, entity_state.location),
    FIELD("orientation", 72, F32, 3, entity_state.orientation),
    FIELD("appearance", 84, U32, 1, entity_state.appearance),
    FIELD("dead_reckoning", 88, U8, 1, entity_state.dead_reckoning),
    FIELD("acceleration", 104, F32, 3, entity_state.acceleration),
    FIELD("angular_velocity", 116, F32, 3, entity_state.angular_velocity),
    FIELD("character_set", 128, U8, 1, entity_state.character_set),
    FIELD("marking", 129, MARKING, 1, entity_state.marking),
    FIELD("capabilities", 140, U32, 1, entity_state.capabilities),
};

static const struct pdu_field fire[] = {
    FIELD("firer", 12, ID, 1, fire.firer),
    FIELD("target", 18, ID, 1, fire.target),
    FIELD("munition", 24, ID, 1, fire.munition),
    FIELD("event", 30, ID, 1, fire.event),
    FIELD("fire_mission", 36, U32, 1, fire.fire_mission),
    FIELD("location", 40, F64, 3, fire.location),
    FIELD("munition_type", 64, ENTITY_TYPE, 1, fire.munition_type),
    FIELD("warhead", 72, U16, 1, fire.warhead),
    FIELD("fuse", 74, U16, 1, fire.fuse),
    FIELD("quantity", 76, U16, 1, fire.quantity),
    FIELD("rate", 78, U16, 1, fire.rate),
    FIELD("velocity", 80, F32, 3, fire.velocity),
    FIELD("range", 92, F32, 1, fire.range),
};

static const struct pdu_field detonation[] = {
    FIELD("firer", 12, ID, 1, detonation.firer),
    FIELD("target", 18, ID, 1, detonation.target),
    FIELD("munition", 24, ID, 1, detonation.munition),
    FIELD("event", 30, ID, 1, detonation.event),
    FIELD("velocity", 36, F32, 3, detonation.velocity),
    FIELD("location", 48, F64, 3, detonation.location),
    FIELD("munition_type", 72, ENTITY_TYPE, 1, detonation.munition_type),
    FIELD("warhead", 80, U16, 1, detonation.warhead),
    FIELD("fuse", 82, U16, 1, detonation.fuse),
    FIELD("quantity", 84, U16, 1, detonation.quantity),
    FIELD("rate", 86, U16, 1, detonation.rate),
    FIELD("point", 88, F32, 3, detonation.point),
    FIELD("result", 100, U8, 1, detonation.result),
};

static const struct pdu_field collision[] = {
    FIELD("issuer", 12, ID, 1, collision.issuer),
    FIELD("other", 18, ID, 1, collision.other),
    FIELD("event", 24, ID, 1, collision.event),
    FIELD("collision_type", 30, U8, 1, collision.collision_type),
    FIELD("velocity", 32, F32, 3, collision.velocity),
    FIELD("mass", 44, F32, 1, collision.mass),
    FIELD("point", 48, F32, 3, collision.point),
};

static const struct pdu_field collision_elastic[] = {
    FIELD("issuer", 12, ID, 1, collision_elastic.issuer),
    FIELD("other", 18, ID, 1, collision_elastic.other),
    FIELD("event", 24, ID, 1, collision_elastic.event),
    FIELD("velocity", 32, F32, 3, collision_elastic.velocity),
    FIELD("mass", 44, F32, 1, collision_elastic.mass),
    FIELD("point", 48, F32, 3, collision_elastic.point),
    FIELD("result", 60, F32, 6, collision_elastic.result),
    FIELD("normal", 84, F32, 3, collision_elastic.normal),
    FIELD("restitution", 96, F32, 1, collision_elastic.restitution),
};

#define BOTH_ENDS                                                                                  \
    FIELD("originator", 12, ID, 1, management.originator),                                         \
    FIELD("receiver", 18, ID, 1, management.receiver)

static const struct pdu_field request[] = { /* of Create and Remove */
    BOTH_ENDS,
    FIELD("request", 24, U32, 1, management.request),
};

static const struct pdu_field start_resume[] = {
    BOTH_ENDS,
    FIELD("real_time", 24, CLOCK, 1, management.real_time),
    FIELD("simulation_time", 32, CLOCK, 1, management.simulation_time),
    FIELD("request", 40, U32, 1, management.request),
};

static const struct pdu_field stop_freeze[] = {
    BOTH_ENDS,
    FIELD("real_time", 24, CLOCK, 1, management.real_time),
    FIELD("reason", 32, U8, 1, management.reason),
    FIELD("frozen", 33, U8, 1, management.frozen),
    FIELD("request", 36, U32, 1, management.request),
};

static const struct pdu_field acknowledge[] = {
    BOTH_ENDS,
    FIELD("acknowledge", 24, U16, 1, management.acknowledge),
    FIELD("response", 26, U16, 1, management.response),
    FIELD("request", 28, U32, 1, management.request),
};

#define LAYOUT(name, fields, type, family, bytes, parts_at)                                        \
    {name, fields, sizeof fields / sizeof fields[0], PDU_##type, PDU_FAMILY_##family, bytes,       \
     parts_at}

static const struct pdu_layout layouts[] = {
    LAYOUT("entity-state", entity_state, ENTITY_STATE, ENTITY, 144, 19),
    LAYOUT("fire", fire, FIRE, WARFARE, 96, 0),
    LAYOUT("detonation", detonation, DETONATION, WARFARE, 104, 101),
    LAYOUT("collision", collision, COLLISION, ENTITY, 60, 0),
    LAYOUT("create-entity", request, CREATE, MANAGEMENT, 28, 0),
    LAYOUT("remove-entity", request, REMOVE, MANAGEMENT, 28, 0),
    LAYOUT("start-resume", start_resume, START_RESUME, MANAGEMENT, 44, 0),
    LAYOUT("stop-freeze", stop_freeze, STOP_FREEZE, MANAGEMENT, 40, 0),
    LAYOUT("acknowledge", acknowledge, ACKNOWLEDGE, MANAGEMENT, 32, 0),
    LAYOUT("collision-elastic", collision_elastic, COLLISION_ELASTIC, ENTITY, 100, 0),
};
/* clang-format on */

#define LAYOUTS (sizeof layouts / sizeof layouts[0])

const struct pdu_layout *pdu_layout_at(unsigned index)
{
    return index < LAYOUTS ? &layouts[index] : NULL;
}

const struct pdu_layout *pdu_layout_of(uint8_t type)
{
    for (unsigned i = 0; i < LAYOUTS; i++) {
        if (layouts[i].type == type)
            return &layouts[i];
    }
    return NULL;
}

const struct pdu_layout *pdu_layout_named(const char *name)
{
    for (unsigned i = 0; i < LAYOUTS; i++) {
        if (strcmp(layouts[i].name, name) == 0)
            return &layouts[i];
    }
    return NULL;
}

const struct pdu_field *pdu_layout_field(const struct pdu_layout *layout, const char *name)
{
    for (unsigned i = 0; i < layout->field_count; i++) {
        if (strcmp(layout->fields[i].name, name) == 0)
            return &layout->fields[i];
    }
    return NULL;
}
