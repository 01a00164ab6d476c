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
    const struct kind *kind = &world->kinds[from->row[row].kind];
    const uint64_t ready = from->row[row].reload_tick, tick = snapshot->head.tick;
    return (jolon_Entity){
        .id = from->row[row].id,
        .kind = from->row[row].kind,
        .state = (jolon_EntityState)from->row[row].state,
        .force = (jolon_Force)from->row[row].force,
        .behaviour = (jolon_Behaviour)from->row[row].behaviour,
        .damage = (jolon_Damage)from->row[row].damage,
        .x_m = from->row[row].x,
        .y_m = from->row[row].y,
        .z_m = from->row[row].z,
        .vx_mps = (float)from->row[row].vx,
        .vy_mps = (float)from->row[row].vy,
        .vz_mps = (float)from->row[row].vz,
        .heading_rad = (float)from->row[row].heading,
        .pitch_rad = (float)from->row[row].pitch,
        .roll_rad = (float)from->row[row].roll,
        .turret_rad = from->row[row].turret,
        .gun_rad = from->row[row].gun,
        .target = from->row[row].target_id,
        .rounds = from->row[row].rounds,
        .fuel_l = (float)from->row[row].fuel_l,
        .driver = from->row[row].driver,
        .throttle = from->row[row].throttle,
        .gear = (jolon_Gear)entity_gear(from->row[row].flags),
        .spool = (float)spool_of(from, kind, row),
        .grounded = grounded_of(from, kind, row),
        .pull_up = pull_up_of(world, from, row),
        .reload_s = ready > tick ? (float)((double)(ready - tick) * world_dt_s(world)) : 0.0f,
    };
}
