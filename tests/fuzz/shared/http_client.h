/* A client for the harnesses of console and live stream. It sends an input unchanged and checks the
 * answer. */
#ifndef JOLON_TESTS_FUZZ_SHARED_HTTP_CLIENT_H
#define JOLON_TESTS_FUZZ_SHARED_HTTP_CLIENT_H

#include "ipc/http/listen.h"

#include <stddef.h>
#include <stdint.h>

/* Returns a Unix socket whose server expects the names of the loopback interface. */
struct http_listener http_client_listener(void);

/* Sends the bytes in two parts. Reads until the server closes the connection, 64 kB have come, or
 * nothing comes for 40 ms. Calls meanwhile(), which does the work of the program's other threads.
 * Every answer must begin as HTTP. */
void http_client_send(const uint8_t *data, size_t size, void (*meanwhile)(void));

/* Requests a path, which must be answered with 200 within 20 s. */
void http_client_get(const char *path, void (*meanwhile)(void));

#endif
