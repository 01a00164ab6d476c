/* An order: a command as people and programs say it, word by word, and what is wrong with it.
 *
 * One table of the verbs and one of their arguments, for whoever takes orders: jolon ctl from a
 * command line, jolon harness and jolon console from JSON (ipc/topics/command_json.h). Every check
 * that needs no world is made here; what is wrong is said in words that name what would be right.
 *
 *     command_text_begin(&order, "drive", &error);
 *     command_text_give(&order, COMMAND_TEXT_VEHICLE, &value, &error);    for each argument
 *     command_text_end(&order, &error);                            is it whole?
 *     command_text_resolve(&order, names, hz, &error);             names to ids, seconds to frames
 *
 * Pure; one thread an order. */
#ifndef JOLON_IPC_TOPICS_COMMAND_TEXT_H
#define JOLON_IPC_TOPICS_COMMAND_TEXT_H

#include "ipc/segment/segment.h"
#include "ipc/topics/name_table.h"

#include "status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define COMMAND_TEXT_NAME_MAX   24u
#define COMMAND_TEXT_ROUNDS_MAX 1000u

enum command_text_field {
    COMMAND_TEXT_VEHICLE,
    COMMAND_TEXT_TARGET,
    COMMAND_TEXT_THROTTLE,
    COMMAND_TEXT_STEER,
    COMMAND_TEXT_CLIMB,
    COMMAND_TEXT_TRAVERSE,
    COMMAND_TEXT_ELEVATE,
    COMMAND_TEXT_BRAKE,
    COMMAND_TEXT_GEAR,
    COMMAND_TEXT_LEASE,
    COMMAND_TEXT_ANYWAY,
    COMMAND_TEXT_KIND,
    COMMAND_TEXT_MUNITION,
    COMMAND_TEXT_X,
    COMMAND_TEXT_Z,
    COMMAND_TEXT_FORCE,
    COMMAND_TEXT_BEHAVIOUR,
    COMMAND_TEXT_ALTITUDE,
    COMMAND_TEXT_HEADING,
    COMMAND_TEXT_SPEED,
    COMMAND_TEXT_FRAMES,
    COMMAND_TEXT_SCALE,
    COMMAND_TEXT_ROUNDS,
    COMMAND_TEXT_EVERY,
    COMMAND_TEXT_RADIUS,
    COMMAND_TEXT_SEED,
    COMMAND_TEXT_FIELD_COUNT
};

/* An argument's value: a text where it came as one, from which numbers are read if loose says so
 * (a command line knows nothing else). */
struct command_text_value {
    const char *text; /* NULL: number or truth */
    double number;
    bool truth, is_truth;
    bool loose;
};

struct command_text_verb {
    const char *name;
    jolon_CommandType type;
    uint32_t allowed, needed; /* bits of command_text_field */
    enum command_text_field
        operand; /* what follows the verb on a command line, FIELD_COUNT: nothing */
};

struct command_text {
    const struct command_text_verb *verb;
    jolon_Command command; /* source and sequence are 0 */
    char vehicle[COMMAND_TEXT_NAME_MAX],
        target[COMMAND_TEXT_NAME_MAX]; /* by name: still to be found; else "" */
    double lease_s;                    /* 0: none */
    uint32_t rounds;                   /* of a fire mission, from 1 */
    double every_s, radius_m;
    uint32_t seed;  /* of where its rounds fall */
    uint32_t given; /* bits of command_text_field */
};

/* The verb i, NULL beyond the last. */
const struct command_text_verb *command_text_verb(size_t i);

/* Begins an order. -1 with the reason, which names the verb that may have been meant. */
int command_text_begin(struct command_text *order, const char *verb, struct error_text *error);

/* The name of an argument in JSON ("lease_s") and as an option ("lease"). */
const char *command_text_field_name(enum command_text_field field);
const char *command_text_field_option(enum command_text_field field);

/* The field of that JSON name, FIELD_COUNT when there is none. */
enum command_text_field command_text_field(const char *name);

/* Does it take no value on a command line? */
bool command_text_field_is_truth(enum command_text_field field);

/* Takes an argument. -1 with the reason, which begins with the value: the caller says of what. */
int command_text_give(struct command_text *order, enum command_text_field field,
                      const struct command_text_value *value, struct error_text *error);

/* Is all there that the verb needs, and nothing that contradicts? -1 with the reason. */
int command_text_end(struct command_text *order, struct error_text *error);

/* Does command_text_resolve() need the names, or the world's frames a second? */
bool command_text_needs_names(const struct command_text *order);
bool command_text_needs_hz(const struct command_text *order);

/* Puts ids for names and frames for seconds. -1 with the reason: nobody is called so. */
int command_text_resolve(struct command_text *order, const struct name_table *names, double hz,
                         struct error_text *error);

/* The command of a fire mission's round, from 0: about the middle, within radius_m, by chance from
 * seed. Any other order has the one round 0. */
jolon_Command command_text_round(const struct command_text *order, uint64_t seed, uint32_t round);

/* What to do about a refusal, as the end of a sentence: "; ..." or "". */
const char *command_text_advice(const struct command_text *order, jolon_CommandResult result);

#endif
