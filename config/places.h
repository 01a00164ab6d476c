/* Places of a scenario that are written as texts: "44.2705N,71.3033W", "19TCK1617404497" or
 * "25000,24000" where a point is allowed, and two of them, the corners, where an area is. */
#ifndef JOLON_CONFIG_PLACES_H
#define JOLON_CONFIG_PLACES_H

#include "world/params.h"
#include "world/runtime/error_text.h"

#include <libconfig.h>

/* Replaces such texts in the lists of a scenario's tree by metres from the north-west corner, so
 * that the readers of the lists know of numbers alone. params, side_m: the world's place on the
 * earth. Returns 0, or -1 with the message: file, line, key, value and what would be right. */
int places_convert(config_t *config, const char *file, const struct params *params, double side_m,
                   struct error_text *error);

#endif
