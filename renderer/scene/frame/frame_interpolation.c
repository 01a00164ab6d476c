/* Interpolates between two frames. */
#include "renderer/scene/frame/frame_interpolation.h"

#include "world/world.h"

#include <stdlib.h>

#define JUMP_SHARE  2.0  /* a body moves at most this many times as far as its speed says ... */
#define JUMP_M      2.0  /* ... plus this; otherwise it jumped */
#define LATE_STEPS  4.0  /* after such a delay the clock starts anew */
#define EARLY_DRIFT 0.1  /* share of the difference made up when a frame is early */
#define LATE_DRIFT  0.05 /* share of the delay beyond one step made up */

int frame_interpolation_init(struct frame_interpolation *interpolation, uint32_t capacity)
{
    *interpolation = (struct frame_interpolation){
        .entities = {capacity, calloc(capacity, sizeof(struct entity))}};
    return interpolation->entities.row == NULL ? -1 : 0;
}

void frame_interpolation_free(struct frame_interpolation *interpolation)
{
    free(interpolation->entities.row);
    interpolation->entities.row = NULL;
}

/* Returns true if both rows are the same body in the same state and it has not jumped. */
static bool is_continuous(const struct entities *a, const struct entities *b, uint32_t i,
                          double passed_s)
{
    if (a->row[i].state == ENTITY_FREE || a->row[i].id != b->row[i].id ||
        a->row[i].state != b->row[i].state)
        return false;
    double speed =
        maths_max(vec3_length(entities_velocity(a, i)), vec3_length(entities_velocity(b, i)));
    double distance = vec3_length(vec3_sub(entities_position(b, i), entities_position(a, i)));
    return distance <= JUMP_SHARE * speed * passed_s + JUMP_M;
}

/* Interpolates an angle along the shorter arc. */
static double turn_between(double a, double b, double share)
{
    return a + maths_wrap_half(b - a) * share;
}

static void interpolate_row(const struct entities *to, const struct entities *a,
                            const struct entities *b, uint32_t i, double share)
{
    entities_set_position(to, i,
                          vec3_lerp(entities_position(a, i), entities_position(b, i), share));
    to->row[i].heading = maths_wrap_turn(turn_between(a->row[i].heading, b->row[i].heading, share));
    to->row[i].pitch = turn_between(a->row[i].pitch, b->row[i].pitch, share);
    to->row[i].roll = turn_between(a->row[i].roll, b->row[i].roll, share);
}

struct frame_view frame_interpolation_between(struct frame_interpolation *interpolation,
                                              const struct frame_view *earlier,
                                              const struct frame_view *later, double share)
{
    double passed_s = frame_view_time_s(later) - frame_view_time_s(earlier);
    double most_s = FRAME_INTERPOLATION_STEPS_MAX * world_dt_s(earlier->world);
    if (!(share < 1.0) || passed_s <= 0.0 || passed_s > most_s)
        return *later;
    if (share <= 0.0)
        return *earlier;
    const struct entities *a = earlier->entities, *b = later->entities;
    entities_copy(&interpolation->entities, a, 0, earlier->head->used);
    for (uint32_t i = 0; i < earlier->head->used; i++) {
        bool goes_on = i < later->head->used && is_continuous(a, b, i, passed_s);
        interpolate_row(&interpolation->entities, a, goes_on ? b : a, i, share);
    }
    struct frame_view between = *earlier;
    between.entities = &interpolation->entities;
    between.ahead_s += share * passed_s;
    return between;
}

/* Lets the clock run on, or begins it anew. ahead_s: of the newest frame. */
static void follow_world(struct frame_interpolation_clock *clock, double ahead_s, double step_s,
                         double rate)
{
    double late_s = clock->ahead_s - ahead_s;
    if (!clock->set || rate != clock->rate || fabs(late_s) > LATE_STEPS * step_s)
        clock->ahead_s = ahead_s;
    else if (late_s < 0.0)
        clock->ahead_s -= EARLY_DRIFT * late_s;
    else if (late_s > step_s) /* a delay of up to one step may be a late look at the frame */
        clock->ahead_s -= LATE_DRIFT * (late_s - step_s);
    clock->set = true;
    clock->rate = rate;
}

double frame_interpolation_time(struct frame_interpolation_clock *clock, double now_s,
                                double newest_s, double step_s, double rate)
{
    double show_s = newest_s;
    if (rate > 0.0) {
        follow_world(clock, newest_s - rate * now_s, step_s, rate);
        show_s = maths_max(clock->shown_s, rate * now_s + clock->ahead_s - step_s);
    } else {
        clock->set = false;
    }
    clock->shown_s = maths_min(newest_s, show_s);
    return clock->shown_s;
}
