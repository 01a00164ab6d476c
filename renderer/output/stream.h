/* The live stream: an HTTP server for the renderer's views and for pictures that clients request
 * (docs/pictures.md). One thread encodes JPEGs: each picture once for all clients, and only while
 * there are clients. One thread paints maps. libmicrohttpd's threads serve the clients. The drawing
 * thread never waits for a client: a client gets the newest picture when it has read the one
 * before. */
#ifndef JOLON_RENDERER_OUTPUT_STREAM_H
#define JOLON_RENDERER_OUTPUT_STREAM_H

#include "ipc/segment/role.h"
#include "ipc/segment/segment.h"
#include "renderer/output/picture.h"
#include "renderer/output/query.h"
#include "renderer/output/picture_requests.h"

#include <stdint.h>

struct stream;

/* Paints maps, in the stream's painting thread. paint() returns 0, or -1 when there is no memory.
 */
struct stream_painter {
    double side_m; /* of the world */
    void *self;
    int (*paint)(void *self, const struct query_map *map, struct image *image);
};

/* Makes a stream that does not listen yet. world: the name on its page. painter: NULL for no maps.
 * Returns NULL with the reason: no memory. */
struct stream *stream_open(const char *world, const struct stream_painter *painter,
                           struct error_text *error);

/* Returns "http://ADDRESS:PORT/" of stream_listen(). */
const char *stream_url(const struct stream *stream);

/* Starts the threads. Returns 0, or -1 with the reason. */
int stream_start(struct stream *stream, struct error_text *error);

/* Shows a picture in its view, and adds a reference to it. */
void stream_put(struct stream *stream, struct picture *picture);

/* Ends all connections and threads, and frees the stream. NULL is allowed. */
void stream_close(struct stream *stream);

#endif
