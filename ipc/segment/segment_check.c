/* Is this a world, and is it whole? */
#include "ipc/segment/segment_check.h"

#include "ipc/segment/segment_internal.h"
#include "world/maths/hash.h"
#include "world/params.h"

#include <errno.h>
#include <inttypes.h>
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

/* --- damage by its field -----------------------------------------------------------------------*/

enum form { FORM_WHOLE, FORM_HEX, FORM_REAL, FORM_OTHER };

struct field {
    const char *name;
    size_t offset, bytes;
    enum form form;
};

#define FIELD(type, member, form)                                                                  \
    {                                                                                              \
#member, offsetof(struct type, member), sizeof(((const struct type *)0)->member), form     \
    }
#define HEADER(member) FIELD(segment_header, member, FORM_WHOLE)
#define PARAM(member)  FIELD(params, member, FORM_WHOLE)

static const struct field header_fields[] = {
    FIELD(segment_header, magic, FORM_HEX),
    HEADER(version),
    HEADER(header_bytes),
    FIELD(segment_header, layout_hash, FORM_HEX),
    HEADER(total_bytes),
    FIELD(segment_header, static_hash, FORM_OTHER),
    HEADER(counts.kinds),
    HEADER(counts.models),
    HEADER(counts.model_vertices),
    HEADER(counts.model_triangles),
    HEADER(counts.hulls),
    HEADER(counts.hull_vertices),
    HEADER(counts.hull_planes),
    HEADER(counts.posts_side),
    HEADER(counts.fixed),
    HEADER(counts.reach),
    HEADER(counts.areas),
    HEADER(counts.routes),
    HEADER(counts.route_points),
    HEADER(counts.fires),
    HEADER(counts.road_points),
    HEADER(counts.names),
    HEADER(counts.formations),
    HEADER(counts.scripts),
    HEADER(counts.script_steps),
    HEADER(counts.recipe),
    HEADER(capacity),
    HEADER(event_slots),
    HEADER(intents_per_frame),
    HEADER(command_slots),
    HEADER(crater_slots),
    HEADER(dent_slots),
    FIELD(segment_header, made, FORM_HEX),
    FIELD(segment_header, origin, FORM_HEX),
    HEADER(first_event),
    FIELD(segment_header, head_hash, FORM_HEX),
};

static const struct field params_fields[] = {
    FIELD(params, name, FORM_OTHER),
    FIELD(params, scenario, FORM_OTHER),
    PARAM(seed),
    FIELD(params, scenario_hash, FORM_HEX),
    PARAM(frame_limit),
    FIELD(params, hz, FORM_REAL),
    FIELD(params, dt_s, FORM_REAL),
    PARAM(pace),
    PARAM(capacity),
    PARAM(event_slots),
    PARAM(events_per_frame),
    PARAM(intents_per_frame),
    PARAM(command_slots),
    PARAM(crater_slots),
    PARAM(dent_slots),
    PARAM(initial_entities),
    FIELD(params, collision, FORM_OTHER),
    FIELD(params, base, FORM_OTHER),
    FIELD(params, renderer, FORM_OTHER),
};

#define FIELDS(table) table, sizeof(table) / sizeof((table)[0])

/* Flips the one bit of bytes whose flip makes hash right again. Its byte; count when there is none,
 * and then bytes are as they were. */
static size_t unflip(unsigned char *bytes, size_t count, uint64_t (*hash)(const void *bytes),
                     uint64_t right)
{
    for (size_t i = 0; i < count; i++) {
        for (int bit = 0; bit < 8; bit++) {
            bytes[i] ^= (unsigned char)(1u << bit);
            if (hash(bytes) == right)
                return i;
            bytes[i] ^= (unsigned char)(1u << bit);
        }
    }
    return count;
}

static void print_value(char *text, size_t room, const struct field *field, const void *base)
{
    const unsigned char *at = (const unsigned char *)base + field->offset;
    uint64_t whole = 0;
    double real;
    memcpy(&whole, at, field->bytes < sizeof whole ? field->bytes : sizeof whole);
    memcpy(&real, &whole, sizeof real);
    if (field->form == FORM_REAL)
        snprintf(text, room, "%.17g", real);
    else
        snprintf(text, room, field->form == FORM_HEX ? "%016" PRIx64 : "%" PRIu64, whole);
}

/* Names the field that holds byte at, with its value and the one it had in good. */
static int damaged_field(const struct field *fields, size_t count, size_t at, const void *damaged,
                         const void *good, const char *where, struct reason *reason)
{
    char is[32], was[32];
    for (size_t i = 0; i < count; i++) {
        const struct field *field = &fields[i];
        if (at < field->offset || at >= field->offset + field->bytes)
            continue;
        if (field->form == FORM_OTHER)
            return reason_set(reason, "%s.%s is damaged at its byte %zu", where, field->name,
                              at - field->offset);
        print_value(is, sizeof is, field, damaged);
        print_value(was, sizeof was, field, good);
        return reason_set(reason, "%s.%s is damaged: it is %s and was %s", where, field->name, is,
                          was);
    }
    return reason_set(reason, "%s is damaged at byte %zu", where, at);
}

static uint64_t hash_of_header(const void *bytes)
{
    struct segment_header header;
    memcpy(&header, bytes, sizeof header);
    return segment_head_hash(&header);
}

static uint64_t hash_of_params(const void *bytes)
{
    return XXH3_64bits(bytes, sizeof(struct params));
}

static bool one_bit(uint64_t difference)
{
    return difference != 0 && (difference & (difference - 1)) == 0;
}

/* The header fails its hash: is one flipped bit the reason? Then reason names its field. */
static bool header_flipped(const struct segment_header *header, const char *path,
                           struct reason *reason)
{
    struct segment_header good = *header;
    char where[SEGMENT_PATH_MAX + 16];
    uint64_t hash = segment_head_hash(header);
    size_t at = offsetof(struct segment_header, head_hash);
    if (one_bit(hash ^ header->head_hash))
        good.head_hash = hash;
    else
        at = unflip((unsigned char *)&good, sizeof good, hash_of_header, header->head_hash);
    if (at == sizeof good)
        return false;
    snprintf(where, sizeof where, "%s: header", path);
    damaged_field(FIELDS(header_fields), at, header, &good, where, reason);
    return true;
}

/* More than one bit: what does not follow from the rest? */
static int damaged_header(const struct segment_header *header, const char *path,
                          struct reason *reason)
{
    struct layout layout;
    if (layout_compute(&layout, header) != 0)
        return reason_set(reason, "%s: header: counts are damaged: out of range", path);
    if (header->total_bytes != layout.total)
        return reason_set(reason,
                          "%s: header: total_bytes or counts are damaged: %" PRIu64
                          "; the counts need %zu",
                          path, header->total_bytes, layout.total);
    return reason_set(reason, "%s: header: fails its head_hash in more than one bit", path);
}

static int damaged_params(const struct params *params, uint64_t right, const char *path,
                          struct reason *reason)
{
    struct params good = *params;
    char where[SEGMENT_PATH_MAX + 16];
    snprintf(where, sizeof where, "%s: params", path);
    size_t at = unflip((unsigned char *)&good, sizeof good, hash_of_params, right);
    if (at < sizeof good)
        return damaged_field(FIELDS(params_fields), at, params, &good, where, reason);
    return reason_set(reason, "%s: fail their hash in more than one bit", where);
}

/* --- checks ------------------------------------------------------------------------------------*/

int segment_check_object(int fd, const char *path, size_t *bytes, struct reason *reason)
{
    struct stat status;
    if (fstat(fd, &status) != 0)
        return reason_set(reason, "%s: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return reason_set(reason, "%s: is no shared-memory object", path);
    if (status.st_uid != geteuid())
        return reason_set(reason, "%s: belongs to user %u, not to you (%u)", path,
                          (unsigned)status.st_uid, (unsigned)geteuid());
    if ((status.st_mode & 0777) != 0600)
        return reason_set(reason, "%s: has mode %03o; a world's is 600", path,
                          (unsigned)(status.st_mode & 0777));
    if (status.st_size < (off_t)sizeof(struct segment_header)) {
        reason_set(reason, "%s: size %lld is too small for a header", path,
                   (long long)status.st_size);
        reason->damaged = true;
        return -1;
    }
    *bytes = (size_t)status.st_size;
    return 0;
}

/* A header of another build is told from a damaged one by its own hash, if that build made it in
 * the same way, and else by its version and layout, in which no single flipped bit explains the
 * hash. */
static int check_build(const struct segment_header *header, const char *path, struct reason *reason)
{
    if (header->version == SEGMENT_VERSION && header->header_bytes == sizeof *header &&
        header->layout_hash == layout_hash())
        return 0;
    if (header->version != SEGMENT_VERSION)
        reason_set(reason, "%s: version %u; this program knows %u", path, header->version,
                   SEGMENT_VERSION);
    else
        reason_set(reason,
                   "%s: layout: made by another build of Jolon; stop it with that build, or remove "
                   "it with `jolon clean -w NAME`",
                   path);
    reason->foreign = true;
    return -1;
}

/* The header is copied out of memory that others could change, then checked field by field. */
int segment_check_header(const struct segment_header *header, size_t bytes, const char *path,
                         struct layout *layout, struct reason *reason)
{
    if (header->magic != SEGMENT_MAGIC) {
        reason_set(reason, "%s: magic: not a Jolon world, or one that was never finished", path);
        reason->foreign = !one_bit(header->magic ^ SEGMENT_MAGIC);
        return -1;
    }
    bool whole = header->head_hash == segment_head_hash(header);
    if ((!whole && header_flipped(header, path, reason)) || check_build(header, path, reason) != 0)
        return -1;
    if (!whole)
        return damaged_header(header, path, reason);
    if (layout_compute(layout, header) != 0)
        return reason_set(reason, "%s: counts: out of range", path);
    if (header->total_bytes != layout->total || bytes != layout->total)
        return reason_set(reason, "%s: size %zu; its counts need %zu", path, bytes, layout->total);
    return 0;
}

int segment_params_fit(const struct params *params, const struct segment_header *header,
                       const char *path, struct reason *reason)
{
    if (params->capacity != header->capacity || params->event_slots != header->event_slots ||
        params->intents_per_frame != header->intents_per_frame ||
        params->command_slots != header->command_slots ||
        params->crater_slots != header->crater_slots || params->dent_slots != header->dent_slots)
        return reason_set(reason, "%s: params: do not fit the header", path);
    if (params->events_per_frame == 0 || params->events_per_frame > params->event_slots / 2)
        return reason_set(reason,
                          "%s: params: events_per_frame = %u of %u slots; must be from 1 to half "
                          "of them",
                          path, params->events_per_frame, params->event_slots);
    if (!(params->dt_s > 0.0 && params->dt_s <= 1.0))
        return reason_set(reason, "%s: params: dt_s = %g; must be more than 0, at most 1", path,
                          params->dt_s);
    return 0;
}

int segment_check_params(const struct view *view, const char *path, struct reason *reason)
{
    const struct segment_header *header = view->base;
    const struct params *params = segment_part(view, REGION_PARAMS);
    if (segment_region_hash(view, REGION_PARAMS) != header->static_hash[REGION_PARAMS])
        return damaged_params(params, header->static_hash[REGION_PARAMS], path, reason);
    return segment_params_fit(params, header, path, reason);
}

int segment_verify(const struct view *view, struct reason *reason)
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
    return reason_set(reason, "damaged since it was made: %s", names);
}
