/* Settings of a gateway that a world does not have. Pure; any thread. */
#ifndef JOLON_WORLD_GATEWAY_IDLE_H
#define JOLON_WORLD_GATEWAY_IDLE_H

#include <stdbool.h>

struct params;

/* Room for the names of all keys. */
#define GATEWAY_IDLE_TEXT 512u

#define GATEWAY_IDLE_BETWEEN ", "

/* Returns true if the parameters have no gateway and yet say what one would do, and writes the
 * names of the keys, with GATEWAY_IDLE_BETWEEN between them, into text. The place of the world on
 * the earth (latitude, longitude, undulation) does not count, as a ground file sets it. */
bool gateway_idle_settings(const struct params *params, char text[GATEWAY_IDLE_TEXT]);

/* The warning of such a world: a format with one %s, the names. */
#define GATEWAY_IDLE_WARNING                                                                       \
    "without a gateway these settings have no effect: %s; --dis ADDRESS or gateway.enabled = "     \
    "true "                                                                                        \
    "gives the world one"

#endif
