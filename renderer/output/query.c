/* Reading queries of clients that are not trusted. */
#include "renderer/output/query.h"

#include "world/terrain/gridsquare.h"
#include "world/view_mode.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH_USUAL  640u
#define HEIGHT_USUAL 360u
#define SHOWN_BYTES  24 /* of what a client wrote */

/* --- values ------------------------------------------------------------------------------------*/

/* Copies the beginning of a text with '?' for characters that cannot be printed. */
static const char *shown(const char *text, char room[SHOWN_BYTES])
{
    size_t used = 0;
    for (; text[used] != '\0' && used + 1 < SHOWN_BYTES; used++)
        room[used] = text[used] > ' ' && text[used] <= '~' ? text[used] : '?';
    room[used] = '\0';
    return room;
}

static int refuse(struct error_text *error, const char *key, const char *value, const char *right)
{
    char room[SHOWN_BYTES];
    return error_text_set(error, "%s=%s: %s", key, shown(value, room), right);
}

/* Reads digits. Returns what follows them; NULL without digits or for a value above most. */
static const char *read_whole(const char *text, uint64_t most, uint64_t *value)
{
    const char *at = text;
    *value = 0;
    for (; *at >= '0' && *at <= '9'; at++) {
        *value = 10 * *value + (uint64_t)(*at - '0');
        if (*value > most)
            return NULL;
    }
    return at > text ? at : NULL;
}

static bool is_whole(const char *text, uint64_t most, uint64_t *value)
{
    const char *end = read_whole(text, most, value);
    return end != NULL && *end == '\0';
}

static bool is_number(const char *text, double low, double high, double *value)
{
    char *end;
    if (text[0] == '\0' || text[strspn(text, "+-.0123456789eE")] != '\0')
        return false; /* strtod takes more: spaces, hexadecimal, infinity */
    *value = strtod(text, &end);
    return *end == '\0' && *value >= low && *value <= high;
}

static int take_size(uint32_t *width, uint32_t *height, const char *value, struct error_text *error)
{
    uint64_t across, down = 0;
    const char *at = read_whole(value, QUERY_WIDTH_MAX, &across);
    if (at == NULL || *at != 'x' || !is_whole(at + 1, QUERY_HEIGHT_MAX, &down) ||
        across < QUERY_SIDE_MIN || down < QUERY_SIDE_MIN)
        return refuse(error, "size", value, "is WIDTHxHEIGHT, from 64x64 to 1920x1080");
    *width = (uint32_t)across;
    *height = (uint32_t)down;
    return 0;
}

/* --- keys --------------------------------------------------------------------------------------*/

/* Returns the index of a key, which may be given once; -1 with the reason. */
static int find_key(const char *const *keys, int count, const char *key, const char *value,
                    uint32_t *seen, const char *all, struct error_text *error)
{
    char room[SHOWN_BYTES];
    for (int i = 0; i < count; i++) {
        if (strcmp(keys[i], key) != 0)
            continue;
        if (*seen & 1u << i)
            return error_text_set(error, "%s is there twice", key);
        if (value == NULL)
            return error_text_set(error, "%s has no value", key);
        *seen |= 1u << i;
        return i;
    }
    return error_text_set(error, "%s is none of %s", shown(key, room), all);
}

static int take_view(struct query_picture *query, const char *value, struct error_text *error)
{
    static const enum view_mode views[] = {VIEW_CHASE, VIEW_INSIDE, VIEW_ORBIT, VIEW_OVERHEAD};
    for (size_t i = 0; i < sizeof views / sizeof views[0]; i++)
        if (strcmp(value, view_mode_name(views[i])) == 0) {
            query->key.view = views[i];
            return 0;
        }
    return refuse(error, "view", value, "is chase, inside, orbit or overhead");
}

void query_picture_begin(struct query_picture *query)
{
    *query = (struct query_picture){
        .key = {.view = VIEW_CHASE, .width = WIDTH_USUAL, .height = HEIGHT_USUAL, .bar = true}};
}

int query_picture_take(struct query_picture *query, const char *key, const char *value,
                       struct error_text *error)
{
    enum { KEY_VIEW, KEY_VEHICLE, KEY_SIZE, KEY_AFTER, KEY_BAR, KEY_COUNT };
    static const char *const keys[] = {"view", "vehicle", "size", "after", "bar"};
    uint64_t whole;
    switch (find_key(keys, KEY_COUNT, key, value, &query->seen, "view, vehicle, size, after, bar",
                     error)) {
    case KEY_VIEW:
        return take_view(query, value, error);
    case KEY_VEHICLE:
        if (!is_whole(value, UINT32_MAX, &whole))
            return refuse(error, key, value, "is a vehicle's number, as 17");
        query->key.vehicle = (uint32_t)whole;
        return 0;
    case KEY_SIZE:
        return take_size(&query->key.width, &query->key.height, value, error);
    case KEY_AFTER:
        query->after_given = true;
        if (!is_whole(value, UINT64_MAX / 16, &query->after))
            return refuse(error, key, value, "is a picture's number, as in X-Picture");
        return 0;
    case KEY_BAR:
        if (!is_whole(value, 1, &whole))
            return refuse(error, key, value, "is 0 or 1");
        query->key.bar = whole == 1;
        return 0;
    default:
        return -1;
    }
}

void query_map_begin(struct query_map *query, double side_m)
{
    *query = (struct query_map){.x = 0.5 * side_m,
                                .z = 0.5 * side_m,
                                .metres = side_m,
                                .width = WIDTH_USUAL,
                                .height = HEIGHT_USUAL};
}

int query_map_take(struct query_map *query, const char *key, const char *value,
                   struct error_text *error)
{
    enum { KEY_X, KEY_Z, KEY_METRES, KEY_SIZE, KEY_COUNT };
    static const char *const keys[] = {"x", "z", "metres", "size"};
    int which = find_key(keys, KEY_COUNT, key, value, &query->seen, "x, z, metres, size", error);
    switch (which) {
    case KEY_X:
    case KEY_Z:
        if (!is_number(value, -QUERY_PLACE_MOST, QUERY_PLACE_MOST,
                       which == KEY_X ? &query->x : &query->z))
            return refuse(error, key, value, "is a place in metres, from -1000000 to 1000000");
        return 0;
    case KEY_METRES:
        if (!is_number(value, QUERY_METRES_MIN, QUERY_METRES_MAX, &query->metres))
            return refuse(error, key, value, "is metres across the map, from 100 to 2000000");
        return 0;
    case KEY_SIZE:
        return take_size(&query->width, &query->height, value, error);
    default:
        return -1;
    }
}
