/* Images, logs and worlds as frames to be compared. */
#include "worldctl/side.h"

#include "archive/image.h"
#include "ipc/log.h"
#include "worldctl/arguments.h"
#include "worldctl/remake.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>

static void start_player(struct side *side)
{
    if (player_init(&side->player, &side->view, side->threads) != 0)
        die_refused("cannot start %u threads: %s", side->threads, strerror(errno));
}

static void open_image(struct side *side)
{
    static struct image image;
    struct reason reason;
    if (image_open(&image, side->name, &reason) != 0)
        die_refused("%s", reason.text);
    struct segment_header header = image_segment(&image);
    if (segment_private(&side->view, &header, &reason) != 0 ||
        image_load(&side->view, &image, &reason) != 0)
        die_refused("%s", reason.text);
    image_close(&image);
    start_player(side);
}

void side_open(struct side *side, const char *name, uint32_t threads)
{
    struct stat status;
    *side = (struct side){.name = name, .threads = threads};
    if (stat(name, &status) != 0 && !strchr(name, '/')) {
        const struct arguments arguments = {.world = name};
        side->kind = SIDE_WORLD;
        arguments_snapshot(&arguments, &side->view, &side->snapshot);
    } else if (tape_is_one(name)) {
        side->kind = SIDE_LOG;
        remake_tape(&side->tape, name);
        remake_world(&side->view, &side->tape);
        start_player(side);
    } else {
        side->kind = SIDE_IMAGE;
        open_image(side);
    }
}

void side_close(struct side *side)
{
    if (side->kind == SIDE_WORLD) {
        snapshot_free(&side->snapshot);
        segment_detach(&side->view);
        return;
    }
    player_free(&side->player);
    segment_abandon(&side->view);
    if (side->kind == SIDE_LOG)
        tape_close(&side->tape);
}

struct compared side_frame(const struct side *side)
{
    if (side->kind == SIDE_WORLD)
        return (struct compared){&side->view.world, snapshot_state(&side->snapshot, &side->view)};
    return (struct compared){&side->view.world, side->view.w[player_frame(&side->player) & 1]};
}

uint64_t side_number(const struct side *side)
{
    return side->kind == SIDE_WORLD ? side->snapshot.head.frame : player_frame(&side->player);
}

bool side_known(const struct side *side)
{
    return side->kind == SIDE_LOG && side_number(side) < side->tape.known_frame;
}

bool side_step(struct side *side)
{
    struct reason reason;
    if (side->kind == SIDE_IMAGE) {
        player_step(&side->player, NULL);
        return true;
    }
    enum tape_step step = tape_step(&side->tape, &side->player, &reason);
    if (step == TAPE_WRONG)
        die_refused("%s", reason.text);
    return step == TAPE_STEPPED;
}
