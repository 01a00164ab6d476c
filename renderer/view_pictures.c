/* Drawing and output of the pictures of one frame. */
#include "renderer/render_session.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "renderer/image/upscale.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "renderer/view_pictures.h"
#include "renderer/chart/instruments.h"
#include "world/view_mode.h"

#include <stdio.h>
#include <string.h>

#define WARNING_INTERVAL_NS 10000000000ull
#define TEXTURE_S           0.001 /* about the time to make one terrain texture */
#define TEXTURE_SHARE       0.25  /* share of a picture's time for terrain textures */
#define TEXTURES_MIN        2u
#define TEXTURES_FIRST      64u
#define RATE_SHARE          0.1 /* weight of the latest interval in the average */
#define SIDE_LEAST          16u /* [pixel] of a reduced picture */

/* Returns the time of simulation to show [s]: that of the session, or by the clock. */
static double show_time(struct render_session *session, const struct frame_view *latest)
{
    if (session->at_s >= 0.0)
        return session->at_s;
    double rate = latest->head->paused != 0 ? 0.0 : latest->head->time_scale;
    return frame_interpolation_time(&session->clock, (double)clock_now_ns() / 1e9,
                                    frame_view_time_s(latest), world_dt_s(&session->view->world),
                                    rate);
}

struct frame_view view_pictures_frame(struct render_session *session, bool last)
{
    struct frame_view latest = render_session_frame_view(session, session->latest);
    if (last || !session->smooth)
        return latest;
    double newest_s = frame_view_time_s(&latest), show_s = show_time(session, &latest);
    if (session->snapshots_taken < 2)
        return latest;
    struct frame_view earlier = render_session_frame_view(session, 1 - session->latest);
    double passed_s = newest_s - frame_view_time_s(&earlier);
    double share = passed_s > 0.0 ? 1.0 - (newest_s - show_s) / passed_s : 1.0;
    return frame_interpolation_between(&session->interpolation, &earlier, &latest, share);
}

uint32_t view_pictures_vehicle(struct render_session *session, const struct frame_view *frame_view,
                               uint32_t vehicle)
{
    if (vehicle != 0)
        return entities_find(frame_view->entities, frame_view->head->used, vehicle);
    return follow_choose(&session->follow, frame_view, &session->effects, session->options.follow,
                         session->options.follow_given);
}

/* Sets the vehicle of each view: its own, or the one that the renderer follows. */
static void choose_vehicles(struct render_session *session, const struct frame_view *frame_view)
{
    uint32_t followed = view_pictures_vehicle(session, frame_view, 0);
    for (uint32_t i = 0; i < session->picture_count; i++) {
        struct view_picture *picture = &session->pictures[i];
        uint32_t own = SLOT_NONE;
        if (picture->spec.vehicle != 0)
            own = view_pictures_vehicle(session, frame_view, picture->spec.vehicle);
        picture->slot = own != SLOT_NONE ? own : followed;
    }
}

/* Writes the comment of a picture's file: the vehicle's statistics in this frame. */
static void describe(const struct view_picture *picture, const struct frame_view *frame_view,
                     char *comment, size_t bytes)
{
    if (picture->slot != SLOT_NONE) {
        struct statistics statistics;
        statistics_of(&statistics, frame_view, picture->slot);
        statistics_line(&statistics, comment, bytes);
    } else {
        snprintf(comment, bytes, "frame=%llu time_s=%.3f",
                 (unsigned long long)frame_view->head->frame, frame_view_time_s(frame_view));
    }
    size_t used = strlen(comment);
    int more =
        snprintf(comment + used, bytes - used, " view=%s", view_mode_name(picture->spec.mode));
    if (frame_view->ahead_s > 0.0) /* the picture is later than the frame */
        snprintf(comment + used + more, bytes - used - (size_t)more, " ahead_s=%.4f",
                 frame_view->ahead_s);
}

/* Writes the first view to the file of --snap, another view to "NAME-VIEW.png" beside it. */
static int write_snapshot(const struct render_session *session, const struct view_picture *picture,
                          const char *comment, struct error_text *error)
{
    const char *name = session->options.snap;
    if (picture == session->pictures)
        return picture_folder_file(name, &session->image, comment, error);
    char path[1024];
    const char *dot = strrchr(name, '.');
    if (dot == NULL || strchr(dot, '/') != NULL)
        dot = name + strlen(name);
    int length =
        snprintf(path, sizeof path, "%.*s-%s%s", (int)(dot - name), name, picture->spec.name, dot);
    if (length < 0 || (size_t)length >= sizeof path)
        return error_text_set(error, "--snap %s: the path is too long", name);
    return picture_folder_file(path, &session->image, comment, error);
}

static int output_picture(struct render_session *session, const struct view_picture *picture,
                          const struct frame_view *frame_view, struct error_text *error)
{
    char comment[512];
    describe(picture, frame_view, comment, sizeof comment);
    heartbeat_stage(session->heartbeat);
    if (session->outputs == NULL)
        return write_snapshot(session, picture, comment, error);
    return output_set_put(session->outputs, picture->spec.name, &session->image,
                          frame_view->head->frame, frame_view_time_s(frame_view), comment, error);
}

/* Returns the image that the scene is drawn into: the picture itself, or a smaller one. */
static struct image *canvas(struct render_session *session, struct image *complete,
                            const struct quality_control_level *level)
{
    if (level->quarters == 4)
        return complete;
    uint32_t width = complete->width * level->quarters / 4;
    uint32_t height = complete->height * level->quarters / 4;
    session->small.width = width > SIDE_LEAST ? width : SIDE_LEAST;
    session->small.height = height > SIDE_LEAST ? height : SIDE_LEAST;
    return &session->small;
}

/* Returns how many terrain textures a picture may make. At a high rate the textures are spread over
 * several pictures, so that no picture is late. The first makes few, so that it comes soon. */
static uint32_t texture_budget(const struct render_session *session, bool complete)
{
    if (complete || (!session->smooth && session->drawn != UINT64_MAX))
        return TERRAIN_TILES_ALL;
    if (!session->smooth)
        return TEXTURES_FIRST;
    double several = TEXTURE_SHARE / (session->options.fps * TEXTURE_S);
    return several > TEXTURES_MIN ? (uint32_t)several : TEXTURES_MIN;
}

static struct annotated_picture_source source_of(const struct render_session *session,
                                                 const struct view_picture *picture,
                                                 const struct frame_view *frame_view,
                                                 const struct camera *camera, double rate)
{
    return (struct annotated_picture_source){.frame_view = frame_view,
                                             .tracks = &session->tracks,
                                             .effects = &session->effects,
                                             .camera = camera,
                                             .slot = picture->slot,
                                             .fps = rate};
}

/* Aims the camera of a picture. That of a vehicle which nobody has named looks at what happens. */
static void aim(const struct render_session *session, struct view_picture *picture,
                const struct frame_view *frame_view, struct camera *camera)
{
    bool chosen = picture->spec.vehicle == 0 && session->options.follow == 0;
    if (chosen && picture->slot != SLOT_NONE) {
        struct follow_sight sight = follow_look(frame_view, &session->effects, picture->slot);
        view_camera_watch(&picture->view_camera, sight.heading_rad, sight.far_m);
    }
    view_camera_update(&picture->view_camera, &picture->camera_options, frame_view, picture->slot,
                       camera);
}

int view_pictures_camera(struct render_session *session, struct view_picture *picture,
                         const struct frame_view *frame_view,
                         const struct quality_control_level *level,
                         const struct view_picture_target *target, struct error_text *error)
{
    struct camera camera;
    struct image *drawn = canvas(session, target->image, level);
    picture->camera_options.width = drawn->width;
    picture->camera_options.height = drawn->height;
    aim(session, picture, frame_view, &camera);
    scene_build(&session->draw_list, &camera, &session->static_scene, frame_view,
                &session->effects);
    if (session->draw_list.omitted > 0 && log_due(&session->warned_ns, WARNING_INTERVAL_NS))
        log_warn("%u things in view are left out: more than a picture can hold",
                 session->draw_list.omitted);
    heartbeat_stage(session->heartbeat);
    if (session->draw.picture(session->draw.self, &session->draw_list, frame_view, drawn, error) !=
        0)
        return -1;
    heartbeat_stage(session->heartbeat);
    if (drawn != target->image)
        image_upscale(target->image, drawn);
    struct annotated_picture_source source =
        source_of(session, picture, frame_view, &camera, target->rate);
    if (target->annotated != NULL)
        annotated_picture_instruments(target->annotated, target->image, &source);
    return 0;
}

static int draw_camera(struct render_session *session, struct view_picture *picture,
                       const struct frame_view *frame_view,
                       const struct quality_control_level *level, struct error_text *error)
{
    const struct view_picture_target target = {
        .image = &session->image, .annotated = &session->annotated, .rate = session->rate};
    if (view_pictures_camera(session, picture, frame_view, level, &target, error) != 0)
        return -1;
    if (session->smooth)
        session->draw_list.texture_budget = RENDER_SESSION_TEXTURE_BUDGET;
    return 0;
}

/* Draws the map, with the triangle that the chase camera would see. */
static int draw_map(struct render_session *session, struct view_picture *picture,
                    const struct frame_view *frame_view, struct error_text *error)
{
    struct camera camera;
    picture->camera_options.view = VIEW_CHASE;
    picture->camera_options.width = session->image.width;
    picture->camera_options.height = session->image.height;
    aim(session, picture, frame_view, &camera);
    struct annotated_picture_source source =
        source_of(session, picture, frame_view, &camera, session->rate);
    if (annotated_picture_map(&session->annotated, &session->image, &source) != 0)
        return error_text_set(error, "no memory for the map");
    return 0;
}

static int draw_picture(struct render_session *session, struct view_picture *picture,
                        const struct frame_view *frame_view,
                        const struct quality_control_level *level, struct error_text *error)
{
    int failed = picture->spec.mode == VIEW_MAP
                     ? draw_map(session, picture, frame_view, error)
                     : draw_camera(session, picture, frame_view, level, error);
    if (failed)
        return -1;
    return output_picture(session, picture, frame_view, error);
}

void view_pictures_adjust_quality(struct quality_control *quality, uint64_t begun_ns,
                                  uint32_t count, const char *which, const char *object)
{
    uint64_t now_ns = clock_now_ns();
    double took_s = (double)(now_ns - begun_ns) / 1e9 * count;
    int change = quality_control_note(quality, took_s, (double)now_ns / 1e9);
    const struct quality_control_level *level = &quality_control_levels[quality->level];
    if (change != 0)
        log_info("pictures%s take %.1f of %.1f ms: draws %s%s, %.0f %% of the detail at %u %% of "
                 "the size",
                 which, 1e3 * quality->judged_s, 1e3 * quality->interval_s,
                 change < 0 ? "less" : "more", object, 100.0 * level->detail, 25 * level->quarters);
}

double view_pictures_rate(double rate, uint64_t interval_ns)
{
    double latest = (double)NS_PER_S / (double)interval_ns;
    return rate + (rate == 0.0 ? 1.0 : RATE_SHARE) * (latest - rate);
}

/* Measures the rate. A replayed video shows the rate at which it will be played. */
static void note_rate(struct render_session *session)
{
    uint64_t now_ns = clock_now_ns();
    if (session->at_s >= 0.0) {
        session->rate = session->options.fps;
    } else if (session->drawn_ns != 0) {
        session->rate = view_pictures_rate(session->rate, now_ns - session->drawn_ns);
    }
    session->drawn_ns = now_ns;
}

int view_pictures_draw(struct render_session *session, bool last, struct error_text *error)
{
    note_rate(session);
    struct frame_view frame_view = view_pictures_frame(session, last);
    /* An unchanged picture of a paused world is drawn once more, at full quality. */
    bool same =
        session->drawn == frame_view.head->frame && session->drawn_ahead_s == frame_view.ahead_s;
    bool complete = last || (same && frame_view.head->paused != 0);
    if (same && (session->drawn_complete || !complete))
        return 0;
    const struct quality_control_level *level =
        &quality_control_levels[complete ? 0 : session->quality.level];
    session->draw_list.detail = (float)level->detail;
    session->draw_list.texture_budget = texture_budget(session, complete);
    choose_vehicles(session, &frame_view);
    articulation_note(&session->articulation, &frame_view);
    for (uint32_t i = 0; i < session->picture_count; i++) {
        if (draw_picture(session, &session->pictures[i], &frame_view, level, error) != 0)
            return -1;
        heartbeat_stage(session->heartbeat);
    }
    session->drawn = frame_view.head->frame;
    session->drawn_ahead_s = frame_view.ahead_s;
    session->drawn_complete =
        level == quality_control_levels && session->draw_list.texture_budget == TERRAIN_TILES_ALL;
    if (!complete)
        view_pictures_adjust_quality(&session->quality, session->drawn_ns, 1, "", "");
    return 0;
}
