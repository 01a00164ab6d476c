/* The lists in the gateway's settings as texts, with commas between their members: the addresses
 * from which packets are taken, and the simulations whose requests to start and stop are obeyed.
 * "none" and the empty text are lists of nobody. Pure; any thread. */
#ifndef JOLON_WORLD_GATEWAY_LISTS_H
#define JOLON_WORLD_GATEWAY_LISTS_H

#include "world/runtime/internet_address.h"

#define GATEWAY_LISTS_MAX  16u     /* members of a list */
#define GATEWAY_LISTS_ANY  0xffffu /* any application of the site */
#define GATEWAY_LISTS_NONE "none"

struct gateway_lists_peers {
    uint32_t count;
    struct internet_address_range range[GATEWAY_LISTS_MAX]; /* [count] */
};

struct gateway_lists_control {
    uint32_t count;
    struct {
        uint16_t site;            /* 1..65533 */
        uint16_t application;     /* 1..65533, or GATEWAY_LISTS_ANY */
    } allowed[GATEWAY_LISTS_MAX]; /* [count] */
};

/* Read "10.0.0.7, 10.1.0.0/16", and "7:1, 8:*" (SITE:APPLICATION). Return 0, or -1 with the reason
 * in error, which names the member. */
int gateway_lists_peers(struct gateway_lists_peers *peers, const char *text,
                        struct error_text *error);
int gateway_lists_control(struct gateway_lists_control *control, const char *text,
                          struct error_text *error);

/* Return true if the list has the address, or the simulation. */
bool gateway_lists_has_peer(const struct gateway_lists_peers *peers,
                            const struct internet_address *address);
bool gateway_lists_has_control(const struct gateway_lists_control *control, uint16_t site,
                               uint16_t application);

#endif
