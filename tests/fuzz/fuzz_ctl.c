/* The command line of jolon-ctl, one argument on each line, and its lines from standard input,
 * which are the same bytes with blanks between the words. */
#include "tests/fuzz/support.h"

#include "clients/ctl/parse.h"
#include "tests/fuzz/shared/ending.h"
#include "world/runtime/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ARGUMENTS_MAX 24

static void check_order(const struct command_text *order)
{
    CHECK(!order->place.on_earth ||
          (fabs(order->place.latitude_deg) <= 90.0 && fabs(order->place.longitude_deg) <= 180.0));
    const jolon_Command *c = &order->command;
    CHECK(order->verb && (order->given & ~order->verb->allowed) == 0);
    CHECK(c->type > jolon_COMMAND_NONE && c->type <= jolon_COMMAND_QUIT);
    CHECK(memchr(c->kind, '\0', sizeof c->kind));
    CHECK(c->force <= jolon_FORCE_RED && c->behaviour <= jolon_BEHAVIOUR_PATROL &&
          c->gear <= jolon_GEAR_LOW);
    CHECK(isfinite(c->x_m) && isfinite(c->z_m) && isfinite(c->altitude_m) &&
          isfinite(c->heading_rad) && isfinite(c->speed_mps) && isfinite(c->scale));
    CHECK(order->rounds >= 1 && order->rounds <= COMMAND_TEXT_ROUNDS_MAX);
}

static void check(const struct ctl_request *request)
{
    CHECK(segment_name_ok(request->world));
    CHECK(request->timeout_s > 0.0 && request->timeout_s <= 3600.0);
    CHECK(request->link.domain <= DDS_LINK_DOMAIN_MAX);
    if (!request->lines)
        check_order(&request->order);
}

static void run_line(const uint8_t *data, size_t size)
{
    char line[CTL_LINE_MAX];
    struct command_text order;
    struct error_text error = {.text = ""};
    size = size < sizeof line - 1 ? size : sizeof line - 1;
    memcpy(line, data, size);
    line[size] = '\0';
    int result = ctl_parse_line(&order, line, &error);
    CHECK(result == 0 || result == 1 || error.text[0]);
    if (result == 0)
        check_order(&order);
}

/* A separate function: ENDING_CATCH() is a setjmp(), after which changed variables are lost. */
static void run_arguments(int count, char **arguments)
{
    struct ctl_request request;
    if (ENDING_CATCH() == 0) {
        ctl_parse(&request, count, arguments);
        check(&request);
    }
    ending_done();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char text[4096];
    static char program[] = "jolon-ctl";
    char *arguments[ARGUMENTS_MAX + 2] = {program};
    int count = 1;
    if (size >= sizeof text)
        return 0;
    memcpy(text, data, size);
    text[size] = '\0';
    for (char *at = text; count <= ARGUMENTS_MAX && at < text + size; count++) {
        arguments[count] = at;
        at += strcspn(at, "\n");
        *at++ = '\0';
    }
    arguments[count] = NULL;
    run_arguments(count, arguments);
    run_line(data, size);
    return 0;
}
