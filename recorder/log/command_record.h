/* Records of the log of commands (docs/replay.md), to and from JSON. What is read was written by
 * nobody that could be trusted: everything is checked for its type and range. */
#ifndef JOLON_RECORDER_LOG_COMMAND_RECORD_H
#define JOLON_RECORDER_LOG_COMMAND_RECORD_H

#include "world/entity/event.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

#define COMMAND_LOG_FORMAT 1

/* Largest whole number of a record: exact in a double, as JSON carries numbers. */
#define RECORD_WHOLE_MAX 9007199254740991u

/* How such a log begins, whatever follows. */
#define COMMAND_LOG_BEGINS "{\"jolon\":\"commands\","

enum record_type {
    RECORD_BEGIN,   /* what the run was made of */
    RECORD_COMMAND, /* one command, applied in that frame */
    RECORD_MARK,    /* the run got so far */
    RECORD_END,     /* the recorder was asked to end: the last mark */
    RECORD_RESUMED, /* and went on after all */
    RECORD_GAP,     /* commands that are lost */
    RECORD_TYPE_COUNT
};

/* Where a run stands: the same three numbers in every record. */
struct record_place {
    uint64_t frame;    /* committed */
    uint64_t events;   /* of the run until then, a command's own answer included */
    uint64_t commands; /* likewise */
};

struct command_record {
    enum record_type type;
    struct record_place at;
    struct event_command command;  /* RECORD_COMMAND */
    uint64_t digest, event_digest; /* RECORD_MARK, RECORD_END */
    bool digested;                 /* they have a digest, not of the events alone */
    uint64_t lost;                 /* RECORD_GAP */
};

/* The record as an object; it is the caller's. Not for RECORD_BEGIN. */
cJSON *command_record_json(const struct command_record *record);

/* Reads a record; of RECORD_BEGIN only type and place. False when it is none. */
bool command_record_read(struct command_record *record, const cJSON *object);

/* A value of 16 hex digits; false when the object has none called key. */
bool record_hex(const cJSON *object, const char *key, uint64_t *value);

/* A whole number of 0 .. most. */
bool record_whole(const cJSON *object, const char *key, uint64_t most, uint64_t *value);

/* Adds the three numbers of a place. */
void record_put_place(cJSON *object, const struct record_place *at);

const char *record_type_name(enum record_type type);

#endif
