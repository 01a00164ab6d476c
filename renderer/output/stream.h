/* The live stream: an HTTP server that shows pictures to browsers (docs/video.md). Two threads of
 * its own: one makes a JPEG of a picture, once however many watch and not at all when nobody does;
 * libmicrohttpd's serves the clients. Nobody who watches, or does not read, makes the drawing wait:
 * a client takes the newest picture when it is done with the one before. */
#ifndef JOLON_RENDERER_STREAM_H
#define JOLON_RENDERER_STREAM_H

#include "ipc/segment.h"
#include "renderer/output/picture.h"

#include <stdint.h>

#define STREAM_ADDRESS "127.0.0.1" /* by default; others can be told */

struct stream;

/* Binds and listens, without a thread yet; port 0: any that is free. A warning says when others
 * than this machine's may come. world: the name that is shown. NULL with the reason: no such
 * address, the port is in use or not allowed, no memory. */
struct stream *stream_open(const char *address, uint16_t port, const char *world,
                           struct reason *reason);

/* "http://ADDRESS:PORT/" */
const char *stream_url(const struct stream *stream);

/* Starts to serve. 0, or -1 with the reason. */
int stream_start(struct stream *stream, struct reason *reason);

/* Shows a picture, which the caller goes on holding, in its view. */
void stream_put(struct stream *stream, struct picture *picture);

/* Ends all connections and threads, and lets every picture go. NULL is nothing. */
void stream_close(struct stream *stream);

#endif
