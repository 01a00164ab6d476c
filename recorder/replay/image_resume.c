/* Continues from an image, or branches off it with other settings. */
#include "recorder/replay/image_resume.h"

#include "ipc/segment/segment_attach.h"
#include "recorder/archive/image_read.h"
#include "config/loader.h"
#include "ipc/process/log.h"
#include "ipc/process/process.h"
#include "world/checksum.h"
#include "world/cruise_pose.h"
#include "recorder/replay/world_adopt.h"
#include "recorder/replay/scenario_load.h"
#include "world/terrain/crater.h"
#include "world/terrain/posts_write.h"
#include "world/provenance.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void change_settings(const struct arguments *arguments, struct image *image)
{
    struct error_text error;
    if (loader_branch(&image->params, arguments->set, arguments->sets, &error) != 0)
        die_refused("%s", error.text);
    arguments_seconds(arguments, &image->params);
    uint64_t limit = image->params.frame_limit;
    if (limit != 0 && image->header.frame >= limit)
        die_refused("%s: is of frame %" PRIu64 ", and the run ends with frame %" PRIu64
                    "; --set world.frames=N goes further, 0 without end",
                    image->path, image->header.frame, limit);
}

/* A run that was quit goes on from its image. Seals the frame. */
static void clear_quit(struct view *view, uint64_t frame)
{
    struct state *state = &view->w[frame & 1];
    state->head->quit = 0;
    state_seal(state, view->header->counts.fixed);
}

/* Writes the world's provenance: how to make it again from the image, and the changed settings. */
static int write_provenance(const struct view *view, const struct arguments *arguments,
                            const struct image *image, struct error_text *error)
{
    struct provenance recipe = {0};
    char text[32], *path = realpath(image->path, NULL);
    const struct state_head *head = view->w[image->header.frame & 1].head;
    int result = provenance_add(&recipe, "image", path ? path : image->path);
    free(path);
    snprintf(text, sizeof text, "%" PRIu64, head->frame);
    result |= provenance_add(&recipe, "frame", text);
    snprintf(text, sizeof text, "%" PRIu64, head->tally.commands);
    result |= provenance_add(&recipe, "commands", text);
    for (int i = 0; i < arguments->sets; i++)
        result |= provenance_add(&recipe, "set", arguments->set[i]);
    const char *ground = provenance_find(view->world.recipe, view->world.counts.recipe, "ground");
    if (ground) /* the image holds it, and the gateway has to know that it is one of a file */
        result |= provenance_add(&recipe, "ground", ground);
    scenario_load_note_seconds(arguments, &recipe);
    uint32_t room = view->world.counts.recipe;
    if (result == 0 && recipe.bytes < room) {
        char *to = (char *)(uintptr_t)view->world.recipe;
        memset(to, 0, room);
        memcpy(to, recipe.text, recipe.bytes);
    } else {
        result = error_text_set(
            error, "--set: %u bytes of overrides; a world from an image has room for %u",
            recipe.bytes, room);
    }
    provenance_free(&recipe);
    return result;
}

/* Maps the posts of a large world, which the image does not hold. Makes their file again from the
 * ground file if that is all that is missing. */
static int find_posts(struct view *view, struct error_text *error)
{
    const char *ground = provenance_find(view->world.recipe, view->world.counts.recipe, "ground");
    char *path = NULL;
    if (segment_map_posts(view, error) == 0)
        return 0;
    uint64_t hash = ground ? strtoull(ground, &path, 16) : 0;
    if (!path || *path != ' ' || posts_write_for(path + 1, hash, error) != 0)
        return -1;
    return segment_map_posts(view, error);
}

/* Ends the stretches of vehicles that cruise in a branch: where they are follows from the settings
 * under which the stretches began (world/entity/cruise.h). */
static int end_stretches(struct view *view, const struct image *image, struct error_text *error)
{
    const struct state *state = &view->w[image->header.frame & 1];
    struct world then = view->world;
    struct crater_index craters;
    if (!image->header.params.cruise || !image_branches(image))
        return 0;
    if (crater_index_init(&craters, &then.terrain.squares, state->craters) != 0)
        return error_text_set(error, "%s: not enough memory for its craters", image->path);
    then.params = &image->header.params;
    crater_index_update(&craters, state->head->crater_count);
    cruise_pose_settle(&state->entities, &then, &craters, state->head->used, state->head->tick);
    crater_index_free(&craters);
    return 0;
}

void image_resume_open(const struct arguments *arguments, struct image *image)
{
    struct error_text error;
    if (image_open(image, arguments->from, &error) != 0)
        die_refused("%s", error.text);
    change_settings(arguments, image);
}

int image_resume_fill(struct view *view, const struct arguments *arguments,
                      const struct image *image, struct error_text *error)
{
    if (image_load(view, image, error) != 0 || find_posts(view, error) != 0 ||
        end_stretches(view, image, error) != 0)
        return -1;
    clear_quit(view, image->header.frame);
    return write_provenance(view, arguments, image, error);
}

void image_resume_private(struct view *view, struct image *image, const char *path)
{
    struct error_text error;
    if (image_open(image, path, &error) != 0)
        die_refused("%s", error.text);
    struct segment_header header = image_segment(image);
    if (segment_private(view, &header, &error) != 0 || image_load(view, image, &error) != 0 ||
        find_posts(view, &error) != 0)
        die_refused("%s", error.text);
}

static void make(const struct arguments *arguments, const struct image *image)
{
    struct view view;
    struct error_text error;
    struct segment_header header = image_segment(image);
    if (segment_begin(&view, arguments->world, &header, &error) != 0)
        die_refused("%s", error.text);
    int result = image_resume_fill(&view, arguments, image, &error);
    process_hold_stop();
    if (result != 0 || segment_publish(&view, &error) != 0) {
        segment_abandon(&view);
        die_refused("%s", error.text);
    }
    segment_detach(&view);
}

int image_resume_world(const struct arguments *arguments)
{
    static struct image image;
    if (arguments->path)
        die_usage("create --from %s %s: an image has its scenario within it; leave one of them out",
                  arguments->from, arguments->path);
    image_resume_open(arguments, &image);
    if (!arguments->adopt || !world_adopt(arguments->world, &image.params, &image.header)) {
        make(arguments, &image);
        printf("world \"%s\": frame %" PRIu64 " of %s, %s\n", arguments->world, image.header.frame,
               image.path,
               image_branches(&image) ? "branched off with other settings" : "goes on from there");
    }
    image_close(&image);
    return EXIT_OK;
}
