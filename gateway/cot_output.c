/* Events of Cursor on Target for entities. */
#include "gateway/cot_output.h"

#include "gateway/cot_event.h"
#include "gateway/earth/geodesy.h"

#include <stdio.h>
#include <time.h>

#define STANDS_MPS 0.1 /* below it, the course is where the nose points */

/* The place is that of the frame; the receiver's map needs no better. */
#define ERROR_M 1.0

int cot_output_open(struct cot_output *cot, const char *address, unsigned interface,
                    uint8_t exercise, struct error_text *error)
{
    cot->exercise = exercise;
    return udp_output_open(&cot->udp, "gateway.cot", address, COT_OUTPUT_PORT, interface,
                           "events of Cursor on Target", error);
}

/* Writes course [deg] and speed [m/s] over the ground, at the entity's own place: there, north is
 * up to 0.2 degrees from that of the world's middle. */
static void set_track(struct cot_event *event, const struct cot_output_entity *entity,
                      const struct geodesy_place *place)
{
    double sin_lat, cos_lat, sin_lon, cos_lon;
    maths_sincos(place->latitude_rad, &sin_lat, &cos_lat);
    maths_sincos(place->longitude_rad, &sin_lon, &cos_lon);
    struct vec3 east = {-sin_lon, cos_lon, 0.0};
    struct vec3 north = {-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat};
    const double(*m)[3] = entity->matrix->m;
    struct vec3 nose = {m[0][0], m[1][0], m[2][0]};
    double to_east = vec3_dot(entity->velocity, east), to_north = vec3_dot(entity->velocity, north);
    event->speed_mps = sqrt(to_east * to_east + to_north * to_north);
    if (event->speed_mps < STANDS_MPS) {
        to_east = vec3_dot(nose, east);
        to_north = vec3_dot(nose, north);
    }
    event->course_deg = maths_wrap_turn(maths_atan2(to_east, to_north)) / RAD_PER_DEG;
}

void cot_output_send(struct cot_output *cot, const struct cot_output_entity *entity, bool gone)
{
    static const char affiliations[FORCE_COUNT] = {
        [FORCE_NEUTRAL] = 'n', [FORCE_BLUE] = 'f', [FORCE_RED] = 'h'};
    char xml[COT_EVENT_BYTES];
    struct cot_event event;
    struct timespec utc;
    if (entity->type->cot[0] == '\0' || entity->force >= FORCE_COUNT)
        return;
    clock_gettime(CLOCK_REALTIME, &utc);
    struct geodesy_place place = geodesy_place_of(entity->position);
    event.time_ms = utc.tv_sec * 1000 + utc.tv_nsec / 1000000;
    event.stale_ms = event.time_ms + COT_OUTPUT_STALE_S * 1000;
    event.latitude_deg = place.latitude_rad / RAD_PER_DEG;
    event.longitude_deg = place.longitude_rad / RAD_PER_DEG;
    event.height_m = place.height_m;
    event.error_m = ERROR_M;
    set_track(&event, entity, &place);
    (void)snprintf(event.uid, sizeof event.uid, "jolon.%u.%u.%u.%u", cot->exercise, entity->id.site,
                   entity->id.application, entity->id.entity);
    (void)snprintf(event.type, sizeof event.type, "a-%c-%s", affiliations[entity->force],
                   entity->type->cot);
    (void)snprintf(event.callsign, sizeof event.callsign, "%s", entity->callsign);
    udp_output_send(&cot->udp, xml,
                    gone ? cot_event_write_deletion(&event, xml, sizeof xml)
                         : cot_event_write(&event, xml, sizeof xml));
}
