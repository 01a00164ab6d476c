/* Copies the columns of a row into an entity of the topics. */
#include "reporter/entity_sample.h"

#include "world/entity/grounded.h"
#include "world/entity/spool.h"
#include "world/params.h"
#include "world/pull_up.h"

_Static_assert((int)jolon_ENTITY_FREE == (int)ENTITY_FREE &&
                   (int)jolon_ENTITY_WRECK == (int)ENTITY_WRECK,
               "entity states in ipc/topics/status.idl");
_Static_assert((int)jolon_GEAR_LOW == (int)GEAR_LOW && (int)GEAR_COUNT == (int)jolon_GEAR_LOW + 1,
               "gears in ipc/topics/status.idl");

jolon_Entity entity_sample_of(const struct world *world, const struct snapshot *snapshot,
                              uint32_t row)
{
    const struct entities *from = &snapshot->entities;
    const struct kind *kind = &world->kinds[from->kind[row]];
    const uint64_t ready = from->reload_tick[row], tick = snapshot->head.tick;
    return (jolon_Entity){
        .id = from->id[row],
        .kind = from->kind[row],
        .state = (jolon_EntityState)from->state[row],
        .force = (jolon_Force)from->force[row],
        .behaviour = (jolon_Behaviour)from->behaviour[row],
        .damage = (jolon_Damage)from->damage[row],
        .x_m = from->x[row],
        .y_m = from->y[row],
        .z_m = from->z[row],
        .vx_mps = (float)from->vx[row],
        .vy_mps = (float)from->vy[row],
        .vz_mps = (float)from->vz[row],
        .heading_rad = (float)from->heading[row],
        .pitch_rad = (float)from->pitch[row],
        .roll_rad = (float)from->roll[row],
        .turret_rad = from->turret[row],
        .gun_rad = from->gun[row],
        .target = from->target_id[row],
        .rounds = from->rounds[row],
        .fuel_l = (float)from->fuel_l[row],
        .driver = from->driver[row],
        .throttle = from->throttle[row],
        .gear = (jolon_Gear)entity_gear(from->flags[row]),
        .spool = (float)spool_of(from, kind, row),
        .grounded = grounded_of(from, kind, row),
        .pull_up = pull_up_of(world, from, row),
        .reload_s = ready > tick ? (float)((double)(ready - tick) * world_dt_s(world)) : 0.0f,
    };
}
