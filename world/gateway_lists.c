/* The lists in the gateway's settings. */
#include "world/gateway_lists.h"

#include "world/runtime/parse_number.h"

#include <stdio.h>
#include <string.h>

#define MEMBER_MAX  64u
#define NUMBER_LAST 65533u /* of a site or an application; higher numbers are reserved */

/* Reads a member into list. Returns 0, or -1 with what is wrong. */
typedef int read_member(void *list, const char *member, struct error_text *wrong);

/* Reads the members of a list one after the other. */
static int read_members(void *list, const char *text, read_member *read, struct error_text *error)
{
    struct error_text wrong;
    uint32_t count = 0;
    if (strcmp(text, GATEWAY_LISTS_NONE) == 0)
        return 0;
    for (const char *at = text + strspn(text, " "); *at != '\0'; at += strspn(at, " ")) {
        char member[MEMBER_MAX];
        size_t length = strcspn(at, ", ");
        if (length == 0 || length >= sizeof member)
            return error_text_set(error, "\"%s\" must be a list with commas between its members",
                                  text);
        (void)snprintf(member, sizeof member, "%.*s", (int)length, at);
        if (++count > GATEWAY_LISTS_MAX)
            return error_text_set(error, "\"%s\" has more than %u members", text,
                                  GATEWAY_LISTS_MAX);
        if (read(list, member, &wrong) != 0)
            return error_text_set(error, "\"%s\" %s", member, wrong.text);
        at += length;
        at += strspn(at, " ");
        at += *at == ',';
    }
    return 0;
}

static int read_peer(void *list, const char *member, struct error_text *wrong)
{
    struct gateway_lists_peers *peers = list;
    return internet_address_range_read(&peers->range[peers->count++], member, wrong);
}

int gateway_lists_peers(struct gateway_lists_peers *peers, const char *text,
                        struct error_text *error)
{
    peers->count = 0;
    return read_members(peers, text, read_peer, error);
}

static int read_control(void *list, const char *member, struct error_text *wrong)
{
    struct gateway_lists_control *control = list;
    char site[MEMBER_MAX];
    uint64_t number[2] = {0, GATEWAY_LISTS_ANY};
    (void)snprintf(site, sizeof site, "%s", member);
    char *application = strchr(site, ':');
    if (application)
        *application++ = '\0';
    if (!application || !parse_whole(site, 1, NUMBER_LAST, &number[0]) ||
        (strcmp(application, "*") != 0 && !parse_whole(application, 1, NUMBER_LAST, &number[1])))
        return error_text_set(
            wrong,
            "must be SITE:APPLICATION with numbers from 1 to %u, or SITE:* for all "
            "applications of a site",
            NUMBER_LAST);
    control->allowed[control->count].site = (uint16_t)number[0];
    control->allowed[control->count++].application = (uint16_t)number[1];
    return 0;
}

int gateway_lists_control(struct gateway_lists_control *control, const char *text,
                          struct error_text *error)
{
    control->count = 0;
    return read_members(control, text, read_control, error);
}

bool gateway_lists_has_peer(const struct gateway_lists_peers *peers,
                            const struct internet_address *address)
{
    for (uint32_t i = 0; i < peers->count; i++) {
        if (internet_address_in(address, &peers->range[i]))
            return true;
    }
    return false;
}

bool gateway_lists_has_control(const struct gateway_lists_control *control, uint16_t site,
                               uint16_t application)
{
    for (uint32_t i = 0; i < control->count; i++) {
        if (control->allowed[i].site == site &&
            (control->allowed[i].application == application ||
             control->allowed[i].application == GATEWAY_LISTS_ANY))
            return true;
    }
    return false;
}
