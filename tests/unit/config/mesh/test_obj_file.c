/* Reads OBJ files. Faces of any plain polygon are cut into triangles that cover it once; corners at
 * one place are one vertex; faces of one object and one material are a mesh. What is refused is in
 * test_models.c. */
#include "config/mesh/obj_file.h"

#include "world/maths/maths.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define MATERIALS "newmtl red\nKd 1 0.5 0\nnewmtl blue\nKd 0 0 1\n"
#define TEXT_MOST 8192

static struct source model, materials;
static struct obj_file file;
static struct error_text error;

static const struct source *open_materials(void *context, const char *name, struct error_text *text)
{
    (void)context, (void)name, (void)text;
    return &materials;
}

static void set_text(struct source *source, const char *path, char *text)
{
    snprintf(source->path, sizeof source->path, "%s", path);
    source->text = text;
    source->bytes = strlen(text);
}

/* Reads a model with these lines after its head. */
static void read_lines(const char *lines)
{
    static char text[TEXT_MOST], library[] = MATERIALS;
    snprintf(text, sizeof text, "mtllib k.mtl\n%s", lines);
    set_text(&model, "k.obj", text);
    set_text(&materials, "k.mtl", library);
    if (obj_file_read(&file, &model, open_materials, NULL, &error) != 0)
        fail_msg("%s", error.text);
}

static struct vec3 place(uint32_t triangle, int corner)
{
    const struct model_vertex *v = &file.vertex[file.triangle[triangle].corner[corner]];
    return (struct vec3){(double)v->x, (double)v->y, (double)v->z};
}

static struct vec3 area_of(uint32_t triangle)
{
    return vec3_scale(vec3_cross(vec3_sub(place(triangle, 1), place(triangle, 0)),
                                 vec3_sub(place(triangle, 2), place(triangle, 0))),
                      0.5);
}

/* Polygons of a plane are covered once if all triangles are turned alike and their areas sum up to
 * its own. */
static void check_covers(uint32_t corners, double area, struct vec3 normal)
{
    double sum = 0.0;
    assert_int_equal(file.triangles, corners - 2);
    for (uint32_t t = 0; t < file.triangles; t++) {
        const double covers = vec3_dot(area_of(t), normal);
        if (covers < -1e-9)
            fail_msg("triangle %u of %u is turned over", t, file.triangles);
        sum += covers;
    }
    if (fabs(sum - area) > 1e-4 * area)
        fail_msg("%u corners: %g m2 are covered of %g", corners, sum, area);
}

static void test_a_concave_face_is_covered_once(void **state)
{
    (void)state;
    read_lines("o body\nusemtl red\nv 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\n"
               "f 1 2 3 4 5 6\nf 4 5 6 1 2 3\n");
    assert_int_equal(file.triangles, 8);
    file.triangles = 4; /* each face alone */
    check_covers(6, 3.0, (struct vec3){0.0, 0.0, 1.0});
    memmove(file.triangle, file.triangle + 4, 4 * sizeof *file.triangle);
    check_covers(6, 3.0, (struct vec3){0.0, 0.0, 1.0});
    obj_file_free(&file);
}

/* A polygon around a point, in a plane of two directions at right angles. */
static double put_star(char *text, size_t room, uint32_t corners, struct vec3 right, struct vec3 up)
{
    double area = 0.0, before_m = 0.0, first_m = 0.0;
    size_t at = (size_t)snprintf(text, room, "o body\nusemtl red\n");
    const double turn_rad = TWO_PI / (double)corners;
    for (uint32_t i = 0; i < corners; i++) {
        const double far_m = 1.0 + 9.0 * (double)(rand() % 1000) / 1000.0;
        double sine, cosine;
        maths_sincos(turn_rad * (double)i, &sine, &cosine);
        const struct vec3 p =
            vec3_add(vec3_scale(right, far_m * cosine), vec3_scale(up, far_m * sine));
        at += (size_t)snprintf(text + at, room - at, "v %.9f %.9f %.9f\n", p.x, p.y, p.z);
        area += i > 0 ? 0.5 * before_m * far_m * maths_sin(turn_rad) : 0.0;
        before_m = far_m;
        first_m = i > 0 ? first_m : far_m;
    }
    at += (size_t)snprintf(text + at, room - at, "f");
    for (uint32_t i = 1; i <= corners; i++)
        at += (size_t)snprintf(text + at, room - at, " %u", i);
    snprintf(text + at, room - at, "\n");
    return area + 0.5 * before_m * first_m * maths_sin(turn_rad);
}

static void test_stars_are_covered_once(void **state)
{
    char text[TEXT_MOST - 64];
    (void)state;
    srand(1991);
    for (uint32_t n = 0; n < 600; n++) {
        const uint32_t corners = 4 + n % (OBJ_FILE_CORNERS_MAX - 3);
        const struct vec3 right = {0.6, 0.0, 0.8};
        const struct vec3 up = n % 2 ? (struct vec3){0.0, 1.0, 0.0} : (struct vec3){0.8, 0.0, -0.6};
        const double area = put_star(text, sizeof text, corners, right, up);
        read_lines(text);
        check_covers(corners, area, vec3_cross(right, up));
        obj_file_free(&file);
    }
}

/* Faces without a plane, area or order still have their number of triangles. */
static void test_no_plain_polygon_is_cut_too(void **state)
{
    static const char *const faces[] = {"f 1 1 1 1 1\n", "f 1 3 2 4 1\n", "f 1 2 1 2 1\n",
                                        "f 1 2 5 3 4\n", "f 4 3 2 1 5\n"};
    char text[TEXT_MOST - 64];
    (void)state;
    for (size_t i = 0; i < sizeof faces / sizeof faces[0]; i++) {
        snprintf(text, sizeof text,
                 "o body\nusemtl red\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 5 5\n%s", faces[i]);
        read_lines(text);
        assert_int_equal(file.triangles, 3);
        obj_file_free(&file);
    }
}

/* No file has more triangles for its size. */
static void test_there_is_room_for_the_shortest_faces(void **state)
{
    char text[TEXT_MOST - 64];
    size_t at = (size_t)snprintf(text, sizeof text, "o b\nusemtl red\nv 0 0 0\n");
    uint32_t faces = 0;
    (void)state;
    while (at + 2 * OBJ_FILE_CORNERS_MAX + 3 < sizeof text) {
        text[at++] = 'f';
        for (uint32_t i = 0; i < OBJ_FILE_CORNERS_MAX; i++, at += 2)
            memcpy(text + at, " 1", 2);
        text[at++] = '\n';
        faces++;
    }
    text[at] = '\0';
    read_lines(text);
    assert_int_equal(file.triangles, faces * (OBJ_FILE_CORNERS_MAX - 2));
    obj_file_free(&file);
}

static void test_corners_at_one_place_are_one_vertex(void **state)
{
    (void)state;
    read_lines("o body\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1.0 0 -0\nv 0 1e0 0\nv 1 1 0\n"
               "f 1 2 3\nf 4 6 5\n");
    assert_int_equal(file.triangle[1].corner[0], file.triangle[0].corner[1]);
    assert_int_equal(file.triangle[1].corner[2], file.triangle[0].corner[2]);
    assert_int_equal(file.triangle[1].corner[1], 5);
    obj_file_free(&file);
}

static void test_meshes_are_of_one_object_and_material(void **state)
{
    static const struct {
        const char *object, *material;
        uint32_t first, count;
    } meshes[] = {{"body", "red", 0, 2}, {"body", "blue", 2, 1}, {"gun", "blue", 3, 1}};
    (void)state;
    read_lines("o tank\no body\nusemtl blue\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
               "f 1 2 3\nf 3 2 1\nusemtl blue\nf 1 2 3\ng gun\nf 1 2 3\n");
    assert_int_equal(file.meshes, 3);
    for (uint32_t m = 0; m < file.meshes; m++) {
        assert_string_equal(file.mesh[m].object, meshes[m].object);
        assert_string_equal(file.material[file.mesh[m].material].name, meshes[m].material);
        assert_int_equal(file.mesh[m].first, meshes[m].first);
        assert_int_equal(file.mesh[m].count, meshes[m].count);
    }
    assert_true(file.material[0].kd[1] == 0.5);
    obj_file_free(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_concave_face_is_covered_once),
        cmocka_unit_test(test_stars_are_covered_once),
        cmocka_unit_test(test_no_plain_polygon_is_cut_too),
        cmocka_unit_test(test_there_is_room_for_the_shortest_faces),
        cmocka_unit_test(test_corners_at_one_place_are_one_vertex),
        cmocka_unit_test(test_meshes_are_of_one_object_and_material),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
