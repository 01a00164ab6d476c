/* Statistics and notes as text. */
#include "clients/drive/status_panel.h"

#include "clients/drive/vehicle_choice.h"
#include "ipc/topics/event_lines.h"
#include "world/entity/entity.h"
#include "world/enum_names.h"
#include "world/maths/maths.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define LOOK_CONE_RAD 0.2
#define LOOK_RANGE_M  5000.0
#define GAUGE_CELLS   10

/* A damaged land vehicle does not drive if it stands with so much throttle. */
#define STOPPED_THROTTLE 0.3
#define STOPPED_MPS      0.2

static double degrees(float rad)
{
    return (double)rad * DEG_PER_RAD;
}

static double speed_of(const jolon_Entity *e)
{
    return vec3_length((struct vec3){(double)e->vx_mps, (double)e->vy_mps, (double)e->vz_mps});
}

static const char *state_name(const struct session *session)
{
    static const char *const names[] = {"waiting", "watching", "taking", "driving"};
    return names[session->state];
}

void status_panel_line(char line[STATUS_PANEL_LINE], const struct session *session)
{
    const struct world_mirror *mirror = session->mirror;
    const jolon_Entity *e = session_entity(session);
    int used = snprintf(line, STATUS_PANEL_LINE, "frame=%llu session=%s",
                        (unsigned long long)(e ? mirror->batch.frame : mirror->frame.frame),
                        state_name(session));
    if (!e)
        return;
    (void)snprintf(
        line + used, STATUS_PANEL_LINE - (size_t)used,
        " id=%u name=%s kind=%s force=%s state=%s damage=%s behaviour=%s x_m=%.2f z_m=%.2f "
        "speed_mps=%.3f heading_deg=%.3f pitch_deg=%.3f roll_deg=%.3f altitude_m=%.3f "
        "turret_deg=%.3f gun_deg=%.3f rounds=%u fuel_l=%.2f reload_s=%.3f throttle=%.3f gear=%s "
        "target=%u spool=%.3f grounded=%d pull_up=%d",
        e->id, name_table_of(&mirror->names, e->id), world_mirror_kind_name(mirror, e->kind),
        force_name((enum force)e->force), entity_state_name((enum entity_state)e->state),
        damage_name((enum damage)e->damage), behaviour_name((enum behaviour)e->behaviour), e->x_m,
        e->z_m, speed_of(e), degrees(e->heading_rad), degrees(e->pitch_rad), degrees(e->roll_rad),
        e->y_m, degrees(e->turret_rad), degrees(e->gun_rad), e->rounds, (double)e->fuel_l,
        (double)e->reload_s, (double)e->throttle, gear_name((enum gearing)e->gear), session->target,
        (double)e->spool, e->grounded, e->pull_up);
}

void status_panel_head(char line[STATUS_PANEL_LINE], const struct session *session, uint64_t now_ns)
{
    char label[64], time[EVENT_LINES_CLOCK_MAX];
    const struct world_mirror *mirror = session->mirror;
    const jolon_Entity *e = session_entity(session);
    (void)snprintf(line, STATUS_PANEL_LINE, "%s %s%s%s  %s %s  frame %llu  %s",
                   session->state == SESSION_DRIVING ? "driving" : state_name(session),
                   session_label(mirror, session->vehicle, label), e ? " " : "",
                   e ? force_name((enum force)e->force) : "", mirror->name,
                   world_mirror_run_state(mirror, now_ns), (unsigned long long)mirror->frame.frame,
                   event_lines_clock(time, mirror->frame.sim_time_s));
}

/* A bar for -1..1 from its middle: "[     |###  ]". */
static const char *gauge(char text[GAUGE_CELLS + 4], double value)
{
    int half = GAUGE_CELLS / 2;
    int cells = (int)(fabs(value) * half + 0.5);
    int middle = half + 1;
    memset(text, ' ', GAUGE_CELLS + 3);
    text[0] = '[';
    text[middle] = '|';
    text[GAUGE_CELLS + 2] = ']';
    text[GAUGE_CELLS + 3] = '\0';
    for (int i = 1; i <= cells && i <= half; i++)
        text[value < 0.0 ? middle - i : middle + i] = '#';
    return text;
}

/* A bar for 0..1: "[######    ]". */
static const char *level(char text[GAUGE_CELLS + 4], double share)
{
    int cells = (int)(maths_clamp(share, 0.0, 1.0) * GAUGE_CELLS + 0.5);
    (void)snprintf(text, GAUGE_CELLS + 3, "[%-*.*s]", GAUGE_CELLS, cells, "##########");
    return text;
}

static const char *compass(double heading_deg)
{
    static const char *const names[] = {"N", "NE", "E", "SE", "S", "SW", "W", "NW"};
    return names[(int)(heading_deg / 45.0 + 0.5) & 7];
}

static void put_target(char row[STATUS_PANEL_COLUMNS], char more[STATUS_PANEL_COLUMNS],
                       const struct session *session, const jolon_Entity *e)
{
    char label[64];
    const jolon_Entity *target = world_mirror_entity(session->mirror, session->target);
    if (!target) {
        (void)snprintf(row, STATUS_PANEL_COLUMNS, "target    none locked");
        return;
    }
    struct relative_position sight = vehicle_choice_relative(e, target);
    double side = maths_wrap_half(sight.bearing_rad - (double)e->heading_rad);
    (void)snprintf(row, STATUS_PANEL_COLUMNS, "target    %.25s",
                   session_label(session->mirror, target->id, label));
    (void)snprintf(more, STATUS_PANEL_COLUMNS, "          %.0f m, gun %.1f deg off",
                   sight.distance_m,
                   fabs(maths_wrap_half(side - (double)e->turret_rad)) * DEG_PER_RAD);
}

static void put_weapon(char (*row)[STATUS_PANEL_COLUMNS], const struct session *session,
                       const jolon_Entity *e, const jolon_KindInfo *kind)
{
    if (kind->rounds == 0) {
        (void)snprintf(row[0], STATUS_PANEL_COLUMNS, "rounds    none: no weapon");
        return;
    }
    (void)snprintf(row[0], STATUS_PANEL_COLUMNS, "rounds    %u of %u", e->rounds, kind->rounds);
    if (e->state != jolon_ENTITY_ACTIVE)
        (void)snprintf(row[1], STATUS_PANEL_COLUMNS, "gun       destroyed");
    else if (e->reload_s > 0.0f)
        (void)snprintf(row[1], STATUS_PANEL_COLUMNS, "gun       reloads %.1f s",
                       (double)e->reload_s);
    else
        (void)snprintf(row[1], STATUS_PANEL_COLUMNS, "gun       %s",
                       e->rounds ? "ready" : "out of rounds");
    (void)snprintf(row[2], STATUS_PANEL_COLUMNS, "turret    %+.1f deg, gun %+.1f",
                   degrees(e->turret_rad), degrees(e->gun_rad));
    put_target(row[3], row[4], session, e);
}

void status_panel_statistics(char row[STATUS_PANEL_ROWS][STATUS_PANEL_COLUMNS],
                             const struct session *session)
{
    char bar[GAUGE_CELLS + 4];
    const jolon_Entity *e = session_entity(session);
    const jolon_KindInfo *kind = e ? world_mirror_kind(session->mirror, e->kind) : NULL;
    const struct controls *c = &session->sent;
    memset(row, 0, (size_t)STATUS_PANEL_ROWS * STATUS_PANEL_COLUMNS);
    if (!kind)
        return;
    double speed = speed_of(e), heading = degrees(e->heading_rad);
    (void)snprintf(row[0], STATUS_PANEL_COLUMNS, "speed     %5.1f km/h %.13s", 3.6 * speed,
                   level(bar, speed / maths_max((double)kind->max_speed_mps, 0.1)));
    const char *grounded = !e->grounded                       ? ""
                           : kind->domain == jolon_DOMAIN_SEA ? "aground"
                                                              : "on the ground";
    (void)snprintf(row[1], STATUS_PANEL_COLUMNS, "heading   %05.1f %-3s %s", heading,
                   compass(heading), grounded);
    (void)snprintf(row[2], STATUS_PANEL_COLUMNS, "pitch     %+.1f  roll %+.1f",
                   degrees(e->pitch_rad), degrees(e->roll_rad));
    (void)snprintf(row[3], STATUS_PANEL_COLUMNS, "altitude  %.1f m%s", e->y_m,
                   e->pull_up ? "    PULL UP" : "");
    (void)snprintf(row[4], STATUS_PANEL_COLUMNS, "throttle  %+5.2f     %s", (double)e->throttle,
                   gauge(bar, (double)e->throttle));
    (void)snprintf(row[5], STATUS_PANEL_COLUMNS, "steering  %+5.2f     %s", (double)c->steer,
                   gauge(bar, (double)c->steer));
    if (kind->domain == jolon_DOMAIN_AIR)
        (void)snprintf(row[6], STATUS_PANEL_COLUMNS, "climb     %+5.2f     engine %3.0f %%",
                       (double)c->climb, 100.0 * (double)e->spool);
    else
        (void)snprintf(row[6], STATUS_PANEL_COLUMNS, "gear      %-10s brake %.2f",
                       gear_name((enum gearing)e->gear), (double)c->brake);
    put_weapon(row + 7, session, e, kind);
    if (kind->fuel_l > 0.0f)
        (void)snprintf(row[12], STATUS_PANEL_COLUMNS, "fuel      %5.1f l    %.13s",
                       (double)e->fuel_l, level(bar, (double)e->fuel_l / (double)kind->fuel_l));
    bool stopped = e->damage >= jolon_DAMAGE_MED && kind->domain == jolon_DOMAIN_LAND &&
                   fabs((double)e->throttle) > STOPPED_THROTTLE && speed < STOPPED_MPS;
    (void)snprintf(row[13], STATUS_PANEL_COLUMNS, "damage    %s%s",
                   damage_name((enum damage)e->damage), stopped ? ": it does not drive" : "");
    (void)snprintf(row[14], STATUS_PANEL_COLUMNS, "behaviour %s",
                   behaviour_name((enum behaviour)e->behaviour));
}

void status_panel_look(char line[STATUS_PANEL_LINE], const struct session *session)
{
    char label[64];
    const jolon_Entity *e = session_entity(session);
    line[0] = '\0';
    if (!e)
        return;
    double bearing = maths_wrap_turn((double)e->heading_rad + session->look_rad);
    const jolon_Entity *seen =
        vehicle_choice_seen(session->mirror, e, bearing, LOOK_CONE_RAD, LOOK_RANGE_M);
    int used = snprintf(line, STATUS_PANEL_LINE, "look %03.0f %s: ", bearing * DEG_PER_RAD,
                        compass(bearing * DEG_PER_RAD));
    if (!seen) {
        (void)snprintf(line + used, STATUS_PANEL_LINE - (size_t)used, "nothing within %.0f km",
                       LOOK_RANGE_M / 1000.0);
        return;
    }
    struct relative_position sight = vehicle_choice_relative(e, seen);
    (void)snprintf(line + used, STATUS_PANEL_LINE - (size_t)used, "%s %s%s, %.0f m at %03.0f",
                   force_name((enum force)seen->force),
                   session_label(session->mirror, seen->id, label),
                   seen->state == jolon_ENTITY_WRECK ? ", a wreck" : "", sight.distance_m,
                   sight.bearing_rad * DEG_PER_RAD);
}

void status_panel_others(char line[STATUS_PANEL_LINE], const struct session *session)
{
    char label[64];
    size_t used = 0;
    const struct world_mirror *mirror = session->mirror;
    line[0] = '\0';
    for (uint32_t i = 0; mirror->has_batch && i < mirror->batch.count; i++) {
        const jolon_Entity *e = &mirror->batch.entity[i];
        if (e->driver == 0 || e->driver == session->client->source || used + 80 > STATUS_PANEL_LINE)
            continue;
        used +=
            (size_t)snprintf(line + used, STATUS_PANEL_LINE - used, "%s%s",
                             used ? ", " : "others drive: ", session_label(mirror, e->id, label));
    }
    if (used == 0)
        (void)snprintf(line, STATUS_PANEL_LINE, "no other drivers");
}
