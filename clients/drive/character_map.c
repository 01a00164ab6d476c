/* Draws the map's cells. */
#include "clients/drive/character_map.h"

#include "clients/drive/session.h"
#include "world/maths/maths.h"

#include <ctype.h>
#include <string.h>

double character_map_cell_m(uint32_t zoom)
{
    static const double metres[SESSION_ZOOMS] = {10.0, 25.0, 50.0, 100.0, 250.0, 500.0, 1000.0};
    return metres[zoom < SESSION_ZOOMS ? zoom : SESSION_ZOOMS - 1];
}

static bool code_used(char code[][3], uint32_t count, const char *wanted)
{
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(code[i], wanted) == 0)
            return true;
    }
    return false;
}

void character_map_codes(char code[][3], const struct world_mirror *mirror)
{
    for (uint32_t i = 0; i < mirror->world.kinds._length; i++) {
        const char *name = mirror->kinds[i].name;
        char wanted[3] = {name[0], name[0] ? name[1] : '\0', '\0'};
        for (const char *next = name + 1; name[0] && *next; next++) {
            wanted[1] = *next;
            if (*next != '-' && !code_used(code, i, wanted))
                break;
        }
        memcpy(code[i], wanted, sizeof wanted);
    }
}

static void put(struct character_map *map, int row, int column, const char *text,
                enum character_map_mark mark)
{
    if (row < 0 || row >= map->rows || column < 0 || column >= map->columns)
        return;
    struct character_map_cell *cell = &map->cell[row][column];
    if (cell->mark > mark)
        return;
    cell->mark = (uint8_t)mark;
    memcpy(cell->text, text, 2);
}

static void draw_ground(struct character_map *map, const struct world_mirror *mirror, double x0,
                        double z0)
{
    double side_m = mirror->world.side_m;
    for (int row = 0; row < map->rows; row++) {
        for (int column = 0; column < map->columns; column++) {
            double x = x0 + (column + 0.5) * map->cell_m;
            double z = z0 + (row + 0.5) * map->cell_m;
            struct character_map_cell *cell = &map->cell[row][column];
            if (!(x >= 0.0 && z >= 0.0 && x < side_m && z < side_m)) {
                memcpy(cell->text, "//", 2); /* outside the world */
                continue;
            }
            uint32_t at = (uint32_t)(z / side_m * jolon_MAP_SIDE) * jolon_MAP_SIDE +
                          (uint32_t)(x / side_m * jolon_MAP_SIDE);
            if (mirror->world.water[at]) {
                memcpy(cell->text, " ~", 2);
                cell->mark = CHARACTER_MAP_WATER;
            }
        }
    }
}

/* The arrow of the vehicle's heading, one of eight. */
static const char *arrow(const jolon_Entity *self)
{
    static const char *const arrows[] = {"/\\", "_/", "=>", "~\\", "\\/", "/~", "<=", "\\_"};
    return arrows[(int)((double)self->heading_rad / TWO_PI * 8.0 + 0.5) & 7];
}

static void draw_entity(struct character_map *map, const struct world_mirror *mirror,
                        const jolon_Entity *e, char code[][3], int row, int column)
{
    const jolon_KindInfo *kind = world_mirror_kind(mirror, e->kind);
    char text[3] = "??";
    if (kind && kind->domain == jolon_DOMAIN_MUNITION) {
        put(map, row, column, " *", CHARACTER_MAP_MUNITION);
        return;
    }
    if (e->state == jolon_ENTITY_WRECK) {
        put(map, row, column, "xx", CHARACTER_MAP_WRECK);
        return;
    }
    if (kind)
        memcpy(text, code[e->kind], sizeof text);
    if (e->force != jolon_FORCE_BLUE)
        text[0] = (char)toupper((unsigned char)text[0]);
    if (e->force == jolon_FORCE_RED)
        text[1] = (char)toupper((unsigned char)text[1]);
    put(map, row, column, text,
        e->force == jolon_FORCE_BLUE  ? CHARACTER_MAP_BLUE
        : e->force == jolon_FORCE_RED ? CHARACTER_MAP_RED
                                      : CHARACTER_MAP_NEUTRAL);
}

void character_map_draw(struct character_map *map, const struct world_mirror *mirror,
                        const jolon_Entity *self, uint32_t target, int rows, int columns,
                        double cell_m)
{
    char code[WORLD_MIRROR_KINDS_MAX][3] = {{0}};
    map->rows = rows < 0 ? 0 : rows > CHARACTER_MAP_ROWS_MAX ? CHARACTER_MAP_ROWS_MAX : rows;
    map->columns = columns < 0                           ? 0
                   : columns > CHARACTER_MAP_COLUMNS_MAX ? CHARACTER_MAP_COLUMNS_MAX
                                                         : columns;
    map->cell_m = cell_m;
    for (int row = 0; row < map->rows; row++) {
        for (int column = 0; column < map->columns; column++)
            map->cell[row][column] =
                (struct character_map_cell){.text = " .", .mark = CHARACTER_MAP_GROUND};
    }
    if (!self || !mirror->has_world || !mirror->has_batch)
        return;
    double x0 = self->x_m - (map->columns / 2 + 0.5) * cell_m;
    double z0 = self->z_m - (map->rows / 2 + 0.5) * cell_m;
    draw_ground(map, mirror, x0, z0);
    character_map_codes(code, mirror);
    for (uint32_t i = 0; i < mirror->batch.count; i++) {
        const jolon_Entity *e = &mirror->batch.entity[i];
        double row = floor((e->z_m - z0) / cell_m), column = floor((e->x_m - x0) / cell_m);
        if (!(row >= 0.0 && column >= 0.0 && row < map->rows && column < map->columns))
            continue;
        draw_entity(map, mirror, e, code, (int)row, (int)column);
        if (e->id == target)
            map->cell[(int)row][(int)column].mark = CHARACTER_MAP_TARGET;
    }
    put(map, map->rows / 2, map->columns / 2, arrow(self), CHARACTER_MAP_SELF);
}
