/* The text of a scenario that a test writes piece by piece. */
#ifndef JOLON_TESTS_SUPPORT_SCENARIO_TEXT_H
#define JOLON_TESTS_SUPPORT_SCENARIO_TEXT_H

#include <stddef.h>

struct scenario_text {
    char at[1 << 17];
    size_t used; /* without the final zero; 0: it is empty */
};

/* Adds text. The test fails if there is no room for it. */
void scenario_text_add(struct scenario_text *text, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
