/* The command line of jolon-ctl: one argument a line. */
#include "tests/fuzz/support.h"

#include "ipc/log.h"
#include "ctl/parse.h"
#include "tests/fuzz/ending.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define ARGUMENTS_MAX 24

static void check(const struct ctl_request *request)
{
    const jolon_Command *c = &request->command;
    CHECK(segment_name_ok(request->world) && request->verb);
    CHECK(request->timeout_s > 0.0 && request->timeout_s <= 3600.0);
    CHECK(request->link.domain <= DDS_LINK_DOMAIN_MAX);
    CHECK(c->type > jolon_COMMAND_NONE && c->type <= jolon_COMMAND_QUIT);
    CHECK(memchr(c->kind, '\0', sizeof c->kind));
    CHECK(c->force <= jolon_FORCE_RED && c->behaviour <= jolon_BEHAVIOUR_PATROL);
    CHECK(isfinite(c->x_m) && isfinite(c->z_m) && isfinite(c->altitude_m) &&
          isfinite(c->heading_rad) && isfinite(c->speed_mps) && isfinite(c->scale));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char text[4096];
    static char program[] = "jolon-ctl";
    char *arguments[ARGUMENTS_MAX + 2] = {program};
    struct ctl_request request;
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
    optind = 0; /* getopt forgets the last line */
    if (ENDING_CATCH() == 0) {
        ctl_parse(&request, count, arguments);
        check(&request);
    }
    ending_done();
    return 0;
}
