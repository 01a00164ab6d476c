/* Avoiding: a fan of directions, how far each is free, and the best of them. */
#include "mover/avoid.h"

#include "world/reach.h"
#include "world/square.h"

#include <stddef.h>

#define REACT_S        0.6  /* until a look has turned or slowed it */
#define TURNS_AHEAD    1.5  /* turning circles that it looks ahead at least */
#define HORIZON_M      12.0 /* and in any case */
#define FARTHEST_M     600.0
#define TALL_M         3.0   /* above this nothing is in a land vehicle's way */
#define GAP_M          1.0   /* kept clear to the side and ahead */
#define AIR_GAP_M      8.0   /* likewise in the air, and above and below */
#define LOW_FLIGHT_M   40.0  /* above it nothing fixed is in an aircraft's way */
#define BRAKE_SHARE    0.8   /* of how hard it can slow, counted on */
#define HARMLESS_SHARE 0.005 /* of its resistance_j that an object may cost a vehicle */
#define YIELDS         0.1   /* fixed kinds with less rigidity bend, whatever runs into them */
#define TURN_COST      0.25  /* a radian off its way, in shares of the horizon */
#define CHANGE_COST    0.10  /* a radian off what it did before: it makes up its mind */
#define LEFT_COST      0.03  /* turning left: of equals everybody takes the right */
#define SHARP_SHARE    0.25 /* of its speed in turns of a quarter and more: it sweeps less ground */
#define STRAYS         0.05 /* over distance: what bodies stray from the course that they have now */
#define GIVEN_WAY_S    2.5  /* until when it counts on who must give way to do so */
#define CROSSING       0.94 /* cosine of 20 degrees: courses that differ by less do not cross */
#define CLIMB_AHEAD_S  6.0  /* how far ahead aircraft see that they must climb */

/* The fan [rad] off the wished heading, and its sines and cosines; the last is the present heading,
 * set by the look. */
#define FAN     13
#define PRESENT FAN
static const double fan_rad[FAN] = {0.0,
                                    10 * RAD_PER_DEG,
                                    -10 * RAD_PER_DEG,
                                    20 * RAD_PER_DEG,
                                    -20 * RAD_PER_DEG,
                                    35 * RAD_PER_DEG,
                                    -35 * RAD_PER_DEG,
                                    55 * RAD_PER_DEG,
                                    -55 * RAD_PER_DEG,
                                    80 * RAD_PER_DEG,
                                    -80 * RAD_PER_DEG,
                                    115 * RAD_PER_DEG,
                                    -115 * RAD_PER_DEG};
static const double fan_sine[FAN] = {0.0,
                                     0.17364817766693033,
                                     -0.17364817766693033,
                                     0.3420201433256687,
                                     -0.3420201433256687,
                                     0.573576436351046,
                                     -0.573576436351046,
                                     0.8191520442889918,
                                     -0.8191520442889918,
                                     0.984807753012208,
                                     -0.984807753012208,
                                     0.9063077870366499,
                                     -0.9063077870366499};
static const double fan_cosine[FAN] = {1.0,
                                       0.984807753012208,
                                       0.984807753012208,
                                       0.9396926207859084,
                                       0.9396926207859084,
                                       0.8191520442889918,
                                       0.8191520442889918,
                                       0.5735764363510461,
                                       0.5735764363510461,
                                       0.17364817766693041,
                                       0.17364817766693041,
                                       -0.42261826174069944,
                                       -0.42261826174069944};

struct look {
    const struct kind *kind;
    double wish_mps, present_mps;
    double speed_mps; /* along the fan: that it comes to within a second */
    double horizon_m;
    double half_width, half_length, gap;
    double x[FAN + 1], z[FAN + 1]; /* the fan's directions, unit */
    double free_m[FAN + 1];        /* how far it can go along each; the horizon when farther */
};

/* --- what follows from the kinds ---------------------------------------------------------------*/

/* Of its model's hulls that begin below TALL_M, upright; the sphere where spheres collide. */
static double reach_of(const struct world *world, const struct kind *kind)
{
    double farthest = 0.0;
    if (world->params->collision.shape != SHAPE_MODEL)
        return kind->radius_m;
    for (uint32_t h = 0; h < kind->hull_count; h++) {
        const struct hull *hull = &world->hulls[kind->first_hull + h];
        const struct vec3 *vertex = &world->hull_vertices[hull->first_vertex];
        double low = INFINITY, level = 0.0;
        for (uint32_t v = 0; v < hull->vertex_count; v++) {
            low = maths_min(low, vertex[v].y);
            level = maths_max(level, vertex[v].x * vertex[v].x + vertex[v].z * vertex[v].z);
        }
        if (low < TALL_M)
            farthest = maths_max(farthest, level);
    }
    return sqrt(farthest);
}

/* The collider's impulses: a bush bends; what breaks costs its resistance, times its rigidity. */
static bool does_no_harm(const struct kind *vehicle, const struct kind *fixed)
{
    if (fixed->rigidity < YIELDS)
        return true;
    double energy = 0.5 * vehicle->mass_kg * vehicle->max_speed_mps * vehicle->max_speed_mps;
    return energy > fixed->resistance_j &&
           fixed->resistance_j * fixed->rigidity < HARMLESS_SHARE * vehicle->resistance_j;
}

void avoid_init(struct avoid *avoid, const struct world *world)
{
    *avoid = (struct avoid){.reach_m = {0.0}};
    for (uint32_t k = 0; k < world->counts.kinds; k++) {
        const struct kind *kind = &world->kinds[k];
        if (kind->domain == DOMAIN_FIXED)
            avoid->reach_m[k] = reach_of(world, kind);
        for (uint32_t o = 0; o < world->counts.kinds && kind->domain != DOMAIN_FIXED; o++) {
            if (world->kinds[o].domain == DOMAIN_FIXED && does_no_harm(kind, &world->kinds[o]))
                avoid->harmless[k] |= UINT64_C(1) << o;
        }
    }
}

/* --- the fan -----------------------------------------------------------------------------------*/

static struct look begin(const struct move *move, uint32_t i, const struct wish *wish)
{
    const struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    double brake = BRAKES * kind->acceleration_mps2, speed = fabs(wish->speed_mps), sine, cosine;
    double way = wish->speed_mps < 0.0 ? -1.0 : 1.0, forward, rightward;
    struct look look = {.kind = kind,
                        .wish_mps = speed,
                        .half_width = 0.5 * kind->width_m,
                        .half_length = 0.5 * kind->length_m,
                        .gap = kind->domain == DOMAIN_AIR ? AIR_GAP_M : GAP_M};
    look.horizon_m =
        maths_max(speed * speed / (2.0 * brake), TURNS_AHEAD * speed / kind->turn_rate_rps);
    look.horizon_m = maths_min(FARTHEST_M, look.horizon_m + speed * REACT_S + HORIZON_M +
                                               2.0 * look.half_length);
    maths_sincos(wish->heading_rad, &sine, &cosine);
    for (int k = 0; k < FAN; k++) {
        look.x[k] = way * (sine * fan_cosine[k] + cosine * fan_sine[k]);
        look.z[k] = way * (sine * fan_sine[k] - cosine * fan_cosine[k]);
        look.free_m[k] = look.horizon_m;
    }
    maths_sincos(m->heading[i], &sine, &cosine);
    pose_speeds(m, i, &forward, &rightward);
    look.x[PRESENT] = way * sine;
    look.z[PRESENT] = -way * cosine;
    look.present_mps = maths_max(1.0, way * forward);
    look.speed_mps = maths_min(speed, look.present_mps + kind->acceleration_mps2);
    look.free_m[PRESENT] = look.horizon_m;
    return look;
}

/* Something that stands at (dx, dz) from here, reach_m about its middle. */
static void stands(struct look *look, double dx, double dz, double reach_m)
{
    double beside = reach_m + look->half_width + look->gap;
    double ahead = reach_m + look->half_length + look->gap;
    for (int k = 0; k <= FAN; k++) {
        double along = dx * look->x[k] + dz * look->z[k];
        double across = fabs(dx * look->z[k] - dz * look->x[k]);
        if (along > 0.0 && across < beside + STRAYS * along)
            look->free_m[k] = maths_min(look->free_m[k], maths_max(0.0, along - ahead));
    }
}

/* Must the other give way? As at sea: who has the other on his right, and who comes from behind. */
static bool gives_way(const struct look *look, double dx, double dz, double vx, double vz)
{
    double ahead = dx * look->x[0] + dz * look->z[0];
    double to_right = dz * look->x[0] - dx * look->z[0];
    double same = vx * look->x[0] + vz * look->z[0];
    double speed = sqrt(vx * vx + vz * vz);
    if (speed < 1.0) /* it stands */
        return false;
    if (same > CROSSING * speed)
        return ahead < 0.0;
    return same > -CROSSING * speed && to_right < 0.0;
}

/* Something that goes on at (vx, vz): as far as it comes itself until they meet. */
static void goes(struct look *look, double dx, double dz, double vx, double vz, double reach_m)
{
    double beside = reach_m + look->half_width + look->gap;
    double ahead = reach_m + look->half_length + look->gap;
    bool other_gives_way = gives_way(look, dx, dz, vx, vz);
    for (int k = 0; k <= FAN; k++) {
        double speed = k == PRESENT ? look->present_mps : look->speed_mps;
        double ux = speed * look->x[k] - vx, uz = speed * look->z[k] - vz;
        double closing = sqrt(ux * ux + uz * uz);
        if (closing < 0.1)
            continue;
        double along = (dx * ux + dz * uz) / closing;
        double across = fabs(dx * uz - dz * ux) / closing;
        double askew = fabs(ux * look->z[k] - uz * look->x[k]) / closing; /* it meets it so */
        double wide = beside + askew * (look->half_length - look->half_width);
        if (along > 0.0 && across < wide + STRAYS * along) {
            double meets_s = maths_max(0.0, along - ahead) / closing;
            if (!other_gives_way || meets_s < GIVEN_WAY_S)
                look->free_m[k] = maths_min(look->free_m[k], speed * meets_s);
        }
    }
}

/* --- what is there -----------------------------------------------------------------------------*/

static void see_square(const struct move *move, uint32_t i, struct look *look, uint32_t square)
{
    const struct world *world = move->world;
    const struct entities *m = move->m;
    const uint8_t *damage = move->committed->fixed_damage;
    uint64_t harmless = move->avoid->harmless[m->kind[i]];
    bool flies = look->kind->domain == DOMAIN_AIR;
    const uint32_t *objects;
    uint32_t count = world_reach(world, square, &objects);
    for (uint32_t n = 0; n < count; n++) {
        const struct fixed_object *object = &world->fixed[objects[n]];
        double dx = object->x - m->x[i], dz = object->z - m->z[i];
        double most = look->horizon_m + (double)object->radius_m;
        if (dx * dx + dz * dz > most * most || damage[objects[n]] >= DAMAGE_HIGH ||
            harmless >> object->kind & 1u)
            continue;
        if (flies &&
            (double)object->y + (double)object->height_m + 0.5 * look->kind->height_m < m->y[i])
            continue;
        const struct kind *kind = &world->kinds[object->kind];
        stands(look, dx, dz,
               flies ? reach_of_fixed(object, world->kinds)
                     : move->avoid->reach_m[object->kind] * fixed_scale(object, kind));
    }
}

static void see_fixed(const struct move *move, uint32_t i, struct look *look)
{
    const struct entities *m = move->m;
    double most = look->horizon_m;
    struct square_box box =
        square_box_of(m->x[i] - most, m->z[i] - most, m->x[i] + most, m->z[i] + most);
    for (int32_t row = box.z0; row <= box.z1; row++)
        for (int32_t column = box.x0; column <= box.x1; column++)
            see_square(move, i, look, square_index(column, row));
}

static void see_vehicles(const struct move *move, uint32_t i, struct look *look)
{
    const struct entities *m = move->m, *w = &move->committed->entities;
    const struct near_entry *entry;
    double most = maths_min(FARTHEST_M, 2.0 * look->horizon_m); /* they come to meet it */
    struct near_walk walk = near_begin(move->near, NEAR_ALL, m->x[i], m->z[i], most);
    while ((entry = near_next(&walk)) != NULL) {
        uint32_t j = entry->row;
        const struct kind *other = &move->world->kinds[w->kind[j]];
        double apart = 0.5 * (look->kind->height_m + other->height_m) + look->gap;
        if (j == i || fabs(w->y[j] - m->y[i]) > apart)
            continue;
        double reach =
            0.5 * sqrt(other->length_m * other->length_m + other->width_m * other->width_m);
        goes(look, w->x[j] - m->x[i], w->z[j] - m->z[i], w->vx[j], w->vz[j], reach);
    }
}

/* How far the ground lets it go that way: two soundings. */
static double ground_free(const struct move *move, uint32_t i, const struct look *look, int k)
{
    const struct entities *m = move->m;
    double before_m = 0.0, before_y = m->y[i];
    for (int n = 1; n <= 2; n++) {
        double way = 0.5 * n * look->horizon_m;
        double x = m->x[i] + way * look->x[k], z = m->z[i] + way * look->z[k];
        bool edge = !(x > 0.0 && z > 0.0 && x < WORLD_SIDE_M && z < WORLD_SIDE_M);
        if (edge || cover_is_water(terrain_cover(&move->world->terrain, x, z)) !=
                        (look->kind->domain == DOMAIN_SEA))
            return before_m;
        if (look->kind->domain == DOMAIN_LAND) {
            double y = pose_ground(move, x, z);
            if (maths_atan2(y - before_y, way - before_m) >= look->kind->max_slope_rad)
                return before_m;
            before_y = y;
        }
        before_m = way;
    }
    return look->horizon_m;
}

/* --- what it does about it ---------------------------------------------------------------------*/

static int best(const struct look *look, double dodge_rad)
{
    int found = 0;
    double most = -INFINITY;
    for (int k = 0; k < FAN; k++) {
        double score = look->free_m[k] / look->horizon_m - TURN_COST * fabs(fan_rad[k]) -
                       CHANGE_COST * fabs(fan_rad[k] - dodge_rad) -
                       (fan_rad[k] < 0.0 ? LEFT_COST : 0.0);
        if (score > most) {
            most = score;
            found = k;
        }
    }
    return found;
}

/* Speed from which it stops within free_m. */
static double stopping_speed(const struct look *look, double free_m)
{
    return sqrt(2.0 * BRAKE_SHARE * BRAKES * look->kind->acceleration_mps2 * free_m);
}

/* Share of its speed that aircraft do without, to be over the ground ahead when they are there. */
static double climbing_ease(const struct move *move, uint32_t i, const struct look *look,
                            const struct wish *wish)
{
    const struct entities *m = move->m;
    double way = look->wish_mps * CLIMB_AHEAD_S;
    double ground = pose_ground(move, m->x[i] + way * look->x[0], m->z[i] + way * look->z[0]);
    double climb = ground + 0.5 * wish->altitude_m - m->y[i];
    double most = look->kind->climb_rate_mps * CLIMB_AHEAD_S;
    return climb > most ? 1.0 - most / climb : 0.0;
}

static void look_ahead(const struct move *move, uint32_t i, const struct wish *wish)
{
    struct entities *m = move->m;
    struct look look = begin(move, i, wish);
    bool flies = look.kind->domain == DOMAIN_AIR;
    double ease = flies ? climbing_ease(move, i, &look, wish) : 0.0;
    see_vehicles(move, i, &look);
    if (!flies || m->y[i] - pose_ground(move, m->x[i], m->z[i]) < LOW_FLIGHT_M)
        see_fixed(move, i, &look);
    int way = wish->speed_mps < 0.0 ? PRESENT : best(&look, (double)m->dodge[i]);
    for (int tries = 0; tries < FAN && !flies && way != PRESENT; tries++) {
        double free_m = ground_free(move, i, &look, way);
        if (free_m >= look.free_m[way])
            break;
        look.free_m[way] = free_m;
        way = best(&look, (double)m->dodge[i]);
    }
    double free_m = look.free_m[way];
    if (look.x[way] * look.x[PRESENT] + look.z[way] * look.z[PRESENT] < fan_cosine[1])
        free_m = maths_min(free_m, look.free_m[PRESENT]); /* it is not turned there yet */
    if (free_m < look.horizon_m)
        ease = maths_max(ease, 1.0 - stopping_speed(&look, free_m) / look.wish_mps);
    m->dodge[i] = way < FAN ? (float)fan_rad[way] : 0.0f; /* backwards it only slows */
    m->ease[i] = (float)maths_max(ease, 0.0);
}

void avoid_steer(const struct move *move, uint32_t i, struct wish *wish)
{
    struct entities *m = move->m;
    const struct kind *kind = &move->world->kinds[m->kind[i]];
    if (wish->driven || !(fabs(wish->speed_mps) > 0.0)) {
        m->dodge[i] = m->ease[i] = 0.0f;
        return;
    }
    if (move_thinks(move, i))
        look_ahead(move, i, wish);
    wish->heading_rad = maths_wrap_turn(wish->heading_rad + (double)m->dodge[i]);
    wish->speed_mps *= 1.0 - (double)m->ease[i];
    if (wish->speed_mps > 0.0 && kind->domain != DOMAIN_SEA && kind->min_speed_mps <= 0.0) {
        double off = maths_cos(wish->heading_rad - m->heading[i]);
        wish->speed_mps *= maths_clamp(off, SHARP_SHARE, 1.0);
    }
}
