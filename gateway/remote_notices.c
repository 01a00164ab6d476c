/* Lines of the log on what comes in. */
#include "gateway/remote_notices.h"

#include "ipc/process/log.h"
#include "world/enum_names.h"

#include <inttypes.h>
#include <stdio.h>

static const char *const refusal_texts[REMOTE_INPUT_REFUSALS] = {
    [REMOTE_INPUT_FULL] = "Entity States beyond world.remotes_max",
    [REMOTE_INPUT_PLACE] = "outside the square",
    [REMOTE_INPUT_HEIGHT] = "below -1 km or above 50 km",
    [REMOTE_INPUT_JUMP] = "that jump",
    [REMOTE_INPUT_TWIN] = "of an identifier that another sender (address and port) had first",
    [REMOTE_INPUT_RING] = "without room in the ring",
    [REMOTE_INPUT_SHOTS] = "shots and detonations beyond 1,000 a second",
    [REMOTE_INPUT_BODY] = "Collisions without a mass, with one above 1e9 kg, or beyond 256 at once",
    [REMOTE_INPUT_TYPE] = "of types that cannot be shown"};

static uint64_t sum(const uint64_t *counts, unsigned number)
{
    uint64_t total = 0;
    for (unsigned i = 0; i < number; i++)
        total += counts[i];
    return total;
}

bool remote_notices_text(const struct remote_input *input, char *text, size_t size)
{
    size_t at = 0;
    text[0] = '\0';
    for (int i = 0; i < REMOTE_INPUT_REFUSALS && at < size; i++) {
        char more[24] = "";
        if (input->refused[i] == 0)
            continue;
        if (i == REMOTE_INPUT_FULL)
            (void)snprintf(more, sizeof more, " = %u", input->table.capacity);
        int length = snprintf(text + at, size - at, "%s%" PRIu64 " %s%s", at > 0 ? ", " : "",
                              input->refused[i], refusal_texts[i], more);
        at += length > 0 ? (size_t)length : 0;
    }
    return text[0] != '\0';
}

bool remote_notices_refusals(void *subject, uint64_t now_ns)
{
    struct remote_input *input = subject;
    uint64_t total = sum(input->refused, REMOTE_INPUT_TYPE), twin = input->twin;
    char text[700], from[UDP_ADDRESS_TEXT], id[REMOTE_ID_TEXT], last[160] = "";
    (void)now_ns;
    if (total == input->refused_told)
        return false;
    if (twin != 0)
        (void)snprintf(last, sizeof last, "; the last of them is %s of %s",
                       remote_id_text(twin, id),
                       udp_address_text(&input->twin_from, from, sizeof from));
    (void)remote_notices_text(input, text, sizeof text);
    log_warn("refused so far: %s%s", text, last);
    input->refused_told = total;
    input->twin = 0;
    return true;
}

bool remote_notices_world(void *subject, uint64_t now_ns)
{
    struct remote_input *input = subject;
    uint64_t total = sum(input->world_refused, REMOTE_REFUSAL_COUNT);
    char text[500] = "", id[REMOTE_ID_TEXT];
    size_t at = 0;
    (void)now_ns;
    if (total == input->world_refused_told)
        return false;
    for (int i = 0; i < REMOTE_REFUSAL_COUNT && at < sizeof text; i++) {
        char more[64] = "";
        if (input->world_refused[i] == 0)
            continue;
        if (i == REMOTE_NO_ROW)
            (void)snprintf(more, sizeof more, " (world.capacity = %u)", input->world_capacity);
        int length =
            snprintf(text + at, sizeof text - at, "%s%" PRIu64 " because: %s%s", at > 0 ? ", " : "",
                     input->world_refused[i], remote_refusal_name((enum remote_refusal)i), more);
        at += length > 0 ? (size_t)length : 0;
    }
    log_warn("the world has refused so far: %s; the last is %s", text,
             remote_id_text(input->world_refused_remote, id));
    input->world_refused_told = total;
    return true;
}

bool remote_notices_types(struct remote_input *input, const struct kind *kinds)
{
    char text[900];
    if (type_notices_text(&input->unknown, kinds, text, sizeof text) == 0)
        return false;
    log_info("%s", text);
    return true;
}
