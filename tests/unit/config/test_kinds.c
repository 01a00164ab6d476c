/* Kinds: defaults, derived values, and the shipped kinds (rows 26, 27, 49). Refusals are in
 * test_loader_refusals.c. */
#include "config/kinds.h"

#include "config/loader.h"
#include "config/syntax/schema.h"
#include "tests/support/quick_config.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/maths/maths.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

/* Two pieces that share no corner, so two hulls. */
#define SHAPE                                                                                      \
    "mtllib k.mtl\no body\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 0 0\nv 8 0 0\nv 9 1 0\n"        \
    "v 9 0 1\nusemtl red\nf 1 2 3\nf 1 2 4\nf 5 6 7\nf 5 6 8\n"
#define NEEDS                                                                                      \
    "domain = \"fixed\"; class = \"tree\"; mass_kg = 1; radius_m = 1; resistance_j = 5000;\n"      \
    "length_m = 4; width_m = 2; height_m = 8; model = "

static struct error_text error;

static void write_in(const char *folder, const char *file, const char *text)
{
    char path[160];

    snprintf(path, sizeof(path), "%s/%s", quick_config.folder, folder);
    mkdir(path, 0700);
    snprintf(path, sizeof(path), "%s/%s/%s", quick_config.folder, folder, file);
    quick_config_write(path, text);
}

/* Loads the kind k with this text after the required keys, and the kind l with these alone. */
static void load(struct scenario *scenario, const char *text)
{
    char kind[512];

    write_in("models", "k.mtl", "newmtl red\nKd 1 0 0\n");
    write_in("models", "k.obj", SHAPE);
    write_in("models", "m.obj", SHAPE);
    snprintf(kind, sizeof(kind), "name = \"k\"; " NEEDS "\"k\"; %s", text);
    write_in("kinds", "k.cfg", kind);
    write_in("kinds", "l.cfg", "name = \"l\"; " NEEDS "\"k\";");
    write_in("kinds", "m.cfg", "name = \"m\"; " NEEDS "\"m\";");
    quick_config_write(quick_config.scenario_path, "");
    if (loader_scenario(scenario, quick_config.folder, quick_config.scenario_path, NULL, 0,
                        &error) != 0)
        fail_msg("refused: %s", error.text);
    assert_int_equal(scenario->kind_count, 3);
}

static void test_defaults(void **state)
{
    struct scenario s;

    (void)state;
    load(&s, "");
    const struct kind *k = &s.kinds[0];
    assert_true(k->friction == 0.6);
    assert_true(k->severe_rad == 5.0 * RAD_PER_DEG);
    assert_true(k->bounce_keep == 0.6);
    assert_true(k->fast_mps == 0.0);
    assert_true(k->damage_high == 0.0 && k->damage_med == 0.0 && k->damage_low == 0.0);
    assert_true(k->debris_keep == 1.0);
    /* 5 kJ over a quarter of 2 m: k d^2 / 2. */
    assert_true(fabs(0.5 * k->stiffness_npm * 0.5 * 0.5 - 5000.0) < 1e-9);
    scenario_free(&s);
}

static void test_given_values(void **state)
{
    static const struct {
        const char *text;
        size_t offset;
        double value;
    } rows[] = {
        {"friction = 0;", offsetof(struct kind, friction), 0.0},
        {"friction = 2;", offsetof(struct kind, friction), 2.0},
        {"stiffness_npm = 7e6;", offsetof(struct kind, stiffness_npm), 7e6},
        {"severe_deg = 45;", offsetof(struct kind, severe_rad), 45.0 * RAD_PER_DEG},
        {"severe_deg = 0;", offsetof(struct kind, severe_rad), 0.0},
        {"bounce_keep = 0.25;", offsetof(struct kind, bounce_keep), 0.25},
        {"fast_mps = 12.5;", offsetof(struct kind, fast_mps), 12.5},
        {"damage_high = 3; damage_med = 2; damage_low = 1;", offsetof(struct kind, damage_high), 3},
        {"damage_high = 3; damage_med = 2; damage_low = 1;", offsetof(struct kind, damage_med), 2},
        {"damage_high = 3; damage_med = 2; damage_low = 1;", offsetof(struct kind, damage_low), 1},
        {"damage_high = 0; damage_med = 0; damage_low = 0;", offsetof(struct kind, damage_high), 0},
        {"debris_keep = 0.35;", offsetof(struct kind, debris_keep), 0.35},
        {"armour_mm = [9, 8.5, 7, 6];", offsetof(struct kind, armour_mm), 9.0},
        {"armour_mm = [9, 8.5, 7, 6];", offsetof(struct kind, armour_mm[ASPECT_SIDE]), 8.5},
        {"armour_mm = [9, 8.5, 7, 6];", offsetof(struct kind, armour_mm[ASPECT_TOP]), 6.0},
    };

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        struct scenario s;
        double value;

        load(&s, rows[i].text);
        memcpy(&value, (const char *)&s.kinds[0] + rows[i].offset, sizeof(value));
        if (value != rows[i].value)
            fail_msg("%s gives %g", rows[i].text, value);
        scenario_free(&s);
    }
}

/* Row 38: kinds of one model share its hulls; another model of the same shape has its own. */
static void test_kinds_of_one_model_share_its_hulls(void **state)
{
    struct scenario s;

    (void)state;
    load(&s, "");
    assert_int_equal(s.model_count, 2);
    assert_int_equal(s.hull_count, 6);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(s.kinds[i].hull_count, 2);
        assert_true(s.kinds[i].bound_m == s.kinds[0].bound_m);
        assert_true(s.kinds[i].level_m == s.kinds[0].level_m);
        assert_true(s.kinds[i].low_m == s.kinds[0].low_m);
        assert_true(s.kinds[i].high_m == s.kinds[0].high_m);
    }
    assert_int_equal(s.kinds[0].first_hull, 0);
    assert_int_equal(s.kinds[1].first_hull, 0);
    assert_int_equal(s.kinds[2].first_hull, 3);
    assert_int_equal(s.kinds[1].outer_hull, 2);
    assert_int_equal(s.kinds[2].outer_hull, 5);
    assert_true(fabs(s.kinds[0].level_m - hypot(9.0, 1.0)) < 1e-6);
    assert_true(fabs(s.kinds[0].low_m) < 1e-6 && fabs(s.kinds[0].high_m - 1.0) < 1e-6);
    scenario_free(&s);
}

/* Row 32: a stump slows a vehicle less than a house's rubble. */
static void test_shipped_kinds_slide_and_leave_debris(void **state)
{
    struct scenario s;

    (void)state;
    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error), 0);
    for (uint32_t i = 0; i < s.kind_count; i++) {
        const struct kind *kind = &s.kinds[i];

        assert_true(kind->friction >= 0.2 && kind->friction <= 1.0);
        assert_true(kind->stiffness_npm > 0.0);
        if (kind->domain != DOMAIN_FIXED)
            assert_true(kind->debris_keep == 1.0);
    }
    const struct kind *tree = &s.kinds[kind_find(s.kinds, s.kind_count, "tree")];
    const struct kind *pole = &s.kinds[kind_find(s.kinds, s.kind_count, "pole")];
    const struct kind *bush = &s.kinds[kind_find(s.kinds, s.kind_count, "bush")];
    const struct kind *tower = &s.kinds[kind_find(s.kinds, s.kind_count, "watertower")];
    const struct kind *building = &s.kinds[kind_find(s.kinds, s.kind_count, "building")];
    assert_true(bush->debris_keep == 1.0);
    assert_true(pole->debris_keep < bush->debris_keep);
    assert_true(tree->debris_keep < pole->debris_keep);
    assert_true(tower->debris_keep < tree->debris_keep);
    assert_true(building->debris_keep < tower->debris_keep);
    scenario_free(&s);
}

static const struct kind *shipped(const struct scenario *s, const char *name)
{
    return &s->kinds[kind_find(s->kinds, s->kind_count, name)];
}

/* A truck of 8.2 t has no armour in its file, a tank has. */
static void test_armour_follows_from_mass_unless_it_is_given(void **state)
{
    struct scenario s;

    (void)state;
    assert_int_equal(loader_scenario(&s, QUICK_CONFIG_SHIPPED, NULL, NULL, 0, &error), 0);
    const struct kind *truck = shipped(&s, "truck"), *tank = shipped(&s, "tank");
    const struct kind *ship = shipped(&s, "ship"), *howitzer = shipped(&s, "howitzer");
    assert_true(fabs(truck->armour_mm[ASPECT_SIDE] - 1.2 * 8.2) < 1e-9);
    assert_true(fabs(truck->armour_mm[ASPECT_FRONT] - 1.2 * 8.2) < 1e-9);
    assert_true(fabs(truck->armour_mm[ASPECT_TOP] - 0.6 * 8.2) < 1e-9);
    assert_true(tank->armour_mm[ASPECT_FRONT] == 375.0 && tank->armour_mm[ASPECT_TOP] == 30.0);
    assert_true(ship->armour_mm[ASPECT_SIDE] < 10.0);
    assert_int_equal(s.kinds[howitzer->munition].delivery, DELIVERY_ARC);
    assert_int_equal(shipped(&s, "bomb")->delivery, DELIVERY_DROP);
    scenario_free(&s);
}

static void test_refused_numbers_of_armour(void **state)
{
    static const char *const texts[] = {"armour_mm = [1, 2, 3];", "armour_mm = [1, 2, 3, -4];",
                                        "armour_mm = 5;", "penetration_mm = 100;",
                                        "delivery = \"arc\";"};
    struct scenario s;

    (void)state;
    load(&s, "");
    scenario_free(&s);
    for (size_t i = 0; i < COUNT(texts); i++) {
        char kind[512];
        snprintf(kind, sizeof(kind), "name = \"k\"; " NEEDS "\"k\"; %s", texts[i]);
        write_in("kinds", "k.cfg", kind);
        if (loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error) ==
            0)
            fail_msg("not refused: %s", texts[i]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_defaults),
        cmocka_unit_test(test_given_values),
        cmocka_unit_test(test_kinds_of_one_model_share_its_hulls),
        cmocka_unit_test(test_shipped_kinds_slide_and_leave_debris),
        cmocka_unit_test(test_armour_follows_from_mass_unless_it_is_given),
        cmocka_unit_test(test_refused_numbers_of_armour),
    };

    return cmocka_run_group_tests(tests, quick_config_make, quick_config_remove);
}
