/* Requests to a live stream: libmicrohttpd's parser, names, routes, and query keys of pictures and
 * maps. The harness draws the requested pictures. */
#include "tests/fuzz/shared/http_client.h"
#include "tests/fuzz/support.h"

#include "renderer/output/stream_internal.h"
#include "world/runtime/check.h"
#include "renderer/output/stream_requests.h"

#include <string.h>

static struct stream *stream;
static struct picture_pool pool;
static struct image image;
static uint64_t frame;

static int paint(void *self, const struct query_map *map, struct image *to)
{
    (void)self;
    CHECK(map->width == to->width && map->height == to->height);
    memset(to->pixels, 0, (size_t)to->width * to->height * sizeof *to->pixels);
    return 0;
}

static struct picture *draw(void)
{
    struct picture *picture = picture_make(&pool, &image, "chase", "");
    CHECK(picture != NULL);
    picture->frame = ++frame;
    return picture;
}

/* Every second request is for a vehicle that no longer exists. */
static void draw_wishes(void)
{
    struct stream_request requests[PICTURE_REQUESTS_MAX];
    if (stream_requests_read(stream, requests) == 0)
        return;
    for (uint32_t i = 0; i < PICTURE_REQUESTS_MAX; i++) {
        if (!requests[i].waiting)
            continue;
        CHECK(requests[i].key.width >= QUERY_SIDE_MIN && requests[i].key.width <= QUERY_WIDTH_MAX &&
              requests[i].key.height <= QUERY_HEIGHT_MAX);
        struct picture *picture = requests[i].key.vehicle % 2 == 0 ? draw() : NULL;
        stream_requests_answer(stream, i, requests[i].generation, picture);
        picture_release(picture);
    }
}

static void start(void)
{
    const struct stream_painter painter = {.self = NULL, .paint = paint};
    struct error_text error;
    picture_pool_init(&pool);
    CHECK(image_init(&image, 64, 48) == 0);
    stream = stream_open("fuzz", &painter, &error);
    CHECK(stream != NULL);
    stream->endpoint[stream->endpoints++].listener = http_client_listener();
    CHECK(stream_start(stream, &error) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (stream == NULL)
        start();
    struct picture *picture = draw();
    stream_put(stream, picture);
    picture_release(picture);
    http_client_send(data, size, draw_wishes);
    http_client_get("/chase.jpg", draw_wishes);
    return 0;
}
