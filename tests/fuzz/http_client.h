/* A client of a server under test, for the harnesses of console and live stream: it sends an input
 * as it is, and looks at what comes back. */
#ifndef JOLON_TESTS_FUZZ_HTTP_CLIENT_H
#define JOLON_TESTS_FUZZ_HTTP_CLIENT_H

#include "ipc/http/listen.h"

#include <stddef.h>
#include <stdint.h>

/* A Unix socket to listen on, whose server asks for names as on loopback. */
struct http_listener http_client_listener(void);

/* Sends the bytes in two parts and reads until the server ends the connection, 64 kB came, or
 * nothing comes for 40 ms. meanwhile() does what other threads of the program would. Every answer
 * begins as one of HTTP. */
void http_client_send(const uint8_t *data, size_t size, void (*meanwhile)(void));

/* Asks for a path, which must be answered with 200 within 20 s. */
void http_client_get(const char *path, void (*meanwhile)(void));

#endif
