/* Continues a dead set's world, or removes it. */
#include "recorder/replay/world_adopt.h"

#include "ipc/process/clock.h"
#include "ipc/process/log.h"
#include "ipc/segment/segment.h"
#include "ipc/segment/segment_attach.h"
#include "ipc/segment/segment_locks.h"
#include "ipc/segment/segment_repair.h"

#include <inttypes.h>
#include <stdio.h>

#define DYING_NS (5 * (uint64_t)NS_PER_S) /* for the roles to die after their keeper */

static bool same_world(const struct view *view, const struct params *params,
                       const struct image_header *image)
{
    return view->world.params->scenario_hash == params->scenario_hash &&
           (!image || view->header->origin == image->header_hash ||
            view->header->made == image->segment.made);
}

/* A damaged world is given up only if an image of it is at hand. A world that merely cannot be read
 * now may be good, and is kept in any case. */
static void refuse_unusable(struct error_text *error, const struct image_header *image)
{
    if (!error->damaged)
        die_refused("%s", error->text);
    if (!image)
        die_refused("%s; `jolon clean -w` with its name removes it, another -w NAME makes another",
                    error->text);
    log_warn("%s; goes on from the image", error->text);
}

static bool remove_world(const char *name)
{
    struct error_text error;
    if (segment_remove(name, false, &error) != 0)
        die_refused("%s", error.text);
    return false;
}

bool world_adopt(const char *name, const struct params *params, const struct image_header *image)
{
    struct view view;
    struct error_text error;
    bool same = false;
    if (segment_attach(&view, name, ROLE_NONE, &error) == 0) {
        same = same_world(&view, params, image);
        segment_detach(&view);
    } else if (!error.foreign) {
        refuse_unusable(&error, image);
    }
    if (!same)
        return remove_world(name);
    if (segment_wait_free(name, ROLE_COLLIDER, clock_now_ns() + DYING_NS, &error) != 0)
        die_refused("%s", error.text);
    int repaired = segment_repair(name, &error);
    if (repaired < 0) {
        refuse_unusable(&error, image);
        return remove_world(name);
    }
    if (repaired > 0)
        printf("%s\n", error.text);
    if (segment_attach(&view, name, ROLE_NONE, &error) != 0)
        die_refused("%s", error.text);
    printf("world \"%s\": a set that died left it at frame %" PRIu64 "; goes on from there\n", name,
           (uint64_t)atomic_load(&view.commit->commit));
    segment_detach(&view);
    return true;
}
