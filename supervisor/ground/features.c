/* Sorts the features of maps by their words, and reads their shapes. */
#include "supervisor/ground/features.h"
#include "supervisor/ground/grown_list.h"

#include "supervisor/ground/vector_map.h"
#include "world/maths/maths.h"

#include <cpl_error.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define STOREY_M      3.0
#define HOUSE_M       5.5 /* walls of a building whose height is not known ... */
#define HALL_M        8.0 /* ... of one of HALL_M2 or more ... */
#define SHED_M        2.6 /* ... and of one below SHED_M2 */
#define HALL_M2       450.0
#define SHED_M2       32.0
#define RIDGED_M      11.0 /* higher walls have flat roofs */
#define RISE_SHARE    0.45 /* of a ridge over the walls, of their height */
#define WALLS_MIN_M   2.0
#define WALLS_MAX_M   500.0
#define RIVER_M       16.0 /* width of a river whose width is not known */
#define RIVER_MOST_M  2000.0
#define CANAL_M       10.0
#define ROW_APART_M   10.0 /* of trees in a row */
#define TOWER_PERCENT 250u /* of a pole's size */
#define WORD_MAX      64u
#define METRES_A_FOOT 0.3048

enum key {
    KEY_BUILDING,
    KEY_POWER,
    KEY_MAN_MADE,
    KEY_NATURAL,
    KEY_LANDUSE,
    KEY_WATERWAY,
    KEY_WATER,
    KEY_FCLASS,
    KEYS
};
static const char *const keys[KEYS] = {"building", "power",    "man_made", "natural",
                                       "landuse",  "waterway", "water",    "fclass"};

/* What a closed line is, unless area=yes says that it is an outline. */
enum closed { OUTLINE, LINE };

/* The first row that fits counts. A value of NULL fits every word but "no". */
static const struct word {
    const char *value;
    enum key key;
    enum feature_use use;
    enum closed closed;
} words[] = {
    {"roof", KEY_BUILDING, FEATURE_NONE, OUTLINE},
    {NULL, KEY_BUILDING, FEATURE_BUILDING, OUTLINE},
    {"building", KEY_FCLASS, FEATURE_BUILDING, OUTLINE},
    {"tower", KEY_POWER, FEATURE_TOWER, OUTLINE},
    {"pole", KEY_POWER, FEATURE_POLE, OUTLINE},
    {"line", KEY_POWER, FEATURE_TOWER, LINE},
    {"minor_line", KEY_POWER, FEATURE_POLE, LINE},
    {"water_tower", KEY_MAN_MADE, FEATURE_WATERTOWER, OUTLINE},
    {"water_tower", KEY_FCLASS, FEATURE_WATERTOWER, OUTLINE},
    {"utility_pole", KEY_MAN_MADE, FEATURE_POLE, OUTLINE},
    {"mast", KEY_MAN_MADE, FEATURE_TOWER, OUTLINE},
    {"communications_tower", KEY_MAN_MADE, FEATURE_TOWER, OUTLINE},
    {"tree", KEY_NATURAL, FEATURE_TREE, OUTLINE},
    {"tree", KEY_FCLASS, FEATURE_TREE, OUTLINE},
    {"tree_row", KEY_NATURAL, FEATURE_TREE_ROW, LINE},
    {"river", KEY_WATER, FEATURE_RIVER, OUTLINE},
    {"canal", KEY_WATER, FEATURE_RIVER, OUTLINE},
    {"water", KEY_NATURAL, FEATURE_LAKE, OUTLINE},
    {"reservoir", KEY_LANDUSE, FEATURE_LAKE, OUTLINE},
    {"basin", KEY_LANDUSE, FEATURE_LAKE, OUTLINE},
    {"water", KEY_FCLASS, FEATURE_LAKE, OUTLINE},
    {"reservoir", KEY_FCLASS, FEATURE_LAKE, OUTLINE},
    {"river", KEY_WATERWAY, FEATURE_RIVER, LINE},
    {"canal", KEY_WATERWAY, FEATURE_RIVER, LINE},
    {"riverbank", KEY_WATERWAY, FEATURE_RIVER, OUTLINE},
    {"dock", KEY_WATERWAY, FEATURE_LAKE, OUTLINE},
    {"river", KEY_FCLASS, FEATURE_RIVER, LINE},
    {"canal", KEY_FCLASS, FEATURE_RIVER, LINE},
    {"riverbank", KEY_FCLASS, FEATURE_RIVER, OUTLINE},
    {"dock", KEY_FCLASS, FEATURE_LAKE, OUTLINE},
    {"coastline", KEY_NATURAL, FEATURE_COAST, LINE},
    {"wood", KEY_NATURAL, FEATURE_WOOD, OUTLINE},
    {"forest", KEY_LANDUSE, FEATURE_WOOD, OUTLINE},
    {"forest", KEY_FCLASS, FEATURE_WOOD, OUTLINE},
    {"scrub", KEY_NATURAL, FEATURE_SCRUB, OUTLINE},
    {"heath", KEY_NATURAL, FEATURE_SCRUB, OUTLINE},
    {"scrub", KEY_FCLASS, FEATURE_SCRUB, OUTLINE},
    {"heath", KEY_FCLASS, FEATURE_SCRUB, OUTLINE},
};

static const char *const troubles[FEATURE_TROUBLES] = {
    [FEATURE_NO_PLACE] = "features with too few places, or with one that is none, are left out",
    [FEATURE_SHAPE] = "buildings or woods that are points or lines are left out",
    [FEATURE_OPEN] = "outlines are open, and were closed",
    [FEATURE_MENDED] = "outlines cross themselves, and were mended",
    [FEATURE_CROSSED] = ("woods or waters have outlines that cross, or holes outside of them: what "
                         "an odd number of sides encloses counts"),
    [FEATURE_NOTCHED] = "holes touch the outline around them, and are cut out of it",
    [FEATURE_BOXED] = ("outlines could not be split, and have the smallest rectangle around them "
                       "instead"),
    [FEATURE_SMALL] = "outlines are too small for buildings, and are left out",
    [FEATURE_EDGE] = "buildings across the edge of the square are left out",
    [FEATURE_LARGE] = "buildings of more than 1 km are left out",
    [FEATURE_HEIGHT] =
        "buildings have a height that is no number from 0 to 500 m, and was not used",
    [FEATURE_WIDTH] = "rivers have a width that is no number from 0 to 2000 m, and was not used",
};

struct reading {
    struct features *features;
    const struct post_grid *grid;
    struct vector_map *map;
    OGRFeatureH feature;
    enum feature_use use;
    const struct word *word; /* which says so */
    struct vector_map_track track;
    struct vector_map_courts courts; /* of the map that is read */
};

const char *features_trouble_text(enum feature_trouble trouble)
{
    return troubles[trouble];
}

/* Counts a trouble at the first place of the track. */
static void note(struct reading *r, enum feature_trouble trouble)
{
    if (r->features->trouble[trouble].count++ > 0)
        return;
    r->features->trouble[trouble].map = r->map->path;
    r->features->trouble[trouble].feature = vector_map_number(r->feature);
    r->features->trouble[trouble].latitude_deg = r->features->trouble[trouble].longitude_deg = NAN;
    if (r->track.count > 0)
        projection_place(&r->grid->projection, r->track.place[0][0], r->track.place[0][1],
                         &r->features->trouble[trouble].latitude_deg,
                         &r->features->trouble[trouble].longitude_deg);
}

static double side_of(const struct reading *r)
{
    return 2.0 * r->grid->projection.middle_m;
}

/* Returns a number of metres, 0 if the tag has none: "12", "12.5 m", "40 ft", "40'". */
static double metres_of(const struct reading *r, const char *key)
{
    char buffer[WORD_MAX], *end;
    const char *text = vector_map_tag(r->feature, key, buffer, sizeof buffer);
    double metres = strtod(text, &end);
    if (end == text || !isfinite(metres) || metres <= 0.0)
        return 0.0;
    while (*end == ' ')
        end++;
    return *end == '\'' || strncmp(end, "ft", 2) == 0 ? metres * METRES_A_FOOT : metres;
}

static bool has(const struct reading *r, const char *key)
{
    char buffer[WORD_MAX];
    return *vector_map_tag(r->feature, key, buffer, sizeof buffer) != '\0';
}

/* Returns larger memory for one more row, or the same. NULL: no memory, which is noted. */
static void *room_for(struct reading *r, void *rows, uint32_t used, uint32_t *room, size_t bytes)
{
    void *larger = grown_list(rows, used, room, 256, bytes);
    r->map->no_memory |= !larger;
    return larger;
}

/* --- objects -----------------------------------------------------------------------------------*/

static void add_object(struct reading *r, const double place[2], uint8_t type, uint8_t percent,
                       double heading_rad)
{
    struct features *f = r->features;
    double side = side_of(r);
    if (!(place[0] >= 0.0 && place[1] >= 0.0 && place[0] <= side && place[1] <= side))
        return;
    struct ground_object *rows =
        room_for(r, f->object, f->objects, &f->object_room, sizeof *f->object);
    if (!rows)
        return;
    f->object = rows;
    f->object[f->objects++] = (struct ground_object){
        (int32_t)floor(place[0] * 1000.0 + 0.5), (int32_t)floor(place[1] * 1000.0 + 0.5), type,
        percent, (uint16_t)(maths_wrap_turn(heading_rad) * (65536.0 / TWO_PI))};
}

static uint8_t type_of(enum feature_use use)
{
    return use == FEATURE_WATERTOWER                     ? GROUND_WATERTOWER
           : use == FEATURE_POLE || use == FEATURE_TOWER ? GROUND_POLE
                                                         : GROUND_TREE;
}

static void add_object_at(struct reading *r, const double place[2], double heading_rad)
{
    add_object(r, place, type_of(r->use), r->use == FEATURE_TOWER ? TOWER_PERCENT : 100,
               heading_rad);
}

/* Trees of a row, or the towers of a line, which stand where it bends. A pole's arm is across. */
static void add_row(struct reading *r)
{
    const struct vector_map_track *t = &r->track;
    for (uint32_t i = 0; i < t->count; i++) {
        const double *a = t->place[i > 0 ? i - 1 : 0], *b = t->place[i],
                     *c = t->place[i + 1 < t->count ? i + 1 : i];
        double length = sqrt((c[0] - b[0]) * (c[0] - b[0]) + (c[1] - b[1]) * (c[1] - b[1]));
        double steps = r->use == FEATURE_TREE_ROW ? floor(length / ROW_APART_M) : 0.0;
        double heading =
            a[0] != c[0] || a[1] != c[1] ? maths_heading(c[0] - a[0], c[1] - a[1]) : 0.0;
        add_object_at(r, b, heading);
        for (double n = 1.0; n <= steps && n * ROW_APART_M < 2.0 * side_of(r); n += 1.0) {
            double share = n * ROW_APART_M / length;
            const double place[2] = {b[0] + share * (c[0] - b[0]), b[1] + share * (c[1] - b[1])};
            if (share < 1.0)
                add_object_at(r, place, heading);
        }
    }
}

static void take_point(struct reading *r, OGRGeometryH point)
{
    if (!vector_map_track(r->map, point, &r->track))
        note(r, FEATURE_NO_PLACE);
    else if (r->use < FEATURE_TREE)
        note(r, FEATURE_SHAPE);
    else
        add_object_at(r, r->track.place[0], 0.0);
}

/* --- areas -------------------------------------------------------------------------------------*/

static bool touches(const struct reading *r, const struct area *area)
{
    double side = side_of(r);
    return area->low[0] <= side && area->low[1] <= side && area->high[0] >= 0.0 &&
           area->high[1] >= 0.0;
}

static bool is_closed(OGRGeometryH line)
{
    int last = OGR_G_GetPointCount(line) - 1;
    return last > 0 && OGR_G_GetX(line, 0) == OGR_G_GetX(line, last) &&
           OGR_G_GetY(line, 0) == OGR_G_GetY(line, last);
}

/* Tells of outlines that are open, which it closes. */
static void close_rings(struct reading *r, OGRGeometryH polygon)
{
    for (int i = 0; i < OGR_G_GetGeometryCount(polygon); i++) {
        OGRGeometryH ring = OGR_G_GetGeometryRef(polygon, i);
        if (is_closed(ring) || !vector_map_track(r->map, ring, &r->track) || r->track.count < 3)
            continue;
        note(r, FEATURE_OPEN);
        OGR_G_CloseRings(ring);
    }
}

static void take_area(struct reading *r, OGRGeometryH polygon)
{
    struct features *f = r->features;
    struct area area = {.use = (uint8_t)r->use};
    for (int i = 0; i < OGR_G_GetGeometryCount(polygon); i++) {
        if (!vector_map_track(r->map, OGR_G_GetGeometryRef(polygon, i), &r->track) ||
            r->track.count < 3) {
            note(r, FEATURE_NO_PLACE);
            break;
        }
        r->map->no_memory |= !area_add_ring(&area, r->track.place, r->track.count);
        if (r->map->no_memory)
            break;
    }
    struct area *rows = NULL;
    if (area.rings > 0 && touches(r, &area))
        rows = room_for(r, f->area, f->areas, &f->area_room, sizeof *f->area);
    if (!rows) {
        area_free(&area);
        return;
    }
    f->area = rows;
    f->area[f->areas++] = area;
    if (!OGR_G_IsValid(polygon)) {
        note(r, FEATURE_CROSSED);
        CPLErrorReset(); /* GDAL says why */
    }
}

/* Keeps the track as a line. */
static void add_line(struct reading *r, double width_m)
{
    struct features *f = r->features;
    struct feature_line *rows = room_for(r, f->line, f->lines, &f->line_room, sizeof *f->line);
    double(*place)[2] = calloc(r->track.count, sizeof *place);
    r->map->no_memory |= !place;
    if (rows)
        f->line = rows;
    if (!rows || !place) {
        free(place);
        return;
    }
    memcpy(place, r->track.place, r->track.count * sizeof *place);
    f->line[f->lines++] = (struct feature_line){place, r->track.count, width_m};
}

static void take_river(struct reading *r)
{
    char buffer[WORD_MAX];
    double width = metres_of(r, "width");
    if (width > RIVER_MOST_M || (width == 0.0 && has(r, "width"))) {
        note(r, FEATURE_WIDTH);
        width = 0.0;
    }
    if (width == 0.0)
        width = strcmp(vector_map_tag(r->feature, keys[r->word->key], buffer, sizeof buffer),
                       "canal") == 0
                    ? CANAL_M
                    : RIVER_M;
    add_line(r, width);
}

/* An island: its outline gets the direction of a coastline. */
static void take_island(struct reading *r, OGRGeometryH polygon)
{
    OGRGeometryH ring = OGR_G_GetGeometryRef(polygon, 0);
    if (!ring || !vector_map_track(r->map, ring, &r->track) || r->track.count < 3) {
        note(r, FEATURE_NO_PLACE);
        return;
    }
    double(*place)[2] = r->track.place, twice_area = 0.0;
    uint32_t count = r->track.count;
    for (uint32_t i = 0; i + 1 < count; i++)
        twice_area += place[i][0] * place[i + 1][1] - place[i + 1][0] * place[i][1];
    for (uint32_t i = 0; twice_area > 0.0 && i < count / 2; i++) {
        for (int k = 0; k < 2; k++) {
            double swapped = place[i][k];
            place[i][k] = place[count - 1 - i][k];
            place[count - 1 - i][k] = swapped;
        }
    }
    add_line(r, 0.0);
}

/* --- buildings ---------------------------------------------------------------------------------*/

static double walls_of(struct reading *r, double area_m2)
{
    double height = metres_of(r, "height"), storeys = metres_of(r, "building:levels");
    if (height == 0.0 && storeys > 0.0)
        height = storeys * STOREY_M;
    if (height > WALLS_MAX_M || (height == 0.0 && (has(r, "height") || has(r, "building:levels"))))
        note(r, FEATURE_HEIGHT);
    if (height == 0.0 || height > WALLS_MAX_M)
        height = area_m2 < SHED_M2 ? SHED_M : area_m2 < HALL_M2 ? HOUSE_M : HALL_M;
    return maths_max(height, WALLS_MIN_M);
}

/* Returns how many corners lie within the square; all: how many there are. */
static uint32_t corners_in(const struct convex_parts *parts, double side_m, uint32_t *all)
{
    uint32_t inside = 0;
    *all = 0;
    for (uint32_t i = 0; i < parts->count; i++) {
        for (uint32_t k = 0; k < parts->part[i].count; k++, ++*all) {
            const int32_t *c = parts->part[i].corner[k];
            inside += c[0] >= 0 && c[1] >= 0 && c[0] <= side_m * 1000.0 && c[1] <= side_m * 1000.0;
        }
    }
    return inside;
}

static void add_parts(struct reading *r, const struct convex_parts *parts)
{
    char buffer[WORD_MAX];
    uint32_t all, inside = corners_in(parts, side_of(r), &all);
    if (inside == 0)
        return;
    double height = walls_of(r, parts->area_m2), rise = 0.0;
    const char *roof = vector_map_tag(r->feature, "roof:shape", buffer, sizeof buffer);
    if (height <= RIDGED_M && parts->area_m2 >= SHED_M2 && strcmp(roof, "flat") != 0)
        rise = RISE_SHARE * maths_min(height, HOUSE_M);
    int added = buildings_add(&r->features->buildings, parts, height, rise, side_of(r));
    r->map->no_memory |= added < 0;
    if (added == 0 && parts->area_m2 < BUILDINGS_LEAST_M2)
        note(r, FEATURE_SMALL);
    else if (added == 0)
        note(r, inside == all ? FEATURE_LARGE : FEATURE_EDGE);
}

/* The smallest rectangle around the outline stands for it. */
static void add_box(struct reading *r, const struct convex_parts_ring *outline)
{
    struct convex_parts_box box;
    int32_t corner[4][2];
    if (outline->count < 3 || !convex_parts_box_of(&box, outline->corner, outline->count)) {
        note(r, FEATURE_SMALL);
        return;
    }
    for (int i = 0; i < 4; i++) {
        double along = (i == 0 || i == 3 ? 1.0 : -1.0) * box.half_length_mm;
        double across = (i < 2 ? 1.0 : -1.0) * box.half_width_mm;
        corner[i][0] = (int32_t)floor(box.x_mm + along * box.along_x - across * box.along_z + 0.5);
        corner[i][1] = (int32_t)floor(box.z_mm + along * box.along_z + across * box.along_x + 0.5);
    }
    struct convex_parts_ring part = {corner, 4};
    struct convex_parts parts = {&part, 1, 4e-6 * box.half_length_mm * box.half_width_mm};
    note(r, FEATURE_BOXED);
    add_parts(r, &parts);
}

/* Reads a ring in whole millimetres. Returns false if it is not near the square. */
static bool read_ring(struct reading *r, OGRGeometryH geometry, struct convex_parts_ring *ring)
{
    double side = side_of(r), reach = GROUND_BUILDING_REACH_MM / 1000.0;
    if (!vector_map_track(r->map, geometry, &r->track) || r->track.count < 3) {
        note(r, FEATURE_NO_PLACE);
        return false;
    }
    ring->corner = calloc(r->track.count, sizeof *ring->corner);
    r->map->no_memory |= !ring->corner;
    for (uint32_t i = 0; i < r->track.count && ring->corner; i++) {
        const double *place = r->track.place[i];
        for (int k = 0; k < 2; k++) {
            if (!(place[k] >= -reach && place[k] <= side + reach))
                return false;
            ring->corner[i][k] = (int32_t)floor(place[k] * 1000.0 + 0.5);
        }
        ring->count++;
    }
    return ring->corner != NULL;
}

static void take_building(struct reading *r, OGRGeometryH polygon, bool mended);

/* Mends an outline that crosses itself. Returns false if it cannot be mended. */
static bool mend(struct reading *r, OGRGeometryH polygon)
{
    OGRGeometryH good = vector_map_mend(polygon);
    if (!good)
        return false;
    OGRwkbGeometryType type = wkbFlatten(OGR_G_GetGeometryType(good));
    int pieces = type == wkbPolygon ? 1 : OGR_G_GetGeometryCount(good);
    bool any = false;
    for (int i = 0; i < pieces && (type == wkbPolygon || type == wkbMultiPolygon ||
                                   type == wkbGeometryCollection);
         i++) {
        OGRGeometryH piece = type == wkbPolygon ? good : OGR_G_GetGeometryRef(good, i);
        if (wkbFlatten(OGR_G_GetGeometryType(piece)) != wkbPolygon)
            continue;
        take_building(r, piece, true);
        any = true;
    }
    OGR_G_DestroyGeometry(good);
    if (any)
        note(r, FEATURE_MENDED);
    return any;
}

static void take_building(struct reading *r, OGRGeometryH polygon, bool mended)
{
    int count = OGR_G_GetGeometryCount(polygon), read = 0;
    struct convex_parts parts = {0};
    struct convex_parts_ring *ring = calloc((size_t)count + 1, sizeof *ring);
    r->map->no_memory |= !ring;
    while (ring && read < count && read_ring(r, OGR_G_GetGeometryRef(polygon, read), &ring[read]))
        read++;
    if (ring && read == count && count > 0) {
        switch (convex_parts_split(&parts, ring, (uint32_t)count)) {
        case CONVEX_PARTS_GOOD:
            add_parts(r, &parts);
            break;
        case CONVEX_PARTS_EMPTY:
            note(r, FEATURE_SMALL);
            break;
        case CONVEX_PARTS_TANGLED:
            if (mended || !mend(r, polygon))
                add_box(r, &ring[0]);
            break;
        case CONVEX_PARTS_NO_MEMORY:
            r->map->no_memory = true;
            break;
        }
    }
    convex_parts_free(&parts);
    for (int i = 0; ring && i <= read && i < count; i++)
        free(ring[i].corner);
    free(ring);
}

/* --- features ----------------------------------------------------------------------------------*/

/* A tower that is drawn as an outline stands in its middle. */
static void take_outline_object(struct reading *r, OGRGeometryH polygon)
{
    double middle[2] = {0.0, 0.0};
    OGRGeometryH ring = OGR_G_GetGeometryRef(polygon, 0);
    if (!ring || !vector_map_track(r->map, ring, &r->track)) {
        note(r, FEATURE_NO_PLACE);
        return;
    }
    for (uint32_t i = 0; i < r->track.count; i++) {
        middle[0] += r->track.place[i][0] / r->track.count;
        middle[1] += r->track.place[i][1] / r->track.count;
    }
    add_object_at(r, middle, 0.0);
}

static void take_polygon(struct reading *r, OGRGeometryH polygon)
{
    if (r->use == FEATURE_BUILDING)
        take_building(r, polygon, false);
    else if (r->use == FEATURE_COAST)
        take_island(r, polygon);
    else if (r->use < FEATURE_TREE)
        take_area(r, polygon);
    else
        take_outline_object(r, polygon);
}

/* Makes a polygon of a line whose ends may be apart. */
static void take_outline(struct reading *r, OGRGeometryH line)
{
    int count = OGR_G_GetPointCount(line);
    bool closed = is_closed(line);
    if (!vector_map_track(r->map, line, &r->track) || count < (closed ? 4 : 3)) {
        note(r, count < 3 ? FEATURE_SHAPE : FEATURE_NO_PLACE);
        return;
    }
    OGRGeometryH ring = OGR_G_CreateGeometry(wkbLinearRing),
                 polygon = OGR_G_CreateGeometry(wkbPolygon);
    for (int i = 0; i < count; i++)
        OGR_G_AddPoint_2D(ring, OGR_G_GetX(line, i), OGR_G_GetY(line, i));
    if (!closed)
        note(r, FEATURE_OPEN);
    OGR_G_CloseRings(ring);
    OGR_G_AddGeometryDirectly(polygon, ring);
    OGRGeometryH court =
        r->use == FEATURE_BUILDING ? vector_map_courts_find(&r->courts, polygon) : NULL;
    take_polygon(r, court ? court : polygon);
    OGR_G_DestroyGeometry(polygon);
}

/* Returns true if a line is the outline of an area. */
static bool is_outline(const struct reading *r, OGRGeometryH line)
{
    char buffer[WORD_MAX];
    if (r->use == FEATURE_BUILDING || r->use == FEATURE_WOOD || r->use == FEATURE_SCRUB ||
        r->use == FEATURE_LAKE)
        return true;
    return is_closed(line) &&
           (r->word->closed == OUTLINE ||
            strcmp(vector_map_tag(r->feature, "area", buffer, sizeof buffer), "yes") == 0);
}

static void take_line(struct reading *r, OGRGeometryH line)
{
    if (is_outline(r, line))
        take_outline(r, line);
    else if (!vector_map_track(r->map, line, &r->track) || r->track.count < 2)
        note(r, FEATURE_NO_PLACE);
    else if (r->use == FEATURE_COAST)
        add_line(r, 0.0);
    else if (r->use == FEATURE_RIVER)
        take_river(r);
    else
        add_row(r);
}

static void take_geometry(struct reading *r, OGRGeometryH geometry);

/* Takes a polygon without the holes among the others. */
static void take_cut(struct reading *r, const struct vector_map_polygon *own,
                     const struct vector_map_polygon *polygon, uint32_t count)
{
    OGRGeometryH rest = OGR_G_Clone(own->shape);
    for (uint32_t i = 0; i < count && rest; i++) {
        if (polygon[i].around % 2 == 0 || !vector_map_lies_within(&polygon[i], own))
            continue;
        OGRGeometryH less = OGR_G_Difference(rest, polygon[i].shape);
        CPLErrorReset();
        if (!less) /* the hole crosses itself */
            continue;
        OGR_G_DestroyGeometry(rest);
        rest = less;
        if (vector_map_track(r->map, OGR_G_GetGeometryRef(polygon[i].shape, 0), &r->track))
            note(r, FEATURE_NOTCHED);
    }
    if (rest && !OGR_G_IsEmpty(rest))
        take_geometry(r, rest);
    if (rest)
        OGR_G_DestroyGeometry(rest);
}

/* Takes the polygons of one area. GDAL makes a polygon of its own of a hole that touches its
 * outline: one that lies within an odd number of others is a hole of them. */
static void take_areas(struct reading *r, OGRGeometryH areas)
{
    uint32_t count = (uint32_t)OGR_G_GetGeometryCount(areas);
    struct vector_map_polygon *polygon = vector_map_polygons(areas);
    r->map->no_memory |= !polygon;
    for (uint32_t i = 0; i < count && polygon; i++) {
        if (polygon[i].around % 2 == 0)
            take_cut(r, &polygon[i], polygon, count);
    }
    free(polygon);
}

static void take_geometry(struct reading *r, OGRGeometryH geometry)
{
    r->track.count = 0;
    if (!geometry || OGR_G_IsEmpty(geometry)) {
        note(r, FEATURE_NO_PLACE);
        return;
    }
    switch ((int)wkbFlatten(OGR_G_GetGeometryType(geometry))) {
    case wkbPoint:
        take_point(r, geometry);
        break;
    case wkbLineString:
        take_line(r, geometry);
        break;
    case wkbPolygon:
        close_rings(r, geometry);
        take_polygon(r, geometry);
        break;
    case wkbMultiPolygon:
        take_areas(r, geometry);
        break;
    case wkbMultiPoint:
    case wkbMultiLineString:
    case wkbGeometryCollection:
        for (int i = 0; i < OGR_G_GetGeometryCount(geometry); i++)
            take_geometry(r, OGR_G_GetGeometryRef(geometry, i));
        break;
    default:
        note(r, FEATURE_SHAPE);
        break;
    }
}

/* Returns the word that says what a feature is, NULL if there is none. */
static const struct word *word_of(OGRFeatureH feature)
{
    char buffer[KEYS][WORD_MAX];
    const char *value[KEYS];
    for (int i = 0; i < KEYS; i++)
        value[i] = vector_map_tag(feature, keys[i], buffer[i], WORD_MAX);
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        const char *word = value[words[i].key];
        if (*word && (words[i].value ? strcmp(word, words[i].value) == 0 : strcmp(word, "no") != 0))
            return &words[i];
    }
    return NULL;
}

static void take_feature(void *context, struct vector_map *map, OGRFeatureH feature,
                         OGRGeometryH geometry)
{
    struct reading *r = context;
    r->map = map;
    r->feature = feature;
    r->word = word_of(feature);
    r->use = r->word ? r->word->use : FEATURE_NONE;
    if (r->use != FEATURE_NONE)
        take_geometry(r, geometry);
    else if (!r->word && map->relations_alone && geometry)
        map->no_memory |= !vector_map_courts_keep(&r->courts, geometry);
}

static int by_place(const double *p, const double *q)
{
    for (int k = 0; k < 2; k++) {
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    }
    return 0;
}

/* Where two areas overlap the later one counts, so their order must not be that of the maps: the
 * larger come first. */
static int by_extent(const void *left, const void *right)
{
    const struct area *p = left, *q = right;
    double extent[2] = {(p->high[0] - p->low[0]) * (p->high[1] - p->low[1]),
                        (q->high[0] - q->low[0]) * (q->high[1] - q->low[1])};
    if (extent[0] != extent[1])
        return extent[0] > extent[1] ? -1 : 1;
    int order = by_place(p->low, q->low);
    if (order == 0)
        order = by_place(p->high, q->high);
    if (order == 0)
        order = (int)p->use - (int)q->use;
    if (order == 0 && p->rings != q->rings)
        order = p->rings < q->rings ? -1 : 1;
    if (order == 0)
        order = memcmp(p->end, q->end, p->rings * sizeof *p->end);
    if (order == 0)
        order = memcmp(p->place, q->place, p->end[p->rings - 1] * sizeof *p->place);
    return order;
}

/* Puts the areas in order. Of an outline that a map has with holes and without them, as a relation
 * of OpenStreetMap and as its outer way, the one with holes counts. */
static void order_areas(struct features *f)
{
    uint32_t kept = 0;
    if (f->areas > 0)
        qsort(f->area, f->areas, sizeof *f->area, by_extent);
    for (uint32_t i = 0; i < f->areas; i++) {
        struct area *own = &f->area[i], *next = own + 1;
        if (i + 1 < f->areas && own->use == next->use && own->rings < next->rings &&
            by_place(own->low, next->low) == 0 && by_place(own->high, next->high) == 0)
            area_free(own);
        else
            f->area[kept++] = *own;
    }
    f->areas = kept;
}

int features_read(struct features *features, char *const *paths, uint32_t count,
                  const struct post_grid *grid, struct vector_map_gaps *gaps,
                  struct error_text *error)
{
    struct reading r = {.features = features, .grid = grid};
    int result = 0;
    *features = (struct features){0};
    for (uint32_t i = 0; i < count && result == 0; i++) {
        result = vector_map_read(
            paths[i], grid, VECTOR_MAP_POINTS | VECTOR_MAP_LINES | VECTOR_MAP_AREAS,
            "points, lines or areas that become features", take_feature, &r, gaps, error);
        vector_map_courts_free(&r.courts);
    }
    order_areas(features);
    vector_map_track_free(&r.track);
    return result;
}

void features_free(struct features *features)
{
    for (uint32_t i = 0; i < features->areas; i++)
        area_free(&features->area[i]);
    for (uint32_t i = 0; i < features->lines; i++)
        free(features->line[i].place);
    free(features->area);
    free(features->line);
    free(features->object);
    buildings_free(&features->buildings);
    *features = (struct features){0};
}
