/* Moves a rectangle along arcs, by steps that nothing can come between. */
#include "mover/agent/driving/shunting_room.h"

#include "world/maths/maths.h"

#define STEP_M   0.2  /* of an arc, at least: obstacles are larger */
#define KEEPS_M  0.01 /* of a gap that it is in already */
#define STROKES  16   /* that a plan has at most */
#define LEAST_M  0.4  /* a stroke that is shorter leads nowhere */
#define PLAN_GAP 0.4  /* [m] gap in plans: more than that of a vehicle that carries them out */
#define CHANGE_M 3.0  /* what a change between forwards and backwards costs, as a way */

/* The rectangle of the vehicle in a pose. */
struct body {
    double x, z;   /* its middle */
    double ux, uz; /* its direction */
    double half_m, half_width;
};

static struct body body_of(const struct shunting_room *room, const struct shunting_pose *pose)
{
    double sine, cosine;
    maths_sincos(pose->heading_rad, &sine, &cosine);
    const double ahead = 0.5 * (room->front_m - room->rear_m);
    const double aside = 0.5 * (room->right_m - room->left_m);
    return (struct body){.x = pose->x + ahead * sine + aside * cosine,
                         .z = pose->z - ahead * cosine + aside * sine,
                         .ux = sine,
                         .uz = -cosine,
                         .half_m = 0.5 * (room->front_m + room->rear_m),
                         .half_width = 0.5 * (room->left_m + room->right_m)};
}

/* Returns the gap between the body and an obstacle along the axis of a rectangle that separates
 * them most: no more than their distance, and below 0 if they overlap. */
static double gap_between(const struct body *body, const struct shunting_obstacle *other)
{
    const double dx = other->x - body->x, dz = other->z - body->z;
    const double cosine = fabs(body->ux * other->ux + body->uz * other->uz);
    const double sine = fabs(body->ux * other->uz - body->uz * other->ux);
    const double along = fabs(dx * body->ux + dz * body->uz) - body->half_m -
                         other->half_m * cosine - other->half_width * sine;
    const double across = fabs(dx * body->uz - dz * body->ux) - body->half_width -
                          other->half_m * sine - other->half_width * cosine;
    const double other_along = fabs(dx * other->ux + dz * other->uz) - other->half_m -
                               body->half_m * cosine - body->half_width * sine;
    const double other_across = fabs(dx * other->uz - dz * other->ux) - other->half_width -
                                body->half_m * sine - body->half_width * cosine;
    return maths_max(maths_max(along, across), maths_max(other_along, other_across)) -
           other->border_m;
}

static double distance_to(const struct shunting_room *room,
                          const struct shunting_obstacle *obstacle)
{
    const double dx = obstacle->x - room->x, dz = obstacle->z - room->z;
    const double reach = obstacle->half_m + obstacle->half_width + obstacle->border_m;
    return maths_max(0.0, sqrt(dx * dx + dz * dz) - reach);
}

void shunting_room_add(struct shunting_room *room, const struct shunting_obstacle *obstacle)
{
    uint32_t farthest = 0;
    for (uint32_t n = 0; n < room->count; n++) {
        if (room->obstacle[n].x == obstacle->x && room->obstacle[n].z == obstacle->z &&
            room->obstacle[n].half_m == obstacle->half_m)
            return;
    }
    if (room->count < SHUNTING_ROOM_MOST) {
        room->obstacle[room->count++] = *obstacle;
        return;
    }
    for (uint32_t n = 1; n < room->count; n++) {
        if (distance_to(room, &room->obstacle[n]) > distance_to(room, &room->obstacle[farthest]))
            farthest = n;
    }
    if (distance_to(room, obstacle) < distance_to(room, &room->obstacle[farthest]))
        room->obstacle[farthest] = *obstacle;
}

/* Moves the pose along a stroke. */
static void go(const struct shunting_room *room, struct shunting_pose *pose,
               struct shunting_stroke stroke, double way_m)
{
    const double turn = stroke.side * way_m / room->circle_m, half = 0.5 * turn;
    double sine, cosine;
    maths_sincos(pose->heading_rad + half, &sine, &cosine);
    /* The chord of the arc; for a small angle the sine is nearly the angle. */
    const double chord =
        stroke.ahead * (stroke.side != 0.0 ? 2.0 * room->circle_m * maths_sin(fabs(half)) : way_m);
    pose->x += chord * sine;
    pose->z -= chord * cosine;
    pose->heading_rad += turn;
}

double shunting_room_free(const struct shunting_room *room, const struct shunting_pose *pose,
                          struct shunting_stroke stroke, double most_m, double gap_m)
{
    double keeps[SHUNTING_ROOM_MOST], free_m = 0.0, least = INFINITY;
    /* No point of the body moves further than this on each metre of the arc. */
    const double corner =
        sqrt(maths_max(room->front_m, room->rear_m) * maths_max(room->front_m, room->rear_m) +
             maths_max(room->left_m, room->right_m) * maths_max(room->left_m, room->right_m));
    const double faster = 1.0 + fabs(stroke.side) * corner / room->circle_m;
    struct body body = body_of(room, pose);
    for (uint32_t n = 0; n < room->count; n++) {
        const double gap = gap_between(&body, &room->obstacle[n]);
        keeps[n] = maths_min(gap_m, gap - KEEPS_M);
        least = maths_min(least, gap - keeps[n]);
    }
    while (free_m < most_m) {
        const double way_m = maths_min(most_m, free_m + maths_max(STEP_M, least / faster));
        struct shunting_pose at = *pose;
        go(room, &at, stroke, way_m);
        body = body_of(room, &at);
        least = INFINITY;
        for (uint32_t n = 0; n < room->count; n++)
            least = maths_min(least, gap_between(&body, &room->obstacle[n]) - keeps[n]);
        if (least < 0.0)
            break;
        free_m = way_m;
    }
    return free_m;
}

/* Returns the way that the strokes to a heading have, the first of which is given; INFINITY: they
 * do not lead there. */
static double way_of(const struct shunting_room *room, struct shunting_pose pose,
                     double heading_rad, double exact_rad, double longest_m,
                     struct shunting_stroke stroke)
{
    double way_m = 0.0;
    bool moved = true;
    for (int n = 0; n < STROKES; n++) {
        const double left = maths_wrap_turn(stroke.side * (heading_rad - pose.heading_rad));
        if (left < exact_rad || left > TWO_PI - exact_rad)
            return way_m;
        const double most = maths_min(longest_m, left * room->circle_m);
        const double free_m = shunting_room_free(room, &pose, stroke, most, PLAN_GAP);
        const bool moves = free_m >= maths_min(LEAST_M, most);
        if (!moves && (!moved || n == 0))
            break;
        moved = moves;
        go(room, &pose, stroke, free_m);
        way_m += free_m + CHANGE_M;
        stroke.ahead = -stroke.ahead;
    }
    return INFINITY;
}

bool shunting_room_plan(const struct shunting_room *room, const struct shunting_pose *pose,
                        double heading_rad, double exact_rad, double longest_m,
                        struct shunting_stroke *first)
{
    const double right = maths_wrap_half(heading_rad - pose->heading_rad) < 0.0 ? -1.0 : 1.0;
    double least = INFINITY;
    for (int n = 0; n < 4; n++) {
        const struct shunting_stroke stroke = {.ahead = n % 2 ? -1.0 : 1.0,
                                               .side = n / 2 ? -right : right};
        const double way_m = way_of(room, *pose, heading_rad, exact_rad, longest_m, stroke);
        if (way_m < least) {
            least = way_m;
            *first = stroke;
        }
    }
    return least < INFINITY;
}
