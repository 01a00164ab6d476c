/* Pairs of hulls that boxes rule out, against the distance of their hulls on the whole way. SEED=n
 * runs another set. */
#include "collider/geometry/box_view.h"

#include "collider/geometry/gjk.h"
#include "tests/support/fixture.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#define CORNERS 8
#define TIMES   9 /* at which the hulls are looked at on the way */

/* A body of up to HULLS_A_MODEL boxes. */
struct model {
    struct hull hull[HULLS_A_MODEL];
    struct vec3 vertex[HULLS_A_MODEL * CORNERS];
    struct swept_body body;
    struct mat3 turn;
};

static struct vec3 any_vector(uint64_t *random, double low, double high)
{
    double x = fixture_uniform(random, low, high), y = fixture_uniform(random, low, high);
    return (struct vec3){x, y, fixture_uniform(random, low, high)};
}

static void form(struct model *model, uint64_t *random)
{
    uint32_t count = 1 + (uint32_t)(fixture_random(random) % HULLS_A_MODEL);
    for (uint32_t i = 0; i < count; i++) {
        struct vec3 at = any_vector(random, -4, 4), half = any_vector(random, 0.05, 2.5);
        for (uint32_t k = 0; k < CORNERS; k++)
            model->vertex[CORNERS * i + k] =
                vec3_add(at, (struct vec3){k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y,
                                           k & 4 ? half.z : -half.z});
        model->hull[i] = (struct hull){
            .first_vertex = CORNERS * i, .vertex_count = CORNERS, .centre = at, .half = half};
    }
    model->body = (struct swept_body){.hull = model->hull,
                                      .hull_count = count,
                                      .vertices = model->vertex,
                                      .scale = fixture_uniform(random, 0.5, 2.0)};
    model->turn = rotation_matrix(rotation_of(fixture_uniform(random, 0.0, TWO_PI),
                                              fixture_uniform(random, -1.5, 1.5),
                                              fixture_uniform(random, -PI, PI)));
}

static struct convex put(const struct model *model, uint32_t hull, struct vec3 at)
{
    return (struct convex){.vertex = model->vertex + model->hull[hull].first_vertex,
                           .count = CORNERS,
                           .scale = model->body.scale,
                           .turn = model->turn,
                           .at = at};
}

/* Returns the least distance of two hulls while b goes its way relative to a. */
static double least(const struct convex *a, struct convex b, struct vec3 way)
{
    struct vec3 from = b.at;
    double least = INFINITY;
    for (int i = 0; i < TIMES; i++) {
        b.at = vec3_add(from, vec3_scale(way, (double)i / (TIMES - 1)));
        least = maths_min(least, gjk_distance(a, &b).distance_m);
    }
    return least;
}

static void test_what_boxes_rule_out_stays_far(void **state)
{
    static struct model a, b;
    uint64_t random = fixture_seed(340), pairs = 0, far = 0, ruled_out = 0;
    (void)state;
    for (int n = 0; n < 1500; n++) {
        form(&a, &random);
        form(&b, &random);
        struct vec3 at = vec3_scale(fixture_direction(&random), fixture_uniform(&random, 0, 20));
        struct vec3 way = n % 2 ? any_vector(&random, -3, 3) : (struct vec3){0, 0, 0};
        double margin = n % 3 == 0 ? 0.0 : fixture_uniform(&random, 0.0, 1.0);
        struct box_view view = box_view_swept(&a.turn, &b.turn, at, way, margin);
        uint64_t near = box_view_near(&view, &a.body, &b.body);
        for (uint32_t i = 0; i < a.body.hull_count; i++) {
            for (uint32_t j = 0; j < b.body.hull_count; j++) {
                struct convex p = put(&a, i, (struct vec3){0, 0, 0});
                double gap = least(&p, put(&b, j, at), way);
                bool out = !(near >> (HULLS_A_MODEL * i + j) & 1);
                if (out ? gap <= margin
                        : box_view_apart(&view, &a.body, &a.hull[i], &b.body, &b.hull[j]))
                    fail_msg("case %d, hulls %u and %u: %.17g m apart, margin %.17g, out %d", n, i,
                             j, gap, margin, out);
                pairs++;
                far += gap > margin;
                ruled_out += out;
            }
        }
    }
    printf("  test_box_view: of %lu pairs %lu are far, %lu ruled out\n", (unsigned long)pairs,
           (unsigned long)far, (unsigned long)ruled_out);
    assert_true(ruled_out > far * 4 / 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_boxes_rule_out_stays_far),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
