/* Sizes, offsets and writers of the regions. */
#include "ipc/segment/layout.h"

#include "ipc/segment/doorbell.h"
#include "ipc/segment/segment.h"
#include "world/checksum.h"
#include "world/entity/dent.h"
#include "world/entity/event.h"
#include "world/entity/formation.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/mission.h"
#include "world/entity/persistent_contact.h"
#include "world/entity/script.h"
#include "world/model.h"
#include "world/param_values.h"
#include "world/params.h"
#include "world/terrain/fixed.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/ground_format.h"

#include <errno.h>
#include <string.h>
#include <xxhash.h>

_Static_assert(sizeof(struct state_head) <= LAYOUT_HEAD_BYTES, "columns begin after the head");

/* Records of a remote entity that fit into the ring: at one a second, so many seconds of the
 * recorder are bridged. */
#define INPUTS_PER_REMOTE 8u
#define INPUT_SLOTS_MAX   (1u << 17)

/* Bounds for a forged header; each is far above what a world needs. */
#define PART_MAX (1u << 26)

static const char *const region_names[REGION_COUNT] = {
    [REGION_HEADER] = "header",
    [REGION_PARAMS] = "params",
    [REGION_KINDS] = "kinds",
    [REGION_MODELS] = "models",
    [REGION_MODEL_VERTICES] = "model vertices",
    [REGION_MODEL_TRIANGLES] = "model triangles",
    [REGION_HULLS] = "hulls",
    [REGION_HULL_VERTICES] = "hull vertices",
    [REGION_HULL_PLANES] = "hull planes",
    [REGION_POSTS] = "posts",
    [REGION_COVER] = "cover",
    [REGION_EARTHWORKS] = "earthworks",
    [REGION_EARTHWORK_INDEX] = "index of earthworks",
    [REGION_FIXED] = "fixed objects",
    [REGION_REACH_START] = "reach of squares",
    [REGION_REACH] = "reach",
    [REGION_AREAS] = "areas",
    [REGION_ROUTES] = "routes",
    [REGION_ROUTE_POINTS] = "route points",
    [REGION_FIRES] = "fires",
    [REGION_ROAD_POINTS] = "road points",
    [REGION_FORMATIONS] = "formations",
    [REGION_SCRIPTS] = "scripts",
    [REGION_SCRIPT_STEPS] = "script steps",
    [REGION_MISSIONS] = "missions",
    [REGION_MISSION_PHASES] = "mission phases",
    [REGION_MISSION_MEMBERS] = "mission members",
    [REGION_OBJECTIVES] = "objectives",
    [REGION_NAMES] = "names",
    [REGION_RECIPE] = "recipe",
    [REGION_COMMIT] = "commit words",
    [REGION_WORLD_A] = "world A",
    [REGION_WORLD_B] = "world B",
    [REGION_CRATERS] = "craters",
    [REGION_DENTS] = "dents",
    [REGION_EVENTS] = "events",
    [REGION_MOVED_WORD] = "moved word",
    [REGION_MOVED] = "moved table",
    [REGION_COMMANDS + RING_CLIENTS] = "commands (clients)",
    [REGION_COMMANDS + RING_RECORDER] = "commands (recorder)",
    [REGION_COMMANDS + RING_GATEWAY] = "commands (gateway)",
    [REGION_DOORS] = "doorbells",
};

const char *region_name(enum region region)
{
    if (region >= REGION_SLOTS && region <= REGION_SLOTS_LAST)
        return role_name((enum role)(region - REGION_SLOTS));
    return region < REGION_COUNT && region_names[region] ? region_names[region] : "?";
}

size_t layout_table_bytes(uint32_t capacity)
{
    return LAYOUT_HEAD_BYTES + entities_bytes(capacity) + block_hashes_bytes(capacity) +
           written_bytes(capacity);
}

size_t layout_contacts_offset(uint32_t capacity, uint32_t fixed)
{
    size_t bytes = layout_table_bytes(capacity) + fixed;
    return (bytes + TABLE_ALIGN - 1) / TABLE_ALIGN * TABLE_ALIGN;
}

uint32_t layout_input_slots(uint32_t command_slots, uint32_t remotes_max)
{
    uint32_t slots = command_slots;
    while (slots < INPUT_SLOTS_MAX && slots < (uint64_t)INPUTS_PER_REMOTE * remotes_max)
        slots *= 2;
    return slots;
}

static bool power_of_two(uint32_t value)
{
    return value != 0 && (value & (value - 1)) == 0;
}

static bool plausible(const struct segment_header *h)
{
    const struct counts *n = &h->counts;
    const uint32_t parts[] = {n->kinds,           n->models,       n->model_vertices,
                              n->model_triangles, n->fixed,        n->reach,
                              n->areas,           n->routes,       n->route_points,
                              n->fires,           n->road_points,  n->names,
                              h->crater_slots,    h->event_slots,  h->intents_per_frame,
                              h->dent_slots,      n->hulls,        n->hull_vertices,
                              n->hull_planes,     n->recipe,       n->formations,
                              n->scripts,         n->script_steps, n->mission_phases,
                              n->mission_members, n->earthworks,   n->earthwork_words};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (parts[i] > PART_MAX)
            return false;
    }
    return h->capacity >= 1 && h->capacity <= CAPACITY_MAX && n->posts_side >= 2 &&
           n->posts_side <= (n->posts_in_file ? GROUND_POSTS_SIDE_MAX : GROUND_WORLD_POSTS_MAX) &&
           n->posts_in_file <= 1 && n->side_m >= WORLD_SIDE_MIN_M &&
           n->side_m <= WORLD_SIDE_MAX_M && n->side_m % WORLD_SIDE_OF_M == 0 &&
           power_of_two(h->event_slots) && power_of_two(h->command_slots) &&
           h->command_slots <= (1u << 20) && power_of_two(h->input_slots) &&
           h->input_slots <= (1u << 20) && h->crater_slots <= CRATER_SLOTS_MAX &&
           h->contact_slots <= PERSISTENT_CONTACT_SLOTS_MAX && n->missions <= MISSIONS_MAX &&
           n->objectives <= OBJECTIVES_MAX;
}

int layout_compute(struct layout *layout, const struct segment_header *h)
{
    const struct counts *n = &h->counts;
    if (!plausible(h)) {
        errno = EOVERFLOW;
        return -1;
    }
    size_t posts = n->posts_in_file ? 0 : (size_t)n->posts_side * n->posts_side;
    size_t *b = layout->bytes;
    b[REGION_HEADER] = sizeof *h;
    b[REGION_PARAMS] = sizeof(struct params);
    b[REGION_KINDS] = n->kinds * sizeof(struct kind);
    b[REGION_MODELS] = n->models * sizeof(struct model);
    b[REGION_MODEL_VERTICES] = n->model_vertices * sizeof(struct model_vertex);
    b[REGION_MODEL_TRIANGLES] = n->model_triangles * sizeof(struct model_triangle);
    b[REGION_HULLS] = n->hulls * sizeof(struct hull);
    b[REGION_HULL_VERTICES] = n->hull_vertices * sizeof(struct vec3);
    b[REGION_HULL_PLANES] = n->hull_planes * sizeof(struct hull_plane);
    b[REGION_POSTS] = posts * sizeof(float);
    b[REGION_COVER] = posts;
    b[REGION_EARTHWORKS] = n->earthworks * sizeof(struct earthwork);
    b[REGION_EARTHWORK_INDEX] = n->earthwork_words * sizeof(uint32_t);
    b[REGION_FIXED] = n->fixed * sizeof(struct fixed_object);
    b[REGION_REACH_START] = (gridsquares_of(n->side_m).count + 1) * sizeof(uint32_t);
    b[REGION_REACH] = n->reach * sizeof(uint32_t);
    b[REGION_AREAS] = n->areas * sizeof(struct area);
    b[REGION_ROUTES] = n->routes * sizeof(struct route);
    b[REGION_ROUTE_POINTS] = n->route_points * sizeof(struct route_point);
    b[REGION_FIRES] = n->fires * sizeof(struct fire_order);
    b[REGION_ROAD_POINTS] = n->road_points * sizeof(struct road_point);
    b[REGION_FORMATIONS] = n->formations * sizeof(struct formation);
    b[REGION_SCRIPTS] = n->scripts * sizeof(struct script);
    b[REGION_SCRIPT_STEPS] = n->script_steps * sizeof(struct script_step);
    b[REGION_MISSIONS] = n->missions * sizeof(struct mission);
    b[REGION_MISSION_PHASES] = n->mission_phases * sizeof(struct battle_phase);
    b[REGION_MISSION_MEMBERS] = n->mission_members * sizeof(uint32_t);
    b[REGION_OBJECTIVES] = n->objectives * sizeof(struct objective);
    b[REGION_NAMES] = n->names * sizeof(struct entity_name);
    b[REGION_RECIPE] = n->recipe;
    b[REGION_COMMIT] = sizeof(struct commit_words);
    b[REGION_WORLD_A] = b[REGION_WORLD_B] = layout_contacts_offset(h->capacity, n->fixed) +
                                            h->contact_slots * sizeof(struct persistent_contact);
    b[REGION_CRATERS] = h->crater_slots * sizeof(struct crater);
    b[REGION_DENTS] = h->dent_slots * sizeof(struct dent);
    b[REGION_EVENTS] = h->event_slots * sizeof(struct event);
    b[REGION_MOVED_WORD] = sizeof(struct moved_word);
    b[REGION_MOVED] = layout_table_bytes(h->capacity) + h->intents_per_frame * sizeof(struct event);
    for (int i = 0; i < COMMAND_RING_COUNT; i++)
        b[REGION_COMMANDS + i] =
            sizeof(struct command_ring_words) + layout_ring_slots(h, i) * sizeof(struct command);
    b[REGION_DOORS] = sizeof(struct doorbells);
    for (int i = 0; i < ROLE_COUNT; i++)
        b[REGION_SLOTS + i] = ROLE_SLOT_BYTES;
    size_t at = 0;
    for (int i = 0; i < REGION_COUNT; i++) {
        layout->offset[i] = at;
        at += (b[i] + REGION_ALIGN - 1) / REGION_ALIGN * REGION_ALIGN;
    }
    layout->total = at;
    return 0;
}

uint64_t layout_hash(void)
{
    const size_t compiled[] = {
        SEGMENT_VERSION,
        sizeof(struct segment_header),
        sizeof(struct params),
        sizeof(struct kind),
        sizeof(struct model),
        sizeof(struct model_triangle),
        sizeof(struct fixed_object),
        sizeof(struct earthwork),
        sizeof(struct fire_order),
        sizeof(struct state_head),
        sizeof(struct crater),
        sizeof(struct dent),
        sizeof(struct persistent_contact),
        sizeof(struct hull),
        sizeof(struct hull_plane),
        sizeof(struct event),
        sizeof(struct command),
        sizeof(struct role_slot),
        sizeof(struct doorbells),
        offsetof(struct state_head, tally),
        offsetof(struct params, collision),
        offsetof(struct kind, mass_kg),
        entities_bytes(1),
        entities_bytes(CAPACITY_MAX),
        CHECKSUM_ROWS,
        REGION_COUNT,
        ROLE_COUNT,
        sizeof(struct model_vertex),
        sizeof(struct area),
        sizeof(struct route),
        sizeof(struct route_point),
        sizeof(struct road_point),
        sizeof(struct formation),
        sizeof(struct script),
        sizeof(struct script_step),
        sizeof(struct entity_name),
        sizeof(struct commit_words),
        sizeof(struct moved_word),
        BEHAVIOUR_COUNT,
        FORCE_COUNT,
        FORMATION_SHAPE_COUNT,
        STEP_TYPE_COUNT,
        sizeof(struct mission),
        sizeof(struct battle_phase),
        sizeof(struct objective),
        MISSION_ORDER_COUNT,
        DAMAGE_COUNT,
        METHOD_COUNT,
        SHAPE_COUNT,
        NEARNESS_COUNT,
        MEASURE_COUNT,
        MODEL_COUNT,
        EVENT_TYPE_COUNT,
        COMMAND_TYPE_COUNT,
        sizeof(struct event_command),
        offsetof(struct event_command, number),
    };
#define X(type, name) #type " " #name ";"
    static const char fields[] = ENTITY_FIELDS(X); /* their order and types */
#undef X
    return XXH3_64bits_withSeed(fields, sizeof fields, XXH3_64bits(compiled, sizeof compiled));
}

/* The regions that each role writes, beside its slot and the doorbells. */
static const struct {
    enum region first, last;
} written[ROLE_COUNT] = {
#define X(tag, name, calls, traits, first, last, start, stop) {first, last},
    ROLES(X)
#undef X
};

bool layout_writable(enum role role, enum region region)
{
    if (role >= ROLE_COUNT || region >= REGION_COUNT)
        return false;
    return region == (enum region)(REGION_SLOTS + (int)role) ||
           (region == REGION_DOORS && role_has(role, ROLE_RINGS)) ||
           (region >= written[role].first && region <= written[role].last);
}
