/* Compares the settings with their defaults. */
#include "world/gateway_idle.h"

#include "world/gateway_defaults.h"
#include "world/params.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum setting_type { TEXT, WHOLE, TRUTH };

struct setting {
    const char *name, *fallback; /* as a scenario writes it */
    enum setting_type type;
    size_t offset; /* in struct params */
};

#define AT(member) offsetof(struct params, member)

static const struct setting settings[] = {
    {"gateway.address", GATEWAY_DEFAULT_ADDRESS, TEXT, AT(gateway.address)},
    {"gateway.listen", GATEWAY_DEFAULT_LISTEN, TEXT, AT(gateway.listen)},
    {"gateway.interface", GATEWAY_DEFAULT_INTERFACE, TEXT, AT(gateway.interface)},
    {"gateway.peers", GATEWAY_DEFAULT_PEERS, TEXT, AT(gateway.peers)},
    {"gateway.control", GATEWAY_DEFAULT_CONTROL, TEXT, AT(gateway.control)},
    {"gateway.cot", GATEWAY_DEFAULT_COT, TEXT, AT(gateway.cot)},
    {"gateway.port", GATEWAY_DEFAULT_PORT, WHOLE, AT(gateway.port)},
    {"gateway.exercise", GATEWAY_DEFAULT_EXERCISE, WHOLE, AT(gateway.exercise)},
    {"gateway.site", GATEWAY_DEFAULT_SITE, WHOLE, AT(gateway.site)},
    {"gateway.application", GATEWAY_DEFAULT_APPLICATION, WHOLE, AT(gateway.application)},
    {"gateway.applications", GATEWAY_DEFAULT_APPLICATIONS, WHOLE, AT(gateway.applications)},
    {"gateway.version", GATEWAY_DEFAULT_VERSION, WHOLE, AT(gateway.version)},
    {"gateway.rate", GATEWAY_DEFAULT_RATE, WHOLE, AT(gateway.rate_ps)},
    {"gateway.clamp", GATEWAY_DEFAULT_CLAMP, TRUTH, AT(gateway.clamp)},
    {"gateway.undulation_grid", GATEWAY_DEFAULT_UNDULATION_GRID, TRUTH,
     AT(gateway.undulation_grid)},
    {"world.remotes_max", GATEWAY_DEFAULT_REMOTES_MAX, WHOLE, AT(remotes_max)},
};

/* Returns true if a setting has its default. */
static bool is_default(const struct params *params, const struct setting *setting)
{
    const char *value = (const char *)params + setting->offset;
    char text[16];
    uint32_t whole;
    if (setting->type == TEXT)
        return strcmp(value, setting->fallback) == 0;
    memcpy(&whole, value, sizeof whole);
    if (setting->type == TRUTH)
        return strcmp(whole != 0 ? "true" : "false", setting->fallback) == 0;
    (void)snprintf(text, sizeof text, "%u", whole);
    return strcmp(text, setting->fallback) == 0;
}

static void add(char text[GATEWAY_IDLE_TEXT], const char *name)
{
    size_t used = strlen(text);
    (void)snprintf(text + used, GATEWAY_IDLE_TEXT - used, "%s%s",
                   used > 0 ? GATEWAY_IDLE_BETWEEN : "", name);
}

bool gateway_idle_settings(const struct params *params, char text[GATEWAY_IDLE_TEXT])
{
    char timeout_s[32];
    text[0] = '\0';
    if (params->gateway.enabled != 0)
        return false;
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++) {
        if (!is_default(params, &settings[i]))
            add(text, settings[i].name);
    }
    (void)snprintf(timeout_s, sizeof timeout_s, "%.17g", params->gateway.timeout_s);
    if (strcmp(timeout_s, GATEWAY_DEFAULT_TIMEOUT_S) != 0)
        add(text, "gateway.timeout_s");
    return text[0] != '\0';
}
