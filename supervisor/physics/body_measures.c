/* One body's numbers against the ground, its kind and its last frame. */
#include "supervisor/physics/body_measures.h"

#include "supervisor/physics/hull_shape.h"
#include "supervisor/physics/sprung_body.h"
#include "world/entity/kind.h"
#include "world/terrain/terrain.h"

#include <stddef.h>

#define HELD_M         1e-3 /* a body that is no farther off the ground is on it */
#define LEAST_DEPTH_M  0.05 /* a corner that is no higher over the ground touches it */
#define SINKS_M        1e-4 /* a wreck that comes out slowly may turn a corner so much deeper */
#define SLANTS         0.2  /* of the way by which it is pushed out */
#define CLEARS         0.75 /* of the step that a vehicle climbs: its underside is so high */
#define EDGE_M         1.0  /* a vehicle whose end is no farther from the edge of the world */
#define LEANING_RPS    3.0  /* an aircraft banks and pitches so fast */
#define BOX_CORNERS    8u
#define LIFTED_M       1e-6 /* a vehicle that is higher over where it stands has been lifted */
#define PLACES_ALONG   17u  /* of an underside that is lifted out of works and craters */
#define PLACES_ACROSS  9u
#define FRAME_S        (1.0 / 60.0)
#define STANCE_LEAST_M 0.5  /* a vehicle stands on half its length and width, at least on this */
#define ONE_IMPACT     2u   /* counts of a touch group */
#define PASSED_ON      2.0  /* a body is at most so much faster than what strikes it */
#define PARTING_MPS    20.0 /* bodies that part push others aside no faster */
#define HOLDS          0.5  /* friction of tracks to their side on sand: no brake holds it there */
#define LEAST_TOP      10.0 /* [m/s] top speed of kinds that hardly move by themselves */
#define SLOW_SPIN      0.5  /* of the bound: what has been spun up is slow again */
#define BURIED_S                                                                                   \
    0.2 /* [s] in which a shell gets out of the ground after an explosion or an impact */

static int unfinished(struct vec3 v)
{
    return !isfinite(v.x) + !isfinite(v.y) + !isfinite(v.z);
}

static double beyond(double metres, double side_m)
{
    return maths_max(0.0, maths_max(-metres, metres - side_m));
}

void body_measures_numbers(struct measures *measures, const struct body_look *body, double side_m)
{
    const struct motion_look *now = &body->now;
    const struct vec3 angles = {now->heading, now->pitch, now->roll};
    int count = body->finite ? 0
                             : unfinished(body->named.at) + unfinished(now->velocity) +
                                   unfinished(now->spin) + unfinished(angles);
    measure_take(measures, MEASURE_OF_NOT_FINITE, count, &body->named, NULL);
    measure_take(measures, MEASURE_OF_OUTSIDE,
                 maths_max(beyond(body->named.at.x, side_m), beyond(body->named.at.z, side_m)),
                 &body->named, NULL);
}

/* --- the ground --------------------------------------------------------------------------------*/

/* Returns true if a corner is one of the wheels and tracks, which springs move and edges bend, or
 * of a gun beyond the ends, which its crew lifts and turns out of the way. */
static bool is_moved(const struct kind *kind, struct vec3 corner)
{
    double under = maths_max(kind->travel_m, CLEARS * kind->step_m);
    return corner.y < under || fabs(corner.x) > 0.5 * kind->length_m + LEAST_DEPTH_M;
}

/* Returns how deep the deepest corner of a hull is under a ground that is not one plane, at least
 * deepest. */
static double deepest_corner(const struct surface *surface, const struct hull_shape *shape,
                             const struct surface_part *part, const struct body_look *body,
                             double deepest)
{
    const struct vec3 centre = rigid_pose_out(&body->now.pose, shape->centre);
    double wide = shape->radius_m, low = body->named.at.y + centre.y - wide;
    if (surface_part_most(part, fabs(centre.x) + wide, fabs(centre.z) + wide) - low <= deepest)
        return deepest;
    for (uint32_t i = 0; i < shape->vertices; i++) {
        const struct vec3 to = rigid_pose_out(&body->now.pose, shape->vertex[i]);
        const struct vec3 corner = vec3_add(body->named.at, to);
        if (body->now.sprung && is_moved(body->kind, shape->vertex[i]))
            continue;
        if (surface_part_most(part, to.x, to.z) - corner.y > deepest)
            deepest = maths_max(deepest, surface_height(surface, corner.x, corner.z) - corner.y);
    }
    return deepest;
}

static double depth_of(const struct surface *surface, const struct hull_shape *shape,
                       const struct surface_part *part, const struct body_look *body)
{
    const struct kind *kind = body->kind;
    if (part->flat) {
        const struct vec3 down = {part->east_m, -1.0, part->south_m};
        return part->at_m - body->named.at.y +
               hull_shape_reach(&shape[kind->outer_hull], rigid_pose_in(&body->now.pose, down));
    }
    double deepest = -LEAST_DEPTH_M;
    for (uint32_t i = 0; i < kind->hull_count; i++)
        deepest = deepest_corner(surface, &shape[kind->first_hull + i], part, body, deepest);
    return deepest;
}

/* Returns corner i of the kind's box, in body axes. Land vehicles stand on their position. */
static struct vec3 box_corner(const struct kind *kind, uint32_t i)
{
    double middle = kind->domain == DOMAIN_LAND ? 0.5 * kind->height_m : 0.0;
    return (struct vec3){(i & 1 ? 0.5 : -0.5) * kind->length_m,
                         middle + (i & 2 ? 0.5 : -0.5) * kind->height_m,
                         (i & 4 ? 0.5 : -0.5) * kind->width_m};
}

/* Returns how far the farthest of the points that touch the ground is from the position [m]. */
static double reach_of(const struct ground_look *ground, const struct kind *kind)
{
    double reach = kind->bound_m;
    for (uint32_t i = 0; ground->boxes && i < BOX_CORNERS; i++)
        reach = maths_max(reach, vec3_length(box_corner(kind, i)));
    return reach;
}

/* Returns how high a wreck's lowest corner is over the ground below that corner. */
static double lowest_corner(const struct ground_look *ground, const struct body_look *body)
{
    const struct hull_shape *hull = &ground->shape[body->kind->outer_hull];
    uint32_t corners = ground->boxes ? BOX_CORNERS : hull->vertices;
    double lowest = HUGE_VAL;
    for (uint32_t i = 0; i < corners; i++) {
        struct vec3 own = ground->boxes ? box_corner(body->kind, i) : hull->vertex[i];
        struct vec3 corner = vec3_add(body->named.at, rigid_pose_out(&body->now.pose, own));
        lowest = maths_min(lowest, corner.y - surface_height(ground->surface, corner.x, corner.z));
    }
    return lowest;
}

/* Returns how far a point of the body, within this reach of its position, may move in the frame. */
static double way_of(const struct body_look *body, double reach_m, double dt_s)
{
    const struct motion_look *now = &body->now;
    return dt_s * (vec3_length(now->velocity) + vec3_length(now->spin) * reach_m);
}

/* Returns how far the ground may have pushed a body out of it, which gives no speed [m]. */
static double pushed_m(const struct body_look *body, double dt_s)
{
    double speed = maths_max(vec3_length(body->now.velocity), vec3_length(body->was->velocity));
    double way = vec3_length(vec3_sub(body->named.at, body->was->pose.at));
    return maths_max(0.0, way - speed * dt_s);
}

/* Measures a wreck's depth in the ground if it has grown, beyond the least that it has had: one
 * that a vehicle had may stay. Where the ground pushes out a wreck to the side, a corner that it
 * leaves slantwise may get deeper below the surface first. Wrecks sink in water. */
static void measure_sinking(struct measures *measures, const struct ground_look *ground,
                            const struct body_look *body)
{
    double slack = SINKS_M + SLANTS * pushed_m(body, ground->dt_s);
    bool sinks = body->now.lowest_m < body->was->lowest_m - slack &&
                 !surface_is_water(ground->surface, body->named.at.x, body->named.at.z);
    measure_take(measures, MEASURE_OF_WRECK_UNDERGROUND,
                 sinks ? maths_max(0.0, body->now.begun_m - body->now.lowest_m) : 0.0, &body->named,
                 NULL);
}

/* Notes the least depth that a wreck has had. */
static void note_begun(struct body_look *body)
{
    double lowest = maths_min(0.0, body->now.lowest_m);
    bool was = body->known && body->was->wreck;
    body->now.begun_m = was ? maths_max(body->was->begun_m, lowest) : lowest;
}

/* Measures the deepest corner. A body that comes down touches the ground with it. */
static void measure_corners(struct measures *measures, const struct ground_look *ground,
                            const struct surface_part *part, struct body_look *body)
{
    const struct kind *kind = body->kind;
    const struct vec3 at = body->named.at;
    double bound = reach_of(ground, kind);
    double near = LEAST_DEPTH_M + (body->now.wreck ? way_of(body, bound, ground->dt_s) : 0.0);
    body->now.lowest_m = body->now.height_m;
    if (kind->domain == DOMAIN_SEA || kind->hull_count == 0 ||
        at.y - bound > surface_part_most(part, bound, bound) + near)
        return;
    double depth = depth_of(ground->surface, ground->shape, part, body);
    if (body->now.wreck) {
        body->now.lowest_m = lowest_corner(ground, body);
        note_begun(body);
    }
    body->now.grounded =
        body->now.wreck ? body->now.lowest_m < near : kind->domain == DOMAIN_AIR && depth > -near;
    /* A vehicle is not measured in the frame in which it appears: a teleport may end on a cliff. */
    bool placed = !body->known && kind->domain == DOMAIN_LAND && !body->now.wreck;
    if (!placed && !surface_is_water(ground->surface, at.x, at.z))
        measure_take(measures, MEASURE_OF_UNDERGROUND, maths_max(0.0, depth), &body->named, NULL);
    if (body->known && body->now.wreck && body->was->wreck && !ground->fresh)
        measure_sinking(measures, ground, body);
}

/* Returns the rectangle on which a land vehicle stands. */
static struct surface_rectangle rectangle_under(const struct body_look *body)
{
    const struct kind *kind = body->kind;
    double length = maths_max(0.5 * kind->length_m, STANCE_LEAST_M);
    double width = maths_max(0.5 * kind->width_m, STANCE_LEAST_M);
    double sine, cosine;
    maths_sincos(body->now.heading, &sine, &cosine);
    return (struct surface_rectangle){.middle = body->named.at,
                                      .forward = {sine * length, 0.0, -cosine * length},
                                      .right = {cosine * width, 0.0, sine * width}};
}

/* Returns how high a vehicle stands over the ground under its middle. */
static double standing_height(const struct surface *surface, const struct body_look *body)
{
    if (body->kind->domain != DOMAIN_LAND || body->now.wreck)
        return 0.0;
    const struct surface_rectangle under = rectangle_under(body);
    return surface_clearance(surface, &under);
}

/* A body on a ground. */
struct stand {
    const struct surface *surface;
    struct rigid_pose pose;
};

static double place_height(const struct stand *stand, struct vec3 place)
{
    const struct vec3 at = vec3_add(stand->pose.at, rigid_pose_out(&stand->pose, place));
    return at.y - surface_height(stand->surface, at.x, at.z);
}

/* Returns the pose that a vehicle has on a ground by the heights under its middle and the middles
 * of its sides. Its right axis has the slope of those, and is at a right angle to its forward axis.
 */
static struct rigid_pose five_heights(const struct surface *surface, const struct body_look *body)
{
    const struct surface_rectangle under = rectangle_under(body);
    const struct vec3 at = under.middle, forward = under.forward, right = under.right;
    double rise = surface_height(surface, at.x + forward.x, at.z + forward.z) -
                  surface_height(surface, at.x - forward.x, at.z - forward.z);
    double fall = surface_height(surface, at.x - right.x, at.z - right.z) -
                  surface_height(surface, at.x + right.x, at.z + right.z);
    const struct vec3 stands = {at.x, surface_height(surface, at.x, at.z), at.z};
    double pitch = maths_atan2(rise, 2.0 * vec3_length(forward));
    double roll = maths_atan2(fall * maths_cos(pitch), 2.0 * vec3_length(right));
    return rigid_pose_of(stands, body->now.heading, pitch, roll);
}

/* Returns how high a place is over the ground. One that would be in the ground without works and
 * craters is as high as it is over that depth. */
static double raised(const struct stand *uneven, const struct stand *bare, struct vec3 place)
{
    return place_height(uneven, place) - maths_min(0.0, place_height(bare, place));
}

/* Returns how high the lowest place of a vehicle that holds its course is over an uneven ground: of
 * its hulls' corners, and of its underside in parts of length and width. */
static double lowest_place(const struct ground_look *ground, const struct body_look *body)
{
    const struct kind *kind = body->kind;
    struct terrain posts = *ground->surface->terrain;
    const struct surface plain = {.terrain = &posts};
    const struct stand uneven = {ground->surface, body->now.pose};
    double lowest = HUGE_VAL;
    posts.earthworks.count = 0;
    const struct stand bare = {&plain, five_heights(&plain, body)};
    for (uint32_t i = 0; i < kind->hull_count; i++) {
        const struct hull_shape *shape = &ground->shape[kind->first_hull + i];
        for (uint32_t n = 0; n < shape->vertices; n++)
            lowest = maths_min(lowest, raised(&uneven, &bare, shape->vertex[n]));
    }
    for (uint32_t i = 0; i < PLACES_ALONG * PLACES_ACROSS; i++) {
        double along = (double)(i % PLACES_ALONG) / (PLACES_ALONG - 1) - 0.5;
        double across = (double)(i / PLACES_ALONG) / (PLACES_ACROSS - 1) - 0.5;
        const struct vec3 place = {along * kind->length_m, 0.0, across * kind->width_m};
        lowest = maths_min(lowest, raised(&uneven, &bare, place));
    }
    return lowest;
}

/* Returns how high a land vehicle is over where it stands. One that holds its course is lifted out
 * of works and craters, so that it is as high as its lowest place. */
static double height_over_stand(const struct ground_look *ground, const struct body_look *body)
{
    double height = body->now.height_m - standing_height(ground->surface, body);
    return body->now.courses && height > LIFTED_M ? lowest_place(ground, body) : height;
}

void body_measures_ground(struct measures *measures, const struct ground_look *ground,
                          struct body_look *body)
{
    const struct surface *surface = ground->surface;
    const struct vec3 at = body->named.at;
    uint8_t domain = body->kind->domain;
    if (body->still && !ground->fresh && body->now.wreck == body->was->wreck) {
        body->now.height_m = body->was->height_m;
        body->now.lowest_m = body->was->lowest_m;
        body->now.begun_m = body->was->begun_m;
        body->now.grounded = body->was->grounded;
        body->now.springs = body->was->springs;
        if (body->now.sprung && !body->was->sprung)
            sprung_body_look(surface, body);
        body->now.stood = body->now.wreck;
        body->now.at_rest |= body->now.stood && (body->now.lowest_m >= 0.0 || body->was->stood);
        return;
    }
    const struct surface_part part =
        surface_around(surface, at.x, at.z, reach_of(ground, body->kind));
    body->now.height_m = at.y - (part.flat ? part.at_m : surface_height(surface, at.x, at.z));
    if (!part.flat)
        body->now.height_m = height_over_stand(ground, body);
    if (domain <= DOMAIN_SEA && !body->now.wreck && !body->now.sprung)
        measure_take(measures, MEASURE_OF_HEIGHT, fabs(body->now.height_m), &body->named, NULL);
    measure_corners(measures, ground, &part, body);
    if (body->now.sprung)
        sprung_body_look(surface, body);
}

void body_measures_rest(struct measures *measures, const struct ground_look *ground,
                        const struct body_look *body)
{
    const struct motion_look *now = &body->now;
    bool wet = surface_is_water(ground->surface, body->named.at.x, body->named.at.z);
    bool lies = now->at_rest && !wet && body->kind->domain != DOMAIN_SEA && !body->touches;
    bool looked = body->known && body->was->at_rest && body->still && !ground->fresh;
    if (lies && !looked && body->kind->hull_count > 0)
        measure_take(measures, MEASURE_OF_WRECK_HEIGHT, fabs(now->lowest_m), &body->named, NULL);
}

/* --- motion ------------------------------------------------------------------------------------*/

bool body_measures_held(const struct body_look *body)
{
    uint8_t domain = body->kind->domain;
    bool follows = domain == DOMAIN_SEA || (domain == DOMAIN_LAND && !body->was->wreck);
    return follows && fabs(body->now.height_m) <= HELD_M && fabs(body->was->height_m) <= HELD_M;
}

/* Returns true if only the map's part of the body's way counts. One that is destroyed in this frame
 * has followed the ground until then. */
static bool goes_on_map(const struct body_look *body)
{
    bool destroyed = body->now.wreck && !body->was->wreck;
    return body_measures_held(body) ||
           (destroyed && body->kind->domain == DOMAIN_LAND && fabs(body->was->height_m) <= HELD_M);
}

static struct vec3 level(struct vec3 v, bool held)
{
    return (struct vec3){v.x, held ? 0.0 : v.y, v.z};
}

/* Returns true if an impact may have been passed on within the frame: by another impact, or by a
 * contact beside that of the impact. A body that leans on the next one strikes it slowly, which is
 * no impact. */
static bool passes_on(const struct joined_bodies *group)
{
    return group->impacts > ONE_IMPACT || (group->impacts > 0 && group->presses > ONE_IMPACT);
}

static void measure_jump(struct measures *measures, double dt_s, const struct body_look *body)
{
    bool held = goes_on_map(body);
    struct vec3 way = level(vec3_sub(body->named.at, body->was->pose.at), held);
    double speed = maths_max(vec3_length(level(body->now.velocity, held)),
                             vec3_length(level(body->was->velocity, held)));
    double out = body->was->wreck ? maths_max(0.0, -body->was->lowest_m) : 0.0;
    if (passes_on(&body->together))
        speed = maths_max(speed, PASSED_ON * body->together.fastest_mps);
    if (body->together.parts)
        speed += PARTING_MPS;
    /* The bounds are those of a frame of at most 1/60 s: in a longer one gravity and the ground
     * have more time to change speed and spin. */
    double share = maths_min(1.0, FRAME_S / dt_s);
    double beyond_m = maths_max(0.0, vec3_length(way) - speed * dt_s - out);
    measure_take(measures, MEASURE_OF_JUMP, beyond_m * share, &body->named, NULL);
    if (body->kind->domain != DOMAIN_AIR && !body->was->wreck)
        return;
    double spin = maths_max(vec3_length(body->now.spin), vec3_length(body->was->spin));
    double angle = rigid_pose_angle(&body->was->pose, &body->now.pose);
    if (!body->was->wreck)
        spin += body->kind->turn_rate_rps + LEANING_RPS;
    measure_take(measures, MEASURE_OF_SNAP, maths_max(0.0, angle - spin * dt_s) * share,
                 &body->named, NULL);
}

/* Free rotation accelerates every point of a wreck but its centre of mass. */
static struct vec3 measured_velocity(const struct body_look *body, const struct motion_look *look)
{
    if (body->was->wreck && body->now.wreck)
        return motion_look_centre_velocity(look, body->kind);
    return level(look->velocity, body_measures_held(body));
}

/* Returns the change of velocity without what the air may have taken: of a wreck, any loss of its
 * speed against the way that it goes. */
static struct vec3 without_drag(const struct body_look *body, struct vec3 before,
                                struct vec3 change)
{
    double square = vec3_dot(before, before), loss = -vec3_dot(change, before);
    if (!body->was->wreck || square == 0.0 || loss <= 0.0)
        return change;
    return vec3_add(change, vec3_scale(before, maths_min(1.0, loss / square)));
}

static void measure_acceleration(struct measures *measures, double dt_s,
                                 const struct body_look *body)
{
    struct vec3 before = measured_velocity(body, body->was);
    struct vec3 change = vec3_sub(measured_velocity(body, &body->now), before);
    change = without_drag(body, before, change);
    double steered = body->now.wreck ? 0.0 : vec3_length(before) * body->kind->turn_rate_rps;
    measure_take(measures, MEASURE_OF_ACCELERATION,
                 maths_max(0.0, vec3_length(change) / dt_s - steered), &body->named, NULL);
}

/* Returns true if a vehicle on its springs goes down so steeply that no brake holds it: it slides
 * or falls. What it gains so is a part of the measure of its energy. */
static bool slides_down(const struct body_look *body)
{
    const struct vec3 velocity = body->now.velocity;
    return body->now.sprung && -velocity.y > HOLDS * vec3_length(level(velocity, true));
}

/* Engines bound the speed of what they drive. A scenario may let a body begin faster, an explosion
 * or another body may throw it faster, and it may fall or slide; it then is left out until it is
 * slow again. The speed is that of the centre of mass: any other point of a wreck that turns over
 * is faster and slower by turns. */
static void measure_speed(struct measures *measures, struct body_look *body)
{
    double top = maths_max(body->kind->max_speed_mps, LEAST_TOP);
    struct vec3 velocity = motion_look_centre_velocity(&body->now, body->kind);
    double share = vec3_length(level(velocity, true)) / top;
    bool faster = share > measure_bound(measures, MEASURE_OF_SPEED);
    body->thrown = faster && (body->thrown || !body->known || body->blasts > 0 ||
                              body->struck > 0 || body->hits > 0 || slides_down(body));
    if (!body->thrown)
        measure_take(measures, MEASURE_OF_SPEED, share, &body->named, NULL);
}

/* Returns true if an impact explains the body's spin. One at closing speed v with restitution e, at
 * r from the centre of mass of a body whose radius of gyration is k, spins it up by at most
 * v (1 + e) r / (k^2 + r^2). That is most at r = k, where the points of the body go about its
 * centre at v (1 + e) / 2: at the speed of either body, if both come at the same one and nothing
 * bounces. */
static bool spun_by_impact(const struct body_look *body)
{
    return (body->struck > 0 || body->hits > 0) &&
           motion_look_turning(&body->now, body->kind) <= body->together.fastest_mps;
}

/* Explosions spin bodies up, and so do fast bodies that strike them, and what these have thrown.
 * Such a body is left out until it is slow again: without a torque its spin rises and falls as it
 * turns, because its moments of inertia differ. */
static void measure_spin(struct measures *measures, struct body_look *body)
{
    double spin = vec3_length(body->now.spin);
    bool slow = spin <= SLOW_SPIN * measure_bound(measures, MEASURE_OF_SPIN);
    body->spun = !slow && (body->spun || body->blasts > 0 || body->thrown || spun_by_impact(body));
    if (!body->spun)
        measure_take(measures, MEASURE_OF_SPIN, spin, &body->named, NULL);
}

/* Returns true if the edge of the world may have stopped a land vehicle, which has its ends within
 * the world: the edge is no wall that gives a contact. */
static bool edge_stops(const struct ground_look *ground, const struct body_look *body)
{
    const double side_m = ground->surface->terrain->squares.world_m;
    const struct vec3 at = body->was->pose.at;
    double inside = maths_min(maths_min(at.x, side_m - at.x), maths_min(at.z, side_m - at.z));
    return body->kind->domain == DOMAIN_LAND &&
           inside < 0.5 * body->kind->length_m + ground->dt_s * vec3_length(body->was->velocity) +
                        EDGE_M;
}

void body_measures_motion(struct measures *measures, const struct ground_look *ground,
                          struct body_look *body)
{
    const double dt_s = ground->dt_s;
    measure_speed(measures, body);
    measure_spin(measures, body);
    bool pushed = body->blasts > 0 || body->struck > 0 || body->hits > 0;
    body->buried_s = pushed ? BURIED_S : maths_max(0.0, body->buried_s - dt_s);
    if (body->now.sprung)
        sprung_body_measure(measures, dt_s, body);
    if (!body->known || body->commanded)
        return;
    /* Between two explosions or collisions it may be faster than before and after. */
    if (body->blasts < 2 && body->struck < 2 && body->hits < 2 && body->parted == 0)
        measure_jump(measures, dt_s, body);
    bool touches = body->touches || body->touched || body->now.grounded || body->was->grounded ||
                   body->now.sprung || body->was->sprung;
    if (body->blasts == 0 && body->struck == 0 && !touches && !edge_stops(ground, body))
        measure_acceleration(measures, dt_s, body);
}
