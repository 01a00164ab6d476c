/* Groups by union-find; wishes by sweeps over the points, or by spreading. */
#include "collider/resting/parting_wishes.h"

#include "collider/resting/deep_pair.h"
#include "collider/resting/resting.h"
#include "world/world.h"

/* No body is moved apart faster than this, and none turns faster. */
#define PUSHED_MOST_MPS 10.0
#define PUSHED_MOST_RPS 0.2

/* So far at most is a body moved in a frame by the recovery of shallow overlaps [m]. */
#define RECOVERED_MOST_M 0.006

/* Bodies that a contact kept from moving a frame ago go so much farther apart [m]. */
#define LEANS_M 0.01

/* Bodies of a crowd that are nearer hold each other up [m]. One that is locked becomes wider by so
 * much of its width in a frame. */
#define IN_THE_WAY_M 0.02
#define OPENED       0.02
#define OPENS_MPS    20.0 /* along the ground */

/* Two bodies that part by less than this share of what they wish are locked. */
#define HINDERED 0.25

/* In masses that part light bodies would hold up heavy ones, as sweeps converge slowly between
 * them: displacements are shared by the roots of the masses, in so many sweeps over the points at
 * most. */
#define WISH_SWEEPS 100

/* --- groups ------------------------------------------------------------------------------------*/

static bool is_fixed(const struct parting_input *input, uint32_t body)
{
    return input->row[body] == SLOT_NONE;
}

static uint32_t root_of(struct parting_body *body, uint32_t i)
{
    while (body[i].parent != i)
        i = body[i].parent = body[body[i].parent].parent;
    return i;
}

/* The lower root becomes that of both. */
static void join(struct parting_body *body, uint32_t p, uint32_t q)
{
    uint32_t a = root_of(body, p), b = root_of(body, q);
    body[a > b ? a : b].parent = a > b ? b : a;
}

double parting_wishes_speed(const struct parting_input *input, const struct resting_pair *pair)
{
    double most = 0.0;
    for (uint32_t i = pair->first; i < pair->first + pair->count; i++)
        most = maths_max(most, input->point[i].apart_mps);
    return most;
}

bool parting_wishes_group(struct parting *parting, const struct parting_input *input)
{
    bool any = false;
    for (uint32_t i = 0; i < input->bodies; i++)
        parting->body[i] = (struct parting_body){.parent = i};
    for (uint32_t i = 0; i < input->pairs; i++) {
        const struct level_contact *point = &input->point[input->pair[i].first];
        if (!is_fixed(input, point->b))
            join(parting->body, point->a, point->b);
    }
    for (uint32_t i = 0; i < input->pairs; i++) {
        bool deep = input->pair[i].gap_m <= -RESTING_PARTS_M;
        uint32_t a = input->point[input->pair[i].first].a;
        parting->body[root_of(parting->body, a)].parts |= deep;
        any |= deep;
    }
    return any;
}

bool parting_wishes_parts(struct parting *parting, uint32_t body)
{
    return parting->body[root_of(parting->body, body)].parts;
}

/* --- crowds that are locked --------------------------------------------------------------------*/

static uint32_t crowd_of(struct parting_body *body, uint32_t i)
{
    while (body[i].crowd != i)
        i = body[i].crowd = body[body[i].crowd].crowd;
    return i;
}

/* Joins the bodies that are in each other's way. The lower root becomes that of both. */
static void find_crowds(struct parting *parting, const struct parting_input *input)
{
    for (uint32_t i = 0; i < input->bodies; i++)
        parting->body[i].crowd = i;
    for (uint32_t i = 0; i < input->pairs; i++) {
        const struct level_contact *point = &input->point[input->pair[i].first];
        if (is_fixed(input, point->b) || input->pair[i].gap_m > IN_THE_WAY_M)
            continue;
        uint32_t a = crowd_of(parting->body, point->a), b = crowd_of(parting->body, point->b);
        parting->body[a > b ? a : b].crowd = a > b ? b : a;
    }
}

/* Marks the crowds with two bodies that are deep in each other and did not move a frame ago. */
void parting_wishes_find_locked(struct parting *parting, const struct parting_input *input)
{
    find_crowds(parting, input);
    for (uint32_t i = 0; i < input->pairs; i++) {
        const struct resting_pair *pair = &input->pair[i];
        const struct level_contact *point = &input->point[pair->first];
        if (pair->holds && pair->gap_m <= -RESTING_PARTS_M && !is_fixed(input, point->b))
            parting->body[crowd_of(parting->body, point->a)].locked = true;
    }
}

bool parting_wishes_hindered(struct parting *parting, const struct parting_input *input)
{
    bool any = false;
    for (uint32_t i = 0; i < input->pairs; i++) {
        const struct resting_pair *pair = &input->pair[i];
        const struct level_contact *point = &input->point[pair->first];
        if (pair->gap_m > -RESTING_PARTS_M || is_fixed(input, point->b) ||
            parting->body[point->a].spreads || parting->body[point->a].opens)
            continue;
        const struct level_motion *a = &input->body[point->a].pushed;
        const struct level_motion *b = &input->body[point->b].pushed;
        double along = (b->x - a->x) * point->normal_x + (b->z - a->z) * point->normal_z;
        if (along >= HINDERED * point->part_mps)
            continue;
        parting->body[crowd_of(parting->body, point->a)].locked = true;
        any = true;
    }
    return any;
}

/* Sets where a body of a crowd is from the crowd's centre of mass [m]. */
static void from_centre(const struct parting_body *root, const struct parting_input *input,
                        uint32_t i, double *x, double *z)
{
    const struct vec3 at = input->context->path[input->row[i]].at;
    *x = at.x - root->centre_x / root->mass_kg;
    *z = at.z - root->centre_z / root->mass_kg;
}

/* Finds the bodies, the centre and the reach of crowds that are locked. */
static void measure_locked(struct parting *parting, const struct parting_input *input)
{
    double x, z;
    for (uint32_t i = 0; i < input->bodies; i++) {
        struct parting_body *root = &parting->body[crowd_of(parting->body, i)];
        if (!root->locked || is_fixed(input, i) || parting->body[i].opens)
            continue;
        const struct vec3 at = input->context->path[input->row[i]].at;
        double kg = 1.0 / input->body[i].inverse_mass;
        parting->body[i].opens = true;
        root->mass_kg += kg;
        root->centre_x += kg * at.x;
        root->centre_z += kg * at.z;
    }
    for (uint32_t i = 0; i < input->bodies; i++) {
        struct parting_body *root = &parting->body[crowd_of(parting->body, i)];
        if (!parting->body[i].opens)
            continue;
        from_centre(root, input, i, &x, &z);
        root->reach_m = maths_max(root->reach_m, sqrt(x * x + z * z));
    }
}

/* Sets the wish of a body whose crowd is locked: to go away from the crowd's centre of mass, the
 * farther from it the faster. Bodies that a plane separates have their middles on both sides of it:
 * so all gaps of the crowd widen at once, and by more than bodies lean otherwise where they go. */
static void open_crowd(struct parting *parting, const struct parting_input *input, uint32_t i)
{
    const struct parting_body *root = &parting->body[crowd_of(parting->body, i)];
    double rate = maths_min(OPENED / world_dt_s(input->context->world), OPENS_MPS / root->reach_m);
    double x, z;
    from_centre(root, input, i, &x, &z);
    parting->body[i].wish_x = rate * x;
    parting->body[i].wish_z = rate * z;
}

/* --- wishes ------------------------------------------------------------------------------------*/

static void limit(struct level_motion *pushed, double most_mps)
{
    double speed = sqrt(pushed->x * pushed->x + pushed->z * pushed->z);
    double keep = speed > most_mps ? most_mps / speed : 1.0;
    pushed->x *= keep;
    pushed->z *= keep;
    pushed->spin = maths_clamp(pushed->spin, -PUSHED_MOST_RPS, PUSHED_MOST_RPS);
}

void parting_wishes_limit(const struct parting_input *input, struct level_motion *pushed)
{
    limit(pushed, maths_min(PUSHED_MOST_MPS, RECOVERED_MOST_M / world_dt_s(input->context->world)));
}

/* Those that are deep in each other in a dense crowd do not bound each other: spreading parts them
 * all, though a pair may first get deeper. */
static bool spread_together(const struct parting_input *input, const struct level_contact *point)
{
    const struct pair rows = {input->row[point->a], input->row[point->b]};
    return !is_fixed(input, point->b) && crowds_spread_together(input->crowds, &rows);
}

/* Gives the bodies of a point the speeds at which it parts, or keeps its gap: the lighter takes
 * more. Returns by how much the speed at the point changes [m/s]. What others have made needless is
 * taken back, so that nobody goes farther than he has to. The point's apart_ns is the sum of its
 * steps, each in units of the bodies' light. */
static double part_point(const struct parting *parting, const struct parting_input *input,
                         struct level_contact *point)
{
    struct level_motion *a = &input->body[point->a].pushed, *b = &input->body[point->b].pushed;
    double light_a = parting->body[point->a].light, light_b = parting->body[point->b].light;
    double along = (b->x - a->x) * point->normal_x + (b->z - a->z) * point->normal_z;
    double before = point->apart_ns;
    if (light_a + light_b == 0.0)
        return 0.0;
    point->apart_ns = maths_max(0.0, before + (point->part_mps - along) / (light_a + light_b));
    double step = point->apart_ns - before;
    if (step == 0.0)
        return 0.0;
    a->x -= step * light_a * point->normal_x;
    a->z -= step * light_a * point->normal_z;
    b->x += step * light_b * point->normal_x;
    b->z += step * light_b * point->normal_z;
    return fabs(step) * (light_a + light_b);
}

/* Returns the speed at which the point asks its bodies to part [m/s]. Bodies that kept each other
 * where they were lean differently as soon as they move: they need more room. */
static double asked(const struct parting_input *input, const struct resting_pair *pair,
                    const struct level_contact *point)
{
    double more = pair->holds ? LEANS_M / world_dt_s(input->context->world) : 0.0;
    if (point->apart_mps > 0.0)
        return maths_min(point->apart_mps / PARTING_SHARE + more, PARTING_MPS);
    return point->least_mps + level_solver_closing(input->body, point) + more;
}

/* Lists the points that the sweeps go over. Returns their number. */
static uint32_t list_points(struct parting *parting, const struct parting_input *input)
{
    uint32_t count = 0;
    for (uint32_t p = 0; p < input->pairs; p++) {
        const struct resting_pair *pair = &input->pair[p];
        const struct level_contact *first = &input->point[pair->first];
        if (!parting_wishes_parts(parting, first->a) || spread_together(input, first))
            continue;
        for (uint32_t i = pair->first; i < pair->first + pair->count; i++) {
            input->point[i].part_mps = asked(input, pair, &input->point[i]);
            input->point[i].apart_ns = 0.0;
            parting->wishing[count++] = i;
        }
    }
    return count;
}

/* Finds the speeds at which the bodies would part. They do not turn: a turn would change the depths
 * of all their points. */
static void part_points(struct parting *parting, const struct parting_input *input)
{
    measure_locked(parting, input);
    for (uint32_t i = 0; i < input->bodies; i++) {
        struct parting_body *body = &parting->body[i];
        body->light = sqrt(input->body[i].inverse_mass);
        if (is_fixed(input, i) || !parting_wishes_parts(parting, i))
            continue;
        body->spreads = crowds_spreads(input->crowds, input->row[i]);
        body->wish_x = body->wish_z = 0.0;
        if (body->spreads)
            crowds_spread(input->crowds, input->context, input->row[i], &body->wish_x,
                          &body->wish_z);
        else if (body->opens)
            open_crowd(parting, input, i);
        input->body[i].pushed = (struct level_motion){body->wish_x, body->wish_z, 0.0};
    }
    uint32_t count = list_points(parting, input);
    double change = INFINITY;
    for (uint32_t sweep = 0; sweep < WISH_SWEEPS && change > LEVEL_SOLVER_ENOUGH_MPS; sweep++) {
        change = 0.0;
        for (uint32_t n = 0; n < count; n++) {
            uint32_t i = sweep % 2 == 0 ? n : count - 1 - n;
            struct level_contact *point = &input->point[parting->wishing[i]];
            change = maths_max(change, part_point(parting, input, point));
        }
    }
}

static void make_wishes(struct parting *parting, const struct parting_input *input)
{
    for (uint32_t i = 0; i < input->bodies; i++) {
        struct parting_body *body = &parting->body[i];
        body->goes = !is_fixed(input, i) && parting_wishes_parts(parting, i);
        if (body->goes)
            limit(&input->body[i].pushed,
                  body->opens ? OPENS_MPS * deep_pair_level(input->context, input->row[i])
                              : PUSHED_MOST_MPS);
        else
            parting_wishes_limit(input, &input->body[i].pushed);
        if (!body->goes || parting->body[i].spreads)
            continue;
        body->wish_x = input->body[i].pushed.x;
        body->wish_z = input->body[i].pushed.z;
    }
}

void parting_wishes_make(struct parting *parting, const struct parting_input *input)
{
    part_points(parting, input);
    make_wishes(parting, input);
}
