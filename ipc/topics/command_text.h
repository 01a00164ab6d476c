/* An order: a command as text, given word by word, and its checks.
 *
 * One table of verbs and one of their arguments serve jolon ctl (command line), and jolon harness
 * and jolon console (JSON, ipc/topics/command_json.h). Every check that needs no world is made
 * here. Each error says what would be right.
 *
 *     command_text_begin(&order, "drive", &error);
 *     command_text_give(&order, COMMAND_TEXT_VEHICLE, &value, &error);    for each argument
 *     command_text_end(&order, &error);                                   nothing is missing
 *     command_text_resolve(&order, names, hz, &error);         names to ids, seconds to frames
 *     command_text_place(&order, &frame, &error);              a place on the earth to x and z
 *
 * Each order is used by one thread. */
#ifndef JOLON_IPC_TOPICS_COMMAND_TEXT_H
#define JOLON_IPC_TOPICS_COMMAND_TEXT_H

#include "ipc/segment/segment.h"
#include "ipc/topics/name_table.h"
#include "world/terrain/location.h"

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
    COMMAND_TEXT_AT,
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

/* An argument's value. text is set for a text; with loose, which a command line sets, numbers are
 * read from it. */
struct command_text_value {
    const char *text; /* NULL: a number or a truth value */
    double number;
    bool truth, is_truth;
    bool loose;
};

struct command_text_verb {
    const char *name;
    jolon_CommandType type;
    uint32_t allowed, needed;        /* bits of command_text_field */
    enum command_text_field operand; /* follows the verb on a command line; FIELD_COUNT: none */
};

struct command_text {
    const struct command_text_verb *verb;
    jolon_Command command; /* source and sequence are 0 */
    char vehicle[COMMAND_TEXT_NAME_MAX],
        target[COMMAND_TEXT_NAME_MAX]; /* names that are still to be resolved, or "" */
    double lease_s;                    /* 0: none */
    uint32_t rounds;                   /* of a fire mission, from 1 */
    double every_s, radius_m;
    double side_m;  /* of the world, WORLD_SIDE_MAX_M while it is not known */
    uint32_t seed;  /* of the rounds' points of aim */
    uint32_t given; /* bits of command_text_field */
    /* on_earth: x and z are still to follow from it by command_text_place(); they count as given.
     */
    struct location place;
};

/* Returns verb i, NULL beyond the last. */
const struct command_text_verb *command_text_verb(size_t i);

/* Begins an order. Returns 0, or -1 with the reason, which names the verb that may have been
 * meant. */
int command_text_begin(struct command_text *order, const char *verb, struct error_text *error);

/* Return the name of an argument in JSON ("lease_s") and as an option ("lease"). */
const char *command_text_field_name(enum command_text_field field);
const char *command_text_field_option(enum command_text_field field);

/* Returns the field of that JSON name, FIELD_COUNT when there is none. */
enum command_text_field command_text_field(const char *name);

/* Returns true if the argument takes no value on a command line. */
bool command_text_field_is_truth(enum command_text_field field);

/* Takes an argument. Returns 0, or -1 with the reason, before which the caller puts the
 * argument. */
int command_text_give(struct command_text *order, enum command_text_field field,
                      const struct command_text_value *value, struct error_text *error);

/* Checks that nothing is missing and nothing contradicts. Returns 0, or -1 with the reason. */
int command_text_end(struct command_text *order, struct error_text *error);

/* Return true if command_text_resolve() needs the names, or the world's frames a second; and if
 * command_text_place() has something to do. */
bool command_text_needs_names(const struct command_text *order);
bool command_text_needs_hz(const struct command_text *order);
bool command_text_needs_place(const struct command_text *order);

/* Replaces names by ids and seconds by frames. Returns 0, or -1 with the reason: no vehicle has
 * that name. */
int command_text_resolve(struct command_text *order, const struct name_table *names, double hz,
                         struct error_text *error);

/* Gives a place on the earth its x and z, and any other order nothing. Returns 0, or -1 with the
 * reason: the place is outside of the world. */
int command_text_place(struct command_text *order, const struct location_frame *frame,
                       struct error_text *error);

/* Returns the command of a fire mission's round, counted from 0, aimed at random within radius_m of
 * the middle. Any other order has the one round 0. */
jolon_Command command_text_round(const struct command_text *order, uint64_t seed, uint32_t round);

/* Returns advice on a refusal, as the end of a sentence: "; ..." or "". */
const char *command_text_advice(const struct command_text *order, jolon_CommandResult result);

#endif
