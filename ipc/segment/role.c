/* The table of roles. */
#include "ipc/segment/role.h"

#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    unsigned traits; /* bits of enum role_trait */
    int start, stop; /* places in the keeper's order, from 1; 0: not the keeper's */
} roles[ROLE_COUNT] = {
#define X(tag, name, calls, traits, first, last, start, stop) {name, traits, start, stop},
    ROLES(X)
#undef X
};

const char *role_name(enum role role)
{
    return role < ROLE_COUNT ? roles[role].name : "?";
}

enum role role_find(const char *name)
{
    for (int i = 0; i < ROLE_COUNT; i++) {
        if (strcmp(roles[i].name, name) == 0)
            return (enum role)i;
    }
    return ROLE_NONE;
}

bool role_has(enum role role, enum role_trait trait)
{
    return role < ROLE_COUNT && (roles[role].traits & trait) != 0;
}

const char *role_names(enum role_trait trait, char *text, size_t size)
{
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < ROLE_COUNT && length < size; i++) {
        if (trait == 0 || role_has((enum role)i, trait))
            length += (size_t)snprintf(text + length, size - length, "%s%s", length ? ", " : "",
                                       roles[i].name);
    }
    return text;
}

int role_order(enum role order[ROLE_COUNT], bool stopping)
{
    int count = 0;
    for (int place = 1; place <= ROLE_COUNT; place++) {
        for (int i = 0; i < ROLE_COUNT; i++) {
            if ((stopping ? roles[i].stop : roles[i].start) == place)
                order[count++] = (enum role)i;
        }
    }
    return count;
}

const char *role_state_name(enum role_state state)
{
    static const char *const names[ROLE_STATE_COUNT] = {"absent", "starting", "ready", "stopping"};
    return state < ROLE_STATE_COUNT ? names[state] : "?";
}
