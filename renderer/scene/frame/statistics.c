/* Reads the statistics from the columns of the snapshot. */
#include "renderer/scene/frame/statistics.h"

#include "world/entity/grounded.h"
#include "world/entity/kind.h"
#include "world/entity/remote.h"
#include "world/enum_names.h"
#include "world/world.h"

#include <stdio.h>

void statistics_of(struct statistics *statistics, const struct frame_view *frame_view,
                   uint32_t slot)
{
    const struct world *world = frame_view->world;
    const struct entities *e = frame_view->entities;
    const struct kind *kind = &world->kinds[e->row[slot].kind];
    const char *grounded = grounded_word(e, kind, slot);
    char marking[REMOTE_MARKING_MAX + 1];
    const char *own = world_row_name(world, e, slot, marking);
    *statistics = (struct statistics){
        .kind = kind->name,
        .force = force_name((enum force)e->row[slot].force),
        .state = grounded ? grounded : entity_state_name((enum entity_state)e->row[slot].state),
        .damage = damage_name((enum damage)e->row[slot].damage),
        .behaviour = behaviour_name((enum behaviour)e->row[slot].behaviour),
        .id = e->row[slot].id,
        .speed_kmh = 3.6 * vec3_length(entities_velocity(e, slot)),
        .heading_deg = maths_wrap_turn(e->row[slot].heading) * DEG_PER_RAD,
        .pitch_deg = e->row[slot].pitch * DEG_PER_RAD,
        .roll_deg = e->row[slot].roll * DEG_PER_RAD,
        .altitude_m = e->row[slot].y,
        .above_ground_m = e->row[slot].y - terrain_height(&world->terrain, frame_view->craters,
                                                          e->row[slot].x, e->row[slot].z),
        .fuel_share = kind->fuel_l > 0.0 ? e->row[slot].fuel_l / kind->fuel_l : 1.0,
        .rounds = e->row[slot].rounds,
        .rounds_full = kind->rounds,
        .frame = frame_view->head->frame,
        .time_s = frame_view_time_s(frame_view),
    };
    if (own[0] != '\0')
        snprintf(statistics->name, sizeof statistics->name, "%s", own);
    else
        snprintf(statistics->name, sizeof statistics->name, "%s %u", kind->name, e->row[slot].id);
}

void statistics_line(const struct statistics *s, char *text, size_t bytes)
{
    snprintf(text, bytes,
             "frame=%llu time_s=%.3f id=%u name=%s kind=%s force=%s state=%s damage=%s "
             "behaviour=%s speed_kmh=%.2f heading_deg=%.2f pitch_deg=%.2f roll_deg=%.2f "
             "altitude_m=%.2f rounds=%u fuel_pct=%.1f",
             (unsigned long long)s->frame, s->time_s, s->id, s->name, s->kind, s->force, s->state,
             s->damage, s->behaviour, s->speed_kmh, s->heading_deg, s->pitch_deg, s->roll_deg,
             s->altitude_m, s->rounds, 100.0 * s->fuel_share);
}
