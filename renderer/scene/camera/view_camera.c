/* The cameras of the views. */
#include "renderer/scene/camera/view_camera.h"

#include "renderer/scene/camera/crew_eye.h"
#include "renderer/scene/frame/articulation.h"
#include "renderer/scene/frame/body_axes.h"
#include "world/entity/kind.h"
#include "world/view_mode.h"
#include "world/terrain/gridsquare.h"
#include "world/world.h"

#define TANK_RADIUS_M 3.0 /* body radius for which the lengths below hold */
#define SCALE_MIN     0.75
#define SCALE_MAX     12.0

#define CHASE_BACK_M      25.0
#define CHASE_UP_M        9.0
#define CHASE_BEYOND_M    23.0 /* the camera looks at a point this far ahead of the vehicle */
#define CHASE_ASIDE_RAD   0.24 /* slightly from the side: straight from behind a body looks flat */
#define CHASE_PITCH_SHARE 0.5  /* share of the vehicle's pitch that the camera follows */
#define EASE_TURN_S       0.5  /* time after which a third of a turn is left */
#define EASE_WATCH_S      1.5  /* the same for a camera that looks at what happens */
#define WATCH_AWAY        1.7 /* at least so many times as far away, through a lens as much longer */
#define WATCH_AWAY_MAX    4.0
#define WATCH_M           280.0 /* what is so far away is as large as it would be beside the camera */
#define EASE_LIFT_S       0.4

#define ORBIT_AWAY_M  22.0
#define ORBIT_UP_M    8.0
#define OVERHEAD_UP_M 90.0
#define STAND_AHEAD_M 38.0 /* of a free camera without a given pose */
#define STAND_ASIDE_M 16.0
#define STAND_UP_M    6.0
#define INSIDE_NEAR_M 0.3
#define INSIDE_MIN_M  0.5 /* above the ground, for low seats and overturned vehicles */

#define SIGHT_SAMPLES     12
#define SIGHT_CLEARANCE_M 1.0
#define LATE_S            1.5  /* after this long without a picture ... */
#define JUMP_M            25.0 /* ... or this far off its path, the camera starts anew */
#define OVERLOOK_M        60.0 /* above the middle of the world, when there is no vehicle */

struct subject {
    struct vec3 position;
    double heading_rad, pitch_rad;
    double scale; /* size relative to a tank */
    double away;  /* how many times as far away the camera is */
};

static struct subject subject_of(const struct frame_view *frame_view, uint32_t slot)
{
    const struct entities *e = frame_view->entities;
    double middle = 0.5 * frame_view->world->terrain.squares.world_m;
    if (slot == SLOT_NONE) {
        double ground = terrain_height(&frame_view->world->terrain, NULL, middle, middle);
        return (struct subject){
            .position = {middle, ground, middle}, .scale = OVERLOOK_M / CHASE_UP_M, .away = 1.0};
    }
    double radius = frame_view->world->kinds[e->row[slot].kind].radius_m;
    return (struct subject){
        .position = entities_position(e, slot),
        .heading_rad = e->row[slot].heading,
        .pitch_rad = e->row[slot].pitch,
        .scale = maths_clamp(radius / TANK_RADIUS_M, SCALE_MIN, SCALE_MAX),
        .away = 1.0,
    };
}

/* Returns the share of a difference that is left after a time, close to exp(-t / ease). */
static double left_after(double t_s, double ease_s)
{
    double x = t_s / ease_s;
    return 1.0 / (1.0 + x * (1.0 + x * (0.5 + x / 6.0)));
}

/* Returns the simulation time since the last picture [s], or INFINITY if the camera starts anew. */
static double since_last(const struct view_camera *state, const struct frame_view *frame_view,
                         uint32_t slot, const struct subject *subject)
{
    const struct entities *e = frame_view->entities;
    double passed = frame_view_time_s(frame_view) - state->time_s;
    if (slot == SLOT_NONE || state->id != e->row[slot].id || passed < 0.0 || passed > LATE_S)
        return INFINITY;
    struct vec3 gone = vec3_scale(entities_velocity(e, slot), passed);
    struct vec3 off = vec3_sub(subject->position, vec3_add(state->position, gone));
    return vec3_length(off) < JUMP_M + vec3_length(gone) ? passed : INFINITY;
}

static void remember(struct view_camera *state, const struct frame_view *frame_view, uint32_t slot,
                     const struct subject *subject)
{
    state->id = slot == SLOT_NONE ? 0 : frame_view->entities->row[slot].id;
    state->time_s = frame_view_time_s(frame_view);
    state->position = subject->position;
}

static double floor_at(const struct frame_view *frame_view, struct vec3 at, double clearance_m)
{
    return terrain_height(&frame_view->world->terrain, frame_view->craters, at.x, at.z) +
           clearance_m;
}

/* Returns how far the eye must rise to see the subject over the ground between them. */
static double lift_over(const struct frame_view *frame_view, struct vec3 eye, struct vec3 subject)
{
    double before = eye.y;
    eye.y = maths_max(eye.y, floor_at(frame_view, eye, VIEW_CAMERA_CLEARANCE_M));
    for (int32_t i = 1; i < SIGHT_SAMPLES; i++) {
        double t = (double)i / SIGHT_SAMPLES; /* 0 at the eye, 1 at the subject */
        struct vec3 on = vec3_lerp(eye, subject, t);
        double ground = floor_at(frame_view, on, SIGHT_CLEARANCE_M * (1.0 - t));
        if (on.y < ground)
            eye.y += (ground - on.y) / (1.0 - t);
    }
    return eye.y - before;
}

/* Lifts the eye smoothly, but at once where it would be under the ground. */
static void lift(struct view_camera *state, const struct frame_view *frame_view,
                 const struct subject *subject, double passed_s, struct vec3 *eye)
{
    double wanted = lift_over(frame_view, *eye, subject->position);
    state->lift_m = wanted + (state->lift_m - wanted) * left_after(passed_s, EASE_LIFT_S);
    eye->y = maths_max(eye->y + state->lift_m, floor_at(frame_view, *eye, VIEW_CAMERA_CLEARANCE_M));
}

/* --- views ------------------------------------------------------------------------------------ */

static void chase(struct view_camera *state, const struct frame_view *frame_view,
                  const struct subject *subject, double passed_s, struct vec3 *eye,
                  struct vec3 *target)
{
    double scale = subject->scale;
    double back = CHASE_BACK_M * scale * subject->away;
    double beyond = CHASE_BEYOND_M * scale * subject->away;
    double left = left_after(passed_s, state->watches ? EASE_WATCH_S : EASE_TURN_S);
    double tilt = CHASE_PITCH_SHARE * subject->pitch_rad;
    state->tilt_rad = tilt + (state->tilt_rad - tilt) * left;
    state->heading_rad =
        subject->heading_rad + maths_wrap_half(state->heading_rad - subject->heading_rad) * left;
    double sine, cosine, rise = maths_sin(state->tilt_rad);
    struct vec3 p = subject->position;
    maths_sincos(state->heading_rad + CHASE_ASIDE_RAD / subject->away, &sine, &cosine);
    *eye = (struct vec3){p.x - sine * back, p.y + CHASE_UP_M * scale - back * rise,
                         p.z + cosine * back};
    maths_sincos(state->heading_rad, &sine, &cosine);
    *target =
        (struct vec3){p.x + sine * beyond, p.y + scale + beyond * rise, p.z - cosine * beyond};
    lift(state, frame_view, subject, passed_s, eye);
    /* From high above the camera looks at the vehicle itself, which would otherwise leave the
     * picture. */
    double high = maths_max(state->lift_m, 0.0);
    *target = vec3_lerp(*target, p, high / (high + CHASE_UP_M * scale));
}

static void orbit(struct view_camera *state, const struct frame_view *frame_view,
                  const struct subject *subject, double passed_s, struct vec3 *eye,
                  struct vec3 *target)
{
    double sine, cosine, scale = subject->scale,
                         turns = frame_view_time_s(frame_view) / VIEW_CAMERA_ORBIT_S;
    struct vec3 p = subject->position;
    maths_sincos(TWO_PI * (turns - floor(turns)), &sine, &cosine);
    *eye = (struct vec3){p.x + sine * ORBIT_AWAY_M * scale, p.y + ORBIT_UP_M * scale,
                         p.z - cosine * ORBIT_AWAY_M * scale};
    *target = (struct vec3){p.x, p.y + scale, p.z};
    lift(state, frame_view, subject, passed_s, eye);
}

/* Places the camera beside the path ahead of the vehicle, which will pass it. */
static void stand_beside(struct view_camera *state, const struct frame_view *frame_view,
                         const struct subject *subject)
{
    double sine, cosine, scale = subject->scale;
    struct vec3 p = subject->position;
    maths_sincos(subject->heading_rad, &sine, &cosine);
    double along = STAND_AHEAD_M * scale, aside = STAND_ASIDE_M * scale;
    state->eye = (struct vec3){p.x + sine * along + cosine * aside, p.y + STAND_UP_M * scale,
                               p.z - cosine * along + sine * aside};
    state->eye.y += lift_over(frame_view, state->eye, p);
    state->target = (struct vec3){p.x, p.y + scale, p.z};
}

static void free_camera(struct view_camera *state, const struct view_camera_options *options,
                        const struct frame_view *frame_view, const struct subject *subject,
                        const struct camera_lens *lens, struct camera *camera)
{
    const struct view_camera_pose *pose = &options->pose;
    if (!pose->given) {
        if (!state->placed)
            stand_beside(state, frame_view, subject);
        state->placed = true;
        /* A new crater may have changed the ground. */
        struct vec3 eye = state->eye;
        eye.y = maths_max(eye.y, floor_at(frame_view, eye, VIEW_CAMERA_EYE_M));
        camera_look_through(camera, eye, state->target, lens);
        return;
    }
    struct vec3 eye = {pose->x, 0.0, pose->z};
    eye.y = floor_at(frame_view, eye, maths_max(pose->above_m, VIEW_CAMERA_EYE_M));
    struct body_axes axes = body_axes_of(pose->heading_rad, pose->pitch_rad, 0.0);
    camera_turn(camera, eye, axes.forward, axes.up, lens);
}

static void inside(const struct frame_view *frame_view, uint32_t slot,
                   const struct camera_lens *lens, struct camera *camera)
{
    const struct entities *e = frame_view->entities;
    struct crew_eye_seat seat =
        crew_eye_seat(frame_view->world, &frame_view->world->kinds[e->row[slot].kind]);
    struct vec3 at = seat.eye;
    struct body_axes axes =
        body_axes_of(e->row[slot].heading, e->row[slot].pitch, e->row[slot].roll);
    struct vec3 eye = vec3_add(entities_position(e, slot), vec3_scale(axes.forward, at.x));
    eye = vec3_add(eye, vec3_add(vec3_scale(axes.up, at.y), vec3_scale(axes.right, at.z)));
    eye.y = maths_max(eye.y, floor_at(frame_view, eye, INSIDE_MIN_M));
    double sine, cosine;
    double turned =
        seat.turns ? (double)articulation_of(frame_view->articulation, frame_view, slot).turret_rad
                   : 0.0;
    maths_sincos(turned, &sine, &cosine);
    struct vec3 ahead = vec3_add(vec3_scale(axes.forward, cosine), vec3_scale(axes.right, sine));
    ahead = vec3_sub(ahead, vec3_scale(axes.up, seat.down));
    camera_turn(camera, eye, ahead, axes.up, lens);
}

void view_camera_watch(struct view_camera *state, double heading_rad, double far_m)
{
    state->watches = true;
    state->watch_rad = heading_rad;
    state->watch_m = far_m;
}

/* Turns the subject to what its camera watches, and takes the longer lens. */
static void watch(struct view_camera *state, double passed_s, struct subject *subject,
                  struct camera_lens *lens)
{
    if (!state->watches)
        return;
    double away = maths_clamp(state->watch_m / WATCH_M, WATCH_AWAY, WATCH_AWAY_MAX);
    state->away = away + (state->away - away) * left_after(passed_s, EASE_WATCH_S);
    subject->pitch_rad *= maths_cos(state->watch_rad - subject->heading_rad);
    subject->heading_rad = state->watch_rad;
    subject->away = state->away;
    double sine, cosine;
    maths_sincos(0.5 * lens->field_rad, &sine, &cosine);
    lens->field_rad = 2.0 * maths_atan2(sine, state->away * cosine);
}

void view_camera_update(struct view_camera *state, const struct view_camera_options *options,
                        const struct frame_view *frame_view, uint32_t slot, struct camera *camera)
{
    struct camera_lens lens = {options->field_rad, CAMERA_NEAR_M, options->width, options->height};
    struct subject subject = subject_of(frame_view, slot);
    double passed_s = since_last(state, frame_view, slot, &subject);
    struct vec3 eye, target;
    remember(state, frame_view, slot, &subject);
    switch (slot == SLOT_NONE && options->view != VIEW_FREE ? VIEW_CHASE : options->view) {
    case VIEW_INSIDE:
        lens.near_m = INSIDE_NEAR_M;
        inside(frame_view, slot, &lens, camera);
        return;
    case VIEW_FREE:
        free_camera(state, options, frame_view, &subject, &lens, camera);
        return;
    case VIEW_OVERHEAD:
        target = subject.position;
        eye = (struct vec3){target.x, target.y + OVERHEAD_UP_M * subject.scale, target.z};
        eye.y = maths_max(eye.y, floor_at(frame_view, eye, VIEW_CAMERA_CLEARANCE_M));
        break;
    case VIEW_ORBIT:
        orbit(state, frame_view, &subject, passed_s, &eye, &target);
        break;
    default:
        watch(state, passed_s, &subject, &lens);
        chase(state, frame_view, &subject, passed_s, &eye, &target);
        break;
    }
    state->watches = false;
    camera_look_through(camera, eye, target, &lens);
}
