/* Reading lists of views. */
#include "renderer/views.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#define WORDS "chase, map, inside, orbit, free, overhead, both"

static bool same_word(const char *text, size_t length, const char *word)
{
    return strlen(word) == length && strncmp(text, word, length) == 0;
}

static void add(struct views *views, enum view_mode mode, uint32_t vehicle)
{
    struct view_spec *spec = &views->spec[views->count++];
    *spec = (struct view_spec){.mode = mode, .vehicle = vehicle};
    if (vehicle == 0)
        snprintf(spec->name, sizeof spec->name, "%s", view_mode_name(mode));
    else
        snprintf(spec->name, sizeof spec->name, "%s.%u", view_mode_name(mode), vehicle);
}

/* Reads ":ID"; an empty text gives 0. Returns 0, or -1 when it is no id. */
static int read_vehicle(const char *text, size_t length, uint32_t *vehicle)
{
    uint64_t id = 0;
    *vehicle = 0;
    if (length == 0)
        return 0;
    if (length == 1 || length > 11)
        return -1;
    for (size_t i = 1; i < length; i++) {
        if (text[i] < '0' || text[i] > '9')
            return -1;
        id = 10 * id + (uint64_t)(text[i] - '0');
    }
    *vehicle = (uint32_t)id;
    return id >= 1 && id <= UINT32_MAX ? 0 : -1;
}

/* Reads one entry of the list, "VIEW" or "VIEW:ID". */
static int read_entry(struct views *views, const char *text, size_t length,
                      struct error_text *error)
{
    size_t word = strcspn(text, ":,");
    uint32_t vehicle, mode = 0;
    bool both = same_word(text, word, "both");
    while (!both && mode < VIEW_COUNT && !same_word(text, word, view_mode_name(mode)))
        mode++;
    if (mode == VIEW_COUNT)
        return error_text_set(error, "%.*s is not one of " WORDS, (int)(length < 40 ? length : 40),
                              text);
    if (read_vehicle(text + word, length - word, &vehicle) != 0)
        return error_text_set(error, "%.*s: after the colon comes a vehicle's id, as chase:17",
                              (int)(length < 40 ? length : 40), text);
    if (views->count + both >= VIEWS_MAX)
        return error_text_set(error, "more than %u views; start another renderer", VIEWS_MAX);
    add(views, both ? VIEW_CHASE : (enum view_mode)mode, vehicle);
    if (both)
        add(views, VIEW_MAP, vehicle);
    return 0;
}

/* Two views of one name would write the same files. */
static int check_different(const struct views *views, struct error_text *error)
{
    for (uint32_t i = 0; i < views->count; i++)
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(views->spec[i].name, views->spec[j].name) == 0)
                return error_text_set(error, "%s is there twice",
                                      view_mode_name(views->spec[i].mode));
    return 0;
}

int views_read(struct views *views, const char *text, struct error_text *error)
{
    *views = (struct views){.count = 0};
    for (;;) {
        size_t length = strcspn(text, ",");
        if (read_entry(views, text, length, error) != 0)
            return -1;
        if (text[length] == '\0')
            return check_different(views, error);
        text += length + 1;
    }
}

void views_of_bits(struct views *views, uint32_t bits)
{
    *views = (struct views){.count = 0};
    for (uint32_t mode = 0; mode < VIEW_COUNT; mode++)
        if (bits & 1u << mode)
            add(views, (enum view_mode)mode, 0);
}
