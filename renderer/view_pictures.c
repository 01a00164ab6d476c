/* The pictures of one moment: each view drawn, its words put on it, and given away. */
#include "renderer/render_session.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "renderer/image/upscale.h"
#include "renderer/scene/terrain/terrain_tiles.h"
#include "world/enum_names.h"
#include "renderer/view_pictures.h"
#include "renderer/chart/instruments.h"

#include <stdio.h>
#include <string.h>

#define COMPLAINT_NS 10000000000ull
#define PAINT_S      0.001 /* about what one tile of the ground takes */
#define PAINT_SHARE  0.25  /* of a picture's time for it */
#define PAINT_LEAST  2u
#define PAINT_FIRST  64u
#define RATE_SHARE   0.1 /* of the latest interval in the rate that is shown */
#define SIDE_LEAST   16u /* [pixel] of a picture that is drawn smaller */

/* Time of simulation to show: as it was asked for, or by the clock. */
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
    if (session->whole < 2)
        return latest;
    struct frame_view earlier = render_session_frame_view(session, 1 - session->latest);
    double passed_s = newest_s - frame_view_time_s(&earlier);
    double share = passed_s > 0.0 ? 1.0 - (newest_s - show_s) / passed_s : 1.0;
    return frame_interpolation_between(&session->interpolation, &earlier, &latest, share);
}

uint32_t view_pictures_vehicle(struct render_session *session, const struct frame_view *moment,
                               uint32_t vehicle)
{
    if (vehicle != 0)
        return entities_find(moment->entities, moment->head->used, vehicle);
    return follow_choose(&session->follow, moment, &session->effects, session->options.follow,
                         session->options.follow_given);
}

/* The vehicle of each view: its own, or the one that the renderer follows. */
static void choose_vehicles(struct render_session *session, const struct frame_view *moment)
{
    uint32_t followed = view_pictures_vehicle(session, moment, 0);
    for (uint32_t i = 0; i < session->picture_count; i++) {
        struct view_picture *picture = &session->pictures[i];
        uint32_t own = SLOT_NONE;
        if (picture->wish.vehicle != 0)
            own = view_pictures_vehicle(session, moment, picture->wish.vehicle);
        picture->slot = own != SLOT_NONE ? own : followed;
    }
}

/* What is stored with the picture: the vehicle's figures as they are in it. */
static void describe(const struct view_picture *picture, const struct frame_view *moment,
                     char *words, size_t bytes)
{
    if (picture->slot != SLOT_NONE) {
        struct statistics statistics;
        statistics_of(&statistics, moment, picture->slot);
        statistics_line(&statistics, words, bytes);
    } else {
        snprintf(words, bytes, "frame=%llu time_s=%.3f", (unsigned long long)moment->head->frame,
                 frame_view_time_s(moment));
    }
    size_t used = strlen(words);
    int more = snprintf(words + used, bytes - used, " view=%s", view_mode_name(picture->wish.mode));
    if (moment->ahead_s > 0.0) /* the picture is so much later than the frame */
        snprintf(words + used + more, bytes - used - (size_t)more, " ahead_s=%.4f",
                 moment->ahead_s);
}

/* The first view goes where --snap says; others have their names before its ending. */
static int put_file(const struct render_session *session, const struct view_picture *picture,
                    const char *words, struct error_text *error)
{
    const char *name = session->options.snap;
    if (picture == session->pictures)
        return picture_folder_file(name, &session->image, words, error);
    char path[1024];
    const char *dot = strrchr(name, '.');
    if (dot == NULL || strchr(dot, '/') != NULL)
        dot = name + strlen(name);
    int length =
        snprintf(path, sizeof path, "%.*s-%s%s", (int)(dot - name), name, picture->wish.name, dot);
    if (length < 0 || (size_t)length >= sizeof path)
        return error_text_set(error, "--snap %s: the path is too long", name);
    return picture_folder_file(path, &session->image, words, error);
}

static int put_out(struct render_session *session, const struct view_picture *picture,
                   const struct frame_view *moment, struct error_text *error)
{
    char words[512];
    describe(picture, moment, words, sizeof words);
    heartbeat_stage(session->heartbeat);
    if (session->outputs == NULL)
        return put_file(session, picture, words, error);
    return output_set_put(session->outputs, picture->wish.name, &session->image,
                          moment->head->frame, frame_view_time_s(moment), words, error);
}

/* Where the scene is drawn: the picture itself, or a smaller one. */
static struct image *canvas(struct render_session *session, struct image *whole,
                            const struct quality_control_level *level)
{
    if (level->quarters == 4)
        return whole;
    uint32_t width = whole->width * level->quarters / 4;
    uint32_t height = whole->height * level->quarters / 4;
    session->small.width = width > SIDE_LEAST ? width : SIDE_LEAST;
    session->small.height = height > SIDE_LEAST ? height : SIDE_LEAST;
    return &session->small;
}

/* At a high rate the ground is painted over several pictures, so that none comes late; and a
 * renderer that begins shows its first soon. */
static uint32_t paintings_of(const struct render_session *session, bool whole)
{
    if (whole || (!session->smooth && session->drawn != UINT64_MAX))
        return TERRAIN_TILES_ALL;
    if (!session->smooth)
        return PAINT_FIRST;
    double several = PAINT_SHARE / (session->options.fps * PAINT_S);
    return several > PAINT_LEAST ? (uint32_t)several : PAINT_LEAST;
}

static struct annotated_picture_source source_of(const struct render_session *session,
                                                 const struct view_picture *picture,
                                                 const struct frame_view *moment,
                                                 const struct camera *camera, double rate)
{
    return (struct annotated_picture_source){.moment = moment,
                                             .tracks = &session->tracks,
                                             .effects = &session->effects,
                                             .camera = camera,
                                             .slot = picture->slot,
                                             .fps = rate};
}

int view_pictures_camera(struct render_session *session, struct view_picture *picture,
                         const struct frame_view *moment, const struct quality_control_level *level,
                         const struct view_picture_target *sheet, struct error_text *error)
{
    struct camera camera;
    struct image *drawn = canvas(session, sheet->image, level);
    picture->camera_wish.width = drawn->width;
    picture->camera_wish.height = drawn->height;
    view_camera_camera(&picture->view_camera, &picture->camera_wish, moment, picture->slot,
                       &camera);
    scene_build(&session->scene, &camera, &session->scenery, moment, &session->effects);
    if (session->scene.omitted > 0 && log_due(&session->complained_ns, COMPLAINT_NS))
        log_warn("%u things in view are left out: more than a picture can hold",
                 session->scene.omitted);
    heartbeat_stage(session->heartbeat);
    if (session->draw.picture(session->draw.self, &session->scene, moment, drawn, error) != 0)
        return -1;
    heartbeat_stage(session->heartbeat);
    if (drawn != sheet->image)
        image_upscale(sheet->image, drawn);
    struct annotated_picture_source source =
        source_of(session, picture, moment, &camera, sheet->rate);
    if (sheet->chart != NULL)
        annotated_picture_instruments(sheet->chart, sheet->image, &source);
    return 0;
}

static int draw_camera(struct render_session *session, struct view_picture *picture,
                       const struct frame_view *moment, const struct quality_control_level *level,
                       struct error_text *error)
{
    const struct view_picture_target sheet = {
        .image = &session->image, .chart = &session->chart, .rate = session->rate};
    if (view_pictures_camera(session, picture, moment, level, &sheet, error) != 0)
        return -1;
    /* The first picture waits for all its ground; at a rate, ground comes when there is time. */
    if (session->smooth)
        session->scene.paintings = RENDER_SESSION_PAINTINGS;
    return 0;
}

/* The map, with what the chase camera would see. */
static int draw_map(struct render_session *session, struct view_picture *picture,
                    const struct frame_view *moment, struct error_text *error)
{
    struct camera camera;
    picture->camera_wish.view = VIEW_CHASE;
    picture->camera_wish.width = session->image.width;
    picture->camera_wish.height = session->image.height;
    view_camera_camera(&picture->view_camera, &picture->camera_wish, moment, picture->slot,
                       &camera);
    struct annotated_picture_source source =
        source_of(session, picture, moment, &camera, session->rate);
    if (annotated_picture_map(&session->chart, &session->image, &source) != 0)
        return error_text_set(error, "no memory for the map");
    return 0;
}

static int draw_picture(struct render_session *session, struct view_picture *picture,
                        const struct frame_view *moment, const struct quality_control_level *level,
                        struct error_text *error)
{
    int failed = picture->wish.mode == VIEW_MAP
                     ? draw_map(session, picture, moment, error)
                     : draw_camera(session, picture, moment, level, error);
    if (failed)
        return -1;
    return put_out(session, picture, moment, error);
}

/* Draws less or more from the next picture on, and says so. */
static void govern(struct render_session *session)
{
    struct quality_control *quality = &session->quality;
    uint64_t now_ns = clock_now_ns();
    double took_s = (double)(now_ns - session->drawn_ns) / 1e9;
    int change = quality_control_note(quality, took_s, (double)now_ns / 1e9);
    if (change == 0)
        return;
    const struct quality_control_level *level = &quality_control_levels[quality->level];
    log_info("pictures take %.1f of %.1f ms: draws %s, %.0f %% of the detail at %u %% of the size",
             1e3 * quality->judged_s, 1e3 * quality->interval_s, change < 0 ? "less" : "more",
             100.0 * level->detail, 25 * level->quarters);
}

/* Pictures a second, as they have been lately; of a film, as it will be seen. */
static void note_rate(struct render_session *session)
{
    uint64_t now_ns = clock_now_ns();
    if (session->at_s >= 0.0) {
        session->rate = session->options.fps;
    } else if (session->drawn_ns != 0) {
        double rate = (double)NS_PER_S / (double)(now_ns - session->drawn_ns);
        session->rate += (session->rate == 0.0 ? 1.0 : RATE_SHARE) * (rate - session->rate);
    }
    session->drawn_ns = now_ns;
}

int view_pictures_draw(struct render_session *session, bool last, struct error_text *error)
{
    note_rate(session);
    struct frame_view moment = view_pictures_frame(session, last);
    /* What stands still is drawn once more, with everything. */
    bool same = session->drawn == moment.head->frame && session->drawn_ahead_s == moment.ahead_s;
    bool whole = last || (same && moment.head->paused != 0);
    if (same && (session->drawn_whole || !whole))
        return 0;
    const struct quality_control_level *level =
        &quality_control_levels[whole ? 0 : session->quality.level];
    session->scene.detail = (float)level->detail;
    session->scene.paintings = paintings_of(session, whole);
    choose_vehicles(session, &moment);
    articulation_note(&session->articulation, &moment);
    for (uint32_t i = 0; i < session->picture_count; i++) {
        if (draw_picture(session, &session->pictures[i], &moment, level, error) != 0)
            return -1;
        heartbeat_stage(session->heartbeat);
    }
    session->drawn = moment.head->frame;
    session->drawn_ahead_s = moment.ahead_s;
    session->drawn_whole =
        level == quality_control_levels && session->scene.paintings == TERRAIN_TILES_ALL;
    if (!whole)
        govern(session);
    return 0;
}
