/* Checks that an object is a world, of this build and whole. */
#include "ipc/segment/segment_check.h"

#include "ipc/segment/segment_internal.h"
#include "world/maths/hash.h"
#include "world/params.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* --- hashes ------------------------------------------------------------------------------------*/

uint64_t segment_head_hash(const struct segment_header *header)
{
    struct segment_header copy = *header;
    copy.magic = 0;
    copy.head_hash = 0;
    return XXH3_64bits(&copy, sizeof copy);
}

uint64_t segment_region_hash(const struct view *view, int region)
{
    return XXH3_64bits(segment_part(view, region), view->layout.bytes[region]);
}

void segment_hash_static(struct view *view)
{
    struct segment_header *own = view->base;
    for (int i = REGION_PARAMS; i < REGION_COMMIT; i++)
        own->static_hash[i] = segment_region_hash(view, i);
}

uint64_t segment_static_hash(const struct segment_header *header)
{
    return XXH3_64bits(header->static_hash, sizeof header->static_hash);
}

/* --- checks ------------------------------------------------------------------------------------*/

int segment_check_object(int fd, const char *path, size_t *bytes, struct error_text *error)
{
    struct stat status;
    if (fstat(fd, &status) != 0)
        return error_text_set(error, "%s: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return error_text_set(error, "%s: is no shared-memory object", path);
    if (status.st_uid != geteuid())
        return error_text_set(error, "%s: belongs to user %u, not to you (%u)", path,
                              (unsigned)status.st_uid, (unsigned)geteuid());
    if ((status.st_mode & 0777) != 0600)
        return error_text_set(error, "%s: has mode %03o; a world's is 600", path,
                              (unsigned)(status.st_mode & 0777));
    if (status.st_size < (off_t)sizeof(struct segment_header)) {
        error_text_set(error, "%s: size %lld is too small for a header", path,
                       (long long)status.st_size);
        error->damaged = true;
        return -1;
    }
    *bytes = (size_t)status.st_size;
    return 0;
}

static int check_build(const struct segment_header *header, const char *path,
                       struct error_text *error)
{
    if (header->version == SEGMENT_VERSION && header->header_bytes == sizeof *header &&
        header->layout_hash == layout_hash())
        return 0;
    if (header->version != SEGMENT_VERSION)
        error_text_set(error, "%s: version %u; this program knows %u", path, header->version,
                       SEGMENT_VERSION);
    else
        error_text_set(
            error,
            "%s: layout: made by another build of Jolon; stop it with that build, or remove "
            "it with `jolon clean -w NAME`",
            path);
    error->foreign = true;
    return -1;
}

static bool one_bit(uint64_t difference)
{
    return difference != 0 && (difference & (difference - 1)) == 0;
}

/* The caller has copied the header out of memory that other processes can change. A header may fail
 * its hash because another build has another layout; a single flipped bit cannot explain a
 * different layout hash. */
int segment_check_header(const struct segment_header *header, size_t bytes, const char *path,
                         struct layout *layout, struct error_text *error)
{
    if (header->magic != SEGMENT_MAGIC) {
        error_text_set(error, "%s: magic: not a Jolon world, or one that was never finished", path);
        error->foreign = !one_bit(header->magic ^ SEGMENT_MAGIC);
        return -1;
    }
    uint64_t difference = header->layout_hash ^ layout_hash();
    if (header->head_hash != segment_head_hash(header) && (difference == 0 || one_bit(difference)))
        return error_text_set(error, "%s: header is damaged: it fails its hash", path);
    if (check_build(header, path, error) != 0)
        return -1;
    if (layout_compute(layout, header) != 0)
        return error_text_set(error, "%s: counts: out of range", path);
    if (header->total_bytes != layout->total || bytes != layout->total)
        return error_text_set(error, "%s: size %zu; its counts need %zu", path, bytes,
                              layout->total);
    return 0;
}

int segment_params_fit(const struct params *params, const struct segment_header *header,
                       const char *path, struct error_text *error)
{
    if (params->capacity != header->capacity || params->event_slots != header->event_slots ||
        params->intents_per_frame != header->intents_per_frame ||
        params->command_slots != header->command_slots ||
        params->crater_slots != header->crater_slots || params->dent_slots != header->dent_slots ||
        params->contact_slots != header->contact_slots ||
        layout_input_slots(params->command_slots, params->remotes_max) != header->input_slots)
        return error_text_set(error, "%s: params: do not fit the header", path);
    if (params->events_per_frame == 0 || params->events_per_frame > params->event_slots / 2)
        return error_text_set(
            error,
            "%s: params: events_per_frame = %u of %u slots; must be from 1 to half "
            "of them",
            path, params->events_per_frame, params->event_slots);
    if (!(params->dt_s > 0.0 && params->dt_s <= 1.0))
        return error_text_set(error, "%s: params: dt_s = %g; must be more than 0, at most 1", path,
                              params->dt_s);
    return 0;
}

int segment_check_params(const struct view *view, const char *path, struct error_text *error)
{
    const struct segment_header *header = view->base;
    const struct params *params = segment_part(view, REGION_PARAMS);
    if (segment_region_hash(view, REGION_PARAMS) != header->static_hash[REGION_PARAMS])
        return error_text_set(error, "%s: params are damaged: they fail their hash", path);
    return segment_params_fit(params, header, path, error);
}

int segment_verify(const struct view *view, struct error_text *error)
{
    char names[256] = "";
    size_t length = 0;
    for (int i = REGION_PARAMS; i < REGION_COMMIT; i++) {
        if (segment_region_hash(view, i) == view->header->static_hash[i] || length >= sizeof names)
            continue;
        length += (size_t)snprintf(names + length, sizeof names - length, "%s%s",
                                   length > 0 ? ", " : "", region_name((enum region)i));
    }
    if (length == 0)
        return 0;
    return error_text_set(error, "damaged since it was made: %s", names);
}
