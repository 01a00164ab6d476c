/* Frames whose values all follow from the frame's number, so that a copy mixed from two frames is
 * detected. For tests of the frame protocol, whose writers fill the frames with made-up values. */
#ifndef JOLON_TESTS_SUPPORT_NUMBERED_FRAME_H
#define JOLON_TESTS_SUPPORT_NUMBERED_FRAME_H

#include <stdbool.h>
#include <stdint.h>

struct entities;
struct state_head;

/* Fills rows 0 .. rows - 1 and the head for the frame head->frame. */
void numbered_frame_fill(struct state_head *head, struct entities *entities, uint32_t rows);

/* Return true if all values are those of the head's frame. Frame 0 is not filled and always
 * accepted. They use no asserts, so that children may call them. */
bool numbered_frame_head(const struct state_head *head);
bool numbered_frame_rows(const struct state_head *head, const struct entities *entities);

#endif
