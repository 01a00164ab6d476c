/* Compares what receivers compute with what is. */
#include "ipc/frame/motion_table.h"

#include "world/cruise_pose.h"
#include "world/entity/cruise.h"
#include "world/entity/grounded.h"
#include "world/entity/spool.h"
#include "world/params.h"
#include "world/pull_up.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

int motion_table_init(struct motion_table *table, uint32_t capacity)
{
    *table = (struct motion_table){.capacity = capacity};
    table->told = calloc(capacity, sizeof *table->told);
    return table->told ? 0 : -1;
}

void motion_table_free(struct motion_table *table)
{
    free(table->told);
    *table = (struct motion_table){0};
}

void motion_table_clear(struct motion_table *table)
{
    memset(table->told, 0, table->used * sizeof *table->told);
    table->used = 0;
}

static struct motion_marks marks_of(const struct world *world, const struct entities *e,
                                    uint32_t row)
{
    const struct kind *kind = &world->kinds[e->row[row].kind];
    return (struct motion_marks){.driver = e->row[row].driver,
                                 .target = e->row[row].target_id,
                                 .rounds = e->row[row].rounds,
                                 .reload_tick = e->row[row].reload_tick,
                                 .turret = e->row[row].turret,
                                 .gun = e->row[row].gun,
                                 .fuel_l = (float)e->row[row].fuel_l,
                                 .throttle = e->row[row].throttle,
                                 .spool = (float)spool_of(e, kind, row),
                                 .kind = e->row[row].kind,
                                 .state = e->row[row].state,
                                 .force = e->row[row].force,
                                 .behaviour = e->row[row].behaviour,
                                 .damage = e->row[row].damage,
                                 .gear = (uint8_t)entity_gear(e->row[row].flags),
                                 .grounded = grounded_of(e, kind, row),
                                 .pull_up = pull_up_of(world, e, row)};
}

static bool off(double a, double b, double most)
{
    return fabs(a - b) > most;
}

/* share: of the tolerances, 0 for none. */
static bool marks_differ(const struct motion_marks *told, const struct motion_marks *now,
                         const struct kind *kind, double share)
{
    const double angle = share * MOTION_TABLE_OFF_RAD, part = share * MOTION_TABLE_OFF_SHARE;
    return told->driver != now->driver || told->target != now->target ||
           told->rounds != now->rounds || told->reload_tick != now->reload_tick ||
           told->kind != now->kind || told->state != now->state || told->force != now->force ||
           told->behaviour != now->behaviour || told->damage != now->damage ||
           told->gear != now->gear || told->grounded != now->grounded ||
           told->pull_up != now->pull_up || off((double)told->turret, (double)now->turret, angle) ||
           off((double)told->gun, (double)now->gun, angle) ||
           off((double)told->fuel_l, (double)now->fuel_l, part * kind->fuel_l) ||
           off((double)told->throttle, (double)now->throttle, part) ||
           off((double)told->spool, (double)now->spool, part);
}

static bool turned(double told_rad, double now_rad, double share)
{
    return off(maths_wrap_half(told_rad - now_rad), 0.0, share * MOTION_TABLE_OFF_RAD);
}

/* Returns true if receivers have the row farther off than the share of the tolerances. */
static bool motion_differs(const struct motion_told *told, const struct world *world,
                           const struct entities *e, uint32_t i, uint64_t tick, double share)
{
    const double dt_s = world_dt_s(world);
    const bool cruises = cruise_goes(e, i, tick);
    if (cruises && e->row[i].cruise_tick == told->row_tick && e->row[i].x == told->row_x &&
        e->row[i].z == told->row_z)
        return false;
    struct told_motion then = told->motion;
    if (told->motion.lasts_s > 0.0F || vec3_dot(then.velocity, then.velocity) > 0.0)
        then = told_motion_at(&told->motion, (double)(tick - told->tick) * dt_s);
    struct vec3 at = vec3_sub(then.at, cruise_position(e, i, tick, dt_s));
    struct vec3 velocity = vec3_sub(then.velocity, cruise_velocity(e, i, tick, dt_s));
    if (off(vec3_length(at), 0.0, share * MOTION_TABLE_OFF_M) ||
        off(vec3_length(velocity), 0.0, share * MOTION_TABLE_OFF_MPS) ||
        turned(then.heading_rad, cruise_heading(e, i, tick, dt_s), share))
        return true;
    /* A land vehicle that cruises leans as the ground does, which is not looked up for this. */
    if (cruises && world->kinds[e->row[i].kind].domain == DOMAIN_LAND)
        return false;
    return turned(then.pitch_rad, cruise_pitch(e, i, tick, dt_s), share) ||
           turned(then.roll_rad, cruise_roll(e, i, tick, dt_s), share);
}

static void tell(struct motion_table *table, uint32_t row)
{
    table->told[row].next_frame = table->frame + 1;
    table->told[row].tick = table->tick;
    table->count++;
}

static void update_row(struct motion_table *table, const struct world *world,
                       const struct snapshot *snapshot, uint32_t row)
{
    struct motion_told *told = &table->told[row];
    const struct entities *e = &snapshot->entities;
    if (row >= snapshot->head.used || e->row[row].state == ENTITY_FREE) {
        if (told->marks.state != ENTITY_FREE) {
            told->marks.state = ENTITY_FREE;
            tell(table, row);
        }
        return;
    }
    const struct kind *kind = &world->kinds[e->row[row].kind];
    struct motion_marks marks = marks_of(world, e, row);
    double share = e->row[row].driver != 0 ? 0.0 : 1.0; /* who drives sees everything */
    if (told->id == e->row[row].id && !marks_differ(&told->marks, &marks, kind, share) &&
        !motion_differs(told, world, e, row, table->tick, share))
        return;
    told->motion = cruise_pose_motion(world, &snapshot->craters, e, row, table->tick);
    told->row_x = e->row[row].x;
    told->row_z = e->row[row].z;
    told->row_tick = e->row[row].cruise_tick;
    told->id = e->row[row].id;
    told->marks = marks;
    tell(table, row);
}

void motion_table_update(struct motion_table *table, const struct world *world,
                         struct snapshot *snapshot)
{
    const struct state_head *head = &snapshot->head;
    table->frame = head->frame;
    table->tick = head->tick;
    table->count = 0;
    if (table->used == 0)
        table->from_frame = head->frame;
    if (world->params->cruise)
        crater_index_update(&snapshot->craters, head->crater_count);
    uint32_t rows = head->used > table->used ? head->used : table->used;
    for (uint32_t row = 0; row < rows; row++)
        update_row(table, world, snapshot, row);
    table->used = rows;
}
