/* Events of Cursor on Target (version 2.0) as XML: where something is, and that it is gone. ATAK,
 * WinTAK and their servers read them. Pure; any thread. */
#ifndef JOLON_GATEWAY_COT_EVENT_H
#define JOLON_GATEWAY_COT_EVENT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define COT_EVENT_BYTES 2048u /* room for any event */
#define COT_EVENT_TEXT  64u   /* room for an identifier, a type or a call sign with its NUL */

struct cot_event {
    char uid[COT_EVENT_TEXT];
    char type[COT_EVENT_TEXT];
    char callsign[COT_EVENT_TEXT];                /* any bytes; what XML forbids becomes '?' */
    int64_t time_ms;                              /* since 1970, UTC, 0 or more */
    int64_t stale_ms;                             /* after this it counts as out of date */
    double latitude_deg, longitude_deg, height_m; /* WGS 84, above the ellipsoid */
    double error_m;                               /* of the place, level and upright */
    double course_deg, speed_mps;                 /* over the ground, from true north */
};

/* Writes the event, or the one that takes the thing with this uid off the map, with a NUL at its
 * end. Returns its length, 0 when there is no room. The result is well-formed XML in ASCII
 * whatever the texts are. */
size_t cot_event_write(const struct cot_event *event, char *xml, size_t size);
size_t cot_event_write_deletion(const struct cot_event *event, char *xml, size_t size);

#endif
