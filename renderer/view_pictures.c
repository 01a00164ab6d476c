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
static double show_time(struct render_session *studio, const struct frame_view *latest)
{
    if (studio->at_s >= 0.0)
        return studio->at_s;
    double rate = latest->head->paused != 0 ? 0.0 : latest->head->time_scale;
    return frame_interpolation_time(&studio->clock, (double)clock_now_ns() / 1e9,
                                    frame_view_time_s(latest), world_dt_s(&studio->view->world),
                                    rate);
}

struct frame_view view_pictures_frame(struct render_session *studio, bool last)
{
    struct frame_view latest = render_session_moment(studio, studio->latest);
    if (last || !studio->smooth)
        return latest;
    double newest_s = frame_view_time_s(&latest), show_s = show_time(studio, &latest);
    if (studio->whole < 2)
        return latest;
    struct frame_view earlier = render_session_moment(studio, 1 - studio->latest);
    double passed_s = newest_s - frame_view_time_s(&earlier);
    double share = passed_s > 0.0 ? 1.0 - (newest_s - show_s) / passed_s : 1.0;
    return frame_interpolation_between(&studio->blend, &earlier, &latest, share);
}

uint32_t view_pictures_vehicle(struct render_session *studio, const struct frame_view *moment,
                               uint32_t vehicle)
{
    if (vehicle != 0)
        return entities_find(moment->entities, moment->head->used, vehicle);
    return follow_choose(&studio->follow, moment, &studio->effects, studio->options.follow,
                         studio->options.follow_given);
}

/* The vehicle of each view: its own, or the one that the renderer follows. */
static void choose_vehicles(struct render_session *studio, const struct frame_view *moment)
{
    uint32_t followed = view_pictures_vehicle(studio, moment, 0);
    for (uint32_t i = 0; i < studio->shot_count; i++) {
        struct view_picture *shot = &studio->shots[i];
        uint32_t own = SLOT_NONE;
        if (shot->wish.vehicle != 0)
            own = view_pictures_vehicle(studio, moment, shot->wish.vehicle);
        shot->slot = own != SLOT_NONE ? own : followed;
    }
}

/* What is stored with the picture: the vehicle's figures as they are in it. */
static void describe(const struct view_picture *shot, const struct frame_view *moment, char *words,
                     size_t bytes)
{
    if (shot->slot != SLOT_NONE) {
        struct statistics statistics;
        statistics_of(&statistics, moment, shot->slot);
        statistics_line(&statistics, words, bytes);
    } else {
        snprintf(words, bytes, "frame=%llu time_s=%.3f", (unsigned long long)moment->head->frame,
                 frame_view_time_s(moment));
    }
    size_t used = strlen(words);
    int more = snprintf(words + used, bytes - used, " view=%s", view_mode_name(shot->wish.mode));
    if (moment->ahead_s > 0.0) /* the picture is so much later than the frame */
        snprintf(words + used + more, bytes - used - (size_t)more, " ahead_s=%.4f",
                 moment->ahead_s);
}

/* The first view goes where --snap says; others have their names before its ending. */
static int put_file(const struct render_session *studio, const struct view_picture *shot,
                    const char *words, struct reason *reason)
{
    const char *name = studio->options.snap;
    if (shot == studio->shots)
        return picture_folder_file(name, &studio->image, words, reason);
    char path[1024];
    const char *dot = strrchr(name, '.');
    if (dot == NULL || strchr(dot, '/') != NULL)
        dot = name + strlen(name);
    int length =
        snprintf(path, sizeof path, "%.*s-%s%s", (int)(dot - name), name, shot->wish.name, dot);
    if (length < 0 || (size_t)length >= sizeof path)
        return reason_set(reason, "--snap %s: the path is too long", name);
    return picture_folder_file(path, &studio->image, words, reason);
}

static int put_out(struct render_session *studio, const struct view_picture *shot,
                   const struct frame_view *moment, struct reason *reason)
{
    char words[512];
    describe(shot, moment, words, sizeof words);
    heartbeat_stage(studio->pulse);
    if (studio->outlets == NULL)
        return put_file(studio, shot, words, reason);
    return output_set_put(studio->outlets, shot->wish.name, &studio->image, moment->head->frame,
                          frame_view_time_s(moment), words, reason);
}

/* Where the scene is drawn: the picture itself, or a smaller one. */
static struct image *canvas(struct render_session *studio, struct image *whole,
                            const struct quality_control_level *level)
{
    if (level->quarters == 4)
        return whole;
    uint32_t width = whole->width * level->quarters / 4;
    uint32_t height = whole->height * level->quarters / 4;
    studio->small.width = width > SIDE_LEAST ? width : SIDE_LEAST;
    studio->small.height = height > SIDE_LEAST ? height : SIDE_LEAST;
    return &studio->small;
}

/* At a high rate the ground is painted over several pictures, so that none comes late; and a
 * renderer that begins shows its first soon. */
static uint32_t paintings_of(const struct render_session *studio, bool whole)
{
    if (whole || (!studio->smooth && studio->drawn != UINT64_MAX))
        return TERRAIN_TILES_ALL;
    if (!studio->smooth)
        return PAINT_FIRST;
    double several = PAINT_SHARE / (studio->options.fps * PAINT_S);
    return several > PAINT_LEAST ? (uint32_t)several : PAINT_LEAST;
}

static struct annotated_picture_source source_of(const struct render_session *studio,
                                                 const struct view_picture *shot,
                                                 const struct frame_view *moment,
                                                 const struct camera *camera, double rate)
{
    return (struct annotated_picture_source){.moment = moment,
                                             .tracks = &studio->tracks,
                                             .effects = &studio->effects,
                                             .camera = camera,
                                             .slot = shot->slot,
                                             .fps = rate};
}

int view_pictures_camera(struct render_session *studio, struct view_picture *shot,
                         const struct frame_view *moment, const struct quality_control_level *level,
                         const struct view_picture_target *sheet, struct reason *reason)
{
    struct camera camera;
    struct image *drawn = canvas(studio, sheet->image, level);
    shot->aim_wish.width = drawn->width;
    shot->aim_wish.height = drawn->height;
    view_camera_camera(&shot->aim, &shot->aim_wish, moment, shot->slot, &camera);
    scene_build(&studio->scene, &camera, &studio->scenery, moment, &studio->effects);
    if (studio->scene.omitted > 0 && log_due(&studio->complained_ns, COMPLAINT_NS))
        log_warn("%u things in view are left out: more than a picture can hold",
                 studio->scene.omitted);
    heartbeat_stage(studio->pulse);
    if (studio->draw.picture(studio->draw.self, &studio->scene, moment, drawn, reason) != 0)
        return -1;
    heartbeat_stage(studio->pulse);
    if (drawn != sheet->image)
        image_stretch(sheet->image, drawn);
    struct annotated_picture_source source = source_of(studio, shot, moment, &camera, sheet->rate);
    if (sheet->chart != NULL)
        annotated_picture_instruments(sheet->chart, sheet->image, &source);
    return 0;
}

static int draw_camera(struct render_session *studio, struct view_picture *shot,
                       const struct frame_view *moment, const struct quality_control_level *level,
                       struct reason *reason)
{
    const struct view_picture_target sheet = {
        .image = &studio->image, .chart = &studio->chart, .rate = studio->rate};
    if (view_pictures_camera(studio, shot, moment, level, &sheet, reason) != 0)
        return -1;
    /* The first picture waits for all its ground; at a rate, ground comes when there is time. */
    if (studio->smooth)
        studio->scene.paintings = RENDER_SESSION_PAINTINGS;
    return 0;
}

/* The map, with what the chase camera would see. */
static int draw_map(struct render_session *studio, struct view_picture *shot,
                    const struct frame_view *moment, struct reason *reason)
{
    struct camera camera;
    shot->aim_wish.view = VIEW_CHASE;
    shot->aim_wish.width = studio->image.width;
    shot->aim_wish.height = studio->image.height;
    view_camera_camera(&shot->aim, &shot->aim_wish, moment, shot->slot, &camera);
    struct annotated_picture_source source = source_of(studio, shot, moment, &camera, studio->rate);
    if (annotated_picture_map(&studio->chart, &studio->image, &source) != 0)
        return reason_set(reason, "no memory for the map");
    return 0;
}

static int draw_shot(struct render_session *studio, struct view_picture *shot,
                     const struct frame_view *moment, const struct quality_control_level *level,
                     struct reason *reason)
{
    int failed = shot->wish.mode == VIEW_MAP ? draw_map(studio, shot, moment, reason)
                                             : draw_camera(studio, shot, moment, level, reason);
    if (failed)
        return -1;
    return put_out(studio, shot, moment, reason);
}

/* Draws less or more from the next picture on, and says so. */
static void govern(struct render_session *studio)
{
    struct quality_control *governor = &studio->governor;
    uint64_t now_ns = clock_now_ns();
    double took_s = (double)(now_ns - studio->drawn_ns) / 1e9;
    int change = quality_control_note(governor, took_s, (double)now_ns / 1e9);
    if (change == 0)
        return;
    const struct quality_control_level *level = &quality_control_levels[governor->level];
    log_info("pictures take %.1f of %.1f ms: draws %s, %.0f %% of the detail at %u %% of the size",
             1e3 * governor->judged_s, 1e3 * governor->interval_s, change < 0 ? "less" : "more",
             100.0 * level->detail, 25 * level->quarters);
}

/* Pictures a second, as they have been lately; of a film, as it will be seen. */
static void note_rate(struct render_session *studio)
{
    uint64_t now_ns = clock_now_ns();
    if (studio->at_s >= 0.0) {
        studio->rate = studio->options.fps;
    } else if (studio->drawn_ns != 0) {
        double rate = (double)NS_PER_S / (double)(now_ns - studio->drawn_ns);
        studio->rate += (studio->rate == 0.0 ? 1.0 : RATE_SHARE) * (rate - studio->rate);
    }
    studio->drawn_ns = now_ns;
}

int view_pictures_draw(struct render_session *studio, bool last, struct reason *reason)
{
    note_rate(studio);
    struct frame_view moment = view_pictures_frame(studio, last);
    /* What stands still is drawn once more, with everything. */
    bool same = studio->drawn == moment.head->frame && studio->drawn_ahead_s == moment.ahead_s;
    bool whole = last || (same && moment.head->paused != 0);
    if (same && (studio->drawn_whole || !whole))
        return 0;
    const struct quality_control_level *level =
        &quality_control_levels[whole ? 0 : studio->governor.level];
    studio->scene.detail = (float)level->detail;
    studio->scene.paintings = paintings_of(studio, whole);
    choose_vehicles(studio, &moment);
    articulation_note(&studio->gear, &moment);
    for (uint32_t i = 0; i < studio->shot_count; i++) {
        if (draw_shot(studio, &studio->shots[i], &moment, level, reason) != 0)
            return -1;
        heartbeat_stage(studio->pulse);
    }
    studio->drawn = moment.head->frame;
    studio->drawn_ahead_s = moment.ahead_s;
    studio->drawn_whole =
        level == quality_control_levels && studio->scene.paintings == TERRAIN_TILES_ALL;
    if (!whole)
        govern(studio);
    return 0;
}
