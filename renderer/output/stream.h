/* The live stream: an HTTP server that shows pictures (docs/pictures.md): the renderer's views to
 * browsers that watch, and to any client the picture that it asks for. It has threads of its own:
 * one makes a JPEG of a picture, once however many watch and not at all when nobody does; one
 * paints maps; libmicrohttpd's serve the clients. Nobody who watches, or does not read, makes the
 * drawing wait: a client takes the newest picture when it is done with the one before. */
#ifndef JOLON_RENDERER_OUTPUT_STREAM_H
#define JOLON_RENDERER_OUTPUT_STREAM_H

#include "ipc/segment/role.h"
#include "ipc/segment/segment.h"
#include "renderer/output/picture.h"
#include "renderer/output/query.h"
#include "renderer/output/picture_requests.h"

#include <stdint.h>

struct stream;

/* What paints maps, in a thread of its own: 0, or -1 when there is no memory. */
struct stream_painter {
    void *self;
    int (*paint)(void *self, const struct query_map *map, struct image *image);
};

/* A stream that listens nowhere yet. world: the name that is shown. NULL with the reason: no
 * memory. */
struct stream *stream_open(const char *world, const struct stream_painter *painter,
                           struct error_text *error);

/* "http://ADDRESS:PORT/" of stream_listen(). */
const char *stream_url(const struct stream *stream);

/* Starts to serve. 0, or -1 with the reason. */
int stream_start(struct stream *stream, struct error_text *error);

/* Shows a picture, which the caller goes on holding, in its view. */
void stream_put(struct stream *stream, struct picture *picture);

/* Ends all connections and threads, and lets every picture go. NULL is nothing. */
void stream_close(struct stream *stream);

#endif
