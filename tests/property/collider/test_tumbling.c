/* Tumbling pairs in free space: what collides in mid-frame, spinning, conserves momentum and gains
 * no energy, at any frame rate, and what turns by more than half a turn a frame is swept along its
 * real path. The oracle turns bodies by Euler's equations in small steps of its own. SEED=n runs
 * another set. */
#include "collider/geometry/time_of_impact.h"
#include "tests/support/steps.h"
#include "world/entity/mass_properties.h"
#include "world/params.h"
#include "world/world.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static const struct vec3 middle = {25000.0, 3000.0, 25000.0};
static const char *const kinds[] = {"helicopter", "jet"};
static const double rates_hz[] = {5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 240.0};
static struct fixture f;

static int open_world(void **state)
{
    (void)state;
    fixture_open(&f, "collision = { shape = \"model\"; };");
    return 0;
}

/* --- pairs -------------------------------------------------------------------------------------*/

static struct vec3 direction(uint64_t *random)
{
    for (;;) {
        struct vec3 v = {fixture_uniform(random, -1, 1), fixture_uniform(random, -1, 1),
                         fixture_uniform(random, -1, 1)};
        double length = vec3_length(v);
        if (length > 0.1 && length < 1.0)
            return vec3_scale(v, 1.0 / length);
    }
}

/* Sets a random frame rate and random kinds that no impact destroys. */
static double draw_world(uint64_t *random)
{
    double rate_hz = rates_hz[fixture_random(random) % (sizeof rates_hz / sizeof rates_hz[0])];
    for (int i = 0; i < 2; i++) {
        struct kind *kind = steps_kind(&f, kinds[i]);
        kind->restitution = fixture_uniform(random, 0.0, 1.0);
        kind->friction = fixture_uniform(random, 0.0, 1.0);
        kind->resistance_j = 1e300;
        kind->explosive_kg = 0.0;
    }
    steps_params(&f)->dt_s = 1.0 / rate_hz;
    steps_empty(&f);
    return rate_hz;
}

static void put(struct vec3 at, struct vec3 velocity, double spin_rps, uint64_t *random)
{
    const char *kind = kinds[fixture_random(random) % 2];
    uint32_t row =
        fixture_put(&f, (struct fixture_entity){.kind = kind, .at = at, .velocity = velocity});
    struct entities e = steps_rows(&f);
    struct vec3 spin = vec3_scale(direction(random), spin_rps);
    e.row[row].heading = fixture_uniform(random, 0.0, TWO_PI);
    e.row[row].pitch = fixture_uniform(random, -1.5, 1.5);
    e.row[row].roll = fixture_uniform(random, -PI, PI);
    e.row[row].spin_x = spin.x;
    e.row[row].spin_y = spin.y;
    e.row[row].spin_z = spin.z;
}

/* Two bodies that fly at each other and spin by up to most_rps. Returns the time in which they come
 * near and part again [s]. */
static double put_pair(double most_rps, uint64_t *random)
{
    double reach = steps_kind(&f, kinds[0])->bound_m + steps_kind(&f, kinds[1])->bound_m;
    double speed = fixture_uniform(random, 2.0, 60.0);
    struct vec3 towards = direction(random);
    struct vec3 beside = vec3_scale(direction(random), fixture_uniform(random, 0.0, 0.4 * reach));
    struct vec3 apart =
        vec3_add(vec3_scale(towards, -fixture_uniform(random, 0.6, 1.2) * reach), beside);
    struct vec3 drift = vec3_scale(direction(random), fixture_uniform(random, 0.0, 30.0));
    put(vec3_sub(middle, vec3_scale(apart, 0.5)), drift, fixture_uniform(random, 0.0, most_rps),
        random);
    put(vec3_add(middle, vec3_scale(apart, 0.5)), vec3_add(drift, vec3_scale(towards, speed)),
        fixture_uniform(random, 0.0, most_rps), random);
    return 2.0 * reach / speed;
}

/* A body at a frame's beginning. */
struct spinner {
    const struct kind *kind;
    struct vec3 at, velocity;
    struct quat q;
    struct vec3 momentum, moment; /* of its rotation: world axes; body axes */
    double spin_rps;
};

static struct spinner spinner_of(uint32_t row)
{
    struct entities e = steps_rows(&f);
    const struct kind *kind = &f.view.world.kinds[e.row[row].kind];
    struct vec3 spin = {e.row[row].spin_x, e.row[row].spin_y, e.row[row].spin_z};
    struct spinner body = {.kind = kind,
                           .at = entities_position(&e, row),
                           .velocity = entities_velocity(&e, row),
                           .q = rotation_of(e.row[row].heading, e.row[row].pitch, e.row[row].roll),
                           .moment = mass_properties_of(kind).moment,
                           .spin_rps = vec3_length(spin)};
    const struct mat3 turn = rotation_matrix(body.q);
    struct vec3 own = rotation_back(&turn, spin), m = body.moment;
    body.momentum = rotation_apply(&turn, (struct vec3){m.x * own.x, m.y * own.y, m.z * own.z});
    return body;
}

/* Returns the gap between the two with their orientations after a time [m]. */
static double gap_after(const struct spinner spinner[2], double time_s)
{
    const struct world *world = &f.view.world;
    struct swept_body body[2];
    for (uint32_t i = 0; i < 2; i++) {
        const struct spinner *s = &spinner[i];
        body[i] =
            (struct swept_body){.hull = world->hulls + s->kind->first_hull,
                                .hull_count = s->kind->hull_count,
                                .vertices = world->hull_vertices,
                                .planes = world->hull_planes,
                                .scale = 1.0,
                                .bound_m = s->kind->bound_m,
                                .path = {.at = vec3_add(s->at, vec3_scale(s->velocity, time_s))},
                                .from = s->q,
                                .to = s->q};
    }
    return time_of_impact_gap(&body[0], &body[1], 0.0);
}

static bool begins_apart(void)
{
    const struct spinner body[2] = {spinner_of(0), spinner_of(1)};
    return gap_after(body, 0.0) > 0.01;
}

/* --- what is conserved -------------------------------------------------------------------------*/

struct sums {
    struct vec3 momentum, angular;  /* [N s]; [N m s] about middle */
    double energy;                  /* [J] */
    double momentum_of, angular_of; /* sums of the parts' sizes */
};

static struct sums sums_of(void)
{
    struct entities e = steps_rows(&f);
    struct sums sums = {.energy = 0.0};
    for (uint32_t i = 0; i < 2; i++) {
        const struct mass_properties body = mass_properties_of(&f.view.world.kinds[e.row[i].kind]);
        struct mat3 turn =
            rotation_matrix(rotation_of(e.row[i].heading, e.row[i].pitch, e.row[i].roll));
        struct vec3 spin =
            rotation_back(&turn, (struct vec3){e.row[i].spin_x, e.row[i].spin_y, e.row[i].spin_z});
        struct vec3 momentum = vec3_scale(entities_velocity(&e, i), body.mass_kg);
        struct vec3 orbit = vec3_cross(vec3_sub(entities_position(&e, i), middle), momentum);
        struct vec3 own = {body.moment.x * spin.x, body.moment.y * spin.y, body.moment.z * spin.z};
        sums.energy += 0.5 * (vec3_dot(momentum, entities_velocity(&e, i)) + vec3_dot(own, spin));
        own = rotation_apply(&turn, own);
        sums.momentum = vec3_add(sums.momentum, momentum);
        sums.angular = vec3_add(sums.angular, vec3_add(orbit, own));
        sums.momentum_of += vec3_length(momentum);
        sums.angular_of += vec3_length(orbit) + vec3_length(own);
    }
    return sums;
}

#define PAIRS      400
#define FRAMES_MAX 400

struct score {
    int pairs, events;
    int grew, turned, pushed; /* pairs that gained energy, angular momentum and momentum */
    double energy, angular, momentum;
};

static void run_pair(uint64_t *random, struct score *score)
{
    double rate_hz = draw_world(random), worst[3] = {0.0, 0.0, 0.0};
    uint32_t frames = 2 + (uint32_t)(put_pair(20.0, random) * rate_hz), events = 0;
    if (!begins_apart())
        return;
    for (uint32_t n = 0; n < frames && n < FRAMES_MAX; n++) {
        struct sums before = sums_of();
        fixture_run(&f, 1);
        struct sums after = sums_of();
        worst[0] = maths_max(worst[0], after.energy / before.energy - 1.0);
        worst[1] = maths_max(worst[1], vec3_length(vec3_sub(after.angular, before.angular)) /
                                           before.angular_of);
        worst[2] = maths_max(worst[2], vec3_length(vec3_sub(after.momentum, before.momentum)) /
                                           before.momentum_of);
    }
    events = fixture_event_count(&f, EVENT_COLLISION);
    score->pairs += events > 0;
    score->events += (int)events;
    score->grew += worst[0] > 1e-6;
    score->turned += worst[1] > 1e-9;
    score->pushed += worst[2] > 1e-9;
    score->energy = maths_max(score->energy, worst[0]);
    score->angular = maths_max(score->angular, worst[1]);
    score->momentum = maths_max(score->momentum, worst[2]);
}

static void test_rows_39_43_tumbling_pairs_keep_momentum_and_gain_no_energy(void **state)
{
    uint64_t random = fixture_seed(3943);
    struct score score = {.pairs = 0};
    (void)state;
    while (score.pairs < PAIRS)
        run_pair(&random, &score);
    print_message("# figures: %d pairs, %d impacts, energy +%.1e, momenta %.1e and %.1e\n",
                  score.pairs, score.events, score.energy, score.momentum, score.angular);
    if (score.grew + score.turned + score.pushed > 0)
        fail_msg("of %d pairs with %d impacts %d gained energy (worst %.3g), %d angular momentum "
                 "(%.3g), %d momentum (%.3g)",
                 score.pairs, score.events, score.grew, score.energy, score.turned, score.angular,
                 score.pushed, score.momentum);
}

/* --- many turns a frame ------------------------------------------------------------------------*/

#define SPUN_PAIRS  120
#define SMALL_STEPS 20000
#define NEAR_M      1e-5 /* between the oracle's gap and the skin */

/* Euler's equations: the orientation's change in a second. */
static struct quat change_of(const struct spinner *s, struct quat q)
{
    const struct mat3 turn = rotation_matrix(q);
    struct vec3 body = rotation_back(&turn, s->momentum);
    return rotation_product(q,
                            (struct quat){0.0, 0.5 * body.x / s->moment.x,
                                          0.5 * body.y / s->moment.y, 0.5 * body.z / s->moment.z});
}

static struct quat plus(struct quat q, struct quat change, double h)
{
    return (struct quat){q.w + h * change.w, q.x + h * change.x, q.y + h * change.y,
                         q.z + h * change.z};
}

/* Runge and Kutta's rule. */
static void step(struct spinner *s, double h)
{
    struct quat a = change_of(s, s->q), b = change_of(s, plus(s->q, a, 0.5 * h));
    struct quat c = change_of(s, plus(s->q, b, 0.5 * h)), d = change_of(s, plus(s->q, c, h));
    struct quat q = plus(plus(plus(plus(s->q, a, h / 6.0), b, h / 3.0), c, h / 3.0), d, h / 6.0);
    double scale = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    s->q = (struct quat){q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

/* Returns the gap at a share of the frame; *least_m is the least gap before [m]. */
static double watch(struct spinner body[2], double dt_s, double share, double *least_m)
{
    double fastest = vec3_length(vec3_sub(body[1].velocity, body[0].velocity)), next_s = 0.0;
    double h = dt_s / SMALL_STEPS;
    int steps = (int)(share * SMALL_STEPS);
    *least_m = INFINITY;
    /* A body spins up to twice as fast where its momentum is about a smaller moment. */
    for (int i = 0; i < 2; i++)
        fastest += 2.0 * body[i].kind->bound_m * body[i].spin_rps;
    for (int n = 0; n < steps; n++) {
        if (n * h >= next_s) {
            double gap = gap_after(body, n * h);
            *least_m = maths_min(*least_m, gap);
            next_s = n * h + maths_max(0.0, gap - SKIN_M) / fastest;
        }
        step(&body[0], h);
        step(&body[1], h);
    }
    double rest_s = (share * SMALL_STEPS - steps) * h;
    step(&body[0], rest_s);
    step(&body[1], rest_s);
    return gap_after(body, share * dt_s);
}

/* The first contact of the frame is where the oracle's bodies are one skin apart, and those are
 * nowhere nearer before. */
static void test_row_23_nothing_is_missed_at_several_turns_a_frame(void **state)
{
    static const double slow_hz[] = {2.0, 5.0, 10.0};
    uint64_t random = fixture_seed(2339);
    int hits = 0, pairs = 0, missed = 0, wrong = 0;
    double worst = 0.0;
    (void)state;
    while (pairs < SPUN_PAIRS) {
        draw_world(&random);
        double rate_hz = slow_hz[fixture_random(&random) % 3], least, gap;
        steps_params(&f)->dt_s = 1.0 / rate_hz;
        put_pair(TWO_PI * rate_hz * fixture_uniform(&random, 0.5, 2.5), &random);
        if (!begins_apart())
            continue;
        struct spinner body[2] = {spinner_of(0), spinner_of(1)};
        fixture_run(&f, 1);
        const struct event *event = fixture_event(&f, EVENT_COLLISION, 0);
        gap = watch(body, 1.0 / rate_hz, event ? event->collision.toi : 1.0, &least);
        pairs++;
        hits += event != NULL;
        missed += least < SKIN_M - NEAR_M;
        wrong += event && fabs(gap - SKIN_M) > NEAR_M;
        worst = maths_max(worst, event ? fabs(gap - SKIN_M) : 0.0);
    }
    print_message("# figures: %d pairs, %d touch, %.1e m from the skin at most\n", pairs, hits,
                  worst);
    if (missed + wrong > 0 || hits < pairs / 4 || hits == pairs)
        fail_msg("of %d pairs %d touch, %d were missed before, %d elsewhere (worst gap %.3g m)",
                 pairs, hits, missed, wrong, worst);
}

int main(void)
{
#define TEST(function)                                                                             \
    cmocka_unit_test_prestate_setup_teardown(function, open_world, fixture_teardown, &f)
    const struct CMUnitTest tests[] = {
        TEST(test_rows_39_43_tumbling_pairs_keep_momentum_and_gain_no_energy),
        TEST(test_row_23_nothing_is_missed_at_several_turns_a_frame),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
