/* Counts what agents collide with when nobody fires at them: on the Hunter-Liggett world without
 * ammunition, or on its ground with any number of vehicles on patrol. Agents that hold their course
 * are left out, because their collisions are intended. */
#include "tests/bench/bench.h"
#include "tests/bench/world.h"

#include "collider/narrow_phase/narrow_phase.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "recorder/replay/frame_stepper.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

struct traffic {
    uint64_t fixed, bushes, vehicles, surface; /* collisions of agents, by what they met */
    double hours;                              /* total time that agents were alive */
};

static bool counts(const struct entities *e, uint32_t row)
{
    return e->row[row].state == ENTITY_ACTIVE && e->row[row].behaviour != BEHAVIOUR_HOLD &&
           e->row[row].behaviour != BEHAVIOUR_FLIGHT;
}

static void disarm(const struct view *view)
{
    const struct entities *e = &view->w[0].entities;
    for (uint32_t i = 0; i < view->w[0].head->used; i++) {
        e->row[i].rounds = 0;
        e->row[i].flags &= (uint8_t)~ENTITY_FLAG_FIRE_AT_WILL;
    }
}

static void take(const struct view *view, const struct state *state, uint64_t from,
                 struct traffic *traffic)
{
    const struct entities *e = &state->entities;
    for (uint32_t i = 0; i < state->head->used; i++)
        traffic->hours += counts(e, i) ? world_dt_s(&view->world) / 3600.0 : 0.0;
    for (uint64_t n = from; n < state->head->event_end; n++) {
        const struct event *event = &view->events[n & (view->header->event_slots - 1)];
        if (event->type != EVENT_COLLISION)
            continue;
        uint32_t row = entities_find(e, state->head->used, event->collision.a.id);
        if (row == SLOT_NONE || e->row[row].behaviour == BEHAVIOUR_HOLD)
            continue;
        const struct event_party *other = &event->collision.b;
        if (other->fixed && view->world.kinds[other->kind].rigidity < YIELDING_RIGIDITY)
            traffic->bushes++;
        else if (other->fixed)
            traffic->fixed++;
        else if (other->id != 0)
            traffic->vehicles++;
        else
            traffic->surface++;
    }
}

int bench_traffic(struct bench_options options)
{
    struct view view;
    struct frame_stepper stepper;
    struct traffic traffic = {0, 0, 0, 0, 0.0};
    bench_world_open(&view, NULL, options.vehicles);
    disarm(&view);
    if (frame_stepper_init(&stepper, &view, options.threads) != 0)
        die_refused("cannot begin: %s", strerror(errno));
    for (uint32_t i = 0; i < options.frames; i++) {
        uint64_t from = view.w[i & 1].head->event_end;
        frame_stepper_step(&stepper, NULL);
        take(&view, &view.w[(i + 1) & 1], from, &traffic);
    }
    frame_stepper_free(&stepper);
    double all = (double)(traffic.fixed + traffic.vehicles + traffic.surface);
    printf(options.json ? "{\"vehicle_hours\":%.3f,\"fixed\":%llu,\"vehicles\":%llu,"
                          "\"surface\":%llu,\"an_hour\":%.4f,\"bushes\":%llu}\n"
                        : "%.1f vehicle-hours: %llu collisions with fixed objects, %llu with "
                          "vehicles, %llu with ground or water; %.3f a vehicle-hour; and %llu with "
                          "bushes\n",
           traffic.hours, (unsigned long long)traffic.fixed, (unsigned long long)traffic.vehicles,
           (unsigned long long)traffic.surface, all / maths_max(traffic.hours, 1e-9),
           (unsigned long long)traffic.bushes);
    segment_abandon(&view);
    return EXIT_OK;
}
