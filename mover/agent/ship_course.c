/* Looks along courses for land and shallows. */
#include "mover/agent/ship_course.h"

#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define SHALLOW_M     60.0 /* from the shore: 3 m deep there */
#define STEP_M        30.0 /* between two points of a course */
#define LEG_STEP_M    60.0 /* and of one to a far goal */
#define LEAST_LENGTHS 6.0  /* looked ahead: the room to turn round */
#define STOP_LENGTHS  1.5  /* kept between the ship and the end of what is clear */
#define ASTERN_SHARE  0.6  /* of the acceleration: by which it plans to stop */
#define ASTERN_MPS    0.5  /* share of the top speed, off the shore */
#define FAN           25   /* courses: the wanted one, and 15 to 180 degrees to both sides */
#define FAN_RAD       (PI / 12.0)
#define OWN_COST      0.6 /* of a turn off the ship's own heading, to one off the wanted heading */

static bool is_deep(const struct step_context *context, double x, double z)
{
    return world_holds(context->world, x, z) &&
           cover_is_water(terrain_cover(&context->world->terrain, x, z));
}

struct course {
    double x, z;         /* [m] where it begins */
    double sine, cosine; /* of its heading */
    double far_m;        /* to look */
    double wide_m;       /* water that it needs on both sides */
    double step_m;
};

/* Returns how far the course is clear. The water that it needs grows along it, so that there is a
 * way out of shallows. */
static double clear_m(const struct step_context *context, const struct course *course)
{
    double clear = 0.0;
    while (clear < course->far_m) {
        double to = maths_min(clear + course->step_m, course->far_m);
        double wide = maths_min(course->wide_m, to);
        double side_x = course->cosine * wide, side_z = course->sine * wide;
        double x = course->x + course->sine * to, z = course->z - course->cosine * to;
        if (!is_deep(context, x, z) || !is_deep(context, x + side_x, z + side_z) ||
            !is_deep(context, x - side_x, z - side_z))
            return clear;
        clear = to;
    }
    return clear;
}

static double clear_along(const struct step_context *context, struct course *course, double heading)
{
    maths_sincos(heading, &course->sine, &course->cosine);
    return clear_m(context, course);
}

/* Returns the wanted heading if it is clear as far as it looks. Otherwise it returns the one of the
 * fan that is clear and costs the least: turns off the wanted heading, and off the ship's own, so
 * that it follows a coast in one direction. If none is clear, it returns the one that is clear
 * furthest. */
static double choose(const struct step_context *context, struct course *course, double wanted,
                     double own, double *clear)
{
    double best = wanted, least = INFINITY;
    *clear = clear_along(context, course, wanted);
    for (int n = 1; n < FAN && (n > 1 || *clear < course->far_m); n++) {
        double turn = FAN_RAD * (double)((n + 1) / 2) * (n % 2 ? 1.0 : -1.0);
        double free_m = clear_along(context, course, wanted + turn);
        double cost = fabs(turn) + OWN_COST * fabs(maths_wrap_half(wanted + turn - own));
        if (free_m > *clear || (free_m >= course->far_m && cost < least)) {
            least = free_m >= course->far_m ? cost : INFINITY;
            *clear = free_m;
            best = wanted + turn;
        }
    }
    return best;
}

/* Returns the speed from which it can stop in time. */
static double stopping_speed(const struct kind *kind, double clear)
{
    double room = maths_max(clear - STOP_LENGTHS * kind->length_m, 0.0);
    return sqrt(2.0 * ASTERN_SHARE * kind->acceleration_mps2 * room);
}

/* Goes astern, straight off the shore. */
static void back_off(const struct entities *m, uint32_t i, const struct kind *kind,
                     struct desired_motion *desired)
{
    desired->heading_rad = m->row[i].heading;
    desired->speed_mps = -ASTERN_MPS * kind->max_speed_mps;
}

void ship_course_keep(const struct step_context *context, uint32_t i,
                      struct desired_motion *desired)
{
    const struct entities *m = context->m;
    const struct kind *kind = &context->world->kinds[m->row[i].kind];
    if (m->row[i].flags & ENTITY_FLAG_AGROUND) {
        back_off(m, i, kind, desired);
        return;
    }
    if (!(desired->speed_mps > 0.0))
        return;
    double speed = sqrt(m->row[i].vx * m->row[i].vx + m->row[i].vz * m->row[i].vz), clear;
    double fast = maths_max(desired->speed_mps, speed);
    double stops = fast * fast / (2.0 * ASTERN_SHARE * maths_max(kind->acceleration_mps2, 1e-9));
    struct course course = {
        .x = m->row[i].x,
        .z = m->row[i].z,
        .far_m = maths_max(stops, LEAST_LENGTHS * kind->length_m) + STOP_LENGTHS * kind->length_m,
        .wide_m = SHALLOW_M,
        .step_m = STEP_M,
    };
    double heading = choose(context, &course, desired->heading_rad, m->row[i].heading, &clear);
    if (clear < STOP_LENGTHS * kind->length_m) { /* a narrow channel */
        course.wide_m = 0.5 * kind->width_m;
        heading = choose(context, &course, desired->heading_rad, m->row[i].heading, &clear);
    }
    double now = clear_along(context, &course, m->row[i].heading);
    desired->heading_rad = maths_wrap_turn(heading);
    desired->speed_mps = maths_min(desired->speed_mps, stopping_speed(kind, maths_min(clear, now)));
}

bool ship_course_is_clear(const struct step_context *context, uint32_t i, double x, double z)
{
    const struct entities *m = context->m;
    double dx = x - m->row[i].x, dz = z - m->row[i].z;
    struct course course = {.x = m->row[i].x,
                            .z = m->row[i].z,
                            .far_m = sqrt(dx * dx + dz * dz),
                            .wide_m = SHALLOW_M,
                            .step_m = LEG_STEP_M};
    double clear = clear_along(context, &course, maths_heading(dx, dz));
    return clear >= course.far_m;
}
