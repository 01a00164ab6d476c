/* The response to contacts, one at a time, and the registry of responses.
 *
 * A response is a row of RESPONSE_MODELS (world/collision_models.h) and a file response_WORD.c that
 * defines its functions. */
#ifndef JOLON_COLLIDER_RESPONSE_RESPONSE_H
#define JOLON_COLLIDER_RESPONSE_RESPONSE_H

#include "collider/response/response_context.h"
#include "world/collision_models.h"

typedef void response_function(struct response_context *context, const struct impact *impact,
                               struct outcome *outcome);

struct response_functions {
    /* Respond to a collision with a moving body, and with a fixed object. NULL: the two pass
     * through each other. */
    response_function *moving, *fixed;
    /* Solves all contacts of a group of bodies at one moment (island.h). first is the group's first
     * index into met + 1. NULL: each contact is resolved alone. */
    void (*joint)(struct response_context *context, uint32_t first, uint32_t bodies);
};

/* response_figure8 and so on, each in its own file. */
#define X(name, value, word, text) extern const struct response_functions response_##word;
RESPONSE_MODELS(X)
#undef X

const struct response_functions *response_of(enum response_model model);

/* Responds to the earliest contact. A joint response also resolves those of the same moment that
 * must be solved together with it. */
void response_contact(struct response_context *context, const struct contact *contact);

struct impact response_impact(const struct response_context *context,
                              const struct contact *contact);

/* Returns true if the row is still inside an object that it may pass through. When another hull of
 * the same body enters the object later, no second collision is reported. Remembers the contact. */
bool passes_through(struct response_context *context, const struct impact *impact);

/* What an impact is to the contact of its two bodies. */
enum impact_role {
    IMPACT_BEGINS, /* the contact begins with it: an event */
    IMPACT_RENEWS, /* the bodies had parted for a while, and the contact had not ended: an event */
    IMPACT_WITHIN, /* they have just touched: an event only if the damage of one becomes worse */
    IMPACT_LEANS   /* it is too slow: no bounce, no damage, no event */
};

/* Returns the role of an impact, and remembers that its bodies touched. */
enum impact_role response_role(struct response_context *context, const struct impact *impact);

/* The place of a collision's event. It is taken before the response, so that the events that follow
 * from the response come after it. */
struct report {
    enum impact_role role;
    struct event *event; /* NULL: no event so far, or the frame has no room for events */
    uint8_t damage[2];   /* enum damage of both sides before the response */
    struct vec3 direction_a;
};
struct report response_report(struct response_context *context, const struct impact *impact,
                              enum impact_role role);

/* Completes the event, and adds the impact to its contact. */
void write_collision_event(struct response_context *context, const struct report *report,
                           const struct impact *impact, const struct outcome *outcome);

#endif
