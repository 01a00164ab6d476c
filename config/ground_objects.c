/* Fixed objects of a ground file. */
#include "config/ground_objects.h"

#include "config/ground_source.h"
#include "config/kinds.h"
#include "config/mesh/outline_model.h"
#include "world/entity/kind.h"
#include "world/making/scenario.h"
#include "world/making/scenario_settings.h"
#include "world/maths/maths.h"
#include "world/model.h"
#include "world/terrain/ground_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* A larger ground has buildings without windows, which would take up more memory than all else. */
#define WINDOWS_BUILDINGS 20000u

_Static_assert(GROUND_PART_CORNERS_MAX == OUTLINE_CORNERS_MAX &&
                   GROUND_BUILDING_PARTS_MAX == HULLS_A_MODEL,
               "a building of a file is an outline");
_Static_assert(KIND_COUNT_MAX + GROUND_BUILDINGS_MAX <= KIND_ALL_MAX && KIND_ALL_MAX < KIND_NONE,
               "each building is a kind");

struct objects {
    struct scenario *scenario;
    struct ground_file file;
    struct ground_object *object;
    struct ground_building *building;
    struct ground_corner *corner;
    uint16_t kind[GROUND_OBJECT_TYPES], building_kind;
    double offset_m; /* of the file's square in the world's */
    struct key_place place;
    struct error_text *error;
};

static int refuse(const struct objects *o, const char *what)
{
    return key_table_refuse(o->error, o->place, GROUND_SOURCE_KEY,
                            o->scenario->settings->ground_file, "%s", what);
}

static int find_kind(const struct objects *o, const char *name, uint16_t *found)
{
    const struct scenario *scenario = o->scenario;
    *found = kind_find(scenario->kinds, scenario->kind_count, name);
    if (*found != KIND_NONE && scenario->kinds[*found].domain == DOMAIN_FIXED)
        return 0;
    return key_table_refuse(o->error, o->place, GROUND_SOURCE_KEY, name,
                            "is a kind of fixed objects that the file has and config/kinds has "
                            "not; allowed: objects.source = \"none\"");
}

static int find_kinds(struct objects *o)
{
    static const char *const names[GROUND_OBJECT_TYPES] = {"tree", "pine", "bush", "pole",
                                                           "watertower"};
    bool wanted[GROUND_OBJECT_TYPES] = {false};
    for (uint32_t i = 0; i < o->file.objects; i++)
        wanted[o->object[i].type] = true;
    for (int i = 0; i < GROUND_OBJECT_TYPES; i++) {
        if (wanted[i] && find_kind(o, names[i], &o->kind[i]) != 0)
            return -1;
    }
    return o->file.buildings > 0 ? find_kind(o, "building", &o->building_kind) : 0;
}

static int open_file(struct objects *o)
{
    const struct scenario_settings *settings = o->scenario->settings;
    struct error_text reason;
    if (ground_file_open(&o->file, settings->ground_file, &reason) != 0)
        return refuse(o, reason.text);
    if (o->file.header.hash != settings->ground_hash)
        return refuse(o, "has changed while the scenario was read");
    uint32_t posts_side;
    if (!ground_file_fits_world(&o->file.header, o->scenario->settings->side_m, &o->offset_m,
                                &posts_side))
        return refuse(o, "has a square that no world has");
    o->object = calloc(o->file.objects + 1, sizeof(*o->object));
    o->building = calloc(o->file.buildings + 1, sizeof(*o->building));
    o->corner = calloc(o->file.corners + 1, sizeof(*o->corner));
    if (o->object == NULL || o->building == NULL || o->corner == NULL)
        return refuse(o, "has more objects than there is memory for");
    if (ground_file_objects(&o->file, o->object, &reason) != 0 ||
        ground_file_buildings(&o->file, o->building, o->corner, &reason) != 0)
        return refuse(o, reason.text);
    return 0;
}

/* Makes room for all kinds and entries. */
static int extend(struct objects *o)
{
    struct scenario *scenario = o->scenario;
    size_t kinds = scenario->kind_count + o->file.buildings;
    size_t entries = o->file.objects + o->file.buildings;
    struct kind *more = realloc(scenario->kinds, (kinds + 1) * sizeof(*more));
    if (more == NULL)
        return refuse(o, "has more buildings than there is memory for");
    scenario->kinds = more;
    struct scenario_object *list = realloc(scenario->object_list, (entries + 1) * sizeof(*list));
    if (list == NULL)
        return refuse(o, "has more objects than there is memory for");
    scenario->object_list = list;
    scenario->object_count = 0;
    return 0;
}

/* Turns the corners of a building into its body axes. */
static const struct ground_corner *read_outline(const struct ground_building *b,
                                                const struct ground_corner *corner,
                                                struct outline *outline)
{
    double sine, cosine;
    maths_sincos((double)b->turn * (TWO_PI / 65536.0), &sine, &cosine);
    outline->parts = b->parts;
    outline->foot_m = b->foot_mm / 1000.0;
    outline->eaves_m = b->eaves_mm / 1000.0;
    outline->top_m = b->top_mm / 1000.0;
    for (uint32_t p = 0; p < outline->parts; p++) {
        struct outline_part *part = &outline->part[p];
        uint32_t number = corner->part;
        for (part->corners = 0; corner->part == number; corner++, part->corners++) {
            double x = corner->x_mm / 1000.0, z = corner->z_mm / 1000.0;
            part->x[part->corners] = x * sine - z * cosine;
            part->z[part->corners] = x * cosine + z * sine;
        }
    }
    return corner;
}

static double area_of(const struct outline *outline)
{
    double area = 0.0;
    for (uint32_t p = 0; p < outline->parts; p++) {
        const struct outline_part *part = &outline->part[p];
        for (uint32_t i = 0; i < part->corners; i++) {
            uint32_t next = (i + 1) % part->corners;
            area += 0.5 * (part->x[i] * part->z[next] - part->z[i] * part->x[next]);
        }
    }
    return fabs(area);
}

/* Sets what differs from the kind "building". */
static void set_sizes(struct kind *kind, const struct outline *outline)
{
    double whole = kind->length_m * kind->width_m * kind->height_m, half[2] = {0.0, 0.0};
    double ratio = area_of(outline) * outline->eaves_m / whole;
    ratio = maths_clamp(ratio, 1.0 / GROUND_OBJECTS_RATIO, GROUND_OBJECTS_RATIO);
    for (uint32_t p = 0; p < outline->parts; p++) {
        for (uint32_t i = 0; i < outline->part[p].corners; i++) {
            half[0] = maths_max(half[0], fabs(outline->part[p].x[i]));
            half[1] = maths_max(half[1], fabs(outline->part[p].z[i]));
        }
    }
    kind->outline = 1;
    kind->length_m = 2.0 * half[0];
    kind->width_m = 2.0 * half[1];
    kind->height_m = outline->top_m;
    kind->mass_kg *= ratio;
    kind->resistance_j *= ratio;
    kind->stiffness_npm = kinds_stiffness(kind);
}

static int add_building(struct objects *o, const struct ground_building *b,
                        const struct ground_corner **corner, struct outline *outline)
{
    struct scenario *scenario = o->scenario;
    struct kind *kind = &scenario->kinds[scenario->kind_count];
    struct hulls hulls;
    *corner = read_outline(b, *corner, outline);
    *kind = scenario->kinds[o->building_kind];
    kind->model = (uint16_t)scenario->model_count;
    set_sizes(kind, outline);
    if (outline_model_add(scenario, outline, kind->name, o->file.buildings <= WINDOWS_BUILDINGS) !=
            0 ||
        outline_model_hulls(&hulls, scenario, outline) != 0)
        return refuse(o, errno == ENOMEM ? "has more buildings than there is memory for"
                                         : "has a building that takes up no space");
    kinds_take_hulls(kind, scenario, &hulls);
    kind->radius_m = kind->level_m;
    scenario->object_list[scenario->object_count++] =
        (struct scenario_object){.kind = (uint16_t)scenario->kind_count++,
                                 .turn = b->turn,
                                 .size = 1.0f,
                                 .x = b->x_mm / 1000.0 + o->offset_m,
                                 .z = b->z_mm / 1000.0 + o->offset_m};
    return 0;
}

static int add_all(struct objects *o)
{
    struct scenario *scenario = o->scenario;
    const struct ground_corner *corner = o->corner;
    struct outline *outline = malloc(sizeof(*outline));
    int result = 0;
    if (outline == NULL)
        return refuse(o, "has more objects than there is memory for");
    /* The corner behind the last is of no part. */
    o->corner[o->file.corners].part = UINT32_MAX;
    for (uint32_t i = 0; i < o->file.buildings && result == 0; i++)
        result = add_building(o, &o->building[i], &corner, outline);
    for (uint32_t i = 0; i < o->file.objects && result == 0; i++) {
        const struct ground_object *from = &o->object[i];
        scenario->object_list[scenario->object_count++] =
            (struct scenario_object){.kind = o->kind[from->type],
                                     .turn = from->turn,
                                     .size = (float)(from->size_percent / 100.0),
                                     .x = from->x_mm / 1000.0 + o->offset_m,
                                     .z = from->z_mm / 1000.0 + o->offset_m};
    }
    free(outline);
    return result;
}

int ground_objects_read(struct scenario *scenario, struct key_place place, struct error_text *error)
{
    struct objects o = {.scenario = scenario, .place = place, .error = error};
    int result = -1;
    if (scenario->settings->terrain != TERRAIN_FILE)
        return key_table_refuse(error, place, "objects.source", "file",
                                "needs terrain.source = \"file\"");
    if (open_file(&o) == 0 && find_kinds(&o) == 0 && extend(&o) == 0)
        result = add_all(&o);
    ground_file_close(&o.file);
    free(o.object);
    free(o.building);
    free(o.corner);
    return result;
}
