/* Draws what stands on a ground. */
#include "supervisor/ground/picture_features.h"

#include "ipc/process/log.h"

#include <stdlib.h>
#include <string.h>

#define ROAD_WIDTH_M    7.0
#define ROAD_PIXELS     1.2
#define WALL_STEP_M     2.0  /* walls have an edge where pixels are smaller */
#define PLANT_STEP_M    8.0  /* plants and poles are drawn where pixels are smaller */
#define BUILDING_PIXELS 0.75 /* half the width of the least dot for a building */
#define M_OF_MM         0.001

static const struct canvas_colour road_edge = {95, 88, 80}, road_middle = {245, 236, 205},
                                  building = {150, 62, 48}, wall = {70, 26, 22};

/* Radius [m], least radius in pixels and colour of enum ground_object_type. */
static const struct {
    double radius_m, least;
    struct canvas_colour colour;
} looks[GROUND_OBJECT_TYPES] = {
    [GROUND_TREE] = {3.0, 0.0, {44, 84, 36}},        [GROUND_PINE] = {2.5, 0.0, {30, 70, 44}},
    [GROUND_BUSH] = {1.0, 0.0, {96, 112, 52}},       [GROUND_POLE] = {0.3, 1.0, {40, 40, 48}},
    [GROUND_WATERTOWER] = {4.0, 2.0, {40, 70, 120}},
};

static void *allocate(const struct ground_file *file, size_t count, size_t size)
{
    void *memory = calloc(count + 1, size);
    if (!memory)
        die_refused("%s: no memory for what stands on it", file->path);
    return memory;
}

static void place_of(double at[2], int32_t x_mm, int32_t z_mm)
{
    at[0] = x_mm * M_OF_MM;
    at[1] = z_mm * M_OF_MM;
}

static void draw_stretches(const struct canvas *canvas, const struct ground_road_point *points,
                           uint32_t count, double width_m, double least,
                           struct canvas_colour colour)
{
    for (uint32_t i = 0; i + 1 < count; i++) {
        double from[2], to[2];
        if (points[i].road != points[i + 1].road)
            continue;
        place_of(from, points[i].x_mm, points[i].z_mm);
        place_of(to, points[i + 1].x_mm, points[i + 1].z_mm);
        canvas_line(canvas, from, to, width_m, least, colour);
    }
}

static void draw_roads(const struct canvas *canvas, const struct ground_file *file)
{
    struct error_text error;
    struct ground_road_point *points = allocate(file, file->road_points, sizeof *points);
    if (ground_file_roads(file, points, &error) != 0)
        die_refused("%s", error.text);
    double edge_m = 2.0 * canvas->step_m;
    draw_stretches(canvas, points, file->road_points, ROAD_WIDTH_M + edge_m, ROAD_PIXELS + 1.5,
                   road_edge);
    draw_stretches(canvas, points, file->road_points, ROAD_WIDTH_M, ROAD_PIXELS, road_middle);
    free(points);
}

static void draw_objects(const struct canvas *canvas, const struct ground_file *file)
{
    struct error_text error;
    struct ground_object *objects = allocate(file, file->objects, sizeof *objects);
    if (ground_file_objects(file, objects, &error) != 0)
        die_refused("%s", error.text);
    for (uint32_t i = 0; i < file->objects; i++) {
        const struct ground_object *object = &objects[i];
        double at[2];
        if (object->type != GROUND_WATERTOWER && canvas->step_m > PLANT_STEP_M)
            continue;
        place_of(at, object->x_mm, object->z_mm);
        canvas_disc(canvas, at, looks[object->type].radius_m * object->size_percent / 100.0,
                    looks[object->type].least, looks[object->type].colour);
    }
    free(objects);
}

/* Draws a part: its outline, or a dot in a picture where it would be lost between the pixels. */
static void draw_part(const struct canvas *canvas, const struct ground_building *whole,
                      const struct ground_corner *corner, uint32_t count)
{
    double place[GROUND_PART_CORNERS_MAX][2], middle[2];
    for (uint32_t i = 0; i < count; i++)
        place_of(place[i], whole->x_mm + corner[i].x_mm, whole->z_mm + corner[i].z_mm);
    canvas_polygon(canvas, (const double(*)[2])place, count, building);
    for (uint32_t i = 0; canvas->step_m <= WALL_STEP_M && i < count; i++)
        canvas_line(canvas, place[i], place[(i + 1) % count], 0.0, 1.0, wall);
    place_of(middle, whole->x_mm, whole->z_mm);
    if (canvas->step_m > PLANT_STEP_M)
        canvas_disc(canvas, middle, 0.0, BUILDING_PIXELS, building);
}

static void draw_buildings(const struct canvas *canvas, const struct ground_file *file)
{
    struct error_text error;
    struct ground_building *buildings = allocate(file, file->buildings, sizeof *buildings);
    struct ground_corner *corners = allocate(file, file->corners, sizeof *corners);
    uint32_t at = 0, part = 0;
    if (ground_file_buildings(file, buildings, corners, &error) != 0)
        die_refused("%s", error.text);
    for (uint32_t i = 0; i < file->buildings; i++) {
        for (uint32_t last = part + buildings[i].parts; part < last; part++) {
            uint32_t first = at;
            while (at < file->corners && corners[at].part == part)
                at++;
            draw_part(canvas, &buildings[i], &corners[first], at - first);
        }
    }
    free(buildings);
    free(corners);
}

void picture_features_draw(const struct canvas *canvas, const struct ground_file *file)
{
    if (file->road_points)
        draw_roads(canvas, file);
    if (file->objects)
        draw_objects(canvas, file);
    if (file->buildings)
        draw_buildings(canvas, file);
}
