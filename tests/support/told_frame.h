/* Frames that can be told apart: every value follows from the frame's number, so that a copy of two
 * frames at once shows. For tests of the protocol, whose writers make frames up. */
#ifndef JOLON_TESTS_SUPPORT_TOLD_FRAME_H
#define JOLON_TESTS_SUPPORT_TOLD_FRAME_H

#include <stdbool.h>
#include <stdint.h>

struct entities;
struct state_head;

/* Fills rows 0 .. rows - 1 and what the head says of them, for the frame that head->frame is. */
void told_frame_fill(struct state_head *head, struct entities *entities, uint32_t rows);

/* Do they say one frame? Frame 0, which nobody filled, does. No asserts: also for children. */
bool told_frame_head(const struct state_head *head);
bool told_frame_rows(const struct state_head *head, const struct entities *entities);

#endif
