/* Compares the settings with their defaults. A unit test holds the defaults below to those of the
 * schema of scenarios. */
#include "world/gateway_idle.h"

#include "world/params.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

struct text_setting {
    const char *name, *fallback;
    size_t offset;
};

struct number_setting {
    const char *name;
    uint32_t fallback;
    size_t offset;
};

#define AT(member) offsetof(struct params, member)

static const struct text_setting texts[] = {
    {"gateway.address", "127.0.0.1", AT(gateway.address)},
    {"gateway.listen", "none", AT(gateway.listen)},
    {"gateway.interface", "any", AT(gateway.interface)},
    {"gateway.peers", "127.0.0.0/8, ::1", AT(gateway.peers)},
    {"gateway.control", "none", AT(gateway.control)},
    {"gateway.cot", "none", AT(gateway.cot)},
};

static const struct number_setting numbers[] = {
    {"gateway.port", 3000, AT(gateway.port)},
    {"gateway.exercise", 1, AT(gateway.exercise)},
    {"gateway.site", 1991, AT(gateway.site)},
    {"gateway.application", 1, AT(gateway.application)},
    {"gateway.applications", 16, AT(gateway.applications)},
    {"gateway.version", 7, AT(gateway.version)},
    {"gateway.rate", 5000, AT(gateway.rate_ps)},
    {"gateway.clamp", 1, AT(gateway.clamp)},
    {"gateway.undulation_grid", 0, AT(gateway.undulation_grid)},
    {"world.remotes_max", 0, AT(remotes_max)},
};

static void add(char text[GATEWAY_IDLE_TEXT], const char *name)
{
    size_t used = strlen(text);
    (void)snprintf(text + used, GATEWAY_IDLE_TEXT - used, "%s%s", used > 0 ? ", " : "", name);
}

bool gateway_idle_settings(const struct params *params, char text[GATEWAY_IDLE_TEXT])
{
    const char *bytes = (const char *)params;
    text[0] = '\0';
    if (params->gateway.enabled != 0)
        return false;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        if (strcmp(bytes + texts[i].offset, texts[i].fallback) != 0)
            add(text, texts[i].name);
    }
    for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++) {
        uint32_t value;
        memcpy(&value, bytes + numbers[i].offset, sizeof value);
        if (value != numbers[i].fallback)
            add(text, numbers[i].name);
    }
    if (params->gateway.timeout_s != 12.0)
        add(text, "gateway.timeout_s");
    return text[0] != '\0';
}
