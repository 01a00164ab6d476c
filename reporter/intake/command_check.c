/* The check of commands from outside: key, type, names, numbers and their ranges. */
#include "reporter/intake/command_check.h"

#include "world/entity/entity.h"
#include "world/entity/kind.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#include <math.h>

/* The enumerations of status.idl are those of the world, so values need no translation. */
_Static_assert((int)jolon_COMMAND_QUIT == (int)COMMAND_QUIT &&
                   (int)COMMAND_TYPE_COUNT == (int)jolon_COMMAND_QUIT + 1,
               "command types in ipc/topics/status.idl");
_Static_assert((int)jolon_RESULT_REMOTE == (int)COMMAND_REMOTE &&
                   (int)COMMAND_RESULT_COUNT == (int)jolon_RESULT_REMOTE + 1,
               "command results in ipc/topics/status.idl");
_Static_assert((int)jolon_FORCE_RED == (int)FORCE_RED && (int)FORCE_COUNT == FORCE_RED + 1,
               "forces in ipc/topics/status.idl");
_Static_assert((int)jolon_BEHAVIOUR_REMOTE == (int)BEHAVIOUR_REMOTE &&
                   (int)BEHAVIOUR_COUNT == (int)jolon_BEHAVIOUR_REMOTE + 1,
               "behaviours in ipc/topics/status.idl");
_Static_assert((int)jolon_GEAR_LOW == (int)GEAR_LOW && (int)GEAR_COUNT == (int)jolon_GEAR_LOW + 1,
               "gears in ipc/topics/status.idl");
_Static_assert(sizeof((jolon_Command *)0)->kind == KIND_NAME_MAX,
               "kind names in ipc/topics/status.idl");

/* Returns false also for NaN. */
static bool within(double value, double low, double high)
{
    return value >= low && value <= high;
}

static enum command_result check_drive(struct command *command, const jolon_Command *wire)
{
    if (!within(wire->throttle, -1.0, 1.0) || !within(wire->steer, -1.0, 1.0) ||
        !within(wire->climb, -1.0, 1.0) || !within(wire->traverse, -1.0, 1.0) ||
        !within(wire->elevate, -1.0, 1.0) || !within(wire->brake, 0.0, 1.0) ||
        wire->gear > jolon_GEAR_LOW || wire->lease_frames > COMMAND_LEASE_MAX)
        return COMMAND_OUT_OF_RANGE;
    command->value[0] = wire->throttle;
    command->value[1] = wire->steer;
    command->value[2] = wire->climb;
    command->value[3] = wire->traverse;
    command->value[4] = wire->elevate;
    command->value[5] = wire->brake;
    command->force = (uint16_t)wire->gear;
    command->amount = wire->lease_frames;
    return COMMAND_DONE;
}

static enum command_result check_fire(struct command *command, const jolon_Command *wire,
                                      const struct world *world)
{
    command->target = wire->target;
    if (wire->entity)
        return COMMAND_DONE;
    command->kind = kind_find(world->kinds, world->counts.kinds, wire->kind);
    if (command->kind == KIND_NONE || world->kinds[command->kind].domain != DOMAIN_MUNITION)
        return COMMAND_NO_SUCH_KIND;
    if (!world_holds(world, wire->x_m, wire->z_m))
        return COMMAND_OUT_OF_RANGE;
    command->value[0] = wire->x_m;
    command->value[1] = wire->z_m;
    return COMMAND_DONE;
}

static enum command_result check_spawn(struct command *command, const jolon_Command *wire,
                                       const struct world *world)
{
    command->kind = kind_find(world->kinds, world->counts.kinds, wire->kind);
    if (command->kind == KIND_NONE)
        return COMMAND_NO_SUCH_KIND;
    const struct kind *kind = &world->kinds[command->kind];
    if (kind->domain != DOMAIN_LAND && kind->domain != DOMAIN_SEA && kind->domain != DOMAIN_AIR)
        return COMMAND_NO_SUCH_KIND;
    bool as_it_flies = !(wire->altitude_m < -1.0) && !(wire->altitude_m > -1.0);
    if (!world_holds(world, wire->x_m, wire->z_m) || wire->behaviour > jolon_BEHAVIOUR_PATROL ||
        wire->force > jolon_FORCE_RED ||
        !(within(wire->altitude_m, 0.0, COMMAND_CHECK_ALTITUDE_MAX) || as_it_flies) ||
        !within(wire->heading_rad, -1e3, 1e3) ||
        !within(wire->speed_mps, 0.0, COMMAND_CHECK_SPEED_MAX))
        return COMMAND_OUT_OF_RANGE;
    double cruise_m = kind->domain == DOMAIN_AIR ? kind->cruise_altitude_m : 0.0;
    command->force = (uint16_t)wire->force;
    command->amount = (uint32_t)wire->behaviour;
    command->value[0] = wire->x_m;
    command->value[1] = wire->z_m;
    command->value[2] = as_it_flies ? cruise_m : wire->altitude_m;
    command->value[3] = maths_wrap_turn(wire->heading_rad);
    command->value[4] = wire->speed_mps;
    return COMMAND_DONE;
}

enum command_result command_check(struct command *command, const jolon_Command *wire,
                                  const struct world *world)
{
    *command = (struct command){
        .source = wire->source,
        .source_sequence = wire->sequence,
        .type = (uint32_t)wire->type,
        .entity = wire->entity,
        .kind = KIND_NONE,
    };
    if (!wire->source || !wire->sequence)
        return COMMAND_OUT_OF_RANGE;
    switch (wire->type) {
    case jolon_COMMAND_PAUSE:
    case jolon_COMMAND_RESUME:
    case jolon_COMMAND_QUIT:
        return COMMAND_DONE;
    case jolon_COMMAND_STEP:
        command->amount = wire->frames;
        return within(wire->frames, 1.0, COMMAND_CHECK_FRAMES_MAX) ? COMMAND_DONE
                                                                   : COMMAND_OUT_OF_RANGE;
    case jolon_COMMAND_SCALE:
        command->value[0] = wire->scale;
        return within(wire->scale, COMMAND_CHECK_SCALE_MIN, COMMAND_CHECK_SCALE_MAX)
                   ? COMMAND_DONE
                   : COMMAND_OUT_OF_RANGE;
    case jolon_COMMAND_DRIVE:
        return check_drive(command, wire);
    case jolon_COMMAND_RELEASE:
        command->amount = wire->anyway;
        return wire->entity ? COMMAND_DONE : COMMAND_NO_SUCH_ENTITY;
    case jolon_COMMAND_REMOVE:
        return wire->entity ? COMMAND_DONE : COMMAND_NO_SUCH_ENTITY;
    case jolon_COMMAND_FIRE:
        return check_fire(command, wire, world);
    case jolon_COMMAND_SPAWN:
        return check_spawn(command, wire, world);
    case jolon_COMMAND_NONE:
        break;
    }
    return COMMAND_UNKNOWN;
}
