/* Choices of vehicles and targets. */
#include "clients/drive/vehicle_choice.h"

#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/runtime/parse_number.h"

#include <string.h>

bool vehicle_choice_drivable(const struct world_mirror *mirror, const jolon_Entity *entity)
{
    const jolon_KindInfo *kind = world_mirror_kind(mirror, entity->kind);
    return kind && kind->domain <= jolon_DOMAIN_AIR && entity->state == jolon_ENTITY_ACTIVE;
}

static bool is_candidate(const struct world_mirror *mirror, const struct vehicle_choice *choice,
                         const jolon_Entity *entity)
{
    return vehicle_choice_drivable(mirror, entity) && entity->id != choice->from &&
           (entity->driver == 0 || entity->driver == choice->source) &&
           (choice->force < 0 || (int)entity->force == choice->force) &&
           (choice->kind < 0 || (int)entity->kind == choice->kind);
}

struct relative_position vehicle_choice_relative(const jolon_Entity *from, const jolon_Entity *to)
{
    double dx = to->x_m - from->x_m, dz = to->z_m - from->z_m;
    return (struct relative_position){.bearing_rad = maths_heading(dx, dz),
                                      .distance_m = sqrt(dx * dx + dz * dz),
                                      .up_m = to->y_m - from->y_m};
}

uint32_t vehicle_choice_next(const struct world_mirror *mirror, const struct vehicle_choice *choice,
                             int by)
{
    uint32_t first = 0, next = 0; /* first: where the search starts again after the last id */
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        if (!is_candidate(mirror, choice, entity))
            continue;
        uint32_t id = entity->id;
        if (first == 0 || (by > 0 ? id < first : id > first))
            first = id;
        if ((by > 0 ? id > choice->from : id < choice->from) &&
            (next == 0 || (by > 0 ? id < next : id > next)))
            next = id;
    }
    return next ? next : first;
}

uint32_t vehicle_choice_nearest(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice)
{
    const jolon_Entity *self = world_mirror_entity(mirror, choice->from);
    uint32_t nearest = 0;
    double nearest_m = 0.0;
    if (!self)
        return vehicle_choice_next(mirror, choice, 1);
    for (uint32_t i = 0; i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        if (!is_candidate(mirror, choice, entity))
            continue;
        double distance_m = vehicle_choice_relative(self, entity).distance_m;
        if (nearest == 0 || distance_m < nearest_m) {
            nearest = entity->id;
            nearest_m = distance_m;
        }
    }
    return nearest;
}

static int find_kind(const struct world_mirror *mirror, const char *text)
{
    for (uint32_t i = 0; mirror->has_world && i < mirror->world.kinds._length; i++) {
        if (mirror->kinds[i].domain <= jolon_DOMAIN_AIR && strcmp(mirror->kinds[i].name, text) == 0)
            return (int)i;
    }
    return -1;
}

static int find_force(const char *text)
{
    for (int i = 0; i < FORCE_COUNT; i++) {
        if (strcmp(force_name((enum force)i), text) == 0)
            return i;
    }
    return -1;
}

uint32_t vehicle_choice_by_text(const struct world_mirror *mirror,
                                const struct vehicle_choice *choice, const char *text,
                                struct error_text *error)
{
    struct vehicle_choice narrowed = *choice;
    uint64_t number;
    bool is_number = parse_whole(text, 0, UINT64_MAX, &number);
    uint32_t id = is_number && number <= UINT32_MAX ? (uint32_t)number : 0;
    if (!is_number)
        id = name_table_find(&mirror->names, text);
    if (id != 0 && world_mirror_entity(mirror, id))
        return id;
    narrowed.kind = is_number ? -1 : find_kind(mirror, text);
    narrowed.force = is_number || narrowed.kind >= 0 ? choice->force : find_force(text);
    if (id == 0 && !is_number && (narrowed.kind >= 0 || narrowed.force >= 0))
        id = vehicle_choice_nearest(mirror, &narrowed);
    else
        id = 0;
    if (id == 0)
        (void)error_text_set(
            error,
            "no vehicle \"%s\" is free in world \"%s\": give an id, a name, a kind "
            "or a force; `jolon world dump -w %s` lists them",
            text, mirror->name, mirror->name);
    return id;
}

static bool enemies(const jolon_Entity *a, const jolon_Entity *b)
{
    return a->force != b->force &&
           (a->force == jolon_FORCE_NEUTRAL || b->force != jolon_FORCE_NEUTRAL);
}

static bool ahead(const struct relative_position *sight, double bearing_rad, double cone_rad,
                  double range_m)
{
    return sight->distance_m <= range_m &&
           fabs(maths_wrap_half(sight->bearing_rad - bearing_rad)) <= cone_rad;
}

uint32_t vehicle_choice_target(const struct world_mirror *mirror, const jolon_Entity *self,
                               uint32_t present, double bearing_rad, double cone_rad,
                               double range_m)
{
    const jolon_Entity *old = world_mirror_entity(mirror, present);
    double beyond_m = old ? vehicle_choice_relative(self, old).distance_m : -1.0;
    double first_m = 0.0, next_m = 0.0;
    uint32_t first = 0, next = 0;
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        struct relative_position sight = vehicle_choice_relative(self, entity);
        if (entity->id == self->id || !vehicle_choice_drivable(mirror, entity) ||
            !enemies(self, entity) || !ahead(&sight, bearing_rad, cone_rad, range_m))
            continue;
        if (first == 0 || sight.distance_m < first_m) {
            first = entity->id;
            first_m = sight.distance_m;
        }
        if (sight.distance_m > beyond_m && entity->id != present &&
            (next == 0 || sight.distance_m < next_m)) {
            next = entity->id;
            next_m = sight.distance_m;
        }
    }
    return next ? next : first;
}

const jolon_Entity *vehicle_choice_seen(const struct world_mirror *mirror, const jolon_Entity *self,
                                        double bearing_rad, double cone_rad, double range_m)
{
    const jolon_Entity *seen = NULL;
    double seen_m = 0.0;
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *entity = &mirror->batch.entity[i];
        const jolon_KindInfo *kind = world_mirror_kind(mirror, entity->kind);
        struct relative_position sight = vehicle_choice_relative(self, entity);
        if (entity->id == self->id || !kind || kind->domain > jolon_DOMAIN_AIR ||
            !ahead(&sight, bearing_rad, cone_rad, range_m) || (seen && sight.distance_m >= seen_m))
            continue;
        seen = entity;
        seen_m = sight.distance_m;
    }
    return seen;
}
