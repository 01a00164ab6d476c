/* One script for each vehicle, or for the leader of a formation. */
#include "world/making/script_build.h"

#include "world/entity/entity.h"
#include "world/entity/formation.h"
#include "world/entity/kind.h"
#include "world/entity/script.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/making/world_build.h"
#include "world/maths/maths.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#define IN_TIME_SHARE 1.001 /* of full speed: tolerance for rounding */
#define LEANS         0.125 /* of a helicopter's length, by which its nose or its tail goes down */
#define THERE_M       1.0   /* a vehicle this near to its first point is there at time 0 */

/* A script that is being copied to a vehicle. */
struct copy {
    struct world_build *built;
    const struct scenario_script *from;
    const struct scenario_group *group;
    const struct name_index *name_index;
    struct error_text *error;
    uint32_t slot;       /* of the vehicle */
    double off_x, off_z; /* its place relative to the group's first vehicle */
};

static bool goes(const struct script_step *step)
{
    return step->type == STEP_GO || step->type == STEP_ARRIVE;
}

/* Returns true for steps at which the vehicle halts, and for the last step. */
static bool stands(const struct scenario_script *script, const struct scenario_step *steps,
                   uint32_t index)
{
    if (index + 1 == script->count)
        return !script->repeats;
    enum step_type type = (enum step_type)steps[index + 1].step.type;
    return type == STEP_FACE || type == STEP_STOP || type == STEP_WAIT || type == STEP_FIRE_AT;
}

static const char *file_of(const struct copy *copy)
{
    return copy->from->file[0] != '\0' ? copy->from->file
                                       : copy->built->scenario->settings->params.scenario;
}

bool script_build_start(const struct scenario *scenario, uint32_t script, double first[2],
                        double next[2])
{
    const struct scenario_script *from = &scenario->scripts[script];
    uint32_t found = 0;
    for (uint32_t i = from->first; i < from->first + from->count && found < 2; i++) {
        const struct script_step *step = &scenario->steps[i].step;
        if (!goes(step))
            continue;
        double *point = found++ == 0 ? first : next;
        point[0] = step->x;
        point[1] = step->z;
    }
    if (found == 1)
        memcpy(next, first, 2 * sizeof *next);
    return found > 0;
}

static int check_ground(const struct copy *copy, const struct scenario_step *from,
                        const struct script_step *step)
{
    const struct kind *kind = &copy->built->scenario->kinds[copy->group->kind];
    struct terrain terrain = world_build_terrain(copy->built);
    bool water = cover_is_water(terrain_cover(&terrain, step->x, step->z));
    if (!goes(step) || kind->domain == DOMAIN_AIR || (kind->domain == DOMAIN_SEA) == water)
        return 0;
    return error_text_set(copy->error,
                          "%s:%d: script \"%s\": [%.0f, %.0f] is %s, where no %s goes; right would "
                          "be: a point on %s",
                          file_of(copy), from->line, copy->from->name, step->x, step->z,
                          water ? "water" : "land", kind->name, water ? "land" : "water");
}

/* Checks whether the vehicle can be here at this time if it was there at that time. */
static int check_pace(const struct copy *copy, const struct scenario_step *from, double x, double z,
                      double time_s)
{
    const struct kind *kind = &copy->built->scenario->kinds[copy->group->kind];
    double dx = from->step.x - x, dz = from->step.z - z, metres = sqrt(dx * dx + dz * dz);
    double seconds = from->step.at_s - time_s;
    if (metres <= kind->max_speed_mps * seconds * IN_TIME_SHARE + THERE_M)
        return 0;
    return error_text_set(copy->error,
                          "%s:%d: script \"%s\": %.0f m in %.15g s is more than the %.4g m/s of a "
                          "%s; right would be: there at %.1f s or later",
                          file_of(copy), from->line, copy->from->name, metres, seconds,
                          kind->max_speed_mps, kind->name,
                          time_s + ceil(10.0 * metres / kind->max_speed_mps) / 10.0);
}

/* Checks each arrival that directly follows another, and the first from where the vehicle
 * starts. */
static int check_paces(const struct copy *copy)
{
    const struct scenario *scenario = copy->built->scenario;
    const struct entities *e = &copy->built->first;
    double x = e->row[copy->slot].x - copy->off_x, z = e->row[copy->slot].z - copy->off_z,
           time_s = 0.0;
    bool known = true;
    for (uint32_t i = 0; i < copy->from->count; i++) {
        const struct scenario_step *from = &scenario->steps[copy->from->first + i];
        bool arrives = from->step.type == STEP_ARRIVE;
        if (arrives && known && check_pace(copy, from, x, z, time_s) != 0)
            return -1;
        known = arrives;
        x = from->step.x;
        z = from->step.z;
        time_s = from->step.at_s;
    }
    return 0;
}

static int give_order(const struct copy *copy, const struct scenario_step *from,
                      struct script_step *step)
{
    const struct scenario_group *group = copy->group;
    if (step->behaviour != BEHAVIOUR_ROUTE) {
        step->order_arg = group->area;
        return 0;
    }
    step->order_arg = group->route;
    return group->route != UINT32_MAX
               ? 0
               : error_text_set(copy->error,
                                "%s:%d: script \"%s\": behaviour = \"route\" has no route; right "
                                "would be: route = ( [x, z], [x, z] ) with the vehicle",
                                file_of(copy), from->line, copy->from->name);
}

/* Checks whether the vehicle can stand, and whether it can fire, and at another one. */
static int check_ability(const struct copy *copy, const struct scenario_step *from,
                         const struct script_step *step)
{
    const struct kind *kind = &copy->built->scenario->kinds[copy->group->kind];
    if (step->type == STEP_STOP && kind->min_speed_mps > 0.0)
        return error_text_set(copy->error,
                              "%s:%d: script \"%s\": stop = true: a %s cannot stand; right would "
                              "be: wait_s, in which it flies straight on",
                              file_of(copy), from->line, copy->from->name, kind->name);
    if (step->type != STEP_FIRE && step->type != STEP_FIRE_AT)
        return 0;
    if (kind->munition == KIND_NONE)
        return error_text_set(copy->error,
                              "%s:%d: script \"%s\": a %s fires, which has no munition; right "
                              "would be: an armed vehicle, or a script without this step",
                              file_of(copy), from->line, copy->from->name, kind->name);
    if (step->type == STEP_FIRE && step->target_slot == copy->slot)
        return error_text_set(copy->error,
                              "%s:%d: script \"%s\": fire = \"%s\": is the vehicle itself; right "
                              "would be: another vehicle",
                              file_of(copy), from->line, copy->from->name, from->target);
    return 0;
}

/* Checks whether a helicopter can fly so low: it leans to gain and lose speed, and its nose or its
 * tail would touch the ground. */
static int check_height(const struct copy *copy, const struct scenario_step *from,
                        const struct script_step *step)
{
    const struct kind *kind = &copy->built->scenario->kinds[copy->group->kind];
    double least = ceil(10.0 * (LEANS * kind->length_m - kind->low_m)) / 10.0;
    if (!kind_hovers(kind) || step->type == STEP_BEHAVIOUR || step->type == STEP_CONTROLS ||
        step->altitude_m >= least || step->altitude_m <= 0.0)
        return 0;
    return error_text_set(copy->error,
                          "%s:%d: script \"%s\": altitude_m = %.1f: the nose of a %s that leans "
                          "would touch the ground; right would be: %.1f or more, or 0 to set down",
                          file_of(copy), from->line, copy->from->name, step->altitude_m, kind->name,
                          least);
}

static int copy_step(const struct copy *copy, uint32_t index, double *altitude_m,
                     struct script_step *step)
{
    const struct scenario *scenario = copy->built->scenario;
    const struct scenario_step *steps = &scenario->steps[copy->from->first];
    const struct scenario_step *from = &steps[index];
    *step = from->step;
    if (goes(step)) {
        step->x = maths_clamp(step->x + copy->off_x, 0.0, scenario->settings->side_m);
        step->z = maths_clamp(step->z + copy->off_z, 0.0, scenario->settings->side_m);
        step->halt = stands(copy->from, steps, index);
    }
    if (step->altitude_m >= 0.0)
        *altitude_m = step->altitude_m;
    step->altitude_m = *altitude_m;
    step->target_slot = SLOT_NONE;
    step->next_due = UINT32_MAX;
    if (name_index_find(copy->name_index, from->target, &step->target_slot) != 0)
        return error_text_set(
            copy->error,
            "%s:%d: script \"%s\": fire = \"%s\": no vehicle has that name; right would "
            "be: a name that vehicles gives, of a group with a number: \"NAME-1\"",
            file_of(copy), from->line, copy->from->name, from->target);
    if (step->type == STEP_BEHAVIOUR && give_order(copy, from, step) != 0)
        return -1;
    if (check_ability(copy, from, step) != 0 || check_height(copy, from, step) != 0)
        return -1;
    return check_ground(copy, from, step);
}

/* Sets for each step the one that cuts it off. Returns the last begin time. */
static double link_dues(struct script_step *steps, uint32_t count)
{
    uint32_t due = UINT32_MAX;
    double last_s = 0.0;
    for (uint32_t i = count; i-- > 0;) {
        steps[i].next_due = due;
        if (steps[i].at_s >= 0.0 && steps[i].type != STEP_ARRIVE)
            due = i;
        last_s = maths_max(last_s, steps[i].at_s);
    }
    return last_s;
}

static int copy_script(const struct copy *copy)
{
    struct world_build *built = copy->built;
    const struct kind *kind = &built->scenario->kinds[copy->group->kind];
    struct counts *counts = &built->counts;
    struct script *script = &built->scripts[counts->scripts];
    struct script_step *steps = &built->steps[counts->script_steps];
    double altitude = copy->group->floating ? copy->group->altitude_m : kind->cruise_altitude_m;
    *script = (struct script){.first = counts->script_steps,
                              .count = copy->from->count,
                              .reacts = copy->from->reacts,
                              .repeats = copy->from->repeats};
    memcpy(script->name, copy->from->name, sizeof script->name);
    for (uint32_t i = 0; i < script->count; i++) {
        if (copy_step(copy, i, &altitude, &steps[i]) != 0)
            return -1;
    }
    double last_s = link_dues(steps, script->count);
    script->period_s = script->repeats ? last_s : 0.0;
    built->first.row[copy->slot].order_arg = counts->scripts++;
    counts->script_steps += script->count;
    return check_paces(copy);
}

/* Gives scripts to the vehicles of one group, whose first one is in this slot. */
static int give_scripts(struct copy *copy, uint32_t first)
{
    struct world_build *built = copy->built;
    const struct entities *e = &built->first;
    uint32_t count = copy->group->formed ? 1 : copy->group->count;
    copy->from = &built->scenario->scripts[copy->group->script];
    for (uint32_t i = 0; i < count; i++) {
        copy->slot = first + i;
        copy->off_x = e->row[first + i].x - e->row[first].x;
        copy->off_z = e->row[first + i].z - e->row[first].z;
        if (copy_script(copy) != 0)
            return -1;
    }
    for (uint32_t f = 0; f < built->counts.formations; f++) {
        if (built->formations[f].first == first)
            built->formations[f].order_arg = e->row[first].order_arg;
    }
    return 0;
}

int script_build_build(struct world_build *built, const struct name_index *name_index,
                       struct error_text *error)
{
    const struct scenario *scenario = built->scenario;
    struct copy copy = {.built = built, .name_index = name_index, .error = error};
    uint64_t steps = 0, scripts = 0;
    uint32_t slot = 0;
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        const struct scenario_group *group = &scenario->groups[g];
        uint64_t count = group->formed ? 1 : group->count;
        if (group->script == UINT32_MAX)
            continue;
        scripts += count;
        steps += count * scenario->scripts[group->script].count;
    }
    if (steps > SCRIPT_STEPS_MAX)
        return error_text_set(
            error,
            "%s: the vehicles' scripts have %llu steps; allowed: up to %u in all; "
            "right would be: formations, whose leader alone has one",
            scenario->settings->params.scenario, (unsigned long long)steps, SCRIPT_STEPS_MAX);
    built->scripts = calloc(scripts + 1, sizeof *built->scripts);
    built->steps = calloc(steps + 1, sizeof *built->steps);
    if (!built->scripts || !built->steps)
        return error_text_memory(error);
    for (uint32_t g = 0; g < scenario->group_count; g++) {
        copy.group = &scenario->groups[g];
        if (copy.group->script != UINT32_MAX && give_scripts(&copy, slot) != 0)
            return -1;
        slot += copy.group->count;
    }
    return 0;
}
