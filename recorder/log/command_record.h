/* Records of the command log (docs/replay.md), to and from JSON. The type and range of every value
 * that is read are checked, as the file may come from anywhere. */
#ifndef JOLON_RECORDER_LOG_COMMAND_RECORD_H
#define JOLON_RECORDER_LOG_COMMAND_RECORD_H

#include "world/entity/event.h"

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stdint.h>

#define COMMAND_LOG_FORMAT 1

/* Largest whole number in a record. JSON carries numbers as doubles, which hold it exactly. */
#define RECORD_WHOLE_MAX 9007199254740991u

/* The first bytes of every command log. */
#define COMMAND_LOG_BEGINS "{\"jolon\":\"commands\","

enum record_type {
    RECORD_BEGIN,   /* how the run was made */
    RECORD_COMMAND, /* one command, applied in that frame */
    RECORD_MARK,    /* the run has reached this frame */
    RECORD_END,     /* the recorder ended as asked: the last mark */
    RECORD_RESUMED, /* a recorder continued the log after its end */
    RECORD_GAP,     /* commands or inputs are lost */
    RECORD_INPUTS,  /* records of other simulators, applied in that frame one after the other */
    RECORD_TYPE_COUNT
};

/* A position in a run. Every record has these three numbers. */
struct record_position {
    uint64_t frame;    /* committed */
    uint64_t events;   /* of the run so far; a command's record counts its own event */
    uint64_t commands; /* of the run so far; a command's record counts its own command */
};

struct command_record {
    enum record_type type;
    struct record_position at;
    struct event_command command;  /* RECORD_COMMAND */
    uint64_t digest, event_digest; /* RECORD_MARK, RECORD_END */
    bool digested;                 /* digest is known, not only event_digest */
    uint64_t lost;                 /* RECORD_GAP: commands; 0 if inputs are lost */
    struct command *inputs;        /* RECORD_INPUTS [input_count], without their sequence */
    uint32_t input_count;
    uint8_t input_ring; /* enum command_ring */
};

/* Records of other simulators in one record of the log, at most. */
#define COMMAND_RECORD_INPUTS_MAX 4096u

/* Returns the record as a JSON object, which the caller deletes. Not for RECORD_BEGIN. */
cJSON *command_record_json(const struct command_record *record);

/* Reads a record; of RECORD_BEGIN only type and position. Returns false if the object is not a
 * record, or if there is no memory for its inputs, which the caller frees. */
bool command_record_read(struct command_record *record, const cJSON *object);

/* Reads the value of 16 hex digits called key. Returns false if the object has none. */
bool record_hex(const cJSON *object, const char *key, uint64_t *value);

/* Reads the whole number called key. Returns false if the object has none from 0 to most. */
bool record_whole(const cJSON *object, const char *key, uint64_t most, uint64_t *value);

/* Adds the three numbers of a position. */
void record_add_position(cJSON *object, const struct record_position *at);

const char *record_type_name(enum record_type type);

#endif
