/* Paths and rotations of the frame's rows. */
#include "collider/motion/body_motion.h"

#include "collider/motion/pair_filter.h"
#include "world/entity/hull.h"
#include "world/entity/kind.h"
#include "world/entity/mass_properties.h"
#include "world/maths/maths.h"
#include "world/params.h"
#include "world/runtime/reserve.h"
#include "world/runtime/prefault.h"
#include "world/state.h"
#include "world/cruise_pose.h"
#include "world/terrain/fixed.h"
#include "world/world.h"

#include <stdlib.h>
#include <string.h>

/* The ground on the way of a stretch is at most this share of its length above or below its ends:
 * no vehicle on easy ground is on a steeper slope (mover/motion/chassis.h). The climb of others
 * changes evenly. */
#define STRETCH_SLOPE 0.5

/* What is left of a stretch is within so many times the height of its arc over its chord, and this
 * much for each second that is left. One would do for its places. But what is around the rest of a
 * stretch has to be within what was around it before: else a collider that begins anew, and
 * compares all rows, would end a stretch that another one does not. */
#define STRETCH_ARCS       3.0
#define STRETCH_AROUND_MPS 0.1

/* A body that turns or leans further in a frame, or leans so far, may point anywhere [rad]. */
#define AXIS_TURN_RAD  0.5
#define AXIS_PITCH_RAD 0.7

/* Leaning moves a point of a body about its axis, by no more than it is off the axis, and towards
 * its middle. So only its place along the axis and how far it is off it matter: it is within the
 * greatest such distance of a point of the axis that is nearer to the middle by the root of the
 * difference of their squares. */
static struct body_axis axis_of(const struct world *world, const struct kind *kind)
{
    struct body_axis axis = {.beside_m = INFINITY};
    double square = 0.0;
    if (kind->hull_count == 0 || world->params->collision.shape != SHAPE_MODEL)
        return axis;
    const struct hull *hull = &world->hulls[kind->outer_hull];
    const struct vec3 *at = world->hull_vertices + hull->first_vertex;
    for (uint32_t v = 0; v < hull->vertex_count; v++)
        square = maths_max(square, at[v].y * at[v].y + at[v].z * at[v].z);
    for (uint32_t v = 0; v < hull->vertex_count; v++) {
        double nearer = sqrt(square - (at[v].y * at[v].y + at[v].z * at[v].z));
        axis.ahead_m = maths_max(axis.ahead_m, at[v].x - nearer);
        axis.behind_m = maths_max(axis.behind_m, -at[v].x - nearer);
    }
    axis.beside_m = sqrt(square);
    return axis;
}

#define WORD_ROWS 64u

static uint32_t words_of(uint32_t rows)
{
    return (rows + WORD_ROWS - 1) / WORD_ROWS;
}

int body_motion_init(struct body_motion *motion, const struct world *world)
{
    uint32_t capacity = world->params->capacity, words = words_of(capacity);
    *motion = (struct body_motion){.world = world};
    motion->path = malloc(capacity * sizeof *motion->path);
    motion->computed = calloc(words, WORD_ROWS * sizeof *motion->computed);
    motion->change = calloc(capacity, sizeof *motion->change);
    motion->changed = reserve_take(capacity, sizeof *motion->changed);
    motion->row = reserve_take(capacity, sizeof *motion->row);
    motion->parting_rps = calloc(capacity, sizeof *motion->parting_rps);
    motion->fall = calloc(words, WORD_ROWS * sizeof *motion->fall);
    motion->known = calloc(words, sizeof *motion->known);
    motion->pose = reserve_take(2 * (uint64_t)capacity, sizeof *motion->pose);
    motion->begins = reserve_take(capacity, sizeof *motion->begins);
    if (!motion->path || !motion->computed || !motion->change || !motion->changed || !motion->row ||
        !motion->parting_rps || !motion->fall || !motion->known || !motion->pose ||
        !motion->begins) {
        body_motion_free(motion);
        return -1;
    }
    for (uint32_t k = 0; k < world->counts.kinds && k < KIND_COUNT_MAX; k++)
        motion->axis[k] = axis_of(world, &world->kinds[k]);
    return 0;
}

void body_motion_free(struct body_motion *motion)
{
    free(motion->path);
    free(motion->computed);
    reserve_free(motion->changed);
    free(motion->change);
    reserve_free(motion->row);
    free(motion->parting_rps);
    free(motion->fall);
    free(motion->known);
    reserve_free(motion->pose);
    reserve_free(motion->begins);
    *motion = (struct body_motion){0};
}

void body_motion_touch(const struct body_motion *motion, uint32_t rows)
{
    prefault_own(motion->path, rows * sizeof *motion->path);
    prefault_own(motion->computed, rows * sizeof *motion->computed);
    prefault_own(motion->change, rows * sizeof *motion->change);
    prefault_own(motion->parting_rps, rows * sizeof *motion->parting_rps);
    prefault_own(motion->fall, rows * sizeof *motion->fall);
    prefault_own(motion->pose, 2 * (size_t)rows * sizeof *motion->pose);
    if (motion->world->params->cruise)
        prefault_own(motion->begins, rows * sizeof *motion->begins);
}

/* Forgets what the last frame found out of rows: in a large world of few. */
static void forget_known(const struct body_motion *motion)
{
    for (uint32_t w = 0; w < words_of(motion->world->params->capacity); w++) {
        if (atomic_load_explicit(&motion->known[w], memory_order_relaxed) == 0)
            continue;
        atomic_store_explicit(&motion->known[w], 0, memory_order_relaxed);
        memset(&motion->computed[(size_t)w * WORD_ROWS], 0, WORD_ROWS * sizeof *motion->computed);
        memset(&motion->fall[(size_t)w * WORD_ROWS], 0, WORD_ROWS * sizeof *motion->fall);
    }
}

void body_motion_begin(struct body_motion *motion, const struct state *committed,
                       const struct state *next, const struct crater_index *craters)
{
    for (uint32_t i = 0; i < motion->changes; i++)
        motion->change[motion->row[i]] = 0;
    motion->changes = 0;
    forget_known(motion);
    motion->committed = committed;
    motion->next = next;
    motion->craters = craters;
    motion->before = committed->entities;
    if (motion->world->params->cruise) {
        motion->before.row = motion->begins;
    }
    motion->models = motion->world->params->collision.shape == SHAPE_MODEL;
}

/* Returns how an old row stands when the frame begins. */
static struct cruise_pose begins_at(const struct body_motion *motion, uint32_t row)
{
    return cruise_pose_of(motion->world, motion->craters, &motion->committed->entities, row,
                          motion->committed->head->tick);
}

static void note_begin(const struct body_motion *motion, uint32_t row)
{
    struct entity *begins = &motion->begins[row];
    *begins = motion->committed->entities.row[row];
    if (!body_motion_old(motion, row))
        return;
    const struct cruise_pose pose = begins_at(motion, row);
    begins->x = pose.at.x;
    begins->y = pose.at.y;
    begins->z = pose.at.z;
    begins->heading = pose.heading_rad;
    begins->pitch = pose.pitch_rad;
    begins->roll = pose.roll_rad;
}

/* What turns where it stands does not rest. */
static struct path path_of(const struct body_motion *motion, uint32_t row, struct vec3 from,
                           struct vec3 to)
{
    struct path path = {.at = from, .along = vec3_sub(to, from)};
    if (pair_filter_rests(&path))
        path.rotates = body_motion_rotates(motion, row);
    return path;
}

struct path body_motion_path(const struct body_motion *motion, uint32_t row)
{
    struct vec3 to = entities_position(&motion->next->entities, row);
    struct vec3 from = body_motion_old(motion, row) ? begins_at(motion, row).at : to;
    return path_of(motion, row, from, to);
}

/* Returns the line of a row that cruises in this frame to where it is at a tick of its stretch. */
static struct body_line line_until(const struct body_motion *motion, uint32_t row, uint64_t tick)
{
    const struct entities *n = &motion->next->entities;
    const uint64_t now = motion->next->head->tick - 1;
    const double dt_s = world_dt_s(motion->world), left_s = (double)(tick - now) * dt_s;
    struct body_line line = {.from = cruise_position(n, row, now, dt_s),
                             .to = cruise_position(n, row, tick, dt_s),
                             .left_s = left_s};
    double x = line.to.x - line.from.x, z = line.to.z - line.from.z, way_m = sqrt(x * x + z * z);
    double arc_m = fabs(n->row[row].cruise_rps) * left_s * way_m / 8.0;
    if (way_m > 0.0)
        line.around_m = STRETCH_ARCS * arc_m + STRETCH_AROUND_MPS * left_s;
    return line;
}

struct body_line body_motion_line(const struct body_motion *motion, uint32_t row)
{
    return line_until(motion, row, motion->next->entities.row[row].cruise_tick);
}

/* Returns the line around a body that goes from one place to another while its axis points from its
 * middle to a heading. off_m: how far its axis may be off that direction at its ends, and its
 * middle off the straight way. It goes ahead or backwards. */
static struct body_line line_around(const struct body_motion *motion, const struct body_axis *axis,
                                    const struct body_line *way, double heading_rad, double off_m)
{
    struct body_line line = *way;
    double ahead = axis->ahead_m, behind = axis->behind_m, x, z;
    maths_sincos(heading_rad, &x, &z);
    z = -z;
    if (x * (way->to.x - way->from.x) + z * (way->to.z - way->from.z) < 0.0)
        ahead = -axis->behind_m, behind = -axis->ahead_m;
    line.from = (struct vec3){way->from.x - behind * x, way->from.y, way->from.z - behind * z};
    line.to = (struct vec3){way->to.x + ahead * x, way->to.y, way->to.z + ahead * z};
    line.around_m = axis->beside_m + pair_filter_slack(motion->world) + off_m;
    return line;
}

static double longest_of(const struct body_axis *axis)
{
    return maths_max(axis->ahead_m, axis->behind_m);
}

/* The chord of an arc has the heading of its middle, and the axis is off it by half of its turn. */
struct body_line body_motion_line_around(const struct body_motion *motion, uint32_t row,
                                         uint64_t tick, double reach_m)
{
    const struct entities *n = &motion->next->entities;
    const struct body_axis *axis = &motion->axis[n->row[row].kind];
    struct body_line way = line_until(motion, row, tick);
    double half_rad = 0.5 * n->row[row].cruise_rps * way.left_s;
    double heading = cruise_heading(n, row, tick, world_dt_s(motion->world)) - half_rad;
    double off_m = way.around_m + fabs(half_rad) * longest_of(axis);
    way.around_m += reach_m;
    return axis->beside_m < reach_m ? line_around(motion, axis, &way, heading, off_m) : way;
}

/* Returns true if the turret and the gun of the row point ahead in this frame. */
static bool points_ahead(const struct body_motion *motion, uint32_t row)
{
    const struct entities *w = body_motion_committed(motion, row), *n = &motion->next->entities;
    return w->row[row].turret == 0.0f && w->row[row].gun == 0.0f && n->row[row].turret == 0.0f &&
           n->row[row].gun == 0.0f;
}

/* Returns how far at most the axis of a row that does not cruise is off its last heading in this
 * frame [rad]; INFINITY: it may point anywhere. Between both ends it is off the nearer one by no
 * more than half of its turn. */
static double axis_turn(const struct body_motion *motion, uint32_t row,
                        const struct cruise_pose *from)
{
    const struct entities *w = body_motion_committed(motion, row), *n = &motion->next->entities;
    const struct vec3 spin = {w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z};
    const double dt_s = world_dt_s(motion->world);
    double turned = fabs(maths_wrap_half(n->row[row].heading - from->heading_rad));
    double leant = fabs(n->row[row].pitch - from->pitch_rad) +
                   fabs(maths_wrap_half(n->row[row].roll - from->roll_rad));
    double steepest = maths_max(fabs(n->row[row].pitch), fabs(from->pitch_rad));
    if (turned + leant > AXIS_TURN_RAD || steepest > AXIS_PITCH_RAD ||
        vec3_dot(spin, spin) * dt_s * dt_s > AXIS_TURN_RAD * AXIS_TURN_RAD)
        return INFINITY;
    return turned + 0.5 * (turned + leant);
}

/* Aircraft and rounds turn by free rotations. */
struct body_line body_motion_frame_line(const struct body_motion *motion, uint32_t row,
                                        double reach_m)
{
    const struct entities *n = &motion->next->entities;
    const struct kind *kind = &motion->world->kinds[n->row[row].kind];
    const struct body_axis *axis = &motion->axis[n->row[row].kind];
    const struct vec3 to = entities_position(n, row);
    struct cruise_pose from = {to, n->row[row].heading, n->row[row].pitch, n->row[row].roll};
    double sine, cosine;
    if (body_motion_old(motion, row))
        from = begins_at(motion, row);
    struct body_line way = {.from = from.at, .to = to, .around_m = reach_m};
    double turn_rad = axis_turn(motion, row, &from);
    if ((kind->domain != DOMAIN_LAND && kind->domain != DOMAIN_SEA) || turn_rad == INFINITY ||
        !points_ahead(motion, row))
        return way;
    maths_sincos(n->row[row].heading, &sine, &cosine);
    double sideways_m = fabs(cosine * (to.x - from.at.x) + sine * (to.z - from.at.z));
    double off_m = sideways_m + turn_rad * longest_of(axis);
    return axis->beside_m + off_m < reach_m
               ? line_around(motion, axis, &way, n->row[row].heading, off_m)
               : way;
}

struct body_line body_motion_standing_line(const struct body_motion *motion, uint32_t row,
                                           double reach_m)
{
    const struct entities *n = &motion->next->entities;
    const struct body_axis *axis = &motion->axis[n->row[row].kind];
    const struct vec3 at = entities_position(n, row);
    const struct body_line way = {.from = at, .to = at, .around_m = reach_m};
    return axis->beside_m < reach_m && points_ahead(motion, row)
               ? line_around(motion, axis, &way, n->row[row].heading, 0.0)
               : way;
}

/* Returns how far above or below its line what is left of a stretch may be [m]. */
static double rise_of(const struct body_motion *motion, uint32_t row, const struct body_line *line)
{
    const struct entities *n = &motion->next->entities;
    double x = line->to.x - line->from.x, z = line->to.z - line->from.z;
    double climb_mps2 = fabs((double)n->row[row].cruise_climb_mps2), left_s = line->left_s;
    if (motion->world->kinds[n->row[row].kind].domain == DOMAIN_LAND)
        return STRETCH_SLOPE * sqrt(x * x + z * z);
    if (climb_mps2 == 0.0)
        return 0.0;
    return STRETCH_ARCS * climb_mps2 * left_s * left_s / 8.0 + STRETCH_AROUND_MPS * left_s;
}

struct path body_motion_stretch(const struct body_motion *motion, uint32_t row)
{
    const struct body_line line = body_motion_line(motion, row);
    const struct vec3 at = line.from, to = line.to;
    const struct vec3 most = {line.around_m, rise_of(motion, row, &line), line.around_m};
    struct vec3 low = {maths_min(at.x, to.x), maths_min(at.y, to.y), maths_min(at.z, to.z)};
    struct vec3 high = {maths_max(at.x, to.x), maths_max(at.y, to.y), maths_max(at.z, to.z)};
    low = vec3_sub(low, most);
    return path_of(motion, row, low, vec3_add(high, most));
}

void body_motion_compute(struct body_motion *motion, uint32_t row)
{
    if (motion->before.row == motion->begins && !motion->computed[row])
        note_begin(motion, row);
    motion->path[row] = body_motion_path(motion, row);
    motion->computed[row] = 1;
    body_motion_note_known(motion, row);
}

static const struct quat no_turn = {1.0, 0.0, 0.0, 0.0};

/* Returns where the rotation of a row of a table is kept. Each world buffer has a place, so that
 * what ends a frame is known when the next one begins. */
static struct known_pose *place_of(const struct body_motion *motion, const struct entities *e,
                                   uint32_t row)
{
    bool before = e == &motion->before;
    const struct state *state = before ? motion->committed : motion->next;
    return &motion->pose[2 * (uint64_t)row + (state->head->frame & 1)];
}

/* Returns the rotation of a row of a table. */
static struct quat pose(const struct body_motion *motion, const struct entities *e, uint32_t row)
{
    const struct known_pose *known = place_of(motion, e, row);
    const double angle[3] = {e->row[row].heading, e->row[row].pitch, e->row[row].roll};
    /* Bit by bit: a rotation by -0 has other signs of zero than one by 0. */
    if (known->known && memcmp((const unsigned char *)known->angle, (const unsigned char *)angle,
                               sizeof angle) == 0)
        return known->turn;
    return rotation_of(angle[0], angle[1], angle[2]);
}

static void note_pose(struct body_motion *motion, const struct entities *e, uint32_t row)
{
    struct quat turn = pose(motion, e, row);
    *place_of(motion, e, row) =
        (struct known_pose){{e->row[row].heading, e->row[row].pitch, e->row[row].roll}, turn, 1};
}

void body_motion_note_poses(struct body_motion *motion, uint32_t row)
{
    note_pose(motion, &motion->next->entities, row);
    if (body_motion_old(motion, row))
        note_pose(motion, &motion->before, row);
}

/* Returns the spin by which the mover turns the row: freely in the air, about the vertical on the
 * ground and on the water. Most rows have none, so few fields are read. */
static struct vec3 committed_spin(const struct body_motion *motion, uint32_t row, bool flies)
{
    const struct entities *w = &motion->committed->entities;
    if (!flies)
        return (struct vec3){0.0, w->row[row].spin_y, 0.0};
    return (struct vec3){w->row[row].spin_x, w->row[row].spin_y, w->row[row].spin_z};
}

/* Finds how the mover turned the row, if not the shorter way: an aircraft by any spin, another body
 * by one of more than a quarter turn a frame. */
static void find_turn(const struct body_motion *motion, uint32_t row,
                      struct rotation_path *rotation)
{
    const struct kind *kind = &motion->world->kinds[motion->next->entities.row[row].kind];
    bool flies = kind->domain == DOMAIN_AIR;
    double dt_s = world_dt_s(motion->world), least = flies ? 0.0 : HALF_PI;
    struct vec3 spin = committed_spin(motion, row, flies);
    if (!(vec3_dot(spin, spin) * dt_s * dt_s > least * least))
        return;
    struct vec3 moment = flies ? mass_properties_of(kind).moment : (struct vec3){1.0, 1.0, 1.0};
    struct free_rotation freely = free_rotation_of(moment, rotation->from, spin, dt_s);
    struct free_turn turn = free_turn_to(&freely, rotation->to);
    /* Where something else turned the body, its spin may explain less than the shorter way. */
    if (!turn.steers ||
        rotation_rate(turn.steered, no_turn) < rotation_rate(rotation->from, rotation->to))
        rotation->turn = turn;
}

struct rotation_path body_motion_rotation(const struct body_motion *motion, uint32_t row)
{
    if (motion->change[row] != 0)
        return motion->changed[motion->change[row] - 1];
    const struct entities *w = &motion->before, *n = &motion->next->entities;
    struct quat to = pose(motion, n, row);
    if (!body_motion_rotated(motion, row))
        return (struct rotation_path){.from = to, .to = to};
    struct rotation_path rotation = {.from = pose(motion, w, row), .to = to};
    find_turn(motion, row, &rotation);
    return rotation;
}

struct quat body_motion_orientation(const struct body_motion *motion, uint32_t row, double time)
{
    struct rotation_path rotation = body_motion_rotation(motion, row);
    double since = motion->path[row].since;
    double left = 1.0 - since;
    if (!(left > 0.0))
        return rotation.to;
    if (rotation.turn.rotation.steps == 0)
        return rotation_between(rotation.from, rotation.to, (time - since) / left);
    struct quat turned;
    struct vec3 spin;
    free_turn_at(&rotation.turn, (time - since) / left, &turned, &spin);
    return turned;
}

struct rotation_path body_motion_rotation_from(const struct body_motion *motion, uint32_t row,
                                               double time)
{
    struct rotation_path rotation = body_motion_rotation(motion, row);
    const struct free_rotation before = rotation.turn.rotation;
    rotation.from = body_motion_orientation(motion, row, time);
    if (before.steps == 0)
        return rotation;
    struct vec3 spin = free_rotation_spin(before.moment, rotation.from, before.momentum);
    struct free_rotation left = free_rotation_of(before.moment, rotation.from, spin,
                                                 (1.0 - time) * world_dt_s(motion->world));
    rotation.turn = free_turn_to(&left, rotation.to);
    return rotation;
}

void body_motion_change(struct body_motion *motion, uint32_t row, const struct path *path,
                        const struct rotation_path *rotation)
{
    if (motion->change[row] == 0) {
        motion->row[motion->changes] = row;
        motion->change[row] = ++motion->changes;
    }
    motion->changed[motion->change[row] - 1] = *rotation;
    motion->path[row] = *path;
}

/* Turret and gun are at rest: where they begin is not read. */
static void put_shape(const struct world *world, uint16_t kind, double scale,
                      struct swept_body *body)
{
    const struct kind *k = &world->kinds[kind];
    body->hull = world->hulls + k->first_hull;
    body->hull_count = k->hull_count;
    body->outer = world->hulls + k->outer_hull;
    body->vertices = world->hull_vertices;
    body->planes = world->hull_planes;
    body->scale = scale;
    body->bound_m = scale * k->bound_m;
    body->turn = NULL;
    body->turret.outer = NULL;
    body->turret.outers = 0;
    body->turret.turret_pivot = body->turret.gun_pivot = (struct vec3){0.0, 0.0, 0.0};
    body->turret.turret = body->turret.gun = 0.0;
    body->turret.turret_turn = body->turret.gun_turn = 0.0;
}

void body_motion_aim(const struct body_motion *motion, uint32_t row, double turret, double gun,
                     double turret_turn, double gun_turn, struct swept_body *body)
{
    const struct kind *kind = &motion->world->kinds[motion->next->entities.row[row].kind];
    if (kind->part_count == 0 ||
        (turret == 0.0 && gun == 0.0 && turret_turn == 0.0 && gun_turn == 0.0))
        return;
    body->turret.outer = motion->world->hulls + kind->first_part_hull;
    body->turret.outers = kind->part_count;
    body->turret.turret_pivot = kind->turret_pivot;
    body->turret.gun_pivot = kind->gun_pivot;
    body->bound_m = kind->reach_m;
    turret_path_set(&body->turret, turret, gun, turret_turn, gun_turn);
}

/* Makes turret and gun point as they did when the frame began. */
static void aim_as_before(const struct body_motion *motion, uint32_t row, struct swept_body *body)
{
    const struct entities *e = body_motion_before(motion, row);
    body_motion_aim(motion, row, (double)e->row[row].turret, (double)e->row[row].gun, 0.0, 0.0,
                    body);
}

void body_motion_put(const struct body_motion *motion, uint32_t row, struct free_turn *turn,
                     struct swept_body *body)
{
    struct rotation_path rotation = body_motion_rotation(motion, row);
    put_shape(motion->world, motion->next->entities.row[row].kind, 1.0, body);
    body->path = motion->path[row];
    body->from = rotation.from;
    body->to = rotation.to;
    if (rotation.turn.rotation.steps > 0) {
        *turn = rotation.turn;
        body->turn = turn;
    }
    aim_as_before(motion, row, body);
}

struct swept_body body_motion_body(const struct body_motion *motion, uint32_t row,
                                   struct free_turn *turn)
{
    struct swept_body body = {.hull_count = 0};
    body_motion_put(motion, row, turn, &body);
    return body;
}

struct swept_body body_motion_fixed(const struct world *world, uint32_t object)
{
    const struct fixed_object *fixed = &world->fixed[object];
    double scale = fixed_scale(fixed, &world->kinds[fixed->kind]);
    struct swept_body body = {.hull_count = 0};
    put_shape(world, fixed->kind, scale, &body);
    body.path.at = fixed_position(fixed);
    body.from = body.to = rotation_of(fixed_heading(fixed), 0.0, 0.0);
    return body;
}

struct swept_body body_motion_side(const struct body_motion *motion, uint32_t side,
                                   struct free_turn *turn)
{
    return side & PAIR_FIXED ? body_motion_fixed(motion->world, side & ~PAIR_FIXED)
                             : body_motion_body(motion, side, turn);
}

void body_motion_put_standing(const struct body_motion *motion, const struct entities *entities,
                              uint32_t row, struct swept_body *body)
{
    put_shape(motion->world, entities->row[row].kind, 1.0, body);
    body->path = (struct path){.at = entities_position(entities, row)};
    body->from = body->to = pose(motion, entities, row);
    aim_as_before(motion, row, body);
}

struct swept_body body_motion_standing(const struct body_motion *motion,
                                       const struct entities *entities, uint32_t side)
{
    struct swept_body body = {.hull_count = 0};
    if (side & PAIR_FIXED)
        return body_motion_fixed(motion->world, side & ~PAIR_FIXED);
    body_motion_put_standing(motion, entities, side, &body);
    return body;
}
