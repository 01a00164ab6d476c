/* Reading the queries of HTTP requests to the stream: "view=chase&vehicle=17". Pure. Functions
 * return 0, or -1 with a reason that says what would be right. It repeats the client's text only
 * shortened and without characters that cannot be printed. */
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
#define QUERY_METRES_MAX 2000000.0
#define QUERY_PLACE_MOST                                                                           \
    1000000.0 /* [m] coordinates of a map's centre may lie outside of the world */

/* /picture.jpg?view=&vehicle=&size=WxH&after=N&bar=0|1 */
struct query_picture {
    struct picture_requests_key key;
    bool after_given;
    uint64_t after; /* number of the picture that the client has */
    uint32_t seen;  /* bits of the keys that were given */
};

/* /map.jpg?x=&z=&metres=&size=WxH */
struct query_map {
    double x, z;   /* [m, world] of the centre */
    double metres; /* [m] width of the map */
    uint32_t width, height;
    uint32_t seen;
};

/* Set the defaults. */
void query_picture_begin(struct query_picture *query);
void query_map_begin(struct query_map *query, double side_m); /* of the world */

/* Take one key and its value, NULL for a key without one. */
int query_picture_take(struct query_picture *query, const char *key, const char *value,
                       struct error_text *error);
int query_map_take(struct query_map *query, const char *key, const char *value,
                   struct error_text *error);

#endif
