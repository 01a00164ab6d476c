/* The checks of each type's members. */
#include "ipc/topics/samples.h"

#include "ipc/segment/role.h"
#include "world/entity/entity.h"
#include "world/runtime/utf8.h"

#include "status.h"

#include <math.h>
#include <string.h>

/* Far beyond the numbers of any world, and safe for arithmetic. */
#define NUMBER_MAX 1e15
#define SIDE_MIN_M 1.0

/* Likewise for the courses of motions. */
#define RATE_MAX     1e4f
#define COURSE_MAX_S 60.0f

bool samples_number(double value)
{
    return fabs(value) <= NUMBER_MAX; /* false for NaN */
}

static bool amount(double value)
{
    return value >= 0.0 && value <= NUMBER_MAX;
}

static void clean(char *text)
{
    while (*text) {
        uint32_t code;
        size_t bytes = utf8_read(text, &code);
        if (bytes > 0 && utf8_visible(code))
            text += bytes;
        else
            *text++ = '?';
    }
}

static bool times(const jolon_Times *value)
{
    return amount(value->p50_ms) && amount(value->p99_ms) && amount(value->max_ms);
}

static bool good_world(jolon_WorldInfo *world)
{
    bool good = world->hz > 0.0 && amount(world->hz) && world->side_m >= SIDE_MIN_M &&
                amount(world->side_m) && fabs(world->latitude_deg) <= 90.0 &&
                fabs(world->longitude_deg) <= 180.0 && world->kinds._length <= 64;
    for (uint32_t i = 0; good && i < jolon_MAP_CELLS; i++)
        good = samples_number((double)world->height_m[i]);
    for (uint32_t i = 0; good && i < world->kinds._length; i++) {
        jolon_KindInfo *kind = &world->kinds._buffer[i];
        clean(kind->name);
        good = kind->domain <= jolon_DOMAIN_FIXED && samples_number((double)kind->length_m) &&
               samples_number((double)kind->max_speed_mps) &&
               samples_number((double)kind->range_m) && samples_number((double)kind->fuel_l);
    }
    clean(world->world);
    clean(world->ground);
    clean(world->scenario);
    return good;
}

static bool good_names(jolon_EntityNames *names)
{
    for (uint32_t i = 0; i < names->names._length; i++) {
        clean(names->names._buffer[i].name);
        if (i > 0 && names->names._buffer[i].id <= names->names._buffer[i - 1].id)
            return false; /* binary search needs this order */
    }
    return names->names._length <= jolon_NAMES_MAX;
}

static bool good_process(const jolon_ProcessStatus *status)
{
    return role_find(status->role) != ROLE_NONE && status->state <= jolon_PROCESS_DEAD &&
           amount(status->beat_age_ms) && amount(status->stage_ms) &&
           amount(status->stage_p50_ms) && amount(status->stage_p99_ms) &&
           amount(status->stage_max_ms);
}

static bool good_frame(const jolon_FrameStatus *frame)
{
    return amount(frame->sim_time_s) && frame->state <= jolon_RUN_STALLED && amount(frame->hz) &&
           amount(frame->rate_hz) && amount(frame->time_scale) && times(&frame->frame_time) &&
           times(&frame->mover_time) && times(&frame->collider_time) && times(&frame->recent);
}

static bool good_entity(const jolon_Entity *entity)
{
    const float numbers[] = {
        entity->vx_mps,    entity->vy_mps,   entity->vz_mps,     entity->heading_rad,
        entity->pitch_rad, entity->roll_rad, entity->turret_rad, entity->gun_rad,
        entity->fuel_l,    entity->throttle, entity->spool,      entity->reload_s,
    };
    bool good = entity->state <= jolon_ENTITY_WRECK && entity->force <= jolon_FORCE_RED &&
                entity->behaviour <= jolon_BEHAVIOUR_REMOTE &&
                entity->damage <= jolon_DAMAGE_DESTROYED && entity->gear <= jolon_GEAR_LOW &&
                samples_number(entity->x_m) && samples_number(entity->y_m) &&
                samples_number(entity->z_m);
    for (size_t i = 0; good && i < sizeof numbers / sizeof numbers[0]; i++)
        good = samples_number((double)numbers[i]);
    return good;
}

static bool degrees(const jolon_Degrees *value)
{
    return fabs(value->latitude_deg) <= 90.0 && fabs(value->longitude_deg) <= 180.0;
}

static bool good_batch(const jolon_EntityBatch *batch)
{
    bool good = batch->part < batch->parts && amount(batch->sim_time_s) &&
                batch->total <= CAPACITY_MAX && batch->entities._length <= batch->total;
    for (uint32_t i = 0; good && i < batch->entities._length; i++)
        good = good_entity(&batch->entities._buffer[i]);
    /* Reporters of older builds send no places. */
    good = good && (batch->places._length == 0 || batch->places._length == batch->entities._length);
    for (uint32_t i = 0; good && i < batch->places._length; i++)
        good = degrees(&batch->places._buffer[i]);
    return good;
}

static bool good_course(const jolon_Course *course)
{
    const float rates[] = {course->turn_rps, course->pitch_rps, course->roll_rps, course->gain_mps2,
                           course->climb_mps2};
    bool good = course->lasts_s >= 0.0F && course->lasts_s <= COURSE_MAX_S;
    for (size_t i = 0; good && i < sizeof rates / sizeof rates[0]; i++)
        good = fabsf(rates[i]) <= RATE_MAX;
    return good;
}

static bool good_motions(const jolon_MotionBatch *batch)
{
    const uint32_t count = batch->entities._length, *rows = batch->rows._buffer;
    bool good =
        batch->part < batch->parts && amount(batch->sim_time_s) && count == batch->rows._length;
    for (uint32_t i = 0; good && i < count; i++)
        good = good_entity(&batch->entities._buffer[i]) && rows[i] < CAPACITY_MAX &&
               (i == 0 || rows[i] > rows[i - 1]);
    for (uint32_t i = 0; good && i < batch->courses._length; i++) {
        const jolon_Course *course = &batch->courses._buffer[i];
        good = good_course(course) && course->entity < count &&
               (i == 0 || course->entity > course[-1].entity);
    }
    return good;
}

static bool party(jolon_Party *value)
{
    clean(value->kind);
    return value->damage <= jolon_DAMAGE_DESTROYED;
}

static bool point(const jolon_Point *value)
{
    return samples_number(value->x_m) && samples_number(value->y_m) && samples_number(value->z_m);
}

static bool place(const jolon_Degrees *value, char *mgrs)
{
    clean(mgrs);
    return degrees(value);
}

static bool direction(const jolon_Direction *value)
{
    return samples_number((double)value->x) && samples_number((double)value->y) &&
           samples_number((double)value->z);
}

static bool good_collision(jolon_CollisionEvent *event)
{
    return party(&event->a) && party(&event->b) && point(&event->point) &&
           direction(&event->normal) && direction(&event->direction) &&
           samples_number(event->toi) && samples_number((double)event->closing_mps) &&
           samples_number((double)event->angle_deg) && samples_number((double)event->impulse_ns) &&
           event->response <= jolon_RESPONSE_DESTROYED && place(&event->degrees, event->mgrs);
}

static bool good_fire(jolon_FireEvent *event)
{
    return party(&event->shooter) && party(&event->target) && party(&event->munition) &&
           point(&event->point) && place(&event->degrees, event->mgrs);
}

static bool good_detonation(jolon_DetonationEvent *event)
{
    return party(&event->munition) && party(&event->victim) && point(&event->point) &&
           samples_number((double)event->explosive_kg) && event->struck <= jolon_STRUCK_AIR &&
           place(&event->degrees, event->mgrs);
}

static bool good_crater(jolon_CraterEvent *event)
{
    return point(&event->point) && amount((double)event->radius_m) &&
           amount((double)event->depth_m) && place(&event->degrees, event->mgrs);
}

static bool good_agent(jolon_AgentEvent *event)
{
    return party(&event->agent) && event->before <= jolon_BEHAVIOUR_REMOTE &&
           event->after <= jolon_BEHAVIOUR_REMOTE && event->because <= jolon_REASON_LEFT_WORLD;
}

static bool good_contact_end(jolon_ContactEndEvent *event)
{
    return party(&event->a) && party(&event->b) && amount(event->lasted_s) &&
           samples_number((double)event->impulse_ns) && event->because <= jolon_CONTACT_END_NO_ROOM;
}

static bool good_event(const jolon_EventHeader *header)
{
    return amount(header->time_s) && header->previous <= header->sequence;
}

bool samples_good(enum dds_topic topic, void *sample)
{
    switch (topic) {
    case TOPIC_WORLD:
        return good_world(sample);
    case TOPIC_NAMES:
        return good_names(sample);
    case TOPIC_PROCESS:
        return good_process(sample);
    case TOPIC_FRAME:
        return good_frame(sample);
    case TOPIC_ENTITIES:
        return good_batch(sample);
    case TOPIC_MOTIONS:
        return good_motions(sample);
#define X(tag, word)                                                                               \
    case TOPIC_##tag:                                                                              \
        return good_event(sample) && good_##word(sample);
        EVENT_TYPES_WITH_TOPIC(X)
#undef X
    case TOPIC_COMMAND:
    case TOPIC_REPLY:
    case TOPIC_COUNT:
        break;
    }
    return false;
}

bool samples_next(struct samples *samples)
{
    dds_sample_info_t info;
    for (;;) {
        if (samples->sample)
            (void)dds_return_loan(samples->reader, &samples->sample, 1);
        samples->sample = NULL;
        if (dds_take(samples->reader, &samples->sample, &info, 1, 1) <= 0)
            return false;
        samples->writer = info.publication_handle;
        if (info.valid_data && samples_good(samples->topic, samples->sample))
            return true;
    }
}
