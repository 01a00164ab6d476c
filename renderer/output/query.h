/* What clients of the stream ask for, read from the addresses' queries: "view=chase&vehicle=17".
 * Pure. Every call returns 0, or -1 with a reason that says what would be right; what a client
 * wrote is repeated in it shortened, and letters alone. */
#ifndef JOLON_RENDERER_OUTPUT_QUERY_H
#define JOLON_RENDERER_OUTPUT_QUERY_H

#include "ipc/segment/segment.h"
#include "renderer/output/picture_requests.h"

#include <stdbool.h>
#include <stdint.h>

#define QUERY_SIDE_MIN   64u
#define QUERY_WIDTH_MAX  1920u
#define QUERY_HEIGHT_MAX 1080u
#define QUERY_METRES_MIN 100.0 /* across a map */
#define QUERY_METRES_MAX 200000.0
#define QUERY_PLACE_MOST 100000.0 /* [m] of a map's middle, in the world or somewhat beyond */

/* /picture.jpg?view=&vehicle=&size=WxH&after=N&bar=0|1 */
struct query_picture {
    struct picture_requests_key key;
    bool after_given;
    uint64_t after; /* waits for another picture than this */
    uint32_t seen;  /* keys that came, a bit each */
};

/* /map.jpg?x=&z=&metres=&size=WxH */
struct query_map {
    double x, z;   /* [m, world] of the middle */
    double metres; /* across the width */
    uint32_t width, height;
    uint32_t seen;
};

/* What holds for keys that do not come. */
void query_picture_begin(struct query_picture *query);
void query_map_begin(struct query_map *query);

/* One key and its value, NULL for a key without one. */
int query_picture_take(struct query_picture *query, const char *key, const char *value,
                       struct error_text *error);
int query_map_take(struct query_map *query, const char *key, const char *value,
                   struct error_text *error);

#endif
