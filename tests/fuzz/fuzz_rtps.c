/* Datagrams of arbitrary bytes through the filter in front of Cyclone DDS. It must read nothing
 * beyond them and leave no type information in discovery. A datagram that it has passed must pass
 * again unchanged. */
#include "ipc/topics/rtps_filter.h"
#include "world/runtime/check.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct rtps_announcement said;
    uint8_t *datagram = malloc(size + 1), *before = malloc(size + 1);
    CHECK(datagram && before);
    memcpy(datagram, data, size);
    if (rtps_filter(datagram, size, &said)) {
        CHECK(!(said.here && said.gone) && said.locator_count <= RTPS_LOCATORS_MAX);
        CHECK(!(said.here || said.gone) || rtps_announces(datagram, size));
        memcpy(before, datagram, size);
        CHECK(rtps_filter(datagram, size, &said));
        CHECK(memcmp(datagram, before, size) == 0);
    }
    free(datagram);
    free(before);
    return 0;
}
