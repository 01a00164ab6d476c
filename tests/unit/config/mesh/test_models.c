/* Models. Shipped ones are closed, turned outwards, of their kind's size, and have the parts that
 * the renderer moves. Bad ones are refused. */
#include "config/loader.h"

#include "config/mesh/models.h"
#include "tests/support/quick_config.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/model.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#define SEEN_MOST    4500 /* triangles of a model that are drawn ... */
#define SOLID_MOST   500  /* ... and that collide: rays try each of them */
#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static struct scenario shipped;
static struct error_text error;

static int load_shipped(void **state)
{
    (void)state;
    return loader_scenario(&shipped, QUICK_CONFIG_SHIPPED, "duel", NULL, 0, &error);
}

static int free_shipped(void **state)
{
    (void)state;
    scenario_free(&shipped);
    return 0;
}

static const struct model *model_of(const char *kind)
{
    uint16_t index = kind_find(shipped.kinds, shipped.kind_count, kind);

    assert_int_not_equal(index, KIND_NONE);
    return &shipped.models[shipped.kinds[index].model];
}

static const struct model_vertex *corner(const struct model *model, uint32_t triangle, int which)
{
    const struct model_triangle *t = &shipped.triangles[model->first_triangle + triangle];

    return &shipped.vertices[model->first_vertex + t->vertex[which % 3]];
}

static void test_tables_fit(void **state)
{
    uint32_t vertices = 0, triangles = 0;

    (void)state;
    for (uint32_t m = 0; m < shipped.model_count; m++) {
        const struct model *model = &shipped.models[m];

        assert_int_equal(model->first_vertex, vertices);
        assert_int_equal(model->first_triangle, triangles);
        assert_in_range(model->triangle_count - model->solid_triangles, 12, SEEN_MOST);
        assert_in_range(model_solid_triangles(model), 12, SOLID_MOST);
        for (uint32_t i = 0; i < model->triangle_count; i++) {
            const struct model_triangle *t = &shipped.triangles[triangles + i];

            assert_true(t->part < PART_COUNT && t->joint < MODEL_JOINTS_MAX);
            for (int c = 0; c < 3; c++)
                assert_true(t->vertex[c] < model->vertex_count);
        }
        vertices += model->vertex_count;
        triangles += model->triangle_count;
    }
    assert_int_equal(vertices, shipped.vertex_count);
    assert_int_equal(triangles, shipped.triangle_count);
}

/* An edge, by its two places: surfaces share places, not always vertices. */
struct edge {
    struct model_vertex from, to;
};

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(struct edge));
}

static uint32_t root_of(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
    return i;
}

/* Every edge occurs as often in one direction as in the other. */
static void check_closed(const struct model *model)
{
    size_t count = (size_t)model->triangle_count * 3;
    struct edge *forth = calloc(count, sizeof(*forth)), *back = calloc(count, sizeof(*back));

    assert_true(forth != NULL && back != NULL);
    for (uint32_t t = 0; t < model->triangle_count; t++) {
        for (int c = 0; c < 3; c++) {
            const struct model_vertex *from = corner(model, t, c), *to = corner(model, t, c + 1);

            forth[t * 3 + (uint32_t)c] = (struct edge){*from, *to};
            back[t * 3 + (uint32_t)c] = (struct edge){*to, *from};
        }
    }
    qsort(forth, count, sizeof(*forth), compare_edges);
    qsort(back, count, sizeof(*back), compare_edges);
    if (memcmp(forth, back, count * sizeof(*forth)) != 0)
        fail_msg("%s is not closed, or turned outwards here and inwards there", model->name);
    free(forth);
    free(back);
}

static double volume(const struct model *model, uint32_t t)
{
    const struct model_vertex *a = corner(model, t, 0), *b = corner(model, t, 1),
                              *c = corner(model, t, 2);
    double ax = (double)a->x, ay = (double)a->y, az = (double)a->z;
    double bx = (double)b->x, by = (double)b->y, bz = (double)b->z;
    double cx = (double)c->x, cy = (double)c->y, cz = (double)c->z;

    return (ax * (by * cz - bz * cy) - ay * (bx * cz - bz * cx) + az * (bx * cy - by * cx)) / 6;
}

static double area(const struct model *model, uint32_t t)
{
    const struct model_vertex *a = corner(model, t, 0), *b = corner(model, t, 1),
                              *c = corner(model, t, 2);
    double ux = (double)(b->x - a->x), uy = (double)(b->y - a->y), uz = (double)(b->z - a->z);
    double vx = (double)(c->x - a->x), vy = (double)(c->y - a->y), vz = (double)(c->z - a->z);
    double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;

    return sqrt(nx * nx + ny * ny + nz * nz) / 2;
}

/* The connected pieces of triangles first .. end - 1 each have a positive volume, so that none is
 * inside out. */
static void check_pieces(const struct model *model, uint32_t first, uint32_t end)
{
    uint32_t count = 3 * (end - first), *parent = calloc(count + 1, sizeof(*parent));
    struct edge *place =
        calloc(count + 1, sizeof(*place)); /* to: index of the other corner, as x and y */
    double *inside = calloc(count + 1, sizeof(*inside));

    assert_true(parent != NULL && place != NULL && inside != NULL);
    for (uint32_t i = 0; i < count; i++) {
        place[i].from = *corner(model, first + i / 3, (int)(i % 3));
        place[i].to.x = (float)i;
        parent[i] = i;
    }
    qsort(place, count, sizeof(*place), compare_edges);
    for (uint32_t i = 1; i < count; i++) {
        if (memcmp(&place[i - 1].from, &place[i].from, sizeof(place[i].from)) == 0)
            parent[root_of(parent, (uint32_t)place[i].to.x)] =
                root_of(parent, (uint32_t)place[i - 1].to.x);
    }
    for (uint32_t i = 0; i < count; i++)
        parent[root_of(parent, i)] = root_of(parent, i - i % 3);
    for (uint32_t i = 0; i < count; i += 3)
        inside[root_of(parent, i)] += volume(model, first + i / 3);
    for (uint32_t i = 0; i < count; i++) {
        if (root_of(parent, i) == i && !(inside[i] > 0.0))
            fail_msg("%s: the piece with triangle %u is turned inside out", model->name,
                     first + i / 3);
    }
    free(parent);
    free(place);
    free(inside);
}

static void test_closed_and_outwards(void **state)
{
    (void)state;
    for (uint32_t m = 0; m < shipped.model_count; m++) {
        const struct model *model = &shipped.models[m];

        check_closed(model);
        for (uint32_t t = 0; t < model->triangle_count; t++)
            assert_true(area(model, t) > 1e-9);
        check_pieces(model, 0, model->solid_triangles);
        check_pieces(model, model->solid_triangles, model->triangle_count);
    }
}

struct box {
    double low[3], high[3];
};

/* The box around the parts that collide. */
static struct box box_of(const struct model *model)
{
    uint32_t count = model->solid_triangles > 0 ? model->solid_vertices : model->vertex_count;
    struct box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};

    for (uint32_t i = 0; i < count; i++) {
        const struct model_vertex *v = &shipped.vertices[model->first_vertex + i];
        const double at[3] = {(double)v->x, (double)v->y, (double)v->z};

        for (int axis = 0; axis < 3; axis++) {
            box.low[axis] = fmin(box.low[axis], at[axis]);
            box.high[axis] = fmax(box.high[axis], at[axis]);
        }
    }
    return box;
}

/* Apart from aerials, the drawn shape is the colliding shape: nearly all of its corners are in or
 * near the colliding box, and none is far from it. */
static void test_drawn_shape_is_the_colliding_shape(void **state)
{
    (void)state;
    for (uint32_t m = 0; m < shipped.model_count; m++) {
        const struct model *model = &shipped.models[m];
        const struct box box = box_of(model);
        uint32_t out = 0, seen = 3 * (model->triangle_count - model->solid_triangles);

        for (uint32_t i = 0; i < seen; i++) {
            const struct model_vertex *v =
                corner(model, model->solid_triangles + i / 3, (int)i % 3);
            const double at[3] = {(double)v->x, (double)v->y, (double)v->z};
            double most = 0;

            for (int axis = 0; axis < 3; axis++) {
                double over = fmax(box.low[axis] - at[axis], at[axis] - box.high[axis]);

                most = fmax(most, over / fmax(box.high[axis] - box.low[axis], 1.0));
            }
            out += most > 0.04;
            if (most > 0.5)
                fail_msg("%s: (%g, %g, %g) is far from what collides", model->name, at[0], at[1],
                         at[2]);
        }
        if (out > seen / 8)
            fail_msg("%s: %u of %u corners are out of what collides", model->name, out, seen);
    }
}

/* Guns and aerials may stick out of a body; no part is much smaller than its kind says. */
static void test_sizes_are_the_kinds(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct kind *kind = &shipped.kinds[k];
        const struct box box = box_of(&shipped.models[kind->model]);
        const double says[3] = {kind->length_m, kind->height_m, kind->width_m};

        for (int axis = 0; axis < 3; axis++) {
            double is = box.high[axis] - box.low[axis];

            if (!(is > 0.75 * says[axis] - 0.1 && is < 1.3 * says[axis] + 0.1))
                fail_msg("%s: its model's axis %d is %.2f m long, the kind says %.2f m", kind->name,
                         axis, is, says[axis]);
        }
        if (kind->domain == DOMAIN_LAND && fabs(box.low[1]) > 0.02)
            fail_msg("%s: does not stand on the ground but at %.2f m", kind->name, box.low[1]);
        if (kind->domain == DOMAIN_FIXED && (box.low[1] > 0 || box.low[1] < -1))
            fail_msg("%s: has its foot at %.2f m", kind->name, box.low[1]);
        if (kind->domain == DOMAIN_SEA)
            assert_true(box.low[1] < -0.5 && box.high[1] > 2);
        if (kind->domain == DOMAIN_AIR || kind->domain == DOMAIN_MUNITION)
            assert_true(box.low[1] < 0 && box.high[1] > 0);
    }
}

static uint32_t count_part(const struct model *model, enum model_part part)
{
    uint32_t count = 0;

    for (uint32_t t = 0; t < model->triangle_count; t++)
        count += shipped.triangles[model->first_triangle + t].part == part;
    return count;
}

static int count_joints(const struct model *model, enum model_part part)
{
    bool has[MODEL_JOINTS_MAX] = {false};
    int count = 0;

    for (uint32_t t = 0; t < model->triangle_count; t++) {
        const struct model_triangle *triangle = &shipped.triangles[model->first_triangle + t];

        count += triangle->part == part && !has[triangle->joint];
        if (triangle->part == part)
            has[triangle->joint] = true;
    }
    return count;
}

static void test_parts(void **state)
{
    static const struct {
        const char *kind;
        bool turret, gun, rotors, tracks;
        int wheels; /* number of joints */
    } rows[] = {
        {"tank", true, true, false, true, 14},      {"carrier", true, true, false, true, 14},
        {"ship", true, true, false, false, 0},      {"helicopter", false, true, true, false, 0},
        {"helo-cow", false, false, true, false, 0}, {"jeep", true, true, false, false, 4},
        {"truck", false, false, false, false, 6},   {"jet", false, false, false, false, 0},
        {"tree", false, false, false, false, 0}};

    (void)state;
    for (size_t i = 0; i < COUNT(rows); i++) {
        const struct model *model = model_of(rows[i].kind);

        assert_true(count_part(model, PART_BODY) > 0);
        assert_int_equal(count_part(model, PART_TURRET) > 0, rows[i].turret);
        assert_int_equal(count_part(model, PART_ROTOR) > 0, rows[i].rotors);
        assert_int_equal(count_part(model, PART_TAIL_ROTOR) > 0, rows[i].rotors);
        assert_int_equal(count_part(model, PART_GUN) > 0, rows[i].gun);
        assert_int_equal(count_part(model, PART_TRACK) > 0, rows[i].tracks);
        assert_int_equal(count_joints(model, PART_WHEEL) + count_joints(model, PART_FRONT_WHEEL),
                         rows[i].wheels);
    }
}

static void test_forces_have_different_colours(void **state)
{
    (void)state;
    for (uint32_t k = 0; k < shipped.kind_count; k++) {
        const struct model *model = &shipped.models[shipped.kinds[k].model];
        uint32_t tinted = 0;

        for (uint32_t t = 0; t < model->triangle_count; t++)
            tinted += shipped.triangles[model->first_triangle + t].force_tint == MODEL_TINT_FORCE;
        assert_int_equal(tinted > 0, shipped.kinds[k].domain <= DOMAIN_AIR);
    }
}

static void test_colours_are_of_the_palette(void **state)
{
    const struct model *model = model_of("attack-tomato");
    uint32_t red = 0;

    (void)state;
    for (uint32_t t = 0; t < model->triangle_count; t++) {
        const struct model_triangle *triangle = &shipped.triangles[model->first_triangle + t];

        red += triangle->red == 199 && triangle->green == 33 && triangle->blue == 23;
    }
    assert_true(red > 50);
}

/* --- bad models --------------------------------------------------------------------------------*/

#define TOP       "mtllib k.mtl\n"
#define TRIANGLE  "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
#define MATERIALS "newmtl red\nKd 1 0 0\nnewmtl plain\nKa 1 0 0\n"

static const struct {
    const char *text; /* NULL: the file is missing */
    const char *says;
} bad[] = {
    {NULL, "k.obj: cannot be opened: No such file or directory"},
    {"", "k.obj: has no faces; right would be: f 1 2 3"},
    {"nonsense\n", "k.obj:1: nonsense: is not supported in a model; "},
    {TOP "o body\n" TRIANGLE "f 1 2 3\n", "k.obj:6: f: has no material; right would be: usemtl "},
    {TOP "o body\n" TRIANGLE "usemtl blue\nf 1 2 3\n",
     "k.obj:6: usemtl = blue: unknown material; "},
    {"o body\n" TRIANGLE "usemtl red\nf 1 2 3\n", "k.obj:5: usemtl = red: unknown material; "},
    {TOP "o body\n" TRIANGLE "usemtl plain\nf 1 2 3\n",
     "k.obj:6: usemtl = plain: unknown material; "},
    {"mtllib none.mtl\no body\n" TRIANGLE "usemtl red\nf 1 2 3\n",
     "none.mtl: cannot be opened: No such file or directory"},
    {"mtllib ../../../../etc/passwd\no body\n" TRIANGLE "usemtl red\nf 1 2 3\n",
     "k.obj:1: mtllib = ../../../../etc/passwd: is not a name; allowed: 1..63 of a-z A-Z 0-9"},
    {"mtllib /etc/passwd\n", "k.obj:1: mtllib = /etc/passwd: is not a name; "},
    {"mtllib ..\n", "k.obj:1: mtllib = ..: is not a file's name; "},
    {"mtllib link.mtl\n", "link.mtl: is a symbolic link; allowed: a regular file"},
    {"mtllib bright.mtl\n", "bright.mtl:2: Kd = 2: out of range; allowed: 0..1"},
    {"mtllib twice.mtl\n", "twice.mtl:3: newmtl = red: is another material's name too; "},
    {"mtllib image.mtl\n", "image.mtl:2: map_Kd: is not supported in a model; "},
    {TOP TOP, "k.obj:2: mtllib: stands twice; allowed: once"},
    {TOP "o body left\n", "k.obj:2: o: needs one name; "},
    {TOP "o wing\n" TRIANGLE "usemtl red\nf 1 2 3\n",
     "k.obj: object wing: unknown part; allowed: body, turret, gun, rotor, tail_rotor, "},
    {TOP "o wheel_x\n" TRIANGLE "usemtl red\nf 1 2 3\n", "k.obj: object wheel_x: unknown part; "},
    {TOP "o _1\n" TRIANGLE "usemtl red\nf 1 2 3\n", "k.obj: object _1: unknown part; "},
    {TOP "o solid\n" TRIANGLE "usemtl red\nf 1 2 3\n", "k.obj: has no triangles"},
    {TOP TRIANGLE "usemtl red\nf 1 2 3\n", "k.obj:6: f: is of no object; right would be: o NAME "},
    {TOP "o body\nv 0 0 0\nv 1001 0 0\n", "k.obj:4: v = 1001: out of range; allowed: -1000..1000"},
    {TOP "v nan 0 0\n", "k.obj:2: v = nan: is not a number; "},
    {TOP "v .5 0 0\n", "k.obj:2: v = .5: is not a number; "},
    {TOP "v 0x1 0 0\n", "k.obj:2: v = 0x1: is not a number; "},
    {TOP "v 1e39 0 0\n", "k.obj:2: v = 1e39: out of range; allowed: -1000..1000"},
    {TOP " v 0 0 0\n", "k.obj:2: v: is indented; "},
    {TOP "v 0 0\n", "k.obj:2: v: has 2 numbers; allowed: 3..3"},
    {TOP "v 0 0 0 \\\n", "k.obj:2: has a byte 0x5c; "},
    {TOP "v 0 0\r0\n", "k.obj:2: has a byte 0x0d; "},
    {TOP "o b\xc3\xb6rdy\n", "k.obj:2: has a byte 0xc3; "},
    {TOP TRIANGLE "usemtl red\nf 1 2 7\n", "k.obj:6: f = 7: is not a corner; allowed: 1..3, "},
    {TOP TRIANGLE "usemtl red\nf 1 2 0\n", "k.obj:6: f = 0: is not a corner; "},
    {TOP TRIANGLE "usemtl red\nf 1 2 -1\n", "k.obj:6: f = -1: is not a corner; "},
    {TOP TRIANGLE "usemtl red\nf 1/1 2/1 3/1\n", "k.obj:6: f = 1/1: is not a corner; "},
    {TOP TRIANGLE "usemtl red\nf 1// 2 3\n", "k.obj:6: f = 1//: is not a corner; "},
    {TOP TRIANGLE "usemtl red\nf 1 2\n", "k.obj:6: f: has 2 corners; allowed: 3..64"},
};

static void put_model(const char *name, const char *text)
{
    char path[128];

    snprintf(path, sizeof(path), "%s/models/%s", quick_config.folder, name);
    quick_config_write(path, text);
}

static void test_refusals(void **state)
{
    static const char kind[] =
        "name = \"k\"; model = \"k\"; domain = \"fixed\"; class = \"tree\"; mass_kg = 1; radius_m "
        "= 1; resistance_j = 1; length_m = 1; width_m = 1; height_m = 1;\n";
    char path[128], begin[256];

    (void)state;
    snprintf(path, sizeof(path), "%s/kinds", quick_config.folder);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof(path), "%s/models", quick_config.folder);
    assert_int_equal(mkdir(path, 0700), 0);
    snprintf(path, sizeof(path), "%s/kinds/k.cfg", quick_config.folder);
    quick_config_write(path, kind);
    snprintf(begin, sizeof(begin), "%s:1: model = k: %s/models/", path, quick_config.folder);
    snprintf(path, sizeof(path), "%s/models/k.mtl", quick_config.folder);
    quick_config_write(path, MATERIALS);
    put_model("bright.mtl", "newmtl bright\nKd 2 0 0\n");
    put_model("twice.mtl", "newmtl red\nKd 1 0 0\nnewmtl red\n");
    put_model("image.mtl", "newmtl red\nmap_Kd /etc/passwd\n");
    snprintf(path, sizeof(path), "%s/models/link.mtl", quick_config.folder);
    assert_int_equal(symlink("k.mtl", path), 0);
    quick_config_write(quick_config.scenario_path, "");
    snprintf(path, sizeof(path), "%s/models/k.obj", quick_config.folder);
    for (size_t i = 0; i < COUNT(bad); i++) {
        struct scenario s;
        char want[sizeof(error.text)];

        if (bad[i].text != NULL)
            quick_config_write(path, bad[i].text);
        snprintf(want, sizeof(want), "%s%s", begin, bad[i].says);
        if (loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error) ==
            0)
            fail_msg("accepted: %s", bad[i].text);
        if (strncmp(error.text, want, strlen(want)) != 0)
            fail_msg("refused as\n  %s\ninstead of\n  %s", error.text, want);
    }
}

static void test_square_is_two_triangles(void **state)
{
    struct scenario s;
    char path[128];

    (void)state;
    snprintf(path, sizeof(path), "%s/models/k.obj", quick_config.folder);
    quick_config_write(path, TOP "o body\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl red\n"
                                 "f 1 2 3 4\n");
    assert_int_equal(
        loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error), 0);
    assert_int_equal(s.model_count, 1);
    assert_int_equal(s.triangle_count, 2);
    assert_int_equal(s.vertex_count, 4);
    assert_int_equal(s.triangles[0].red, 255);
    scenario_free(&s);
}

/* Lines that modelling programs write, beside the ones that are needed. */
static void test_whole_grammar_is_accepted(void **state)
{
    struct scenario s;

    (void)state;
    put_model("all.mtl", "# Erd\xc3\xa4hnlich\r\nnewmtl red\r\nNs 250.0\r\nKa 1 1 1\r\nKd 1 0 0\r\n"
                         "Ks 0.5 0.5 0.5\r\nKe 0 0 0\r\nNi 1.45\r\nd 1.0\r\nillum 2\r\n");
    put_model("k.obj", "# C: \"drawn\"\r\nmtllib all.mtl\r\n\r\no body\r\nv\t0 0 0\r\nv 1 0 0\r\n"
                       "v 0 1e0 0\r\nv 0.5 -1 +0.25e-00\r\nvt 0 0\r\nvt 1 0 0\r\nvn 0 0 1\r\n"
                       "s off\r\nusemtl red\r\nf 1 2 3\r\nf 1/1 2/2 3/1\r\nf 1//1 2//1 4//1\r\n"
                       "g body\r\nf 1/1/1 2/2/1 4/1/1");
    if (loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error) != 0)
        fail_msg("%s", error.text);
    assert_int_equal(s.triangle_count, 4);
    scenario_free(&s);
}

/* An object may be begun again: its faces move together. */
static void test_faces_of_a_name_are_one_object(void **state)
{
    struct scenario s;

    (void)state;
    put_model("k.obj",
              TOP "o wheel_1\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\n"
                  "o body\nf 1 2 3\nf 1 3 2\nf 1 4 2\no wheel_1\nf 3 2 1\no wheel_2\nf 3 2 1\n");
    if (loader_scenario(&s, quick_config.folder, quick_config.scenario_path, NULL, 0, &error) != 0)
        fail_msg("%s", error.text);
    assert_int_equal(s.triangle_count, 6);
    assert_int_equal(s.triangles[0].joint, s.triangles[1].joint);
    assert_int_equal(s.triangles[1].part, PART_WHEEL);
    assert_int_equal(s.triangles[2].part, PART_BODY);
    assert_int_not_equal(s.triangles[5].joint, s.triangles[0].joint);
    scenario_free(&s);
}

int main(void)
{
    const struct CMUnitTest shipped_tests[] = {
        cmocka_unit_test(test_tables_fit),
        cmocka_unit_test(test_closed_and_outwards),
        cmocka_unit_test(test_drawn_shape_is_the_colliding_shape),
        cmocka_unit_test(test_sizes_are_the_kinds),
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_forces_have_different_colours),
        cmocka_unit_test(test_colours_are_of_the_palette),
    };
    const struct CMUnitTest bad_tests[] = {
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_square_is_two_triangles),
        cmocka_unit_test(test_whole_grammar_is_accepted),
        cmocka_unit_test(test_faces_of_a_name_are_one_object),
    };

    return cmocka_run_group_tests(shipped_tests, load_shipped, free_shipped) +
           cmocka_run_group_tests(bad_tests, quick_config_make, quick_config_remove);
}
