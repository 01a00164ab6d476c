/* An order: a command as people and programs say it, word by word, and what is wrong with it.
 *
 * One table of the verbs and one of their arguments, for whoever takes orders: jolon ctl from a
 * command line, jolon harness and jolon console from JSON (topics/order_json.h). Every check that
 * needs no world is made here; what is wrong is said in words that name what would be right.
 *
 *     order_begin(&order, "drive", &reason);
 *     order_give(&order, ORDER_VEHICLE, &value, &reason);    for each argument
 *     order_end(&order, &reason);                            is it whole?
 *     order_resolve(&order, names, hz, &reason);             names to ids, seconds to frames
 *
 * Pure; one thread an order. */
#ifndef JOLON_TOPICS_ORDER_H
#define JOLON_TOPICS_ORDER_H

#include "ipc/segment.h"
#include "topics/names.h"

#include "status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define ORDER_NAME_MAX   24u
#define ORDER_ROUNDS_MAX 1000u

enum order_field {
    ORDER_VEHICLE,
    ORDER_TARGET,
    ORDER_THROTTLE,
    ORDER_STEER,
    ORDER_CLIMB,
    ORDER_TRAVERSE,
    ORDER_ELEVATE,
    ORDER_BRAKE,
    ORDER_GEAR,
    ORDER_LEASE,
    ORDER_ANYWAY,
    ORDER_KIND,
    ORDER_MUNITION,
    ORDER_X,
    ORDER_Z,
    ORDER_FORCE,
    ORDER_BEHAVIOUR,
    ORDER_ALTITUDE,
    ORDER_HEADING,
    ORDER_SPEED,
    ORDER_FRAMES,
    ORDER_SCALE,
    ORDER_ROUNDS,
    ORDER_EVERY,
    ORDER_RADIUS,
    ORDER_SEED,
    ORDER_FIELD_COUNT
};

/* An argument's value: a text where it came as one, from which numbers are read if loose says so
 * (a command line knows nothing else). */
struct order_value {
    const char *text; /* NULL: number or truth */
    double number;
    bool truth, is_truth;
    bool loose;
};

struct order_verb {
    const char *name;
    jolon_CommandType type;
    uint32_t allowed, needed; /* bits of order_field */
    enum order_field operand; /* what follows the verb on a command line, FIELD_COUNT: nothing */
};

struct order {
    const struct order_verb *verb;
    jolon_Command command;                                /* source and sequence are 0 */
    char vehicle[ORDER_NAME_MAX], target[ORDER_NAME_MAX]; /* by name: still to be found; else "" */
    double lease_s;                                       /* 0: none */
    uint32_t rounds;                                      /* of a fire mission, from 1 */
    double every_s, radius_m;
    uint32_t seed;  /* of where its rounds fall */
    uint32_t given; /* bits of order_field */
};

/* The verb i, NULL beyond the last. */
const struct order_verb *order_verb(size_t i);

/* Begins an order. -1 with the reason, which names the verb that may have been meant. */
int order_begin(struct order *order, const char *verb, struct reason *reason);

/* The name of an argument in JSON ("lease_s") and as an option ("lease"). */
const char *order_field_name(enum order_field field);
const char *order_field_option(enum order_field field);

/* The field of that JSON name, FIELD_COUNT when there is none. */
enum order_field order_field(const char *name);

/* Does it take no value on a command line? */
bool order_field_is_truth(enum order_field field);

/* Takes an argument. -1 with the reason, which begins with the value: the caller says of what. */
int order_give(struct order *order, enum order_field field, const struct order_value *value,
               struct reason *reason);

/* Is all there that the verb needs, and nothing that contradicts? -1 with the reason. */
int order_end(struct order *order, struct reason *reason);

/* Does order_resolve() need the names, or the world's frames a second? */
bool order_needs_names(const struct order *order);
bool order_needs_hz(const struct order *order);

/* Puts ids for names and frames for seconds. -1 with the reason: nobody is called so. */
int order_resolve(struct order *order, const struct names *names, double hz, struct reason *reason);

/* The command of a fire mission's round, from 0: about the middle, within radius_m, by chance from
 * seed. Any other order has the one round 0. */
jolon_Command order_round(const struct order *order, uint64_t seed, uint32_t round);

/* What to do about a refusal, as the end of a sentence: "; ..." or "". */
const char *order_advice(const struct order *order, jolon_CommandResult result);

#endif
