/* Places vehicles, one group of the scenario after the other. */
#include "world/making/vehicle_placement.h"

#include "world/entity/entity.h"
#include "world/entity/formation.h"
#include "world/making/free_place.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/random.h"
#include "world/start_height.h"
#include "world/terrain/fixed_index.h"
#include "world/making/road_routing.h"
#include "world/making/script_build.h"
#include "world/terrain/gridsquare.h"
#include "world/terrain/rest_pose.h"
#include "world/vehicle_shell.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define NEAR_TRIES  8    /* for a place near another; each doubles the radius */
#define NEAR_ROAD_M 10.0 /* the first radius for a place on a road */

#define PLACING_STEP 256u /* vehicles between two reports of progress */

/* A group that is being placed. */
struct rank {
    const struct scenario_group *group;
    uint32_t first; /* slot of its first vehicle */
    uint32_t leader,
        member;     /* of its formation: the leader's slot, and the number of its first member */
    double heading; /* [rad] of a formation */
    const struct route *along; /* starts on this route; NULL: in its area */
    double along_m;            /* where on it the leader of a formation is */
};

/* The place where one vehicle starts. */
struct stand {
    double x, z, heading;
    uint32_t leg; /* the point of its route that it heads for */
};

struct vehicle_placement {
    struct world_build *built;
    struct free_place place;
    struct error_text *error;
    struct rank rank; /* of the present group; a group that follows continues the formation of the
                         one before */
};

static double heading_of(const struct vehicle_placement *placement, uint32_t slot)
{
    const struct scenario_group *group = placement->rank.group;
    uint64_t seed = placement->built->scenario->settings->params.seed;
    return group->turned ? maths_wrap_turn(group->heading_rad)
                         : random_between(seed, 0, slot, RANDOM_HEADING, 0, TWO_PI);
}

static bool follows(const struct vehicle_placement *placement, uint32_t slot)
{
    return placement->rank.group->formed && slot != placement->rank.leader;
}

/* Returns how high a vehicle with these angles has to be for its shell to be in no ground [m].
 * least_y_m: it is not lower. */
static double clear_height(const struct terrain *terrain, const struct kind *kind,
                           const struct entity *row, const struct rest_pose *pose, double least_y_m)
{
    const struct mat3 turn =
        rotation_matrix(rotation_of(row->heading, pose->pitch_rad, pose->roll_rad));
    const struct vec3 at = {row->x, least_y_m, row->z};
    return least_y_m + maths_max(0.0, vehicle_shell_depth(terrain, NULL, kind, VEHICLE_SHELL_POINTS,
                                                          at, &turn));
}

/* A land vehicle stands on the ground as it will in the frames to come. Where the edges of works
 * are under it, it is let down on them as a body on its springs: leaning as five heights say or
 * level, whichever of the two is lower. */
static void set_on_ground(const struct world_build *built, uint32_t slot)
{
    const struct terrain terrain = world_build_terrain(built);
    struct entity *row = &built->first.row[slot];
    const struct kind *kind = &built->scenario->kinds[row->kind];
    double clear_y_m;
    struct rest_pose pose = rest_pose_of(&terrain, NULL, kind, row->x, row->z, row->heading);
    if (rest_pose_bends(&terrain, kind, row->x, row->z, row->heading, &clear_y_m)) {
        struct rest_pose level = {.y_m = 0.0};
        level.y_m = clear_height(&terrain, kind, row, &level, clear_y_m);
        pose.y_m = clear_height(&terrain, kind, row, &pose,
                                terrain_height(&terrain, NULL, row->x, row->z));
        pose = level.y_m < pose.y_m ? level : pose;
        row->flags |= ENTITY_FLAG_CHASSIS;
    }
    row->y = pose.y_m;
    row->pitch = pose.pitch_rad;
    row->roll = pose.roll_rad;
}

/* Returns the height of a vehicle over the ground. An aeroplane that holds its course flies into
 * what its author has put before it. */
static double height_of(struct world_build *built, const struct scenario_group *group,
                        const struct stand *stand, double speed_mps)
{
    const struct kind *kind = &built->scenario->kinds[group->kind];
    const struct terrain terrain = world_build_terrain(built);
    double altitude = group->floating ? group->altitude_m : kind->cruise_altitude_m;
    if (kind->domain != DOMAIN_AIR)
        return 0.0;
    if (kind_hovers(kind) || group->behaviour == BEHAVIOUR_HOLD)
        return altitude;
    const struct start_flight flight = {stand->x, stand->z, stand->heading, speed_mps, altitude};
    double height = start_height(&terrain, kind, &flight);
    built->raised += height > altitude;
    return height;
}

static void put_entity(const struct vehicle_placement *placement, uint32_t slot,
                       const struct stand *stand)
{
    struct world_build *built = placement->built;
    const struct scenario_group *group = placement->rank.group;
    const struct kind *kind = &built->scenario->kinds[group->kind];
    struct terrain terrain = world_build_terrain(built);
    struct entities *e = &built->first;
    double speed = group->moving ? group->speed_mps : kind->min_speed_mps;
    double sine, cosine;
    maths_sincos(stand->heading, &sine, &cosine);
    e->row[slot].id = slot + 1;
    e->row[slot].state = ENTITY_ACTIVE;
    e->row[slot].kind = group->kind;
    e->row[slot].force = group->force;
    e->row[slot].behaviour = e->row[slot].order =
        follows(placement, slot) ? BEHAVIOUR_FOLLOW : group->behaviour;
    e->row[slot].order_arg = follows(placement, slot)              ? built->counts.formations - 1
                             : group->behaviour == BEHAVIOUR_ROUTE ? group->route
                                                                   : group->area;
    e->row[slot].flags = group->flags;
    e->row[slot].leg = stand->leg;
    e->row[slot].x = stand->x;
    e->row[slot].z = stand->z;
    e->row[slot].y =
        terrain_base_height(&terrain, stand->x, stand->z) + height_of(built, group, stand, speed);
    e->row[slot].heading = stand->heading;
    if (kind->domain == DOMAIN_LAND)
        set_on_ground(built, slot);
    e->row[slot].vx = speed * sine;
    e->row[slot].vz = -speed * cosine;
    e->row[slot].fuel_l = kind->fuel_l;
    e->row[slot].rounds = kind->rounds;
    e->row[slot].goal_x = stand->x; /* reached: the agent's first decision chooses the next */
    e->row[slot].goal_z = stand->z;
}

/* Finds the wanted place, or one near it if the ground there is unsuitable. */
static int near_stand(struct vehicle_placement *placement, uint32_t slot, double reach,
                      struct stand *stand)
{
    const struct scenario *scenario = placement->built->scenario;
    const struct kind *kind = &scenario->kinds[placement->rank.group->kind];
    const struct stand wanted = *stand;
    if (free_place_suits(&placement->place, kind, stand->x, stand->z))
        return 0;
    for (int i = 0; i < NEAR_TRIES; i++, reach *= 2.0) {
        const double last = placement->place.terrain.squares.world_m;
        const struct area near = {
            maths_clamp(wanted.x - reach, 0.0, last),
            maths_clamp(wanted.z - reach, 0.0, last),
            maths_clamp(wanted.x + reach, 0.0, last),
            maths_clamp(wanted.z + reach, 0.0, last),
        };
        if (free_place_find(&placement->place, &near, kind, slot, &stand->x, &stand->z) == 0)
            return 0;
    }
    return -1;
}

static int stand_on_route(struct vehicle_placement *placement, uint32_t slot, double along_m,
                          struct stand *stand)
{
    struct route_place at = road_routing_place(placement->built, placement->rank.along, along_m);
    *stand = (struct stand){at.x, at.z, at.heading, at.next};
    return near_stand(placement, slot, NEAR_ROAD_M, stand);
}

/* Finds its place in the formation; a column that starts on a road bends with it. */
static int stand_in_formation(struct vehicle_placement *placement, uint32_t slot,
                              struct stand *stand)
{
    const struct world_build *built = placement->built;
    const struct rank *rank = &placement->rank;
    const struct formation *formation = &built->formations[built->counts.formations - 1];
    const struct entities *e = &built->first;
    double ahead, right, sine, cosine;
    formation_place((enum formation_shape)formation->shape, formation->spacing_m,
                    rank->member + (slot - rank->first), &ahead, &right);
    if (rank->along && formation->shape == FORMATION_COLUMN) {
        if (stand_on_route(placement, slot, rank->along_m + ahead, stand) != 0)
            return -1;
        stand->leg = 0;
        return 0;
    }
    maths_sincos(rank->heading, &sine, &cosine);
    *stand =
        (struct stand){e->row[rank->leader].x + ahead * sine + right * cosine,
                       e->row[rank->leader].z - ahead * cosine + right * sine, rank->heading, 0};
    return near_stand(placement, slot, formation->spacing_m / 4.0, stand);
}

/* Where its script begins, looking to where it goes next. */
static bool stand_on_script(const struct vehicle_placement *placement, uint32_t slot,
                            struct stand *stand)
{
    const struct scenario_group *group = placement->rank.group;
    double first[2], next[2];
    if (!script_build_start(placement->built->scenario, group->script, first, next))
        return false;
    *stand = (struct stand){first[0], first[1], heading_of(placement, slot), 0};
    if (!group->turned && (next[0] != first[0] || next[1] != first[1]))
        stand->heading = maths_heading(next[0] - first[0], next[1] - first[1]);
    return true;
}

static int find_stand(struct vehicle_placement *placement, uint32_t slot, struct stand *stand)
{
    const struct scenario *scenario = placement->built->scenario;
    const struct rank *rank = &placement->rank;
    const struct scenario_group *group = rank->group;
    if (follows(placement, slot))
        return stand_in_formation(placement, slot, stand);
    *stand = (struct stand){group->x, group->z, heading_of(placement, slot), 0};
    if (group->placed)
        return 0;
    if (group->script != UINT32_MAX && group->area == 0 && stand_on_script(placement, slot, stand))
        return near_stand(placement, slot, NEAR_ROAD_M, stand);
    if (rank->along && group->formed)
        return stand_on_route(placement, slot, rank->along_m, stand);
    if (rank->along)
        return stand_on_route(placement, slot,
                              road_routing_length(placement->built, rank->along) *
                                  (double)(slot - rank->first) / (double)group->count,
                              stand);
    return free_place_find(&placement->place, &scenario->areas[group->area],
                           &scenario->kinds[group->kind], slot, &stand->x, &stand->z);
}

/* Returns the number of vehicles behind the leader, in its own group and those that follow it. */
static uint32_t tail_of(const struct scenario *scenario, const struct scenario_group *group)
{
    uint32_t tail = group->count - 1;
    for (group++;
         group < scenario->groups + scenario->group_count && group->behaviour == BEHAVIOUR_FOLLOW;
         group++)
        tail += group->count;
    return tail;
}

/* Begins a new formation, or adds the group's vehicles to the formation before it. */
static void form(struct vehicle_placement *placement, const struct scenario_group *group)
{
    struct world_build *built = placement->built;
    struct rank *rank = &placement->rank;
    struct formation *formation = &built->formations[built->counts.formations];
    rank->group = group;
    rank->first = built->used;
    if (group->behaviour == BEHAVIOUR_FOLLOW) {
        rank->member = formation[-1].count;
        formation[-1].count += group->count;
        return;
    }
    rank->leader = rank->first;
    rank->member = 0;
    rank->along =
        group->roads && !group->placed && group->area == 0 ? &built->routes[group->route] : NULL;
    if (!group->formed)
        return;
    *formation = (struct formation){
        .first = rank->first,
        .count = group->count,
        .shape = group->shape,
        .order = group->behaviour,
        .order_arg = group->behaviour == BEHAVIOUR_ROUTE ? group->route : group->area,
        .spacing_m = group->spacing_m,
    };
    if (group->shape == FORMATION_COLUMN)
        rank->along_m = (double)tail_of(built->scenario, group) * group->spacing_m;
    else
        rank->along_m = 0.0;
    built->counts.formations++;
}

/* The entry of vehicles that is being placed. */
static uint32_t index_of(const struct vehicle_placement *placement)
{
    return (uint32_t)(placement->rank.group - placement->built->scenario->groups);
}

static int no_stand(const struct vehicle_placement *placement, uint32_t number)
{
    const struct scenario *scenario = placement->built->scenario;
    const struct scenario_group *group = placement->rank.group;
    const struct kind *kind = &scenario->kinds[group->kind];
    const struct area *area = &scenario->areas[group->area];
    return error_text_set(placement->error,
                          "%s:%d: vehicles[%u].area = [%.0f, %.0f, %.0f, %.0f]: no place for %s "
                          "number %u of %u: too crowded, or the wrong ground; right would be: a "
                          "larger area, one with more %s, or fewer vehicles",
                          scenario->settings->params.scenario, group->line, index_of(placement),
                          area->x0, area->z0, area->x1, area->z1, kind->name, number, group->count,
                          kind->domain == DOMAIN_SEA ? "deep water" : "dry and gentle ground");
}

/* Checks whether the group's kind may be where the scenario puts it. As for the command spawn, a
 * ship needs water and a land vehicle needs land. */
static int check_ground(const struct vehicle_placement *placement)
{
    const struct scenario *scenario = placement->built->scenario;
    const struct scenario_group *group = placement->rank.group;
    const struct kind *kind = &scenario->kinds[group->kind];
    bool sails = kind->domain == DOMAIN_SEA;
    if (!group->placed || free_place_carries(&placement->place.terrain, kind, group->x, group->z))
        return 0;
    return error_text_set(
        placement->error,
        "%s:%d: vehicles[%u].at = [%.15g, %.15g]: a %s would stand %s; right would be: a "
        "place %s",
        scenario->settings->params.scenario, group->line, index_of(placement), group->x, group->z,
        kind->name, sails ? "on dry land" : "in the water", sails ? "on water" : "on land");
}

static int build_group(struct vehicle_placement *placement, const struct scenario_group *group)
{
    struct world_build *built = placement->built;
    const struct scenario *scenario = built->scenario;
    form(placement, group);
    if (check_ground(placement) != 0)
        return -1;
    for (uint32_t i = 0; i < group->count; i++) {
        uint32_t slot = built->used;
        struct stand stand;
        if (scenario->placing && slot % PLACING_STEP == 0)
            scenario->placing(slot, scenario->settings->params.initial_entities);
        if (slot >= scenario->settings->params.capacity)
            return error_text_set(placement->error,
                                  "%s:%d: vehicles[%u].count: more vehicles than world.capacity = "
                                  "%u; raise it (at most %u) or lower a count",
                                  scenario->settings->params.scenario, group->line,
                                  index_of(placement), scenario->settings->params.capacity,
                                  CAPACITY_MAX);
        if (find_stand(placement, slot, &stand) != 0)
            return no_stand(placement, i + 1);
        if (free_place_take(&placement->place, stand.x, stand.z,
                            fixed_index_of_kind(&scenario->kinds[group->kind])) != 0)
            return error_text_memory(placement->error);
        put_entity(placement, slot, &stand);
        if (slot == placement->rank.leader)
            placement->rank.heading = stand.heading;
        if (group->name[0] != '\0')
            snprintf(built->names[slot].text, ENTITY_NAME_MAX, group->count > 1 ? "%.15s-%u" : "%s",
                     group->name, i + 1);
        built->used++;
    }
    return 0;
}

static struct force_base middle_of(const struct entities *e, uint32_t used, uint32_t force,
                                   double side_m)
{
    double x = 0.0, z = 0.0, count = 0.0;
    for (uint32_t i = 0; i < used; i++) {
        if (e->row[i].force != force)
            continue;
        x += e->row[i].x;
        z += e->row[i].z;
        count += 1.0;
    }
    return count > 0.0 ? (struct force_base){x / count, z / count}
                       : (struct force_base){0.5 * side_m, 0.5 * side_m};
}

/* Returns the place of the force's land vehicle that is nearest to the middle of the force, since
 * the middle itself may be in a lake or on a cliff. Without land vehicles it is the middle. */
static struct force_base base_of(const struct world_build *built, uint32_t force)
{
    const struct entities *e = &built->first;
    struct force_base middle = middle_of(e, built->used, force, built->counts.side_m),
                      base = middle;
    double least = INFINITY;
    for (uint32_t i = 0; i < built->used; i++) {
        double dx = e->row[i].x - middle.x, dz = e->row[i].z - middle.z;
        if (e->row[i].force == force && dx * dx + dz * dz < least &&
            built->scenario->kinds[e->row[i].kind].domain == DOMAIN_LAND) {
            least = dx * dx + dz * dz;
            base = (struct force_base){e->row[i].x, e->row[i].z};
        }
    }
    return base;
}

/* Sets the bases that the scenario does not give: in the middle of the force; without vehicles in
 * the middle of the map. */
static void set_bases(struct world_build *built)
{
    for (uint32_t force = 0; force < FORCE_COUNT; force++)
        built->base[force] = built->scenario->based[force]
                                 ? built->scenario->settings->params.base[force]
                                 : base_of(built, force);
}

int vehicle_placement_build(struct world_build *built, struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    uint32_t capacity = scenario->settings->params.capacity;
    struct terrain terrain = world_build_terrain(built);
    struct vehicle_placement placement = {.built = built, .error = error};
    int result = 0;
    built->first_memory = aligned_alloc(TABLE_ALIGN, entities_bytes(capacity));
    built->names = calloc(capacity, sizeof *built->names);
    built->formations = calloc(scenario->group_count + 1, sizeof *built->formations);
    if (!built->first_memory || !built->names || !built->formations)
        return error_text_memory(error);
    memset(built->first_memory, 0, entities_bytes(capacity));
    entities_bind(&built->first, capacity, built->first_memory);
    if (free_place_init(&placement.place, &terrain, built->fixed, scenario->kinds,
                        built->reach_start, built->reach, scenario->settings->params.seed) != 0)
        return error_text_memory(error);
    for (uint32_t g = 0; g < scenario->group_count && result == 0; g++)
        result = build_group(&placement, &scenario->groups[g]);
    free_place_free(&placement.place);
    set_bases(built);
    built->counts.names = built->used;
    return result;
}
