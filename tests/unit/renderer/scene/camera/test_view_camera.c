/* The cameras of the views: above the ground, on their vehicle, without jerks. */
#include "renderer/scene/camera/view_camera.h"

#include "renderer/scene/camera/crew_eye.h"
#include "renderer/scene/frame/body_axes.h"
#include "tests/support/fixture.h"
#include "tests/support/scene_stage.h"
#include "world/model.h"
#include "world/params.h"
#include "world/terrain/gridsquare.h"
#include "world/view_mode.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define POSTS    401u
#define CAPACITY 16u
#define DT_S     (1.0 / 60.0)

enum { TANK, PLANE, KINDS };

/* A hull of 6 x 2 x 3 m with a turret on it, whose gun is long. */
static const struct model_vertex vertices[] = {
    {-3, 0, -1.5f},    {3, 0, -1.5f},   {3, 0, 1.5f},     {-3, 0, 1.5f},   {-3, 1.4f, -1.5f},
    {3, 1.4f, -1.5f},  {3, 1.4f, 1.5f}, {-3, 1.4f, 1.5f}, {-1, 2.0f, -1},  {1, 2.0f, -1},
    {1, 2.0f, 1},      {-1, 2.0f, 1},   {1, 1.8f, 0},     {5, 1.8f, 0.1f}, {5, 1.8f, -0.1f},
    {-9, 3.5f, -0.2f}, {9, 3.5f, 0},    {-9, 3.5f, 0.2f},
};
static const struct model_triangle triangles[] = {
    {.vertex = {4, 7, 6}},
    {.vertex = {4, 6, 5}},
    {.vertex = {8, 11, 10}, .part = PART_TURRET},
    {.vertex = {8, 10, 9}, .part = PART_TURRET},
    {.vertex = {12, 13, 14}, .part = PART_TURRET},
    {.vertex = {15, 16, 17}, .part = PART_ROTOR},
};
static const struct model models[] = {{.name = "box", .triangle_count = 6, .vertex_count = 18}};
static const struct kind kinds[KINDS] = {
    [TANK] =
        {.name = "tank", .domain = DOMAIN_LAND, .radius_m = 3.0, .length_m = 6.0, .height_m = 2.0},
    [PLANE] =
        {.name = "plane", .domain = DOMAIN_AIR, .radius_m = 7.0, .length_m = 15.0, .height_m = 3.0},
};

struct stage {
    struct params params;
    struct world world;
    struct state_head head;
    struct entities entities;
    void *columns;
    float *posts;
    uint8_t *cover;
    struct crater craters[4];
    struct crater_index index;
    struct frame_view frame_view;
};

static uint64_t seed;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005ull + 1442695040888963407ull;
    return low + (high - low) * (double)(seed >> 11) / 9007199254740992.0;
}

static int open_stage(void **context)
{
    struct stage *s = calloc(1, sizeof *s);
    assert_non_null(s);
    seed = fixture_seed(11);
    s->posts = malloc(POSTS * POSTS * sizeof *s->posts);
    s->cover = calloc(POSTS, POSTS);
    s->columns = aligned_alloc(TABLE_ALIGN, entities_bytes(CAPACITY));
    assert_true(s->posts != NULL && s->cover != NULL && s->columns != NULL);
    for (uint32_t row = 0; row < POSTS; row++)
        for (uint32_t column = 0; column < POSTS; column++)
            s->posts[row * POSTS + column] =
                (float)(300.0 + 200.0 * maths_sin(column * 0.11) * maths_cos(row * 0.07) +
                        60.0 * maths_sin(column * 0.9 + row));
    s->params.dt_s = DT_S;
    s->world = (struct world){
        .params = &s->params,
        .counts = {.kinds = KINDS, .models = 1},
        .terrain = {s->posts, s->cover, POSTS, 125.0, .squares = GRIDSQUARES_DEFAULT_INIT},
        .kinds = kinds,
        .models = models,
        .model_vertices = vertices,
        .model_triangles = triangles};
    memset(s->columns, 0, entities_bytes(CAPACITY));
    entities_bind(&s->entities, CAPACITY, s->columns);
    assert_int_equal(crater_index_init(&s->index, &GRIDSQUARES_DEFAULT, s->craters), 0);
    s->frame_view = (struct frame_view){
        .world = &s->world, .head = &s->head, .entities = &s->entities, .craters = &s->index};
    *context = s;
    return 0;
}

static int close_stage(void **context)
{
    struct stage *s = *context;
    crater_index_free(&s->index);
    free(s->columns);
    free(s->posts);
    free(s->cover);
    free(s);
    return 0;
}

static double ground_at(const struct stage *s, double x, double z)
{
    return terrain_height(&s->world.terrain, &s->index, x, z);
}

/* Moves and turns the one vehicle. */
static void put(struct stage *s, uint16_t kind, double x, double z)
{
    const struct entities *e = &s->entities;
    s->head.used = 1;
    e->row[0].id = 1;
    e->row[0].state = ENTITY_ACTIVE;
    e->row[0].kind = kind;
    e->row[0].x = x;
    e->row[0].z = z;
    e->row[0].y = ground_at(s, x, z) + (kind == PLANE ? draw(0.0, 500.0) : 0.0);
    e->row[0].heading = draw(0.0, TWO_PI);
    e->row[0].pitch = draw(-0.6, 0.6);
    e->row[0].roll = draw(-0.6, 0.6);
}

static struct view_camera_options wish_of(enum view_mode view)
{
    return (struct view_camera_options){
        .view = view, .field_rad = CAMERA_FIELD_OF_VIEW_RAD, .width = 1280, .height = 720};
}

static void check_axes(const struct camera *c)
{
    assert_true(isfinite(c->eye.x + c->eye.y + c->eye.z));
    assert_true(fabs(vec3_length(c->forward) - 1.0) < 1e-9);
    assert_true(fabs(vec3_length(c->right) - 1.0) < 1e-9);
    assert_true(fabs(vec3_length(c->up) - 1.0) < 1e-9);
    assert_true(fabs(vec3_dot(c->forward, c->right)) < 1e-9);
    assert_true(fabs(vec3_dot(c->forward, c->up)) < 1e-9);
    assert_true(vec3_dot(vec3_cross(c->right, c->forward), c->up) > 0.999);
}

/* --- every view ------------------------------------------------------------------------------- */

static void test_cameras_are_above_the_ground_and_see_their_vehicle(void **context)
{
    struct stage *s = *context;
    for (uint32_t i = 0; i < 4000; i++) {
        enum view_mode view = (enum view_mode)(i % VIEW_COUNT);
        struct view_camera aim = {.id = 0};
        struct camera camera;
        struct view_camera_options wish = wish_of(view);
        if (view == VIEW_MAP)
            continue;
        s->head.tick = i * 1000;
        put(s, i % 7 == 0 ? PLANE : TANK, draw(0.0, WORLD_SIDE_DEFAULT_M),
            draw(0.0, WORLD_SIDE_DEFAULT_M));
        view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
        check_axes(&camera);
        double least = view == VIEW_INSIDE ? 0.5
                       : view == VIEW_FREE ? VIEW_CAMERA_EYE_M
                                           : VIEW_CAMERA_CLEARANCE_M;
        double ground = ground_at(s, camera.eye.x, camera.eye.z);
        if (camera.eye.y < ground + least - 1e-9)
            fail_msg("%s: %.3f m above the ground", view_mode_name(view), camera.eye.y - ground);
        if (view != VIEW_INSIDE &&
            !scene_stage_in_picture(&camera, entities_position(&s->entities, 0)))
            fail_msg("%s does not see its vehicle (%u)", view_mode_name(view), i);
    }
}

static void test_without_a_vehicle_they_look_over_the_middle(void **context)
{
    struct stage *s = *context;
    for (int view = 0; view < VIEW_COUNT; view++) {
        struct view_camera aim = {.id = 0};
        struct view_camera_options wish = wish_of((enum view_mode)view);
        struct camera camera;
        double middle = 0.5 * WORLD_SIDE_DEFAULT_M;
        if (view == VIEW_MAP)
            continue;
        view_camera_update(&aim, &wish, &s->frame_view, SLOT_NONE, &camera);
        check_axes(&camera);
        assert_true(scene_stage_in_picture(
            &camera, (struct vec3){middle, ground_at(s, middle, middle), middle}));
    }
}

static void test_overhead_has_north_above_and_east_right(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_OVERHEAD);
    struct camera camera;
    put(s, TANK, 20000.0, 30000.0);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    assert_true(camera.forward.y == -1.0);
    assert_true(camera.up.z == -1.0 && camera.right.x == 1.0);
    assert_true(camera.eye.x == 20000.0 && camera.eye.z == 30000.0);
}

static void test_field_of_view_is_as_wished(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_CHASE);
    struct camera camera;
    wish.field_rad = HALF_PI;
    put(s, TANK, 20000.0, 30000.0);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    assert_true(fabs(camera.tan_x - 1.0) < 1e-12);
    assert_true(fabs(camera.tan_y - 9.0 / 16.0) < 1e-12);
}

/* --- inside ----------------------------------------------------------------------------------- */

static void test_the_crew_looks_out_above_its_polygons(void **context)
{
    struct stage *s = *context;
    struct vec3 eye = crew_eye_seat(&s->world, &kinds[TANK]).eye;
    assert_true(fabs(eye.y - 2.0 - CREW_EYE_CLEARANCE_M) <
                1e-6); /* the turret's top, not the rotor's */
    assert_true(eye.x > -1.0 && eye.x < 3.0 && fabs(eye.z) < 0.5);
    put(s, TANK, 20000.0, 30000.0);
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_INSIDE);
    struct camera camera;
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    const struct entities *e = &s->entities;
    struct body_axes pose = body_axes_of(e->row[0].heading, e->row[0].pitch, e->row[0].roll);
    assert_true(vec3_dot(camera.right, pose.right) > 1.0 - 1e-9); /* it rolls with its vehicle */
    struct vec3 muzzle = vec3_add(entities_position(e, 0), vec3_scale(pose.forward, 5.0));
    assert_true(scene_stage_in_picture(&camera, vec3_add(muzzle, vec3_scale(pose.up, 1.8))));
}

/* --- from picture to picture ------------------------------------------------------------------ */

static void go(struct stage *s, double turn_rps, double speed_mps)
{
    const struct entities *e = &s->entities;
    double sine, cosine;
    s->head.tick++;
    e->row[0].heading = maths_wrap_turn(e->row[0].heading + turn_rps * DT_S);
    maths_sincos(e->row[0].heading, &sine, &cosine);
    entities_set_velocity(e, 0, (struct vec3){speed_mps * sine, 0.0, -speed_mps * cosine});
    e->row[0].x += e->row[0].vx * DT_S;
    e->row[0].z += e->row[0].vz * DT_S;
    e->row[0].y = ground_at(s, e->row[0].x, e->row[0].z);
    e->row[0].pitch = e->row[0].roll = 0.0;
}

static double angle_between(struct vec3 a, struct vec3 b)
{
    double cosine = vec3_dot(a, b);
    return acos(maths_clamp(cosine, -1.0, 1.0));
}

/* When a vehicle turns on the spot within a frame, the camera follows smoothly. */
static void test_chase_eases_into_a_turn(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_CHASE);
    struct camera camera, before;
    put(s, TANK, 20000.0, 30000.0);
    for (int i = 0; i < 120; i++) {
        go(s, 0.0, 10.0);
        view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    }
    double most = 0.0, whole = 0.0;
    s->entities.row[0].heading = maths_wrap_turn(s->entities.row[0].heading + 1.5);
    for (int i = 0; i < 240; i++) {
        before = camera;
        go(s, 0.0, 0.0);
        view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
        double turned = angle_between(before.forward, camera.forward);
        most = maths_max(most, turned);
        whole += turned;
    }
    assert_true(most < 0.06); /* 1.5 at once for a new camera */
    assert_true(whole > 1.4);
    struct view_camera cold = {.id = 0};
    view_camera_update(&cold, &wish, &s->frame_view, 0, &before);
    assert_true(angle_between(before.forward, camera.forward) < 0.02);
    assert_true(vec3_length(vec3_sub(before.eye, camera.eye)) < 0.8);
}

/* A camera that watches something turns to it softly. Through its longer lens the vehicle is as
 * large as before, and as near to the middle of the picture. */
static void test_a_watching_camera_turns_and_keeps_the_size(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0}, cold = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_CHASE);
    struct camera usual, before, camera;
    put(s, TANK, 20000.0, 30000.0);
    s->entities.row[0].heading = 0.0;
    view_camera_update(&cold, &wish, &s->frame_view, 0, &usual);
    double most = 0.0;
    for (int i = 0; i < 600; i++) {
        before = camera;
        s->head.tick++;
        view_camera_watch(&aim, i < 300 ? 0.0 : HALF_PI, i < 300 ? 0.0 : 1000.0);
        view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
        most = i > 0 ? maths_max(most, angle_between(before.forward, camera.forward)) : most;
    }
    assert_true(most < 0.03);
    assert_true(fabs(maths_heading(camera.forward.x, camera.forward.z) - HALF_PI) < 0.2);
    struct vec3 at = entities_position(&s->entities, 0);
    double size = camera_pixels(&camera, 1.0, vec3_length(vec3_sub(at, camera.eye)));
    double usually = camera_pixels(&usual, 1.0, vec3_length(vec3_sub(at, usual.eye)));
    assert_true(fabs(size / usually - 1.0) < 0.15);
    assert_true(scene_stage_in_picture(&camera, at));
    assert_true(camera.tan_x < 0.65 * usual.tan_x);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera); /* it no longer watches */
    assert_true(camera.tan_x == usual.tan_x);
}

/* The picture rate hardly changes the camera's position. */
static void test_easing_does_not_depend_on_the_rate(void **context)
{
    struct stage *s = *context;
    struct view_camera aims[2] = {{.id = 0}, {.id = 0}};
    struct view_camera_options wish = wish_of(VIEW_CHASE);
    struct camera often, seldom;
    put(s, TANK, 20000.0, 30000.0);
    for (int i = 0; i < 300; i++) {
        go(s, i % 100 < 50 ? 0.8 : -0.8, 10.0);
        view_camera_update(&aims[0], &wish, &s->frame_view, 0, &often);
        if (i % 6 != 5)
            continue;
        view_camera_update(&aims[1], &wish, &s->frame_view, 0, &seldom);
        assert_true(vec3_length(vec3_sub(often.eye, seldom.eye)) < 2.5);
    }
}

/* After a change of vehicle, a jump or a long pause the camera equals a new one exactly. */
static void test_camera_restarts_after_a_break(void **context)
{
    struct stage *s = *context;
    for (int what = 0; what < 3; what++) {
        struct view_camera aim = {.id = 0}, cold = {.id = 0};
        struct view_camera_options wish = wish_of(VIEW_CHASE);
        struct camera warm, fresh;
        put(s, TANK, 20000.0, 30000.0);
        for (int i = 0; i < 30; i++) {
            go(s, 0.5, 10.0);
            view_camera_update(&aim, &wish, &s->frame_view, 0, &warm);
        }
        s->head.tick += what == 0 ? 600 : 1;
        s->entities.row[0].x += what == 1 ? 400.0 : 0.0;
        s->entities.row[0].id += what == 2 ? 1 : 0;
        view_camera_update(&aim, &wish, &s->frame_view, 0, &warm);
        view_camera_update(&cold, &wish, &s->frame_view, 0, &fresh);
        assert_memory_equal(&warm, &fresh, sizeof warm);
        assert_memory_equal(&aim, &cold, sizeof aim);
    }
}

static void test_orbit_goes_around_in_its_time(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_ORBIT);
    struct camera camera;
    put(s, TANK, 20000.0, 30000.0);
    s->head.tick = 0;
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    struct vec3 first = vec3_sub(camera.eye, entities_position(&s->entities, 0));
    s->head.tick = (uint64_t)(60.0 * VIEW_CAMERA_ORBIT_S / 2.0 + 0.5);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    struct vec3 half = vec3_sub(camera.eye, entities_position(&s->entities, 0));
    assert_true(fabs(first.x + half.x) < 1e-6 && fabs(first.z + half.z) < 1e-6);
}

static void test_free_camera_stays(void **context)
{
    struct stage *s = *context;
    struct view_camera aim = {.id = 0};
    struct view_camera_options wish = wish_of(VIEW_FREE);
    struct camera camera, later;
    put(s, TANK, 20000.0, 30000.0);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &camera);
    for (int i = 0; i < 100; i++)
        go(s, 0.1, 20.0);
    view_camera_update(&aim, &wish, &s->frame_view, 0, &later);
    assert_memory_equal(&camera, &later, sizeof camera);
}

static void test_free_camera_has_the_given_pose(void **context)
{
    struct stage *s = *context;
    static const double pitches[] = {-HALF_PI, -0.1, 0.7, HALF_PI};
    for (size_t i = 0; i < sizeof pitches / sizeof pitches[0]; i++) {
        struct view_camera aim = {.id = 0};
        struct view_camera_options wish = wish_of(VIEW_FREE);
        struct camera camera;
        wish.pose = (struct view_camera_pose){true, 1000.0, 2000.0, 30.0, HALF_PI, pitches[i]};
        view_camera_update(&aim, &wish, &s->frame_view, SLOT_NONE, &camera);
        check_axes(&camera);
        assert_true(camera.eye.x == 1000.0 && camera.eye.z == 2000.0);
        assert_true(fabs(camera.eye.y - ground_at(s, 1000.0, 2000.0) - 30.0) < 1e-9);
        assert_true(fabs(camera.forward.y - maths_sin(pitches[i])) < 1e-9);
        assert_true(fabs(camera.right.z - 1.0) < 1e-9); /* it looks east */
    }
}

#define TEST(name) cmocka_unit_test_setup_teardown(name, open_stage, close_stage)

int main(void)
{
    const struct CMUnitTest tests[] = {
        TEST(test_cameras_are_above_the_ground_and_see_their_vehicle),
        TEST(test_without_a_vehicle_they_look_over_the_middle),
        TEST(test_overhead_has_north_above_and_east_right),
        TEST(test_field_of_view_is_as_wished),
        TEST(test_the_crew_looks_out_above_its_polygons),
        TEST(test_chase_eases_into_a_turn),
        TEST(test_a_watching_camera_turns_and_keeps_the_size),
        TEST(test_easing_does_not_depend_on_the_rate),
        TEST(test_camera_restarts_after_a_break),
        TEST(test_orbit_goes_around_in_its_time),
        TEST(test_free_camera_stays),
        TEST(test_free_camera_has_the_given_pose),
    };
    return cmocka_run_group_tests_name("aim", tests, NULL, NULL);
}
