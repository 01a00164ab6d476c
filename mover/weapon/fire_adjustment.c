/* What observers see, and the corrections that follow. */
#include "mover/weapon/fire_adjustment.h"

#include "mover/motion/kinematics.h"
#include "world/entity/kind.h"
#include "world/state.h"
#include "world/world.h"

#define BRACKET_M 200.0 /* the first correction along the range */
#define CLOSE_M   50.0  /* the last */
#define EYES_MOST 64u   /* vehicles that are asked whether they see the target */
#define EYE_SHARE 0.9   /* of the height of a vehicle */
#define TARGET_M  2.0   /* the height over the ground at which the target is seen */

static double level_distance(const struct entities *m, uint32_t row, double x, double z)
{
    double dx = m->row[row].x - x, dz = m->row[row].z - z;
    return sqrt(dx * dx + dz * dz);
}

/* Returns true if a vehicle of the force sees the target. */
static bool is_observed(const struct serial_context *context, const struct battery *battery)
{
    const struct entities *m = &context->moved->entities;
    const struct kind *kinds = context->step->world->kinds;
    struct vec3 target = {battery->x, kinematics_ground(context->step, battery->x, battery->z),
                          battery->z};
    target.y += TARGET_M;
    uint32_t asked = 0;
    for (uint32_t row = 0; row < context->moved->head->used && asked < EYES_MOST; row++) {
        const struct kind *kind = &kinds[m->row[row].kind];
        if (m->row[row].state != ENTITY_ACTIVE || m->row[row].behaviour == BEHAVIOUR_FLIGHT ||
            m->row[row].force != battery->force ||
            level_distance(m, row, battery->x, battery->z) > kind->sight_m)
            continue;
        struct vec3 eye = step_context_position(context->step, m, row);
        eye.y += kind->domain == DOMAIN_AIR ? 0.0 : EYE_SHARE * kind->height_m;
        asked++;
        if (line_of_sight_clear(context->step->line_of_sight, eye, target))
            return true;
    }
    return false;
}

/* The unit vector on the map along which the rounds come. */
struct vec3 fire_adjustment_line(const struct battery *battery)
{
    double turn = battery->guns == 0 ? PI : 0.0; /* the bearing points back to the guns */
    return firing_arc_unit((double)battery->azimuth + turn, 0.0);
}

/* Corrects by what the observer sees of the last round: its side along the range, and how far it is
 * aside. */
void fire_adjustment_correct(const struct serial_context *context, struct battery *battery)
{
    if (!is_observed(context, battery)) {
        battery->phase = BATTERY_FIRES;
        return;
    }
    struct vec3 ahead = fire_adjustment_line(battery), right = {-ahead.z, 0.0, ahead.x};
    struct vec3 fell = {(double)battery->fell_x, 0.0, (double)battery->fell_z};
    double side = vec3_dot(fell, ahead) > 0.0 ? -1.0 : 1.0, aside = vec3_dot(fell, right);
    double last = (double)battery->step_m;
    battery->bracketed |= last * side < 0.0;
    double step = last == 0.0 ? BRACKET_M : battery->bracketed ? 0.5 * fabs(last) : fabs(last);
    battery->step_m = (float)(side * step);
    battery->aim_x += side * step * ahead.x - aside * right.x;
    battery->aim_z += side * step * ahead.z - aside * right.z;
    if (step <= CLOSE_M)
        battery->phase = BATTERY_FIRES;
}

/* Notes where a round for adjustment falls, off the target. */
void fire_adjustment_note(const struct serial_context *context, struct battery *battery,
                          struct fire_error error)
{
    const struct entities *m = &context->moved->entities;
    struct vec3 ahead = fire_adjustment_line(battery), right = {-ahead.z, 0.0, ahead.x};
    double range = battery->guns == 0
                       ? FIRE_AFAR_M
                       : level_distance(m, battery->gun_slot[0], battery->aim_x, battery->aim_z);
    double x = battery->aim_x - battery->x + (double)battery->survey_x;
    double z = battery->aim_z - battery->z + (double)battery->survey_z;
    double far = error.range * range, aside = error.azimuth_rad * range;
    battery->fell_x = (float)(x + far * ahead.x + aside * right.x);
    battery->fell_z = (float)(z + far * ahead.z + aside * right.z);
}
