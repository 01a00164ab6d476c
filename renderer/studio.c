/* From a committed frame to files. */
#include "renderer/studio.h"

#include "ipc/clock.h"
#include "ipc/frame.h"
#include "ipc/log.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#define EVENT_BATCH       256u
#define EVENTS_BEFORE     2048u /* read at the start, for what still burns */
#define COMPLAINT_NS      10000000000ull
#define OVERLOOK_HEIGHT_M 60.0

static struct moment moment_of(const struct studio *studio)
{
    return (struct moment){.world = &studio->view->world,
                           .head = &studio->snapshot.head,
                           .entities = &studio->snapshot.entities,
                           .fixed_damage = studio->snapshot.fixed_damage,
                           .craters = &studio->craters,
                           .dents = &studio->dents};
}

static bool wants(const struct studio *studio, enum view_mode view)
{
    return studio->options.view == VIEW_BOTH || studio->options.view == (int)view;
}

static void take_defaults(struct options *options, const struct renderer_params *params)
{
    if (options->fps < 0.0)
        options->fps = params->fps;
    if (options->view < 0)
        options->view = (int)params->view;
    if (options->width == 0) {
        options->width = params->width;
        options->height = params->height;
    }
    if (!options->follow_given)
        options->follow = params->follow;
}

int studio_open(struct studio *studio, struct view *view, struct pulse *pulse,
                struct output *output, const struct options *options, struct reason *reason)
{
    memset(studio, 0, sizeof *studio);
    studio->view = view;
    studio->pulse = pulse;
    studio->output = output;
    studio->options = *options;
    studio->drawn = UINT64_MAX;
    studio->followed = SLOT_NONE;
    take_defaults(&studio->options, &view->world.params->renderer);
    uint32_t width = studio->options.width, height = studio->options.height;

    if (snapshot_init(&studio->snapshot, view) != 0)
        goto err_memory;
    if (crater_index_init(&studio->craters, view->w[0].craters) != 0)
        goto err_snapshot;
    if (dents_init(&studio->dents, view->w[0].dents, view->world.params->dent_slots) != 0)
        goto err_craters;
    if (tracks_init(&studio->tracks, view->world.params->capacity) != 0)
        goto err_dents;
    if (scenery_init(&studio->scenery, &view->world) != 0)
        goto err_tracks;
    if (scene_init(&studio->scene) != 0)
        goto err_scenery;
    if (image_init(&studio->image, width, height) != 0)
        goto err_scene;
    pulse_stage(pulse);
    if (chart_open(&studio->chart, &view->world, width, height, reason) != 0)
        goto err_image;
    pulse_stage(pulse);
    if (wants(studio, VIEW_CHASE) &&
        gl_open(&studio->draw, &studio->scenery, width, height, reason) != 0)
        goto err_chart;
    pulse_stage(pulse);
    struct state_head head;
    if (snapshot_head(&head, view) == 0 && head.event_end > EVENTS_BEFORE)
        studio->events.next = head.event_end - EVENTS_BEFORE;
    return 0;

err_chart:
    chart_close(&studio->chart);
err_image:
    image_free(&studio->image);
    scene_free(&studio->scene);
    scenery_free(&studio->scenery);
    tracks_free(&studio->tracks);
    dents_free(&studio->dents);
    crater_index_free(&studio->craters);
    snapshot_free(&studio->snapshot);
    return -1;
err_scene:
    scene_free(&studio->scene);
err_scenery:
    scenery_free(&studio->scenery);
err_tracks:
    tracks_free(&studio->tracks);
err_dents:
    dents_free(&studio->dents);
err_craters:
    crater_index_free(&studio->craters);
err_snapshot:
    snapshot_free(&studio->snapshot);
err_memory:
    return reason_set(reason, "no memory for a renderer of %ux%u pictures", width, height);
}

void studio_close(struct studio *studio)
{
    if (studio->draw.self != NULL)
        studio->draw.close(studio->draw.self);
    chart_close(&studio->chart);
    image_free(&studio->image);
    scene_free(&studio->scene);
    scenery_free(&studio->scenery);
    tracks_free(&studio->tracks);
    dents_free(&studio->dents);
    crater_index_free(&studio->craters);
    snapshot_free(&studio->snapshot);
}

uint64_t studio_due_ns(const struct studio *studio)
{
    if (studio->options.fps <= 0.0)
        return UINT64_MAX;
    return studio->drawn_ns + (uint64_t)((double)NS_PER_S / studio->options.fps);
}

static void take_events(struct studio *studio, const struct moment *moment)
{
    struct event events[EVENT_BATCH];
    uint32_t count;
    do {
        count = events_read(studio->view, &studio->events, events, EVENT_BATCH);
        /* The ring may be ahead of the snapshot: what is not yet in it comes with the next. */
        uint32_t old = 0;
        while (old < count && events[old].frame <= moment->head->frame)
            old++;
        effects_take(&studio->effects, moment, events, old);
        studio->events.next -= count - old;
        count = old;
    } while (count == EVENT_BATCH);
}

int studio_look(struct studio *studio, struct reason *reason)
{
    if (snapshot_take(&studio->snapshot, studio->view) != 0) {
        if (errno == EBADMSG)
            return reason_set(reason, "world \"%s\" is damaged: its checksum is wrong",
                              studio->view->name);
        if (log_due(&studio->complained_ns, COMPLAINT_NS))
            log_warn("the world goes on faster than it can be copied; the picture stays");
        return 0;
    }
    struct moment moment = moment_of(studio);
    if (crater_index_update(&studio->craters, moment.head->crater_count) != 0)
        return reason_set(reason, "no memory for %u craters", moment.head->crater_count);
    dents_update(&studio->dents, moment.head->dent_count);
    studio->seen = moment.head->frame;
    log_frame(studio->seen);
    take_events(studio, &moment);
    tracks_note(&studio->tracks, &moment);
    studio->followed = follow_choose(&studio->follow, &moment, &studio->effects,
                                     studio->options.follow, studio->options.follow_given);
    pulse_stage(studio->pulse);
    return 0;
}

/* Behind the followed vehicle; with none there is, over the middle of the square. */
static struct camera aim(const struct studio *studio, const struct moment *moment)
{
    struct camera camera;
    const struct entities *e = moment->entities;
    uint32_t slot = studio->followed;
    struct camera_subject subject = {.radius_m = 3.0 * OVERLOOK_HEIGHT_M / 9.0};
    if (slot != SLOT_NONE) {
        const struct kind *kind = &moment->world->kinds[e->kind[slot]];
        subject = (struct camera_subject){.position = entities_position(e, slot),
                                          .heading_rad = e->heading[slot],
                                          .pitch_rad = e->pitch[slot],
                                          .radius_m = kind->radius_m};
    } else {
        double middle = 25000.0;
        subject.position = (struct vec3){
            middle, terrain_height(&moment->world->terrain, NULL, middle, middle), middle};
    }
    camera_chase(&camera, &subject, &moment->world->terrain, moment->craters, studio->options.width,
                 studio->options.height);
    return camera;
}

static void describe(const struct studio *studio, const struct moment *moment, char *words,
                     size_t bytes)
{
    if (studio->followed == SLOT_NONE) {
        snprintf(words, bytes, "frame=%llu time_s=%.3f", (unsigned long long)moment->head->frame,
                 world_time_s(moment->world, moment->head));
        return;
    }
    struct statistics statistics;
    statistics_of(&statistics, moment, studio->followed);
    statistics_line(&statistics, words, bytes);
}

static int put_out(struct studio *studio, const char *name, const char *words,
                   struct reason *reason)
{
    if (studio->output != NULL)
        return output_picture(studio->output, name, &studio->image, studio->seen, words, reason);
    if (studio->options.view != VIEW_BOTH || name[0] == 'c')
        return output_file(studio->options.snap, &studio->image, words, reason);
    /* Both into one name given: the map's has "-map" before its ending. */
    char path[1024];
    const char *dot = strrchr(studio->options.snap, '.');
    int stem =
        (int)(dot != NULL ? dot - studio->options.snap : (ptrdiff_t)strlen(studio->options.snap));
    int length = snprintf(path, sizeof path, "%.*s-map%s", stem, studio->options.snap,
                          dot != NULL ? dot : "");
    if (length < 0 || (size_t)length >= sizeof path)
        return reason_set(reason, "--snap %s: the path is too long", studio->options.snap);
    return output_file(path, &studio->image, words, reason);
}

static int draw_chase(struct studio *studio, const struct moment *moment, const char *words,
                      struct reason *reason)
{
    struct camera camera = aim(studio, moment);
    scene_build(&studio->scene, &camera, &studio->scenery, moment, &studio->effects);
    if (studio->scene.omitted > 0 && log_due(&studio->complained_ns, COMPLAINT_NS))
        log_warn("%u things in view are left out: more than a picture can hold",
                 studio->scene.omitted);
    pulse_stage(studio->pulse);
    if (studio->draw.picture(studio->draw.self, &studio->scene, moment, &studio->image, reason) !=
        0)
        return -1;
    pulse_stage(studio->pulse);
    chart_instruments(&studio->chart, &studio->image, moment, &studio->tracks, studio->followed);
    return put_out(studio, "chase", words, reason);
}

int studio_draw(struct studio *studio, struct reason *reason)
{
    struct moment moment = moment_of(studio);
    char words[512];
    studio->drawn_ns = clock_now_ns();
    if (studio->drawn == studio->seen)
        return 0;
    describe(studio, &moment, words, sizeof words);
    if (wants(studio, VIEW_CHASE) && draw_chase(studio, &moment, words, reason) != 0)
        return -1;
    pulse_stage(studio->pulse);
    if (wants(studio, VIEW_MAP)) {
        if (chart_map(&studio->chart, &studio->image, &moment, &studio->tracks, studio->followed) !=
            0)
            return reason_set(reason, "no memory for the map");
        if (put_out(studio, "map", words, reason) != 0)
            return -1;
    }
    pulse_stage(studio->pulse);
    studio->drawn = studio->seen;
    return 0;
}
