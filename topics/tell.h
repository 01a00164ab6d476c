/* What a world says, in words as people read them. */
#ifndef JOLON_TOPICS_TELL_H
#define JOLON_TOPICS_TELL_H

#include "topics/mirror.h"
#include "topics/tail.h"

#define TELL_CLOCK_MAX 32
#define TELL_IDS       3

/* 00:03:25.7 */
const char *tell_clock(char text[TELL_CLOCK_MAX], double time_s);

/* "00:03:25.7 tank 12 fired at jeep 7"; a tail_format. */
void tell_event(char line[TAIL_LINE_MAX], enum dds_topic topic, const void *event);

/* The vehicles and munitions that it concerns, by id; 0 where there is none. */
void tell_ids(uint32_t ids[TELL_IDS], enum dds_topic topic, const void *event);

/* Why there is nothing new to see, "" when there is. */
void tell_silence(char *line, size_t bytes, const struct mirror *mirror, uint64_t now_ns);

#endif
